"""The first process inside a sandbox: loads what notebooks need once, then forks a process for each notebook.

It obeys the grader on one socket (its standard input). A notebook's own process gets a socket of its own, so nothing
that one notebook leaves behind can speak for another.
"""

import base64
import os
import random
import resource
import signal
import socket
import sys
from pathlib import Path

from channel import Channel, Closed


def main():
    """Serve until the grader goes away."""
    control = socket.socket(fileno=os.dup(0))
    null = os.open(os.devnull, os.O_RDONLY)
    os.dup2(null, 0)
    os.close(null)
    settings = Channel(control).receive()
    _limit(settings["limits"])
    os.environ.update(settings["environment"])

    # Loaded here, once for all notebooks: these modules are most of a notebook's start.
    import numpy.random  # noqa: F401
    import scipy.spatial.transform  # noqa: F401
    from executor import Executor

    # Only now: a student's own numpy.py must not become the grader's.
    for path, content in settings["files"].items():
        target = Path(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(base64.b64decode(content))
    sys.path.remove(str(Path(__file__).parent))
    for module in ("channel", "executor", "worker"):
        del sys.modules[module]  # a student's helper may have that name
    sys.path.insert(0, "")  # as in Jupyter: modules beside the notebook

    Channel(control).send({"ready": True})
    Worker(control, settings["isolated"], Executor).serve()


def _limit(limits):
    for name, amount in limits.items():
        resource.setrlimit(getattr(resource, name), (amount, amount))


class Worker:
    """Starts, interrupts and stops the notebook's process, one at a time."""

    def __init__(self, control, isolated, executor):
        self.control, self.isolated, self.executor = control, isolated, executor
        self.notebook = None

    def serve(self):
        while True:
            try:
                data, descriptors, _, _ = socket.recv_fds(self.control, 1, 1)
            except OSError:
                data = b""
            if data == b"S":
                self.start(descriptors[0])
            elif data == b"I" and self.notebook:
                os.kill(self.notebook, signal.SIGINT)
            elif data == b"K":
                self.stop()
                self.control.send(b"k")
            else:
                self.stop()
                return

    def start(self, descriptor):
        self.notebook = os.fork()
        if self.notebook == 0:
            self.control.close()
            os.setsid()
            run_notebook(socket.socket(fileno=descriptor), self.executor())
        os.close(descriptor)

    def stop(self):
        """End the notebook's process and all it started."""
        if self.notebook:
            for kill in (os.killpg, os.kill):  # the group may not exist yet, right after the fork
                try:
                    kill(self.notebook, signal.SIGKILL)
                except ProcessLookupError:
                    continue
            os.waitpid(self.notebook, 0)
        if self.isolated:
            try:
                os.kill(-1, signal.SIGKILL)  # all but itself and the namespace's init: daemons, too
            except ProcessLookupError:
                self.notebook = None
        self.notebook = None


def run_notebook(connection, executor):
    """The life of a notebook's process: answer requests until the grader hangs up."""
    import numpy as np

    random.seed()
    np.random.seed()
    grader = Channel(connection)
    actions = {"run_cell": executor.run_cell, "call": executor.call}
    while True:
        try:
            request = grader.receive()
            reply = actions[request["action"]](*request["arguments"])
            grader.send({"nonce": request["nonce"], **reply})
        except Closed:
            os._exit(0)
