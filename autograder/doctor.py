"""What protects grading on this machine and what does not, in plain words."""

import sys

from . import sandbox
from .sandbox import Limits


def examine(course):
    """[(whether it is as it should be, one line about it)]"""
    problem, limits = sandbox.problem(), Limits()
    lines = [(True, f"Python {sys.version.split()[0]} with the packages of environment.txt.")]
    if problem:
        lines.append((False, f"No sandbox: {problem} `grade` refuses to run without --unsafe-no-sandbox."))
        return lines
    lines += [
        (
            True,
            "bubblewrap works: a notebook sees no network, no other process, no file and no variable of yours.",
        ),
        (True, "Verdicts are reached outside the notebook's process: no expected value or hidden case is ever in it."),
        (
            True,
            f"Limits: {limits.call:g} s a call, {limits.cell:g} s a cell, {limits.notebook:g} s a notebook; "
            f"{limits.memory / 1e9:g} GB a process, {limits.processes} of them.",
        ),
        (
            False,
            "Not filtered: system calls (no seccomp filter yet); a hole in the kernel would be one in the sandbox.",
        ),
    ]
    if exposed := sandbox.refusal(course.root):
        lines.append((False, exposed))
    released = course.release.is_dir()
    lines.append(
        (released, f"notebooks/ is {'there' if released else 'missing: run `python3 -m autograder release`'}.")
    )
    return lines
