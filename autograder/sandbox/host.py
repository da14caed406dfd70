"""The grader's side of a sandbox: start it, run a notebook's cells in it, call the notebook's functions."""

import base64
import secrets
import socket
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

from transform_lab import codec
from transform_lab.verdict import Reply

from ..outputs import printable
from . import bubblewrap
from .channel import Channel, Closed, Garbled, Late

HERE = Path(__file__).parent


@dataclass(frozen=True)
class Limits:
    """What a notebook may use. Seconds are of wall time.

    A call or a cell that reaches its limit costs itself; a notebook that does costs its exercises from there on.
    """

    cell: float = 10.0
    call: float = 3.0
    notebook: float = 90.0
    grace: float = 1.0  # between the interrupt and the end of the process
    start: float = 60.0
    memory: int = 2_000_000_000  # bytes of address space for each process
    processes: int = 100
    file: int = 20_000_000  # bytes of one file

    def resources(self):
        """For resource.setrlimit, inside the sandbox."""
        return {
            "RLIMIT_AS": self.memory,
            "RLIMIT_FSIZE": self.file,
            "RLIMIT_CORE": 0,
            "RLIMIT_NPROC": self.processes,
        }


class Ended(Exception):
    """The notebook's process is gone: "timeout" when it did not heed the interrupt, else "killed"."""

    def __init__(self, status):
        super().__init__(status)
        self.status = status


@dataclass
class CellRun:
    """What running one cell gave, as nbformat outputs (dictionaries; not validated yet)."""

    outputs: list = field(default_factory=list)
    execution_count: int | None = None
    ended: bool = False  # the cell called exit() or quit()


class Sandbox:
    """One submission's sandbox: a context manager whose `notebook()` gives a fresh process for each notebook.

    package: the folder of the students' package `transform_lab`
    files: what the student handed in besides notebooks, {relative path: bytes}
    isolated: False runs the student's code unprotected, as this very user (for the demo, or when asked to)
    """

    def __init__(self, package, files=None, limits=Limits(), isolated=True):
        self.package, self.files, self.limits, self.isolated = package, files or {}, limits, isolated
        self.process = self.control = self.folder = self.errors = None

    def __enter__(self):
        self._start()
        return self

    def __exit__(self, *_):
        self._stop()

    def notebook(self, deadline=None):
        """A fresh NotebookProcess; starts the sandbox again if the student's code brought it down.

        deadline: when the notebook's time is over (time.monotonic), for one that is run again
        """
        if self.process.poll() is not None:
            self._stop()
            self._start()
        return NotebookProcess(self, deadline or time.monotonic() + self.limits.notebook)

    def said(self):
        """The end of what the worker itself wrote: the reason, when it failed."""
        self.errors.seek(0)
        return " ".join(self.errors.read().decode(errors="replace").split())[-500:]

    def _start(self):
        self.control, inside = socket.socketpair()
        arguments, folder = [sys.executable, "-I", "-B", "-X", "utf8", "-c"], None
        if self.isolated:
            arguments = [*bubblewrap.command(self.package), *arguments]
            paths = [str(bubblewrap.WORKER), str(bubblewrap.COURSE / "transforms")]
        else:
            # Without bubblewrap: a folder of its own with the same files, which is tidy, but protects nothing.
            self.folder = tempfile.TemporaryDirectory(prefix="notebook-")
            folder = Path(self.folder.name, "transforms")
            (folder / self.package.name).mkdir(parents=True)
            for path in bubblewrap.package_files(self.package):
                (folder / self.package.name / path.name).write_bytes(path.read_bytes())
            paths = [str(HERE), str(folder)]
        start = f"import sys; sys.path[:0] = {paths!r}; import worker; worker.main()"
        environment = {"OPENBLAS_NUM_THREADS": "1", "PATH": "/usr/bin:/bin", "LANG": "C.UTF-8", "HOME": "/tmp"}
        environment |= {"TRANSFORM_LAB_GRADING": "1", "MPLBACKEND": "module://matplotlib_inline.backend_inline"}
        if not self.isolated:
            environment["HOME"] = self.folder.name
        # The errors of the worker itself (a Python that does not start) are this machine's, and worth reading.
        self.errors = tempfile.TemporaryFile()
        self.process = subprocess.Popen(
            [*arguments, start], stdin=inside, stdout=self.errors, stderr=self.errors, cwd=folder
        )
        inside.close()
        settings = {
            "limits": self.limits.resources() if self.isolated else {},
            "environment": environment,
            "files": {path: base64.b64encode(content).decode() for path, content in self.files.items()},
            "isolated": self.isolated,
        }
        try:
            grader = Channel(self.control)
            grader.send(settings)
            grader.receive(time.monotonic() + self.limits.start)
        except (Closed, Late, Garbled, OSError) as error:
            self._stop()
            raise RuntimeError(f"the sandbox did not start: {self.said() or 'no answer in time'}") from error

    def _stop(self):
        self.control.close()
        if self.isolated:
            self.process.kill()  # with the namespace's first process, all others in it end
        try:
            self.process.wait(self.limits.start)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        if self.folder:
            self.folder.cleanup()


class NotebookProcess:
    """One notebook's process in a sandbox: a context manager with `run_cell` and `call`."""

    def __init__(self, sandbox, deadline):
        self.sandbox, self.limits, self.deadline = sandbox, sandbox.limits, deadline
        connection, inside = socket.socketpair()
        connection.settimeout(self.limits.grace + 5)  # for sending to a process that does not read
        self.channel = Channel(connection)
        self.gone = False  # whether its process had to be stopped, or died
        socket.send_fds(sandbox.control, [b"S"], [inside.fileno()])
        inside.close()

    def __enter__(self):
        return self

    @property
    def exhausted(self):
        """Whether the notebook's time is over."""
        return time.monotonic() >= self.deadline

    def __exit__(self, *_):
        self.channel.connection.close()
        try:
            self.sandbox.control.sendall(b"K")
            self.sandbox.control.settimeout(self.limits.grace + 5)
            answer = self.sandbox.control.recv(1)
        except OSError:
            answer = b""
        if answer != b"k":
            self.sandbox.process.kill()  # the next notebook gets a new sandbox
            self.sandbox.process.wait()

    def run_cell(self, source):
        """Run a cell; raises Ended when its process had to be stopped or died."""
        reply = self._request("run_cell", [source], self.limits.cell)
        try:
            outputs = [dict(output) for output in reply["outputs"]]
            count = reply["execution_count"]
            return CellRun(outputs, count if type(count) is int else None, reply["ended"] is True)
        except (KeyError, TypeError, ValueError) as error:
            raise self._ended("killed") from error

    def call(self, name, args, kwargs):
        """Call the notebook's function `name` with plain arguments: a Reply; "timeout" or "killed" are outcomes."""
        try:
            reply = self._request("call", [name, args, kwargs], self.limits.call)
        except Ended as ended:
            return Reply(ended.status)
        outcome, error, printed = reply.get("outcome"), reply.get("error", ""), reply.get("printed", "")
        try:
            codec.decode(reply.get("value"))
            known = outcome in ("returned", "raised", "not done", "undefined", "timeout")
            if not known or not isinstance(error, str) or not isinstance(printed, str):
                raise codec.NotPlain("an unknown outcome")
        except codec.NotPlain:
            self.gone = True  # no executor of ours writes that
            return Reply("killed")
        return Reply(outcome, reply.get("value"), reply.get("arguments"), printable(error[:300]), printed[:300])

    def _request(self, action, arguments, seconds):
        nonce = secrets.token_hex(16)
        now = time.monotonic()
        if self.gone or now >= self.deadline:
            raise self._ended("timeout")
        deadline = min(now + seconds, self.deadline)
        try:
            self.channel.send({"nonce": nonce, "action": action, "arguments": arguments})
            try:
                return self.channel.answer_to(nonce, deadline)
            except Late:
                self.sandbox.control.sendall(b"I")
                return self.channel.answer_to(nonce, deadline + self.limits.grace)
        except Late as error:
            raise self._ended("timeout") from error
        except (Closed, Garbled, OSError) as error:
            raise self._ended("killed") from error

    def _ended(self, status):
        self.gone = True
        return Ended(status)
