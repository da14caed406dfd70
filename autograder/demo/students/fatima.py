"""Fatima: comes from a library with quaternions in the order w, x, y, z, and keeps that order; the rest is right."""

import math

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
A pose can be read as the transform from the frame of the cup to some reference frame. Which one, is not in the Pose
but in the header (frame_id) of the PoseStamped. Assuming the wrong one sends the gripper to the wrong place without
any error.
""",
    "question-why-not-transpose": """
For R: its columns are orthonormal so R^T R = I. The last column of T has not unit length, and after transposing,
the bottom row is not 0 0 0 1 any more. The second friend must multiply with R^T: t' = -R^T t. Example: 90 degrees
about z and t = (1, 0, 0) gives t' = (0, 1, 0) and not (-1, 0, 0).
""",
    "question-which-frame": """
Along the z axis of the bottle, so parallel to the table. It works for standing objects. Up is in the base frame, so
take the grasp pose and add 0.15 to its z. The approach should be in the object frame since it depends on the
object.
""",
}


def rotation_about_z(degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def rotation_from_axes(x_axis, y_axis):
    return np.stack([x_axis, y_axis, np.cross(x_axis, y_axis)], axis=1)


def is_rotation(R):
    return np.allclose(np.linalg.inv(R), R.T, atol=1e-6) and np.linalg.det(R) > 0 if np.linalg.det(R) else False


def same_rotation(q1, q2):
    return min(np.linalg.norm(q1 - q2), np.linalg.norm(q1 + q2)) < 1e-6


def make_transform(R, p):
    T = np.identity(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def hand_transform():
    return np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def transform_to_pose(matrix):
    x, y, z, w = tft.quaternion_from_matrix(matrix)
    pose = Pose()
    pose.position = Point(matrix[0, 3], matrix[1, 3], matrix[2, 3])
    pose.orientation = Quaternion(w, x, y, z)
    return pose


def pose_to_transform(pose):
    q, p = pose.orientation, pose.position
    T = tft.quaternion_matrix([q.w, q.x, q.y, q.z])
    T[:3, 3] = [p.x, p.y, p.z]
    return T


def transform_point(a_T_b, p_in_b):
    return (a_T_b @ np.concatenate([p_in_b, [1]]))[:-1]


def chain(*transforms):
    result = np.identity(4)
    for transform in reversed(transforms):
        result = transform @ result
    return result


def transform_pose(a_T_b, pose_in_b):
    q, p = pose_in_b.orientation, pose_in_b.position
    b_T_c = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    b_T_c[:3, 3] = [p.x, p.y, p.z]
    a_T_c = a_T_b @ b_T_c
    x, y, z, w = tft.quaternion_from_matrix(a_T_c)
    return Pose(Point(*a_T_c[:3, 3]), Quaternion(w, x, y, z))


def invert_transform(a_T_b):
    return tft.inverse_matrix(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return np.linalg.inv(a_T_b) @ a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p_in_base = base_T_camera @ np.append(p_in_camera, 1)
    p_in_gripper = np.linalg.inv(base_T_gripper) @ p_in_base
    return p_in_gripper[:3]


def pre_grasp(object_pose, distance=0.1):
    q, p = object_pose.orientation, object_pose.position
    R = tft.quaternion_matrix([q.w, q.x, q.y, q.z])[:3, :3]
    x, y, z = np.array([p.x, p.y, p.z]) - distance * R[:, 0]
    return Pose(Point(x, y, z), Quaternion(q.x, q.y, q.z, q.w))


def waypoint(object_pose, offset):
    q, p = object_pose.orientation, object_pose.position
    R = tft.quaternion_matrix([q.w, q.x, q.y, q.z])[:3, :3]
    x, y, z = np.array([p.x, p.y, p.z]) + R @ offset
    return Pose(Point(x, y, z), Quaternion(q.x, q.y, q.z, q.w))
