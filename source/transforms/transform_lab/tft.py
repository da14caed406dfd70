"""Transforms and quaternions, with the names and conventions of ROS 1's ``tf.transformations``.

::

    from transform_lab import tft              # here
    import tf.transformations as tft           # on a robot; nothing else changes

Conventions
-----------
- **Quaternions are x, y, z, w**: the scalar comes last. q and -q are the same orientation, and a function may return
  either. Lengths other than 1 are normalised where a quaternion is turned into a rotation.
- **Rotations are active, frames are right-handed.** The matrix a_R_b has, in its columns, the axes of frame B written
  in frame A; a_T_b is the 4x4 homogeneous transform made of a_R_b and of B's origin in A (upper right). Points are
  columns: p_in_a = a_T_b @ p_in_b. Products apply from the right: a_T_c = a_T_b @ b_T_c.
- **Angles are in radians**, lengths in whatever unit you use (metres in ROS).
- **Matrices are 4x4**, as in ROS, also where only a rotation is meant: put a 3x3 rotation R into one with
  ``T = np.eye(4); T[:3, :3] = R``.
- **Euler axes** are named as in ROS: 's' (static: fixed axes) or 'r' (rotating: the moving frame's own axes), then the
  three axes in the order in which the angles are given and applied. 'sxyz', the default, is roll, pitch, yaw:
  R = Rz(yaw) @ Ry(pitch) @ Rx(roll). 'rzyx' with yaw, pitch, roll is the same rotation.

Arguments may be lists, tuples, arrays of any number type, or ``np.matrix``; they are never changed. Results are new
float64 arrays. Unlike ROS, whose results for wrong input are silently wrong, a matrix that is not a rigid transform
raises ValueError and the message says which property fails.

Of q and -q, and of the angles that describe one and the same rotation, the one that ROS gives is given here, too. What ROS
has beside the functions below (cameras' projections, shears, crystals, an arcball) is not here.

Source: names, signatures and conventions follow C. Gohlke's ``transformations.py`` as shipped with ROS 1; rotation
arithmetic is SciPy's ``Rotation``, or the same without loading it (arithmetic.py).
"""

import math
import warnings

import numpy as np

from .arithmetic import Rotation, matrix_of, matrix_of_turns, quaternion_of, quaternion_of_turns, turn, vector_of
from .validation import numbers, rigid_transform, shape_text

__all__ = [
    "compose_matrix", "concatenate_matrices", "decompose_matrix", "euler_from_matrix", "euler_from_quaternion", "euler_matrix",
    "identity_matrix", "inverse_matrix", "is_same_transform", "quaternion_about_axis", "quaternion_conjugate",
    "quaternion_from_euler", "quaternion_from_matrix", "quaternion_inverse", "quaternion_matrix", "quaternion_multiply",
    "quaternion_slerp", "random_quaternion", "random_rotation_matrix", "random_vector", "reflection_matrix",
    "rotation_from_matrix", "rotation_matrix", "scale_matrix", "superimposition_matrix", "translation_from_matrix",
    "translation_matrix", "unit_vector", "vector_norm",
]  # fmt: skip

_EPS = np.finfo(float).eps * 4.0  # below this squared length, ROS takes a quaternion for zero


def _matrix(R):
    """Return a 3x3 rotation as a 4x4 matrix."""
    T = np.eye(4)
    T[:3, :3] = R
    return T


def __getattr__(name):
    from difflib import get_close_matches

    alike = get_close_matches(name, __all__)
    there = f"Did you mean {' or '.join(alike)}?" if alike else f"There is {', '.join(__all__)}."
    raise AttributeError(f"tft.{name} is not here. {there}")


def _vector(value, what):
    """Return the first three of 3 or 4 (homogeneous) numbers."""
    return numbers(value, what, lengths=(3, 4))[:3]


def _number(value, what):
    """Return a single number, such as an angle, as a float."""
    number = numbers(value, what)
    if number.size != 1:
        raise TypeError(f"{what} must be a single number; got {shape_text(number)}")
    return number.item()


def _keeping(linear, point, what):
    """Return the 4x4 matrix with this 3x3 part that leaves `point` (by default the origin) where it is."""
    T = np.eye(4)
    T[:3, :3] = linear
    if point is not None:
        p = _vector(point, what)
        T[:3, 3] = p - linear @ p  # R p + t = p
    return T


# Matrices


def identity_matrix():
    """Return the 4x4 identity: no rotation, no translation."""
    return np.eye(4)


def translation_matrix(direction):
    """Return the 4x4 transform that translates by `direction` (3 numbers)."""
    T = np.eye(4)
    T[:3, 3] = _vector(direction, "translation_matrix: the direction")
    return T


def translation_from_matrix(matrix):
    """Return the translation of a 4x4 transform, 3 numbers: the last column without its 1."""
    return rigid_transform(matrix, "translation_from_matrix: the matrix")[:3, 3]


def rotation_matrix(angle, direction, point=None):
    """Return the 4x4 transform that rotates by `angle` (radians) about the axis `direction`.

    The axis goes through `point`, by default through the origin. `direction` may have any length but zero.
    """
    axis = unit_vector(_vector(direction, "rotation_matrix: the direction"))
    R = turn(_number(angle, "rotation_matrix: the angle") * axis)
    return _keeping(R, point, "rotation_matrix: the point")


def rotation_from_matrix(matrix):
    """Return the angle (radians, 0 to pi), the axis (3 numbers) and a point on it (4 numbers) of a 4x4 rotation.

    The point is the one nearest to the origin. The identity gives 0 and the z axis. Raises ValueError if the transform
    also moves along its axis, because such a motion has no point that stays where it is.
    """
    T = rigid_transform(matrix, "rotation_from_matrix: the matrix")
    R, t = T[:3, :3], T[:3, 3]
    rotation_vector = vector_of(R)
    angle = np.linalg.norm(rotation_vector)
    axis = rotation_vector / angle if angle > 0 else np.array([0.0, 0.0, 1.0])
    point = np.linalg.lstsq(np.eye(3) - R, t, rcond=1e-8)[0]
    along = np.abs(point - R @ point - t).max()
    if along > 1e-6:
        raise ValueError(
            f"rotation_from_matrix: the transform also moves by {along:.3g} along its axis; a rotation about a point"
            " does not"
        )
    return angle, axis, np.append(point, 1.0)


def inverse_matrix(matrix):
    """Return the inverse of a square matrix: for a_T_b, b_T_a."""
    return np.linalg.inv(numbers(matrix, "inverse_matrix: the matrix"))


def concatenate_matrices(*matrices):
    """Return the product of 4x4 matrices in the order given; the identity if there are none."""
    product = np.eye(4)
    for matrix in matrices:
        product = product @ numbers(matrix, "concatenate_matrices: each argument")
    return product


def is_same_transform(matrix0, matrix1):
    """Return whether two 4x4 matrices do the same to points: to NumPy's tolerance, whatever common factor they have."""
    one, other = (_homogeneous(matrix, "is_same_transform: each argument") for matrix in (matrix0, matrix1))
    return bool(np.allclose(one, other))


def _homogeneous(matrix, what):
    """Return a 4x4 matrix divided by its last entry, which may not be 0."""
    M = numbers(matrix, what)
    if M.shape != (4, 4):
        raise ValueError(f"{what} must be a 4x4 matrix; got {shape_text(M)}")
    if abs(M[3, 3]) < _EPS:
        raise ValueError(f"{what} has a 0 at its lower right, so that it has no position")
    return M / M[3, 3]


# Matrices that are no rigid transforms


def reflection_matrix(point, normal):
    """Return the 4x4 matrix that mirrors at the plane through `point` with this `normal` (any length but zero)."""
    n = unit_vector(_vector(normal, "reflection_matrix: the normal"))
    return _keeping(np.eye(3) - 2.0 * np.outer(n, n), point, "reflection_matrix: the point")


def scale_matrix(factor, origin=None, direction=None):
    """Return the 4x4 matrix that scales by `factor` from `origin`, by default the frame's; with `direction` along it alone."""
    change = _number(factor, "scale_matrix: the factor") - 1.0
    along = np.eye(3)
    if direction is not None:
        d = unit_vector(_vector(direction, "scale_matrix: the direction"))
        along = np.outer(d, d)
    return _keeping(np.eye(3) + change * along, origin, "scale_matrix: the origin")


def compose_matrix(scale=None, shear=None, angles=None, translate=None, perspective=None):
    """Return the 4x4 matrix that scales, shears, rotates, translates and projects, in this order; what is None is left out.

    `scale`: 3 factors along x, y, z; `shear`: 3 factors of x by y, x by z, y by z; `angles`: roll, pitch, yaw in radians (axes
    'sxyz'); `translate`: 3 numbers; `perspective`: the 4 numbers of the bottom row. See `decompose_matrix`.
    """
    M = np.eye(4)
    if perspective is not None:
        M[3] = numbers(perspective, "compose_matrix: perspective", lengths=(4,))
    if translate is not None:
        M = M @ translation_matrix(translate)
    if angles is not None:
        M = M @ euler_matrix(*numbers(angles, "compose_matrix: angles", lengths=(3,)))
    if shear is not None:
        sheared = np.eye(4)
        sheared[[0, 0, 1], [1, 2, 2]] = numbers(shear, "compose_matrix: shear", lengths=(3,))
        M = M @ sheared
    if scale is not None:
        M = M @ np.diag(np.append(numbers(scale, "compose_matrix: scale", lengths=(3,)), 1.0))
    return _homogeneous(M, "compose_matrix: the product")


def decompose_matrix(matrix):
    """Return scale, shear, angles, translate and perspective of a 4x4 matrix, a tuple: what `compose_matrix` takes.

    Of a rigid transform, `angles` are its roll, pitch and yaw, and `translate` is its translation. A mirror image gets three
    negative scale factors. Raises ValueError for a matrix that cannot be inverted.
    """
    M = _homogeneous(matrix, "decompose_matrix: the matrix")
    affine = np.vstack([M[:3], [0.0, 0.0, 0.0, 1.0]])
    if not np.linalg.det(affine):
        raise ValueError("decompose_matrix: the matrix cannot be inverted: its determinant is 0")
    R, U = np.linalg.qr(M[:3, :3])  # a rotation, then all else: in a triangle
    signs = np.sign(np.diag(U)) * np.sign(np.linalg.det(M[:3, :3]))
    R, U = R * signs, signs[:, None] * U
    scale = np.diag(U).copy()
    return (
        scale,
        list((U / scale)[[0, 0, 1], [1, 2, 2]]),
        list(_euler(R, "sxyz")),
        M[:3, 3].copy(),
        M[3] @ np.linalg.inv(affine),
    )


def superimposition_matrix(v0, v1, scaling=False, usesvd=True):
    """Return the 4x4 transform that brings the points `v0` as near as can be to the points `v1`: the least sum of squares.

    Both are arrays of shape (3, n), or (4, n) with homogeneous coordinates: a point in each column, at least three of them. With
    `scaling`, all may be made larger or smaller, too, by the root of the ratio of both sets' squared distances from their middle.
    `usesvd` has no effect. Source: W. Kabsch, "A solution for the best rotation to relate two sets of vectors", Acta
    Crystallographica A32, 1976.
    """
    v0, v1 = (numbers(v, "superimposition_matrix: each set of points") for v in (v0, v1))
    if v0.shape != v1.shape or v0.ndim != 2 or v0.shape[0] not in (3, 4) or v0.shape[1] < 3:
        raise ValueError(
            "superimposition_matrix: both sets must have the shape (3, n) or (4, n) with three points or more; they have"
            f" {v0.shape} and {v1.shape}"
        )
    middles = [v[:3].mean(axis=1) for v in (v0, v1)]
    first, second = (v[:3].T - middle for v, middle in zip((v0, v1), middles))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of points in a line, which do not say how far they are turned about it
        linear = Rotation.align_vectors(second, first)[0].as_matrix()
    if scaling:
        linear *= math.sqrt(np.sum(second**2) / np.sum(first**2))
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = linear, middles[1] - linear @ middles[0]
    return T


# Euler angles


def _axes(axes):
    """Return the frame, 's' or 'r', and the three axes, such as 'xyz', of ROS's Euler axes: a name, or its tuple of four."""
    if isinstance(axes, tuple) and len(axes) == 4 and axes[0] in (0, 1, 2) and set(axes[1:]) <= {0, 1}:
        first, parity, repetition, rotating = axes
        order = [first, (first + 1 + parity) % 3, first if repetition else (first + 2 - parity) % 3]
        return "sr"[rotating], "".join("xyz"[axis] for axis in (order[::-1] if rotating else order))
    name = axes.lower() if isinstance(axes, str) else ""
    frame, sequence = name[:1], name[1:]
    legal = len(sequence) == 3 and set(sequence) <= set("xyz") and sequence[1] not in (sequence[0], sequence[2])
    if frame not in ("s", "r") or not legal:
        raise ValueError(
            f"no such Euler axes: {axes!r}. Write 's' (fixed axes) or 'r' (rotating axes) and three of x, y, z, the"
            " same never twice running, such as 'sxyz' or 'rzyx'"
        )
    return frame, sequence


def _three_turns(ai, aj, ak, axes, what):
    """Return the angles, their axes, and whether these are fixed."""
    frame, sequence = _axes(axes)
    angles = [_number(angle, f"{what}: {name}") for angle, name in ((ai, "ai"), (aj, "aj"), (ak, "ak"))]
    return angles, sequence, frame == "s"


def _euler(R, axes):
    """Return the three angles about `axes` of a 3x3 rotation, the ones that ROS chooses.

    Source: K. Shoemake, "Euler angle conversion", Graphics Gems IV, 1994.
    """
    frame, sequence = _axes(axes)
    order = ["xyz".index(axis) for axis in (sequence if frame == "s" else sequence[::-1])]
    i, j = order[:2]
    k = 3 - i - j
    if i == order[2]:
        across = math.hypot(R[i, j], R[i, k])
        first, second, third = (R[i, j], R[i, k]), (across, R[i, i]), (R[j, i], -R[k, i])
    else:
        across = math.hypot(R[i, i], R[j, i])
        first, second, third = (R[k, j], R[k, k]), (-R[k, i], across), (R[j, i], R[i, i])
    if across <= _EPS:  # gimbal lock: the first and the third turn about one axis
        first, third = (-R[j, k], R[j, j]), (0.0, 1.0)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    angles = tuple(sign * math.atan2(*pair) for pair in (first, second, third))
    return angles if frame == "s" else angles[::-1]


def euler_matrix(ai, aj, ak, axes="sxyz"):
    """Return the 4x4 rotation by the angles `ai`, `aj`, `ak` (radians) about `axes`, in this order."""
    return _matrix(matrix_of_turns(*_three_turns(ai, aj, ak, axes, "euler_matrix")))


def euler_from_matrix(matrix, axes="sxyz"):
    """Return the three Euler angles (radians, a tuple) about `axes` of the rotation in a 4x4 transform, or of a 3x3 one.

    At gimbal lock many triples are right; the one returned has 0 for the third angle, or with rotating axes for the first.
    """
    M = numbers(matrix, "euler_from_matrix: the matrix")
    if M.shape == (3, 3):  # as ROS takes it
        M = np.block([[M, np.zeros((3, 1))], [np.zeros((1, 3)), 1.0]])
    return _euler(rigid_transform(M, "euler_from_matrix: the matrix")[:3, :3], axes)


def euler_from_quaternion(quaternion, axes="sxyz"):
    """Return the three Euler angles (radians, a tuple) about `axes` of the quaternion x, y, z, w."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def quaternion_from_euler(ai, aj, ak, axes="sxyz"):
    """Return the quaternion x, y, z, w of the rotation by `ai`, `aj`, `ak` (radians) about `axes`, in this order."""
    return quaternion_of_turns(*_three_turns(ai, aj, ak, axes, "quaternion_from_euler"))


# Quaternions


def quaternion_matrix(quaternion):
    """Return the 4x4 rotation of a quaternion, a plain list of the four numbers x, y, z, w.

    A quaternion of another length than 1 is normalised first. As in ROS, 0, 0, 0, 0 gives the identity, though it is
    no orientation: a fresh ``Quaternion()`` has these values, so look whether you forgot to set it.

    Raises TypeError for a message (write ``[q.x, q.y, q.z, q.w]``), ValueError for any other number of numbers.
    """
    q = numbers(quaternion, "quaternion_matrix: the quaternion", lengths=(4,))
    if q @ q < _EPS:
        return np.eye(4)
    return _matrix(matrix_of(q))


def quaternion_from_matrix(matrix):
    """Return the quaternion x, y, z, w of the rotation in a 4x4 transform, of length 1; translation is ignored.

    Raises ValueError unless the matrix is 4x4 and a rigid transform (to 1e-3), naming the property that fails.
    """
    R = rigid_transform(matrix, "quaternion_from_matrix: the matrix")[:3, :3]
    q = quaternion_of(R)
    positive = 3 if np.trace(R) > 0 else int(np.argmax(np.diag(R)))  # in ROS; q and -q are the same orientation
    return q if q[positive] >= 0 else -q


def quaternion_about_axis(angle, axis):
    """Return the quaternion x, y, z, w of the rotation by `angle` (radians) about `axis` (any length but zero)."""
    axis = unit_vector(_vector(axis, "quaternion_about_axis: the axis"))
    angle = _number(angle, "quaternion_about_axis: the angle")
    return np.append(math.sin(angle / 2) * axis, math.cos(angle / 2))


def quaternion_multiply(quaternion1, quaternion0):
    """Return the product quaternion1 * quaternion0 (x, y, z, w): the rotation `quaternion0`, then `quaternion1`.

    This is Hamilton's product, in the order of the matrices: R1 @ R0. Lengths are multiplied, not normalised.
    """
    q1 = numbers(quaternion1, "quaternion_multiply: the first quaternion", lengths=(4,))
    q0 = numbers(quaternion0, "quaternion_multiply: the second quaternion", lengths=(4,))
    vector = q1[3] * q0[:3] + q0[3] * q1[:3] + np.cross(q1[:3], q0[:3])
    return np.append(vector, q1[3] * q0[3] - q1[:3] @ q0[:3])


def quaternion_conjugate(quaternion):
    """Return -x, -y, -z, w: for a quaternion of length 1, the opposite rotation."""
    return numbers(quaternion, "quaternion_conjugate: the quaternion", lengths=(4,)) * [-1, -1, -1, 1]


def quaternion_inverse(quaternion):
    """Return the quaternion whose product with `quaternion` is 0, 0, 0, 1. Raises ValueError for 0, 0, 0, 0."""
    q = numbers(quaternion, "quaternion_inverse: the quaternion", lengths=(4,))
    if q @ q == 0:
        raise ValueError("quaternion_inverse: 0, 0, 0, 0 is no orientation and has no inverse")
    return quaternion_conjugate(q) / (q @ q)


def quaternion_slerp(quat0, quat1, fraction, spin=0, shortestpath=True):
    """Return the quaternion at `fraction` (0 to 1) of the way from `quat0` to `quat1`, turning at constant speed.

    `spin` adds that many full turns on the way; give an even number, because for an odd one the result does not have
    length 1 (as in ROS). With `shortestpath`, the shorter of the two ways is taken; the result then ends
    at `quat1` or at its negative, which is the same orientation. Source: K. Shoemake, "Animating rotation with
    quaternion curves", SIGGRAPH 1985.
    """
    q0 = unit_vector(numbers(quat0, "quaternion_slerp: the first quaternion", lengths=(4,)))
    q1 = unit_vector(numbers(quat1, "quaternion_slerp: the second quaternion", lengths=(4,)))
    if fraction == 0:
        return q0
    if fraction == 1:
        return q1
    cosine = q0 @ q1
    if abs(abs(cosine) - 1) < _EPS:
        return q0
    if shortestpath and cosine < 0:
        cosine, q1 = -cosine, -q1
    angle = math.acos(cosine) + spin * math.pi
    return (math.sin((1 - fraction) * angle) * q0 + math.sin(fraction * angle) * q1) / math.sin(angle)


def random_quaternion(rand=None):
    """Return a random quaternion of length 1, every orientation equally likely.

    `rand`: three numbers from 0 to 1 that determine it; by default NumPy's global generator is asked. Source:
    K. Shoemake, "Uniform random rotations", Graphics Gems III, 1992.
    """
    u = np.random.rand(3) if rand is None else numbers(rand, "random_quaternion: rand", lengths=(3,))
    r1, r2 = math.sqrt(1 - u[0]), math.sqrt(u[0])
    a1, a2 = 2 * math.pi * u[1], 2 * math.pi * u[2]
    return np.array([math.sin(a1) * r1, math.cos(a1) * r1, math.sin(a2) * r2, math.cos(a2) * r2])


def random_rotation_matrix(rand=None):
    """Return a random 4x4 rotation, every orientation equally likely; `rand` as in `random_quaternion`."""
    return quaternion_matrix(random_quaternion(rand))


# Vectors


def random_vector(size):
    """Return `size` random numbers from 0 to 1, an array; `size` may be a shape."""
    return np.random.random(size)


def vector_norm(data, axis=None, out=None):
    """Return the length of a vector, or the lengths of an array's vectors along `axis`; with `out`, write them there instead."""
    lengths = np.linalg.norm(numbers(data, "vector_norm: the data"), axis=axis)
    if out is None:
        return lengths
    out[...] = lengths


def unit_vector(data, axis=None, out=None):
    """Return a vector at length 1, or an array with its vectors along `axis`; with `out`, write them there instead.

    Raises ValueError for a vector of zeros, which has no direction.
    """
    array = numbers(data, "unit_vector: the data")
    lengths = np.linalg.norm(array, axis=axis, keepdims=axis is not None)
    if array.size and np.any(lengths == 0):
        raise ValueError("a vector of zeros has no direction")
    array /= lengths if array.size else 1.0
    if out is None:
        return array
    out[...] = array
