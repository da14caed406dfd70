"""All sixteen with SciPy's Rotation: a transform is a rotation and a translation, put together by NumPy."""

from functools import reduce

import numpy as np
from scipy.spatial.transform import Rotation
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return Rotation.from_euler("z", degrees, degrees=True)


def rotation_from_axes(x_axis, y_axis):
    return Rotation.from_matrix(np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)]))


def is_rotation(R):
    # from_matrix takes the nearest rotation without a word: is it the one that was given?
    try:
        nearest = Rotation.from_matrix(R)
    except ValueError:  # left-handed, or singular
        return False
    return np.allclose(nearest.as_matrix(), R, rtol=0, atol=1e-6)


def same_rotation(q1, q2):
    return Rotation.from_quat(q1).approx_equal(Rotation.from_quat(q2), atol=1e-6)


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = Rotation.from_matrix(R).as_matrix()
    T[:3, 3] = p
    return T


def hand_transform():
    return make_transform(Rotation.from_rotvec([-90, 0, 0], degrees=True).as_matrix(), [-0.1, 0, 0])


def transform_to_pose(matrix):
    q = Rotation.from_matrix(matrix[:3, :3]).as_quat()  # x, y, z, w
    return Pose(Point(*matrix[:3, 3]), Quaternion(*q))


def _parts(pose):
    p, q = pose.position, pose.orientation
    return Rotation.from_quat([q.x, q.y, q.z, q.w]), np.array([p.x, p.y, p.z])


def pose_to_transform(pose):
    R, p = _parts(pose)
    return make_transform(R.as_matrix(), p)


def transform_point(a_T_b, p_in_b):
    return Rotation.from_matrix(a_T_b[:3, :3]).apply(p_in_b) + a_T_b[:3, 3]


def chain(*transforms):
    return reduce(np.matmul, transforms).copy()


def transform_pose(a_T_b, pose_in_b):
    R, p = _parts(pose_in_b)
    q = (Rotation.from_matrix(a_T_b[:3, :3]) * R).as_quat()
    return Pose(Point(*transform_point(a_T_b, p)), Quaternion(*q))


def invert_transform(a_T_b):
    b_R_a = Rotation.from_matrix(a_T_b[:3, :3]).inv()
    return make_transform(b_R_a.as_matrix(), -b_R_a.apply(a_T_b[:3, 3]))


def relative_transform(a_T_b, a_T_c):
    b_R_a = Rotation.from_matrix(a_T_b[:3, :3]).inv()
    b_R_c = b_R_a * Rotation.from_matrix(a_T_c[:3, :3])
    return make_transform(b_R_c.as_matrix(), b_R_a.apply(a_T_c[:3, 3] - a_T_b[:3, 3]))


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p_in_base = transform_point(base_T_camera, p_in_camera)
    base_R_gripper = Rotation.from_matrix(base_T_gripper[:3, :3])
    return base_R_gripper.apply(p_in_base - base_T_gripper[:3, 3], inverse=True)


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    R, p = _parts(object_pose)
    return Pose(Point(*(p + R.apply(offset))), Quaternion(*R.as_quat()))
