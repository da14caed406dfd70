"""Hana: multiplies rotations and adds translations, each by themselves, wherever two frames meet."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
The pose of the cup describes the cup's frame in another frame, and this is what a transform does as well. The
missing thing is the other frame. It is in header.frame_id. If I guess base_link and it was camera_link then the
gripper will go to a point that has nothing to do with the cup.
""",
    "question-why-not-transpose": """
Transposing a rotation exchanges rows and columns, which turns it the other way. It does not work for the 4x4 matrix
because the translation moves to the bottom row. I think the second friend is right, because going back means the
opposite translation.
""",
    "question-which-frame": """
The gripper goes in the direction of the bottle's z axis, and because the bottle is lying this is not up. It would
have worked for standing objects. For the lift one has to use the base frame.
""",
}


def rotation_about_z(degrees):
    a = np.radians(degrees)
    R = np.eye(3)
    R[0, 0] = R[1, 1] = np.cos(a)
    R[1, 0] = np.sin(a)
    R[0, 1] = -np.sin(a)
    return R


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)])


def is_rotation(R):
    return np.allclose(R.T @ R, np.eye(3), atol=1e-6)


def same_rotation(q1, q2):
    return np.allclose(q1, q2, atol=1e-6) or np.allclose(q1, -q2, atol=1e-6)


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def hand_transform():
    return np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])


def transform_to_pose(matrix):
    return Pose(Point(*matrix[:3, 3]), Quaternion(*tft.quaternion_from_matrix(matrix)))


def pose_to_transform(pose):
    p, q = pose.position, pose.orientation
    return make_transform(tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3], [p.x, p.y, p.z])


def transform_point(a_T_b, p_in_b):
    return p_in_b + a_T_b[:3, 3]


def chain(*transforms):
    R = np.eye(3)
    p = np.zeros(3)
    for T in transforms:
        R = R @ T[:3, :3]
        p = p + T[:3, 3]
    result = np.eye(4)
    result[:3, :3] = R
    result[:3, 3] = p
    return result


def transform_pose(a_T_b, pose_in_b):
    p, q = pose_in_b.position, pose_in_b.orientation
    x, y, z = a_T_b[:3, 3] + [p.x, p.y, p.z]
    turned = tft.quaternion_multiply(tft.quaternion_from_matrix(a_T_b), [q.x, q.y, q.z, q.w])
    return Pose(Point(x, y, z), Quaternion(*turned))


def invert_transform(a_T_b):
    b_T_a = np.eye(4)
    b_T_a[:3, :3] = a_T_b[:3, :3].T
    b_T_a[:3, 3] = -a_T_b[:3, 3]
    return b_T_a


def relative_transform(a_T_b, a_T_c):
    b_T_c = np.eye(4)
    b_T_c[:3, :3] = a_T_b[:3, :3].T @ a_T_c[:3, :3]
    b_T_c[:3, 3] = a_T_c[:3, 3] - a_T_b[:3, 3]
    return b_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p_in_base = base_T_camera[:3, :3] @ p_in_camera + base_T_camera[:3, 3]
    return p_in_base - base_T_gripper[:3, 3]


def pre_grasp(object_pose, distance=0.1):
    p, q = object_pose.position, object_pose.orientation
    return Pose(Point(p.x - distance, p.y, p.z), Quaternion(q.x, q.y, q.z, q.w))


def waypoint(object_pose, offset):
    p, q = object_pose.position, object_pose.orientation
    x, y, z = np.array([p.x, p.y, p.z]) + offset
    return Pose(Point(x, y, z), Quaternion(q.x, q.y, q.z, q.w))
