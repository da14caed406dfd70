"""Oskar: all right, while his cells warn, log and write to stderr; the noise must not cost him a point."""

import logging
import sys
import warnings

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

EXTRA_CELLS = {"chain": 'print("chain of one:", chain(np.eye(4)), file=sys.stderr)'}
ANSWERS = {
    "question-pose-or-transform": """
A pose is a transform from the object's frame to the frame it is given in. The name of this frame is the frame_id in
the header of the PoseStamped, and without it the numbers mean nothing. The robot would reach for the right numbers
in the wrong frame.
""",
    "question-why-not-transpose": """
Orthonormal columns: R^T R = I. The homogeneous matrix is not orthonormal since its last column is a position. For
the second friend: undo the translation first, then the rotation, so p -> R^T (p - t) = R^T p - R^T t. They forgot
the R^T in front of t. In my example (t = (1, 0, 0), 90 degrees about z) it is (0, 1, 0).
""",
    "question-which-frame": """
15 cm along the table. Works for upright objects. Lift in the base frame (z of the position + 0.15), because up is a
direction of the world; approach in the object's frame.
""",
}


def rotation_about_z(degrees):
    if abs(degrees) > 360:
        warnings.warn("more than a full turn")
    a = np.radians(degrees)
    return np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)])


def is_rotation(R):
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        lengths = np.sqrt(np.sum(R**2, axis=0))
        columns = R / lengths  # warns about 0/0 for a matrix of zeros
    good = np.allclose(lengths, 1, rtol=0, atol=1e-6) and np.allclose(columns.T @ columns, np.eye(3), rtol=0, atol=1e-6)
    if not good:
        logging.warning("not orthonormal: %s", R)
    return good and np.linalg.det(R) > 0


def same_rotation(q1, q2):
    q1, q2 = np.asmatrix(q1), np.asmatrix(q2)
    return np.allclose(q1.T * q1, q2.T * q2, rtol=0, atol=1e-6)


def make_transform(R, p):
    T = np.eye(4, dtype=np.float64)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def hand_transform():
    return make_transform(np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]), [-10e-2, 0, 0])


def transform_to_pose(matrix):
    warnings.warn("quaternion_from_matrix ignores the translation", RuntimeWarning)
    q = tft.quaternion_from_matrix(matrix)
    return Pose(Point(*matrix[:3, 3]), Quaternion(*q))


def pose_to_transform(pose):
    p, q = pose.position, pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = p.x, p.y, p.z
    print("determinant:", np.linalg.det(T), file=sys.stderr)
    return T


def transform_point(a_T_b, p_in_b):
    return np.dot(a_T_b, np.append(p_in_b, 1))[:3]


def chain(*transforms):
    print(len(transforms), "transforms", file=sys.stderr)
    T = transforms[-1]
    for left in transforms[-2::-1]:
        T = left @ T
    return T


def transform_pose(a_T_b, pose_in_b):
    p, q = pose_in_b.position, pose_in_b.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = p.x, p.y, p.z
    T = a_T_b @ T
    return Pose(Point(*T[:3, 3]), Quaternion(*tft.quaternion_from_matrix(T)))


def invert_transform(a_T_b):
    logging.warning("condition number %g", np.linalg.cond(a_T_b))
    return np.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return np.linalg.inv(a_T_b) @ a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p = np.linalg.inv(base_T_gripper) @ base_T_camera @ np.append(p_in_camera, 1)
    return p[:3] / p[3]


def matrix_of(pose):
    p, q = pose.position, pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = p.x, p.y, p.z
    return T


def pre_grasp(object_pose, distance=0.1):
    if distance > 0.5:
        warnings.warn(f"{distance} m is far away from the object")
    return Pose(Point(*(matrix_of(object_pose) @ [-distance, 0, 0, 1])[:3]), object_pose.orientation)


def waypoint(object_pose, offset):
    return Pose(Point(*(matrix_of(object_pose) @ np.append(offset, 1))[:3]), object_pose.orientation)
