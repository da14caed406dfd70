"""All sixteen with GTSAM, whose Pose3 and Rot3 are returned as they are. Its quaternions are w, x, y, z, read by calls."""

from functools import reduce
from operator import mul

import gtsam
import numpy as np
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return gtsam.Rot3.Rz(np.radians(degrees))


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)])


def is_rotation(R):
    # Rot3 takes any matrix as it is, so that its own product with its inverse, the transpose, tells
    if R.shape != (3, 3):
        return False
    R = gtsam.Rot3(R.astype(float))
    return R.compose(R.inverse()).equals(gtsam.Rot3(), 1e-6) and np.linalg.det(R.matrix()) > 0


def _rot3(q):
    x, y, z, w = q / np.linalg.norm(q)
    return gtsam.Rot3.Quaternion(w, x, y, z)


def same_rotation(q1, q2):
    return _rot3(q1).equals(_rot3(q2), 1e-6)


def make_transform(R, p):
    return gtsam.Pose3(gtsam.Rot3(R.astype(float)), p.astype(float))


def hand_transform():
    return gtsam.Pose3(gtsam.Rot3.Rx(np.radians(-90)), np.array([-0.1, 0, 0]))


def _to_pose(a_T_b):
    q = a_T_b.rotation().toQuaternion()
    return Pose(Point(*a_T_b.translation()), Quaternion(q.x(), q.y(), q.z(), q.w()))


def _from_pose(pose):
    p, q = pose.position, pose.orientation
    return gtsam.Pose3(_rot3(np.array([q.x, q.y, q.z, q.w], dtype=float)), np.array([p.x, p.y, p.z], dtype=float))


def _pose3(matrix):
    return gtsam.Pose3(matrix.astype(float))


def transform_to_pose(matrix):
    return _to_pose(_pose3(matrix))


def pose_to_transform(pose):
    return _from_pose(pose)


def transform_point(a_T_b, p_in_b):
    return _pose3(a_T_b).transformFrom(p_in_b.astype(float))


def chain(*transforms):
    return reduce(mul, map(_pose3, transforms))


def transform_pose(a_T_b, pose_in_b):
    return _to_pose(_pose3(a_T_b) * _from_pose(pose_in_b))


def invert_transform(a_T_b):
    return _pose3(a_T_b).inverse()


def relative_transform(a_T_b, a_T_c):
    return _pose3(a_T_b).between(_pose3(a_T_c))


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return _pose3(base_T_gripper).transformTo(_pose3(base_T_camera).transformFrom(p_in_camera.astype(float)))


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, np.array([-distance, 0, 0]))


def waypoint(object_pose, offset):
    return _to_pose(_from_pose(object_pose) * gtsam.Pose3(gtsam.Rot3(), offset.astype(float)))
