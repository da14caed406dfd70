"""The grader is proven right: no wrong solution passes, no right one fails, and misconceptions get their own name.

For every exercise and for every one of SEEDS, which the hidden cases are drawn from, and for the public cases:

- every misconception is caught, and named by its own id alone
- every syntactic mutant of the reference, and of the solution in the notebook, is caught, or is listed below as
  equivalent with the reason
- every right solution of `solutions/` is accepted, and every wrong one refused

`python -m pytest tests -k adequacy -s` prints the table.
"""

import linecache
import logging
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
from solutions.right import NAMES, RIGHT
from solutions.wrong import WRONG
from transform_lab.check import call
from transform_lab.verdict import compare, examine

from autograder.exercises import EXERCISES, PUBLIC_SEED, key

SEEDS = (PUBLIC_SEED, *range(1000, 1200))

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
        "is_rotation: R.T @ R -> R @ R.T [2]",
    ],
    "with orthonormal columns the determinant is 1 or -1": [
        "is_rotation: np.linalg.det(R) > 0 -> np.linalg.det(R) >= 0",
        "is_rotation: 0 -> 1 [2]",
        "is_rotation: 1e-06 -> 1.000001 [2]",
    ],
    "the tolerance is about 1e-6 all the same; nobody is asked about what lies so near to it": [
        "_close: np.abs(np.asarray(one) - np.asarray(other)) <= tolerance -> "
        "np.abs(np.asarray(one) - np.asarray(other)) < tolerance",
        "is_rotation: np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-06) -> np.allclose(R.T @ R, np.eye(3), atol=1e-06)",
        "is_rotation: np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-06) -> np.allclose(R.T @ R, np.eye(3), rtol=0)",
        "is_rotation: np.isclose(np.linalg.det(R), 1, rtol=0, atol=1e-06) -> np.isclose(np.linalg.det(R), 1, atol=1e-06)",
        "is_rotation: np.isclose(np.linalg.det(R), 1, rtol=0, atol=1e-06) -> np.isclose(np.linalg.det(R), 1, rtol=0)",
        "same_rotation: np.allclose(q1, q2, rtol=0, atol=1e-06) -> np.allclose(q1, q2, atol=1e-06)",
        "same_rotation: np.allclose(q1, q2, rtol=0, atol=1e-06) -> np.allclose(q1, q2, rtol=0)",
        "same_rotation: np.allclose(q1, -np.asarray(q2), rtol=0, atol=1e-06) -> "
        "np.allclose(q1, -np.asarray(q2), atol=1e-06)",
        "same_rotation: np.allclose(q1, -np.asarray(q2), rtol=0, atol=1e-06) -> np.allclose(q1, -np.asarray(q2), rtol=0)",
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
    total = {
        name: sum(getattr(each, name) for each in found)
        for name in vars(found[0])
        if name not in ("exercise", "faults")
    }
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
    logging.disable()  # students print, warn and log
    exercise, found = EXERCISES[name], Adequacy(name)
    changed = mutants(exercise.reference, "autograder.exercises")
    changed += [(f"notebook: {what}", mutant) for what, mutant in mutants(notebook_solution(name))]
    reasons = EQUIVALENT | EQUIVALENT_HERE.get(name, {})
    listed = {what for changes in reasons.values() for what in changes}
    equivalent = {what for what, _ in changed if {what, what.removeprefix("notebook: ")} & listed}
    right = {label: function for (of, function), label in zip(RIGHT, NAMES) if of == name}
    wrong = {function.__name__: function for of, _, function in WRONG if of == name}
    found.misconceptions, found.right, found.wrong = len(exercise.misconceptions), len(right), len(wrong)
    found.equivalent, found.caught = len(equivalent), len(changed) - len(equivalent)
    with np.errstate(all="ignore"):
        for seed in SEEDS:
            cases = key(exercise, seed)
            for misconception in exercise.misconceptions:
                verdict = examine(name, cases, partial(call, misconception.wrong))
                if verdict.right or verdict.misconceptions != tuple(misconception.id.split(";")):
                    found.faults.append(f"{name}: {misconception.id} is called {verdict.misconceptions}")
            found.faults += [
                f"{name}: right, and refused: {label}" for label in right if not passes(right[label], cases)
            ]
            found.faults += [f"{name}: wrong, and accepted: {label}" for label in wrong if passes(wrong[label], cases)]
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
