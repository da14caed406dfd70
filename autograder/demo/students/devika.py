"""Devika: all right with old habits: np.matrix, quaternion products by hand, tft for everything, column vectors."""

from functools import reduce

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
In the sense that it has the same information, T = translation(position) * rotation(orientation). I must know the
reference frame (header.frame_id of the stamped message), otherwise I would move to a point that is off by the
transform between the frames, which can be a crash.
""",
    "question-why-not-transpose": """
Friend 1: an orthogonal matrix is one whose inverse is its transpose, and rotations are orthogonal. Homogeneous
transforms with a translation are not, their transpose has not even the bottom row 0 0 0 1. Friend 2: (R p)^-1 =
(R^T, -R^T p). What is missing is the R^T in front of p.
""",
    "question-which-frame": """
Fifteen centimetres sideways. It works if the z axis of the object is vertical. Lift = translation(0, 0, 0.15) *
base_T_object, multiplied from the left because it is in the base frame; approach = base_T_object *
translation(-0.1, 0, 0), from the right because it is in the object frame.
""",
}

TOLERANCE = 1e-6


def rotation_about_z(degrees):
    return np.matrix(tft.rotation_matrix(np.pi * degrees / 180, (0, 0, 1))[:3, :3])


def rotation_from_axes(x_axis, y_axis):
    z_axis = [x_axis[1] * y_axis[2] - x_axis[2] * y_axis[1],
              x_axis[2] * y_axis[0] - x_axis[0] * y_axis[2],
              x_axis[0] * y_axis[1] - x_axis[1] * y_axis[0]]
    return np.matrix([x_axis, y_axis, z_axis]).T


def is_rotation(R):
    x, y, z = np.asarray(R).T
    lengths = [abs(np.dot(axis, axis) - 1) < TOLERANCE for axis in (x, y, z)]
    angles = [abs(np.dot(one, other)) < TOLERANCE for one, other in ((x, y), (y, z), (z, x))]
    right_handed = np.dot(np.cross(x, y), z) > 0
    return all(lengths) and all(angles) and right_handed


def same_rotation(q1, q2):
    return np.allclose(tft.quaternion_matrix(q1), tft.quaternion_matrix(q2), atol=TOLERANCE)


def make_transform(R, p):
    T = tft.identity_matrix()
    T[0:3, 0:3] = R
    T[0:3, 3] = p
    return np.matrix(T)


def hand_transform():
    roll = tft.rotation_matrix(-np.pi / 2, [1, 0, 0])
    return tft.concatenate_matrices(tft.translation_matrix([-0.1, 0, 0]), roll)


def transform_to_pose(matrix):
    p = tft.translation_from_matrix(matrix)
    q = tft.quaternion_from_matrix(matrix)
    return Pose(Point(p[0], p[1], p[2]), Quaternion(q[0], q[1], q[2], q[3]))


def pose_to_transform(pose):
    p, q = pose.position, pose.orientation
    translation = tft.translation_matrix((p.x, p.y, p.z))
    return tft.concatenate_matrices(translation, tft.quaternion_matrix((q.x, q.y, q.z, q.w)))


def transform_point(a_T_b, p_in_b):
    column = np.matrix(a_T_b) * np.matrix([*p_in_b, 1]).T  # * is the matrix product of np.matrix
    return column[:3]


def chain(*transforms):
    return reduce(np.dot, transforms)


def turned(vector, q):
    """The vector v as the quaternion product q v q*."""
    v = [vector[0], vector[1], vector[2], 0]
    return tft.quaternion_multiply(tft.quaternion_multiply(q, v), tft.quaternion_conjugate(q))[:3]


def transform_pose(a_T_b, pose_in_b):
    p, q = pose_in_b.position, pose_in_b.orientation
    q_a = tft.quaternion_from_matrix(a_T_b)
    x, y, z = turned([p.x, p.y, p.z], q_a) + a_T_b[:3, 3]
    return Pose(Point(x, y, z), Quaternion(*tft.quaternion_multiply(q_a, [q.x, q.y, q.z, q.w])))


def invert_transform(a_T_b):
    return np.matrix(a_T_b).I


def relative_transform(a_T_b, a_T_c):
    return np.matrix(a_T_b) ** -1 * np.matrix(a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    gripper_T_base = tft.inverse_matrix(base_T_gripper)
    return tft.concatenate_matrices(gripper_T_base, base_T_camera).dot(np.append(p_in_camera, 1.0))[:3]


def pre_grasp(object_pose, distance=0.1):
    q = object_pose.orientation
    back = turned([-distance, 0, 0], [q.x, q.y, q.z, q.w])
    p = object_pose.position
    return Pose(Point(p.x + back[0], p.y + back[1], p.z + back[2]), q)


def waypoint(object_pose, offset):
    p, q = object_pose.position, object_pose.orientation
    base_T_object = tft.concatenate_matrices(tft.translation_matrix((p.x, p.y, p.z)),
                                             tft.quaternion_matrix((q.x, q.y, q.z, q.w)))
    goal = tft.concatenate_matrices(base_T_object, tft.translation_matrix(offset))
    return Pose(Point(*tft.translation_from_matrix(goal)), Quaternion(*tft.quaternion_from_matrix(goal)))
