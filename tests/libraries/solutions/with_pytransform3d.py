"""All sixteen with pytransform3d. Its quaternions are w, x, y, z; our a_T_b is what it calls B2A."""

import numpy as np
from pytransform3d import rotations as pr
from pytransform3d import transformations as pt
from pytransform3d.transform_manager import TransformManager
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return pr.active_matrix_from_angle(2, np.deg2rad(degrees))


def rotation_from_axes(x_axis, y_axis):
    return pr.matrix_from_two_vectors(x_axis, y_axis)


# WRONG, and the library's fault: check_matrix compares with np.allclose and gives it the absolute tolerance only, so that
# NumPy's own relative one of 1e-5 is added where the right number is 1: axes too long by 4e-6 pass.
def is_rotation(R):
    try:
        pr.check_matrix(R, tolerance=1e-6)
    except ValueError:
        return False
    return True


def same_rotation(q1, q2):
    return pr.quaternion_dist(pr.quaternion_wxyz_from_xyzw(q1), pr.quaternion_wxyz_from_xyzw(q2)) < 1e-6


def make_transform(R, p):
    return pt.transform_from(R, p)


def hand_transform():
    return pt.transform_from(pr.active_matrix_from_angle(0, np.deg2rad(-90)), [-0.1, 0, 0])


def _pose(pq):
    x, y, z, qw, qx, qy, qz = pq
    return Pose(Point(x, y, z), Quaternion(qx, qy, qz, qw))


def _pq(pose):
    p, q = pose.position, pose.orientation
    return np.array([p.x, p.y, p.z, q.w, q.x, q.y, q.z])


def transform_to_pose(matrix):
    return _pose(pt.pq_from_transform(matrix))


def pose_to_transform(pose):
    return pt.transform_from_pq(_pq(pose))


def transform_point(a_T_b, p_in_b):
    return pt.transform(a_T_b, pt.vector_to_point(p_in_b))[:3]


def chain(*transforms):
    first, *rest = transforms
    first_T_last = np.array(first, dtype=float)
    for next_T_last in rest:
        first_T_last = pt.concat(next_T_last, first_T_last)  # which is first_T_last @ next_T_last
    return first_T_last


def transform_pose(a_T_b, pose_in_b):
    return _pose(pt.pq_from_transform(pt.concat(pose_to_transform(pose_in_b), a_T_b)))


def invert_transform(a_T_b):
    return pt.invert_transform(a_T_b)


def relative_transform(a_T_b, a_T_c):
    frames = TransformManager()
    frames.add_transform("b", "a", a_T_b)
    frames.add_transform("c", "a", a_T_c)
    return frames.get_transform("c", "b")


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    frames = TransformManager()
    frames.add_transform("camera", "base", base_T_camera)
    frames.add_transform("gripper", "base", base_T_gripper)
    return pt.transform(frames.get_transform("camera", "gripper"), pt.vector_to_point(p_in_camera))[:3]


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    base_T_object = pose_to_transform(object_pose)
    object_T_waypoint = pt.transform_from(np.eye(3), offset)
    return _pose(pt.pq_from_transform(pt.concat(object_T_waypoint, base_T_object)))
