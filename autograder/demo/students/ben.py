"""Ben: knows rotations and chains well, but moves waypoints along the base's axes instead of the object's."""

import numpy as np
from transform_lab import Point, Pose, Quaternion, tft

ANSWERS = {
    "question-pose-or-transform": """
Both have a position and an orientation so you can convert between them, e.g. with tft. You still need to know the
frame_id from the PoseStamped header, because a pose in camera_link is not the same as a pose in base_link and the
robot would grasp at the wrong place.
""",
    "question-why-not-transpose": """
R is orthonormal so R.T R = I and the transpose is the inverse. A 4x4 transform is not orthonormal because of the
translation. The second one has to rotate the translation as well, -R.T p, because it has to be expressed in frame
B. For example a frame rotated by 90 degrees about z at (1,0,0) has the inverse translation (0,1,0).
""",
    "question-which-frame": """
It should lift the bottle by 15 cm, because z is up. For other objects it works the same way. I would use the base
frame for both since the robot knows where its base is.
""",
}


def rotation_about_z(degrees):
    a = np.deg2rad(degrees)
    return np.array([[np.cos(a), -np.sin(a), 0.0], [np.sin(a), np.cos(a), 0.0], [0.0, 0.0, 1.0]])


def rotation_from_axes(x_axis, y_axis):
    R = np.zeros((3, 3))
    R[:, 0] = x_axis
    R[:, 1] = y_axis
    R[:, 2] = np.cross(x_axis, y_axis)
    return R


def is_rotation(R):
    if abs(np.linalg.det(R) - 1) > 1e-6:
        return False
    return np.abs(R @ R.T - np.eye(3)).max() < 1e-6


def same_rotation(q1, q2):
    return bool(np.all(np.abs(q1 - q2) < 1e-6) or np.all(np.abs(q1 + q2) < 1e-6))


def make_transform(R, p):
    top = np.hstack([R, np.reshape(p, (3, 1))])
    return np.vstack([top, [0, 0, 0, 1]])


def hand_transform():
    T = np.eye(4)
    T[:3, 0] = [1, 0, 0]
    T[:3, 1] = [0, 0, -1]
    T[:3, 2] = [0, 1, 0]
    T[0, 3] = -0.10
    return T


def transform_to_pose(matrix):
    pose = Pose()
    pose.position.x = matrix[0, 3]
    pose.position.y = matrix[1, 3]
    pose.position.z = matrix[2, 3]
    q = tft.quaternion_from_matrix(matrix)
    pose.orientation.x = q[0]
    pose.orientation.y = q[1]
    pose.orientation.z = q[2]
    pose.orientation.w = q[3]
    return pose


def pose_to_transform(pose):
    o, p = pose.orientation, pose.position
    T = tft.translation_matrix([p.x, p.y, p.z])
    return T @ tft.quaternion_matrix([o.x, o.y, o.z, o.w])


def transform_point(a_T_b, p_in_b):
    return a_T_b[:3, :3] @ p_in_b + a_T_b[:3, 3]


def chain(*transforms):
    result = transforms[0]
    for transform in transforms[1:]:
        result = np.dot(result, transform)
    return result


def transform_pose(a_T_b, pose_in_b):
    o, p = pose_in_b.orientation, pose_in_b.position
    b_T_c = tft.translation_matrix([p.x, p.y, p.z]) @ tft.quaternion_matrix([o.x, o.y, o.z, o.w])
    a_T_c = a_T_b @ b_T_c
    x, y, z, w = tft.quaternion_from_matrix(a_T_c)
    return Pose(Point(a_T_c[0, 3], a_T_c[1, 3], a_T_c[2, 3]), Quaternion(x, y, z, w))


def invert_transform(a_T_b):
    R, p = a_T_b[:3, :3], a_T_b[:3, 3]
    b_T_a = np.eye(4)
    b_T_a[:3, :3] = R.T
    b_T_a[:3, 3] = -R.T @ p
    return b_T_a


def relative_transform(a_T_b, a_T_c):
    return invert_transform(a_T_b) @ a_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p = np.append(p_in_camera, 1)
    return (invert_transform(base_T_gripper) @ base_T_camera @ p)[:3]


def pre_grasp(object_pose, distance=0.1):
    # 10 cm closer to the robot, same orientation
    p, q = object_pose.position, object_pose.orientation
    return Pose(Point(p.x - distance, p.y, p.z), Quaternion(q.x, q.y, q.z, q.w))


def waypoint(object_pose, offset):
    p, q = object_pose.position, object_pose.orientation
    return Pose(Point(p.x + offset[0], p.y + offset[1], p.z + offset[2]), Quaternion(q.x, q.y, q.z, q.w))
