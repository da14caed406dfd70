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

Source: names, signatures and conventions follow C. Gohlke's ``transformations.py`` as shipped with ROS 1; rotation
arithmetic is SciPy's ``Rotation``. Of the angles that describe one and the same rotation, SciPy and ROS may choose
different ones (the middle angle's range, and half turns of it).
"""

import math

import numpy as np

from .validation import numbers, rigid_transform

__all__ = [
    "concatenate_matrices", "euler_from_matrix", "euler_from_quaternion", "euler_matrix", "identity_matrix",
    "inverse_matrix", "quaternion_about_axis", "quaternion_conjugate", "quaternion_from_euler",
    "quaternion_from_matrix", "quaternion_inverse", "quaternion_matrix", "quaternion_multiply", "quaternion_slerp",
    "random_quaternion", "random_rotation_matrix", "rotation_from_matrix", "rotation_matrix",
    "translation_from_matrix", "translation_matrix", "unit_vector", "vector_norm",
]  # fmt: skip

_EPS = np.finfo(float).eps * 4.0  # below this squared length, ROS takes a quaternion for zero


def _rotation():
    """Return SciPy's Rotation, imported at its first use: the import takes longer than all the rest of this package."""
    from scipy.spatial.transform import Rotation

    return Rotation


def _matrix(rotation):
    """Return a SciPy Rotation as a 4x4 matrix."""
    T = np.eye(4)
    T[:3, :3] = rotation.as_matrix()
    return T


def _vector(value, what):
    """Return the first three of 3 or 4 (homogeneous) numbers."""
    return numbers(value, what, lengths=(3, 4))[:3]


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
    T = _matrix(_rotation().from_rotvec(angle * axis))
    if point is not None:
        p = _vector(point, "rotation_matrix: the point")
        T[:3, 3] = p - T[:3, :3] @ p  # the point stays where it is: R p + t = p
    return T


def rotation_from_matrix(matrix):
    """Return the angle (radians, 0 to pi), the axis (3 numbers) and a point on it (4 numbers) of a 4x4 rotation.

    The point is the one nearest to the origin. The identity gives 0 and the z axis. Raises ValueError if the transform
    also moves along its axis, because such a motion has no point that stays where it is.
    """
    T = rigid_transform(matrix, "rotation_from_matrix: the matrix")
    R, t = T[:3, :3], T[:3, 3]
    rotation_vector = _rotation().from_matrix(R).as_rotvec()
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


# Euler angles


def _scipy_axes(axes):
    """Return SciPy's name for ROS's Euler axes: lower case about fixed axes, upper case about the moving frame's."""
    frame, sequence = axes[:1].lower(), axes[1:].lower()
    legal = len(sequence) == 3 and set(sequence) <= set("xyz") and sequence[1] not in (sequence[0], sequence[2])
    if frame not in ("s", "r") or not legal:
        raise ValueError(
            f"no such Euler axes: {axes!r}. Write 's' (fixed axes) or 'r' (rotating axes) and three of x, y, z, the"
            " same never twice running, such as 'sxyz' or 'rzyx'"
        )
    return sequence if frame == "s" else sequence.upper()


def euler_matrix(ai, aj, ak, axes="sxyz"):
    """Return the 4x4 rotation by the angles `ai`, `aj`, `ak` (radians) about `axes`, in this order."""
    return _matrix(_rotation().from_euler(_scipy_axes(axes), [ai, aj, ak]))


def euler_from_matrix(matrix, axes="sxyz"):
    """Return the three Euler angles (radians, a tuple) about `axes` of a 4x4 transform's rotation.

    At gimbal lock many triples are right; the one returned has 0 for the third.
    """
    R = rigid_transform(matrix, "euler_from_matrix: the matrix")[:3, :3]
    # SciPy warns at gimbal lock; text on stderr would cost a student the points of the cell.
    angles = _rotation().from_matrix(R).as_euler(_scipy_axes(axes), suppress_warnings=True)
    return tuple(angles.tolist())


def euler_from_quaternion(quaternion, axes="sxyz"):
    """Return the three Euler angles (radians, a tuple) about `axes` of the quaternion x, y, z, w."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def quaternion_from_euler(ai, aj, ak, axes="sxyz"):
    """Return the quaternion x, y, z, w of the rotation by `ai`, `aj`, `ak` (radians) about `axes`, in this order."""
    return _rotation().from_euler(_scipy_axes(axes), [ai, aj, ak]).as_quat()


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
    return _matrix(_rotation().from_quat(q))


def quaternion_from_matrix(matrix):
    """Return the quaternion x, y, z, w of the rotation in a 4x4 transform, of length 1; translation is ignored.

    Raises ValueError unless the matrix is 4x4 and a rigid transform (to 1e-3), naming the property that fails.
    """
    T = rigid_transform(matrix, "quaternion_from_matrix: the matrix")
    return _rotation().from_matrix(T[:3, :3]).as_quat()


def quaternion_about_axis(angle, axis):
    """Return the quaternion x, y, z, w of the rotation by `angle` (radians) about `axis` (any length but zero)."""
    axis = unit_vector(_vector(axis, "quaternion_about_axis: the axis"))
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


def vector_norm(data, axis=None):
    """Return the length of a vector, or the lengths of an array's vectors along `axis`."""
    return np.linalg.norm(numbers(data, "vector_norm: the data"), axis=axis)


def unit_vector(data, axis=None):
    """Return a vector at length 1, or an array with its vectors along `axis` at length 1.

    Raises ValueError for a vector of zeros, which has no direction.
    """
    array = numbers(data, "unit_vector: the data")
    lengths = np.linalg.norm(array, axis=axis, keepdims=axis is not None)
    if np.any(lengths == 0):
        raise ValueError("a vector of zeros has no direction")
    return array / lengths
