"""Whether a sandbox works on this machine, and may be used for a course: tried, not looked up."""

import os
import shutil
import sys
from functools import cache
from pathlib import Path

from .bounds import NotStarted
from .bubblewrap import python_folders
from .host import Sandbox

INSTALL = (
    "bubblewrap (the command bwrap) is not installed. On Debian or Ubuntu: sudo apt-get install bubblewrap; "
    "on Fedora: sudo dnf install bubblewrap."
)
NO_SECCOMP = (
    "The library libseccomp, which filters system calls, is not installed. On Debian or Ubuntu: sudo apt-get install "
    "libseccomp2; on Fedora: sudo dnf install libseccomp."
)
REFUSED = (
    "bubblewrap is installed but may not make namespaces here ({reason}). In a container, grade as an ordinary user who may "
    "make them (for Docker: --user 1000 --security-opt seccomp=unconfined --security-opt systempaths=unconfined, and "
    "--security-opt apparmor=unconfined on a machine with AppArmor), or run the grader outside the container."
)

RESTRICTED = (
    "bubblewrap is installed, but Ubuntu lets only root make namespaces ({reason}). Allow it: "
    "sudo sysctl -w kernel.apparmor_restrict_unprivileged_userns=0 (for good: a file in /etc/sysctl.d with that setting)."
)
APPARMOR = Path("/proc/sys/kernel/apparmor_restrict_unprivileged_userns")

EXPOSED = (
    "The course lies in a folder that notebooks can read in their sandbox (/usr, or that of Python itself), with its "
    "solutions and gradebook. Move it somewhere else, such as your home folder."
)
NEEDS_ROOT = "Each notebook would run as a user of its own, and only root may start processes as another user."
CLOSED = (
    "Other users cannot read the Python in use, in {python}, so no notebook runs as one of them. Install it, and make its "
    "environment, in folders that anybody may read, such as /usr and /opt."
)
OPEN = (
    "Anybody on this machine may read the course, with its solutions, in {root}. Close it or a folder above it: "
    "chmod 700 {root}"
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
    try:
        import pyseccomp  # noqa: F401
    except (ImportError, OSError, RuntimeError):
        return NO_SECCOMP
    import transform_lab

    try:
        with Sandbox(Path(transform_lab.__file__).parent) as sandbox, sandbox.notebook():
            return None
    except NotStarted as error:
        restricted = APPARMOR.is_file() and APPARMOR.read_text().strip() == "1"
        return (RESTRICTED if restricted else REFUSED).format(reason=error)


def refusal(root):
    """Why the submissions of the course in `root` must not be graded on this machine, or None."""
    return problem() or (EXPOSED if exposes(root) else None)


def refusal_as_user(root):
    """Why the course in `root` must not be graded in this way on this machine, or None."""
    if sys.platform != "linux" or os.getuid() != 0:
        return NEEDS_ROOT
    try:
        import pyseccomp  # noqa: F401
        import transform_lab
    except (ImportError, OSError, RuntimeError):
        return NO_SECCOMP
    root = Path(root).resolve()
    if all(folder.stat().st_mode & 0o001 for folder in (root, *root.parents)):
        return OPEN.format(root=root)
    try:
        with Sandbox(Path(transform_lab.__file__).parent, isolated="user") as sandbox, sandbox.notebook() as notebook:
            works = [output["output_type"] for output in notebook.run_cell("1").outputs] == ["execute_result"]
            return None if works else CLOSED.format(python=sys.prefix)
    except (NotStarted, OSError) as error:
        return f"No process could be started as a user of its own: {error}"


def exposes(folder):
    """Whether notebooks in a sandbox could read `folder`, because it lies in what Python needs."""
    return any(Path(folder).resolve().is_relative_to(seen) for seen in (Path("/usr"), *python_folders()))
