"""The grader is proven right: no wrong solution passes, no right one fails, and misconceptions get their own name.

For every exercise and for every one of SEEDS, which the hidden cases are drawn from, and for the public cases:

- every misconception is caught; on every tenth seed it is also named by its own id alone
- every syntactic mutant of the reference, and of the solution in the notebook, is caught, or is listed below as
  equivalent with the reason
- every right solution of `solutions/` is accepted, and every wrong one refused

`python -m pytest tests -k adequacy -s` prints the table.
"""

import io
import linecache
import logging
import warnings
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stderr
from dataclasses import replace
from functools import partial

import nbformat
import numpy as np
import transform_lab
from mutants import mutants
from rich.console import Console
from rich.table import Table
from solutions.right import NAMES, RIGHT
from solutions.wrong import WRONG
from support import ROOT
from transform_lab.judging.calling import call
from transform_lab.judging.verdict import compare, examine

from autograder.exercises import EXERCISES, PUBLIC_SEED, key

SEEDS = (PUBLIC_SEED, *range(1000, 1200))
NAMED_EVERY = 10

# Mutants that are right, too: {why: [what was changed], beginning with the name of the function it was changed in}
EQUIVALENT = {
    "lists of numbers count as arrays": [
        "rotation_about_z: np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) -> [[c, -s, 0], [s, c, 0], [0, 0, 1]]",
        "hand_transform: np.array([[1.0, 0.0, 0.0, -0.1], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], "
        "[0.0, 0.0, 0.0, 1.0]]) -> [[1.0, 0.0, 0.0, -0.1], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], "
        "[0.0, 0.0, 0.0, 1.0]]",
        "hand_transform: np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]) -> "
        "[[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]",
        "position: np.array([pose.position.x, pose.position.y, pose.position.z]) -> "
        "[pose.position.x, pose.position.y, pose.position.z]",
        "orientation: np.array([q.x, q.y, q.z, q.w]) -> [q.x, q.y, q.z, q.w]",
    ],
    "the arguments are arrays already, and NumPy's numbers are numbers": [
        "_close: np.asarray(one) -> one",
        "_close: np.asarray(other) -> other",
        "same_rotation: np.asarray(q2) -> q2",
        "pose_of: float(c) -> c",
        "pose_of: float(c) -> c [2]",
    ],
    "NumPy's truth values are truth values": [
        "_close: bool(np.all(np.abs(np.asarray(one) - np.asarray(other)) <= tolerance)) -> "
        "np.all(np.abs(np.asarray(one) - np.asarray(other)) <= tolerance)",
        "is_rotation: bool(orthonormal and right_handed) -> orthonormal and right_handed",
        "same_rotation: bool(same or opposite) -> same or opposite",
    ],
    "-True is as true as True": [
        "is_rotation: orthonormal -> -orthonormal",
        "same_rotation: same -> -same",
        "same_rotation: opposite -> -opposite",
    ],
    "q and -q are the same orientation": ["pose_of: c -> -c [2]", "pose_of: q -> -q"],
    "a cosine does not know the angle's sign": ["notebook: rotation_about_z: degrees -> -degrees"],
    "one way or the other, a difference has the same size": [
        "_close: np.asarray(one) - np.asarray(other) -> np.asarray(other) - np.asarray(one)",
        "is_rotation: _close(R.T @ R, np.eye(3)) -> _close(np.eye(3), R.T @ R)",
        "is_rotation: np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-06) -> "
        "np.allclose(np.eye(3), R.T @ R, rtol=0, atol=1e-06)",
        "is_rotation: np.isclose(np.linalg.det(R), 1, rtol=0, atol=1e-06) -> "
        "np.isclose(1, np.linalg.det(R), rtol=0, atol=1e-06)",
        "same_rotation: _close(q1, q2) -> _close(q2, q1)",
        "same_rotation: _close(q1, -q2) -> _close(-q2, q1)",
        "same_rotation: np.allclose(q1, q2, rtol=0, atol=1e-06) -> np.allclose(q2, q1, rtol=0, atol=1e-06)",
        "same_rotation: np.allclose(q1, -np.asarray(q2), rtol=0, atol=1e-06) -> "
        "np.allclose(-np.asarray(q2), q1, rtol=0, atol=1e-06)",
    ],
    "a matrix is orthogonal by its rows when it is by its columns": [
        "is_rotation: R.T @ R -> R @ R.T",
    ],
    "with orthonormal columns the determinant is 1 or -1": [
        "is_rotation: np.linalg.det(R) > 0 -> np.linalg.det(R) >= 0",
        "is_rotation: 0 -> 1 [2]",
        "is_rotation: 1e-06 -> 1.000001 [2]",
    ],
    "the tolerance is about 1e-6 all the same; nobody is asked about what lies so near to it": [
        "_close: np.abs(np.asarray(one) - np.asarray(other)) <= tolerance -> "
        "np.abs(np.asarray(one) - np.asarray(other)) < tolerance",
        "is_rotation: np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-06) -> "
        "np.allclose(R.T @ R, np.eye(3), atol=1e-06)",
        "is_rotation: np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-06) -> np.allclose(R.T @ R, np.eye(3), rtol=0)",
        "is_rotation: np.isclose(np.linalg.det(R), 1, rtol=0, atol=1e-06) -> "
        "np.isclose(np.linalg.det(R), 1, atol=1e-06)",
        "is_rotation: np.isclose(np.linalg.det(R), 1, rtol=0, atol=1e-06) -> np.isclose(np.linalg.det(R), 1, rtol=0)",
        "same_rotation: np.allclose(q1, q2, rtol=0, atol=1e-06) -> np.allclose(q1, q2, atol=1e-06)",
        "same_rotation: np.allclose(q1, q2, rtol=0, atol=1e-06) -> np.allclose(q1, q2, rtol=0)",
        "same_rotation: np.allclose(q1, -np.asarray(q2), rtol=0, atol=1e-06) -> "
        "np.allclose(q1, -np.asarray(q2), atol=1e-06)",
        "same_rotation: np.allclose(q1, -np.asarray(q2), rtol=0, atol=1e-06) -> "
        "np.allclose(q1, -np.asarray(q2), rtol=0)",
    ],
}
# …and in one exercise only, for it asks more of the same helper elsewhere
EQUIVALENT_HERE = {
    "same_rotation": {
        "q1 is compared with q2 and with -q2": [
            "_close: np.asarray(one) - np.asarray(other) -> np.asarray(one) + np.asarray(other)",
            "_close: np.asarray(one) - np.asarray(other) -> np.asarray(one) - -np.asarray(other)",
            "_close: one -> -one",
            "_close: other -> -other",
        ]
    },
    "pre_grasp": {"only the matrix's upper left is used": ["transform: 4 -> 5"]},
    "waypoint": {"only the matrix's upper left is used": ["transform: 4 -> 5"]},
}


def test_adequacy():
    changed = {name: changes(name) for name in EXERCISES}
    every = set().union(*changed.values())
    unknown = [what for reasons in (EQUIVALENT, *EQUIVALENT_HERE.values()) for listed in reasons.values()
               for what in listed if not {what, f"notebook: {what}"} & every]  # fmt: skip
    assert not unknown, "listed as equivalent, and made no longer"
    spans = [SEEDS[start : start + 50] for start in range(0, len(SEEDS), 50)]
    with ProcessPoolExecutor() as pool:
        jobs = [pool.submit(measure, name, span) for span in spans for name in EXERCISES]
        faults = Counter(fault for job in jobs for fault in job.result())
    table = Table("exercise", "misconceptions caught", "mutants caught", "equivalent", "other wrong caught",
                  "right accepted", title=f"each for {len(SEEDS)} seeds")  # fmt: skip
    rows = []
    for name, exercise in EXERCISES.items():
        alike = len(equivalents(name, changed[name]))
        right, wrong = students(name)
        rows.append([len(exercise.misconceptions), len(changed[name]) - alike, alike, len(wrong), len(right)])
        table.add_row(name, *map(str, rows[-1]))
    table.add_section()
    table.add_row("all", *map(str, np.sum(rows, axis=0)))
    console = Console(width=110)
    console.print(table)
    console.print(f"missed, misnamed or refused: {len(faults)}")
    assert not faults, "\n".join(f"{fault} ({times} seeds)" for fault, times in faults.items())


def measure(name, seeds):
    """What must not be, in words, for one exercise and the cases drawn from `seeds`."""
    warnings.simplefilter("ignore")
    logging.disable()  # students print, warn and log
    exercise, faults = EXERCISES[name], []
    changed, (right, wrong) = changes(name), students(name)
    alike = equivalents(name, changed)
    with np.errstate(all="ignore"), redirect_stderr(io.StringIO()):
        for seed in seeds:
            cases = key(replace(exercise, misconceptions=()), seed)
            for number, misconception in enumerate(exercise.misconceptions):
                if passes(misconception.wrong, cases):
                    faults.append(f"{name}: {misconception.id} ({number}) is not caught")
            faults += [f"{name}: right, and refused: {label}" for label in right if not passes(right[label], cases)]
            faults += [f"{name}: wrong, and accepted: {label}" for label in wrong if passes(wrong[label], cases)]
            for what, mutant in changed.items():
                if passes(mutant, cases) != (what in alike):
                    kind = "equivalent, and caught" if what in alike else "mutant, and missed"
                    faults.append(f"{name}: {kind}: {what}")
        for seed in seeds[::NAMED_EVERY]:
            cases = key(exercise, seed)
            for number, misconception in enumerate(exercise.misconceptions):
                called = examine(name, cases, partial(call, misconception.wrong)).misconceptions
                if called != tuple(misconception.id.split(";")):
                    faults.append(f"{name}: {misconception.id} ({number}) is called {called}")
    return faults


def changes(name):
    """{what was changed: mutant} of the reference and of the notebook's solution."""
    found = dict(mutants(EXERCISES[name].reference, "autograder.exercises"))
    return found | {f"notebook: {what}": mutant for what, mutant in mutants(notebook_solution(name))}


def equivalents(name, changed):
    """Those of the changes that are listed as right."""
    reasons = EQUIVALENT | EQUIVALENT_HERE.get(name, {})
    listed = {what for changes in reasons.values() for what in changes}
    return {what for what in changed if {what, what.removeprefix("notebook: ")} & listed}


def students(name):
    """{label: function} of the right solutions, and of the wrong ones."""
    right = {label: function for (of, function), label in zip(RIGHT, NAMES) if of == name}
    return right, {function.__name__: function for of, _, function in WRONG if of == name}


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
