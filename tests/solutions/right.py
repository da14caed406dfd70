"""Right solutions, each written in a way that students write or a naive test refuses."""
import cmath
import collections
import copy
import dataclasses
import functools
import itertools
import logging
import math
import operator
import typing
import warnings
from types import SimpleNamespace

import numpy as np
import scipy.linalg
import scipy.sparse
import scipy.sparse.linalg
import scipy.special
from scipy.spatial.transform import RigidTransform, Rotation
from transform_lab import Point, Pose, Quaternion, Vector3, tft

RIGHT = []  # (exercise, function)
NAMES = []  # the name of each entry of RIGHT, same order (for those that are not plain functions)


def right(exercise, name=None):
    def register(function):
        RIGHT.append((exercise, function))
        NAMES.append(name or getattr(function, "__name__", type(function).__name__))
        return function

    return register


# ------------------------------------------------------------------ helpers, as a student's other cells define them

log = logging.getLogger("homework")
CALLS = 0
IDENTITY = np.eye(4)
BOTTOM = [0, 0, 0, 1]
HALF_TURNS = [np.diag(d) for d in ([1, -1, -1], [-1, 1, -1], [-1, -1, 1], [1, 1, 1])]  # about x, y, z, and none
LEVI_CIVITA = np.zeros((3, 3, 3))
for _i, _j, _k in itertools.permutations(range(3)):
    LEVI_CIVITA[_i, _j, _k] = (_i - _j) * (_j - _k) * (_k - _i) / 2


def numbers_of(message, names):
    return [getattr(message, n) for n in names]


def cosd(degs):
    return math.cos(degs * math.pi / 180)


def sind(degs):
    return math.sin(degs * math.pi / 180)


def skew(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def hamilton(a, b):
    """(x, y, z, w) * (x, y, z, w), by hand, tuples in and out."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def conj(q):
    return (-q[0], -q[1], -q[2], q[3])


def pose_matrix(pose):
    q = pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = pose.position.x, pose.position.y, pose.position.z
    return T


def matrix_pose(T):
    return Pose(Point(*np.asarray(T)[:3, 3]), Quaternion(*tft.quaternion_from_matrix(T)))


class Xyz:
    """Looks like a generated ROS message: slots, constructor without arguments, fields set afterwards."""

    __slots__ = ["x", "y", "z"]
    _slot_types = ["float64"] * 3
    _type = "geometry_msgs/Point"

    def __init__(self):
        self.x = self.y = self.z = 0.0


class Xyzw:
    __slots__ = ["x", "y", "z", "w"]
    _slot_types = ["float64"] * 4
    _type = "geometry_msgs/Quaternion"

    def __init__(self):
        self.x = self.y = self.z = self.w = 0.0


class RosPose:
    __slots__ = ["position", "orientation"]
    _slot_types = ["geometry_msgs/Point", "geometry_msgs/Quaternion"]
    _type = "geometry_msgs/Pose"

    def __init__(self):
        self.position = Xyz()
        self.orientation = Xyzw()


@dataclasses.dataclass
class MyPoint:
    x: float
    y: float
    z: float


@dataclasses.dataclass
class MyQuaternion:
    x: float
    y: float
    z: float
    w: float


@dataclasses.dataclass(frozen=True)
class MyPose:
    position: MyPoint
    orientation: MyQuaternion


PointTuple = collections.namedtuple("PointTuple", "x y z")
QuaternionTuple = collections.namedtuple("QuaternionTuple", "x y z w")
PoseTuple = collections.namedtuple("PoseTuple", "position orientation")
BackwardsPoseTuple = collections.namedtuple("BackwardsPoseTuple", "orientation position")


class PoseSubclass(Pose):
    """The lab's Pose with a convenience of the student's own."""

    def as_matrix(self):
        return pose_matrix(self)


class LazyPose:
    """Keeps the matrix, and makes the two fields when they are asked for."""

    def __init__(self, T):
        self._T = T

    @property
    def position(self):
        return Point(*self._T[:3, 3])

    @property
    def orientation(self):
        return Quaternion(*tft.quaternion_from_matrix(self._T))


# ================================================================== rotation_about_z


@right("rotation_about_z")
def lab_style_nested_list(degrees):
    """A nested list with ints in it, the lab's cosd and sind."""
    return [[cosd(degrees), -sind(degrees), 0], [sind(degrees), cosd(degrees), 0], [0, 0, 1]]


@right("rotation_about_z")
def complex_number(degrees):
    """Multiplication by a complex number; a tuple of tuples."""
    u = cmath.exp(1j * math.radians(degrees))
    return ((u.real, (u * 1j).real, 0), (u.imag, (u * 1j).imag, 0), (0, 0, 1))


@right("rotation_about_z")
def exponential_of_generator(degrees):
    """Matrix exponential of the angle times the generator of turns about z."""
    return scipy.linalg.expm(skew([0, 0, math.radians(degrees % 360)]))


@right("rotation_about_z")
def cosdg_sindg(degrees):
    """SciPy's sines of degrees; a float32 result."""
    c, s = scipy.special.cosdg(degrees), scipy.special.sindg(degrees)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]], dtype=np.float32)


@right("rotation_about_z")
def halving_recursion(degrees):
    """R(a) = R(a/2) R(a/2), down to an angle small enough for a few Taylor terms."""
    if abs(degrees) < 0.05:
        K = skew((0, 0, degrees * math.pi / 180))
        return np.eye(3) + K + K @ K / 2 + K @ K @ K / 6 + K @ K @ K @ K / 24
    half = halving_recursion(degrees / 2)
    return half @ half


@right("rotation_about_z")
def transposed_scipy_of_minus(degrees):
    """The transpose of the turn by the negative angle, from SciPy's Euler angles."""
    return Rotation.from_euler("Z", -degrees, degrees=True).as_matrix().T


@right("rotation_about_z")
def two_reflections(degrees):
    """Two mirrors at half the angle."""
    n = np.array([-math.sin(math.radians(degrees) / 2), math.cos(math.radians(degrees) / 2), 0.0])
    return (np.eye(3) - 2 * np.outer(n, n)) @ np.diag([1, -1, 1])


@right("rotation_about_z")
def np_matrix_from_text(degrees):
    """np.matrix, built from a string."""
    t = np.deg2rad(degrees)
    return np.matrix(f"{float(np.cos(t))!r} {float(-np.sin(t))!r} 0; {float(np.sin(t))!r} {float(np.cos(t))!r} 0; 0 0 1")


@right("rotation_about_z")
@functools.lru_cache(maxsize=None)
def cached_read_only(degrees):
    """lru_cache, and the cached array is made read-only."""
    R = tft.rotation_matrix(np.radians(degrees), (0, 0, 1))[:3, :3]
    R.setflags(write=False)
    return R


right("rotation_about_z", "lambda: tft.euler_matrix, a non-contiguous view")(
    lambda degrees, *, axes="sxyz": tft.euler_matrix(0, 0, np.pi * degrees / 180.0, axes)[:3, :3]
)


@right("rotation_about_z")
def cofunctions_only(degrees):
    """Only cosines; sin(a) as cos(90 - a), the angle taken to the first turn first."""
    degrees = math.fmod(degrees, 360)
    c = [math.cos(math.radians(a)) for a in (degrees, degrees + 90, 90 - degrees)]
    return np.array([c[0], c[1], 0, c[2], c[0], 0, 0, 0, 1]).reshape(3, 3)


# ================================================================== rotation_from_axes


@right("rotation_from_axes")
def zip_star(x_axis, y_axis):
    """A list of tuples from zip(*...)."""
    return list(zip(x_axis, y_axis, np.cross(x_axis, y_axis)))


@right("rotation_from_axes")
def minus_reversed_cross(x_axis, y_axis):
    """z is minus y cross x, written with a skew matrix; np.c_."""
    return np.c_[x_axis, y_axis, -(skew(y_axis) @ x_axis)]


@right("rotation_from_axes")
def einsum_levi_civita(x_axis, y_axis):
    """z through the Levi-Civita symbol; rows, then turned over to Fortran order by .T."""
    z_axis = np.einsum("ijk,j,k->i", LEVI_CIVITA, x_axis, y_axis)
    return np.array([x_axis, y_axis, z_axis]).T


@right("rotation_from_axes")
def null_space_and_determinant(x_axis, y_axis):
    """z is what is at right angles to both, its sign decided by the determinant; np.matrix."""
    z = np.linalg.svd(np.array([x_axis, y_axis]))[2][2]
    M = np.matrix(np.vstack([x_axis, y_axis, z])).T
    if np.linalg.det(M) < 0:
        M[:, 2] *= -1
    return M


@right("rotation_from_axes")
def gram_schmidt_float32(x_axis, y_axis):
    """Orthonormalises again, in float64, and gives float32."""
    x = x_axis / np.linalg.norm(x_axis)
    y = y_axis - (x @ y_axis) * x
    y /= np.linalg.norm(y)
    return np.stack((x, y, np.cross(x, y)), axis=-1).astype("float32")


@right("rotation_from_axes")
def scipy_align_vectors(x_axis, y_axis):
    """The rotation that takes e_x, e_y to the two axes."""
    r, _ = Rotation.align_vectors([x_axis, y_axis], [[1, 0, 0], [0, 1, 0]])
    return r.as_matrix()


@right("rotation_from_axes")
def quaternion_product_of_axes(x_axis, y_axis):
    """The pure quaternions' product: i j = k."""
    z = tft.quaternion_multiply(list(x_axis) + [0], list(y_axis) + [0])[:-1]
    out = np.empty((3, 3))
    for column, axis in enumerate((x_axis, y_axis, z)):
        out[:, column] = axis
    return out


@right("rotation_from_axes")
def cofactors_of_what_is_known(x_axis, y_axis):
    """The third column is the cofactors of the first two; tuples of NumPy scalars."""
    (a, b, c), (d, e, f) = x_axis, y_axis
    return (a, d, b * f - c * e), (b, e, c * d - a * f), (c, f, a * e - b * d)


# ================================================================== is_rotation


@right("is_rotation")
def numpy_bool(R):
    """An np.bool_ from & of two np.bool_."""
    return np.bool_(np.abs(R @ R.T - np.eye(3)).max() <= 1e-6) & np.isclose(np.linalg.det(R), 1, rtol=0, atol=1e-6)


@right("is_rotation")
def one_or_zero(R):
    """1 or 0."""
    return 1 if np.allclose(R.T @ R, np.identity(3), rtol=0, atol=1e-6) and np.linalg.det(R) > 0 else 0


@right("is_rotation")
def third_column_is_cross(R):
    """x and y of length 1 and at right angles, z their cross product; no determinant, no transpose."""
    x, y, z = (R[:, i] for i in range(3))
    return bool(
        abs(x @ x - 1) < 1e-6 and abs(y @ y - 1) < 1e-6 and abs(x @ y) < 1e-6 and (abs(np.cross(x, y) - z) < 1e-6).all()
    )


@right("is_rotation")
def singular_values(R):
    """All singular values are 1, and it is no mirror; an array of no dimension."""
    try:
        s = np.linalg.svd(R, compute_uv=False)
    except np.linalg.LinAlgError:
        return np.array(False)
    return np.array(np.all(np.abs(s - 1) < 1e-6) and np.linalg.det(R) > 0)


@right("is_rotation")
def inverse_is_transpose(R):
    """Compares the inverse with the transpose; a singular matrix is an exception, and no rotation."""
    try:
        inverse = np.linalg.inv(R)
    except np.linalg.LinAlgError:
        return False
    if not np.allclose(inverse, R.T, rtol=0, atol=1e-6):
        return False
    return not np.linalg.det(R) < 0


@right("is_rotation")
def nearest_rotation(R):
    """SciPy makes the nearest rotation (or refuses); the matrix must be it."""
    if not np.isfinite(R).all():
        return False
    try:
        nearest = Rotation.from_matrix(R).as_matrix()
    except (ValueError, np.linalg.LinAlgError):
        return False
    return bool(np.max(np.abs(nearest - R)) < 1e-6)


@right("is_rotation")
def preserves_lengths_and_hands(R):
    """Takes vectors and their cross products along: R(a x b) = Ra x Rb, for the basis, and keeps lengths."""
    e = np.eye(3)
    keeps = all(
        np.linalg.norm(R @ np.cross(e[i], e[j]) - np.cross(R @ e[i], R @ e[j])) < 1e-6
        for i, j in itertools.combinations(range(3), 2)
    )
    return keeps and all(math.isclose(np.linalg.norm(R @ v), 1, rel_tol=0, abs_tol=1e-6) for v in e)


@right("is_rotation")
def early_returns_by_loops(R):
    """Three loops, early returns, the determinant by Sarrus."""
    for i in range(3):
        for j in range(3):
            s = 0
            for k in range(3):
                s += R[k][i] * R[k][j]
            if not abs(s - (i == j)) <= 1e-6:
                return False
    d = sum(R[0][i] * (R[1][(i + 1) % 3] * R[2][(i + 2) % 3] - R[1][(i + 2) % 3] * R[2][(i + 1) % 3]) for i in range(3))
    return d > 0


right("is_rotation", "lambda: a product of truth values")(
    lambda R: (np.linalg.norm(R.T.dot(R) - np.eye(3)) < 2e-6) * (np.linalg.det(R) > 0.5)
)

right("is_rotation", "cofactor matrix equals the matrix (one sentence for both conditions)")(
    lambda R: np.allclose(np.array([np.cross(R[1], R[2]), np.cross(R[2], R[0]), np.cross(R[0], R[1])]), R, 0, 1e-6)
    and np.linalg.det(R) > 0.5
)


# ================================================================== same_rotation


@right("same_rotation")
def either_sign_numpy_bool(q1, q2):
    """np.bool_, from | of the two ways."""
    return np.all(np.abs(q1 - q2) < 1e-6) | np.all(np.abs(q1 + q2) < 1e-6)


@right("same_rotation")
def outer_products(q1, q2):
    """q q^T does not know the sign."""
    return np.allclose(np.outer(q1, q1), np.outer(q2, q2), rtol=0, atol=1e-6)


@right("same_rotation")
def rotation_matrices(q1, q2):
    """Compares the matrices, in nested lists of NumPy bools."""
    return all(map(all, abs(tft.quaternion_matrix(q1) - tft.quaternion_matrix(q2)) < 2e-6))


@right("same_rotation")
def relative_quaternion(q1, q2):
    """The quaternion from one to the other is nearly 0, 0, 0, +-1; 1 or 0."""
    x, y, z, w = tft.quaternion_multiply(tft.quaternion_inverse(q1), q2)
    return int(math.hypot(x, y, z) < 1.5e-6)


@right("same_rotation")
def scipy_magnitude(q1, q2):
    """The angle between the two, in SciPy; half of it is what the numbers differ by."""
    return (Rotation.from_quat(q1).inv() * Rotation.from_quat(q2)).magnitude() / 2 < 1.5e-6


@right("same_rotation")
def sign_of_largest(q1, q2):
    """Both signs made equal by the largest number; an array of no dimension."""
    i = np.argmax(np.abs(q1))
    a, b = np.copysign(1, q1[i]) * q1, np.copysign(1, q2[i]) * q2
    return np.asarray(np.max(np.abs(a - b)) <= 1e-6)


@right("same_rotation")
def sign_of_dot(q1, q2):
    """The sign of the dot product says which of the two to compare with."""
    return np.allclose(q1, q2 * np.sign(np.dot(q1, q2)), rtol=0, atol=1e-6)


@right("same_rotation")
def any_generator(q1, q2):
    """any() of all() of generators, over a tuple of signs, in plain Python."""
    return any(all(abs(a - s * b) <= 1e-6 for a, b in zip(q1, q2)) for s in (1, -1))


@right("same_rotation")
def min_norm_recursive(q1, q2, tried=False):
    """Calls itself with the other sign; an argument that only it uses."""
    if np.linalg.norm(q1 - q2, ord=np.inf) <= 1e-6:
        return True
    return not tried and min_norm_recursive(q1, -q2, tried=True)


# ================================================================== make_transform


@right("make_transform")
def block(R, p):
    """np.block with p as a column."""
    return np.block([[R, p[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])


@right("make_transform")
def bmat(R, p):
    """np.bmat: an np.matrix."""
    return np.bmat([[R, np.reshape(p, (3, 1))], [np.zeros((1, 3)), np.eye(1)]])


@right("make_transform")
def r_and_c(R, p):
    """np.r_ and np.c_."""
    return np.r_[np.c_[R, p], [[0, 0, 0, 1]]]


@right("make_transform")
def nested_list(R, p):
    """A list of lists of NumPy scalars and ints."""
    return [[*row, t] for row, t in zip(R, p)] + [BOTTOM]


@right("make_transform")
def pad(R, p):
    """np.pad, then the last column."""
    T = np.pad(R.astype(float), ((0, 1), (0, 1)))
    T[:, -1] = *p, 1
    return T


@right("make_transform")
def translation_times_rotation(R, p):
    """First the translation, then the turn, as a product; the rotation through a quaternion."""
    return tft.translation_matrix(p) @ tft.quaternion_matrix(Rotation.from_matrix(R).as_quat())


@right("make_transform")
def rigid_transform_of_scipy(R, p):
    """SciPy's RigidTransform."""
    return RigidTransform.from_components(p, Rotation.from_matrix(R)).as_matrix()


@right("make_transform")
def columns_of_images(R, p):
    """Column by column, where e_x, e_y, e_z and the origin go, stacked as rows and transposed."""
    return np.array([np.append(v, w) for v, w in [(R @ (1, 0, 0), 0), (R @ (0, 1, 0), 0), (R @ (0, 0, 1), 0), (p, 1)]]).T


@right("make_transform")
def cached_identity(R, p, _start=IDENTITY):
    """A default argument that is a module's array, copied before it is filled; the results in Fortran order."""
    T = np.asfortranarray(_start.copy())
    T[np.ix_(range(3), range(3))] = R
    T[:-1, -1] = p
    return T


right("make_transform", "lambda: vstack of hstack")(
    lambda R, p: np.vstack((np.hstack((R, p.reshape(-1, 1))), np.eye(4)[-1]))
)


# ================================================================== hand_transform


@right("hand_transform")
def sixteen_ints(*_):
    """A nested list, ints and one float."""
    return [[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]


@right("hand_transform")
def rolled_by_minus_90():
    """Roll by -90 degrees: entries such as 6e-17 and -0.0 instead of 0."""
    T = tft.euler_matrix(-np.pi / 2, 0, 0)
    T[0, 3] -= 10 / 100
    return T


@right("hand_transform")
def rolled_by_270_float32():
    """Three quarter turns the other way round, float32."""
    T = np.linalg.matrix_power(tft.rotation_matrix(math.pi / 2, [1, 0, 0]), 3)
    return (tft.translation_matrix((-0.1, 0, 0)) @ T).astype(np.float32)


@right("hand_transform")
def text_matrix(unit="m"):
    """np.matrix of text; an optional argument nobody asked for."""
    return np.matrix("1 0 0 -.1; 0 0 1 0; 0 -1 0 0; 0 0 0 1")


HAND = np.zeros((4, 4))
HAND[0, 0] = HAND[1, 2] = HAND[3, 3] = 1
HAND[2, 1] = -1
HAND[0, 3] = -0.1

right("hand_transform", "bound method: HAND.copy")(HAND.copy)
right("hand_transform", "lambda: the very same module-level array each time")(lambda: HAND)
right("hand_transform", "partial: a function of fingers")(
    functools.partial(
        lambda index, middle, thumb, moved: tuple(zip(index + (0,), middle + (0,), thumb + (0,), moved + (1,))),
        (1, 0, 0), (0, 0, -1), thumb=(0, 1, 0), moved=(-0.1, 0, 0),
    )
)


# ================================================================== transform_to_pose


def bar_itzhack(R):
    return np.array([
        [R[0, 0] - R[1, 1] - R[2, 2], R[0, 1] + R[1, 0], R[0, 2] + R[2, 0], R[2, 1] - R[1, 2]],
        [R[0, 1] + R[1, 0], R[1, 1] - R[0, 0] - R[2, 2], R[1, 2] + R[2, 1], R[0, 2] - R[2, 0]],
        [R[0, 2] + R[2, 0], R[1, 2] + R[2, 1], R[2, 2] - R[0, 0] - R[1, 1], R[1, 0] - R[0, 1]],
        [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], R[0, 0] + R[1, 1] + R[2, 2]],
    ]) / 3  # fmt: skip


@right("transform_to_pose")
def eigenvector_of_bar_itzhack(matrix):
    """The orientation is an eigenvector, of whatever sign LAPACK likes."""
    q = np.linalg.eigh(bar_itzhack(matrix))[1][:, -1]
    return Pose(Point(*matrix[:3, 3]), Quaternion(*q))


@right("transform_to_pose")
def squared_until_only_q_is_left(matrix):
    """Power iteration by squaring; the orientation's numbers set field by field."""
    K = bar_itzhack(matrix)
    for _ in range(10):
        K = K @ K
        K = K / np.trace(K)
    i = int(np.argmax(np.diag(K)))
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = matrix[:3, -1].tolist()
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = K[i] / np.sqrt(K[i, i])
    return pose


@right("transform_to_pose")
def shepperd(matrix):
    """Four branches by hand, ROS-like messages of its own with slots."""
    m = matrix
    out = RosPose()
    out.position.x, out.position.y, out.position.z = float(m[0, 3]), float(m[1, 3]), float(m[2, 3])
    o = out.orientation
    t = m[0, 0] + m[1, 1] + m[2, 2]
    which = max((t, "w"), (m[0, 0], "x"), (m[1, 1], "y"), (m[2, 2], "z"))[1]
    if which == "w":
        s = math.sqrt(1 + t) * 2
        o.w, o.x, o.y, o.z = s / 4, (m[2, 1] - m[1, 2]) / s, (m[0, 2] - m[2, 0]) / s, (m[1, 0] - m[0, 1]) / s
    elif which == "x":
        s = math.sqrt(1 + m[0, 0] - m[1, 1] - m[2, 2]) * 2
        o.w, o.x, o.y, o.z = (m[2, 1] - m[1, 2]) / s, s / 4, (m[0, 1] + m[1, 0]) / s, (m[0, 2] + m[2, 0]) / s
    elif which == "y":
        s = math.sqrt(1 + m[1, 1] - m[0, 0] - m[2, 2]) * 2
        o.w, o.x, o.y, o.z = (m[0, 2] - m[2, 0]) / s, (m[0, 1] + m[1, 0]) / s, s / 4, (m[1, 2] + m[2, 1]) / s
    else:
        s = math.sqrt(1 + m[2, 2] - m[0, 0] - m[1, 1]) * 2
        o.w, o.x, o.y, o.z = (m[1, 0] - m[0, 1]) / s, (m[0, 2] + m[2, 0]) / s, (m[1, 2] + m[2, 1]) / s, s / 4
    return out


@right("transform_to_pose")
def negated_lab_answer(matrix):
    """The lab's way, all four numbers with the other sign; NumPy scalars in the fields."""
    pose = Pose()
    pose.position = Point(*tft.translation_from_matrix(matrix))
    pose.orientation = Quaternion(*-tft.quaternion_from_matrix(matrix))
    return pose


@right("transform_to_pose")
def always_negative_w(matrix):
    """Makes w negative on purpose, keyword messages."""
    x, y, z, w = Rotation.from_matrix(matrix[:3, :3]).as_quat(canonical=True)
    return Pose(orientation=Quaternion(w=-w, z=-z, y=-y, x=-x), position=Point(z=matrix[2, 3], x=matrix[0, 3], y=matrix[1, 3]))


@right("transform_to_pose")
def scipy_rigid_transform(matrix):
    """SciPy's RigidTransform has both parts; SimpleNamespace all through."""
    motion = RigidTransform.from_matrix(matrix)
    return SimpleNamespace(
        position=SimpleNamespace(**dict(zip("xyz", motion.translation))),
        orientation=SimpleNamespace(**dict(zip("xyzw", motion.rotation.as_quat()))),
    )


@right("transform_to_pose")
def align_vectors(matrix):
    """Wahba's problem: which rotation takes the basis to the columns? A namedtuple of namedtuples."""
    r = Rotation.align_vectors(matrix[:3, :3].T, np.eye(3))[0]
    return PoseTuple(PointTuple(*matrix[:3, 3]), QuaternionTuple(*r.as_quat()))


@right("transform_to_pose")
def rotation_vector(matrix):
    """Axis times angle, then sine and cosine of half of it; a Vector3 as position."""
    v = Rotation.from_matrix(matrix[:-1, :-1]).as_rotvec()
    angle = np.linalg.norm(v)
    q = Quaternion(*(v * np.sinc(angle / 2 / np.pi) / 2), math.cos(angle / 2))
    return Pose(Vector3(*matrix[:3, 3]), q)


@right("transform_to_pose")
def modified_rodrigues(matrix):
    """Modified Rodrigues parameters, and the stereographic projection back; a dataclass of its own."""
    p = Rotation.from_matrix(matrix[:3, :3]).as_mrp()
    n = p.dot(p)
    return MyPose(MyPoint(*matrix[:3, 3]), MyQuaternion(*(2 * p / (1 + n)), (1 - n) / (1 + n)))


@right("transform_to_pose")
def null_space_of_commutation(matrix):
    """q e = (R e) q for the three basis vectors: twelve equations, q is their null space."""
    rows = []
    for e, Re in zip(np.eye(3), matrix[:3, :3].T):
        rows.append(np.column_stack([
            tft.quaternion_multiply(b, [*e, 0]) - tft.quaternion_multiply([*Re, 0], b) for b in np.eye(4)
        ]))  # fmt: skip
    q = np.linalg.svd(np.concatenate(rows))[2][3]
    return Pose(Point(*matrix[:3, 3]), Quaternion(*q))


@right("transform_to_pose")
def axis_from_symmetric_part(matrix):
    """The axis is an eigenvector of R + R^T, the angle an atan2 that takes the axis's sign with it."""
    R = matrix[0:3, 0:3]
    axis = np.linalg.eigh(R + R.T)[1][:, 2]
    vee = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    half = math.atan2(axis @ vee, R.trace() - 1) / 2
    pose = Pose()
    for name, value in zip("xyz", matrix[:3, 3]):
        setattr(pose.position, name, value)
    for name, value in zip("xyzw", [*(axis * math.sin(half)), math.cos(half)]):
        setattr(pose.orientation, name, value)
    return pose


@right("transform_to_pose")
def complex_eigenvector(matrix):
    """np.linalg.eig, the eigenvalue nearest to 1; numbers are taken out of complex arrays."""
    R = np.array(matrix[:3, :3], dtype=float)
    values, vectors = np.linalg.eig(R)
    axis = vectors[:, np.abs(values - 1).argmin()].real
    axis = axis / np.linalg.norm(axis)
    s = np.dot(axis, (R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1])) / 2
    half = np.arctan2(s, (np.trace(R) - 1) / 2) * 0.5
    return Pose(Point(*matrix[:3, 3]), Quaternion(*np.r_[axis * np.sin(half), np.cos(half)]))


@right("transform_to_pose")
def logarithm_away_from_half_turns(matrix):
    """Matrix logarithm, after a half turn about an axis has brought the rotation to below 120 degrees."""
    R = matrix[:3, :3]
    i = max(range(4), key=lambda k: np.trace(R @ HALF_TURNS[k]))
    L = np.real(scipy.linalg.logm(R @ HALF_TURNS[i]))
    q = tft.quaternion_multiply(Rotation.from_rotvec([L[2, 1], L[0, 2], L[1, 0]]).as_quat(), np.eye(4)[i])
    return Pose(Point(*matrix[:3, 3]), Quaternion(*q))


@right("transform_to_pose")
def cayley_away_from_half_turns(matrix):
    """Cayley's formula, after a half turn has brought the rotation to below 120 degrees; own quaternion product."""
    R, I = matrix[:3, :3], np.eye(3)
    i = int(np.argmax([(R * D).sum() for D in HALF_TURNS]))
    Q = R @ HALF_TURNS[i]
    S = np.linalg.solve(Q + I, Q - I)
    q = np.array(hamilton((S[2, 1], S[0, 2], S[1, 0], 1.0), tuple(np.eye(4)[i])))
    q /= np.sqrt(q.dot(q))
    return Pose(Point(*matrix[:3, 3].tolist()), Quaternion(*q.tolist()))


@right("transform_to_pose")
def euler_round_trip(matrix):
    """Roll, pitch, yaw and back, by tft."""
    return Pose(Point(*matrix[:3, 3]), Quaternion(*tft.quaternion_from_euler(*tft.euler_from_matrix(matrix))))


@right("transform_to_pose")
def euler_by_hand_sound_at_gimbal_lock(matrix):
    """Roll first, yaw from what the roll leaves (good at gimbal lock too), half angles by hand."""
    R = matrix
    roll = math.atan2(R[2, 1], R[2, 2])
    s, c = math.sin(roll), math.cos(roll)
    yaw = math.atan2(s * R[0, 2] - c * R[0, 1], c * R[1, 1] - s * R[1, 2])
    pitch = math.atan2(-R[2, 0], math.hypot(R[0, 0], R[1, 0]))
    qx, qy, qz = ((math.sin(a / 2), math.cos(a / 2)) for a in (roll, pitch, yaw))
    q = hamilton((0, 0, *qz), hamilton((0, qy[0], 0, qy[1]), (qx[0], 0, 0, qx[1])))
    return Pose(Point(R[0, 3], R[1, 3], R[2, 3]), Quaternion(*q))


@right("transform_to_pose")
def ints_where_it_can(matrix):
    """Numbers that are whole become ints."""

    def whole(v):
        return int(round(v)) if abs(v - round(v)) < 1e-12 else float(v)

    q = tft.quaternion_from_matrix(matrix)
    return Pose(Point(*map(whole, matrix[:3, 3])), Quaternion(*map(whole, q)))


@right("transform_to_pose")
def float32_orientation(matrix):
    """float32 numbers in the orientation, longdouble ones in the position."""
    q = Rotation.from_matrix(matrix[:3, :3]).as_quat().astype(np.float32)
    return Pose(Point(*np.longdouble(matrix[:3, 3])), Quaternion(*q))


@right("transform_to_pose")
def arrays_of_no_dimension(matrix):
    """Every field is an array of no dimension, which is a number for all that uses it."""
    q = tft.quaternion_from_matrix(matrix)
    return Pose(Point(*(np.array(v) for v in matrix[:3, 3])), Quaternion(*(np.array(v) for v in q)))


@right("transform_to_pose")
def fields_on_demand(matrix):
    """A class of its own with properties instead of stored fields."""
    return LazyPose(np.array(matrix))


@right("transform_to_pose")
def subclass_of_the_labs_pose(matrix):
    """A subclass of Pose with a method more."""
    return PoseSubclass(Point(*matrix[:3, 3]), Quaternion(*tft.quaternion_from_matrix(matrix)))


@right("transform_to_pose")
def prints_and_logs(matrix):
    """Prints, warns and logs on its way."""
    print("matrix is\n", matrix)
    warnings.warn("position is taken in metres")
    pose = Pose(Point(*matrix[:3, 3]), Quaternion(*tft.quaternion_from_matrix(matrix)))
    log.warning("pose is %s", pose)
    return pose


@right("transform_to_pose")
def markley_largest_column(matrix):
    """4 q q^T written down, its longest column, normalised; with `np.matrix`, so that column is 4x1 on the way."""
    K = np.matrix(3 * bar_itzhack(matrix) + np.eye(4))
    lengths = [np.linalg.norm(K[:, j]) for j in range(4)]
    q = K[:, lengths.index(max(lengths))] / max(lengths)
    return Pose(position=Point(*matrix[:3, 3]), orientation=Quaternion(*np.asarray(q).ravel()))


@right("transform_to_pose")
def two_step_alignment(matrix):
    """Turns the old z to the new z the short way, and then the rest about the new z; the longer way if opposite."""
    R = matrix[:3, :3]
    flip = R[2, 2] < 0  # z points down: first half a turn about x, so that the short way is never ambiguous
    Q = R @ HALF_TURNS[0] if flip else R
    z = Q[:, 2]
    tilt = np.append(np.cross([0, 0, 1], z), 1 + z[2])
    tilt = tilt / np.linalg.norm(tilt)
    rest = Rotation.from_quat(tilt).as_matrix().T @ Q
    turn = math.atan2(rest[1, 0], rest[0, 0])
    q = hamilton(tilt, (0, 0, math.sin(turn / 2), math.cos(turn / 2)))
    if flip:
        q = hamilton(q, (1, 0, 0, 0))
    return Pose(Point(*matrix[:3, 3]), Quaternion(*q))


class PoseMaker:
    """A callable object that counts."""

    def __init__(self):
        self.made = 0

    def __call__(self, matrix):
        self.made += 1
        return matrix_pose(matrix)

    def make(self, matrix, frame_id="base_link"):
        return self(matrix)

    @staticmethod
    def static(matrix):
        return MyPose(MyPoint(*matrix[:3, 3]), MyQuaternion(*-Rotation.from_matrix(matrix[:3, :3]).as_quat()))


right("transform_to_pose", "callable object that counts")(PoseMaker())
right("transform_to_pose", "bound method with an extra optional argument")(PoseMaker().make)
right("transform_to_pose", "static method, frozen dataclass, negated")(PoseMaker.static)
right("transform_to_pose", "lambda: namedtuple with the fields in the other order")(
    lambda T: BackwardsPoseTuple(QuaternionTuple(*tft.quaternion_from_matrix(T)), PointTuple(*T[:3, 3]))
)


# ================================================================== pose_to_transform


@right("pose_to_transform")
def rodrigues(pose):
    """Axis and angle, and Rodrigues' formula; the whole turn's angle for a negative w."""
    v = np.array(numbers_of(pose.orientation, "xyz"), dtype=float)
    s = np.linalg.norm(v)
    angle = 2 * math.atan2(s, pose.orientation.w)
    K = skew(v / s) if s > 0 else np.zeros((3, 3))
    T = np.eye(4)
    T[:3, :3] += math.sin(angle) * K + (1 - math.cos(angle)) * K @ K
    T[:3, 3] = numbers_of(pose.position, "xyz")
    return T


@right("pose_to_transform")
def exponential_of_rotation_vector(pose):
    """Matrix exponential of the rotation vector's skew matrix."""
    o, p = pose.orientation, pose.position
    r = Rotation.from_quat([o.x, o.y, o.z, o.w]).as_rotvec()
    return np.vstack([np.column_stack([scipy.linalg.expm(skew(r)), (p.x, p.y, p.z)]), BOTTOM])


@right("pose_to_transform")
def sandwich_of_basis_vectors(pose):
    """q e q* for the three axes, and a nested list at the end."""
    q = tuple(numbers_of(pose.orientation, "xyzw"))
    axes = [hamilton(hamilton(q, e), conj(q))[:3] for e in ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0))]
    p = (pose.position.x, pose.position.y, pose.position.z)
    return [list(row) for row in zip(*axes, p)] + [[0, 0, 0, 1]]


@right("pose_to_transform")
def left_and_right_matrices(pose):
    """The 4x4 matrices of q* from the right and q from the left: their product is the rotation, with the 1 in place."""
    x, y, z, w = numbers_of(pose.orientation, "xyzw")
    L = np.array([[w, -z, y, x], [z, w, -x, y], [-y, x, w, z], [-x, -y, -z, w]])
    Rq = np.array([[w, -z, y, -x], [z, w, -x, -y], [-y, x, w, -z], [x, y, z, w]])
    T = L @ Rq
    T = T / T[3, 3]
    T[0, 3], T[1, 3], T[2, 3] = pose.position.x, pose.position.y, pose.position.z
    return T


@right("pose_to_transform")
def textbook_tuple(pose):
    """The textbook's nine formulas, as a tuple of tuples."""
    q, p = pose.orientation, pose.position
    x, y, z, w = q.x, q.y, q.z, q.w
    return (
        (1 - 2 * (y**2 + z**2), 2 * (x * y - z * w), 2 * (x * z + y * w), p.x),
        (2 * (x * y + z * w), 1 - 2 * (x**2 + z**2), 2 * (y * z - x * w), p.y),
        (2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x**2 + y**2), p.z),
        (0, 0, 0, 1),
    )


@right("pose_to_transform")
def einsum_formula(pose):
    """(w^2 - v.v) I + 2 v v^T + 2 w [v]x with einsum; np.matrix."""
    v, w = np.array(numbers_of(pose.orientation, "xyz")), pose.orientation.w
    R = (w * w - v @ v) * np.eye(3) + 2 * np.einsum("i,j->ij", v, v) - 2 * w * np.einsum("ijk,k->ij", LEVI_CIVITA, v)
    return np.bmat([[R, np.matrix(numbers_of(pose.position, "xyz")).T], [np.zeros((1, 3)), np.matrix([[1]])]])


@right("pose_to_transform")
def scipy_components(pose):
    """RigidTransform.from_components."""
    r = Rotation.from_quat(numbers_of(pose.orientation, "xyzw"))
    return RigidTransform.from_components(numbers_of(pose.position, "xyz"), r).as_matrix()


@right("pose_to_transform")
def scipy_scalar_first(pose):
    """w first, and SciPy is told so."""
    o = pose.orientation
    T = np.zeros((4, 4))
    T[:3, :3] = Rotation.from_quat([o.w, o.x, o.y, o.z], scalar_first=True).as_matrix()
    T[:, 3] = [pose.position.x, pose.position.y, pose.position.z, 1]
    return T


@right("pose_to_transform")
def concatenate_matrices(pose):
    """tft only: a translation, then a rotation."""
    return tft.concatenate_matrices(
        tft.translation_matrix(numbers_of(pose.position, "xyz")),
        tft.quaternion_matrix(tuple(getattr(pose.orientation, n) for n in "xyzw")),
    )


@right("pose_to_transform")
def cayley_of_largest(pose):
    """Cayley's formula, from whichever of the four numbers is largest, and a half turn for it."""
    q = numbers_of(pose.orientation, "xyzw")
    i = max(range(4), key=lambda k: abs(q[k]))
    e = np.eye(4)[i] * [-1, -1, -1, 1]
    x, y, z, w = hamilton(q, e)
    S = skew((x / w, y / w, z / w))
    R = np.linalg.inv(np.eye(3) - S) @ (np.eye(3) + S) @ HALF_TURNS[i]
    return np.block([[R, np.c_[numbers_of(pose.position, "xyz")]], [np.eye(4)[3:]]])


@right("pose_to_transform")
def euler_angles(pose):
    """Roll, pitch, yaw of the quaternion and back to a matrix."""
    T = tft.euler_matrix(*tft.euler_from_quaternion(numbers_of(pose.orientation, "xyzw"), "rzyx"), "rzyx")
    T[:3, -1] += numbers_of(pose.position, "xyz")
    return T


@right("pose_to_transform")
def pauli_matrices(pose):
    """SU(2): R_ij = tr(s_i U s_j U*) / 2 with Pauli matrices; a view of the real part of a complex array."""
    s = np.array([[[0, 1], [1, 0]], [[0, -1j], [1j, 0]], [[1, 0], [0, -1]]])
    x, y, z, w = numbers_of(pose.orientation, "xyzw")
    U = w * np.eye(2) - 1j * (x * s[0] + y * s[1] + z * s[2])
    T = np.eye(4, dtype=complex)
    T[:3, :3] = np.einsum("iab,bc,jcd,da->ij", s, U, s, U.conj().T) / 2
    T[:3, 3] = numbers_of(pose.position, "xyz")
    return T.real


@right("pose_to_transform")
def two_mirrors(pose):
    """Two mirrors, half the angle apart (the quaternion is the product of their normals)."""
    *v, w = numbers_of(pose.orientation, "xyzw")
    v = np.array(v, dtype=float)
    a = np.cross(v, np.eye(3)[np.argmin(np.abs(v))])
    a /= np.linalg.norm(a) or 1.0
    if not a.any():
        a = np.array([1.0, 0, 0])
    b = w * a + np.cross(v, a)
    b /= np.linalg.norm(b)
    mirror = lambda n: np.eye(3) - 2 * np.outer(n, n)  # noqa: E731
    T = np.identity(4)
    T[:3, :3] = mirror(b).dot(mirror(a))
    T[:3, 3] = [pose.position.x, pose.position.y, pose.position.z]
    return T


@right("pose_to_transform")
def view_into_something_larger(pose):
    """A view with strides into a larger array, made read-only."""
    room = np.full((8, 9), np.nan)
    T = room[1:8:2, 2:9:2]
    T[...] = pose_matrix(pose)
    T.setflags(write=False)
    return T


@functools.lru_cache
def _matrix_of(px, py, pz, x, y, z, w):
    return tft.translation_matrix((px, py, pz)) @ tft.quaternion_matrix((x, y, z, w))


@right("pose_to_transform")
def memo(pose):
    """Remembers results by the seven numbers; the same array is returned for the same pose."""
    return _matrix_of(*numbers_of(pose.position, "xyz"), *numbers_of(pose.orientation, "xyzw"))


@right("pose_to_transform")
def copy_mutated(pose):
    """Normalises the quaternion in place, on a deep copy of the pose."""
    pose = copy.deepcopy(pose)
    n = math.sqrt(sum(v * v for v in numbers_of(pose.orientation, "xyzw")))
    for name in "xyzw":
        setattr(pose.orientation, name, -getattr(pose.orientation, name) / n)
    return pose_matrix(pose).tolist()


@right("pose_to_transform")
def matched(pose):
    """A match statement takes the message apart."""
    match pose:
        case object(position=object(x=px, y=py, z=pz), orientation=object(x=x, y=y, z=z, w=w)):
            return np.r_["0,2", np.c_[Rotation.from_quat((x, y, z, w)).as_matrix(), [px, py, pz]], BOTTOM]


@right("pose_to_transform")
def homogeneous_quaternion_squares(pose):
    """No 1 in the formulas: squares, divided by the quaternion's squared length."""
    x, y, z, w = numbers_of(pose.orientation, "xyzw")
    n = x * x + y * y + z * z + w * w
    T = np.diag([x * x - y * y - z * z + w * w, y * y - x * x - z * z + w * w, z * z - x * x - y * y + w * w, n]) / n
    for i, j, k, s in ((0, 1, z, x * y), (1, 2, x, y * z), (2, 0, y, x * z)):
        T[i, j], T[j, i] = 2 * (s - k * w) / n, 2 * (s + k * w) / n
    T[:3, 3:] = [[pose.position.x], [pose.position.y], [pose.position.z]]
    return T


right("pose_to_transform", "partial of a function of two")(
    functools.partial(lambda make, pose: make(pose), lambda pose: np.asmatrix(pose_matrix(pose)))
)


# ================================================================== transform_point


@right("transform_point")
def fourth_number_divided_out(a_T_b, p_in_b):
    """Homogeneous coordinates of length 5 m, divided by the last one."""
    v = a_T_b @ (5 * np.append(p_in_b, 1))
    return v[:3] / v[3]


@right("transform_point")
def column(a_T_b, p_in_b):
    """A column: the result has shape (3, 1)."""
    return a_T_b[:3, :3] @ p_in_b.reshape(3, 1) + a_T_b[:3, 3:]


@right("transform_point")
def row(a_T_b, p_in_b):
    """A row: the result has shape (1, 3)."""
    return (np.array([[*p_in_b, 1]]) @ a_T_b.T)[:, :3]


@right("transform_point")
def matrix_column(a_T_b, p_in_b):
    """np.matrix all through; the result is an np.matrix column."""
    return (np.matrix(a_T_b) * np.matrix(np.append(p_in_b, 1)).T)[0:3]


@right("transform_point")
def list_of_scalars(a_T_b, p_in_b):
    """A list of NumPy scalars, from loops."""
    return [sum((a_T_b[i, j] * p_in_b[j] for j in range(3)), a_T_b[i, 3]) for i in range(3)]


@right("transform_point")
def generator_to_tuple(a_T_b, p_in_b):
    """A tuple of Python floats from map and operator.mul."""
    return tuple(float(sum(map(operator.mul, r, (*p_in_b, 1)))) for r in a_T_b[:-1])


@right("transform_point")
def solves_backwards(a_T_b, p_in_b):
    """Finds the point whose description in B is the given one."""
    return np.linalg.lstsq(np.linalg.inv(a_T_b), np.r_[p_in_b, 1.0], rcond=None)[0][:-1]


@right("transform_point")
def by_quaternion(a_T_b, p_in_b):
    """q p q*, and then the translation."""
    q = tft.quaternion_from_matrix(a_T_b)
    turned = tft.quaternion_multiply(tft.quaternion_multiply(q, [*p_in_b, 0]), tft.quaternion_conjugate(q))
    return (turned[:3] + tft.translation_from_matrix(a_T_b)).tolist()


@right("transform_point")
def as_a_transform(a_T_b, p_in_b):
    """The point as a frame that is not turned; the product's last column."""
    return (a_T_b @ tft.translation_matrix(p_in_b))[:3, 3]


@right("transform_point")
def along_the_axes(a_T_b, p_in_b):
    """In place on a copy: from the origin, along x, along y, along z."""
    here = a_T_b[:3, 3].astype(float)
    for length, axis in zip(p_in_b, a_T_b[:3, :3].T):
        here += length * axis
    return here


right("transform_point", "lambda: einsum")(lambda a_T_b, p_in_b: np.einsum("ij,j->i", a_T_b, [*p_in_b, 1])[:3])
right("transform_point", "SciPy's RigidTransform.apply")(lambda T, p: RigidTransform.from_matrix(T).apply(p))


# ================================================================== chain


@right("chain")
def reduced(*transforms):
    """functools.reduce: for one transform it is the argument itself."""
    return functools.reduce(np.dot, transforms)


@right("chain")
def recursive_from_the_right(first, *rest):
    """Recursion, and the product is built from the right."""
    return first if not rest else first @ recursive_from_the_right(*rest)


@right("chain")
def halves(*transforms):
    """Divide and conquer: products in another order, in the same sequence."""
    n = len(transforms)
    return np.array(transforms[0]) if n == 1 else halves(*transforms[: n // 2]) @ halves(*transforms[n // 2 :])


@right("chain")
def multi_dot(*transforms):
    """np.linalg.multi_dot, which wants two at least."""
    return np.linalg.multi_dot([np.eye(4), np.eye(4), *transforms])


@right("chain")
def inverse_of_reversed_inverses(*transforms):
    """(C^-1 B^-1 A^-1)^-1."""
    P = np.eye(4)
    for T in transforms:
        P = np.linalg.inv(T) @ P
    return np.linalg.inv(P)


@right("chain")
def transposed_of_reversed(*transforms):
    """(C^T B^T A^T)^T, with a list that is popped from."""
    todo = list(transforms)
    product = np.eye(4)
    while todo:
        product = todo.pop(0).T @ product
    return product.T


@right("chain")
def np_matrices(*transforms):
    """np.matrix, where * is the product."""
    product = 1
    for T in map(np.asmatrix, transforms):
        product = product * T
    return product


@right("chain")
def last_of_accumulate(*transforms, start=None):
    """itertools.accumulate, the last of the generator; an optional keyword of its own."""
    return collections.deque(itertools.accumulate(transforms, operator.matmul, initial=start or IDENTITY), maxlen=1)[0]


@right("chain")
def one_einsum(*transforms):
    """One einsum for all factors, with as many indices as it takes."""
    operands = []
    for i, T in enumerate(transforms):
        operands += [T, [i, i + 1]]
    return np.einsum(*operands, [0, len(transforms)], optimize=True)


@right("chain")
def parts_apart(*transforms):
    """Rotations and positions apart, nested lists back."""
    R, p = np.eye(3), np.zeros(3)
    for T in transforms:
        p, R = p + R @ T[:3, 3], R @ T[:3, :3]
    return np.vstack([np.column_stack([R, p]), BOTTOM]).tolist()


@right("chain")
def quaternions(*transforms):
    """A product of quaternions and a running sum of turned positions."""
    q, p = (0.0, 0.0, 0.0, 1.0), np.zeros(3)
    for T in transforms:
        p = p + Rotation.from_quat(q).apply(T[:3, 3])
        q = hamilton(q, tuple(tft.quaternion_from_matrix(T)))
    M = tft.quaternion_matrix(q)
    M[:3, 3] = p
    return M


@right("chain")
def by_columns(*transforms):
    """Sends the four columns of the identity through the chain, last transform first."""
    return np.column_stack([functools.reduce(lambda v, T: T @ v, reversed(transforms), e) for e in np.eye(4)])


class Chain:
    """Overloads * and keeps what it has seen."""

    def __init__(self, T=IDENTITY):
        self.T = T

    def __mul__(self, other):
        return Chain(np.matmul(self.T, other))

    def __call__(self, *transforms):
        return functools.reduce(operator.mul, transforms, self).T

    @classmethod
    def of(cls, *transforms):
        return cls()(*transforms)


right("chain", "callable object that multiplies")(Chain())
right("chain", "class method")(Chain.of)
right("chain", "a partial with the identity as first factor")(functools.partial(tft.concatenate_matrices, np.eye(4)))
right("chain", "tft.concatenate_matrices itself")(tft.concatenate_matrices)
right("chain", "lambda: RigidTransform product")(
    lambda *Ts: functools.reduce(operator.mul, map(RigidTransform.from_matrix, Ts)).as_matrix()
)


# ================================================================== transform_pose


@right("transform_pose")
def quaternion_product(a_T_b, pose_in_b):
    """Positions and quaternions apart."""
    q = tft.quaternion_multiply(tft.quaternion_from_matrix(a_T_b), numbers_of(pose_in_b.orientation, "xyzw"))
    p = a_T_b @ [*numbers_of(pose_in_b.position, "xyz"), 1]
    return Pose(Point(*p[:3]), Quaternion(*q))


@right("transform_pose")
def deep_copy(a_T_b, pose_in_b):
    """Changes a deep copy, field by field; the whole orientation negated."""
    out = copy.deepcopy(pose_in_b)
    T = a_T_b.dot(pose_matrix(pose_in_b))
    out.position.x, out.position.y, out.position.z = T[:3, 3]
    out.orientation.x, out.orientation.y, out.orientation.z, out.orientation.w = -tft.quaternion_from_matrix(T)
    return out


@right("transform_pose")
def same_class_as_argument(a_T_b, pose_in_b):
    """Makes its result of the classes of the argument, whatever they are."""
    T = a_T_b @ pose_matrix(pose_in_b)
    out = type(pose_in_b)()
    out.position = type(pose_in_b.position)(*T[:3, 3].tolist())
    out.orientation = type(pose_in_b.orientation)(*tft.quaternion_from_matrix(T).tolist())
    return out


@right("transform_pose")
def rigid_transforms(a_T_b, pose_in_b):
    """SciPy's RigidTransform, result in SimpleNamespaces."""
    r = Rotation.from_quat(numbers_of(pose_in_b.orientation, "xyzw"))
    t = RigidTransform.from_matrix(a_T_b) * RigidTransform.from_components(numbers_of(pose_in_b.position, "xyz"), r)
    (x, y, z), (i, j, k, w) = t.translation, t.rotation.as_quat()
    return SimpleNamespace(
        orientation=SimpleNamespace(w=w, x=i, y=j, z=k), position=SimpleNamespace(x=x, y=y, z=z), frame_id="a"
    )


@right("transform_pose")
def four_points(a_T_b, pose_in_b):
    """Describes the origin and the tips of the axes in A, and reads the pose off them."""
    o, tip_x, tip_y, tip_z = (a_T_b @ pose_matrix(pose_in_b) @ [*e, 1] for e in ((0, 0, 0), *np.eye(3)))
    R = np.array([tip_x - o, tip_y - o, tip_z - o])[:, :3].T
    return PoseTuple(PointTuple(*o[:3]), QuaternionTuple(*Rotation.from_matrix(R).as_quat()))


def with_matrices(function):
    """Decorator: Pose to matrix on the way in, matrix to Pose on the way out (without functools.wraps)."""

    def wrapper(a_T_b, pose, *more, **named):
        return matrix_pose(function(a_T_b, pose_matrix(pose), *more, **named))

    return wrapper


@right("transform_pose", "decorated, a wrapper of another name")
@with_matrices
def decorated(T, M):
    """The product alone; a decorator does the rest."""
    return np.matmul(T, M)


@right("transform_pose")
def warns_of_nothing(a_T_b: np.ndarray, pose_in_b: Pose, verbose: bool = True) -> Pose:
    """Annotated; prints and warns."""
    if verbose:
        print("transforming", pose_in_b)
        warnings.warn("this is only a homework", UserWarning, stacklevel=2)
    return matrix_pose(np.asmatrix(a_T_b) * np.asmatrix(pose_matrix(pose_in_b)))


@right("transform_pose")
def same_quaternion_from_eigenvector(a_T_b, pose_in_b):
    """The orientation from an eigenvector of the product, the position with einsum."""
    T = np.einsum("ij,jk->ik", a_T_b, pose_matrix(pose_in_b))
    out = RosPose()
    out.position.x, out.position.y, out.position.z = T[:3, 3]
    for n, v in zip(out.orientation.__slots__, np.linalg.eigh(bar_itzhack(T))[1].T[-1]):
        setattr(out.orientation, n, v)
    return out


# ================================================================== invert_transform

right("invert_transform", "np.linalg.inv itself")(np.linalg.inv)
right("invert_transform", "np.linalg.pinv itself")(np.linalg.pinv)
right("invert_transform", "tft.inverse_matrix itself")(tft.inverse_matrix)
right("invert_transform", "lambda: np.matrix.I")(lambda a_T_b: np.matrix(a_T_b).I)
right("invert_transform", "partial of solve with keyword b")(functools.partial(np.linalg.solve, b=np.eye(4)))
right("invert_transform", "lambda: T to the power of -1")(lambda T: np.linalg.matrix_power(T, -1))


@right("invert_transform")
def p_at_minus_R(a_T_b):
    """R^T p with the minus written as p @ -R, into an empty array."""
    R, p = a_T_b[:3, :3], a_T_b[:3, 3]
    out = np.empty_like(a_T_b)
    out[:3, :3] = R.T
    out[:3, 3] = p @ -R
    out[3] = 0, 0, 0, 1
    return out


@right("invert_transform")
def least_squares(a_T_b):
    """lstsq with the identity on the right."""
    return np.linalg.lstsq(a_T_b, np.eye(4), rcond=None)[0]


@right("invert_transform")
def adjugate(a_T_b):
    """Cofactors over the determinant, by minors."""
    minors = [
        [(-1) ** (i + j) * np.linalg.det(np.delete(np.delete(a_T_b, i, 0), j, 1)) for i in range(4)] for j in range(4)
    ]
    return np.array(minors) / np.linalg.det(a_T_b)


@right("invert_transform")
def gauss_jordan(a_T_b):
    """Gauss-Jordan with pivoting, in place on a copy; a list of lists."""
    M = [[float(v) for v in row] + [float(i == j) for j in range(4)] for i, row in enumerate(a_T_b)]
    for c in range(4):
        pivot = max(range(c, 4), key=lambda r: abs(M[r][c]))
        M[c], M[pivot] = M[pivot], M[c]
        M[c] = [v / M[c][c] for v in M[c]]
        for r in range(4):
            if r != c:
                M[r] = [a - M[r][c] * b for a, b in zip(M[r], M[c])]
    return [row[4:] for row in M]


@right("invert_transform")
def cayley_hamilton(a_T_b):
    """The inverse from the characteristic polynomial."""
    c = np.poly(a_T_b).real
    return -(a_T_b @ a_T_b @ a_T_b + c[1] * a_T_b @ a_T_b + c[2] * a_T_b + c[3] * np.eye(4)) / c[4]


@right("invert_transform")
def newton_schulz(a_T_b):
    """Newton's iteration X (2 I - T X)."""
    X = a_T_b.T / (np.linalg.norm(a_T_b, 1) * np.linalg.norm(a_T_b, np.inf))
    for _ in range(80):
        X = X @ (2 * np.eye(4) - a_T_b @ X)
    return X


@right("invert_transform")
def svd_inverse(a_T_b):
    """Singular values."""
    U, s, Vt = np.linalg.svd(a_T_b)
    return Vt.T @ np.diag(1 / s) @ U.T


@right("invert_transform")
def qr_inverse(a_T_b):
    """QR and back substitution."""
    Q, R = scipy.linalg.qr(a_T_b)
    return scipy.linalg.solve_triangular(R, Q.T)


@right("invert_transform")
def lu_overwriting_a_copy(a_T_b):
    """LU, allowed to overwrite its own copy; Fortran order."""
    return scipy.linalg.lu_solve(scipy.linalg.lu_factor(np.array(a_T_b, order="F"), overwrite_a=True), np.eye(4, order="F"), overwrite_b=True)


@right("invert_transform")
def sparse(a_T_b):
    """A sparse solver, dense again at the end."""
    return scipy.sparse.linalg.spsolve(scipy.sparse.csc_array(a_T_b), np.eye(4))


@right("invert_transform")
def untranslate_then_unrotate(a_T_b):
    """Two transforms, undone in the other order."""
    turned = a_T_b.copy()
    turned[:3, 3] = 0
    return turned.T @ tft.translation_matrix(-a_T_b[:3, 3])


@right("invert_transform")
def scipy_rigid_inverse(a_T_b):
    """RigidTransform.inv()."""
    return RigidTransform.from_matrix(a_T_b).inv().as_matrix()


@right("invert_transform")
def conjugate_quaternion(a_T_b):
    """The conjugate quaternion turns both the frame and the position; a tuple of tuples."""
    q = conj(tft.quaternion_from_matrix(a_T_b))
    x, y, z, _ = hamilton(hamilton(q, (*-a_T_b[:3, 3], 0)), conj(q))
    M = tft.quaternion_matrix(q)
    M[0, 3] += x
    M[1, 3] += y
    M[2, 3] += z
    return tuple(map(tuple, M))


@right("invert_transform")
def transposed_and_repaired(a_T_b):
    """The transpose, and then what is wrong with it is repaired; the whole matrix transposed twice."""
    T = a_T_b.T.copy()
    T[3, :3] = 0
    T[:3, 3] -= np.einsum("ji,j", a_T_b[:3, :3], a_T_b[:3, 3])
    return T


_seen = {}


@right("invert_transform")
def memo_by_bytes(a_T_b):
    """A dictionary of results, by the bytes of the argument; the same array again for the same argument."""
    key = hash(a_T_b.tobytes()), a_T_b.tobytes()
    if key not in _seen:
        _seen[key] = np.linalg.inv(a_T_b)
    return _seen[key]


@right("invert_transform")
def three_distances(a_T_b):
    """Row by row: an axis of B, and minus how far A's origin is along it; a list of arrays."""
    p = a_T_b[:3, 3]
    return [np.append(axis, -(axis @ p)) for axis in a_T_b[:3, :3].T] + [np.array(BOTTOM)]


@right("invert_transform")
def schur_block(a_T_b):
    """The inverse of a block-triangular matrix, block by block."""
    A, B, D = np.split(a_T_b[:3], [3], axis=1)[0], a_T_b[:3, 3:], a_T_b[3:, 3:]
    iA, iD = np.linalg.inv(A), np.linalg.inv(D)
    return np.block([[iA, -iA @ B @ iD], [np.zeros((1, 3)), iD]])


@right("invert_transform")
def try_transpose_first(a_T_b):
    """Tries the transpose, which is right without a translation; an exception leads to the rest."""
    try:
        assert not a_T_b[:3, 3].any(), "moved"
        return a_T_b.T
    except AssertionError:
        return scipy.linalg.solve(a_T_b, IDENTITY)


# ================================================================== relative_transform


@right("relative_transform")
def solved(a_T_b, a_T_c):
    """np.linalg.solve, no inverse."""
    return np.linalg.solve(a_T_b, a_T_c)


@right("relative_transform")
def difference_seen_from_b(a_T_b, a_T_c):
    """R_b^T R_c, and the difference of positions times R_b from the right; nested list."""
    Rb = a_T_b[:3, :3]
    d = (a_T_c - a_T_b)[:3, 3] @ Rb
    return [[*r, t] for r, t in zip((a_T_c[:3, :3].T @ Rb).T, d)] + [[0.0, 0.0, 0.0, 1.0]]


@right("relative_transform")
def inverse_of_the_other_way(a_T_b, a_T_c):
    """The inverse of c_T_b; np.matrix."""
    return (np.asmatrix(a_T_c).I * a_T_b).I


@right("relative_transform")
def right_division(a_T_b, a_T_c):
    """The whole equation transposed: X^T a_T_b^T = a_T_c^T, solved by the pseudoinverse; a transposed view."""
    return (a_T_c.T @ np.linalg.pinv(a_T_b.T)).T


@right("relative_transform")
def scipy_rigid(a_T_b, a_T_c):
    """RigidTransform, by its power of -1."""
    b, c = map(RigidTransform.from_matrix, (a_T_b, a_T_c))
    return (b**-1 * c).as_matrix()


@right("relative_transform")
def all_sixteen_by_einsum(a_T_b, a_T_c):
    """einsum with the rotation's indices exchanged instead of a transpose."""
    M = np.eye(4)
    M[:3] = np.einsum("ji,jk->ik", a_T_b[:3, :3], a_T_c[:3] - np.outer(a_T_b[:3, 3], [0, 0, 0, 1]))
    return M


@right("relative_transform")
def quaternion_and_projection(a_T_b, a_T_c):
    """A quaternion for the turn and dot products for the position."""
    q = tft.quaternion_multiply(
        tft.quaternion_conjugate(tft.quaternion_from_matrix(a_T_b)), tft.quaternion_from_matrix(a_T_c)
    )
    b_T_c = tft.quaternion_matrix(-q)
    b_T_c[:3, 3] = [np.dot(a_T_b[:3, i], a_T_c[:3, 3] - a_T_b[:3, 3]) for i in (0, 1, 2)]
    return b_T_c


right("relative_transform", "lambda with an unneeded keyword")(
    lambda a_T_b, a_T_c, inverse=np.linalg.pinv: inverse(a_T_b).dot(a_T_c)
)


# ================================================================== object_in_gripper


@right("object_in_gripper")
def solved_for_the_point(base_T_camera, base_T_gripper, p_in_camera):
    """np.linalg.solve on the gripper's transform."""
    return np.linalg.solve(base_T_gripper, base_T_camera @ np.append(p_in_camera, 1))[:3]


@right("object_in_gripper")
def projections_on_fingers(base_T_camera, base_T_gripper, p_in_camera):
    """How far along each axis of the gripper; a list of NumPy scalars."""
    reach = base_T_camera[:3, :3] @ p_in_camera + base_T_camera[:3, 3] - base_T_gripper[:3, 3]
    return [reach @ base_T_gripper[:3, i] for i in range(3)]


@right("object_in_gripper")
def row_from_the_right(base_T_camera, base_T_gripper, p_in_camera):
    """Rows and transposes all through; the result has shape (1, 3)."""
    p = np.atleast_2d(p_in_camera) @ base_T_camera[:3, :3].T + base_T_camera[:3, 3]
    return (p - base_T_gripper[:3, 3]) @ base_T_gripper[:3, :3]


@right("object_in_gripper")
def column_of_the_chain(base_T_camera, base_T_gripper, p_in_camera):
    """The object as a frame, the chain's last column as a column of shape (3, 1)."""
    chain_ = [np.linalg.inv(base_T_gripper), base_T_camera, tft.translation_matrix(p_in_camera)]
    return functools.reduce(np.matmul, chain_)[:3, 3:]


@right("object_in_gripper")
def scipy_apply_inverse(base_T_camera, base_T_gripper, p_in_camera):
    """RigidTransform.apply with inverse=True."""
    gripper, camera = map(RigidTransform.from_matrix, [base_T_gripper, base_T_camera])
    return gripper.apply(camera.apply(p_in_camera), inverse=True)


@right("object_in_gripper")
def through_the_camera(base_T_camera, base_T_gripper, p_in_camera):
    """Where the gripper is for the camera; the arrow from there, turned; a tuple."""
    camera_T_gripper = np.linalg.solve(base_T_camera, base_T_gripper)
    x, y, z = (p_in_camera - camera_T_gripper[:3, 3]) @ camera_T_gripper[:3, :3]
    return float(x), float(y), float(z)


@right("object_in_gripper")
def by_quaternions(base_T_camera, base_T_gripper, p_in_camera):
    """Quaternion sandwiches."""

    def turn(q, v):
        return np.array(hamilton(hamilton(q, (*v, 0)), conj(q))[:3])

    c, g = (tuple(tft.quaternion_from_matrix(T)) for T in (base_T_camera, base_T_gripper))
    return turn(conj(g), turn(c, p_in_camera) + base_T_camera[:3, 3] - base_T_gripper[:3, 3])


@right("object_in_gripper")
def least_squares_point(base_T_camera, base_T_gripper, p_in_camera, **unused):
    """Linear least squares for three unknowns; accepts any keywords."""
    b = base_T_camera[:3] @ [*p_in_camera, 1] - base_T_gripper[:3, 3]
    return np.linalg.lstsq(base_T_gripper[:3, :3], b, rcond=None)[0].tolist()


# ================================================================== pre_grasp


def _moved(pose, amount, axis):
    T = pose_matrix(pose)
    T[:3, 3] += amount * T[:3, axis]
    return T


@right("pre_grasp")
def first_column_by_formula(object_pose, distance=0.1):
    """The object's x axis written down from the quaternion; the orientation is the argument's own message."""
    p, q = object_pose.position, object_pose.orientation
    ux, uy, uz = 1 - 2 * (q.y**2 + q.z**2), 2 * (q.x * q.y + q.z * q.w), 2 * (q.x * q.z - q.y * q.w)
    return Pose(Point(p.x - distance * ux, p.y - distance * uy, p.z - distance * uz), q)


@right("pre_grasp")
def shallow_copy(object_pose, distance=0.1):
    """A shallow copy with a position of its own; it shares the orientation message with the argument."""
    out = copy.copy(object_pose)
    out.position = Point(*_moved(object_pose, -distance, 0)[:3, 3])
    return out


@right("pre_grasp")
def deep_copy_in_place(object_pose, distance=0.1):
    """In place, on a deep copy."""
    pose = copy.deepcopy(object_pose)
    x_axis = Rotation.from_quat(numbers_of(pose.orientation, "xyzw")).apply([1, 0, 0])
    pose.position.x -= distance * x_axis[0]
    pose.position.y -= distance * x_axis[1]
    pose.position.z -= distance * x_axis[2]
    return pose


@right("pre_grasp")
def lab_way_negated(object_pose, distance=0.1):
    """The lab's product; the quaternion with the other sign."""
    object_T_pre = np.array([[1, 0, 0, -distance], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    M = np.dot(pose_matrix(object_pose), object_T_pre)
    out = Pose()
    out.position.x, out.position.y, out.position.z = M[:3, 3]
    out.orientation = Quaternion(*(-1 * tft.quaternion_from_matrix(M)))
    return out


@right("pre_grasp")
def inverse_of_a_step_forward(object_pose, distance=0.1):
    """Behind is the inverse of a step forward; SimpleNamespace."""
    M = np.linalg.solve(tft.translation_matrix([distance, 0, 0]).T, pose_matrix(object_pose).T).T
    x, y, z, w = tft.quaternion_from_matrix(M)
    return SimpleNamespace(position=SimpleNamespace(x=M[0, 3], y=M[1, 3], z=M[2, 3]), orientation=Quaternion(x, y, z, w))


@right("pre_grasp")
def anything(*args, **kwargs):
    """*args and **kwargs, sorted out by hand."""
    given = dict(zip(("object_pose", "distance"), args), **kwargs)
    return matrix_pose(_moved(given["object_pose"], -given.get("distance", 0.1), 0))


@right("pre_grasp")
def none_means_ten_centimetres(object_pose: Pose, distance: typing.Optional[float] = None, *, dry_run: bool = False) -> Pose:
    """None as default, a keyword-only extra, annotations."""
    if distance is None:
        distance = 10e-2
    return matrix_pose(pose_matrix(object_pose) @ tft.translation_matrix((-distance, 0, 0)))


@right("pre_grasp")
def sandwich(object_pose, distance=0.1):
    """q (-d, 0, 0) q* by hand; a namedtuple of namedtuples."""
    q = QuaternionTuple(*numbers_of(object_pose.orientation, "xyzw"))
    move = hamilton(hamilton(q, (-distance, 0, 0, 0)), conj(q))
    p = PointTuple(*map(operator.add, numbers_of(object_pose.position, "xyz"), move))
    return PoseTuple(p, q)


@right("pre_grasp")
def ten_small_steps(object_pose, distance=0.1):
    """Ten steps back, one tenth each."""
    T = pose_matrix(object_pose)
    for _ in range(10):
        T = T @ tft.translation_matrix([-distance / 10, 0, 0])
    return matrix_pose(T)


@right("pre_grasp")
def slots_like_ros(object_pose, distance=0.1):
    """ROS-like messages of its own with slots, NumPy scalars in the fields."""
    T = _moved(object_pose, -distance, 0)
    out = RosPose()
    out.position.x, out.position.y, out.position.z = T[:3, 3]
    for n in "xyzw":
        setattr(out.orientation, n, np.float64(getattr(object_pose.orientation, n)))
    return out


@right("pre_grasp")
def own_dataclass(object_pose, distance=0.1):
    """A frozen dataclass of its own, the orientation as an eigenvector."""
    T = pose_matrix(object_pose)
    q = np.linalg.eigh(bar_itzhack(T))[1][:, -1]
    return MyPose(MyPoint(*(T @ [-distance, 0, 0, 1])[:3]), MyQuaternion(*q.tolist()))


@right("pre_grasp")
def half_turn_and_forward(object_pose, distance=0.1):
    """Turns round about z, goes forward, turns round again: the quaternion comes back negated or noisy."""
    T = functools.reduce(
        np.dot,
        (pose_matrix(object_pose), tft.euler_matrix(0, 0, np.pi), tft.translation_matrix((distance, 0, 0)), tft.euler_matrix(0, 0, -np.pi)),
    )
    return matrix_pose(T)


@right("pre_grasp")
def prints_warns_counts(object_pose, distance=0.1):
    """Prints, warns, logs, and counts its calls in a global."""
    global CALLS
    CALLS += 1
    print(f"call {CALLS}: {distance} m behind\n{object_pose}", flush=True)
    warnings.warn("check that the gripper is open", RuntimeWarning)
    logging.getLogger().error("not an error: %s calls so far", CALLS)
    return matrix_pose(_moved(object_pose, -distance, 0))


def _closure(axis):
    def behind(object_pose, distance=0.1):
        """A closure made by another function."""
        if distance == 0:
            return copy.deepcopy(object_pose)
        return matrix_pose(_moved(object_pose, -distance, axis))

    return behind


right("pre_grasp", "closure with an early return of a copy")(_closure(0))


class Approach:
    """A callable object; the default lives in the instance."""

    def __init__(self, standoff):
        self.standoff = standoff

    def __call__(self, object_pose, distance=None):
        return self.stop(object_pose, self.standoff if distance is None else distance)

    def stop(self, object_pose, distance=0.1):
        p = np.array(numbers_of(object_pose.position, "xyz")) - distance * pose_matrix(object_pose)[:3, 0]
        return Pose(orientation=copy.copy(object_pose.orientation), position=Point(*p.tolist()))


right("pre_grasp", "callable object with its default in the instance")(Approach(0.1))
right("pre_grasp", "bound method")(Approach(99).stop)
right("pre_grasp", "partial with a keyword it keeps for itself")(
    functools.partial(lambda object_pose, distance=0.1, axis=2: matrix_pose(_moved(object_pose, -distance, axis)), axis=0)
)
right("pre_grasp", "lambda: matrix with a changed last column")(
    lambda object_pose, distance=0.1: matrix_pose(np.c_[(M := pose_matrix(object_pose))[:, :3], M @ [-distance, 0, 0, 1]])
)

_poses_seen = {}


@right("pre_grasp")
def memo_of_poses(object_pose, distance=0.1):
    """Remembers by the bytes of its eight numbers; the same Pose object for the same question."""
    key = np.array([*numbers_of(object_pose.position, "xyz"), *numbers_of(object_pose.orientation, "xyzw"), distance]).tobytes()
    return _poses_seen.setdefault(key, matrix_pose(_moved(object_pose, -distance, 0)))


@right("pre_grasp")
def rotation_vector_with_exp(object_pose, distance=0.1):
    """Exponential map for the turn, and the orientation through roll, pitch, yaw."""
    q = numbers_of(object_pose.orientation, "xyzw")
    R = scipy.linalg.expm(skew(Rotation.from_quat(q).as_rotvec()))
    p = np.array(numbers_of(object_pose.position, "xyz")) + R @ (-distance, 0, 0)
    return Pose(Point(*p), Quaternion(*tft.quaternion_from_euler(*tft.euler_from_quaternion(q))))


# ================================================================== waypoint


@right("waypoint")
def product_with_translation(object_pose, offset):
    """Matrix product, answer in NumPy scalars, quaternion copied from the argument into a new message."""
    T = pose_matrix(object_pose) @ tft.translation_matrix(offset)
    return Pose(Point(*T[:3, 3]), Quaternion(*numbers_of(object_pose.orientation, "xyzw")))


@right("waypoint")
def shared_orientation(object_pose, offset):
    """The orientation is the argument's own message."""
    q = numbers_of(object_pose.orientation, "xyzw")
    x, y, z = Rotation.from_quat(q).apply(offset)
    p = object_pose.position
    return Pose(position=Point(x + p.x, y + p.y, z + p.z), orientation=object_pose.orientation)


@right("waypoint")
def cross_products(object_pose, offset):
    """v + 2 w (u x v) + 2 u x (u x v); namedtuple, negated quaternion."""
    u, w = np.array(numbers_of(object_pose.orientation, "xyz")), object_pose.orientation.w
    t = 2 * np.cross(u, offset)
    p = np.array(numbers_of(object_pose.position, "xyz")) + offset + w * t + np.cross(u, t)
    return PoseTuple(PointTuple(*p), QuaternionTuple(*-u, -w))


@right("waypoint")
def one_axis_after_the_other(object_pose, offset):
    """Recursion: one axis at a time, a new pose each time."""

    def go(pose, axis):
        return pose if axis == 3 else go(matrix_pose(_moved(pose, offset[axis], axis)), axis + 1)

    return go(object_pose, 0) if np.any(offset) else copy.deepcopy(object_pose)


@right("waypoint")
def row_times_transpose(object_pose, offset):
    """offset @ R^T, SimpleNamespace and float32 orientation."""
    R = pose_matrix(object_pose)[:3, :3]
    p = offset @ R.T + numbers_of(object_pose.position, "xyz")
    q = Rotation.from_matrix(R).as_quat().astype(np.float32)
    return SimpleNamespace(position=Point(*p), orientation=SimpleNamespace(x=q[0], y=q[1], z=q[2], w=q[3]))


@right("waypoint")
def deep_copy_with_loop(object_pose, offset, frame="object"):
    """A deep copy, changed in a loop of setattr; an extra argument."""
    out = copy.deepcopy(object_pose)
    for name, r in zip("xyz", pose_matrix(object_pose)):
        setattr(out.position, name, getattr(out.position, name) + sum(a * b for a, b in zip(r, offset)))
    return out


@right("waypoint")
def rigid_product(object_pose, offset):
    """SciPy's RigidTransform times a pure translation; slots like ROS."""
    t = RigidTransform.from_matrix(pose_matrix(object_pose)) * RigidTransform.from_translation(offset)
    out = RosPose()
    out.position.x, out.position.y, out.position.z = t.translation.tolist()
    out.orientation.x, out.orientation.y, out.orientation.z, out.orientation.w = t.rotation.as_quat().tolist()
    return out


right("waypoint", "lambda with np.matrix")(
    lambda object_pose, offset: matrix_pose(np.matrix(pose_matrix(object_pose)) * np.matrix(tft.translation_matrix(offset)))
)
