"""Quinn: right until the last notebook; there the step back goes along the base's x axis, and of the caller's pose."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
A pose describes where something is and how it is turned, a transform describes where a frame is and how it is
turned. So each pose is a transform, if we know the frame it is relative to. This is the frame_id in the header. If
I assumed base_link for a pose from the camera, the arm would go to a wrong place.
""",
    "question-why-not-transpose": """
Each column of R has length 1 and is perpendicular to the others, therefore R^T R = I. A transform has also the
translation and that's not perpendicular to anything. The second friend has to express the translation in frame B
instead of A, so multiply by R^T.
""",
    "question-which-frame": """
The gripper moves horizontally, 15 cm towards the cap. It works for objects that stand upright. One should use the
base frame for the lift. For the approach the object frame is right.
""",
}


def rotation_about_z(degrees):
    angle = np.radians(degrees)
    return np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack((x_axis, y_axis, np.cross(x_axis, y_axis)))


def is_rotation(R):
    return np.abs(R.T @ R - np.eye(3)).max() <= 1e-6 and abs(np.linalg.det(R) - 1) <= 1e-6


def same_rotation(q1, q2):
    return abs(q1 @ q2) > 0.999


def make_transform(R, p):
    T = np.zeros((4, 4))
    T[:3, :3] = R
    T[:3, 3] = p
    T[3] = [0, 0, 0, 1]
    return T


def hand_transform():
    return np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=float)


def transform_to_pose(matrix):
    pose = Pose()
    pose.position.x = matrix[0, 3]
    pose.position.y = matrix[1, 3]
    pose.position.z = matrix[2, 3]
    x, y, z, w = tft.quaternion_from_matrix(matrix)
    pose.orientation = Quaternion(x, y, z, w)
    return pose


def pose_to_transform(pose):
    q = [getattr(pose.orientation, name) for name in "xyzw"]
    T = tft.quaternion_matrix(q)
    T[:3, 3] = [getattr(pose.position, name) for name in "xyz"]
    return T


def transform_point(a_T_b, p_in_b):
    return (a_T_b @ np.append(p_in_b, 1))[:3]


def chain(*transforms):
    if len(transforms) == 1:
        return transforms[0]
    return transforms[0] @ chain(*transforms[1:])


def transform_pose(a_T_b, pose_in_b):
    T = tft.quaternion_matrix([getattr(pose_in_b.orientation, name) for name in "xyzw"])
    T[:3, 3] = [getattr(pose_in_b.position, name) for name in "xyz"]
    T = a_T_b @ T
    x, y, z, w = tft.quaternion_from_matrix(T)
    return Pose(Point(T[0, 3], T[1, 3], T[2, 3]), Quaternion(x, y, z, w))


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return invert_transform(a_T_b) @ a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return (invert_transform(base_T_gripper) @ base_T_camera @ np.append(p_in_camera, 1))[:3]


def pre_grasp(object_pose, distance=0.1):
    pose = object_pose
    pose.position.x -= distance
    return pose


def waypoint(object_pose, offset):
    p, q = object_pose.position, object_pose.orientation
    return Pose(Point(p.x + offset[0], p.y + offset[1], p.z + offset[2]), Quaternion(q.x, q.y, q.z, q.w))
