"""All sixteen with jaxlie, whose SO3 and SE3 are returned as they are. Without 64 bits, float32 is not good enough for 1e-6."""

from functools import reduce
from operator import matmul

import jax
import jax.numpy as jnp
from jaxlie import SE3, SO3
from transform_lab import Point, Pose, Quaternion

jax.config.update("jax_enable_x64", True)


def rotation_about_z(degrees):
    return SO3.from_z_radians(jnp.deg2rad(degrees))


def rotation_from_axes(x_axis, y_axis):
    return SO3.from_matrix(jnp.column_stack([x_axis, y_axis, jnp.cross(x_axis, y_axis)]))


def is_rotation(R):
    # from_matrix makes something of any matrix: is it what was given?
    return jnp.allclose(SO3.from_matrix(jnp.asarray(R)).as_matrix(), R, rtol=0, atol=1e-6)


def same_rotation(q1, q2):
    one, other = (SO3.from_quaternion_xyzw(jnp.asarray(q, dtype=float)) for q in (q1, q2))
    return jnp.linalg.norm((one.inverse() @ other).log()) < 1e-6


def make_transform(R, p):
    return SE3.from_rotation_and_translation(SO3.from_matrix(jnp.asarray(R)), jnp.asarray(p, dtype=float))


def hand_transform():
    return SE3.from_rotation_and_translation(SO3.from_x_radians(-jnp.pi / 2), jnp.array([-0.1, 0, 0]))


def _to_pose(transform):
    return Pose(Point(*transform.translation()), Quaternion(*transform.rotation().as_quaternion_xyzw()))


def _from_pose(pose):
    p, q = pose.position, pose.orientation
    rotation = SO3.from_quaternion_xyzw(jnp.array([q.x, q.y, q.z, q.w], dtype=float))
    return SE3.from_rotation_and_translation(rotation, jnp.array([p.x, p.y, p.z], dtype=float))


def _se3(matrix):
    return SE3.from_matrix(jnp.asarray(matrix, dtype=float))


def transform_to_pose(matrix):
    return _to_pose(_se3(matrix))


def pose_to_transform(pose):
    return _from_pose(pose)


def transform_point(a_T_b, p_in_b):
    return _se3(a_T_b) @ jnp.asarray(p_in_b)


def chain(*transforms):
    return reduce(matmul, map(_se3, transforms))


def transform_pose(a_T_b, pose_in_b):
    return _to_pose(_se3(a_T_b) @ _from_pose(pose_in_b))


def invert_transform(a_T_b):
    return _se3(a_T_b).inverse()


def relative_transform(a_T_b, a_T_c):
    return _se3(a_T_b).inverse() @ _se3(a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return _se3(base_T_gripper).inverse() @ _se3(base_T_camera) @ jnp.asarray(p_in_camera)


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, jnp.array([-distance, 0, 0]))


def waypoint(object_pose, offset):
    moved = SE3.from_rotation_and_translation(SO3.identity(), jnp.asarray(offset, dtype=float))
    return _to_pose(_from_pose(object_pose) @ moved)
