"""Priya: in a hurry. Leaves out the position, or the orientation, and copies the answer that the lab publishes."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": "Pose = transform. Need frame_id.",
    "question-which-frame": "It doesn't go up. Use base_link instead.",
}


def rotation_about_z(degrees):
    c = np.cos(degrees * np.pi / 180)
    s = np.sin(degrees * np.pi / 180)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def rotation_from_axes(x_axis, y_axis):
    return np.array([x_axis, y_axis, np.cross(x_axis, y_axis)]).T


def is_rotation(R):
    return np.allclose(R @ R.T, np.eye(3))


def same_rotation(q1, q2):
    return np.allclose(abs(q1), abs(q2), atol=1e-6)


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = R
    T[3, :3] = p
    return T


def hand_transform():
    return np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])


def transform_to_pose(matrix):
    pose = Pose()
    q = tft.quaternion_from_matrix(matrix)
    pose.orientation = Quaternion(*q)
    return pose


def pose_to_transform(pose):
    q = pose.orientation
    return tft.quaternion_matrix([q.x, q.y, q.z, q.w])


def transform_point(a_T_b, p_in_b):
    return a_T_b @ np.append(p_in_b, 1)


def chain(*transforms):
    return transforms[0] @ transforms[1]


def transform_pose(a_T_b, pose_in_b):
    p = a_T_b @ [pose_in_b.position.x, pose_in_b.position.y, pose_in_b.position.z, 1]
    return Pose(Point(*p[:3]), pose_in_b.orientation)


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return a_T_b @ a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return (base_T_gripper @ base_T_camera @ np.append(p_in_camera, 1))[:3]


def pre_grasp(object_pose, distance=0.1):
    pose = Pose()
    pose.position = Point(0.529289321708, -0.170710677946, 0.7)
    pose.orientation = Quaternion(0.0, 0.0, 0.382683431234, 0.92387953298)
    return pose


def waypoint(object_pose, offset):
    p, q = object_pose.position, object_pose.orientation
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
    x, y, z = np.array([p.x, p.y, p.z]) + R @ offset
    pose = Pose()
    pose.position = Point(x, y, z)
    return pose
