"""Runs the cells of one notebook as Jupyter would, and calls its functions. Lives inside the sandbox.

The outputs are nbformat's; they are meant to be what ipykernel gives for the same cells: streams, display and update,
clear_output, figures, magics, `!commands`, top-level await.
"""

import asyncio
import base64
import builtins
import contextlib
import ctypes
import json
import os
import random
import signal
import sys
import tempfile
from pathlib import Path

import numpy as np
from IPython.core.display_trap import DisplayTrap
from IPython.core.displayhook import DisplayHook
from IPython.core.displaypub import DisplayPublisher
from IPython.core.error import StdinNotImplementedError
from IPython.core.interactiveshell import InteractiveShell
from traitlets import Any
from traitlets.config import Config
from transform_lab.judging.calling import call, one_line
from transform_lab.judging.verdict import Reply

MOST_OUTPUT = 2_000_000  # bytes of output a notebook may make


class Outputs:
    """The outputs of the cell that runs now; what all cells of a notebook may say together is bounded."""

    def __init__(self):
        self.items, self.left, self.clear_next = [], MOST_OUTPUT, False

    def add(self, output):
        """Append one output; text of the same stream as before is joined to it."""
        if self.clear_next:
            self.items, self.clear_next = [], False
        if self.left <= 0:
            return
        text = json.dumps(output, default=_plain)
        output = json.loads(text)
        self.left -= len(text)
        if self.left <= 0:
            output = {"output_type": "stream", "name": "stderr", "text": "[more output than the grader keeps]\n"}
        last = self.items[-1] if self.items else {}
        if output["output_type"] == "stream" and last.get("name") == output["name"] and last["output_type"] == "stream":
            last["text"] += output["text"]
        else:
            self.items.append(output)

    def clear(self, wait):
        if wait:
            self.clear_next = True
        else:
            self.items.clear()

    def take(self):
        """The outputs so far, without what only the executor needs; the next cell begins with none."""
        taken, self.items, self.clear_next = self.items, [], False
        return [{key: value for key, value in output.items() if key != "transient"} for output in taken]


def _plain(value):
    """What JSON has no form for: bytes as Jupyter sends them, anything else by its name."""
    return base64.b64encode(value).decode() if isinstance(value, bytes) else repr(value)


class Stream:
    """sys.stdout and sys.stderr of the notebook."""

    encoding, errors = "utf-8", "replace"

    def __init__(self, name, outputs, descriptor):
        self.name, self._outputs, self._descriptor = f"<{name}>", outputs, descriptor
        self._stream = name

    def write(self, text):
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        for start in range(0, min(len(text), 2 * MOST_OUTPUT), 100_000):
            self._outputs.add({"output_type": "stream", "name": self._stream, "text": text[start : start + 100_000]})
        return len(text)

    def writelines(self, lines):
        for line in lines:
            self.write(line)

    def flush(self):
        """Nothing is kept back."""

    def isatty(self):
        return False

    def fileno(self):
        return self._descriptor


class Publisher(DisplayPublisher):
    """Turns `display(…)` into outputs."""

    outputs = Any()

    def publish(self, data, metadata=None, *, transient=None, update=False, **_):
        transient = transient or {}
        if update:
            for output in self.outputs.items:
                if output.get("transient", {}).get("display_id") == transient.get("display_id"):
                    output["data"], output["metadata"] = data, metadata or {}
            return
        self.outputs.add(
            {"output_type": "display_data", "data": data, "metadata": metadata or {}, "transient": transient}
        )

    def clear_output(self, wait=False):
        self.outputs.clear(wait)


class Hook(DisplayHook):
    """Turns the value of a cell's last line into an output."""

    outputs = Any()

    def write_output_prompt(self):
        """Jupyter shows the prompt itself."""

    def write_format_data(self, format_dict, md_dict=None):
        self.outputs.add(
            {
                "output_type": "execute_result",
                "execution_count": self.prompt_count,
                "data": dict(format_dict),
                "metadata": md_dict or {},
            }
        )

    def finish_displayhook(self):
        """Jupyter ends the line itself."""


class Shell(InteractiveShell):
    """IPython without a terminal, a history file or a keyboard."""

    outputs = Any()
    ended = False

    def init_display_pub(self):
        self.display_pub = Publisher(parent=self, shell=self, outputs=self.outputs)

    def init_displayhook(self):
        self.displayhook = Hook(parent=self, shell=self, outputs=self.outputs)
        self.display_trap = DisplayTrap(hook=self.displayhook)

    def _showtraceback(self, etype, evalue, stb):
        self.outputs.add(
            {"output_type": "error", "ename": str(etype.__name__), "evalue": str(evalue), "traceback": list(stb)}
        )

    def ask_exit(self):
        self.ended = True

    def enable_gui(self, gui=None):
        """There is no window to show anything in."""


class Interrupted(KeyboardInterrupt):
    """The grader's time limit; shown as one line, since where the cell happened to be says little."""

    def _render_traceback_(self):
        return [str(self)]


NO_HISTORY = Config(HistoryManager={"enabled": False})  # nothing to look back to, and no thread that writes it down


class Executor:
    """One notebook: its namespace, its outputs, and the student's functions."""

    def __init__(self):
        """All that can be made before it is known which notebook is run."""
        self.outputs = Outputs()
        self.shell = Shell.instance(outputs=self.outputs, colors="nocolor", config=NO_HISTORY)
        self.shell.user_ns["exit"] = self.shell.user_ns["quit"] = self._exit
        builtins.input = _no_input
        self.libc = ctypes.CDLL(None)
        self.running = False

    def start(self, files):
        """The rest, in the notebook's own process and folder.

        files: what the student handed in besides notebooks, {path relative to the folder: bytes as base64}
        """
        random.seed()
        np.random.seed()
        signal.signal(signal.SIGINT, self._interrupt)
        self.raw = [tempfile.TemporaryFile() for _ in ("stdout", "stderr")]  # what C code and commands write
        for descriptor, file in enumerate(self.raw, start=1):
            os.dup2(file.fileno(), descriptor)
        sys.stdout, sys.stderr = Stream("stdout", self.outputs, 1), Stream("stderr", self.outputs, 2)
        self.loop = asyncio.new_event_loop()
        asyncio.set_event_loop(self.loop)
        # Only now: a student's own numpy.py must not become the grader's.
        for path, content in files.items():
            with contextlib.suppress(OSError):  # a file that cannot be made here must not cost the notebook
                Path(path).parent.mkdir(parents=True, exist_ok=True)
                Path(path).write_bytes(base64.b64decode(content))
        sys.path.insert(0, "")  # as in Jupyter: modules beside the notebook

    def prepare(self, source):
        """Run lines of the grader's before the first cell; they have no outputs, and do not count."""
        exec(source, self.shell.user_ns)
        return {}

    def run_cell(self, source):
        """Run one cell: {"outputs", "execution_count", "ended", "failed"}."""
        failed = True
        try:
            self.running = True
            # A Jupyter cell runs inside an event loop: `await` works, asyncio.run says that a loop is running.
            failed = not self.loop.run_until_complete(self._run(source))
        except KeyboardInterrupt:  # IPython shows those of the cell itself; this one came between two steps of its own
            self.shell.showtraceback()
        finally:
            self.running = False
        self._collect_raw()
        return {
            "outputs": self.outputs.take(),
            "execution_count": self.shell.execution_count - 1,
            "ended": self.shell.ended,
            "failed": failed,
        }

    def calls(self, name, cases):
        """Call a function of the notebook with the plain arguments of each case, [args, kwargs]; nobody sees what it prints.

        Yields a transform_lab.judging.verdict.Reply to each as a dictionary, with whether its arguments were "changed" in
        their stead; the first that neither returned nor raised is the last.
        """
        function = self.shell.user_ns.get(name)
        for args, kwargs in cases:
            reply = self._call(function, args, kwargs)
            yield reply
            if not Reply(reply["outcome"]).finished:
                break

    def _call(self, function, args, kwargs):
        if not callable(function):
            return {"outcome": "undefined"}
        try:
            self.running = True
            reply = vars(call(function, args, kwargs))
            return reply | {"arguments": None, "changed": reply["arguments"] not in (None, [args, kwargs])}
        except KeyboardInterrupt:
            return {"outcome": "timeout"}
        except BaseException as error:  # SystemExit and whatever a student derived from BaseException
            return {"outcome": "raised", "error": one_line(error)}
        finally:
            self.running = False
            self.outputs.take()

    async def _run(self, source):
        """As ipykernel does it; whether it ran without an error."""
        shell, problem = self.shell, None
        try:
            cell = shell.transform_cell(source)
        except Exception:  # of a transformer that the student has put in: shown as the cell's error
            cell, problem = source, sys.exc_info()
        result = await shell.run_cell_async(
            source, store_history=True, transformed_cell=cell, preprocessing_exc_tuple=problem
        )
        shell.events.trigger("post_execute")  # figures are shown here
        shell.events.trigger("post_run_cell", result)
        return result.success

    def _exit(self, *_, **__):
        self.shell.ask_exit()

    def _interrupt(self, *_):
        if self.running:
            raise Interrupted("The grader stopped this cell: it took too long.")

    def _collect_raw(self):
        self.libc.fflush(None)
        for name, file in zip(("stdout", "stderr"), self.raw):
            file.seek(0)
            text = file.read(MOST_OUTPUT).decode(errors="replace")
            file.seek(0)
            file.truncate()
            if text:
                self.outputs.add({"output_type": "stream", "name": name, "text": text})


def _no_input(prompt=""):
    raise StdinNotImplementedError("raw_input was called, but this frontend does not support input requests.")
