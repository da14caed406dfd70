"""Chloe: all right, and all in SciPy, with lists for answers and quaternions that may come out negated."""

import numpy as np
from scipy.spatial.transform import Rotation
from transform_lab import Point, Pose, Quaternion

ANSWERS = {
    "question-pose-or-transform": """
A Pose is the message form of a transform: position = translation, orientation = rotation. It is only half of the
story though, "in terms of what?" is missing, and that is `header.frame_id` in PoseStamped. With the wrong one the
numbers still look fine, but the arm reaches somewhere else, in the worst case through a person.
""",
    "question-why-not-transpose": """
Rotations: the rows of the transpose are the columns of R, so every entry of R^T R is a dot product of two axes.
These are 1 or 0. For the 4x4 matrix the dot product of the last column with itself is |p|^2 + 1, which is not 1
unless p = 0. The second friend's vector -p is the right arrow, told in A's axes. It has to be told in B's axes:
-R^T p. With B at (1, 0, 0) turned by 180 degrees about z, A is at (+1, 0, 0) in B and not at (-1, 0, 0).
""",
    "question-which-frame": """
It drags the bottle 15 cm along the table towards its cap. It would have worked for any object that stands. I would
add 0.15 to z of the pose in the base frame and leave the orientation. Approach: object frame, because the fingers
must fit the object. Lift: base frame, because gravity does not care how the object lies.
""",
}


def rotation_about_z(degrees):
    return Rotation.from_euler("z", degrees, degrees=True).as_matrix().tolist()


def rotation_from_axes(x_axis, y_axis):
    return np.array([x_axis, y_axis, np.cross(x_axis, y_axis)]).T


def is_rotation(R):
    # the singular values of an orthonormal matrix are all 1
    lengths = np.linalg.svd(R, compute_uv=False)
    return np.max(np.abs(lengths - 1)) < 1e-6 and np.linalg.det(R) > 0


def same_rotation(q1, q2):
    between = Rotation.from_quat(q1).inv() * Rotation.from_quat(q2)
    return between.magnitude() < 2e-6  # half of it is what the numbers differ by


def make_transform(R, p):
    return np.block([[np.asarray(R), np.asarray(p).reshape(3, 1)], [np.zeros((1, 3)), np.ones((1, 1))]])


def hand_transform():
    # rolling to the left is a turn about the index finger, clockwise seen from behind
    T = np.eye(4)
    T[:3, :3] = Rotation.from_euler("x", -90, degrees=True).as_matrix()
    T[:3, 3] = [-0.1, 0, 0]
    return T


def transform_to_pose(matrix):
    q = -Rotation.from_matrix(matrix[:3, :3]).as_quat()  # -q is the same orientation
    return Pose(position=Point(*matrix[:3, 3]), orientation=Quaternion(*q))


def pose_to_transform(pose):
    p, q = pose.position, pose.orientation
    R = Rotation.from_quat([q.x, q.y, q.z, q.w]).as_matrix()
    return [[*R[0], p.x], [*R[1], p.y], [*R[2], p.z], [0, 0, 0, 1]]


def transform_point(a_T_b, p_in_b):
    return (Rotation.from_matrix(a_T_b[:3, :3]).apply(p_in_b) + a_T_b[:3, 3]).tolist()


def chain(*transforms):
    return np.linalg.multi_dot([np.eye(4), np.eye(4), *transforms])


def transform_pose(a_T_b, pose_in_b):
    p, q = pose_in_b.position, pose_in_b.orientation
    a_R_b = Rotation.from_matrix(a_T_b[:3, :3])
    position = a_R_b.apply([p.x, p.y, p.z]) + a_T_b[:3, 3]
    orientation = (a_R_b * Rotation.from_quat([q.x, q.y, q.z, q.w])).as_quat()
    return Pose(Point(*position), Quaternion(*orientation))


def invert_transform(a_T_b):
    return np.linalg.solve(a_T_b, np.eye(4)).tolist()


def relative_transform(a_T_b, a_T_c):
    return np.linalg.solve(a_T_b, a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    p_in_base = base_T_camera @ [*p_in_camera, 1]
    return tuple(np.linalg.solve(base_T_gripper, p_in_base)[:3])


def moved(object_pose, offset):
    p, q = object_pose.position, object_pose.orientation
    step = Rotation.from_quat([q.x, q.y, q.z, q.w]).apply(offset)
    return Pose(Point(p.x + step[0], p.y + step[1], p.z + step[2]), Quaternion(-q.x, -q.y, -q.z, -q.w))


def pre_grasp(object_pose, distance=0.1):
    return moved(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    return moved(object_pose, offset)
