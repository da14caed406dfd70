"""SciPy's Rotation, and its arithmetic for one rotation at a time without SciPy.

To load SciPy takes longer than all the rest of this package, and a call of it ten times as long as here. The numbers are the
same, to the last digit: formulas and their order are those of SciPy's `spatial/transform`.
"""

from math import atan2, cos, sin, sqrt

import numpy as np

ORTHOGONAL = 1e-12  # beyond it, SciPy takes the nearest rotation
SMALL = 1e-3  # radians, below which SciPy has series


class _Loaded:
    """SciPy's Rotation, loaded when something of it is asked for."""

    def __getattr__(self, name):
        from scipy.spatial.transform import Rotation

        return getattr(Rotation, name)


Rotation = _Loaded()


def matrix_of(q):
    """The 3x3 matrix of a quaternion x, y, z, w of any length but 0."""
    return _matrix(*_unit(q))


def turn(vector):
    """The 3x3 matrix of a rotation vector: the axis, as long as the angle (radians)."""
    return _matrix(*_quaternion_of_vector(vector))


def turned(q, vector):
    """x, y, z, w of the rotation of a quaternion, after a turn by a rotation vector given in the turned frame."""
    return np.array(_unit(_product(_unit(q), _quaternion_of_vector(vector))))


def quaternion_of_turns(angles, axes, fixed):
    """x, y, z, w of turns by angles (radians) about axes ("xyz"), one after the other; fixed ones, or else the turned frame's."""
    q = (0.0, 0.0, 0.0, 1.0)
    for angle, axis in zip(angles, axes):
        step = [0.0, 0.0, 0.0, cos(angle / 2)]
        step["xyz".index(axis)] = sin(angle / 2)
        q = _product(step, q) if fixed else _product(q, step)
    return np.array(q)


def matrix_of_turns(angles, axes, fixed):
    """The 3x3 matrix of these turns."""
    return _matrix(*quaternion_of_turns(angles, axes, fixed).tolist())


def quaternion_of(R):
    """x, y, z, w of a 3x3 matrix."""
    R = np.asarray(R, dtype=float)
    if not _is_rotation(R):
        return Rotation.from_matrix(R).as_quat()
    m = R.tolist()
    trace = m[0][0] + m[1][1] + m[2][2]
    sizes = [m[0][0], m[1][1], m[2][2], trace]
    i = sizes.index(max(sizes))
    if i == 3:
        q = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], 1 + trace]
    else:
        j, k = (i + 1) % 3, (i + 2) % 3
        q = [0.0, 0.0, 0.0, m[k][j] - m[j][k]]
        q[i], q[j], q[k] = 1 - trace + 2 * m[i][i], m[j][i] + m[i][j], m[k][i] + m[i][k]
    return np.array(q) / _length(q)


def vector_of(R):
    """The rotation vector of a 3x3 matrix: the axis, as long as the angle (radians, at most pi)."""
    q = quaternion_of(R)
    x, y, z, w = q.tolist() if q[3] >= 0 else (-q).tolist()
    angle = 2 * atan2(sqrt(x * x + y * y + z * z), w)
    square = angle * angle
    scale = 2 + square / 12 + 7 * square * square / 2880 if angle <= SMALL else angle / sin(angle / 2)
    return scale * np.array([x, y, z])


def angle_of(R):
    """The angle of a 3x3 matrix (radians, 0 to pi)."""
    x, y, z, w = quaternion_of(R).tolist()
    return 2 * atan2(sqrt(x * x + y * y + z * z), abs(w))


def _unit(q):
    """A quaternion of length 1; of one so short that its length is 0, SciPy's own error."""
    length = _length(q)
    return [float(number) / length for number in q] if length > 0.0 else Rotation.from_quat(q).as_quat().tolist()


def _length(q):
    x, y, z, w = map(float, q)
    return sqrt(x * x + y * y + z * z + w * w)


def _product(p, q):
    (x, y, z, w), (a, b, c, d) = p, q
    return (
        w * a + d * x + (y * c - z * b),
        w * b + d * y + (z * a - x * c),
        w * c + d * z + (x * b - y * a),
        w * d - x * a - y * b - z * c,
    )


def _quaternion_of_vector(vector):
    x, y, z = map(float, vector)
    angle = sqrt(x * x + y * y + z * z)
    square = angle * angle
    scale = 0.5 - square / 48 + square * square / 3840 if angle <= SMALL else sin(angle / 2) / angle
    return scale * x, scale * y, scale * z, cos(angle / 2)


def _matrix(x, y, z, w):
    x2, y2, z2, w2 = x * x, y * y, z * z, w * w
    xy, zw, xz, yw, yz, xw = x * y, z * w, x * z, y * w, y * z, x * w
    return np.array(
        [
            [x2 - y2 - z2 + w2, 2 * (xy - zw), 2 * (xz + yw)],
            [2 * (xy + zw), -x2 + y2 - z2 + w2, 2 * (yz - xw)],
            [2 * (xz - yw), 2 * (yz + xw), -x2 - y2 + z2 + w2],
        ]
    )


def _is_rotation(R):
    """Whether SciPy takes a matrix as it is."""
    if R.shape != (3, 3) or not np.abs(R @ R.T - np.eye(3)).max() <= ORTHOGONAL:
        return False
    (a, b, c), (d, e, f), (g, h, i) = R.tolist()
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) > 0
