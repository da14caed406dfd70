"""Wrong ways from a rotation matrix to a quaternion and back: steps that several exercises ask for, and where they fail."""

import math

import numpy as np
from transform_lab.arithmetic import Rotation

from .cases import off_diagonal, quaternion, x_axis_upright

ORDERS = ([3, 0, 1, 2], [1, 2, 3, 0], [3, 2, 1, 0])


# --- from a rotation matrix to a quaternion (of a 4x4 matrix) --------------------------------------------------------


def trace_formula(matrix):
    w = np.sqrt(1.0 + np.trace(matrix[:3, :3])) / 2.0
    return np.append(off_diagonal(matrix) / (4.0 * w), w)


def trace_formula_in_plain_python(matrix):
    w = math.sqrt(1.0 + float(np.trace(matrix[:3, :3]))) / 2.0
    return [float(difference) / (4.0 * w) for difference in off_diagonal(matrix)] + [w]  # raises at a half turn


def trace_formula_guarded(matrix):
    return trace_formula(matrix) if np.trace(matrix[:3, :3]) > -1.0 + 1e-9 else np.array([0.0, 0.0, 0.0, 1.0])


def half_turn_by_tolerance(matrix):
    """Right for every half turn, and takes some for one that are none."""
    q = quaternion(matrix[:3, :3])
    return np.append(q[:3], 0.0) if np.isclose(np.trace(matrix[:3, :3]), -1.0) else q


def lengths_with_signs(signs):
    """The components' sizes from the diagonal, and the signs of x, y, z from `signs(sizes, differences)`."""

    def wrong(matrix):
        a, b, c = np.diag(matrix)[:3]
        squares = np.array([1 + a - b - c, 1 - a + b - c, 1 - a - b + c, 1 + a + b + c])
        sizes = np.sqrt(np.maximum(squares, 0.0)) / 2.0
        return np.append(signs(sizes[:3], off_diagonal(matrix)), sizes[3])

    return wrong


def axis_and_angle(matrix):
    """The axis from the differences off the diagonal; 0/0 without a rotation, a zero vector at a half turn."""
    angle = np.arccos(np.clip((np.trace(matrix[:3, :3]) - 1.0) / 2.0, -1.0, 1.0))
    axis = off_diagonal(matrix) / (2.0 * np.sin(angle))
    return np.append(axis * np.sin(angle / 2.0), np.cos(angle / 2.0))


def angle_not_halved(matrix):
    rotation_vector = Rotation.from_matrix(matrix[:3, :3]).as_rotvec()
    angle = np.linalg.norm(rotation_vector)
    axis = rotation_vector / angle if angle > 0 else rotation_vector
    return np.append(axis * np.sin(angle), np.cos(angle))


def by_component(k, matrix):
    """The quaternion by the formula that divides by its number k."""
    (a, b, c), (x, y, z) = np.diag(matrix)[:3], off_diagonal(matrix)
    xy, xz, yz = matrix[0, 1] + matrix[1, 0], matrix[0, 2] + matrix[2, 0], matrix[1, 2] + matrix[2, 1]
    products = [
        [1 + a - b - c, xy, xz, x],
        [xy, 1 - a + b - c, yz, y],
        [xz, yz, 1 - a - b + c, z],
        [x, y, z, 1 + a + b + c],
    ]
    row = np.array(products[k], dtype=float)
    return row / (2.0 * np.sqrt(row[k]))


def _by_w_or(otherwise):
    """The quaternion of who knows the formula for a positive trace, and takes `otherwise(matrix)` for all others."""
    return lambda matrix: by_component(3, matrix) if np.trace(matrix[:3, :3]) > 0 else otherwise(matrix)


def _slip_in_branch(k):
    """The opposite turn where the number k of the quaternion is larger than the two beside it, and the trace negative."""

    def wrong(matrix):
        q = quaternion(matrix[:3, :3])
        return q * [1, 1, 1, -1] if np.argmax(np.abs(q[:3])) == k and np.trace(matrix[:3, :3]) <= 0 else q

    return wrong


def plain_angles(matrix):
    """Roll, pitch and yaw as textbooks have them, without a thought of gimbal lock."""
    pitch = math.asin(np.clip(-matrix[2, 0], -1.0, 1.0))
    return math.atan2(matrix[2, 1], matrix[2, 2]), pitch, math.atan2(matrix[1, 0], matrix[0, 0])


def from_euler(angles, axes="xyz"):
    return Rotation.from_euler(axes, angles).as_quat()


def product(first, second):
    """The product of two quaternions x, y, z, w, in the order of the matrices' product."""
    (*u, a), (*v, b) = first, second
    return np.append(a * np.array(v) + b * np.array(u) + np.cross(u, v), a * b - np.dot(u, v))


def rotation_vector(R):
    return Rotation.from_matrix(R).as_rotvec()


# --- where formulas fail, from the rotation R: all that has to be wrong, and what may be --------------------------------

NEAR_HALF = -1.0 + 1e-5  # the trace 3e-3 before a half turn: nearer, it is a matter of digits whether a formula holds
MARGIN = 1e-3


def at_half_turns(R):
    return np.trace(R) <= -1.0 + 1e-14


def near_half_turns(R):
    return np.trace(R) < NEAR_HALF


def short_of_half_turns(R):
    """Where the trace formula's w is what rounding leaves of it; at a trace of -1 it is 0 for everybody."""
    return np.trace(R) != -1.0 and near_half_turns(R)


def at_negative_trace(R):
    return NEAR_HALF < np.trace(R) < -MARGIN


def near_negative_trace(R):
    return np.trace(R) < MARGIN


def in_branch(k):
    """Where the number k of the quaternion is by far the largest, and none is 0."""

    def fails(R):
        q = np.abs(quaternion(R))
        return np.trace(R) < -MARGIN and q.min() > MARGIN and q[k] ** 2 > np.delete(q, k).max() ** 2 + MARGIN

    return fails


def near_branch(k):
    """Where somebody might take the number k of the quaternion for the largest."""

    def varies(R):
        q = np.abs(quaternion(R))
        return q[k] ** 2 > np.delete(q, k).max() ** 2 - MARGIN

    return varies


def without_component(k):
    """Where the number k of the quaternion is 0, in a turn by more than 120 degrees."""
    return lambda R: np.trace(R) < -MARGIN and abs(quaternion(R)[k]) < 1e-9


def near_without_component(k):
    return lambda R: np.trace(R) < MARGIN and abs(quaternion(R)[k]) < 2 * MARGIN


def at_gimbal_lock(R):
    """Where roll and yaw come from zeros alone, and have something to say."""
    return np.hypot(R[2, 1], R[2, 2]) < 1e-14 and R[1, 1] < 1.0 - 1e-6


near_gimbal_lock = x_axis_upright


# --- from a quaternion to a matrix, or to a turned vector --------------------------------------------------------------


def skew(v):
    return np.cross(np.eye(3), v)


def _formula(q):
    """The parts of the well-known formula: products of x, y and z with each other, and with w."""
    v, w = np.asarray(q[:3]), q[3]
    return v, np.outer(v, v), w * skew(v)


def by_tangents(q):
    """Cayley's formula, of x, y and z divided by w."""
    K = skew(q[:3] / q[3])
    return np.linalg.inv(np.eye(3) - K) @ (np.eye(3) + K)


def _sign_slip(i, j):
    """The matrix with one sign wrong in an entry beside the diagonal."""

    def wrong(q):
        v, products, with_w = _formula(q)
        R = 2.0 * (products + with_w) + (1.0 - 2.0 * v @ v) * np.eye(3)
        R[i, j] -= 4.0 * with_w[i, j]
        return R

    return wrong


def _term_missing(i, j):
    """The matrix with one of the two squares missing in an entry of the diagonal."""

    def wrong(q):
        R = Rotation.from_quat(q).as_matrix()
        R[i, i] += 2.0 * q[j] ** 2
        return R

    return wrong


def slips(*columns):
    """The matrix of a quaternion with a slip in one entry of these columns, as functions of x, y, z, w."""
    return [
        slip(i, j) if slip is _sign_slip else slip(j, i)
        for j in columns
        for i in range(3)
        for slip in (_sign_slip, _term_missing)
        if i != j
    ]


def term_missing_when_turned(kept):
    """A vector turned by cos v + sin k×v + (1 - cos)(k·v) k, or by v + 2w u×v + 2 u×(u×v), with only these terms."""

    def wrong(q, v):
        u, w = np.asarray(q[:3]), q[3]
        sine = np.linalg.norm(u)
        angle, k = 2.0 * np.arctan2(sine, w), u / sine if sine > 0 else u
        terms = {
            "cos": np.cos(angle) * v,
            "sin": np.sin(angle) * np.cross(k, v),
            "axis": (1.0 - np.cos(angle)) * (k @ v) * k,
            "v": v,
            "once": 2.0 * w * np.cross(u, v),
            "twice": 2.0 * np.cross(u, np.cross(u, v)),
        }
        return sum(terms[name] for name in kept.split())

    return wrong


TURNED_WITH_A_TERM_MISSING = [term_missing_when_turned(kept) for kept in ("cos sin", "cos axis", "v once", "v twice")]


# --- the steps that break somewhere only: (id, what is said, from a matrix to a quaternion, where it varies, where it fails)

BREAKS_AT_HALF_TURN = (
    "The quaternion goes wrong at or near a half turn.",
    "Your formula divides by w, or takes signs from differences, and both vanish at a half turn. "
    "A library function knows those cases.",
)
BREAKS_BEYOND_120 = (
    "The quaternion goes wrong for turns by more than 120 degrees, where the trace is negative.",
    "One formula is not enough: which of the four numbers is large there, and safe to divide by?",
)
BRANCH_WRONG = (
    "The quaternion goes wrong for turns by more than 120 degrees about axes near one of the coordinate axes only.",
    "A formula for x, y, z and w has a branch for each of them, and one of yours has a slip: "
    "compare it with the others, sign by sign.",
)
BRANCH_MISSING = (
    "The quaternion goes wrong for large turns about axes that have a 0 among x, y and z.",
    "Each of the quaternion's four numbers can be 0: which of them is safe to divide by hangs on the rotation.",
)
GIMBAL_LOCK = (
    "The orientation goes wrong where the x axis points straight up or down.",
    "Roll and yaw cannot be told apart there, whatever the formula: a quaternion does not need them.",
)
BY_TRACE = ("trace-formula-only", BREAKS_AT_HALF_TURN, trace_formula_guarded, near_half_turns, at_half_turns)
BEYOND_120 = (
    "trace-formula-only",
    BREAKS_BEYOND_120,
    _by_w_or(lambda matrix: np.array([0.0, 0.0, 0.0, 1.0])),
    near_negative_trace,
    at_negative_trace,
)
BY_ANGLES = (
    "gimbal-lock",
    GIMBAL_LOCK,
    lambda matrix: from_euler(plain_angles(matrix)),
    near_gimbal_lock,
    at_gimbal_lock,
)
BY_BRANCHES = [
    *(("branch-wrong", BRANCH_WRONG, _slip_in_branch(k), near_branch(k), in_branch(k)) for k in range(3)),
    *(
        (
            "branch-missing",
            BRANCH_MISSING,
            _by_w_or(lambda matrix, k=k: by_component(k, matrix)),
            near_without_component(k),
            without_component(k),
        )
        for k in range(3)
    ),
]
