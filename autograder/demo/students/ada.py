"""Ada: reads everything, does everything, gets everything right, and in the way that the notebooks suggest."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
A pose is a position and an orientation, a transform is a translation and a rotation, and these are the same seven
facts: the position is the origin of the cup's frame and the quaternion says where its axes point. I can compute one
from the other in both directions.

What my colleague forgot is in which frame the numbers are. ROS puts the name into the header of a PoseStamped, in
frame_id. If they are the camera's numbers and I use them in base_link, then the arm goes somewhere else entirely,
perhaps through the table, and no program will complain about it.
""",
    "question-why-not-transpose": """
The columns of R have length 1 and are at right angles, so R.T @ R is the identity and the transpose undoes R. The
4x4 matrix has a place in its last column, which is not an axis. If I transpose, the place goes to the bottom row,
where 0 0 0 1 must be.

The second friend has the right vector but along the wrong axes. It must be -R.T @ p. If B is 2 m in front of me and
looks to the left, then I am 2 m to B's LEFT (y = 2). Minus p would claim that I am behind B.
""",
    "question-which-frame": """
The z axis of the bottle is level, so 15 cm along z of the bottle is 15 cm sideways over the table. It works for all
objects that stand upright, because their z is the same as the base's z. To lift anything I would keep the
orientation and add 0.15 to position.z in the base frame. The approach belongs to the object (it depends on how it
lies), so there the object's frame is right. "Up" belongs to the world, so there the base frame is right.
""",
}


def rotation_about_z(degrees):
    angle = np.radians(degrees)
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0],
                     [s, c, 0],
                     [0, 0, 1]])


def rotation_from_axes(x_axis, y_axis):
    z_axis = np.cross(x_axis, y_axis)
    return np.column_stack([x_axis, y_axis, z_axis])


def is_rotation(R):
    orthonormal = np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-6)
    return orthonormal and np.isclose(np.linalg.det(R), 1, rtol=0, atol=1e-6)


def same_rotation(q1, q2):
    same = np.allclose(q1, q2, rtol=0, atol=1e-6)
    negated = np.allclose(q1, -q2, rtol=0, atol=1e-6)
    return same or negated


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def hand_transform():
    # index finger stays, middle finger points down, thumb points left
    return np.array([[1, 0, 0, -0.1],
                     [0, 0, 1, 0],
                     [0, -1, 0, 0],
                     [0, 0, 0, 1]])


def transform_to_pose(matrix):
    pose = Pose()
    pose.position = Point(*matrix[:3, 3])
    pose.orientation = Quaternion(*tft.quaternion_from_matrix(matrix))
    return pose


def pose_to_transform(pose):
    q = pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [pose.position.x, pose.position.y, pose.position.z]
    return T


def transform_point(a_T_b, p_in_b):
    p_in_a = a_T_b @ np.append(p_in_b, 1)
    return p_in_a[:3]


def chain(*transforms):
    product = np.eye(4)
    for T in transforms:
        product = product @ T
    return product


def matrix_of(pose):
    q, p = pose.orientation, pose.position
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [p.x, p.y, p.z]
    return T


def pose_of(T):
    return Pose(Point(*T[:3, 3]), Quaternion(*tft.quaternion_from_matrix(T)))


def transform_pose(a_T_b, pose_in_b):
    return pose_of(a_T_b @ matrix_of(pose_in_b))


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    b_T_a = np.linalg.inv(a_T_b)
    return b_T_a @ a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    gripper_T_camera = np.linalg.inv(base_T_gripper) @ base_T_camera
    return (gripper_T_camera @ np.append(p_in_camera, 1))[:3]


def pre_grasp(object_pose, distance=0.1):
    object_T_pre_grasp = np.eye(4)
    object_T_pre_grasp[0, 3] = -distance
    return pose_of(matrix_of(object_pose) @ object_T_pre_grasp)


def waypoint(object_pose, offset):
    object_T_waypoint = np.eye(4)
    object_T_waypoint[:3, 3] = offset
    return pose_of(matrix_of(object_pose) @ object_T_waypoint)
