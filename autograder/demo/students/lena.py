"""Lena: a loop that never ends in `chain`, and a cross product the wrong way round; otherwise a good student."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
You can compute the 4x4 matrix from the pose and the pose from the matrix, so in this sense they are the same. The
colleague does not say in which frame the cup is at (1, 0, 0.5). In ROS this would be in header.frame_id. If it is
the camera's frame and I think it is the base's, I grasp into thin air or hit something.
""",
    "question-why-not-transpose": """
In R^T R each entry is a dot product of two columns, 1 on the diagonal and 0 elsewhere, so it is the identity. The
fourth column of T is a position, so this argument does not hold. The other friend: the translation of the inverse
is A's origin in B's axes, so -p must be rotated by R^T. For B at (1, 0, 0), facing left, it is (0, 1, 0).
""",
    "question-which-frame": """
It moves the bottle sideways. The z axis of the object has to be vertical for this program to work. Lifting is about
gravity, so add 0.15 to z in base_link, keeping the orientation. The approach is about the object, so use its frame.
""",
}


def rotation_about_z(degrees):
    c = np.cos(np.radians(degrees))
    s = np.sin(np.radians(degrees))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def rotation_from_axes(x_axis, y_axis):
    z_axis = np.cross(y_axis, x_axis)
    return np.column_stack([x_axis, y_axis, z_axis])


def is_rotation(R):
    return np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-6) and np.linalg.det(R) > 0.5


def same_rotation(q1, q2):
    return np.allclose(q1, q2, rtol=0, atol=1e-6) or np.allclose(q1, -q2, rtol=0, atol=1e-6)


def make_transform(R, p):
    T = np.eye(4)
    T[0:3, 0:3] = R
    T[0:3, 3] = p
    return T


def hand_transform():
    T = np.eye(4)
    T[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    T[0, 3] = -0.1
    return T


def transform_to_pose(matrix):
    x, y, z, w = tft.quaternion_from_matrix(matrix)
    return Pose(Point(matrix[0, 3], matrix[1, 3], matrix[2, 3]), Quaternion(x, y, z, w))


def pose_to_transform(pose):
    T = tft.quaternion_matrix([pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w])
    T[0, 3], T[1, 3], T[2, 3] = pose.position.x, pose.position.y, pose.position.z
    return T


def transform_point(a_T_b, p_in_b):
    return a_T_b.dot(np.append(p_in_b, 1))[:3]


def chain(*transforms):
    product = np.eye(4)
    i = 0
    while i < len(transforms):
        product = product @ transforms[i]
    return product


def transform_pose(a_T_b, pose_in_b):
    q, p = pose_in_b.orientation, pose_in_b.position
    b_T_c = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    b_T_c[:3, 3] = [p.x, p.y, p.z]
    a_T_c = a_T_b @ b_T_c
    return Pose(Point(*a_T_c[:3, 3]), Quaternion(*tft.quaternion_from_matrix(a_T_c)))


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return np.linalg.inv(a_T_b) @ a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p_in_base = base_T_camera @ np.append(p_in_camera, 1)
    return (np.linalg.inv(base_T_gripper) @ p_in_base)[:3]


def pre_grasp(object_pose, distance=0.1):
    q, p = object_pose.orientation, object_pose.position
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    behind = np.array([p.x, p.y, p.z]) - distance * T[:3, 0]
    return Pose(Point(*behind), q)


def waypoint(object_pose, offset):
    q, p = object_pose.orientation, object_pose.position
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    return Pose(Point(*(T[:3, :3] @ offset + [p.x, p.y, p.z])), q)
