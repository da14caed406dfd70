"""What helps with the errors that beginners meet: each is raised by the code that raises it, and gets the advice that fits it."""

import math
import re
import time

import numpy as np
import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from scipy.spatial.transform import Rotation
from transform_lab import Point, Pose, Quaternion, tft
from transform_lab.judging.advice import advice
from transform_lab.judging.calling import one_line

# {part of the advice: lines, each of which raises an error that it helps with}
RAISED = {
    "its numbers are in its fields": [
        "T[:3, 3] = pose.position",
        "T[:3, 3] = [pose.position, 0, 0]",
        "pose.position[0]",
        "pose['position']",
        "pose.orientation.W",
        "x, y, z, w = pose.orientation",
        "[*pose.position]",
        "list(pose.position)",
        "float(pose.position)",
        "len(pose)",
        "abs(pose)",
        "pose + pose",
        "pose.position + p",
        "pose.position - pose.position",
        "pose.orientation * pose.orientation",
        "np.sin(pose)",
        "np.linalg.norm(pose.position)",
        "Rotation.from_quat(pose.orientation)",
    ],
    "`pose.position.x`": ["pose.x = 1", "pose.x", "pose.w"],
    "no message: they are `v[0]`": ["p.x", "T.position", "[1, 2].x", "(1, 2).y", "Pose(p, p).position.x"],
    "made with parentheses": ["Pose.position.x = 1", "Pose(Point, Quaternion).position.x + 1"],
    "its fields, ['x', 'y', 'z'], by name": ["Point(1, 2)", "Point(p)", "Point([1, 2, 3])"],
    "pair of brackets more": ["np.array([1, 0], [0, 1], [0, 0])", "np.array(1, 2, 3)"],
    "Is there a comma missing": ["np.array([[1, 0] [0, 1]])", "[[1, 2], [3, 4]][0, 1]"],
    "The shape is one argument": ["np.zeros(4, 4)", "np.ones(3, 3)", "np.empty(4, 4)", "np.identity(3, 3)"],
    "All rows need the same number": ["np.array([[1, 0, 0], [0, 1]])", "np.array([[R, p], [0, 1]])"],
    "all arrays as one list": ["np.hstack(R, p)", "np.vstack(R, p)", "np.column_stack(p, p)", "np.linalg.multi_dot(T, T)"],
    "handed over as one list": ["np.concatenate(R, p)"],
    "neither a row nor a column": ["np.hstack((R, p))", "np.concatenate((R, p), axis=1)", "np.r_[R, p]"],
    "side by side need as many rows": ["np.c_[R, T]", "np.block([R, p])"],
    "do not fill the shape": ["p.reshape(4, 4)"],
    "has the shape (4,4), the place for it has the shape (3,3)": ["T[:3, :3] = T"],
    "has the shape (4,), the place for it has the shape (3,)": ["T[:3, 3] = T @ np.append(p, 1)"],
    "A single number is needed here": ["math.cos(p)", "float(p)", "p[0] = p", "T[0, 3] = [1, 2, 3]"],
    "holds no fractions": ["whole /= 2", "whole += 0.5", "whole *= 0.1"],
    "work on its `.copy()`": ["np.broadcast_to(p, (3, 3))[0] = 1"],
    "in the fourth place": ["T @ p", "T.dot(p)", "np.dot(T, p)", "np.linalg.inv(T @ p)"],
    "A 3x3 rotation takes three numbers": ["R @ np.append(p, 1)"],
    "One side of `@` is no array": ["T @ pose", "T @ 2", "T @ None", "Rotation.identity() @ p"],
    "as many rows as A has columns": ["T @ [1, 2]", "np.ones((2, 3)) @ np.ones((2, 3))"],
    "go entry by entry": ["T * p", "T + p", "T * R", "np.linalg.inv(T * p)", "tft.quaternion_from_matrix(T * p)"],
    "np.allclose(A, B": ["if T == T: pass", "not p", "assert p == p", "T[0] and T[1]"],
    "`cos` is one of NumPy's names: `np.cos`": ["cos(1)"],
    "`np.pi`": ["pi"],
    "`np.linalg.inv`": ["inv(T)", "np.inv(T)"],
    "`np.linalg.det`": ["np.det(T)"],
    "The inverse of a matrix M": ["np.inverse(T)", "np.linalg.inverse(T)", "T.inv()", "T.inverse()"],
    "`math.atan2`": ["atan2(1, 2)"],
    "called `tft`": ["tf.quaternion_matrix(p)", "from transform_lab import tf"],
    "leave `self` out": ["self.x"],
    "Each notebook starts empty": ["distnace", "chain(T)"],
    "has no value yet": ["def f():\n    later += 1\nf()"],
    "There is no ROS here": ["import tf", "import rospy", "from geometry_msgs.msg import Pose", "import tf.transformations"],
    "Is it spelled right": ["import numpi", "from numpy import linagl"],
    "There is no `cosd` in it": ["np.cosd(1)"],
    "`np.append(v, 1)`": ["p.append(1)"],
    "The parts of a transform T": ["T.rotation"],
    "`from_matrix` and `as_matrix`": ["Rotation.from_dcm(R)", "Rotation.identity().as_dcm()"],
    "an object of SciPy's": ["Rotation.identity() * p"],
    "Something here is None": ["None[0]", "None.x", "None + 1", "a, b = None", "float(None)", "len(None)", "np.cos(None)"],
    "needs two or more": ["np.linalg.multi_dot([T])"],
    "has no inverse, its determinant is 0": ["np.linalg.inv(np.zeros((3, 3)))"],
    "If it is a Pose: make a matrix": ["np.linalg.inv(pose)"],
    "A vector has no inverse": ["np.linalg.inv(p)", "np.linalg.det(p)"],
    "as many rows as columns": ["np.linalg.inv(R[:2])"],
    "which part of a transform": ["Rotation.from_matrix(T)"],
    "four numbers x, y, z, w": ["Rotation.from_quat(p)"],
    "is no orientation": ["Rotation.from_quat([0, 0, 0, 0])"],
    "what you divide by 0": ["1 / 0", "1.0 / 0.0"],
    "A root of a negative number": ["math.sqrt(-1)", "math.acos(1.0000001)"],
    "Counting starts at 0, so 3 is beyond the last of 3": ["p[3]"],
    "the last of three is number 2": ["[1, 2][2]", "(1, 2)[3]"],
    "more indices than": ["T[0, 0, 0]"],
    "Whole numbers are needed": ["T['a']", "T[1.0]", "T[:3.0]", "range(1.5)"],
    "Left of the `=` are 2 names": ["a, b = p"],
    "Left of the `=` are 4 names": ["a, b, c, d = p"],
    "This is a single thing": ["a, b = 1", "for t in 3: pass", "sum(3)", "len(3)"],
    "an array or list has brackets": ["T(0, 3)", "T.shape()", "T.T()", "[1, 2](0)"],
    "Round parentheses after a value": ["2(3)", "np.pi()", "T[0, 0](1)"],
    "This is a function itself": ["np.deg2rad * 2 if False else len[0]", "len + 1"],
    "does not take a third as a factor": ["np.dot(T, T, T, T)", "np.matmul(T, T, T, T)", "np.multiply(T, T, T, T)"],
    "Count the arguments": ["np.dot(T)", "np.cross(p)", "tft.quaternion_matrix(1, 2, 3, 4)", "math.sin(1, 2)", "math.atan2(1)"],
    "no argument called `order`": ["tft.quaternion_matrix([0, 0, 0, 1], order=1)"],
    "Lists are no vectors": ["[1, 2] + 1", "[1] - [2]", "[1, 2] * 2.0", "-[1, 2]", "[[1]] @ [[1]]", "[1].shape", "[1].T"],
    "A text is no number": ["'a' + 1", "1 + 'a'", "T + 'a'", "float('a')", "math.sin('a')", "int('x')"],
    "something that is none": ["np.sin('a')"],
    "two vectors of three numbers": ["np.cross(T, T)"],
    "calls itself again and again": ["f = lambda n: f(n + 1); f(1)"],
    "An `assert` says so": ["assert 1 == 2"],
    "There is nothing under this name": ["{}['a']"],
    "works by itself": ["raise NotImplementedError"],
}  # fmt: skip
# What transform_lab says itself: it needs no advice.
OURS = [
    "tft.quaternion_to_matrix(p)",
    "tft.quaternion_matrix(pose.orientation)",
    "tft.translation_matrix(pose.position)",
    "tft.quaternion_from_matrix(R)",
    "tft.quaternion_from_matrix(p)",
    "tft.quaternion_from_matrix(None)",
    "tft.quaternion_from_matrix('text')",
    "tft.quaternion_from_matrix(2 * T)",
    "tft.quaternion_from_matrix(T @ np.diag([1, 1, -1, 1]))",
    "tft.quaternion_from_matrix(np.eye(4) * [1, 1, 1, 0])",
    "tft.quaternion_from_matrix(T * np.nan)",
    "tft.quaternion_multiply(p, p)",
    "tft.quaternion_inverse([0, 0, 0, 0])",
    "tft.unit_vector([0, 0, 0])",
    "Pose(x=1)",
    "Point(1, 2, z=3)",
]


def raised(code):
    """The error that a line raises, as a Reply has it."""
    pose, T, p = Pose(Point(1.0, 2.0, 3.0), Quaternion(0.0, 0.0, 0.0, 1.0)), np.eye(4), np.array([1.0, 2.0, 3.0])
    names = {
        "T": T,
        "R": np.eye(3),
        "p": p,
        "pose": pose,
        "whole": np.array([1, 2]),
        "np": np,
        "math": math,
        "tft": tft,
    }
    names |= {"Pose": Pose, "Point": Point, "Quaternion": Quaternion, "Rotation": Rotation}
    try:
        exec(code, names)
    except Exception as error:
        return one_line(error)
    raise AssertionError(f"{code} raises nothing")


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("helps, code", [(helps, code) for helps, lines in RAISED.items() for code in lines])
def test_an_error_gets_the_advice_that_fits_it(helps, code):
    assert helps in advice(raised(code), "chain", ["*transforms"])


@pytest.mark.parametrize("code", OURS)
def test_our_own_messages_say_it_themselves(code):
    assert advice(raised(code), "chain", ["*transforms"]) == ""


# What other versions say where those installed here say it differently: (NumPy 1, or a later Python; what helps).
ELSEWHERE = [
    ("TypeError: only size-1 arrays can be converted to Python scalars", "A single number is needed here"),
    ("TypeError: only length-1 arrays can be converted to Python scalars", "A single number is needed here"),
    ("ValueError: too many values to unpack (expected 2, got 3)", "Left of the `=` are 2 names"),
    ("ValueError: expected a nonnegative input, got -1.0", "A root of a negative number"),
    ("UFuncTypeError: Cannot cast ufunc 'true_divide' output from dtype('float64') to dtype('int64')", "holds no fractions"),
]  # fmt: skip


@pytest.mark.parametrize("message, helps", ELSEWHERE)
def test_the_wordings_of_other_versions(message, helps):
    assert helps in advice(message, "chain", ["*transforms"])


@pytest.mark.parametrize(
    "head, arguments",
    [("def chain(transforms):", 2), ("def chain(self, first, second):", 2), ("def chain():", 1), ("def chain(a, *, b):", 1)],
)  # fmt: skip
def test_a_function_with_another_first_line_is_told_how_it_is_called(head, arguments):
    call = f"chain({', '.join(['0'] * arguments)})"
    assert "called as `chain(*transforms)`" in advice(raised(f"{head} pass\n{call}"), "chain", ["*transforms"])


def test_where_nothing_is_known_it_says_where_to_look():
    unknown = "RuntimeError: of a kind that nobody has met"
    assert "`hand_transform()`:" in advice(unknown, "hand_transform", [])
    assert "arguments of the kind" not in advice(unknown, "hand_transform", [])
    assert "`chain(*transforms)`, with arguments" in advice(unknown, "chain", ["*transforms"])
    assert "just before it" in advice(f"{unknown}, in your line 3: `x = odd('str')`", "chain", ["*transforms"])


def test_what_an_interrupted_function_waited_for(monkeypatch):
    """A call that waits is no loop: the line in which it was interrupted tells them apart."""

    def interrupted(*args):
        raise KeyboardInterrupt

    monkeypatch.setattr(time, "sleep", interrupted)
    lines = {
        "input('distance? ')": "somebody to type",
        "time.sleep(9)": "It waits there",
        "interrupted()": "a loop that never ends",
    }
    shell = InteractiveShell.instance()
    try:
        for line, helps in lines.items():
            shell.user_ns |= {"interrupted": interrupted, "input": interrupted}
            with capture_output() as shown:
                shell.run_cell(
                    "import time\nfrom transform_lab import check\n"
                    f"def chain(*transforms):\n    {line}\n    return transforms[0]\ncheck('chain', chain)"
                )
            text = next(output.data["text/plain"] for output in shown.outputs)
            assert f"interrupted before it was done, in your line 4: `{line}`" in text
            assert re.search(helps, text), text
    finally:
        InteractiveShell.clear_instance()
