"""All sixteen with pyquaternion: a transform is a quaternion and a translation. Its numbers are w, x, y, z."""

from functools import reduce

import numpy as np
import pyquaternion
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return pyquaternion.Quaternion(axis=[0, 0, 1], degrees=degrees).rotation_matrix


def rotation_from_axes(x_axis, y_axis):
    return pyquaternion.Quaternion(matrix=np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)])).rotation_matrix


def is_rotation(R):
    try:
        pyquaternion.Quaternion(matrix=R, rtol=0, atol=1e-6)
    except ValueError:
        return False
    return True


def same_rotation(q1, q2):
    one, other = (pyquaternion.Quaternion(q[3], *q[:3]) for q in (q1, q2))
    return pyquaternion.Quaternion.absolute_distance(one, other) < 1e-6


def make_transform(R, p):
    return _matrix(pyquaternion.Quaternion(matrix=R), p)


def hand_transform():
    return _matrix(pyquaternion.Quaternion(axis=[1, 0, 0], degrees=-90), [-0.1, 0, 0])


def _matrix(q, p):
    T = q.transformation_matrix
    T[:3, 3] = p
    return T


def _parts(matrix):
    return pyquaternion.Quaternion(matrix=matrix), matrix[:3, 3]


def _pose(q, p):
    return Pose(Point(*p), Quaternion(q.x, q.y, q.z, q.w))


def _parts_of(pose):
    p, q = pose.position, pose.orientation
    return pyquaternion.Quaternion(q.w, q.x, q.y, q.z), np.array([p.x, p.y, p.z])


def transform_to_pose(matrix):
    return _pose(*_parts(matrix))


def pose_to_transform(pose):
    return _matrix(*_parts_of(pose))


def transform_point(a_T_b, p_in_b):
    q, p = _parts(a_T_b)
    return q.rotate(p_in_b) + p


def _then(a, b):
    return a[0] * b[0], a[0].rotate(b[1]) + a[1]


def _inverse(q, p):
    return q.inverse, -q.inverse.rotate(p)


def chain(*transforms):
    return _matrix(*reduce(_then, map(_parts, transforms)))


def transform_pose(a_T_b, pose_in_b):
    return _pose(*_then(_parts(a_T_b), _parts_of(pose_in_b)))


def invert_transform(a_T_b):
    return _matrix(*_inverse(*_parts(a_T_b)))


def relative_transform(a_T_b, a_T_c):
    return _matrix(*_then(_inverse(*_parts(a_T_b)), _parts(a_T_c)))


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    q, p = _parts(base_T_gripper)
    return q.inverse.rotate(transform_point(base_T_camera, p_in_camera) - p)


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    q, p = _parts_of(object_pose)
    return _pose(q, p + q.rotate(np.asarray(offset)))
