"""All sixteen with transforms3d. Its quaternions are w, x, y, z."""

from functools import reduce

import numpy as np
from transform_lab import Point, Pose, Quaternion
from transforms3d import affines, axangles, euler, quaternions


def rotation_about_z(degrees):
    return axangles.axangle2mat([0, 0, 1], np.deg2rad(degrees), is_normalized=True)


def rotation_from_axes(x_axis, y_axis):
    return np.array([x_axis, y_axis, np.cross(x_axis, y_axis)]).T


def is_rotation(R):
    # a rotation has no zooms and no shears; a mirror image has a zoom of -1, and zeros are divided by zero
    with np.errstate(invalid="ignore"):
        _, _, zooms, shears = affines.decompose44(affines.compose(np.zeros(3), R, np.ones(3)))
    return np.allclose(zooms, 1, rtol=0, atol=1e-6) and np.allclose(shears, 0, rtol=0, atol=1e-6)


def same_rotation(q1, q2):
    return quaternions.nearly_equivalent(q1, q2, rtol=0, atol=1e-6)


def make_transform(R, p):
    return affines.compose(p, R, np.ones(3))


def hand_transform():
    return affines.compose([-0.1, 0, 0], euler.euler2mat(np.deg2rad(-90), 0, 0), np.ones(3))


def _parts(matrix):
    # decompose44 divides in place, which an array of integers refuses
    p, R, _, _ = affines.decompose44(matrix.astype(float))
    return p, R


def _pose(matrix):
    p, R = _parts(matrix)
    w, x, y, z = quaternions.mat2quat(R)
    return Pose(Point(*p), Quaternion(x, y, z, w))


def transform_to_pose(matrix):
    return _pose(matrix)


def pose_to_transform(pose):
    p, q = pose.position, pose.orientation
    return affines.compose([p.x, p.y, p.z], quaternions.quat2mat([q.w, q.x, q.y, q.z]), np.ones(3))


def transform_point(a_T_b, p_in_b):
    p, R = _parts(a_T_b)
    return R @ p_in_b + p


def chain(*transforms):
    return reduce(np.dot, transforms, np.eye(4))


def transform_pose(a_T_b, pose_in_b):
    return _pose(a_T_b @ pose_to_transform(pose_in_b))


def invert_transform(a_T_b):
    p, R = _parts(a_T_b)
    return affines.compose(-R.T @ p, R.T, np.ones(3))


def relative_transform(a_T_b, a_T_c):
    return invert_transform(a_T_b) @ a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return transform_point(invert_transform(base_T_gripper) @ base_T_camera, p_in_camera)


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    p, q = object_pose.position, object_pose.orientation
    x, y, z = quaternions.rotate_vector(offset, [q.w, q.x, q.y, q.z])
    return Pose(Point(p.x + x, p.y + y, p.z + z), Quaternion(q.x, q.y, q.z, q.w))
