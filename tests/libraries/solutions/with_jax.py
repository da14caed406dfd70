"""All sixteen with JAX, and returned as its arrays, numbers and Rotation. Without 64 bits, 1e-6 is too fine for float32."""

from functools import reduce

import jax
import jax.numpy as jnp
from jax.scipy.spatial.transform import Rotation
from transform_lab import Point, Pose, Quaternion

jax.config.update("jax_enable_x64", True)


# Traced once each: JAX's Rotation, called as it is, is traced anew with every call.
@jax.jit
def _about(axis, angle):
    return Rotation.from_rotvec(angle * axis)


@jax.jit
def _matrix(q):
    return Rotation.from_quat(q).as_matrix()


@jax.jit
def _product(q1, q2):
    return (Rotation.from_quat(q1) * Rotation.from_quat(q2)).as_quat()


@jax.jit
def _quaternion(R):
    return Rotation.from_matrix(R).as_quat()  # x, y, z, w


def rotation_about_z(degrees):
    return _about(jnp.array([0.0, 0.0, 1.0]), jnp.deg2rad(degrees))


def rotation_from_axes(x_axis, y_axis):
    x, y = jnp.asarray(x_axis), jnp.asarray(y_axis)
    return jnp.column_stack([x, y, jnp.cross(x, y)])


def is_rotation(R):
    R = jnp.asarray(R)
    return jnp.allclose(R.T @ R, jnp.eye(3), rtol=0, atol=1e-6) & (jnp.linalg.det(R) > 0)


def same_rotation(q1, q2):
    return jnp.minimum(jnp.linalg.norm(q1 - q2), jnp.linalg.norm(q1 + q2)) < 1e-6


def make_transform(R, p):
    return jnp.eye(4).at[:3, :3].set(R).at[:3, 3].set(p)


def hand_transform():
    return make_transform(_about(jnp.array([1.0, 0.0, 0.0]), -jnp.pi / 2).as_matrix(), jnp.array([-0.1, 0.0, 0.0]))


def _pose(p, q):
    return Pose(Point(*p), Quaternion(*q))


def _position(pose):
    p = pose.position
    return jnp.array([p.x, p.y, p.z], dtype=float)


def _orientation(pose):
    q = pose.orientation
    return jnp.array([q.x, q.y, q.z, q.w], dtype=float)


def transform_to_pose(matrix):
    T = jnp.asarray(matrix, dtype=float)
    return _pose(T[:3, 3], _quaternion(T[:3, :3]))


def pose_to_transform(pose):
    return make_transform(_matrix(_orientation(pose)), _position(pose))


def transform_point(a_T_b, p_in_b):
    return jnp.asarray(a_T_b)[:3] @ jnp.append(jnp.asarray(p_in_b), 1)


def chain(*transforms):
    return reduce(jnp.matmul, map(jnp.asarray, transforms))


def transform_pose(a_T_b, pose_in_b):
    q = _quaternion(jnp.asarray(a_T_b, dtype=float)[:3, :3])
    return _pose(transform_point(a_T_b, _position(pose_in_b)), _product(q, _orientation(pose_in_b)))


def invert_transform(a_T_b):
    return jnp.linalg.inv(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return jnp.linalg.solve(a_T_b, a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return transform_point(relative_transform(base_T_gripper, base_T_camera), p_in_camera)


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, jnp.array([-distance, 0, 0]))


def waypoint(object_pose, offset):
    q = _orientation(object_pose)
    return _pose(_position(object_pose) + _matrix(q) @ offset, q)
