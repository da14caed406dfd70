"""Goran: trouble with numbers (degrees as radians, == for floats, q and -q), and waypoints along the base's axes."""

import math

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
position = translation, orientation = rotation. You need the frame (header/frame_id). Wrong frame = wrong place.
""",
    "question-why-not-transpose": """
R^T R = I because of orthonormal columns. Translation cannot be inverted by transposing since it is not part of the
rotation. Second friend: the vector has to be rotated into the other frame first.
""",
}


def rotation_about_z(degrees):
    return np.array([[math.cos(degrees), -math.sin(degrees), 0],
                     [math.sin(degrees), math.cos(degrees), 0],
                     [0, 0, 1]])


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack((x_axis, y_axis, np.cross(x_axis, y_axis)))


def is_rotation(R):
    return np.array_equal(R.T @ R, np.eye(3)) and np.linalg.det(R) == 1


def same_rotation(q1, q2):
    return np.allclose(q1, q2, atol=1e-6)


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def hand_transform():
    return np.array([[1, 0, 0, -10], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def transform_to_pose(matrix):
    pose = Pose()
    pose.position.x = matrix[0][3]
    pose.position.y = matrix[1][3]
    pose.position.z = matrix[2][3]
    q = tft.quaternion_from_matrix(matrix)
    pose.orientation = Quaternion(q[0], q[1], q[2], q[3])
    return pose


def pose_to_transform(pose):
    T = tft.quaternion_matrix([pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w])
    T[0][3] = pose.position.x
    T[1][3] = pose.position.y
    T[2][3] = pose.position.z
    return T


def transform_point(a_T_b, p_in_b):
    return np.dot(a_T_b, np.append(p_in_b, 1))[:3]


def chain(*transforms):
    T = transforms[0]
    for i in range(1, len(transforms)):
        T = np.dot(T, transforms[i])
    return T


def to_matrix(pose):
    T = tft.quaternion_matrix([pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w])
    T[:3, 3] = [pose.position.x, pose.position.y, pose.position.z]
    return T


def transform_pose(a_T_b, pose_in_b):
    T = np.dot(a_T_b, to_matrix(pose_in_b))
    q = tft.quaternion_from_matrix(T)
    return Pose(Point(T[0][3], T[1][3], T[2][3]), Quaternion(q[0], q[1], q[2], q[3]))


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return np.dot(np.linalg.inv(a_T_b), a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    T = np.dot(np.linalg.inv(base_T_gripper), base_T_camera)
    return np.dot(T, np.append(p_in_camera, 1))[:3]


def pre_grasp(object_pose, distance=0.1):
    pose = Pose()
    pose.position.x = object_pose.position.x - distance
    pose.position.y = object_pose.position.y
    pose.position.z = object_pose.position.z
    pose.orientation = object_pose.orientation
    return pose


def waypoint(object_pose, offset):
    # the other way round, so that the offset is in the right frame
    T = np.dot(tft.translation_matrix(offset), to_matrix(object_pose))
    q = tft.quaternion_from_matrix(T)
    return Pose(Point(T[0][3], T[1][3], T[2][3]), Quaternion(q[0], q[1], q[2], q[3]))
