"""All sixteen with trimesh's transformations. Its quaternions are w, x, y, z."""

import numpy as np
from transform_lab import Point, Pose, Quaternion
from trimesh import transformations as tf
from trimesh.scene.transforms import SceneGraph


def rotation_about_z(degrees):
    return tf.rotation_matrix(np.radians(degrees), [0, 0, 1])[:3, :3]


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack([x_axis, y_axis, np.cross(x_axis, y_axis)])


# WRONG, and the library's fault: is_rigid promises "only translation and rotation", and takes mirror images.
def is_rotation(R):
    T = np.eye(4)
    T[:3, :3] = R
    return tf.is_rigid(T, epsilon=1e-6)


def same_rotation(q1, q2):
    # is_same_quaternion has a tolerance of its own, and the order of the numbers does not matter here
    return np.allclose(q1, q2, rtol=0, atol=1e-6) or np.allclose(q1, np.negative(q2), rtol=0, atol=1e-6)


def make_transform(R, p):
    T = tf.translation_matrix(p)
    T[:3, :3] = R
    return T


def hand_transform():
    return tf.compose_matrix(angles=[np.radians(-90), 0, 0], translate=[-0.1, 0, 0])


def transform_to_pose(matrix):
    w, x, y, z = tf.quaternion_from_matrix(matrix)
    return Pose(Point(*tf.translation_from_matrix(matrix)), Quaternion(x, y, z, w))


def pose_to_transform(pose):
    p, q = pose.position, pose.orientation
    return tf.concatenate_matrices(tf.translation_matrix([p.x, p.y, p.z]), tf.quaternion_matrix([q.w, q.x, q.y, q.z]))


def transform_point(a_T_b, p_in_b):
    return tf.transform_points([p_in_b], a_T_b)[0]


def chain(*transforms):
    return tf.concatenate_matrices(*transforms)


def transform_pose(a_T_b, pose_in_b):
    return transform_to_pose(tf.concatenate_matrices(a_T_b, pose_to_transform(pose_in_b)))


def invert_transform(a_T_b):
    return tf.inverse_matrix(a_T_b)


def _frames(base, **transforms):
    graph = SceneGraph(base_frame=base)
    for frame, base_T_frame in transforms.items():
        graph.update(frame_from=base, frame_to=frame, matrix=base_T_frame)
    return graph


def relative_transform(a_T_b, a_T_c):
    b_T_c, _ = _frames("a", b=a_T_b, c=a_T_c).get(frame_to="c", frame_from="b")
    return b_T_c


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    frames = _frames("base", camera=base_T_camera, gripper=base_T_gripper)
    gripper_T_camera, _ = frames.get(frame_to="camera", frame_from="gripper")
    return tf.transform_points([p_in_camera], gripper_T_camera)[0]


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    return transform_to_pose(tf.concatenate_matrices(pose_to_transform(object_pose), tf.translation_matrix(offset)))
