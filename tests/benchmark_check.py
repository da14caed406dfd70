"""How long a student waits for `check`, and the judge for a notebook: `python tests/benchmark_check.py`.

Prints medians in milliseconds on this machine, per exercise: `check` on a right solution (goal: under 50 after the
first call), `check` on a wrong one with its picture, and per notebook what judging all hidden cases costs the grader
on top of the student's own time (goal: under 100). `--smallest` measures everything once, to see that it works.
"""

import contextlib
import io
import statistics
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import nbformat
import numpy as np
from IPython.core.interactiveshell import InteractiveShell
from rich.console import Console
from rich.table import Table

from autograder.exercises import EXERCISES, key  # finds transform_lab, too

from transform_lab import check  # isort: skip
from transform_lab.check import CheckFailed  # isort: skip
from transform_lab.judging.calling import call  # isort: skip
from transform_lab.judging.verdict import examine  # isort: skip

REPEATS = 1 if "--smallest" in sys.argv else 5


def milliseconds(action):
    """The median time of an action, after a first call that is not counted."""
    times = []
    for _ in range(REPEATS + 1):
        start = time.perf_counter()
        action()
        times.append(1000 * (time.perf_counter() - start))
    return statistics.median(times[1:])


def checked(name, function):
    """`check` as a notebook runs it, its display thrown away."""
    with contextlib.redirect_stdout(io.StringIO()), contextlib.suppress(CheckFailed), np.errstate(all="ignore"):
        check(name, function)


def host_alone(name, cases, function):
    """What a verdict costs besides the calls of the student's function."""
    replies = [call(function, case["args"], case["kwargs"]) for case in cases["cases"]]

    def judge():
        waiting = iter(replies)
        examine(name, cases, lambda args, kwargs: next(waiting))

    return milliseconds(judge)


def main():
    InteractiveShell.instance()  # so that `check` makes its panel and its picture
    judging, table = {}, Table("exercise", "check, right", "check, wrong", "judging, right", "judging, wrong")
    for name, exercise in EXERCISES.items():
        hidden, wrong = key(exercise, 1), exercise.misconceptions[0].wrong
        right_ms = milliseconds(lambda: checked(name, exercise.reference))
        wrong_ms = milliseconds(lambda: checked(name, wrong))
        with np.errstate(all="ignore"):
            judging[name] = [host_alone(name, hidden, function) for function in (exercise.reference, wrong)]
        table.add_row(name, *(f"{each:.1f} ms" for each in (right_ms, wrong_ms, *judging[name])))
    console = Console()
    console.print(table)
    for path in sorted((Path(__file__).parent.parent / "source/transforms").glob("*.ipynb")):
        cells = nbformat.read(path, as_version=4).cells
        names = [c.metadata.get("nbgrader", {}).get("grade_id") for c in cells]
        right, wrong = np.sum([judging[name] for name in names if name in judging], axis=0)
        console.print(f"{path.stem}: judging takes {right:.1f} ms when all is right, {wrong:.1f} ms when all is wrong")


if __name__ == "__main__":
    main()
