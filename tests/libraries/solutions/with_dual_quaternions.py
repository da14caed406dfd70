"""All sixteen with dual_quaternions, which stands on pyquaternion. All its arrays of a quaternion are w, x, y, z."""

from functools import reduce
from operator import mul

import numpy as np
import pyquaternion
from dual_quaternions import DualQuaternion
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    turn = DualQuaternion.from_screw([0, 0, 1], [0, 0, 0], np.radians(degrees), 0)
    return turn.homogeneous_matrix()[:3, :3]


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)])


def is_rotation(R):
    try:
        pyquaternion.Quaternion(matrix=R, rtol=0, atol=1e-6)  # from_homogeneous_matrix lets nobody choose
    except ValueError:
        return False
    return True


def same_rotation(q1, q2):
    one, other = (DualQuaternion.from_quat_pose_array([q[3], *q[:3], 0, 0, 0]) for q in (q1, q2))
    return pyquaternion.Quaternion.absolute_distance(one.q_r, other.q_r) < 1e-6


def make_transform(R, p):
    q = pyquaternion.Quaternion(matrix=R)
    return DualQuaternion.from_quat_pose_array([*q, *p]).homogeneous_matrix()


def hand_transform():
    roll = DualQuaternion.from_screw([1, 0, 0], [0, 0, 0], np.radians(-90), 0)
    return (DualQuaternion.from_translation_vector([-0.1, 0, 0]) * roll).homogeneous_matrix()


def _to_pose(dq):
    w, qx, qy, qz, x, y, z = dq.quat_pose_array()
    return Pose(Point(x, y, z), Quaternion(qx, qy, qz, w))


def _from_pose(pose):
    p, q = pose.position, pose.orientation
    return DualQuaternion.from_quat_pose_array([q.w, q.x, q.y, q.z, p.x, p.y, p.z])


_of = DualQuaternion.from_homogeneous_matrix


def transform_to_pose(matrix):
    return _to_pose(_of(matrix))


def pose_to_transform(pose):
    return _from_pose(pose).homogeneous_matrix()


def transform_point(a_T_b, p_in_b):
    return _of(a_T_b).transform_point(p_in_b)


def chain(*transforms):
    return reduce(mul, map(_of, transforms)).homogeneous_matrix()


def transform_pose(a_T_b, pose_in_b):
    return _to_pose(_of(a_T_b) * _from_pose(pose_in_b))


def invert_transform(a_T_b):
    return _of(a_T_b).inverse().homogeneous_matrix()


def relative_transform(a_T_b, a_T_c):
    return (_of(a_T_b).inverse() * _of(a_T_c)).homogeneous_matrix()


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return (_of(base_T_gripper).inverse() * _of(base_T_camera)).transform_point(p_in_camera)


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    return _to_pose(_from_pose(object_pose) * DualQuaternion.from_translation_vector(offset))
