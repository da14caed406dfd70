"""`prove` finds what an author planted: each hole in an exercise is said, with a case that closes it."""

import re
import shutil
import subprocess
import sys

import nbformat
import numpy as np
import pytest
from support import MADE_AT_RUN_TIME, ROOT

from autograder.command_line import run
from autograder.course import Course
from autograder.exercises import EXERCISES
from autograder.proving import search
from autograder.proving.adequacy import quiet
from autograder.proving.solutions import to_be_tried

SPECIFICATION = """
import numpy as np

from .specification import Case, Exercise, Misconception


def raised(p, height):
    return np.array([p[0], p[1], p[2] + height])


def cases(rng):
    found = [Case("a point on the diagonal", (np.array([a, a, a]), 1.0)) for a in rng.uniform(0.2, 0.9, size=3)]
    found += []  # more
    return found


EXERCISES = (
    Exercise(
        name="raised",
        returns="coordinates",
        answer="p_in_a",
        reference=raised,
        cases=cases,
        equivalent={
            "so they say": (
                "raised: np.array([p[0], p[1], p[2] + height]) -> [p[0], p[1], p[2] + height]",
                "raised: p[2] + height -> p[2] - height",
                "raised: q -> -q",
            )
        },
        misconceptions=(
            Misconception("wrong-sign", lambda p, height: raised(p, -height), "Down.", "Up?"),
            Misconception("only-up", lambda p, height: raised(p, abs(height)), "Up.", "Down?"),
            Misconception("one", lambda p, height: p, "Still there.", "Up?"),
            Misconception("other", lambda p, height: p, "Still there.", "Up?"),
        ),
    ),
)
"""
SOLUTION = """
def raised(p, height):
    x, y, z = p
    while x > 180:  # never true, but some of its mutants have no end
        x = x - 360
    return np.array([x, y, z + height])
"""
OWN = """
import numpy as np
from solutions.right import right
from solutions.wrong import wrong


@right("raised")
def plus(p, height):
    return p + np.array([0, 0, height])


@right("raised")
def rounded(p, height):
    return np.round(p + np.array([0, 0, height]), 1)


@wrong("raised")
def not_far(p, height):
    return p + np.array([0, 0, min(height, 2)])
"""


@pytest.fixture(scope="module")
def scratch(tmp_path_factory):
    """A course with one exercise more, which has a hole of every kind."""
    root = tmp_path_factory.mktemp("scratch") / "course"
    shutil.copytree(ROOT, root, ignore=shutil.ignore_patterns(*MADE_AT_RUN_TIME, "notebooks"))
    exercises = root / "autograder" / "exercises"
    (exercises / "raising.py").write_text(SPECIFICATION)
    init = exercises / "__init__.py"
    init.write_text(init.read_text().replace("MODULES = (", 'MODULES = ("raising", '))
    (root / "tests" / "solutions" / "raising.py").write_text(OWN)
    path = next((root / "source" / "transforms").glob("1_*.ipynb"))
    notebook = nbformat.read(path, as_version=4)
    cell = nbformat.v4.new_code_cell(SOLUTION, metadata={"nbgrader": {"grade_id": "raised-solution"}})
    nbformat.write(nbformat.from_dict({**notebook, "cells": [*notebook.cells, cell]}), path)
    return root


def prove(root, *options):
    """(exit code, what is printed without line breaks within a line's text)"""
    done = subprocess.run(
        [sys.executable, "-m", "autograder", "prove", *options], cwd=root, capture_output=True, text=True
    )
    assert "Traceback" not in done.stderr, done.stderr
    return done.returncode, done.stdout + done.stderr


@pytest.fixture(scope="module")
def said(scratch):
    exit_code, said = prove(scratch, "raised", "--seeds", "3")
    assert exit_code == 1
    return said


def paragraphs(said):
    """[(what is open, its details)]"""
    return [tuple(part.partition("\n")[::2]) for part in re.split(r"\n(?=raised: )", said)[1:]]


def details_of(said, beginning):
    found = [details for point, details in paragraphs(said) if point.startswith(f"raised: {beginning}")]
    assert found, said
    return found


def test_the_table_counts(said):
    row = next(line for line in said.splitlines() if line.startswith("raised "))
    numbers = re.findall(r"\d+ of \d+|\S+", row)
    assert numbers[:5] == ["raised", "3", "0", "3 of 4", "1 of 4"]
    assert numbers[7:] == ["1 of 2", "2 of 4", said.split()[-2]]
    assert re.search(r"the answer in the type of p +0 of 1", said)
    assert re.search(r"only-up \(2\) +nothing", said)
    assert re.search(r"wrong-sign \(1\) +all families +by its own name", said)


def test_what_slips_through_is_said_with_a_case_that_closes_it(scratch, said, slow):
    assert details_of(said, "the misconception only-up (2), not caught on all 3 seeds")
    assert details_of(said, "the wrong solution not_far, accepted on all 3 seeds")
    source = "return np.array([p[0], p[1], p[2] + height])"
    line = 1 + SPECIFICATION.splitlines().index(f"    {source}")
    swapped = "changed: raised: [p[0], p[1], p[2] + height] -> [p[1], p[0], p[2] + height]"
    (details,) = (details for point, details in paragraphs(said) if re.match(r"raised: \d+ mutants of a line", point)
                  if f"exercises/raising.py, line {line}:\n    {source}\n" in details)  # fmt: skip
    assert swapped in details and "A case that would catch each of them:" in details
    assert "1_rotation.ipynb, cell raised-solution, line 6:" in said
    suggested = list(dict.fromkeys(re.findall(r"^ +(Case\(.*\))$", said, re.MULTILINE)))
    more = ", ".join(case for case in suggested if search.FAMILY in case)
    path = scratch / "autograder" / "exercises" / "raising.py"
    try:
        path.write_text(SPECIFICATION.replace("[]  # more", f"[{more}]"))
        exit_code, again = prove(scratch, "raised", "--seeds", "3")
    finally:
        path.write_text(SPECIFICATION)
    assert exit_code == 1
    for closed in ("the misconception only-up", "the wrong solution", f"raising.py, line {line}:"):
        assert closed in said and closed not in again.split("declared as equivalent")[0]
    survivors = [details for point, details in paragraphs(again) if " of a line, not caught" in point]
    assert survivors and all("No case found" in details for details in survivors)


def test_shortcuts_of_one_kind_are_said_together(said):
    (details,) = (details for point, details in paragraphs(said) if point.startswith("raised: 5 shortcuts, not caught"))
    for limit in ("1e-05", "0.0001", "0.001", "0.01", "0.1"):
        assert f"numbers of the answer below {limit} taken for 0" in details


def test_what_no_case_tells_apart_may_be_declared(said):
    (details,) = (details for _, details in paragraphs(said) if "cell raised-solution, line 5:" in details)
    assert "No case found that tells it apart: perhaps it is equivalent." in details
    assert '"the reason": ("notebook: raised: x - 360 -> x + 360", ' in details


def test_a_declaration_that_is_wrong_is_said(said):
    (details,) = details_of(said, "declared as equivalent, and caught on all 3 seeds")
    assert "changed: raised: p[2] + height -> p[2] - height" in details
    assert re.search(r"Case\(\"a point on the diagonal\", \(np.array\(\[0\.\d+", details)
    (details,) = details_of(said, "declared as equivalent, and made no longer")
    assert details.split("\n")[0].strip() == "changed: raised: q -> -q"


def test_other_names_and_refused_solutions_are_said(said):
    assert details_of(said, "the misconception one (3) is called entry-slip")
    assert details_of(said, "the misconception other (4) is called entry-slip")
    (details,) = details_of(said, "right (rounded), and refused")
    assert 'Case("a point on the diagonal"' in details
    assert "right (plus)" not in said and "the notebook's solution" not in said and "only-up (2) is called" not in said


def test_nothing_is_open_in_an_exercise_of_the_course(capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert run(["prove", "hand_transform", "--seeds", "2"]) == 0
    said = capsys.readouterr().out
    assert said.strip().endswith("Nothing is open.")
    row = next(line for line in said.splitlines() if line.startswith("hand_transform "))
    number = str(len(EXERCISES["hand_transform"].misconceptions))
    assert row.split()[1:5] == ["1", "0", number, number]


def test_an_unknown_exercise(capsys, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert run(["prove", "chian"]) == 2
    said = capsys.readouterr().err
    assert "There is no exercise called chian. Did you mean chain?" in said
    assert all(name in said for name in EXERCISES)


def test_a_specification_that_stops_is_said_without_a_traceback(scratch):
    path = scratch / "autograder" / "exercises" / "raising.py"
    for old, new, told in (
        ("rng.uniform", "rng.uniformly", "'uniformly' (raising.py, line "),
        ("def cases(rng):", "def cases(rng:", "cannot be read: '(' was never closed (raising.py, line "),
        ("return np.array([", "return str([", "the reference's answer to a case of 'a point on the diagonal' is a str"),
    ):
        try:
            path.write_text(SPECIFICATION.replace(old, new, 1))
            exit_code, said = prove(scratch, "raised", "--seeds", "2")
        finally:
            path.write_text(SPECIFICATION)
        assert exit_code == 2
        assert told in said


@pytest.mark.parametrize("name", EXERCISES)
def test_the_search_finds_what_is_wrong_and_nothing_that_is_right(name, monkeypatch, slow):
    exercise = EXERCISES[name]
    tried = to_be_tried(Course(ROOT), exercise)
    known_right = [each.function for each in tried if each.kind == "right"]
    cases = search.Search(exercise, known_right)
    for each in tried:
        if each.kind == "misconception":
            case = cases.case_for(each.function)
            assert case, each.label
            with quiet():
                assert search.answered_by_reference(exercise, case).refusing(each.function) == 0
    monkeypatch.setattr(search, "MOST", 200)
    cases = search.Search(exercise, known_right)
    for each in tried:
        if each.kind == "equivalent":
            assert cases.case_for(each.function) is None, each.label


def test_the_search_keeps_to_what_the_exercise_asks():
    """Two axes stay unit vectors at right angles, whatever is put in their place."""
    proposed = [case.args for case in search.Candidates(EXERCISES["rotation_from_axes"]).all()]
    assert len(proposed) == search.MOST and len({str(axes) for axes in proposed}) > 100
    for x_axis, y_axis in proposed:
        assert abs(x_axis @ y_axis) < 1e-6
        assert np.linalg.norm(x_axis) == pytest.approx(1) and np.linalg.norm(y_axis) == pytest.approx(1)


def test_the_search_asks_nothing_that_right_solutions_differ_about():
    exercise = EXERCISES["transform_point"]
    wrong = exercise.misconceptions[0].wrong
    assert search.Search(exercise).case_for(wrong)
    assert search.Search(exercise, [wrong]).case_for(wrong) is None
