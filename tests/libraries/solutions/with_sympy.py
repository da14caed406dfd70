"""All sixteen with SymPy: exact where the arguments are, and returned as SymPy's own matrices, numbers and truths."""

from sympy import And, Matrix, Max, Or, Rational, eye, pi, prod, rad, rot_ccw_axis1, rot_ccw_axis3
from sympy import Quaternion as Q
from transform_lab import Point, Pose, Quaternion


def rotation_about_z(degrees):
    return rot_ccw_axis3(rad(degrees))  # rot_axis3 is the passive one, its transpose


def rotation_from_axes(x_axis, y_axis):
    x, y = Matrix(x_axis), Matrix(y_axis)
    return Matrix.hstack(x, y, x.cross(y))


def is_rotation(R):
    R = Matrix(R)
    off = R.T * R - eye(3)
    return And(Max(*map(abs, off)) < 1e-6, R.det() > 0)


def same_rotation(q1, q2):
    q1, q2 = Matrix(q1), Matrix(q2)
    return Or((q1 - q2).norm() < 1e-6, (q1 + q2).norm() < 1e-6)


def make_transform(R, p):
    return Matrix.hstack(Matrix(R), Matrix(p)).col_join(Matrix([[0, 0, 0, 1]]))


def hand_transform():
    return make_transform(rot_ccw_axis1(-pi / 2), [Rational(-1, 10), 0, 0])


def _parts(matrix):
    T = Matrix(matrix)
    return T[:3, :3], T[:3, 3]


def _quaternion(pose):
    q = pose.orientation
    return Q(q.w, q.x, q.y, q.z)


def _position(pose):
    p = pose.position
    return Matrix([p.x, p.y, p.z])


def _pose(p, q):
    return Pose(Point(*p), Quaternion(q.b, q.c, q.d, q.a))


# WRONG, and the library's fault: from_rotation_matrix takes the signs of x, y and z from differences that are 0 at a half
# turn, and roots of what rounding made a little negative, which are imaginary.
def transform_to_pose(matrix):
    R, p = _parts(matrix)
    return _pose(p, Q.from_rotation_matrix(R))


def pose_to_transform(pose):
    return make_transform(_quaternion(pose).to_rotation_matrix(), _position(pose))


def transform_point(a_T_b, p_in_b):
    R, p = _parts(a_T_b)
    return R * Matrix(p_in_b) + p


def chain(*transforms):
    return prod(map(Matrix, transforms), start=eye(4))


# WRONG in the same way.
def transform_pose(a_T_b, pose_in_b):
    R, _ = _parts(a_T_b)
    p = transform_point(a_T_b, _position(pose_in_b))
    return _pose(p, Q.from_rotation_matrix(R) * _quaternion(pose_in_b))


def invert_transform(a_T_b):
    R, p = _parts(a_T_b)
    return make_transform(R.T, -R.T * p)


def relative_transform(a_T_b, a_T_c):
    return invert_transform(a_T_b) * Matrix(a_T_c)


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return transform_point(relative_transform(base_T_gripper, base_T_camera), p_in_camera)


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, [-distance, 0, 0])


def waypoint(object_pose, offset):
    q = _quaternion(object_pose)
    moved = Q.rotate_point(tuple(offset), q)
    return _pose(_position(object_pose) + Matrix(moved), q)
