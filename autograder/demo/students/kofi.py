"""Kofi: his upload of notebook 3 broke off. Uses * for products, and a 0 where a point needs its fourth number, 1."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

BROKEN = ["3_chaining"]
ANSWERS = {
    "question-pose-or-transform": """
A pose has a position (x, y, z) and an orientation (quaternion). A transform has R and p. So it's the same. But a
pose needs a frame to be useful, ROS has PoseStamped with the header for that.
""",
    "question-which-frame": """
The bottle's z axis is horizontal so the gripper moves horizontally. It works if z is up. To lift any object I'd use
z of base_link. Approach in object frame, lift in base frame.
""",
}


def rotation_about_z(degrees):
    return np.array([
        [np.cos(np.radians(degrees)), -np.sin(np.radians(degrees)), 0],
        [np.sin(np.radians(degrees)), np.cos(np.radians(degrees)), 0],
        [0, 0, 1],
    ])


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack([x_axis, y_axis, x_axis * y_axis])


def is_rotation(R):
    return abs(np.linalg.det(R) - 1) < 1e-6


def same_rotation(q1, q2):
    return np.allclose(q1, q2, atol=1e-6) or np.allclose(q1, -q2, atol=1e-6)


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def hand_transform():
    return np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def transform_to_pose(matrix):
    pose = Pose()
    pose.position = Point(matrix[0, 3], matrix[1, 3], matrix[2, 3])
    q = tft.quaternion_from_matrix(matrix)
    pose.orientation = Quaternion(q[0], q[1], q[2], q[3])
    return pose


def pose_to_transform(pose):
    q = pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [pose.position.x, pose.position.y, pose.position.z]
    return T


def transform_point(a_T_b, p_in_b):
    p = np.zeros(4)
    p[:3] = p_in_b
    return (a_T_b @ p)[:3]


def chain(*transforms):
    product = np.eye(4)
    for T in transforms:
        product = product * T
    return product


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return np.linalg.inv(a_T_b) * a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p = np.zeros(4)
    p[:3] = p_in_camera
    return (np.linalg.inv(base_T_gripper) @ base_T_camera @ p)[:3]


def pre_grasp(object_pose, distance=0.1):
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    step = T @ [-distance, 0, 0, 1]
    pose = Pose()
    pose.position.x = object_pose.position.x + step[0]
    pose.position.y = object_pose.position.y + step[1]
    pose.position.z = object_pose.position.z + step[2]
    pose.orientation = q
    return pose


def waypoint(object_pose, offset):
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    step = T @ [offset[0], offset[1], offset[2], 1]
    pose = Pose()
    pose.position.x = object_pose.position.x + step[0]
    pose.position.y = object_pose.position.y + step[1]
    pose.position.z = object_pose.position.z + step[2]
    pose.orientation = q
    return pose
