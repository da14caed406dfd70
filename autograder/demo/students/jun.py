"""Jun: multiplies in the reverse order, and forgot to upload notebook 5."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

MISSING = ["5_pre_grasp"]
ANSWERS = {
    "question-pose-or-transform": """
A pose gives position and orientation, so you can build the transform from it. You also need to know in which frame
the pose is, this is the frame_id in the header. If you take the wrong frame the gripper could hit the table.
""",
    "question-why-not-transpose": """
The rotation's columns are perpendicular unit vectors, so the transpose is the inverse. The transform's translation
column is not a unit vector. The second one has to rotate the translation: -R^T t.
""",
}


def rotation_about_z(degrees):
    theta = np.radians(degrees)
    return np.array([[np.cos(theta), -np.sin(theta), 0], [np.sin(theta), np.cos(theta), 0], [0, 0, 1]])


def rotation_from_axes(x_axis, y_axis):
    z_axis = np.cross(x_axis, y_axis)
    return np.vstack([x_axis, y_axis, z_axis]).T


def is_rotation(R):
    return np.allclose(R @ R.T, np.eye(3), atol=1e-6) and np.isclose(np.linalg.det(R), 1)


def same_rotation(q1, q2):
    return np.allclose(np.outer(q1, q1), np.outer(q2, q2), atol=1e-6)


def make_transform(R, p):
    return np.array([[*R[0], p[0]], [*R[1], p[1]], [*R[2], p[2]], [0, 0, 0, 1]])


def hand_transform():
    return np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def to_pose(T):
    q = tft.quaternion_from_matrix(T)
    return Pose(Point(T[0, 3], T[1, 3], T[2, 3]), Quaternion(q[0], q[1], q[2], q[3]))


def to_transform(pose):
    T = tft.quaternion_matrix([pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w])
    T[:3, 3] = [pose.position.x, pose.position.y, pose.position.z]
    return T


def transform_to_pose(matrix):
    return to_pose(matrix)


def pose_to_transform(pose):
    return to_transform(pose)


def transform_point(a_T_b, p_in_b):
    return (np.append(p_in_b, 1) @ a_T_b)[:3]


def chain(*transforms):
    # the last transform is applied first
    result = np.eye(4)
    for T in transforms:
        result = T @ result
    return result


def transform_pose(a_T_b, pose_in_b):
    return to_pose(to_transform(pose_in_b) @ a_T_b)


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return a_T_c @ np.linalg.inv(a_T_b)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    T = np.linalg.inv(base_T_gripper) @ base_T_camera
    return (T @ np.append(p_in_camera, 1))[:3]
