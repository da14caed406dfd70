"""What a notebook's cells put out, kept as nbclient keeps what ipykernel sends. Lives inside the sandbox."""

import base64
import io
import json
import os

from comm.base_comm import BaseComm

MOST_OUTPUT = 2_000_000  # bytes of output that a notebook may keep
CUT = {"output_type": "stream", "name": "stderr", "text": "[more output than the grader keeps]\n"}


class Outputs:
    """The outputs of the cell that runs now; what all cells of a notebook may keep together is bounded.

    A stream's text is kept in pieces until it is taken.
    """

    def __init__(self):
        self.items, self.held, self.left, self.clear_next = [], 0, MOST_OUTPUT, False
        self.cell, self.shown = 0, {}  # its number; {(cell, position): output} of those above that have a display id
        self.changed = set()  # places of these that were changed since they were last taken
        self.captured = {}  # {Comm of an ipywidgets.Output: its outputs}
        self.capturing = []  # those of them that take what comes
        self.renewed = {}  # of the first, those that were told of less than they hold
        self.raw, self.read, self.process = {}, {}, None

    def start(self, raw):
        """From now on, in this process; raw: the files that commands and C code write to, {stream: descriptor}."""
        self.raw, self.read, self.process = raw, dict.fromkeys(raw, 0), os.getpid()

    def add(self, output):
        """Append one output, after what commands have written until now."""
        self._collect()
        text = json.dumps(output, default=_plain)
        self._append(json.loads(text), len(text))

    def write(self, name, text):
        """Append text to a stream, after what commands have written until now; a copy of the process does as commands do."""
        if os.getpid() != self.process:
            os.write(self.raw[name], text.encode(errors="replace"))
            return
        self._collect()
        self._write(name, text)

    def update(self, display_id, data, metadata):
        """Show something else wherever this display id is shown, in the cells above, too."""
        new = json.loads(json.dumps({"data": data, "metadata": metadata}, default=_plain))
        for place, output in [*self.shown.items(), *((None, output) for output in self.items)]:
            if display_id and _display_id(output) == display_id:
                kept = place is None or place in self.changed
                more = len(json.dumps(output | new)) - (len(json.dumps(output)) if kept else 0)
                if more < self.left:
                    output.update(new)
                    self.left -= more
                    if place is None:
                        self.held += more
                    else:
                        self.changed.add(place)

    def clear(self, wait):
        """Take back what the cell has shown, at once or when more comes."""
        self._collect()
        if self.capturing:
            self._current().clear()
        elif wait:
            self.clear_next = True
        else:
            self._clear()

    def take(self):
        """The outputs so far, and [cell, position, output] of each above that was changed; the next cell begins with none."""
        self._collect()
        for name, descriptor in self.raw.items():
            if self.read[name]:
                os.lseek(descriptor, 0, os.SEEK_SET)
                os.ftruncate(descriptor, 0)
                self.read[name] = 0
        changed = [[*place, _sent(self.shown[place])] for place in self.changed]
        self.shown.update(((self.cell, n), output) for n, output in enumerate(self.items) if _display_id(output))
        taken = [_sent(output) for output in self.items]
        self.cell += 1
        self._begin()
        return taken, changed

    def tell(self):
        """Tell each ipywidgets.Output what it holds now, as a browser does between cells."""
        renewed, self.renewed = self.renewed, {}
        for widget in renewed:
            state = {"outputs": [_sent(output) for output in self.captured[widget]]}
            data = {"method": "update", "state": state, "buffer_paths": []}
            widget.handle_msg({"content": {"data": data}, "buffers": []})

    def forget(self):
        """Drop them: nobody sees what a called function shows."""
        self.read = {name: os.fstat(descriptor).st_size for name, descriptor in self.raw.items()}
        self._begin()

    def _begin(self):
        self.items, self.held, self.changed, self.clear_next = [], 0, set(), False

    def _collect(self):
        """Append what commands and C code have written since this was last done."""
        for name, descriptor in self.raw.items():
            size = os.fstat(descriptor).st_size
            start, self.read[name] = self.read[name], size  # another thread may be here, too
            if size > start:
                self._write(name, os.pread(descriptor, min(size - start, MOST_OUTPUT), start).decode(errors="replace"))

    def _write(self, name, text):
        size = len(json.dumps(text))
        if size >= self.left:
            text = text[: max(self.left, 0)]
        if text:
            self._append({"output_type": "stream", "name": name, "text": [text]}, size)

    def _append(self, output, size):
        if self.clear_next:
            self._clear()
        if self.left <= 0:
            return
        self.left, self.held = self.left - size, self.held + size
        items = self._current()
        if output["output_type"] == "stream" and items and items[-1].get("name") == output["name"]:
            items[-1]["text"] += output["text"]
        elif output["output_type"] == "stream" or self.left > 0:
            items.append(output)
        if self.left <= 0:
            items.append(CUT | {"text": [CUT["text"]]})

    def _current(self):
        """Where outputs go now."""
        if not self.capturing:
            return self.items
        self.renewed[self.capturing[-1]] = True
        return self.captured[self.capturing[-1]]

    def _clear(self):
        if self.left > 0:  # who has shown too much has done so
            self.left += self.held
        self.items, self.held, self.clear_next = [], 0, False


class OutStream(io.TextIOBase):
    """sys.stdout and sys.stderr of a notebook, with what ipykernel's class of this name has for a student."""

    encoding = "UTF-8"

    def __init__(self, name, outputs, descriptor):
        self.name, self._outputs, self._descriptor, self._closed = name, outputs, descriptor, False

    @property
    def closed(self):
        return self._closed

    def close(self):
        self._closed = True

    def writable(self):
        return True

    def fileno(self):
        return self._descriptor

    def flush(self):
        """Nothing is kept back."""

    def write(self, string):
        if not isinstance(string, str):
            raise TypeError(f"write() argument must be str, not {type(string)}")
        if self._closed:
            raise ValueError("I/O operation on closed file")
        self._outputs.write(self.name, string)
        return len(string)


class Comm(BaseComm):
    """The kernel's end of a widget. Of the other end there is what nbclient plays of a browser: ipywidgets.Output."""

    outputs = None  # the notebook's Outputs

    def publish_msg(self, msg_type, data=None, metadata=None, buffers=None, **keys):
        state = (data or {}).get("state", {})
        if msg_type == "comm_open" and state.get("_model_name") == "OutputModel":
            self.outputs.captured[self] = []
        elif self in self.outputs.captured and "msg_id" in state:
            if state["msg_id"]:
                self.outputs.capturing.append(self)
            else:
                self.outputs.capturing.pop()


def _display_id(output):
    return output.get("transient", {}).get("display_id")


def _sent(output):
    """An output as nbformat has it."""
    text = {"text": "".join(output["text"])} if output["output_type"] == "stream" else {}
    return {key: value for key, value in output.items() if key != "transient"} | text


def _plain(value):
    """What JSON has no form for: bytes as Jupyter sends them, anything else by its name."""
    return base64.b64encode(value).decode() if isinstance(value, bytes) else repr(value)


OutStream.__module__ = "ipykernel.iostream"  # by which some libraries know that they are in a notebook
