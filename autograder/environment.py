"""The project's own environment: `.venv`, made from environment.txt on first use. Standard library only.

An interpreter that already has every package at its version is used as it is. Otherwise `.venv` is made, once; a stamp
written last says that it is whole, so a set-up that failed or was interrupted is repaired by the next command.
"""

import fcntl
import hashlib
import os
import re
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path

OLDEST = (3, 11)
MADE = "AUTOGRADER_MADE_ENVIRONMENT"  # in the environment of the interpreter that ours goes on in


class SetupFailed(Exception):
    """The environment could not be made; the message says what to do."""


def ensure(root, arguments):
    """Return when this interpreter can run the project in `root`; else go on in `.venv` (this call does not return)."""
    if sys.version_info < OLDEST:
        raise SetupFailed(f"Python {'.'.join(map(str, OLDEST))} or newer is needed; this is {sys.version.split()[0]}.")
    if not lacking(root / "environment.txt"):
        _use(Path(sys.prefix, "bin"))
        return
    if Path(sys.prefix) == root / ".venv":
        if os.environ.get(MADE) == sys.prefix:
            raise SetupFailed(f".venv was made anew, and still lacks {', '.join(lacking(root / 'environment.txt'))}.")
        # Its packages were changed by hand: make it anew, with the Python that it was made from.
        (root / ".venv" / "stamp").unlink(missing_ok=True)
    with open(root / "environment.txt", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # two first commands at once: the second waits, and finds it made
        python = make(root)
    os.environ[MADE] = str(root / ".venv")
    os.environ.pop("PYTHONPATH", None)
    os.execv(python, [str(python), "-m", "autograder", *arguments])


def pinned(requirements):
    """{package: version} of a file of pip requirements."""
    return dict(re.findall(r"^([\w.-]+)==([\w.]+)", requirements.read_text(encoding="utf-8"), re.MULTILINE))


def lacking(requirements):
    """The requirements that this interpreter does not have at their version."""
    absent = []
    for name, version in pinned(requirements).items():
        try:
            found = metadata.version(name)
        except metadata.PackageNotFoundError:
            found = None
        if found != version:
            absent.append(name)
    return absent


def make(root):
    """Make `.venv` in `root` unless it is whole already; returns its interpreter."""
    folder, requirements = root / ".venv", root / "environment.txt"
    python, stamp = folder / "bin" / "python", folder / "stamp"
    # The folder's own path counts, too: the scripts of an environment that was moved or copied do not work.
    digest = hashlib.sha256(requirements.read_bytes() + str(folder).encode()).hexdigest()
    if stamp.exists() and stamp.read_text() == digest and python.exists():
        return python
    print(
        "Setting up: installing the packages of environment.txt into .venv (once; a minute or two) …", file=sys.stderr
    )
    base = getattr(sys, "_base_executable", None) or sys.executable
    shutil.rmtree(folder, ignore_errors=True)
    steps = (
        [base, "-m", "venv", str(folder)],
        [str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", str(requirements)],
    )
    for step in steps:
        result = subprocess.run(step, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if result.returncode != 0:
            reason = "\n".join((result.stderr or result.stdout).strip().splitlines()[-5:])
            raise SetupFailed(
                f"The set-up failed at: {' '.join(step[1:4])}\n{reason}\n"
                "Check the network (and that Python's venv module is installed: apt install python3-venv), then run "
                "the same command again; it starts over."
            )
    stamp.write_text(digest)
    return python


def _use(scripts):
    """nbgrader runs `alembic` and `jupyter` by name: they have to be those of this environment."""
    os.environ["PATH"] = f"{scripts}{os.pathsep}{os.environ.get('PATH', '')}"
