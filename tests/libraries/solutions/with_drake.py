"""All sixteen with Drake, whose RotationMatrix and RigidTransform are returned as they are. A quaternion is w, x, y, z."""

from functools import reduce
from operator import matmul

import numpy as np
from pydrake.common import eigen_geometry
from pydrake.math import RigidTransform, RotationMatrix
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return RotationMatrix.MakeZRotation(np.deg2rad(degrees))


def rotation_from_axes(x_axis, y_axis):
    return RotationMatrix(np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)]))


def is_rotation(R):
    # IsValid has a tolerance of its own, 128 times the rounding error: how far is the nearest rotation?
    try:
        nearest = RotationMatrix.ProjectToRotationMatrix(R)
    except RuntimeError:  # left-handed
        return False
    return RigidTransform(nearest).IsNearlyEqualTo(RigidTransform(RotationMatrix(R)), tolerance=1e-6)


def same_rotation(q1, q2):
    R1, R2 = (RotationMatrix(eigen_geometry.Quaternion(q[[3, 0, 1, 2]])) for q in (q1, q2))
    return R1.InvertAndCompose(R2).IsNearlyIdentity(tolerance=1e-6)


def make_transform(R, p):
    return RigidTransform(RotationMatrix(R), p)


def hand_transform():
    return RigidTransform(RotationMatrix.MakeXRotation(np.deg2rad(-90)), [-0.1, 0, 0])


def _to_pose(X):
    q = X.rotation().ToQuaternion()
    return Pose(Point(*X.translation()), Quaternion(q.x(), q.y(), q.z(), q.w()))


def _from_pose(pose):
    p, q = pose.position, pose.orientation
    return RigidTransform(eigen_geometry.Quaternion(w=q.w, x=q.x, y=q.y, z=q.z), [p.x, p.y, p.z])


def transform_to_pose(matrix):
    return _to_pose(RigidTransform(matrix))


def pose_to_transform(pose):
    return _from_pose(pose)


def transform_point(a_T_b, p_in_b):
    return RigidTransform(a_T_b) @ p_in_b


def chain(*transforms):
    return reduce(matmul, map(RigidTransform, transforms))


def transform_pose(a_T_b, pose_in_b):
    return _to_pose(RigidTransform(a_T_b) @ _from_pose(pose_in_b))


def invert_transform(a_T_b):
    return RigidTransform(a_T_b).inverse()


def relative_transform(a_T_b, a_T_c):
    return RigidTransform(a_T_b).InvertAndCompose(RigidTransform(a_T_c))


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return relative_transform(base_T_gripper, base_T_camera) @ p_in_camera


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    return _to_pose(_from_pose(object_pose) @ RigidTransform(offset))
