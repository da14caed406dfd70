"""The grader is proven right: no wrong solution passes, no right one fails, and misconceptions get their own name.

For every exercise and for every one of SEEDS, which the hidden cases are drawn from, and for the public cases:

- every misconception is caught, and named by its own id alone
- every syntactic mutant of the reference, and of the solution in the notebook, is caught, or is listed below as
  equivalent with the reason
- every right solution (`solutions/right.py`, and forms of answers that come of the reference) earns full points

`python -m pytest tests -k adequacy -s` prints the table.
"""

import linecache
import warnings
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from functools import partial

import nbformat
import numpy as np
import transform_lab
from conftest import ROOT
from mutants import mutants
from rich.console import Console
from rich.table import Table
from solutions.right import RIGHT
from solutions.wrong import WRONG
from transform_lab.check import call
from transform_lab.verdict import compare, examine

from autograder.exercises import EXERCISES, PUBLIC_SEED, key

SEEDS = (PUBLIC_SEED, *range(1000, 1200))

# Mutants that no input can tell from the original, {(exercise or "", what is changed): why}
EQUIVALENT = {}


@dataclass
class Adequacy:
    """What was found for one exercise; `faults` is what must not be, in words."""

    exercise: str
    misconceptions: int = 0
    caught: int = 0
    equivalent: int = 0
    right: int = 0
    wrong: int = 0
    faults: list = field(default_factory=list)


def test_adequacy():
    with ProcessPoolExecutor() as pool:
        found = list(pool.map(measure, EXERCISES))
    table = Table("exercise", "misconceptions caught and named", "mutants caught / equivalent", "other wrong caught",
                  "right solutions accepted", title=f"each for {len(SEEDS)} seeds")  # fmt: skip
    for each in found:
        table.add_row(each.exercise, str(each.misconceptions), f"{each.caught} / {each.equivalent}", str(each.wrong),
                      str(each.right))  # fmt: skip
    table.add_section()
    total = {name: sum(getattr(each, name) for each in found) for name in vars(found[0]) if name not in ("exercise", "faults")}
    table.add_row("all", str(total["misconceptions"]), f"{total['caught']} / {total['equivalent']}",
                  str(total["wrong"]), str(total["right"]))  # fmt: skip
    console = Console(width=120)
    console.print(table)
    faults = Counter(fault for each in found for fault in each.faults)
    console.print(f"missed, misnamed or refused: {len(faults)}")
    assert not faults, "\n".join(f"{fault} ({times} seeds)" for fault, times in faults.items())


def measure(name):
    """The Adequacy of one exercise's cases."""
    warnings.simplefilter("ignore")
    exercise, found = EXERCISES[name], Adequacy(name)
    changed = [*mutants(exercise.reference, "autograder.exercises"), *mutants(notebook_solution(name))]
    equivalent = {what for of, what in EQUIVALENT if of in (name, "")}
    right = [function for of, function in RIGHT if of == name]
    wrong = [function for of, _, function in WRONG if of == name]
    found.misconceptions, found.right, found.wrong = len(exercise.misconceptions), len(right), len(wrong)
    found.equivalent = sum(what in equivalent for what, _ in changed)
    found.caught = len(changed) - found.equivalent
    with np.errstate(all="ignore"):
        for seed in SEEDS:
            cases = key(exercise, seed)
            for misconception in exercise.misconceptions:
                verdict = examine(name, cases, partial(call, misconception.wrong))
                if verdict.right or verdict.misconceptions != tuple(misconception.id.split(";")):
                    found.faults.append(f"{name}: {misconception.id} is called {verdict.misconceptions}")
            for function in right:
                if not passes(function, cases):
                    found.faults.append(f"{name}: right, and refused: {function}")
            for function in wrong:
                if passes(function, cases):
                    found.faults.append(f"{name}: wrong, and accepted: {function}")
            for what, mutant in changed:
                if (mutant is not None and passes(mutant, cases)) != (what in equivalent):
                    kind = "equivalent, and caught" if what in equivalent else "mutant, and missed"
                    found.faults.append(f"{name}: {kind}: {what}")
    return found


def passes(function, cases):
    """Whether a function is right in all cases; stops at the first that it is not."""
    return all(compare(cases["returns"], case, call(function, case["args"], case["kwargs"])).right
               for case in cases["cases"])  # fmt: skip


def notebook_solution(name):
    """The function `name` as the notebooks in source/ solve it."""
    for path in sorted((ROOT / "source/transforms").glob("*.ipynb")):
        cells = {c.metadata.get("nbgrader", {}).get("grade_id"): c for c in nbformat.read(path, as_version=4).cells}
        if f"{name}-solution" in cells:
            source = cells[f"{name}-solution"].source
            namespace = {"np": np, **{each: getattr(transform_lab, each) for each in transform_lab.__all__}}
            linecache.cache[name] = len(source), None, source.splitlines(keepends=True), name  # for inspect
            exec(compile(source, name, "exec"), namespace)
            return namespace[name]
    raise AssertionError(f"no notebook solves {name}")
