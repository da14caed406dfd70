"""The table of kinds of answers is the one place: each of its kinds has all it needs, and a new one works everywhere."""

import itertools
import json
import math
import re
import sys

import nbformat
import numpy as np
import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from scipy.spatial.transform import Rotation
from support import ROOT, SEEDS, judged
from transform_lab import Point, Pose, PoseStamped, Quaternion, Viewer
from transform_lab.check import CheckFailed, check
from transform_lab.judging import codec, comparison, panel, verdict
from transform_lab.judging.answers import is_right, parts_of, same
from transform_lab.judging.calling import call
from transform_lab.judging.kinds import KINDS, Kind, Part
from transform_lab.judging.naming import GENERAL
from transform_lab.judging.reading import Unfit, array
from transform_lab.judging.verdict import Reply, compare, examine, is_right_itself

from autograder.course import Course
from autograder.exercises import EXERCISES, PUBLIC_SEED, Case, Exercise, Misconception, key
from autograder.exercises.cases import rotation_about
from autograder.grading.judge import judge, rows
from autograder.grading.public_example import public_cases
from autograder.handout import exercises_page
from autograder.intake.restore import restore
from autograder.pages import examples
from autograder.released import Released
from autograder.sandbox import Limits, Sandbox

# --- each kind ------------------------------------------------------------------------------------------------------

every_kind = pytest.mark.parametrize("returns", KINDS)
NAN = float("nan")
ANYTHING = [
    None, True, 0, 2, -1.5, NAN, "", "text", [], [1, 2, 3], [[1, 2], [3]], [[]], [None], ["1", "2", "3"], [[1, 0], [0, 1]],
    np.array(1.0), np.zeros(0), np.zeros(3), np.zeros((3, 1)), np.zeros((1, 3)), np.zeros(4), np.eye(3), np.eye(4), np.eye(5),
    np.full(3, NAN), np.full((3, 3), np.inf), np.full((4, 4), NAN), np.array([True]), np.ones((2, 2, 2)), np.zeros((40, 40)),
    Point(1, 2, 3), Quaternion(0, 0, 0, 1), Pose(), PoseStamped(), Pose(Point(1, 2, NAN), Quaternion(0, 0, 0, 1)),
    Pose([1, 2, 3], [0, 0, 0, 1]), Pose(Point("1", None, []), Quaternion()), Pose(Point(np.zeros(2), 0, 0), Quaternion()),
    (np.eye(3), np.zeros(3)), [np.eye(3), np.zeros(3)], (Point(1, 2, 3), Quaternion(0, 0, 0, 1)), {"a": 1}, 5j, object(), print,
]  # fmt: skip


def right_answers(returns):
    """What the exercises of a kind are answered with, decoded; none, and nothing here would be tested."""
    found = [exercise for exercise in EXERCISES.values() if exercise.returns == returns]
    assert found, f"no exercise returns an answer of the kind {returns!r}, so nothing tests it"
    for exercise in found:
        for seed in SEEDS:
            cases = exercise.drawn(seed)
            yield from (codec.encode(exercise.reference(*case.args, **case.kwargs)) for case in cases[::6])


@every_kind
def test_a_right_answer_can_be_read_and_agrees_with_itself(returns):
    kind = KINDS[returns]
    assert kind.wanted and kind.parts
    for answer in right_answers(returns):
        parts = parts_of(returns, codec.decode(answer))
        assert list(parts) == list(kind.parts)
        assert all(np.asarray(value).dtype == np.float64 for value in parts.values())
        assert same(returns, answer, answer)
        off = {name: part.off(parts[name], parts[name]) for name, part in kind.parts.items()}
        assert set(off.values()) == {"right"}


LOOKALIKES = {
    "whole numbers": lambda number: int(number) if type(number) is float and number == int(number) else number,
    "truths": lambda number: bool(number) if number in (0, 1) else number,
    "floats for truths": lambda number: float(number) if type(number) is bool else number,
    "minus zero": lambda number: -0.0 if number == 0 and type(number) is float else number,
    "the last digit": lambda number: math.nextafter(number, 9) if type(number) is float else number,
}


def numbers_changed(plain, change):
    if isinstance(plain, dict):
        return {name: value if name == "shape" else numbers_changed(value, change) for name, value in plain.items()}
    if isinstance(plain, list):
        return [numbers_changed(value, change) for value in plain]
    return plain if plain is None or isinstance(plain, str) else change(plain)


@every_kind
@pytest.mark.parametrize("change", LOOKALIKES.values(), ids=LOOKALIKES)
def test_what_only_looks_like_the_right_answer_is_compared_with_it(returns, change, monkeypatch):
    for right in itertools.islice(right_answers(returns), 20):
        case = {"args": [], "kwargs": {}, "expected": right}
        alike = numbers_changed(right, change)
        assert is_right_itself(case, json.loads(json.dumps(right)))
        assert is_right_itself(case, alike) == (json.dumps(alike) == json.dumps(right))
        at_once = compare(returns, case, Reply("returned", alike, [[], {}]))
        with monkeypatch.context() as patched:
            patched.setattr(verdict, "is_right_itself", lambda *_: False)
            compared = compare(returns, case, Reply("returned", alike, [[], {}]))
        assert (at_once.parts, at_once.answered, at_once.problem) == (
            compared.parts,
            compared.answered,
            compared.problem,
        )


@every_kind
def test_a_wrong_part_is_found_and_put_into_words(returns):
    kind = KINDS[returns]
    for answer in right_answers(returns):
        right = parts_of(returns, codec.decode(answer))
        for wrong in kind.parts:
            got = {**right, wrong: right[wrong] + 0.25}
            agree = {name: part.agree(got[name], right[name]) for name, part in kind.parts.items()}
            assert agree == {name: name != wrong for name in kind.parts}
            off = {name: part.off(got[name], right[name]) for name, part in kind.parts.items()}
            assert all((words == "right") == (name != wrong) for name, words in off.items()) and all(off.values())
            text = "\n".join(kind.show(got, right, off))
            assert "expected" in text and "yours" in text
            assert len(kind.parts) == 1 or all(name in text and words in text for name, words in off.items())


@every_kind
@pytest.mark.parametrize("number", range(len(ANYTHING)))
def test_whatever_a_function_returns_is_judged_and_shown(returns, number):
    """A student decides what comes; an error other than Unfit would end the grading of their notebook."""
    case = {"family": "any", "args": [1.0], "kwargs": {}, "expected": next(right_answers(returns)), "wrong": []}
    exercise = {
        "parameters": ["x"], "returns": returns, "answer": "a_T_b", "credit": {}, "weights": {"any": 1},
        "misconceptions": [], "cases": [case],
    }  # fmt: skip
    verdict = examine("any", exercise, lambda args, kwargs: call(lambda x: ANYTHING[number], args, kwargs))
    assert panel.text(verdict) and panel.html(verdict)
    if scene := comparison.scene(verdict):
        assert KINDS[returns].draw and scene.still()
    assert set(verdict.misconceptions) <= set(GENERAL)


@every_kind
def test_whatever_a_function_returns_is_read_or_refused_in_words(returns):
    """One thing, or two of them together, as functions in Python return two."""
    for value in [*ANYTHING, *itertools.product(ANYTHING, repeat=2), *map(list, itertools.product(ANYTHING, repeat=2))]:
        read_or_refused(returns, value)


def read_or_refused(returns, value):
    answer = codec.decode(codec.encode(value))
    try:
        parts = parts_of(returns, answer)
    except Unfit as unfit:
        assert unfit.misconception in GENERAL
        said = {"returned-none": "None"}
        words = said.get(unfit.misconception, r".* instead of .*|.*; fill in .*")
        assert re.fullmatch(words, str(unfit))
        return
    assert list(parts) == list(KINDS[returns].parts)
    if not all(np.isfinite(value).all() for value in parts.values()):  # of which no part is right, or like another
        assert not is_right(returns, answer, parts) and same(returns, codec.encode(answer), codec.encode(answer))


@every_kind
def test_it_is_drawn_or_said_not_to_be(returns):
    draw = KINDS[returns].draw
    for answer in right_answers(returns):
        if draw:
            viewer, parts = Viewer("a"), parts_of(returns, codec.decode(answer))
            draw(viewer, "b (expected)", parts, True, 0.5)
            draw(viewer, "b (yours)", parts, False, 0.5)
            assert "b (expected)" in viewer.description() and "b (yours)" in viewer.description()


@every_kind
def test_a_wrong_answer_is_shown_as_text_and_as_html(returns):
    """That of each misconception of an exercise of this kind."""
    name = next(name for name, exercise in EXERCISES.items() if exercise.returns == returns)
    for misconception in EXERCISES[name].misconceptions:
        verdict = judged(name, misconception.wrong)
        assert not verdict.right and "For example" in panel.text(verdict) and "For example" in panel.html(verdict)
        assert KINDS[returns].draw or comparison.scene(verdict) is None


def test_a_kind_that_is_not_in_the_table_is_refused_with_the_list():
    with pytest.raises(ValueError, match="turn: 'colour' is no kind of answer; there are rotation, transform, pose"):
        Exercise("turn", "colour", "", lambda R: 0.0, lambda rng: [])


def test_an_answer_whose_name_tells_no_frame_is_refused():
    with pytest.raises(ValueError, match="turn: 'goal' tells no frame"):
        Exercise("turn", "pose", "goal", lambda R: Pose(), lambda rng: [])


# --- one more kind --------------------------------------------------------------------------------------------------


def turn(a_R_b):
    """By how many degrees B is turned against A."""
    return float(np.degrees(Rotation.from_matrix(a_R_b).magnitude()))


IN_RADIANS = "Your angle is in radians."
TURN = """
import numpy as np

def turn(a_R_b):
    return {}
"""
IS_RIGHT, IS_IN_RADIANS, IS_OFF, IS_NO_NUMBER = (
    "float(np.degrees(np.arccos((np.trace(a_R_b) - 1) / 2)))",
    "float(np.arccos((np.trace(a_R_b) - 1) / 2))",
    "float(np.degrees(np.arccos((np.trace(a_R_b) - 1) / 2))) + 12.5",
    "[90.0]",
)


def cases(rng):
    families = {"about z": (0, 0, 1), "about a slanted axis": (1, 2, 2)}
    return [
        Case(family, (rotation_about(axis, math.radians(rng.uniform(20, 170))),))
        for family, axis in families.items()
        for _ in range(3)
    ]


@pytest.fixture
def exercise(monkeypatch):
    """An exercise whose answer is of a kind that nothing but its entry in the table knows."""
    angle = Kind(
        wanted="a number of degrees",
        parts={"angle": Part(unit="degrees")},
        read=lambda answer, wanted: {"angle": array(answer, wanted, ()).reshape(1)},
        draw=None,
    )
    monkeypatch.setitem(KINDS, "angle", angle)
    radians = Misconception("radians-returned", lambda a_R_b: math.radians(turn(a_R_b)), IN_RADIANS, "Convert it.")
    made = Exercise("turn", "angle", "", turn, cases, (radians,))
    monkeypatch.setitem(EXERCISES, "turn", made)
    examples._public.cache_clear()
    yield made
    examples._public.cache_clear()


def public_key(exercise):
    """The text of a key.json."""
    return json.dumps({"exercises": {"turn": {"points": 2.0, **key(exercise, PUBLIC_SEED)}}})


def solution(body):
    names = {}
    exec(TURN.format(body), names)
    return names["turn"]


@pytest.fixture
def checked(exercise, monkeypatch):
    """checked(body): what `check` displays of such a function in a notebook, {format: text}; and what it raises."""
    monkeypatch.setattr(sys.modules[check.__module__], "_key", lambda: json.loads(public_key(exercise)))
    InteractiveShell.instance()

    def show(body):
        failed = ""
        with capture_output() as shown:
            try:
                check("turn", solution(body))
            except CheckFailed as failure:
                failed = str(failure)
        return shown.outputs[0].data, failed

    yield show
    InteractiveShell.clear_instance()


def test_check_takes_a_new_kind(checked):
    shown, failed = checked(IS_RIGHT)
    assert (shown["text/plain"], failed) == ("turn: all right.", "")
    shown, failed = checked(IS_OFF)
    assert failed == "turn: not right yet."
    _, expected, yours = shown["text/plain"].splitlines()[-3:]
    assert re.fullmatch(r"  expected  \d+\.\d+", expected)
    assert re.fullmatch(r"  yours     \d+\.\d+   off by 12.5 degrees", yours)
    assert "off by 12.5 degrees" in shown["text/html"] and "<svg" not in shown["text/html"]
    shown, failed = checked(IS_IN_RADIANS)
    assert IN_RADIANS in shown["text/plain"] and IN_RADIANS in shown["text/html"]
    shown, failed = checked(IS_NO_NUMBER)
    assert "a list of shape (1,) instead of a number of degrees." in shown["text/plain"]


@pytest.mark.parametrize(
    "body, misconceptions",
    [
        (IS_IN_RADIANS, ("radians-returned",)),
        (f"round({IS_RIGHT}, 1)", ("rounded",)),
        ("12.0", ("hard-coded",)),
        ("None", ("returned-none",)),
        ("float('nan')", ("not-finite",)),
        ("'a quarter turn'", ("wrong-type",)),
        (IS_OFF, ()),
    ],
)
def test_the_diagnosis_takes_a_new_kind(exercise, body, misconceptions):
    verdict = examine("turn", key(exercise, 7), lambda args, kwargs: call(solution(body), args, kwargs))
    assert (verdict.right, verdict.misconceptions) == (False, misconceptions)
    assert comparison.scene(verdict) is None


def released_with(body):
    """A notebook with the exercise, as students get it; and the file of one who solved it so."""
    notebook = nbformat.v4.new_notebook()
    notebook.cells = [nbformat.v4.new_code_cell(TURN.format("None")), nbformat.v4.new_code_cell('check("turn", turn)')]
    for cell, name in zip(notebook.cells, ("turn-solution", "turn")):
        graded = name == "turn"
        cell.metadata["nbgrader"] = {
            "grade_id": name, "grade": graded, "solution": not graded, "locked": graded, "task": False,
            "schema_version": 3, "cell_type": "code", **({"points": 2} if graded else {}),
        }  # fmt: skip
    released = Released("6_turns", nbformat.writes(notebook))
    notebook.cells[0].source = TURN.format(body)
    return released, nbformat.writes(notebook).encode()


@pytest.mark.parametrize(
    "body, score, misconception", [(IS_RIGHT, 2.0, ""), (IS_IN_RADIANS, 0.0, "radians-returned"), (IS_OFF, 0.0, "")]
)
def test_the_judge_and_feedback_take_a_new_kind(exercise, body, score, misconception):
    released, handed_in = released_with(body)
    intake = restore(handed_in, released)
    with Sandbox(Course(ROOT).package, {}, Limits(), isolated=False) as sandbox:
        hidden, public = {"turn": key(exercise, 7)}, public_cases(public_key(exercise))
        verdicts, found = judge(intake, released, hidden, sandbox, public)
    (row,) = rows(released, verdicts)
    assert (row.score, row.max_score, row.status, row.misconception) == (score, 2.0, "graded", misconception)
    opinion = intake.notebook.cells[1].outputs[0].data["text/html"]
    assert ("all right" in opinion) == (score == 2.0) and "expected" not in opinion
    if score == 2.0:
        assert found == {}
    else:
        example = examples.of_answer("turn", found["turn"])
        assert "expected" in example and "yours" in example
        assert ("off by 12.5 degrees" in example) == (body == IS_OFF)


def test_report_and_the_page_of_exercises_take_a_new_kind(exercise):
    example = examples.of_misconception("turn", "radians-returned")
    assert "expected" in example and re.search(r"yours     \d\.\d+   off by \d+(\.\d+)? degrees", example)
    described = exercises_page._described(exercise, key(exercise, PUBLIC_SEED))
    assert described["rows"] == [{"id": "radians-returned", "says": IN_RADIANS, "hint": "Convert it.", "earns": [0]}]
