"""tft gives what tf.transformations gives: known values, round trips, and errors that name the mistake."""

import itertools
import math
import subprocess
import sys
import warnings

import numpy as np
import pytest
from transform_lab import tft
from transform_lab.messages import Point, Pose, Quaternion

HALF = math.sqrt(0.5)
RANDOM = np.random.default_rng(24)


def signed_permutations():
    """Return the 24 rotations whose entries are 0, 1 and -1."""
    rotations = []
    for order in itertools.permutations(range(3)):
        for signs in itertools.product([1, -1], repeat=3):
            R = np.zeros((3, 3))
            R[range(3), order] = signs
            if np.linalg.det(R) > 0:
                rotations.append(R)
    return rotations


def half_turn(axis):
    """Return the rotation by 180 degrees about `axis`: 2 a a^T - I for the unit vector a."""
    a = np.array(axis) / np.linalg.norm(axis)
    return 2 * np.outer(a, a) - np.eye(3)


def random_rotations(count):
    """Return random rotations, made without tft: the orthogonal factor of a random matrix, its determinant made +1."""
    for _ in range(count):
        Q = np.linalg.qr(RANDOM.normal(size=(3, 3)))[0]
        yield Q * np.linalg.det(Q)


def homogeneous(R, p=(0, 0, 0)):
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def about(axis, angle):
    """Return the rotation about x, y or z, from its textbook formula."""
    c, s = math.cos(angle), math.sin(angle)
    return {
        "x": np.array([[1, 0, 0], [0, c, -s], [0, s, c]]),
        "y": np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]),
        "z": np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]),
    }[axis]


def formula(q):
    """Return the rotation of a unit quaternion x, y, z, w, from the textbook formula."""
    x, y, z, w = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def same_orientation(q1, q2):
    return abs(abs(np.dot(q1, q2)) - 1) < 1e-9


QUARTER_TURNS = [
    ([HALF, 0, 0, HALF], [[1, 0, 0], [0, 0, -1], [0, 1, 0]]),
    ([0, HALF, 0, HALF], [[0, 0, 1], [0, 1, 0], [-1, 0, 0]]),
    ([0, 0, HALF, HALF], [[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
]
ROTATIONS = signed_permutations() + [half_turn((1, -2, 3))] + list(random_rotations(50))
EULER_AXES = [
    frame + "".join(axes)
    for frame in "sr"
    for axes in itertools.product("xyz", repeat=3)
    if axes[0] != axes[1] != axes[2]
]


@pytest.mark.parametrize("q, R", QUARTER_TURNS)
def test_quarter_turns(q, R):
    np.testing.assert_allclose(tft.quaternion_matrix(q), homogeneous(R), atol=1e-15)
    np.testing.assert_allclose(tft.quaternion_from_matrix(homogeneous(R, (1, 2, 3))), q, atol=1e-15)


def test_the_labs_numbers():
    T = tft.quaternion_matrix([0, 0, 0.38268343, 0.92387953])
    np.testing.assert_allclose(T, homogeneous(about("z", math.pi / 4)), atol=1e-8)


def test_all_rotations_round_trip():
    assert len(signed_permutations()) == 24
    for R in ROTATIONS:
        q = tft.quaternion_from_matrix(homogeneous(R, (0.3, -0.2, 0.9)))
        assert q.shape == (4,) and abs(np.linalg.norm(q) - 1) < 1e-12
        np.testing.assert_allclose(formula(q), R, atol=1e-12)
        np.testing.assert_allclose(tft.quaternion_matrix(q), homogeneous(R), atol=1e-12)


def test_quaternions_are_normalised_and_zero_is_the_identity():
    np.testing.assert_allclose(tft.quaternion_matrix([0, 0, 5, 5]), homogeneous(about("z", math.pi / 2)), atol=1e-15)
    np.testing.assert_array_equal(tft.quaternion_matrix([0, 0, 0, 0]), np.eye(4))


@pytest.mark.parametrize("axes", EULER_AXES)
def test_euler_conventions(axes):
    i, j, k = axes[1:]
    for a, b, c in [(0.4, -1.1, 2.5), *RANDOM.uniform(-math.pi, math.pi, (5, 3))]:
        if axes[0] == "s":  # about fixed axes, each later rotation multiplies from the left
            R = about(k, c) @ about(j, b) @ about(i, a)
        else:  # about the moving frame's own axes, from the right
            R = about(i, a) @ about(j, b) @ about(k, c)
        np.testing.assert_allclose(tft.euler_matrix(a, b, c, axes), homogeneous(R), atol=1e-12)
        q = tft.quaternion_from_euler(a, b, c, axes)
        np.testing.assert_allclose(formula(q), R, atol=1e-12)
        for angles in (tft.euler_from_matrix(homogeneous(R), axes), tft.euler_from_quaternion(q, axes)):
            assert isinstance(angles, tuple) and len(angles) == 3
            np.testing.assert_allclose(tft.euler_matrix(*angles, axes), homogeneous(R), atol=1e-9)


def test_there_are_24_euler_conventions():
    assert len(EULER_AXES) == 24


def test_values_published_with_transformations_py():
    """The doctests of ROS's tf.transformations."""
    assert np.isclose(tft.euler_matrix(1, 2, 3, "syxz")[0].sum(), -1.34786452)
    np.testing.assert_allclose(
        tft.quaternion_from_euler(1, 2, 3, "ryxz"), [0.310622, -0.718287, 0.444435, 0.435953], atol=1e-6
    )
    np.testing.assert_allclose(tft.euler_from_quaternion([0.06146124, 0, 0, 0.99810947]), [0.123, 0, 0], atol=1e-7)
    np.testing.assert_allclose(
        tft.quaternion_from_matrix(tft.rotation_matrix(0.123, (1, 2, 3))),
        [0.0164262, 0.0328524, 0.0492786, 0.9981095],
        atol=1e-7,
    )
    np.testing.assert_allclose(tft.quaternion_about_axis(0.123, (1, 0, 0)), [0.06146124, 0, 0, 0.99810947])
    np.testing.assert_array_equal(tft.quaternion_multiply([1, -2, 3, 4], [-5, 6, 7, 8]), [-44, -14, 48, 28])


def test_gimbal_lock_neither_warns_nor_loses_the_rotation():
    R = about("z", 0.5) @ about("y", math.pi / 2) @ about("x", 0.2)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        angles = tft.euler_from_matrix(homogeneous(R))
    np.testing.assert_allclose(tft.euler_matrix(*angles), homogeneous(R), atol=1e-7)
    assert angles[2] == 0


@pytest.mark.parametrize("axes", ["xyz", "sxxy", "sxyy", "qxyz", "sxyzx", "sxya", ""])
def test_no_such_euler_axes(axes):
    with pytest.raises(ValueError, match="no such Euler axes"):
        tft.euler_matrix(1, 2, 3, axes)


def test_translation():
    T = tft.translation_matrix([1, 2, 3])
    np.testing.assert_array_equal(T, [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
    np.testing.assert_array_equal(tft.translation_from_matrix(T), [1, 2, 3])
    np.testing.assert_array_equal(tft.translation_matrix([1, 2, 3, 1]), T)


def test_rotation_matrix_and_back():
    np.testing.assert_allclose(tft.rotation_matrix(0.7, [0, 0, 5]), homogeneous(about("z", 0.7)), atol=1e-15)
    T = tft.rotation_matrix(0.7, [1, -2, 3], point=[0.2, 0.3, -0.4])
    np.testing.assert_allclose(T @ [0.2, 0.3, -0.4, 1], [0.2, 0.3, -0.4, 1], atol=1e-15)
    np.testing.assert_allclose(T @ [1.2, -1.7, 2.6, 1], [1.2, -1.7, 2.6, 1], atol=1e-15)
    angle, axis, point = tft.rotation_from_matrix(T)
    assert np.isclose(angle, 0.7)
    np.testing.assert_allclose(axis, np.array([1, -2, 3]) / math.sqrt(14))
    np.testing.assert_allclose(T @ point, point, atol=1e-12)
    np.testing.assert_allclose(tft.rotation_matrix(angle, axis, point), T, atol=1e-12)


def test_rotation_from_matrix_of_the_identity_and_of_a_screw_motion():
    angle, axis, point = tft.rotation_from_matrix(np.eye(4))
    assert angle == 0 and list(axis) == [0, 0, 1] and list(point) == [0, 0, 0, 1]
    with pytest.raises(ValueError, match="also moves by 0.5 along its axis"):
        tft.rotation_from_matrix(homogeneous(about("z", 1), (0, 0, 0.5)))


def test_inverse_and_product():
    T = homogeneous(about("x", 0.3) @ about("z", 1.1), (1, 2, 3))
    np.testing.assert_allclose(tft.inverse_matrix(T) @ T, np.eye(4), atol=1e-12)
    S = homogeneous(about("y", -0.8), (0, 0, 1))
    np.testing.assert_allclose(tft.concatenate_matrices(T, S, T), T @ S @ T)
    np.testing.assert_array_equal(tft.concatenate_matrices(), tft.identity_matrix())


def test_quaternion_algebra_follows_the_matrices():
    for R1, R0 in zip(random_rotations(20), random_rotations(20)):
        q1, q0 = (tft.quaternion_from_matrix(homogeneous(R)) for R in (R1, R0))
        np.testing.assert_allclose(formula(tft.quaternion_multiply(q1, q0)), R1 @ R0, atol=1e-12)
        np.testing.assert_allclose(formula(tft.quaternion_conjugate(q1)), R1.T, atol=1e-12)
        np.testing.assert_allclose(tft.quaternion_multiply(tft.quaternion_inverse(2 * q1), 2 * q1), [0, 0, 0, 1],
                                   atol=1e-12)  # fmt: skip
    with pytest.raises(ValueError, match="no inverse"):
        tft.quaternion_inverse([0, 0, 0, 0])


def test_slerp():
    start, end = [0, 0, 0, 1], tft.quaternion_about_axis(1.2, [0, 1, 0])
    for fraction in (0, 0.25, 0.5, 1):
        expected = tft.quaternion_about_axis(1.2 * fraction, [0, 1, 0])
        np.testing.assert_allclose(tft.quaternion_slerp(start, end, fraction), expected, atol=1e-12)
        assert same_orientation(tft.quaternion_slerp(start, -end, fraction), expected)
    long_way = tft.quaternion_slerp(start, -end, 0.5, shortestpath=False)
    assert same_orientation(long_way, tft.quaternion_about_axis(0.6 + math.pi, [0, 1, 0]))
    two_turns_more = tft.quaternion_slerp(start, end, 0.3, spin=2)
    np.testing.assert_allclose(two_turns_more, tft.quaternion_about_axis(0.3 * (1.2 + 4 * math.pi), [0, 1, 0]))
    np.testing.assert_array_equal(tft.quaternion_slerp(start, start, 0.3), start)


def test_random_rotations_are_rotations():
    np.random.seed(1)
    first, second = tft.random_quaternion(), tft.random_quaternion()
    assert np.isclose(np.linalg.norm(first), 1) and not np.allclose(first, second)
    R = tft.random_rotation_matrix([0.2, 0.5, 0.9])
    np.testing.assert_allclose(R[:3, :3], formula(tft.random_quaternion([0.2, 0.5, 0.9])), atol=1e-12)


def test_vectors():
    assert tft.vector_norm([3, 4]) == 5
    np.testing.assert_array_equal(tft.vector_norm([[3, 4], [6, 8]], axis=1), [5, 10])
    np.testing.assert_array_equal(tft.unit_vector([0, 3, 4]), [0, 0.6, 0.8])
    np.testing.assert_array_equal(tft.unit_vector([[3, 4], [0, 2]], axis=1), [[0.6, 0.8], [0, 1]])
    for call in (tft.unit_vector, lambda v: tft.quaternion_about_axis(1, v), lambda v: tft.rotation_matrix(1, v)):
        with pytest.raises(ValueError, match="no direction"):
            call([0, 0, 0])


@pytest.mark.filterwarnings("ignore:the matrix subclass")
@pytest.mark.parametrize("convert", [np.ndarray.tolist, np.asmatrix, np.float32, np.int64], ids=lambda f: f.__name__)
def test_any_kind_of_numbers_is_taken(convert):
    T = np.array([[0.0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])
    q = tft.quaternion_from_matrix(convert(T))
    assert type(q) is np.ndarray and q.dtype == np.float64 and q.shape == (4,)
    np.testing.assert_allclose(q, [0, 0, HALF, HALF], atol=1e-7)
    R = tft.quaternion_matrix(convert(np.array([0.0, 0, 1, 1])))
    assert type(R) is np.ndarray and R.dtype == np.float64
    np.testing.assert_allclose(R, homogeneous(T[:3, :3]), atol=1e-12)


def test_arguments_are_not_changed():
    T, q, v = homogeneous(about("z", 1), (1, 2, 3)), np.array([0.1, 0.2, 0.3, 0.4]), np.array([1.0, 2.0, 3.0])
    before = T.copy(), q.copy(), v.copy()
    results = [
        tft.quaternion_from_matrix(T), tft.translation_from_matrix(T), tft.inverse_matrix(T),
        tft.concatenate_matrices(T), tft.quaternion_matrix(q), tft.quaternion_conjugate(q), tft.quaternion_inverse(q),
        tft.quaternion_slerp(q, -q, 0), tft.quaternion_slerp(q, -q, 0.3), tft.quaternion_multiply(q, q),
        tft.unit_vector(v), tft.rotation_matrix(1, v, v), tft.translation_matrix(v),
    ]  # fmt: skip
    for result in results:
        result += 1  # nor do results share memory with arguments
    for array, copy in zip((T, q, v), before):
        np.testing.assert_array_equal(array, copy)


def changed(row, column, value):
    T = np.eye(4)
    T[row, column] = value
    return T


@pytest.mark.parametrize(
    "matrix, message",
    [
        (np.eye(3), r"must be a 4x4 homogeneous transform as in ROS; got 3x3.*np\.eye\(4\)"),
        ([0, 0, 0, 1], "must be a 4x4 homogeneous transform as in ROS; got 4 numbers"),
        (5, "got a single number"),
        (np.diag([1, 1, -1, 1]), r"a reflection .*determinant is -1 and must be \+1"),
        (np.diag([1, 2, 1, 1]), r"differs from the identity by up to 3\..*lengths are 1, 2, 1"),
        (changed(0, 1, 0.01), "differs from the identity by up to 0.01"),
        (changed(3, 0, 0.5), r"bottom row 0, 0, 0, 1; it is 0\.5, 0, 0, 1\..*last column"),
        (changed(3, 3, 0), "bottom row 0, 0, 0, 1; it is 0, 0, 0, 0"),
        (changed(0, 0, math.nan), "NaN or infinity"),
        (changed(0, 3, math.inf), "NaN or infinity"),
        ([[1, 2], [3]], "rows of equal length"),
        ([["a"]], r"made of numbers; got \[\['a'\]\]"),
        ([["1"]], r"made of numbers; got \[\['1'\]\]"),
        ([[None]], r"made of numbers; got \[\[None\]\]"),
        (np.eye(4) * 1j, "made of numbers; got ndarray"),
    ],
)
@pytest.mark.parametrize("function", [tft.quaternion_from_matrix, tft.euler_from_matrix, tft.rotation_from_matrix])
def test_wrong_matrices_are_named(function, matrix, message):
    if function is tft.euler_from_matrix and isinstance(matrix, np.ndarray) and len(matrix) == 3:
        assert function(matrix) == (0, 0, 0)  # as in ROS
        return
    with pytest.raises((TypeError, ValueError), match=message) as raised:
        function(matrix)
    assert str(raised.value).startswith(function.__name__)


def test_entries_with_three_decimals_are_a_rotation():
    q = tft.quaternion_from_matrix([[0.707, -0.707, 0, 0], [0.707, 0.707, 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]])
    np.testing.assert_allclose(q, [0, 0, 0.38268343, 0.92387953], atol=1e-4)


def test_messages_are_not_numbers():
    with pytest.raises(TypeError, match=r"not a Quaternion message: write \[q\.x, q\.y, q\.z, q\.w\]"):
        tft.quaternion_matrix(Quaternion(0, 0, 0, 1))
    with pytest.raises(TypeError, match=r"not a Point message: write \[p\.x, p\.y, p\.z\]"):
        tft.translation_matrix(Point(1, 2, 3))
    with pytest.raises(TypeError, match="got Pose"):
        tft.quaternion_from_matrix(Pose())
    with pytest.raises(TypeError, match="got None"):
        tft.quaternion_from_matrix(None)


@pytest.mark.parametrize("values", [[1, 2, 3], [1, 2, 3, 4, 5], [[1, 2], [3, 4]], 7])
def test_a_quaternion_has_four_numbers(values):
    with pytest.raises(ValueError, match="quaternion_matrix: the quaternion must be 4 numbers; got"):
        tft.quaternion_matrix(values)


def test_importing_tft_does_not_import_scipy():
    code = "import sys, transform_lab.tft; sys.exit('scipy' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, env={"PYTHONPATH": ":".join(sys.path)})


def test_what_is_not_here_is_said_with_what_is():
    with pytest.raises(
        AttributeError, match=r"tft\.quaternion_to_matrix is not here\. Did you mean .*quaternion_matrix.*\?"
    ):
        tft.quaternion_to_matrix
    with pytest.raises(AttributeError, match=r"tft\.Arcball is not here\. There is compose_matrix, .*, vector_norm\."):
        tft.Arcball
    assert not hasattr(tft, "clip_matrix")
