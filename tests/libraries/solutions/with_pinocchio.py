"""All sixteen with Pinocchio, whose SE3 is returned as it is. Its arrays of a quaternion are x, y, z, w."""

from functools import reduce
from operator import mul

import numpy as np
import pinocchio as pin
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return pin.AngleAxis(np.radians(degrees), np.array([0.0, 0.0, 1.0])).toRotationMatrix()


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)])


def is_rotation(R):
    # SE3 takes any matrix, and inverts it by its transpose
    M = pin.SE3(R.astype(float), np.zeros(3))
    return (M * M.inverse()).isIdentity(1e-6) and np.linalg.det(M.rotation) > 0


def same_rotation(q1, q2):
    return pin.Quaternion(q1.astype(float)).angularDistance(pin.Quaternion(q2.astype(float))) < 1e-6


def make_transform(R, p):
    return pin.SE3(R.astype(float), p.astype(float))


def hand_transform():
    return pin.SE3(pin.rpy.rpyToMatrix(np.radians(-90), 0, 0), np.array([-0.1, 0, 0]))


def _to_pose(M):
    x, y, z, *q = pin.SE3ToXYZQUAT(M)
    return Pose(Point(x, y, z), Quaternion(*q))


def _from_pose(pose):
    p, q = pose.position, pose.orientation
    return pin.XYZQUATToSE3(np.array([p.x, p.y, p.z, q.x, q.y, q.z, q.w], dtype=float))


def _se3(matrix):
    return pin.SE3(matrix.astype(float))  # it takes no integers


def transform_to_pose(matrix):
    return _to_pose(_se3(matrix))


def pose_to_transform(pose):
    return _from_pose(pose)


def transform_point(a_T_b, p_in_b):
    return _se3(a_T_b).act(p_in_b.astype(float))


def chain(*transforms):
    return reduce(mul, map(_se3, transforms))


def transform_pose(a_T_b, pose_in_b):
    return _to_pose(_se3(a_T_b) * _from_pose(pose_in_b))


def invert_transform(a_T_b):
    return _se3(a_T_b).inverse()


def relative_transform(a_T_b, a_T_c):
    return _se3(a_T_b).actInv(_se3(a_T_c))


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return _se3(base_T_gripper).actInv(_se3(base_T_camera).act(p_in_camera.astype(float)))


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, np.array([-distance, 0, 0]))


def waypoint(object_pose, offset):
    return _to_pose(_from_pose(object_pose) * pin.SE3(np.eye(3), offset.astype(float)))
