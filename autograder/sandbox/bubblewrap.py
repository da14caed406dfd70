"""The command line that puts a process into a sandbox, and the probe that tells whether it works on this machine.

Inside there are: /usr and the Python in use (read-only), the worker's code, the students' package without its key,
small writable folders, and nothing else of this machine: no network, no other processes, no environment.
"""

import os
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

WORKER = Path("/grader")  # where the worker's code lies inside
COURSE = Path("/course")  # where notebooks run inside; the students' package lies in it
HERE = Path(__file__).parent
WORKER_FILES = ("channel.py", "worker.py", "executor.py")

INSTALL = (
    "bubblewrap (the command bwrap) is not installed. On Debian or Ubuntu: sudo apt-get install bubblewrap; "
    "on Fedora: sudo dnf install bubblewrap."
)
REFUSED = (
    "bubblewrap is installed but may not make namespaces here ({reason}). In a container, allow unprivileged user "
    "namespaces (for Docker: --security-opt seccomp=unconfined, or run the grader outside the container)."
)

EXPOSED = (
    "The course lies in a folder that notebooks can read in their sandbox (/usr, or that of Python itself), with its "
    "solutions and gradebook. Move it somewhere else, such as your home folder."
)


@cache
def problem():
    """None when sandboxes work on this machine; else what is wrong and what to do, in one line."""
    if sys.platform != "linux":
        return (
            f"bubblewrap needs Linux; this is {sys.platform}. Grade on a Linux machine, or in a Linux virtual machine."
        )
    if shutil.which("bwrap") is None:
        return INSTALL
    python = [*command(Path("/nonexistent")), sys.executable, "-I", "-c", ""]
    probe = subprocess.run(python, capture_output=True, text=True, timeout=60)
    if probe.returncode == 0:
        return None
    return REFUSED.format(reason=" ".join(probe.stderr.split())[:200] or f"exit {probe.returncode}")


def command(package, megabytes=50):
    """The arguments that run a command in the sandbox: `subprocess.run([*command(package), "true"])`.

    package: the folder of `transform_lab`; its key.json is left out, so that no expected value is inside.
    megabytes: the size of each writable folder.
    """
    root = os.getuid() == 0
    arguments = [shutil.which("bwrap"), "--die-with-parent", "--new-session", "--clearenv"]
    arguments += ["--unshare-ipc", "--unshare-pid", "--unshare-net", "--unshare-uts", "--unshare-cgroup-try"]
    if not root:
        arguments += ["--unshare-user"]
    arguments += ["--ro-bind", "/usr", "/usr"]
    for link in ("bin", "sbin", "lib", "lib32", "lib64"):
        if Path("/", link).is_symlink():
            arguments += ["--symlink", os.readlink(Path("/", link)), f"/{link}"]
        elif Path("/", link).is_dir():
            arguments += ["--ro-bind", f"/{link}", f"/{link}"]
    arguments += ["--proc", "/proc", "--dev", "/dev"]
    for folder in ("/tmp", "/dev/shm", str(COURSE)):
        arguments += ["--perms", "1777", "--size", str(megabytes * 1_000_000), "--tmpfs", folder]
    arguments += ["--perms", "0777", "--dir", str(COURSE / "transforms")]
    made = {Path("/tmp"), COURSE, COURSE / "transforms"}
    for path in filter(Path.exists, map(Path, ("/etc/ld.so.cache", "/etc/fonts"))):
        arguments += _bind(path, path, made)
    for folder in _python():
        if not folder.is_relative_to("/usr") and folder not in made:
            arguments += _bind(folder, folder, made)
    for name in WORKER_FILES:
        arguments += _bind(HERE / name, WORKER / name, made)
    for path in package_files(package):
        arguments += _bind(path, COURSE / "transforms" / package.name / path.name, made)
    arguments += ["--chdir", str(COURSE / "transforms"), "--"]
    if root:
        # Without a user namespace of its own, root inside would still be root to every file: become nobody.
        number = str(100_000 + os.getpid() % 1_000_000)
        arguments += ["setpriv", "--reuid", number, "--regid", number, "--clear-groups"]
        arguments += ["--bounding-set=-all", "--inh-caps=-all", "--no-new-privs"]
    return arguments


def package_files(package):
    """The files of the students' package that notebooks get while they are graded: all but the answers' key."""
    return sorted(path for path in package.glob("*") if path.is_file() and path.name != "key.json")


def refusal(root):
    """Why the submissions of the course in `root` must not be graded on this machine, or None."""
    return problem() or (EXPOSED if exposes(root) else None)


def exposes(folder):
    """Whether notebooks in a sandbox could read `folder`, because it lies in what Python needs."""
    return any(Path(folder).resolve().is_relative_to(seen) for seen in (Path("/usr"), *_python()))


def _python():
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
