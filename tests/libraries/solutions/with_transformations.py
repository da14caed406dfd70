"""All sixteen with Gohlke's transformations, of today: its quaternions are w, x, y, z; those of ROS's copy are x, y, z, w."""

import numpy as np
import transformations as tf
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return tf.rotation_matrix(np.radians(degrees), [0, 0, 1])[:3, :3]


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack([x_axis, y_axis, tf.vector_product(x_axis, y_axis)])


def is_rotation(R):
    # a rotation has no scale and no shear; a mirror image has a negative scale
    T = tf.identity_matrix()
    T[:3, :3] = R
    try:
        scale, shear, *_ = tf.decompose_matrix(T)
    except ValueError:  # singular
        return False
    return np.allclose(scale, 1, rtol=0, atol=1e-6) and np.allclose(shear, 0, rtol=0, atol=1e-6)


def same_rotation(q1, q2):
    # is_same_quaternion has a tolerance of its own
    return min(tf.vector_norm(q1 - q2), tf.vector_norm(q1 + q2)) < 1e-6


def make_transform(R, p):
    T = tf.translation_matrix(p)
    T[:3, :3] = R
    return T


def hand_transform():
    return tf.compose_matrix(angles=[np.radians(-90), 0, 0], translate=[-0.1, 0, 0])


def transform_to_pose(matrix):
    w, x, y, z = tf.quaternion_from_matrix(matrix)
    return Pose(Point(*tf.translation_from_matrix(matrix)), Quaternion(x, y, z, w))


def _wxyz(pose):
    q = pose.orientation
    return [q.w, q.x, q.y, q.z]


def pose_to_transform(pose):
    p = pose.position
    return tf.concatenate_matrices(tf.translation_matrix([p.x, p.y, p.z]), tf.quaternion_matrix(_wxyz(pose)))


def transform_point(a_T_b, p_in_b):
    return tf.translation_from_matrix(tf.concatenate_matrices(a_T_b, tf.translation_matrix(p_in_b)))


def chain(*transforms):
    return tf.concatenate_matrices(*transforms)


def transform_pose(a_T_b, pose_in_b):
    p = pose_in_b.position
    x, y, z = transform_point(a_T_b, [p.x, p.y, p.z])
    qw, qx, qy, qz = tf.quaternion_multiply(tf.quaternion_from_matrix(a_T_b), _wxyz(pose_in_b))
    return Pose(Point(x, y, z), Quaternion(qx, qy, qz, qw))


def invert_transform(a_T_b):
    return tf.inverse_matrix(a_T_b)


def relative_transform(a_T_b, a_T_c):
    return tf.concatenate_matrices(tf.inverse_matrix(a_T_b), a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return transform_point(relative_transform(base_T_gripper, base_T_camera), p_in_camera)


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    x, y, z = transform_point(pose_to_transform(object_pose), offset)
    q = object_pose.orientation
    return Pose(Point(x, y, z), Quaternion(q.x, q.y, q.z, q.w))
