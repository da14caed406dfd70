"""What protects grading on this machine and what does not, in plain words."""

import os
import stat
import sys
from pathlib import Path

from . import sandbox
from .bridge.nbgrader_api import exchange
from .hub import setting_up
from .intake.exchange import not_sticky
from .sandbox import Limits
from .sandbox.bounds import FOLDER


def examine(course):
    """[(whether it is as it should be, one line about it)]"""
    problem, limits = sandbox.problem(), Limits()
    lines = [(True, f"Python {sys.version.split()[0]} with the packages of environment.txt.")]
    if problem:
        lines.append((False, f"No sandbox: {problem} `grade` refuses to run without --unsafe-no-sandbox."))
        return lines + _files(course)
    lines += [
        (True, "bubblewrap works: a notebook sees no network, no other process, no file and no variable of yours."),
        (True, f"Notebooks run as nobody in particular{', although you are root' if os.getuid() == 0 else ''}."),
        (True, "System calls are filtered (seccomp): what no notebook needs of the kernel is refused."),
        (True, "Verdicts are reached outside the notebook's process: no expected value or hidden case is ever in it."),
        (
            True,
            f"Limits of time: {limits.call:g} s a call, {limits.cell:g} s a cell, {limits.notebook:g} s a notebook, "
            f"{limits.submission:g} s a submission; {limits.cpu:g} s of processor time a notebook.",
        ),
        (
            True,
            f"Limits of a notebook: {limits.memory / 1e9:g} GB of memory, {limits.processes} processes and threads, "
            f"{limits.files} files of up to {limits.file / 1e6:g} MB in folders of {FOLDER / 1e6:g} MB.",
        ),
    ]
    lines.append(
        (
            True,
            "Memory and processor time are counted by looking at all processes of a notebook, four times a second; no memory "
            "cgroup is used. Pipes, sockets and terminals count as if they were full; memory without an owner is refused.",
        )
    )
    if not os.path.exists("/proc/self/schedstat"):
        lines.append((False, "This kernel does not tell who waits for a processor: a slow neighbour can cost time."))
    if exposed := sandbox.refusal(course.root):
        lines.append((False, exposed))
    released = course.release.is_dir()
    lines.append(
        (released, f"notebooks/ is {'there' if released else 'missing: run `python3 -m autograder release`'}.")
    )
    return lines + _files(course)


def examine_hub(hub):
    """The same of a JupyterHub."""
    lines = [
        (
            step.take is None,
            step.what + (f": `python3 -m autograder hub {hub.command}` sees to that." if step.take else "."),
        )
        for step in setting_up.steps(hub)
    ]
    return lines + [(False, line) for line in setting_up.problems(hub)]


def _files(course):
    """Lines about who else can get at the course's files, and at what students hand in by nbgrader's exchange."""
    lines = [(True, "Other accounts of this machine can neither read nor change the course.")]
    if found := open_to_others(course.root):
        # The folder around them keeps others out of all that is in it; what lies elsewhere is closed by itself.
        close = {
            course.root if path.resolve().is_relative_to(course.root.resolve()) else path.resolve() for path in found
        }
        names = ", ".join(path.name for path in found)
        mend = "; ".join(f"`chmod o-rwx {folder}`" for folder in sorted(close))
        lines = [(False, f"Other accounts of this machine can read or change {names}: {mend} keeps them out.")]
    root, course_id = exchange(course)
    if root.is_dir():
        loose = not_sticky(root, course_id)
        lines += [
            (False, f"In {folder} students can remove each other's work: `chmod +t {folder}`.") for folder in loose
        ]
        if not loose:
            lines.append((True, f"In the exchange, {root}, students cannot remove each other's work."))
    return lines


def open_to_others(root: Path) -> list[Path]:
    """What of a course other accounts than its owner's and its group's may read or change."""
    names = ("source", "submitted", "autograded", "feedback", "reports", "downloaded", "gradebook.db", "grades.csv")
    return [path for path in (root / name for name in names) if path.exists() and _is_open(path.resolve())]


def _is_open(path):
    through = all(folder.stat().st_mode & stat.S_IXOTH for folder in path.parents)
    return through and bool(path.stat().st_mode & (stat.S_IROTH | stat.S_IWOTH))
