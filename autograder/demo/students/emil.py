"""Emil: reads the rows of a rotation as its axes, and so transposes; "inverts" every transform by transposing it."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
They are the same thing in two formats. I need to know the frame_id in the header. If it is wrong the robot misses
the cup.
""",
    "question-why-not-transpose": """
The transpose of an orthogonal matrix is its inverse, because the lengths are 1. For the 4x4 it works as well as
long as the rotation is correct. The second one should not put the minus.
""",
    "question-which-frame": """
The gripper moves along the bottle's z axis, which is horizontal now. It works only if the bottle stands. The lift
should be done in base_link.
""",
}


def rotation_about_z(degrees):
    t = np.radians(degrees)
    x_axis = [np.cos(t), np.sin(t), 0]
    y_axis = [-np.sin(t), np.cos(t), 0]
    z_axis = [0, 0, 1]
    return np.array([x_axis, y_axis, z_axis])


def rotation_from_axes(x_axis, y_axis):
    return np.array([x_axis, y_axis, np.cross(x_axis, y_axis)])


def is_rotation(R):
    return np.allclose(R.T.dot(R), np.eye(3), atol=1e-6, rtol=0) and np.linalg.det(R) > 0


def same_rotation(q1, q2):
    return abs(abs(np.dot(q1, q2)) - 1) < 1e-9


def make_transform(R, p):
    T = np.zeros((4, 4))
    T[:3, :3] = R
    T[:3, 3] = p
    T[3, 3] = 1
    return T


def hand_transform():
    x_axis = [1, 0, 0]
    y_axis = [0, 0, -1]
    z_axis = [0, 1, 0]
    T = np.eye(4)
    T[:3, :3] = np.array([x_axis, y_axis, z_axis])
    T[:3, 3] = [-0.1, 0, 0]
    return T


def transform_to_pose(matrix):
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = matrix[:3, 3]
    o = pose.orientation
    o.x, o.y, o.z, o.w = tft.quaternion_from_matrix(matrix)
    return pose


def pose_to_transform(pose):
    p, o = pose.position, pose.orientation
    T = tft.quaternion_matrix([o.x, o.y, o.z, o.w])
    T[:3, 3] = p.x, p.y, p.z
    return T


def transform_point(a_T_b, p_in_b):
    x, y, z, one = np.dot(a_T_b, [p_in_b[0], p_in_b[1], p_in_b[2], 1])
    return np.array([x, y, z])


def chain(*transforms):
    T = np.eye(4)
    for t in transforms:
        T = T.dot(t)
    return T


def transform_pose(a_T_b, pose_in_b):
    p, o = pose_in_b.position, pose_in_b.orientation
    b_T_c = tft.quaternion_matrix([o.x, o.y, o.z, o.w])
    b_T_c[:3, 3] = p.x, p.y, p.z
    a_T_c = a_T_b.dot(b_T_c)
    result = Pose(position=Point(*a_T_c[:3, 3]))
    result.orientation = Quaternion(*tft.quaternion_from_matrix(a_T_c))
    return result


def invert_transform(a_T_b):
    return a_T_b.T


def relative_transform(a_T_b, a_T_c):
    return a_T_b.T.dot(a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p = np.append(p_in_camera, 1)
    return base_T_gripper.T.dot(base_T_camera).dot(p)[:3]


def pre_grasp(object_pose, distance=0.1):
    p, o = object_pose.position, object_pose.orientation
    R = tft.quaternion_matrix([o.x, o.y, o.z, o.w])[:3, :3]
    x_axis = R[0]
    x, y, z = np.array([p.x, p.y, p.z]) - distance * x_axis
    return Pose(Point(x, y, z), o)


def waypoint(object_pose, offset):
    p, o = object_pose.position, object_pose.orientation
    T = tft.quaternion_matrix([o.x, o.y, o.z, o.w])
    T[:3, 3] = p.x, p.y, p.z
    goal = T.dot(np.append(offset, 1))
    return Pose(Point(*goal[:3]), o)
