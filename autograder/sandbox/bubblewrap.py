"""An empty sandbox, which bubblewrap makes and holds open.

Inside there are: /usr and the Python in use (read-only), the students' package without its key, small writable
folders, and nothing else of this machine: no network, no other processes, no environment.
"""

import json
import os
import select
import shutil
import signal
import subprocess
import sys
import tempfile
from functools import cache
from pathlib import Path

from .. import ASSIGNMENT
from .bounds import COURSE, FOLDER, PATIENCE, WRITABLE, NotStarted

HERE = Path(__file__).parent
NOBODY = 100_000  # when the grader is root, each notebook runs as a user of its own: this number and up
USER = "student"  # what that user is called
# What runs in a notebook's process
CODE = ("channel.py", "executor.py", "forkserver.py", "outputs.py", "seccomp.py", "shell.py")


class Namespaces:
    """A sandbox without a program of its own: processes enter it by its `pidfd`, and all end with it.

    code: the folder with the students' package and the grader's code for notebooks' processes (see `copy_code`)
    """

    def __init__(self, code):
        # The arguments go by a file: as a command line, anybody inside could read them.
        with (
            tempfile.TemporaryFile() as arguments,
            tempfile.TemporaryFile() as rules,
            tempfile.TemporaryFile() as told,
            # Beside the code, and gone with it if the grader is killed
            tempfile.NamedTemporaryFile("w", dir=code, prefix="user-") as user,
            tempfile.NamedTemporaryFile("w", dir=code, prefix="group-") as group,
        ):
            names = {"/etc/passwd": user.name, "/etc/group": group.name}
            arguments.write(b"\0".join(os.fsencode(argument) for argument in command(code, names)))
            rules.write(compiled_filter())  # also for those that only hold the sandbox open: nobody in it needs more
            for file in (arguments, rules):
                file.seek(0)
            for file in (user, group):
                os.fchmod(file.fileno(), 0o644)
            given = {"--args": arguments.fileno(), "--seccomp": rules.fileno(), "--info-fd": told.fileno()}
            self.process = subprocess.Popen(
                [shutil.which("bwrap"), *(str(word) for option in given.items() for word in option), "cat"],
                stdin=subprocess.PIPE,  # `cat` ends with the grader, and the sandbox with `cat`
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,  # no file of ours, which could be written to from inside
                pass_fds=given.values(),
                env={},  # what bubblewrap itself was started with can be read inside
                start_new_session=True,  # Ctrl-C is for the grader
            )
            self.pid, self.pidfd = None, None
            try:
                os.write(self.process.stdin.fileno(), b"?")  # `cat` answers once everything is mounted
                started = os.read(self.process.stdout.fileno(), 1) == b"?"
                told.seek(0)
                self.pid = json.loads(told.read())["child-pid"]
                self.pidfd = os.pidfd_open(self.pid)
                self.number = NOBODY + self.pid  # of the notebook's user, when root grades; otherwise it is the grader
                number, its_group = (self.number, self.number) if os.getuid() == 0 else (os.getuid(), os.getgid())
                user.write(f"{USER}:x:{number}:{its_group}::/tmp:/bin/sh\n")
                group.write(f"{USER}:x:{its_group}:\n")
            except (ValueError, OSError):
                started = False
            if not started:
                said = " ".join(self.close().decode(errors="replace").split())
                raise NotStarted(said[:300] or f"bubblewrap ended with exit code {self.process.returncode}")

    def close(self):
        """End every process inside, and wait until they are gone; what bubblewrap has said, as bytes."""
        if self.pidfd is not None:
            try:
                signal.pidfd_send_signal(self.pidfd, signal.SIGKILL)
            except ProcessLookupError:
                pass  # it is gone already, and everything inside with it
            select.select([self.pidfd], [], [], PATIENCE)
            os.close(self.pidfd)
            self.pidfd = None
        else:
            self.process.kill()
        return self.process.communicate()[1]


@cache
def compiled_filter():
    """The filter of system calls, as the kernel takes it: bytes."""
    from .seccomp import compiled  # only here: on a machine without its library, `probe` says so

    return compiled()


def command(code, names):
    """The arguments of `bwrap` that describe the sandbox; names: {file inside: the file that it is}."""
    package = code / "transform_lab"
    root = os.getuid() == 0
    # Not --die-with-parent: while it starts, it would be killed in two halves, of which one waits for the other for good.
    arguments = ["--new-session", "--clearenv"]
    arguments += ["--unshare-ipc", "--unshare-pid", "--unshare-net", "--unshare-uts", "--unshare-cgroup-try"]
    # Root keeps the user namespace it has, and notebooks' processes become nobody in it (forkserver.py).
    arguments += ["--cap-drop", "ALL"] if root else ["--unshare-user"]
    arguments += ["--ro-bind", "/usr", "/usr"]
    for link in ("bin", "sbin", "lib", "lib32", "lib64"):
        if Path("/", link).is_symlink():
            arguments += ["--symlink", os.readlink(Path("/", link)), f"/{link}"]
        elif Path("/", link).is_dir():
            arguments += ["--ro-bind", f"/{link}", f"/{link}"]
    # Memory that is shared over /dev/zero would count for nobody; an empty file instead.
    arguments += ["--proc", "/proc", "--dev", "/dev", "--dev-bind", "/dev/null", "/dev/zero"]
    for folder in map(str, WRITABLE):
        arguments += ["--perms", "1777", "--size", str(FOLDER), "--tmpfs", folder]
    arguments += ["--perms", "0777", "--dir", str(COURSE / ASSIGNMENT)]
    made = {*WRITABLE, COURSE / ASSIGNMENT}
    for path in filter(Path.exists, map(Path, ("/etc/ld.so.cache", "/etc/fonts"))):
        arguments += _bind(path, path, made)
    for path, file in names.items():
        arguments += _bind(file, Path(path), made)
    for folder in python_folders():
        if not folder.is_relative_to("/usr") and folder not in made:
            arguments += _bind(folder, folder, made)
    arguments += _bind(code, code, made)
    arguments += _bind(package, COURSE / ASSIGNMENT / package.name, made)
    # bubblewrap makes / and /dev as folders in memory, of no bounded size.
    return [*arguments, "--remount-ro", "/dev", "--remount-ro", "/", "--chdir", str(COURSE / ASSIGNMENT)]


def copy_code(package):
    """A new folder, to be removed by whoever asked, with all of the grader's and the course's that notebooks may see.

    package: the folder of `transform_lab`; its key.json is left out, so that no expected value is inside
    """
    folder = Path(tempfile.mkdtemp(prefix="grader-"))
    folder.chmod(0o755)
    for name in CODE:
        shutil.copy(HERE / name, folder)
    shutil.copytree(package, folder / package.name, ignore=shutil.ignore_patterns("key.json", "__pycache__"))
    return folder


def python_folders():
    """The folders of the Python in use, as they are called and as they are."""
    prefixes = Path(sys.base_prefix), Path(sys.prefix)
    return dict.fromkeys((*prefixes, *(prefix.resolve() for prefix in prefixes)))


def _bind(source, target, made):
    """Mount `source` read-only; folders above it are made readable (bubblewrap alone would make them 0700)."""
    arguments = []
    for folder in reversed(target.parents):
        if folder != Path("/") and folder not in made and not folder.is_relative_to("/usr"):
            arguments += ["--perms", "0755", "--dir", str(folder)]
            made.add(folder)
    made.add(target)
    return [*arguments, "--ro-bind", str(source), str(target)]
