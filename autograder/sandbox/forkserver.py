"""A Python that has loaded what notebooks need, and forks a process into a sandbox for each of them.

Starting Python with NumPy, SciPy and IPython takes most of a second of a processor; forking takes a few milliseconds.
It is a program of its own, beside the grader: no file, variable or object of the grader is in its memory, and so none
is in a notebook's. It runs from a copy of its code and of the students' package, which is mounted in every sandbox.

    grader --connection, sandbox--> fork server --fork, enter the sandbox--> the notebook's process
"""

import ctypes
import gc
import json
import os
import resource
import shutil
import signal
import socket
import sys
import tempfile
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from channel import EXPECT, FORK, FORK_LARGER, Channel, Closed

CLONE_NEWUSER, CLONE_NEWPID = 0x10000000, 0x20000000
NAMESPACES = 0x00020000 | 0x04000000 | 0x08000000 | 0x40000000 | 0x02000000  # mounts, host name, IPC, network, cgroups
PR_SET_PDEATHSIG, PR_SET_DUMPABLE, PR_CAPBSET_DROP, PR_SET_THP_DISABLE = 1, 4, 24, 41
LAST_CAPABILITY = 63


def main():
    """Serve until the grader goes away; then remove the folder that this file lies in, a copy made for this process."""
    here = Path(__file__).parent
    control = socket.socket(fileno=os.dup(0))
    null = os.open(os.devnull, os.O_RDWR)
    os.dup2(null, 0)
    libc = ctypes.CDLL(None, use_errno=True)
    own = os.open("/proc/self/ns/pid", os.O_RDONLY) if sys.platform == "linux" else None
    server, larger = os.getpid(), None
    try:
        executor, put_on_filter = _load()
        signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # nobody waits for what is forked
        while True:
            command, descriptors, _, _ = socket.recv_fds(control, 1, 2)
            if not command:
                return
            if command == FORK_LARGER and not larger:
                larger, its_control = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
                if os.fork() == 0:  # this one goes on as the larger server, each fork of which costs more
                    _die_with_parent(libc)
                    control, larger, command = its_control, None, None
                    _load_more()
                else:
                    its_control.close()
            if command == EXPECT:
                executor.shell.expect(json.loads(Path(f"/proc/self/fd/{descriptors[0]}").read_text(encoding="utf-8")))
                gc.collect()
                gc.freeze()
                if larger:
                    socket.send_fds(larger, [EXPECT], descriptors)
            elif command == FORK_LARGER:
                socket.send_fds(larger, [FORK], descriptors)
            elif command == FORK and len(descriptors) == 1:
                _start(libc, executor, put_on_filter, *descriptors)
            elif command == FORK and os.getuid() == 0:
                _start(libc, executor, put_on_filter, *descriptors)
                _enter(libc, own, CLONE_NEWPID)
            elif command == FORK and os.fork() == 0:  # who has no right to come back does not leave
                _guard(libc, executor, put_on_filter, *descriptors)
            for descriptor in descriptors:
                os.close(descriptor)
    finally:
        if os.getpid() == server:
            shutil.rmtree(here, ignore_errors=True)


def _load():
    """Import what notebooks use, and set IPython up."""
    with _home():
        import numpy.ma
        import numpy.random  # noqa: F401
        from executor import Executor

        put_on_filter = None
        if sys.platform == "linux":
            from seccomp import compiled, put_on

            put_on_filter = partial(put_on, program=compiled())
        executor = Executor()
    here = Path(__file__).parent
    for path in here.glob("*.py"):
        sys.modules.pop(path.stem, None)  # a student's helper may have that name
    sys.path.remove(str(here))
    return executor, put_on_filter


def _load_more():
    with _home():
        import matplotlib.backends.backend_agg
        import matplotlib.pyplot  # noqa: F401
        import scipy.spatial.transform  # noqa: F401


@contextmanager
def _home():
    """A home folder for the configuration that libraries write; gone again before a notebook sees it."""
    home = tempfile.mkdtemp(prefix="notebook-")
    os.environ["HOME"] = home
    try:
        yield
    finally:
        shutil.rmtree(home)
        os.environ["HOME"] = "/tmp"
        gc.collect()
        gc.freeze()  # what is loaded stays shared with the processes that are forked


def _guard(libc, executor, put_on_filter, connection, sandbox):
    """Enter the sandbox (in one step: the first would take away the right to the others) and start the notebook there."""
    _die_with_parent(libc)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    try:
        try:
            _enter(libc, sandbox, CLONE_NEWUSER | CLONE_NEWPID | NAMESPACES)
        except OSError as error:
            os.write(connection, f"E{error}".encode())
            return
        _start(libc, executor, put_on_filter, connection)
        os.closerange(0, os.sysconf("SC_OPEN_MAX"))
        os.wait()
    finally:
        os._exit(0)


def _start(libc, executor, put_on_filter, connection, sandbox=None):
    """Fork the notebook's process, into the sandbox if there is one, and tell the grader which it is."""
    grader = socket.socket(fileno=os.dup(connection))
    try:
        if sandbox is not None:
            _enter(libc, sandbox, CLONE_NEWPID)  # holds for the children of this process alone
        child = os.fork()
        if child == 0:
            try:
                if sandbox is not None:
                    _enter(libc, sandbox, NAMESPACES)
                _notebook(libc, executor, put_on_filter, grader)
            finally:
                os._exit(1)  # whatever was raised: this process goes no other way
        handle = [os.pidfd_open(child)] if hasattr(os, "pidfd_open") else []
        socket.send_fds(grader, [f"P{child:>20}".encode()], handle)
        for descriptor in handle:
            os.close(descriptor)
    except OSError as error:
        grader.sendall(f"E{error}".encode())
    finally:
        grader.close()


def _enter(libc, sandbox, namespaces):
    if libc.setns(sandbox, namespaces) != 0:
        number = ctypes.get_errno()
        raise OSError(number, f"entering the sandbox: {os.strerror(number)}")


def _die_with_parent(libc):
    if sys.platform == "linux":
        libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL)


def _notebook(libc, executor, put_on_filter, connection):
    """The life of a notebook's process: answer requests until the grader hangs up."""
    _die_with_parent(libc)
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    os.setsid()
    os.closerange(3, connection.fileno())
    os.closerange(connection.fileno() + 1, os.sysconf("SC_OPEN_MAX"))
    grader = Channel(connection, most=None)
    try:
        settings = grader.receive()
        for name, amount in settings["limits"].items():
            resource.setrlimit(getattr(resource, name), (amount, amount))
        if settings["isolated"]:
            libc.prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0)  # one that is unmapped in part stays, and counts for nobody
            _become_nobody(libc, settings["number"])
            _die_with_parent(libc)  # another user's process no longer would
            put_on_filter(libc)
        os.environ.update(settings["environment"])
        os.chdir(settings["folder"])
        executor.start(settings["files"])
        grader.send({"ready": True})
        actions = {"prepare": executor.prepare, "run_cell": executor.run_cell, "keep": executor.keep}
        while True:
            request = grader.receive()
            nonce, arguments = request["nonce"], request["arguments"]
            if request["action"] == "snapshot":
                grader = _snapshot(grader, nonce, executor)
            elif request["action"] == "calls":
                for number, reply in enumerate(executor.calls(*arguments)):
                    grader.send({"nonce": nonce, "number": number, **reply})
            else:
                grader.send({"nonce": nonce, **actions[request["action"]](*arguments)})
    except Closed:
        os._exit(0)


def _snapshot(grader, nonce, executor):
    """Fork this process: the copy, which stays as it is until it is asked something, listens to a connection of its own.

    Returns the Channel to listen to, in either process.
    """
    _, (connection,), _, _ = socket.recv_fds(grader.connection, 1, 1)
    try:
        copied = os.fork() == 0
    except OSError:
        copied = False  # the grader sees its end of the connection closed
    if copied:
        grader.connection.close()
        executor.outputs.process = os.getpid()  # it keeps its own outputs
        grader = Channel(socket.socket(fileno=connection), most=None)
    else:
        os.close(connection)
    grader.send({"nonce": nonce, "process": os.getpid()})
    return grader


class _Capabilities(ctypes.Structure):
    """The header of capset(2): its version, which takes three sets of two words each, and the process (0: this one)."""

    _fields_ = [("version", ctypes.c_uint32), ("process", ctypes.c_int)]
    VERSION_3 = 0x20080522


def _become_nobody(libc, number):
    """Give up root, or what entering one's own user namespace has given: no user, no group, no capability."""
    if os.getuid() != 0:
        _leave_user_namespace(libc)
    for capability in range(LAST_CAPABILITY + 1):
        libc.prctl(PR_CAPBSET_DROP, capability, 0, 0, 0)  # fails for numbers that this kernel does not have
    if os.getuid() == 0:
        os.setgroups([])
        os.setresgid(number, number, number)
        os.setresuid(number, number, number)
    header, none = _Capabilities(_Capabilities.VERSION_3, 0), (ctypes.c_uint32 * 6)()
    if libc.capset(ctypes.byref(header), ctypes.byref(none)) != 0:
        raise OSError(ctypes.get_errno(), "capabilities could not be dropped")
    libc.prctl(PR_SET_DUMPABLE, 1, 0, 0, 0)  # its own /proc/self is readable again, as in any process


def _leave_user_namespace(libc):
    """Go into one below the sandbox's own: from there the same user's processes in it, which hold it open, cannot be
    read or written (as root grades, they are another user's)."""
    user, group = os.getuid(), os.getgid()
    if libc.unshare(CLONE_NEWUSER) != 0:
        raise OSError(ctypes.get_errno(), "a notebook's own user namespace could not be made")
    libc.prctl(PR_SET_DUMPABLE, 1, 0, 0, 0)  # or else the files below would be root's
    for name, line in ("setgroups", "deny"), ("uid_map", f"{user} {user} 1"), ("gid_map", f"{group} {group} 1"):
        Path("/proc/self", name).write_text(line)
