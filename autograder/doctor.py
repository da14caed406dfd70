"""What protects grading on this machine and what does not, in plain words."""

import os
import sys

from . import sandbox
from .sandbox import Limits
from .sandbox.bounds import FOLDER


def examine(course):
    """[(whether it is as it should be, one line about it)]"""
    problem, limits = sandbox.problem(), Limits()
    lines = [(True, f"Python {sys.version.split()[0]} with the packages of environment.txt.")]
    if problem:
        lines.append((False, f"No sandbox: {problem} `grade` refuses to run without --unsafe-no-sandbox."))
        return lines
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
    return lines
