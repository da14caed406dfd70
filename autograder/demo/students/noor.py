"""Noor: prints everything and draws a picture. Takes objects to be upright, and a difference of places for a place."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

EXTRA_CELLS = {
    "rotation_about_z": """
for degrees in range(0, 360, 5):
    R = rotation_about_z(degrees)
    print("degrees =", degrees)
    print(R.round(3))
    print("R.T @ R =")
    print((R.T @ R).round(3))
""",
    "rotation_from_axes": """
import matplotlib.pyplot as plt

angles = np.arange(0, 361, 5)
plt.figure(figsize=(5, 3))
plt.plot(angles, [rotation_about_z(a)[0, 0] for a in angles], label="x of B's x axis")
plt.plot(angles, [rotation_about_z(a)[1, 0] for a in angles], label="y of B's x axis")
plt.xlabel("degrees")
plt.legend()
plt.show()
""",
}
ANSWERS = {
    "question-pose-or-transform": """
They hold the same, the position is the last column and the quaternion is the rotation. The frame is missing! It's
in header.frame_id. If I assume the wrong frame, the gripper goes to a wrong place.
""",
    "question-why-not-transpose": """
I printed it: R.T @ R is always the identity, because the columns have length 1 and are perpendicular. T.T @ T is
not the identity, there is p in the last row. And for the second friend I printed it too: T_inv @ T has the identity
in the rotation but not in the translation. It must be -R.T @ p.
""",
    "question-which-frame": """
It moves in the direction of the bottle's z axis, so to the side. It would have worked if the bottle was standing.
Lift: base frame, approach: object frame.
""",
}


def rotation_about_z(degrees):
    angle = np.radians(degrees)
    R = np.array([[np.cos(angle), -np.sin(angle), 0],
                  [np.sin(angle), np.cos(angle), 0],
                  [0, 0, 1]])
    print("rotation_about_z", degrees, R)
    return R


def rotation_from_axes(x_axis, y_axis):
    z_axis = np.cross(x_axis, y_axis)
    print("z_axis:", z_axis)
    return np.column_stack([x_axis, y_axis, z_axis])


def is_rotation(R):
    print("R.T @ R:", R.T @ R)
    print("det:", np.linalg.det(R))
    return np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-6) and np.isclose(np.linalg.det(R), 1)


def same_rotation(q1, q2):
    print(q1, q2)
    return np.allclose(q1, q2, rtol=0, atol=1e-6) or np.allclose(q1, -q2, rtol=0, atol=1e-6)


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    print("T =", T)
    return T


def hand_transform():
    T = np.array([[1, 0, 0, -0.1],
                  [0, 0, 1, 0],
                  [0, -1, 0, 0],
                  [0, 0, 0, 1]])
    print("hand:", T)
    return T


def transform_to_pose(matrix):
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = matrix[:3, 3]
    q = tft.quaternion_from_matrix(matrix)
    print("q =", q)
    pose.orientation = Quaternion(*q)
    print(pose)
    return pose


def pose_to_transform(pose):
    print(pose)
    q = pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [pose.position.x, pose.position.y, pose.position.z]
    print(T)
    return T


def transform_point(a_T_b, p_in_b):
    p_in_a = a_T_b @ np.append(p_in_b, 1)
    print(p_in_b, "->", p_in_a)
    return p_in_a[:3]


def chain(*transforms):
    T = np.eye(4)
    for i, transform in enumerate(transforms):
        T = T @ transform
        print("after", i + 1, "transforms:", T)
    return T


def transform_pose(a_T_b, pose_in_b):
    q, p = pose_in_b.orientation, pose_in_b.position
    b_T_c = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    b_T_c[:3, 3] = [p.x, p.y, p.z]
    a_T_c = a_T_b @ b_T_c
    print(a_T_c)
    return Pose(Point(*a_T_c[:3, 3]), Quaternion(*tft.quaternion_from_matrix(a_T_c)))


def invert_transform(a_T_b):
    b_T_a = np.linalg.inv(a_T_b)
    print("should be the identity:", a_T_b @ b_T_a)
    return b_T_a


def relative_transform(a_T_b, a_T_c):
    return np.linalg.inv(a_T_b) @ a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p_in_base = (base_T_camera @ np.append(p_in_camera, 1))[:3]
    gripper_in_base = base_T_gripper[:3, 3]
    print("object:", p_in_base, "gripper:", gripper_in_base)
    return p_in_base - gripper_in_base


def pre_grasp(object_pose, distance=0.1):
    p, q = object_pose.position, object_pose.orientation
    yaw = 2 * np.arctan2(q.z, q.w)
    print("yaw:", np.degrees(yaw))
    x = p.x - distance * np.cos(yaw)
    y = p.y - distance * np.sin(yaw)
    return Pose(Point(x, y, p.z), Quaternion(q.x, q.y, q.z, q.w))


def waypoint(object_pose, offset):
    p, q = object_pose.position, object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [p.x, p.y, p.z]
    goal = T @ np.append(offset, 1)
    print("goal:", goal)
    return Pose(Point(*goal[:3]), Quaternion(q.x, q.y, q.z, q.w))
