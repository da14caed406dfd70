"""The card of calls to print: each call does what it says."""

import re

import numpy as np
import pytest
import transform_lab
from support import ROOT
from transform_lab import Point, Pose, Quaternion, tft

TEXT = (ROOT / "source/transforms/card.md").read_text(encoding="utf-8")
CALLS = re.findall(r"^\| ([^|`]+?) \| `([^`]+)` \|$", TEXT, re.MULTILINE)
A_T_B = tft.euler_matrix(0.1, 0.2, 0.3)
A_T_B[:3, 3] = 1, 2, 3
B_T_C = tft.translation_matrix([0.4, 0.5, 0.6])
X, Y, Z, W = tft.quaternion_from_matrix(A_T_B)
RIGHT = {
    "a turn about an axis, 4x4": tft.euler_matrix(0, 0, np.pi / 2),
    "a step, 4x4": [[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0.2], [0, 0, 0, 1]],
    "a quaternion as a matrix, 4x4": tft.euler_matrix(0.1, 0.2, 0.3),
    "the quaternion of a matrix": [X, Y, Z, W],
    "a quaternion of roll, pitch and yaw": [X, Y, Z, W],
    "a pose": Pose(Point(X, Y, Z), Quaternion(0, 0, 0, 1)),
    "C in A, from C in B": np.dot(A_T_B, B_T_C),
    "A in B, from B in A": tft.inverse_matrix(A_T_B),
    "a point of B, told in A": np.dot(A_T_B[:3, :3], [7, 8, 9]) + [1, 2, 3],
    "whether two matrices are the same": True,
}


def test_there_are_ten():
    assert [what for what, _ in CALLS] == list(RIGHT) and len(CALLS) == 10
    assert TEXT.startswith("# Ten calls")


@pytest.mark.parametrize("what, code", CALLS)
def test_a_call_does_what_it_says(what, code):
    names = {"np": np, **vars(transform_lab), "x": X, "y": Y, "z": Z, "w": W, "roll": 0.1, "pitch": 0.2, "yaw": 0.3}
    names |= {"a_T_b": A_T_B, "b_T_c": B_T_C, "p_in_b": [7, 8, 9], "A": A_T_B, "B": A_T_B + 1e-7}
    _, _, expression = code.rpartition(" = ") if re.match(r"[\w, ]+ = ", code) else ("", "", code)
    value = eval(expression, names)
    if what == "a pose":
        assert value == RIGHT[what]
    else:
        np.testing.assert_allclose(value, RIGHT[what], atol=1e-12)
