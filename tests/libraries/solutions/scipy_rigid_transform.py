"""All sixteen with SciPy's RigidTransform, which is returned as it is."""

from functools import reduce
from operator import mul

import numpy as np
from scipy.spatial.transform import RigidTransform, Rotation
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return Rotation.from_rotvec([0, 0, degrees], degrees=True)


def rotation_from_axes(x_axis, y_axis):
    # align_vectors finds the rotation that takes A's axes to where B's are
    rotation, _ = Rotation.align_vectors([x_axis, y_axis], [[1, 0, 0], [0, 1, 0]])
    return rotation


def is_rotation(R):
    # from_matrix makes the rotation orthogonal without a word: is it the one that was given?
    T = np.eye(4)
    T[:3, :3] = R
    try:
        nearest = RigidTransform.from_matrix(T)
    except ValueError:  # left-handed, or singular
        return False
    return np.allclose(nearest.as_matrix(), T, rtol=0, atol=1e-6)


def same_rotation(q1, q2):
    return (Rotation.from_quat(q1).inv() * Rotation.from_quat(q2)).magnitude() <= 1e-6


def make_transform(R, p):
    return RigidTransform.from_components(p, Rotation.from_matrix(R))


def hand_transform():
    return RigidTransform.from_components([-0.1, 0, 0], Rotation.from_euler("x", -90, degrees=True))


def _to_pose(transform):
    p, R = transform.as_components()
    return Pose(Point(*p), Quaternion(*R.as_quat()))


def _from_pose(pose):
    p, q = pose.position, pose.orientation
    return RigidTransform.from_components([p.x, p.y, p.z], Rotation.from_quat([q.x, q.y, q.z, q.w]))


def transform_to_pose(matrix):
    return _to_pose(RigidTransform.from_matrix(matrix))


def pose_to_transform(pose):
    return _from_pose(pose)


def transform_point(a_T_b, p_in_b):
    return RigidTransform.from_matrix(a_T_b).apply(p_in_b)


def chain(*transforms):
    return reduce(mul, map(RigidTransform.from_matrix, transforms))


def transform_pose(a_T_b, pose_in_b):
    return _to_pose(RigidTransform.from_matrix(a_T_b) * _from_pose(pose_in_b))


def invert_transform(a_T_b):
    return RigidTransform.from_matrix(a_T_b).inv()


def relative_transform(a_T_b, a_T_c):
    return RigidTransform.from_matrix(a_T_b).inv() * RigidTransform.from_matrix(a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return relative_transform(base_T_gripper, base_T_camera).apply(p_in_camera)


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    return _to_pose(_from_pose(object_pose) * RigidTransform.from_translation(offset))
