"""A user of its own for a notebook's process, where bubblewrap may make no namespaces: weaker, and never a default.

It is for a container that grades one submission and is thrown away, as Gradescope's are. A notebook there has no right
to another user's files and processes, no network, no capability, no way back to root, and the system calls and limits
of any other sandbox. It sees what anybody in the container may see: so the course has to be closed to others, and that
is checked. What it may fill are the folders that anybody may write to; they are counted, and go with the container.
"""

import itertools
import os
import pwd
import shutil
import signal
import tempfile
import time
from pathlib import Path

from .. import ASSIGNMENT
from .bounds import PATIENCE, NotStarted

FIRST, USERS = 20_000, 40_000  # numbers that belong to nobody; a container may have no more than 65536
_next = itertools.count(os.getpid())  # graders at the same time begin elsewhere


class Account:
    """The number of a user whom nobody is, and a folder of theirs with a copy of the students' package.

    package: the folder of `transform_lab` without its key (see `bubblewrap.copy_code`)
    """

    def __init__(self, package):
        self.number = _unused()
        self.home = Path(tempfile.mkdtemp(prefix="notebook-"))
        self.folder = self.home / ASSIGNMENT
        shutil.copytree(package, self.folder / package.name)
        for folder in (self.home, self.folder):
            os.chown(folder, self.number, self.number)

    def close(self):
        """End every process of the user, however fast they multiply, and remove the folder."""
        deadline = time.monotonic() + PATIENCE
        while processes(self.number):
            _kill_all_of(self.number)
            if time.monotonic() > deadline:
                raise NotStarted(f"processes of user {self.number} do not end")
        shutil.rmtree(self.home, ignore_errors=True)


def processes(number):
    """The folders in /proc of the user's processes, those that have ended and are not yet cleared away left out.

    By the number that /proc/PID/status has: a process can make the folder itself seem to be root's.
    """
    found = []
    for path in Path("/proc").iterdir():
        if path.name.isdigit():
            try:
                status = (path / "status").read_text(errors="replace")
            except OSError:
                continue  # it has ended
            ended = "\nState:\tZ" in status and "\nThreads:\t1\n" in status  # others go on when only the first has
            if f"\nUid:\t{number}\t" in status and not ended:
                found.append(path)
    return found


def _unused():
    """A user's number that no account, no process and no earlier notebook has."""
    for offset in itertools.islice(_next, USERS):
        number = FIRST + offset % USERS
        try:
            pwd.getpwuid(number)
        except KeyError:
            if not processes(number):
                return number
    raise NotStarted("there is no user left without processes")


def _kill_all_of(number):
    """In one system call, so that none of them can start another meanwhile: as that user, to all whom it may signal."""
    child = os.fork()
    if child == 0:
        try:
            os.setgroups([])
            os.setresgid(number, number, number)
            os.setresuid(number, number, number)
            os.kill(-1, signal.SIGKILL)
        finally:
            os._exit(0)
    # They may stop or kill this one first; it is then tried again.
    _, status = os.waitpid(child, os.WUNTRACED)
    if os.WIFSTOPPED(status):
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
