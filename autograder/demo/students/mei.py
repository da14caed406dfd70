"""Mei: in notebook 3 a helper calls her function of notebook 2, which is not there; moves the caller's pose with -=."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
A transform and a pose have the same information. To grasp I need to know the reference frame of the pose, which is
in the header of PoseStamped as frame_id. If I get it wrong the robot moves to a wrong position and may break
something.
""",
    "question-why-not-transpose": """
Because for a rotation the columns are orthonormal: R.T @ R is I. With a translation the transpose has numbers in
the bottom row. The translation must be turned too, it should be -R.T @ p. Example: rotate by 180 degrees about z
and move 1 m forward, then the inverse moves 1 m forward as well, and not back.
""",
    "question-which-frame": """
Sideways instead of up. It works for objects which stand upright. I would lift in the base frame and approach in the
object frame, because gravity is fixed to the world and the grasp is fixed to the object.
""",
}


def rotation_about_z(degrees):
    th = np.deg2rad(degrees)
    return np.array([[np.cos(th), -np.sin(th), 0], [np.sin(th), np.cos(th), 0], [0, 0, 1]])


def rotation_from_axes(x_axis, y_axis):
    return np.c_[x_axis, y_axis, np.cross(x_axis, y_axis)]


def is_rotation(R):
    return bool(np.linalg.norm(R.T @ R - np.eye(3)) < 1e-6 and np.linalg.det(R) > 0)


def same_rotation(q1, q2):
    return bool(np.allclose(q1, q2, atol=1e-6) or np.allclose(q1, -q2, atol=1e-6))


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def hand_transform():
    return make_transform(np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]), np.array([0.1, 0, 0]))


def transform_to_pose(matrix):
    pose = Pose()
    pose.position = Point(*matrix[:3, 3])
    pose.orientation = Quaternion(*tft.quaternion_from_matrix(matrix))
    return pose


def pose_to_transform(pose):
    q = [pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w]
    p = [pose.position.x, pose.position.y, pose.position.z]
    return make_transform(tft.quaternion_matrix(q)[:3, :3], p)


def transform_point(a_T_b, p_in_b):
    return (a_T_b @ np.r_[p_in_b, 1])[:3]


def chain(*transforms):
    return tft.concatenate_matrices(*transforms)


def in_frame_a(a_T_b, pose_in_b):
    return a_T_b @ pose_to_transform(pose_in_b)


def transform_pose(a_T_b, pose_in_b):
    a_T_c = in_frame_a(a_T_b, pose_in_b)
    return Pose(Point(*a_T_c[:3, 3]), Quaternion(*tft.quaternion_from_matrix(a_T_c)))


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    # b_T_c: C comes first, then B
    return np.linalg.inv(a_T_c) @ a_T_b


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return (np.linalg.inv(base_T_gripper) @ base_T_camera @ np.r_[p_in_camera, 1])[:3]


def pre_grasp(object_pose, distance=0.1):
    q = object_pose.orientation
    x_axis = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, 0]
    object_pose.position.x -= distance * x_axis[0]
    object_pose.position.y -= distance * x_axis[1]
    object_pose.position.z -= distance * x_axis[2]
    return object_pose


def waypoint(object_pose, offset):
    q, p = object_pose.orientation, object_pose.position
    moved = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3] @ offset
    return Pose(Point(p.x + moved[0], p.y + moved[1], p.z + moved[2]), Quaternion(q.x, q.y, q.z, q.w))
