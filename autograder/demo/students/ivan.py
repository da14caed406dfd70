"""Ivan: ran out of time. Notebooks 1 and 2 are right but for one quaternion formula; the rest is as it was released."""

import numpy as np
from transform_lab import Pose, tft

ANSWERS = {"question-pose-or-transform": "A pose is a transform, because it has a position and an orientation."}


def rotation_about_z(degrees):
    rad = degrees / 180 * np.pi
    return np.array([
        [np.cos(rad), -np.sin(rad), 0],
        [np.sin(rad), np.cos(rad), 0],
        [0, 0, 1],
    ])


def rotation_from_axes(x_axis, y_axis):
    z_axis = np.cross(x_axis, y_axis)
    return np.array([x_axis, y_axis, z_axis]).transpose()


def is_rotation(R):
    should_be_identity = R.T @ R
    for i in range(3):
        for j in range(3):
            if abs(should_be_identity[i, j] - (1 if i == j else 0)) > 1e-6:
                return False
    return np.linalg.det(R) > 0


def same_rotation(q1, q2):
    return all(abs(q1 - q2) < 1e-6) or all(abs(q1 + q2) < 1e-6)


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def hand_transform():
    return make_transform([[1, 0, 0], [0, 0, 1], [0, -1, 0]], [-0.1, 0, 0])


def transform_to_pose(matrix):
    # the formula from the lecture
    m = matrix
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = m[:3, 3]
    w = np.sqrt(1 + m[0, 0] + m[1, 1] + m[2, 2]) / 2
    pose.orientation.x = (m[2, 1] - m[1, 2]) / (4 * w)
    pose.orientation.y = (m[0, 2] - m[2, 0]) / (4 * w)
    pose.orientation.z = (m[1, 0] - m[0, 1]) / (4 * w)
    pose.orientation.w = w
    return pose


def pose_to_transform(pose):
    q = pose.orientation
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
    return make_transform(R, [pose.position.x, pose.position.y, pose.position.z])


def transform_point(a_T_b, p_in_b):
    return np.dot(a_T_b, [*p_in_b, 1])[:3]
