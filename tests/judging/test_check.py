"""What a student sees of `check`: right, wrong, not done, and every way to call it wrongly; as text and as HTML."""

import copy
import math
import re

import numpy as np
import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from scipy.spatial.transform import Rotation
from support import ASKED, judged, key_of
from transform_lab import Point, Pose, Quaternion, check, once_done, tft
from transform_lab.check import CheckFailed
from transform_lab.judging import codec, comparison, lines, panel
from transform_lab.judging.advice import OUT
from transform_lab.judging.calling import call
from transform_lab.judging.kinds import KINDS
from transform_lab.judging.verdict import Reply, Verdict, _effort, compare, examine

from autograder.exercises import EXERCISES


@pytest.fixture
def said(capsys):
    return lambda: capsys.readouterr().out


@pytest.fixture
def shell():
    """IPython, as a notebook has it."""
    yield InteractiveShell.instance()
    InteractiveShell.clear_instance()


def to_pose(matrix):
    return Pose(Point(*matrix[:3, 3]), Quaternion(*tft.quaternion_from_matrix(matrix)))


def failing(name, function, said):
    """What check prints about a wrong function, and the line it fails with."""
    with pytest.raises(CheckFailed) as failure:
        check(name, function)
    assert failure.value._render_traceback_() == [str(failure.value)]
    return said(), str(failure.value)


def test_a_right_answer_gets_one_line(said):
    check("transform_to_pose", to_pose)
    assert said() == "transform_to_pose: all right.\n"


def test_a_stub_is_not_done_yet_and_does_not_fail(said):
    def stub(matrix):
        raise NotImplementedError

    check("transform_to_pose", stub)
    assert said() == "transform_to_pose: not done yet.\n0 of 4 points\n"


def test_a_wrong_answer_shows_what_is_right_what_was_expected_and_the_misconception(said):
    def w_first(matrix):
        x, y, z, w = tft.quaternion_from_matrix(matrix)
        return Pose(Point(*matrix[:3, 3]), Quaternion(w, x, y, z))

    text, line = failing("transform_to_pose", w_first, said)
    assert line.startswith("transform_to_pose: not right yet (position right, orientation ")
    assert "in another order than ROS's" in text
    for label in ("  matrix", "2 of 4 points"):
        assert label in text
    assert re.search(r"position     expected  x \S+   y \S+   z \S+\n +yours     x \S+   y \S+   z \S+   right", text)
    assert re.search(
        r"orientation  expected  x \S+   y \S+   z \S+   w \S+\n +yours .*w \S+   off by \d+ degrees", text
    )


def test_small_readable_numbers(said):
    text, _ = failing("rotation_about_z", lambda degrees: np.eye(3) * 0.123456789 - 1e-17, said)
    assert "0.1235" in text and "0.12345" not in text
    assert not re.search(r"-0\.?[\s\]]|\de-", text)


@pytest.mark.parametrize(
    "answer, misconception, words",
    [
        (None, "returned-none", "returned None"),
        ("text", "wrong-type", "a str instead of a Pose"),
        (np.eye(4), "wrong-type", "an array of shape (4, 4) instead of a Pose"),
        (Pose(Point(0, 0, 0), np.zeros(4)), "wrong-type", "orientation.x"),
        (Pose(Point(np.eye(2), 0, 0), Quaternion(0, 0, 0, 1)), "wrong-type", "position.x"),
        (
            Pose(Point([1, [2, 3]], 0, 0), Quaternion(0, 0, 0, 1)),
            "wrong-type",
            "a list instead of a number in position.x",
        ),
        (Pose(Point({1}, 0, 0), Quaternion(0, 0, 0, 1)), "wrong-type", "a set instead of a number in position.x"),
        (
            Pose(Point([].copy, 0, 0), Quaternion(0, 0, 0, 1)),
            "wrong-type",
            "a method instead of a number in position.x: call it, as in x().",
        ),
        (
            Pose(Point(), Rotation.identity()),
            "wrong-type",
            "\n    orientation  a Rotation (.as_quat() makes an array of it)\n",
        ),
        ([[[0] * 100] * 100] * 100, "wrong-type", "a list instead of a Pose"),
        (np.zeros((0, 3)), "wrong-type", "an array of shape (0, 3)"),
        (Pose(Point(float("nan"), 0, 0), Quaternion(0, 0, 0, 1)), "not-finite", "NaN"),
    ],
)
def test_answers_of_another_kind_are_named(said, answer, misconception, words):
    text, _ = failing("transform_to_pose", lambda matrix: answer, said)
    assert words in text and "0 of 4 points" in text
    verdict = examine("transform_to_pose", key_of("transform_to_pose"), lambda a, k: call(lambda matrix: answer, a, k))
    assert verdict.misconceptions == (misconception,)


def test_wrong_shapes_are_named(said):
    text, _ = failing("make_transform", lambda R, p: np.eye(3), said)
    assert "an array of shape (3, 3)" in text


def test_an_error_of_the_students_is_shown_in_one_line(said):
    def wrong(matrix):
        return undefined_name  # noqa: F821

    text, _ = failing("transform_to_pose", wrong, said)
    assert "NameError: name 'undefined_name' is not defined" in text
    assert ", in your line" not in text  # this file is no cell
    assert "Each notebook starts empty" in text
    assert "Traceback" not in text


def test_an_error_is_shown_with_the_students_own_line(shell):
    with capture_output() as shown:
        shell.run_cell(
            "from transform_lab import check\n"
            "def transform_point(a_T_b, p_in_b):\n"
            "    point = a_T_b @ p_in_b  # a comment\n"
            "    return point[:3]\n"
            "check('transform_point', transform_point)"
        )
    text = next(output.data["text/plain"] for output in shown.outputs)
    assert "(size 3 is different from 4), in your line 3: `point = a_T_b @ p_in_b  # a comment`" in text


def test_errors_are_counted_whatever_their_message(said):
    def wrong(matrix):
        raise ValueError(f"no {matrix[0, 3]}")

    text, _ = failing("transform_to_pose", wrong, said)
    assert "Your function raised an error: ValueError: no " in text

    def wrong_sometimes(matrix):
        return wrong(matrix) if matrix[0, 0] < -0.5 else to_pose(matrix)

    text, _ = failing("transform_to_pose", wrong_sometimes, said)
    assert re.search(r"raised an error in \d+ of \d+ cases", text)


def test_the_forgotten_fourth_coordinate_is_explained(said):
    text, _ = failing("transform_point", lambda a_T_b, p_in_b: a_T_b @ p_in_b, said)
    assert "what belongs in the fourth place?" in text


def test_what_is_printed_while_checking_is_not_shown_but_known(said):
    text, _ = failing("transform_point", lambda a_T_b, p_in_b: print("here:", p_in_b), said)
    assert "here:" not in text and "only `return` hands it" in text


def test_a_call_of_another_stub_is_no_stub(said):
    def invert_transform(a_T_b):
        raise NotImplementedError

    text, _ = failing("relative_transform", lambda a_T_b, a_T_c: invert_transform(a_T_b) @ a_T_c, said)
    assert "raised an error: NotImplementedError" in text and "works by itself" in text


def test_an_interrupted_check_says_so(said):
    def endless(*transforms):
        raise KeyboardInterrupt

    text, _ = failing("chain", endless, said)
    assert "interrupted before it was done" in text and "loop that never ends" in text


def test_an_exercise_without_arguments_does_not_show_its_answer(said):
    text, _ = failing("hand_transform", lambda: np.eye(4), said)
    assert "yours" in text and "expected" not in text


def test_answers_that_look_alike_show_how_far_apart_they_are(said):
    rotation = EXERCISES["rotation_about_z"].reference
    text, _ = failing("rotation_about_z", lambda degrees: rotation(degrees + 1e-3), said)
    assert "rotation: off by 0.001 degrees" in text
    text, _ = failing("rotation_about_z", lambda degrees: rotation(degrees).round(4), said)
    assert "Your answer is right, but rounded." in text


@pytest.mark.parametrize(
    "name, wrong, words",
    [
        (
            "rotation_from_axes",
            lambda x, y: np.column_stack((x, y, np.cross(y, x))),
            "a mirror image, not a rotation: the axes are left",
        ),
        (
            "rotation_from_axes",
            lambda x, y: np.column_stack((x, y, x + y)),
            "not a rotation: its columns are not all of",
        ),
        ("make_transform", lambda R, p: np.vstack((np.column_stack((R, p)), [0, 0, 0, 0])), "bottom row: wrong"),
        (
            "make_transform",
            lambda R, p: np.vstack((np.column_stack((R, 0 * p)), [0, 0, 0, 1])),
            "translation: off by 3.74 m",
        ),
        ("transform_point", lambda T, p: T[:3, 3], "   off by "),
        ("transform_to_pose", lambda T: Pose(Point(*T[:3, 3]), Quaternion()), "no orientation: all four numbers are 0"),
        ("transform_to_pose", lambda T: Pose(Point(*T[:3, 3]), Quaternion(0, 0, 0, 2)), ", and of length 2"),
        ("transform_to_pose", lambda T: Pose(Point(*T[:3, 3]), Quaternion(1e200, 0, 0, 1)), "and of length inf"),
        (
            "transform_point",
            lambda T, p: ["0.1", "0.2", "0.3"],
            "a list with a str in it instead of an array of 3 coordinates",
        ),
        ("transform_point", lambda T, p: np.zeros((500, 2)), "yours  an array of shape (500, 2)"),
        ("is_rotation", lambda R: True, "  expected  False\n  yours     True"),
        ("chain", lambda *transforms: transforms[0], "transforms[1]"),
        ("is_rotation", lambda R: abs(np.linalg.det(R) - 1) < 1e-6, "not right yet (right in "),
    ],
)
def test_how_far_an_answer_is_off(said, name, wrong, words):
    text, _ = failing(name, wrong, said)
    assert words in text


# --- the picture ----------------------------------------------------------------------------------------------------


def pictured(name, wrong):
    verdict = examine(name, key_of(name), lambda args, kwargs: call(wrong, args, kwargs))
    return comparison.scene(verdict)


@pytest.mark.parametrize(
    "name, wrong, frames, points",
    [
        ("rotation_about_z", lambda degrees: np.eye(3), {"b (expected)", "b (yours)"}, set()),
        ("invert_transform", lambda T: T, {"a (expected)", "a (yours)"}, set()),
        ("transform_point", lambda T, p: p, {"b"}, {"p (expected)", "p (yours)"}),
        ("relative_transform", lambda B, C: C, {"a", "c (expected)", "c (yours)"}, set()),
        ("object_in_gripper", lambda C, G, p: p, {"base", "camera"}, {"p (expected)", "p (yours)"}),
        ("pre_grasp", lambda pose, distance=0.1: pose, {"object", "pre_grasp (expected)", "pre_grasp (yours)"}, set()),
        ("chain", lambda *T: T[0] if len(T) < 4 else np.eye(4), {"last (expected)", "last (yours)", "link 1"}, set()),
        ("hand_transform", lambda: np.eye(4), {"b (yours)"}, set()),  # what is expected is the solution
    ],
)
def test_the_failing_case_is_drawn_as_frames(name, wrong, frames, points):
    words = pictured(name, wrong).description()
    assert set(re.findall(r"^frame (.+) in ", words, re.M)) == frames
    assert set(re.findall(r"^point (.+) in ", words, re.M)) == points


def test_the_expected_frame_is_where_it_should_be():
    def wrong(base_T_camera, base_T_gripper, p):
        return p

    scene = pictured("object_in_gripper", wrong)
    case = examine("object_in_gripper", key_of("object_in_gripper"), lambda a, k: call(wrong, a, k)).failing
    base_T_camera, base_T_gripper, p = map(codec.decode, case["args"])
    assert np.allclose(scene.lookup("base", "camera"), base_T_camera)
    assert np.allclose(scene.lookup("base", "gripper"), base_T_gripper)


def test_columns_that_are_no_axes_are_drawn_as_arrows():
    words = pictured("rotation_from_axes", lambda x, y: np.column_stack((x, y, x + y))).description()
    assert set(re.findall(r"^arrow (.+) in ", words, re.M)) == {f"{letter} of b (yours)" for letter in "xyz"}


@pytest.mark.parametrize(
    "name, wrong",
    [
        ("is_rotation", lambda R: True),
        ("transform_to_pose", lambda matrix: None),
        ("transform_to_pose", lambda matrix: Pose()),  # no orientation
        ("make_transform", lambda R, p: np.zeros((4, 4))),
    ],
)
def test_what_cannot_be_drawn_is_not(name, wrong):
    assert pictured(name, wrong) is None


def test_the_picture_follows_the_panel_and_a_right_answer_has_none(shell):
    with capture_output() as wrong:
        shell.run_cell("import numpy as np\nfrom transform_lab import check\ncheck('invert_transform', lambda T: T)")
    with capture_output() as right:
        shell.run_cell("check('invert_transform', np.linalg.inv)")
    (panel_shown,) = [
        o.data["text/html"] for o in wrong.outputs if "text/html" in o.data and "<iframe" in o.data["text/html"]
    ]
    assert "a (expected)" in panel_shown and "data:image/webp" in panel_shown
    assert "Your answer is the transform itself" in panel_shown
    assert all("<iframe" not in o.data.get("text/html", "") for o in right.outputs)


def test_a_changed_argument_is_said_beside_what_else_is_wrong(said):
    def right_but_spoils(matrix):
        pose = to_pose(matrix)
        matrix[0, 3] += 1
        return pose

    text, line = failing("transform_to_pose", right_but_spoils, said)
    assert "changed one of its arguments" in text and "expected" not in text
    assert line == "transform_to_pose: not right yet."

    def base_frame_and_spoils(object_pose, distance=0.1):
        object_pose.position.x -= distance
        return object_pose

    verdict = examine("pre_grasp", key_of("pre_grasp"), lambda a, k: call(base_frame_and_spoils, a, k))
    assert verdict.misconceptions == ("input-mutated", "base-frame-offset")
    assert verdict.credit == 0.0


def test_an_exercise_that_does_not_exist():
    with pytest.raises(CheckFailed, match="no exercise called 'banana'; there are rotation_about_z, "):
        check("banana", to_pose)


def waypoint(object_pose, offset):
    raise NotImplementedError


@pytest.mark.parametrize(
    "given, says",
    [
        ((waypoint,), "check takes the exercise's name in quotes first, then the function: "),
        ((waypoint, waypoint), "check takes the exercise's name in quotes first, then the function: "),
        ((waypoint, "waypoint"), "check takes the exercise's name in quotes first, then the function: "),
        ((Pose(), "waypoint"), "check takes the exercise's name in quotes first, then the function: "),
        (("waypoint",), "check takes, after the name, the function itself, without parentheses: "),
        (("waypoint", Pose()), "check takes, after the name, the function itself, without parentheses: "),
        (("waypoint", "waypoint"), "check takes, after the name, the function itself, without quotes: "),
        (("waypiont", waypoint), "There is no exercise called 'waypiont'; did you mean "),
    ],
)
def test_a_wrong_call_is_told_the_right_one(given, says):
    with pytest.raises(CheckFailed) as failure:
        check(*given)
    assert str(failure.value).rstrip("?") == f'{says}check("waypoint", waypoint)'


def test_the_key_is_missing(monkeypatch, tmp_path):
    import sys

    module = sys.modules["transform_lab.check"]
    monkeypatch.setattr(module, "KEY", tmp_path / "key.json")
    module._key.cache_clear()
    with pytest.raises(CheckFailed, match="fetch the assignment's folder again"):
        check("transform_to_pose", to_pose)
    module._key.cache_clear()


def test_while_grading_check_has_no_opinion(said, monkeypatch):
    monkeypatch.setenv("TRANSFORM_LAB_GRADING", "1")
    check("transform_to_pose", lambda matrix: None)
    assert said() == "transform_to_pose: the grader calls this function itself.\n"


def test_once_done(said):
    with once_done("chain"):
        print("the picture")
    assert said() == "the picture\n"
    with once_done("chain"):
        raise NotImplementedError
    assert said() == "This part appears once chain is done.\n"
    with once_done("chain"):
        raise ValueError("no\nmatrix")
    assert said() == "This part appears once chain is right; now it stops with ValueError: no matrix\n"


def test_html_escapes_what_students_write():
    def wrong(matrix):
        raise ValueError("<script>alert(1)</script>")

    verdict = examine("transform_to_pose", key_of("transform_to_pose"), lambda a, k: call(wrong, a, k))
    assert "<script>" not in panel.html(verdict)
    assert "&lt;script&gt;" in panel.html(verdict)


def test_feedback_on_hidden_cases_has_no_numbers():
    hidden = EXERCISES["transform_to_pose"]
    verdict = examine("transform_to_pose", key_of("transform_to_pose"), lambda a, k: call(lambda m: Pose(), a, k))
    assert verdict.failing is not None and hidden
    for render in (panel.text, panel.html):
        shown = render(verdict, numbers=False)
        assert f"Kind of case: {verdict.failing['family']}." in shown
        assert "expected" not in shown and "matrix:" not in shown


@pytest.mark.parametrize(
    "outcome, why, status, words",
    [
        ("timeout", "", "timeout", "did not finish in time."),
        ("timeout", "the notebook's time was over", "timeout", "did not finish in time: the notebook's time was over."),
        ("killed", "", "killed", "used too much."),
        (
            "killed",
            "it used more than 2 GB of memory",
            "killed",
            "had to be stopped: it used more than 2 GB of memory.",
        ),
        ("undefined", "", "error", "There is no function called chain"),
        ("not done", "", "error", "Not done yet"),
    ],
)
def test_what_ends_an_examination(outcome, why, status, words):
    calls = []

    def answer(args, kwargs):
        calls.append(args)
        return Reply(outcome, error=why)

    verdict = examine("chain", key_of("chain"), answer)
    assert (verdict.status, verdict.credit, len(calls)) == (status, 0.0, 1)
    assert words in verdict.says


def test_a_verdict_is_right_only_with_all_the_credit():
    assert Verdict("chain", credit=1.0).right
    assert not Verdict("chain", credit=0.99).right


# --- what an answer really was ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name, answer, words",
    [
        ("transform_to_pose", (Quaternion(), Point()), "a tuple of a Quaternion and a Point instead of a Pose"),
        ("transform_to_pose", [Quaternion(), Point()], "a list instead of a Pose"),
        ("transform_to_pose", Pose, "the class Pose itself, without parentheses, instead of a Pose"),
        ("transform_to_pose", Pose(Point(None, 0, 0), Quaternion()), "0 of 4 points"),
        ("transform_point", (1.0, 2.0, None), "a tuple with None in it instead of an array of 3 coordinates"),
        ("transform_point", (1.0, 2.0), "a tuple of shape (2,) instead of an array of 3 coordinates"),
        ("transform_point", np.ones(2), "an array of shape (2,) instead of an array of 3 coordinates"),
        ("transform_point", [[1, 2], [3, 4]], "a list of shape (2, 2) instead of an array of 3 coordinates"),
        ("transform_point", 0.5, "a float instead of an array of 3 coordinates"),
        ("transform_point", {1.0, 2.0}, "a set instead of an array of 3 coordinates"),
        ("make_transform", [[1.0, 0.0], [0.0]], "a list of rows that differ in length instead of a 4x4 array"),
        ("make_transform", [["1", 0.0], [0.0, 1.0]], "a list with a str in it instead of a 4x4 array"),
        ("make_transform", np.eye(4) == 1, "an array of shape (4, 4) of True and False instead of a 4x4 array"),
        ("make_transform", np.eye, "a function instead of a 4x4 array"),
        ("is_rotation", (True, False), "a tuple of a bool and a bool instead of True or False"),
        ("is_rotation", np.eye(3) == 1, "an array of shape (3, 3) instead of True or False"),
    ],
)
def test_what_came_is_called_what_it_is(said, name, answer, words):
    text, _ = failing(name, lambda *args: answer, said)
    assert words in text


@pytest.mark.parametrize("name", [name for name in EXERCISES if EXERCISES[name].returns in ("pose", "transform")])
def test_a_part_that_is_no_number_leaves_the_others_as_they_are(name):
    """NaN in one part of an answer: that part is wrong, all others are read, counted and worth what they are without it."""
    exercise, parts = EXERCISES[name], KINDS[EXERCISES[name].returns].parts
    for spoilt in ("orientation", "position") if exercise.returns == "pose" else ("rotation", "translation"):
        for value in (np.nan, np.inf):

            def spoils(*args, spoilt=spoilt, value=value, **kwargs):
                answer = copy.deepcopy(exercise.reference(*args, **kwargs))
                if spoilt in ("rotation", "translation"):
                    answer[0, 0 if spoilt == "rotation" else 3] = value
                else:
                    getattr(answer, spoilt).x = value
                return answer

            verdict = judged(name, spoils)
            assert verdict.misconceptions == ("not-finite",)
            assert verdict.parts == {part: 0 if part == spoilt else verdict.cases for part in parts}
            others = sum(share for part, share in exercise.credit.items() if part != spoilt)
            assert verdict.credit == pytest.approx(others)
            assert "NaN or infinity" in panel.text(verdict) and comparison.scene(verdict) is None


def test_messages_name_no_notebook_that_the_reader_is_in():
    for notebook, released in ASKED.items():
        for name in released.points:
            for misconception in key_of(name)["misconceptions"]:
                told = f"{misconception['says']} {misconception['hint']}"
                assert not re.search(rf"\bnotebook {notebook[0]}\b", told, re.I), (name, told)


@pytest.mark.parametrize("answer", [None, np.eye(3), "text"])
def test_in_how_many_cases_an_answer_was_none(answer):
    """A path without a return, or with another one, is not the whole function."""

    def sometimes(a_T_b, p_in_b):
        return EXERCISES["transform_point"].reference(a_T_b, p_in_b) if a_T_b[0, 3] <= 0 else answer

    assert re.search(r" in \d+ of \d+ cases", judged("transform_point", sometimes).says)
    assert " cases" not in judged("transform_point", lambda a_T_b, p_in_b: answer).says


# --- arguments that are changed --------------------------------------------------------------------------------------

WITH_ARGUMENTS = [name for name in EXERCISES if key_of(name)["parameters"]]


def spoiling(function):
    """The function, and after it something else in each of its arguments that can be changed."""

    def spoils(*args, **kwargs):
        answer = copy.deepcopy(function(*args, **kwargs))
        for value in (*args, *kwargs.values()):
            if isinstance(value, np.ndarray):
                value[...] = 7
            elif isinstance(value, Pose):
                value.position.x += 7
        return answer

    return spoils


@pytest.mark.parametrize("name", [name for name in WITH_ARGUMENTS if name != "rotation_about_z"])
def test_right_numbers_with_a_changed_argument_earn_half_in_every_exercise(name):
    verdict = judged(name, spoiling(EXERCISES[name].reference))
    assert verdict.misconceptions == ("input-mutated",) and verdict.credit == pytest.approx(0.5)
    assert verdict.says.startswith("Your answers are right, but your function changed one of its arguments")
    assert verdict.failing is None


@pytest.mark.parametrize("name", [name for name in WITH_ARGUMENTS if name != "rotation_about_z"])
def test_a_changed_argument_halves_what_a_wrong_answer_earns(name):
    for misconception in EXERCISES[name].misconceptions[::4]:
        without, spoilt = judged(name, misconception.wrong), judged(name, spoiling(misconception.wrong))
        assert not spoilt.right and 0 <= spoilt.credit <= without.credit
        if "raised" not in spoilt.says:
            assert spoilt.credit == pytest.approx(0.5 * without.credit)


def test_a_case_that_changes_its_arguments_costs_its_family_alone():
    def chain(*transforms):
        answer = copy.deepcopy(EXERCISES["chain"].reference(*transforms))
        if len(transforms) == 1:
            transforms[0][0, 0] += 1
        return answer

    verdict, weights = judged("chain", chain), key_of("chain")["weights"]
    families = {case["family"] for case in key_of("chain")["cases"] if len(case["args"]) == 1}
    lost = sum(weights[family] for family in families) / sum(weights.values())
    assert families and verdict.credit == pytest.approx(1 - 0.5 * lost)


@pytest.mark.parametrize("product", [np.dot, np.matmul])
def test_a_third_array_is_where_the_product_is_written(product):
    verdict = judged("chain", lambda *transforms: product(*transforms))
    assert verdict.misconceptions == ("input-mutated",)
    assert verdict.hint.split("\n")[0] == OUT and "a plain `=`" not in verdict.hint.lower()


def test_what_a_changed_argument_brings_about_has_no_name_of_its_own():
    def pre_grasp(object_pose, distance=0.1):
        before = copy.deepcopy(object_pose)
        object_pose.position = EXERCISES["pre_grasp"].reference(object_pose, distance).position
        return before

    verdict = judged("pre_grasp", pre_grasp)
    assert verdict.misconceptions == ("input-mutated",) and "written into the argument" in verdict.hint

    def is_rotation(R):
        for i in range(3):  # what is left of the columns is at right angles, whatever was there
            for j in range(i):
                R[:, i] -= (R[:, j] @ R[:, i]) * R[:, j]
        return bool(np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-6)) and np.linalg.det(R) > 0

    assert judged("is_rotation", is_rotation).misconceptions == ("input-mutated",)


# --- the example that is shown ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", WITH_ARGUMENTS)
def test_the_example_is_the_easiest_of_those_that_fail(name):
    """Over all families: no failing case has fewer numbers to reckon with, or easier ones."""
    for misconception in EXERCISES[name].misconceptions[::3]:
        verdict = judged(name, misconception.wrong)
        failing = [case for case in key_of(name)["cases"] if fails(name, misconception.wrong, case)]
        assert _effort([verdict.failing["args"], verdict.failing["kwargs"]]) == min(
            _effort([case["args"], case["kwargs"]]) for case in failing
        )


def fails(name, function, case):
    with np.errstate(all="ignore"):
        return not compare(EXERCISES[name].returns, case, call(function, case["args"], case["kwargs"])).answered


def test_what_is_easy_to_reckon_with():
    half = np.sqrt(0.5)
    easy_first = [
        [0.0, 0.0],
        [1.0, 0.0],
        [90, 0.0],
        [1.0, -2.0],
        [half, 3.0],
        [0.25, half],
        [0.123456, 0.0],
        [0.123456, 0.5],
    ]
    efforts = [_effort([codec.encode(np.array(numbers))]) for numbers in easy_first]
    assert efforts == sorted(efforts) and efforts[0] == 0
    assert _effort([codec.encode(np.eye(4))]) < _effort(
        [codec.encode(Pose(Point(0.123, 0, 0), Quaternion(0, 0, 0, 1)))]
    )


# --- numbers --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("number, shown", [
    (0.70710678, "0.7071"), (0.5, "0.5"), (6e-17, "0"), (1.0 - 2e-16, "1"), (-6.1e-17, "0"), (7.0, "7"),
    (0.500001, "0.500001"), (-0.499999, "-0.499999"), (1.000004, "1.000004"), (6.4e-6, "6.4e-06"), (0.9999998, "0.9999998"),
])  # fmt: skip
def test_what_is_almost_a_simple_number_is_shown_as_what_it_is(number, shown):
    assert lines.row([number]) == shown


@pytest.mark.filterwarnings("error")
def test_what_is_no_number_is_shown_without_a_warning():
    assert lines.row([np.float64(number) for number in (math.inf, math.nan, -math.inf)]) == lines.row(
        [math.inf, math.nan, -math.inf]
    )


def test_two_that_are_not_the_same_do_not_look_the_same(said):
    """So that nobody is told that two quaternions differ which read alike."""

    def generous(q1, q2):
        return min(np.abs(q1 - q2).max(), np.abs(q1 + q2).max()) <= 1e-5

    text, _ = failing("same_rotation", generous, said)
    first, second = re.findall(r"^ +q[12] +(.*)$", text, re.MULTILINE)
    assert first != second
