"""Arithmetic of single rotations gives SciPy's numbers to the last digit, and needs no SciPy."""

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation
from support import ASKED, ROOT
from transform_lab import arithmetic

from autograder.exercises import cases

NUMBERS = st.floats(-4.0, 4.0) | st.sampled_from([0.0, 1.0, -1.0, 1e-3, 1e-9, np.pi])
SHORT, LONG = np.full(4, 1e-250), np.full(4, 1e200)  # the squares of their numbers are 0, and infinite
ODD = st.sampled_from([SHORT[0], LONG[0], 5e-324, np.inf, np.nan])
VECTORS, QUATERNIONS = arrays(float, 3, elements=NUMBERS), arrays(float, 4, elements=NUMBERS | ODD)


def of_matrix(R):
    """What there is to ask of a matrix: (ours, SciPy's), each a function."""
    return [
        (lambda: arithmetic.quaternion_of(R), lambda: Rotation.from_matrix(R).as_quat()),
        (lambda: arithmetic.vector_of(R), lambda: Rotation.from_matrix(R).as_rotvec()),
        (lambda: arithmetic.angle_of(R), lambda: Rotation.from_matrix(R).magnitude()),
    ]


def alike(ours, theirs):
    try:
        expected = theirs()
    except Exception as error:
        with pytest.raises(type(error)):
            ours()
    else:
        np.testing.assert_array_equal(ours(), expected)


@given(QUATERNIONS)
@example(SHORT)
@example(LONG)
def test_of_a_quaternion(q):
    alike(lambda: arithmetic.matrix_of(q), lambda: Rotation.from_quat(q).as_matrix())


@given(VECTORS)
def test_of_a_rotation_vector(vector):
    alike(lambda: arithmetic.turn(vector), lambda: Rotation.from_rotvec(vector).as_matrix())
    for ours, theirs in of_matrix(Rotation.from_rotvec(vector).as_matrix()):
        alike(ours, theirs)


@given(QUATERNIONS, VECTORS)
@example(SHORT, np.zeros(3))
@example(LONG, np.zeros(3))
@example(np.zeros(4), np.ones(3))
def test_of_a_turn_after_another(q, vector):
    alike(
        lambda: arithmetic.turned(q, vector),
        lambda: (Rotation.from_quat(q) * Rotation.from_rotvec(vector)).as_quat(),
    )


@given(VECTORS, st.sampled_from(["xyz", "zyx", "zxz", "yxz", "xyx"]), st.booleans())
def test_of_three_angles(angles, axes, fixed):
    theirs = Rotation.from_euler(axes if fixed else axes.upper(), angles)
    np.testing.assert_array_equal(arithmetic.quaternion_of_turns(angles, axes, fixed), theirs.as_quat())
    np.testing.assert_array_equal(arithmetic.matrix_of_turns(angles, axes, fixed), theirs.as_matrix())


@given(arrays(float, (3, 3), elements=NUMBERS))
def test_of_what_may_be_no_rotation(R):
    for ours, theirs in of_matrix(R):
        alike(ours, theirs)


@pytest.mark.parametrize(
    "R",
    [
        *cases.signed_permutations(),
        *cases.half_turns_about_almost_an_axis(),
        cases.whole_transform()[:3, :3],
        np.eye(3) * (1 + 1e-7),
        np.diag([1.0, 1.0, -1.0]),
        np.full((3, 3), np.nan),
        np.eye(4),
    ],
)
def test_where_formulas_have_their_edges(R):
    for ours, theirs in of_matrix(R):
        alike(ours, theirs)


@pytest.mark.parametrize("q", [np.zeros(4), np.full(4, np.nan), np.ones(3)])
def test_what_is_no_quaternion(q):
    alike(lambda: arithmetic.matrix_of(q), lambda: Rotation.from_quat(q).as_matrix())


@pytest.mark.parametrize("notebook", ASKED)
def test_cases_are_drawn_without_scipy(notebook):
    code = (
        "import sys; from pathlib import Path; from autograder.course import Course; from autograder.grading.grade import Keys;"
        f"Keys(Course(Path.cwd()).notebooks[{notebook!r}].points, 1); assert 'scipy' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)
