"""All sixteen with spatialmath, whose SO3 and SE3 are returned as they are. Its quaternions are s, x, y, z."""

from functools import reduce
from operator import mul

import numpy as np
from spatialmath import SE3, SO3, UnitQuaternion
from spatialmath.base import isrot
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return SO3.Rz(degrees, unit="deg")


def rotation_from_axes(x_axis, y_axis):
    return SO3.TwoVectors(x=x_axis, y=y_axis)


def is_rotation(R):
    return isrot(R, check=True, tol=1e-6 / np.finfo(float).eps)  # which is told in units of eps


def same_rotation(q1, q2):
    one, other = (UnitQuaternion(q[3], q[:3]) for q in (q1, q2))
    return one.angdist(other) < 1e-6


def make_transform(R, p):
    return SE3.Rt(R, p)


def hand_transform():
    return SE3.Trans(-0.1, 0, 0) * SE3.Rx(-90, unit="deg")


def _to_pose(transform):
    return Pose(Point(*transform.t), Quaternion(*UnitQuaternion(transform).vec_xyzs))


def _from_pose(pose):
    p, q = pose.position, pose.orientation
    return SE3.Rt(UnitQuaternion(q.w, [q.x, q.y, q.z]).SO3(), [p.x, p.y, p.z])


def transform_to_pose(matrix):
    return _to_pose(SE3(matrix))


def pose_to_transform(pose):
    return _from_pose(pose)


def transform_point(a_T_b, p_in_b):
    return SE3(a_T_b) * p_in_b


def chain(*transforms):
    return reduce(mul, map(SE3, transforms))


def transform_pose(a_T_b, pose_in_b):
    return _to_pose(SE3(a_T_b) * _from_pose(pose_in_b))


def invert_transform(a_T_b):
    return SE3(a_T_b).inv()


def relative_transform(a_T_b, a_T_c):
    return SE3(a_T_b).inv() * SE3(a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return SE3(base_T_gripper).inv() * SE3(base_T_camera) * p_in_camera


def pre_grasp(object_pose, distance=0.1):
    return _to_pose(_from_pose(object_pose) * SE3.Tx(-distance))


def waypoint(object_pose, offset):
    return _to_pose(_from_pose(object_pose) * SE3.Trans(offset))
