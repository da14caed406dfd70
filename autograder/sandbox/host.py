"""The grader's side of a sandbox: start it, run a notebook's cells in it, call the notebook's functions."""

import base64
import os
import secrets
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

from transform_lab.judging import codec
from transform_lab.judging.verdict import Reply

from .. import ASSIGNMENT
from ..untrusted import printable
from .account import Account
from .bounds import COURSE, PATIENCE, Limits, NotStarted
from .bubblewrap import Namespaces, copy_code
from .channel import Channel, Closed, Garbled, Late
from .watch import UserWatch, Watch

NOBODY = 100_000  # when the grader is root, each notebook runs as a user of its own: this number and up
GLANCE = 0.25  # seconds between two looks at what a sandbox uses
ENVIRONMENT = {
    "OPENBLAS_NUM_THREADS": "1",
    "PATH": "/usr/bin:/bin",
    "LANG": "C.UTF-8",
    "TRANSFORM_LAB_GRADING": "1",
    "MPLBACKEND": "module://matplotlib_inline.backend_inline",
}


class Ended(Exception):
    """The notebook's process is gone: "timeout" when it did not heed the interrupt, else "killed"; why, in words."""

    def __init__(self, status, reason):
        super().__init__(reason)
        self.status, self.reason = status, reason


@dataclass
class CellRun:
    """What running one cell gave, as nbformat outputs (dictionaries; not validated yet)."""

    outputs: list = field(default_factory=list)
    execution_count: int | None = None
    ended: bool = False  # the cell called exit() or quit()
    failed: bool = False  # it raised an error


class ForkServer:
    """The grader's handle on a forkserver.py, which loads while the grader goes on, and lives as long as the grader.

    Processes that are forked from the grader use it, too: each request carries the socket that its answer comes over.
    package: the folder of the students' package `transform_lab`
    """

    current = None

    @classmethod
    def serving(cls, package):
        """The one that runs, or a new one."""
        if not (cls.current and cls.current.package == package and cls.current.alive()):
            cls.current = cls(package)
        return cls.current

    def __init__(self, package):
        self.package = package
        self.code = copy_code(package)
        self.control, inside = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        start = f"import sys; sys.path.insert(0, {str(self.code)!r}); import forkserver; forkserver.main()"
        self.errors = tempfile.TemporaryFile()  # of a Python that does not start: this machine's, and worth reading
        self.process = subprocess.Popen(
            [sys.executable, "-I", "-B", "-X", "utf8", "-c", start],
            stdin=inside,
            stdout=self.errors,
            stderr=self.errors,
            env=ENVIRONMENT,
            cwd="/",
            start_new_session=True,  # Ctrl-C is for the grader
        )
        inside.close()

    def alive(self):
        try:
            return self.control.recv(1, socket.MSG_PEEK | socket.MSG_DONTWAIT) != b""
        except BlockingIOError:
            return True
        except OSError:
            return False

    def fork(self, connection, namespaces=None):
        """Start a notebook's process that speaks over `connection` (the far end of a socket), inside `namespaces`."""
        handles = [connection.fileno(), *([namespaces.pidfd] if namespaces else [])]
        socket.send_fds(self.control, [b"F"], handles)

    def said(self):
        """The end of what it wrote: why it failed, or why a notebook's process did before it ran anything."""
        self.errors.seek(0)
        return " ".join(self.errors.read().decode(errors="replace").split())[-300:]


class Sandbox:
    """Where one submission is run: a context manager whose `notebook()` gives a fresh sandbox for each notebook.

    package: the folder of the students' package `transform_lab`
    files: what the student handed in besides notebooks, {relative path: bytes}
    isolated: True keeps it in namespaces of its own; "user" only makes it a user of its own (see account.py); False
        runs the student's code unprotected, as this very user (for the demo, or when asked to)
    """

    def __init__(self, package, files=None, limits=Limits(), isolated=True):
        self.package, self.limits, self.isolated = package, limits, isolated
        self.files = {path: base64.b64encode(content).decode() for path, content in (files or {}).items()}

    def __enter__(self):
        self.deadline = time.monotonic() + self.limits.submission
        return self

    def __exit__(self, *_):
        """Each notebook has cleaned up after itself."""

    def notebook(self, deadline=None):
        """A NotebookProcess in a new sandbox.

        deadline: when the notebook's time is over (time.monotonic), for one that is run again
        """
        return NotebookProcess(self, min(deadline or time.monotonic() + self.limits.notebook, self.deadline))


class NotebookProcess:
    """One notebook's process and all around it: a context manager with `run_cell` and `call`."""

    def __init__(self, sandbox, deadline):
        self.limits, self.deadline = sandbox.limits, deadline
        self.gone, self.glanced = False, time.monotonic()  # gone: whether its process had to be stopped, or died
        self.namespaces = self.account = self.folder = self.pid = self.handle = self.watch = None
        connection, inside = socket.socketpair()
        connection.settimeout(PATIENCE)
        self.channel = Channel(connection)
        settings = {"files": sandbox.files, "isolated": sandbox.isolated}
        server = ForkServer.serving(sandbox.package)
        try:
            if sandbox.isolated == "user":
                self.account = Account(server.code / sandbox.package.name)
                settings |= {"limits": self.limits.resources(), "number": self.account.number}
                settings |= {"folder": str(self.account.folder), "environment": {"HOME": str(self.account.home)}}
            elif sandbox.isolated:
                self.namespaces = Namespaces(server.code)
                settings |= {"limits": self.limits.resources(), "number": NOBODY + self.namespaces.pid}
                settings |= {"folder": str(COURSE / ASSIGNMENT), "environment": {"HOME": "/tmp"}}
            else:
                # A folder of its own with the same files, which is tidy, but protects nothing.
                self.folder = tempfile.TemporaryDirectory(prefix="notebook-", ignore_cleanup_errors=True)
                folder = Path(self.folder.name, ASSIGNMENT)
                shutil.copytree(server.code / sandbox.package.name, folder / sandbox.package.name)
                settings |= {"limits": {}, "folder": str(folder), "environment": {"HOME": self.folder.name}}
            server.fork(inside, self.namespaces)
            inside.close()
            self._meet(connection)
            self.channel.send(settings)
            self.channel.receive(time.monotonic() + PATIENCE)
            connection.settimeout(self.limits.grace + 5)  # for sending to a process that does not read
        except (Closed, Late, Garbled, OSError) as error:
            self.__exit__()
            reason = str(error) or server.said() or type(error).__name__
            raise NotStarted(f"a notebook's process did not start: {reason}") from error
        except BaseException:
            self.__exit__()
            raise

    def _meet(self, connection):
        """Learn from the guard which process it started."""
        message, handles, _, _ = socket.recv_fds(connection, 200, 1)
        if message[:1] != b"P":
            raise OSError(message[1:].decode(errors="replace") or "its fork server ended")
        self.pid, self.handle = int(message[1:]), handles[0] if handles else None
        if self.namespaces:
            self.watch = Watch(self.namespaces.pid, self.pid, self.limits)
        elif self.account:
            self.watch = UserWatch(self.account.number, self.pid, self.limits)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.channel.connection.close()
        if self.namespaces:
            self.namespaces.close()
        elif self.account:
            self.account.close()
        elif self.pid:
            try:
                os.killpg(self.pid, signal.SIGKILL)
            except (ProcessLookupError, PermissionError):
                pass  # it has ended by itself
        if self.handle is not None:
            os.close(self.handle)
        if self.folder:
            self.folder.cleanup()

    @property
    def exhausted(self):
        """Whether the notebook's time is over."""
        return time.monotonic() >= self.deadline

    def prepare(self, source):
        """Run lines of the grader's own before the first cell; raises Ended as `run_cell`."""
        self._request("prepare", [source], self.limits.cell)

    def run_cell(self, source):
        """Run a cell; raises Ended when its process had to be stopped or died."""
        reply = self._request("run_cell", [source], self.limits.cell)
        try:
            outputs = [dict(output) for output in reply["outputs"]]
            count = reply["execution_count"]
            return CellRun(
                outputs, count if type(count) is int else None, reply["ended"] is True, reply.get("failed") is True
            )
        except (KeyError, TypeError, ValueError) as error:
            raise self._ended("killed", "its process gave an answer that the grader's own code never gives") from error

    def call(self, name, args, kwargs):
        """Call the notebook's function `name` with plain arguments: a Reply; "timeout" or "killed" are outcomes."""
        try:
            reply = self._request("call", [name, args, kwargs], self.limits.call)
        except Ended as ended:
            return Reply(ended.status, error=ended.reason)
        outcome, error, printed = reply.get("outcome"), reply.get("error", ""), reply.get("printed", "")
        try:
            codec.decode(reply.get("value"))
            known = outcome in ("returned", "raised", "not done", "undefined", "timeout")
            if not known or not isinstance(error, str) or not isinstance(printed, str):
                raise codec.NotPlain("an unknown outcome")
        except codec.NotPlain:
            forged = self._ended("killed", "its process gave an answer that the grader's own code never gives")
            return Reply(forged.status, error=forged.reason)
        return Reply(outcome, reply.get("value"), reply.get("arguments"), printable(error[:300]), printed[:300])

    def _request(self, action, arguments, seconds):
        nonce = secrets.token_hex(16)
        if self.gone or self.exhausted:
            raise self._ended("timeout", "the notebook's time was over")
        if time.monotonic() - self.glanced > GLANCE and (excess := self._excess()):
            raise self._ended("killed", f"it used {excess}")
        try:
            self.channel.send({"nonce": nonce, "action": action, "arguments": arguments})
            try:
                return self._answer(nonce, seconds)
            except Late:
                self._interrupt()
                return self._answer(nonce, self.limits.grace, time.monotonic() + self.limits.grace)
        except Late as error:
            raise self._ended("timeout", "it took too long, and did not heed the interrupt") from error
        except Closed as error:
            raise self._ended("killed", "its process ended all of a sudden") from error
        except (Garbled, OSError) as error:
            raise self._ended("killed", "its process sent what the grader's own code never sends") from error

    def _answer(self, nonce, seconds, latest=None):
        """The answer to a request; raises Late after `seconds` in which the notebook's process could run."""
        latest = latest or self.deadline
        start, waited = time.monotonic(), None
        until = min(start + seconds, latest)
        while True:
            try:
                return self.channel.answer_to(nonce, min(time.monotonic() + GLANCE, until))
            except Late:
                if excess := self._excess():
                    raise self._ended("killed", f"it used {excess}")
                if waited is None:
                    waited = self.watch.waited() if self.watch else 0.0
                elif self.watch:  # others kept the processor busy: that time is given back
                    until = min(start + seconds + self.watch.waited() - waited, latest)
                if time.monotonic() >= until:
                    raise

    def _excess(self):
        self.glanced = time.monotonic()
        return self.watch.excess() if self.watch else None

    def _interrupt(self):
        try:
            if self.handle is not None:
                signal.pidfd_send_signal(self.handle, signal.SIGINT)
            else:
                os.kill(self.pid, signal.SIGINT)
        except ProcessLookupError:
            pass  # it has just ended; the channel tells

    def _ended(self, status, reason):
        self.gone = True
        return Ended(status, reason)
