"""Wrong solutions as students write them, each with the misconception(s) a good teacher would name."""
import copy
import functools
import math
from math import atan2, cos, pi, sin, sqrt

import numpy as np
from numpy.linalg import inv
from scipy.spatial.transform import Rotation
from transform_lab import Point, Pose, PoseStamped, Quaternion, tft

# Look at some of their arguments to know a call again, and take two for one when these are alike.
CACHES = {"point_cached", "inv_cached_by_rotation", "rel_cached_inverse", "oig_cached_chain", "pg_cached"}
WRONG = []  # (exercise, names, function): names is a tuple of misconception ids, () where no single name is fair


def wrong(exercise, *names):
    def register(function):
        WRONG.append((exercise, names, function))
        return function

    return register


def cosd(degs):
    return math.cos(degs * math.pi / 180)


def sind(degs):
    return math.sin(degs * math.pi / 180)


# ---------------------------------------------------------------- rotation_about_z


@wrong("rotation_about_z", "degrees-as-radians")
def z_radians(degrees):
    """Degrees go straight into cos and sin."""
    c, s = np.cos(degrees), np.sin(degrees)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


@wrong("rotation_about_z", "rotation-transposed")
def z_minus_on_wrong_side(degrees):
    """The minus stands at the lower sine: axes as rows."""
    th = math.radians(degrees)
    return np.array([[cos(th), sin(th), 0], [-sin(th), cos(th), 0], [0, 0, 1]])


@wrong("rotation_about_z", "degrees-as-radians", "rotation-transposed")
def z_columns_listed_as_rows(degrees):
    """Lists the axes as rows, and forgets to convert."""
    x = [np.cos(degrees), np.sin(degrees), 0]
    y = [-np.sin(degrees), np.cos(degrees), 0]
    z = [0, 0, 1]
    return np.array([x, y, z])


@wrong("rotation_about_z", "wrong-shape")
def z_four_by_four(degrees):
    """The 4x4 matrix of tft is handed back as it is."""
    return tft.rotation_matrix(np.deg2rad(degrees), [0, 0, 1])


@wrong("rotation_about_z", "wrong-axis", "wrong-shape")
def z_euler_matrix_wrong_slot(degrees):
    """The angle goes into euler_matrix's first slot (roll), and the result is 4x4."""
    return tft.euler_matrix(np.radians(degrees), 0, 0)


@wrong("rotation_about_z", "sine-from-cosine")
def z_sine_from_cosine(degrees):
    """corner: sin is sqrt(1 - cos^2), so it is never negative: right from 0 to 180 only."""
    c = math.cos(math.radians(degrees))
    s = math.sqrt(1 - c ** 2)
    R = np.eye(3)
    R[0, 0] = R[1, 1] = c
    R[0, 1] = -s
    R[1, 0] = s
    return R


@wrong("rotation_about_z", "integer-truncation")
def z_whole_degrees(degrees):
    """int() cuts fractions of a degree off."""
    a = int(degrees) * pi / 180
    return np.array([[cos(a), -sin(a), 0.0], [sin(a), cos(a), 0.0], [0.0, 0.0, 1.0]])


@wrong("rotation_about_z", "pi-rounded")
def z_pi_by_hand(degrees):
    """3.14 for pi."""
    theta = degrees * 3.14 / 180
    return np.array([[np.cos(theta), -np.sin(theta), 0], [np.sin(theta), np.cos(theta), 0], [0, 0, 1]])


@wrong("rotation_about_z", "integer-truncation")
def z_integer_matrix(degrees):
    """Entries are written into an integer array, which truncates them."""
    R = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    t = np.radians(degrees)
    R[0, 0] = np.cos(t)
    R[1, 1] = np.cos(t)
    R[0, 1] = -np.sin(t)
    R[1, 0] = np.sin(t)
    return R


@wrong("rotation_about_z", "angle-folded")
def z_wraps_to_half_circle(degrees):
    """corner: angles are 'normalised' modulo 180 instead of 360: wrong for negative angles and beyond 180."""
    d = degrees % 180
    return Rotation.from_euler("z", d, degrees=True).as_matrix()


@wrong("rotation_about_z", "left-handed")
def z_both_sines_positive(degrees):
    """The minus is forgotten: y is mirrored, no rotation at all unless both are zero."""
    return np.array([[cosd(degrees), sind(degrees), 0], [sind(degrees), -cosd(degrees), 0], [0, 0, 1]])


@wrong("rotation_about_z", "angle-folded")
def z_clipped(degrees):
    """corner: the angle is clipped to -360..360 where it should wrap."""
    degrees = max(-360, min(360, degrees))
    th = np.deg2rad(degrees)
    return Rotation.from_rotvec([0, 0, th]).as_matrix()


# ---------------------------------------------------------------- rotation_from_axes


@wrong("rotation_from_axes", "rotation-transposed")
def axes_as_rows(x_axis, y_axis):
    """np.array writes the vectors as rows."""
    z_axis = np.cross(x_axis, y_axis)
    return np.array([x_axis, y_axis, z_axis])


@wrong("rotation_from_axes", "left-handed")
def axes_y_cross_x(x_axis, y_axis):
    """The thumb of the left hand."""
    z = np.cross(y_axis, x_axis)
    return np.column_stack([x_axis, y_axis, z])


@wrong("rotation_from_axes", "left-handed", "rotation-transposed")
def axes_rows_and_left_hand(x_axis, y_axis):
    """y cross x, stacked as rows."""
    return np.vstack((x_axis, y_axis, np.cross(y_axis, x_axis)))


@wrong("rotation_from_axes", "hard-coded")
def axes_z_is_up(x_axis, y_axis):
    """corner: B's z is taken for A's z: right only for frames that are not tilted."""
    R = np.zeros((3, 3))
    R[:, 0] = x_axis
    R[:, 1] = y_axis
    R[:, 2] = [0, 0, 1]
    return R


@wrong("rotation_from_axes", "wrong-sign")
def axes_z_absolute(x_axis, y_axis):
    """Z from the cross product, made positive 'because z points up'."""
    z_axis = np.abs(np.cross(x_axis, y_axis))
    return np.stack([x_axis, y_axis, z_axis], axis=1)


@wrong("rotation_from_axes", "elementwise-product")
def axes_star_for_cross(x_axis, y_axis):
    """x * y is taken for the cross product."""
    z_axis = x_axis * y_axis
    return np.column_stack((x_axis, y_axis, z_axis))


@wrong("rotation_from_axes", "input-mutated")
def axes_in_place(x_axis, y_axis):
    """The third axis is worked out in y_axis's memory."""
    R = np.eye(3)
    R[:, 0] = x_axis
    R[:, 1] = y_axis
    z = y_axis
    z[:] = np.cross(x_axis, y_axis)
    R[:, 2] = z
    return R


@wrong("rotation_from_axes", "cross-product-slip")
def axes_cross_slip(x_axis, y_axis):
    """The cross product by hand, with one sign wrong in the middle."""
    x1, x2, x3 = x_axis
    y1, y2, y3 = y_axis
    z = [x2 * y3 - x3 * y2, x1 * y3 - x3 * y1, x1 * y2 - x2 * y1]
    return np.array([[x1, y1, z[0]], [x2, y2, z[1]], [x3, y3, z[2]]])


@wrong("rotation_from_axes", "wrong-sign")
def axes_third_by_unit_rows(x_axis, y_axis):
    """Z's entries from 'each row has length 1', so their signs are lost."""
    z = np.sqrt(np.maximum(0, 1 - x_axis ** 2 - y_axis ** 2))
    return np.column_stack([x_axis, y_axis, z])


# ---------------------------------------------------------------- is_rotation


@wrong("is_rotation", "determinant-only")
def isrot_det_only(R):
    """Determinant 1 is taken for the whole test."""
    return abs(np.linalg.det(R) - 1) < 1e-6


@wrong("is_rotation", "reflection-accepted")
def isrot_orthonormal_only(R):
    """R^T R = I, no determinant."""
    return np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-6)


@wrong("is_rotation", "reflection-accepted")
def isrot_abs_det(R):
    """The determinant's absolute value is compared."""
    orth = np.allclose(np.dot(R, R.T), np.identity(3), atol=1e-6)
    return bool(orth and np.isclose(abs(np.linalg.det(R)), 1.0, atol=1e-6))


@wrong("is_rotation", "exact-comparison")
def isrot_exact(R):
    """Compares floating-point numbers with ==."""
    return (R.T @ R == np.eye(3)).all() and np.linalg.det(R) == 1


@wrong("is_rotation", "exact-comparison")
def isrot_det_exact(R):
    """corner: allclose for the product, but == for the determinant."""
    if not np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-6):
        return False
    return np.linalg.det(R) == 1.0


@wrong("is_rotation", "elementwise-product")
def isrot_star(R):
    """R.T * R instead of R.T @ R."""
    return bool(np.allclose(R.T * R, np.eye(3), rtol=0, atol=1e-6) and abs(np.linalg.det(R) - 1) < 1e-6)


@wrong("is_rotation", "loose-comparison")
def isrot_loose(R):
    """corner: tolerance of 0.05: matrices that are off by 1e-3 pass."""
    return np.allclose(R.T @ R, np.eye(3), atol=0.05) and np.isclose(np.linalg.det(R), 1, atol=0.05)


@wrong("is_rotation", "exact-comparison")
def isrot_too_tight(R):
    """corner: tolerance of 1e-12: a matrix that is off by 1e-9 fails."""
    I = np.identity(3)
    n = np.linalg.norm(I - np.dot(np.transpose(R), R))
    return bool(n < 1e-12 and np.linalg.det(R) > 0)


@wrong("is_rotation", "orthogonality-not-checked")
def isrot_unit_columns(R):
    """corner: unit columns and a positive determinant are taken to be enough: sheared matrices pass."""
    lengths = np.linalg.norm(R, axis=0)
    return bool(np.all(np.abs(lengths - 1) < 1e-6) and np.linalg.det(R) > 0)


@wrong("is_rotation")
def isrot_two_pairs(R):
    """corner: two pairs of columns are looked at, the third (x, z) is forgotten."""
    x, y, z = R[:, 0], R[:, 1], R[:, 2]
    tol = 1e-6
    for v in (x, y, z):
        if abs(np.linalg.norm(v) - 1) > tol:
            return False
    if abs(x.dot(y)) > tol or abs(y.dot(z)) > tol:
        return False
    return bool(np.linalg.det(R) > 0)


@wrong("is_rotation", "exact-comparison", "reflection-accepted")
def isrot_inverse_equals_transpose(R):
    """Inverse equal to transpose, exactly, and no determinant."""
    if np.linalg.det(R) == 0:
        return False
    return np.array_equal(inv(R), R.T)


@wrong("is_rotation", "inverse-of-singular")
def isrot_inverse_raises(R):
    """corner: asks for the inverse first, which raises for a singular matrix."""
    return bool(np.allclose(inv(R), R.T, rtol=0, atol=1e-6) and np.linalg.det(R) > 0)


@wrong("is_rotation")
def isrot_signed_sum(R):
    """corner: errors are summed without abs, so a matrix that is too small, or whose errors cancel, passes."""
    err = np.sum(R.T @ R - np.eye(3))
    return bool(err < 1e-6 and np.linalg.det(R) > 0)


@wrong("is_rotation", "input-mutated")
def isrot_subtracts_in_place(R):
    """Subtracts the transpose's inverse from R itself."""
    good_hand = np.linalg.det(R) > 0
    if not good_hand:
        return False
    R -= np.linalg.inv(R).T
    return bool(np.max(np.abs(R)) < 1e-6)


# ---------------------------------------------------------------- same_rotation


@wrong("same_rotation", "sign-ignored")
def same_allclose(q1, q2):
    """q and -q are taken for different."""
    return np.allclose(q1, q2, rtol=0, atol=1e-6)


@wrong("same_rotation", "exact-comparison")
def same_exact(q1, q2):
    """== on floating-point numbers (both signs are thought of)."""
    return np.array_equal(q1, q2) or np.array_equal(q1, -q2)


@wrong("same_rotation", "sign-ignored", "exact-comparison")
def same_list_equal(q1, q2):
    """Lists compared with ==."""
    return list(q1) == list(q2)


@wrong("same_rotation", "component-signs-ignored")
def same_abs_each(q1, q2):
    """Each number's absolute value is compared: a turn and its inverse look the same."""
    return np.allclose(np.abs(q1), np.abs(q2), rtol=0, atol=1e-6)


@wrong("same_rotation")
def same_dot_loose(q1, q2):
    """corner: |dot| > 0.9999 also passes orientations that are 0.01 rad apart."""
    return bool(abs(np.dot(q1, q2)) > 0.9999)


@wrong("same_rotation")
def same_flip_by_w(q1, q2):
    """corner: makes w positive first, which decides nothing at half turns (w = 0)."""
    a = -q1 if q1[3] < 0 else q1
    b = -q2 if q2[3] < 0 else q2
    return np.allclose(a, b, rtol=0, atol=1e-6)


@wrong("same_rotation", "half-turn-missed")
def same_sign_of_w_is_zero(q1, q2):
    """corner: multiplies by sign(w), which is 0 at exact half turns, so all of them are the same."""
    return np.allclose(np.sign(q1[3]) * q1, np.sign(q2[3]) * q2, rtol=0, atol=1e-6)


@wrong("same_rotation")
def same_arccos_nan(q1, q2):
    """corner: arccos of a dot product that rounding made larger than 1 is nan."""
    with np.errstate(invalid="ignore"):
        angle = 2 * np.arccos(abs(np.dot(q1, q2)))
    return bool(angle < 1e-6)


@wrong("same_rotation", "sign-ignored")
def same_dot_signed(q1, q2):
    """dot close to 1, but -1 is forgotten."""
    return bool(np.dot(q1, q2) > 1 - 1e-9)


@wrong("same_rotation", "input-mutated")
def same_flips_in_place(q1, q2):
    """Turns the argument's sign in place when the two point apart."""
    if np.dot(q1, q2) < 0:
        q2 *= -1
    return np.allclose(q1, q2, rtol=0, atol=1e-6)


@wrong("same_rotation")
def same_any(q1, q2):
    """any where all is meant."""
    close = np.abs(q1 - q2) < 1e-6
    close_neg = np.abs(q1 + q2) < 1e-6
    return bool(close.any() or close_neg.any())


@wrong("same_rotation", "angle-only")
def same_angle_only(q1, q2):
    """The angle of the turn is compared, not its axis."""
    return bool(abs(abs(q1[3]) - abs(q2[3])) < 1e-6)


@wrong("same_rotation", "quaternion-order")
def same_w_first_sign(q1, q2):
    """corner: makes the first number positive, thinking it is w: decides nothing when x = 0."""
    def to_wxyz(q):
        w, x, y, z = q
        if w < 0:
            w, x, y, z = -w, -x, -y, -z
        return w, x, y, z
    return np.allclose(to_wxyz(q1), to_wxyz(q2), rtol=0, atol=1e-6)


# ---------------------------------------------------------------- make_transform


@wrong("make_transform", "translation-in-bottom-row")
def make_bottom_row(R, p):
    """The translation stands in the last row."""
    T = np.eye(4)
    T[:3, :3] = R
    T[3, :3] = p
    return T


@wrong("make_transform", "rotation-transposed")
def make_transposed(R, p):
    """The rotation is transposed 'so that the axes are columns'."""
    T = np.identity(4)
    T[:3, :3] = R.T
    T[:3, 3] = p
    return T


@wrong("make_transform", "rotation-transposed", "translation-in-bottom-row")
def make_whole_transpose(R, p):
    """The whole 4x4 is transposed at the end."""
    T = np.zeros((4, 4))
    T[:3, :3] = R
    T[:3, 3] = p
    T[3, 3] = 1
    return T.T


@wrong("make_transform", "bottom-row-wrong")
def make_zeros(R, p):
    """np.zeros, and the 1 in the corner is forgotten."""
    T = np.zeros((4, 4))
    T[0:3, 0:3] = R
    T[0:3, 3] = p
    return T


@wrong("make_transform", "wrong-shape")
def make_three_by_four(R, p):
    """No bottom row at all."""
    return np.hstack([R, p.reshape(3, 1)])


@wrong("make_transform", "order-reversed")
def make_rotates_translation(R, p):
    """Rotation @ translation: the translation gets rotated."""
    M = np.eye(4)
    M[:3, :3] = R
    return M @ tft.translation_matrix(p)


@wrong("make_transform", "integer-truncation")
def make_int_template(R, p):
    """An integer template truncates what is put in."""
    T = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    T[:3, :3] = R
    T[:3, 3] = p
    return T


@wrong("make_transform", "wrong-position")
def make_slice_slip(R, p):
    """Slip: T[:2, 3] copied from the hint, z is missing."""
    T = np.eye(4)
    T[:3, :3] = R
    T[:2, 3] = p[:2]
    return T


@wrong("make_transform", "rotation-transposed", "bottom-row-wrong")
def make_concatenate(R, p):
    """Rows for columns, and a bottom row of ones."""
    cols = np.column_stack([R[0], R[1], R[2], p])
    return np.vstack([cols, np.ones(4)])


# ---------------------------------------------------------------- hand_transform


@wrong("hand_transform", "rotation-transposed")
def hand_axes_as_rows():
    """Axes as rows."""
    return np.array([[1, 0, 0, -0.1], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])


@wrong("hand_transform", "wrong-units")
def hand_centimetres():
    """10 for 10 centimetres."""
    return np.array([[1, 0, 0, -10], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1.0]])


@wrong("hand_transform", "wrong-sign")
def hand_forward():
    """Closer taken for +x."""
    T = np.eye(4)
    T[:3, 0] = [1, 0, 0]
    T[:3, 1] = [0, 0, -1]
    T[:3, 2] = [0, 1, 0]
    T[:3, 3] = [0.1, 0, 0]
    return T


@wrong("hand_transform", "rotation-transposed", "wrong-units")
def hand_rows_and_cm():
    """Rolled the other way, and centimetres."""
    T = tft.rotation_matrix(math.pi / 2, (1, 0, 0))
    T[0, 3] = -10
    return T


@wrong("hand_transform", "translation-in-bottom-row")
def hand_bottom_row():
    """Translation in the last row."""
    return np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [-0.1, 0, 0, 1]])


@wrong("hand_transform", "wrong-axis", "wrong-sign")
def hand_moves_along_y():
    """'Closer' is taken along y, and to the wrong side."""
    return np.array([[1, 0, 0, 0], [0, 0, 1, 0.1], [0, -1, 0, 0], [0, 0, 0, 1]])


@wrong("hand_transform", "left-handed")
def hand_middle_finger_up():
    """The middle finger is written as up: a left hand."""
    return np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])


@wrong("hand_transform", "degrees-as-radians")
def hand_cos_90():
    """cos(-90) with 90 in degrees."""
    a = -90
    return np.array([[1, 0, 0, -0.1], [0, np.cos(a), -np.sin(a), 0], [0, np.sin(a), np.cos(a), 0], [0, 0, 0, 1]])


@wrong("hand_transform")
def hand_rounded_to_int():
    """Slip: dtype=int makes -0.1 a 0."""
    return np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], dtype=int)


@wrong("hand_transform", "wrong-axis")
def hand_about_z():
    """Turned about z, the hand yaws instead of rolling."""
    R = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    T = np.eye(4)
    T[:3, :3] = R
    T[0, 3] = -0.1
    return T


# ---------------------------------------------------------------- transform_to_pose


@wrong("transform_to_pose", "quaternion-order")
def ttp_w_first(matrix):
    """tft's result is taken for w, x, y, z."""
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = matrix[:3, 3]
    q = tft.quaternion_from_matrix(matrix)
    pose.orientation.w = q[0]
    pose.orientation.x = q[1]
    pose.orientation.y = q[2]
    pose.orientation.z = q[3]
    return pose


@wrong("transform_to_pose", "quaternion-order")
def ttp_backwards(matrix):
    """Quaternion read back to front."""
    q = tft.quaternion_from_matrix(matrix)
    return Pose(Point(*matrix[:3, 3]), Quaternion(*q[::-1]))


@wrong("transform_to_pose", "position-missing")
def ttp_no_position(matrix):
    """The position is left at its default."""
    pose = Pose()
    x, y, z, w = tft.quaternion_from_matrix(matrix)
    pose.orientation = Quaternion(x, y, z, w)
    return pose


@wrong("transform_to_pose", "orientation-missing")
def ttp_no_orientation(matrix):
    """Only the position is filled in."""
    pose = Pose()
    pose.position.x = matrix[0, 3]
    pose.position.y = matrix[1, 3]
    pose.position.z = matrix[2, 3]
    return pose


@wrong("transform_to_pose", "trace-formula-only")
def ttp_trace(matrix):
    """corner: the trace formula alone divides by 0 at half turns."""
    pose = Pose()
    pose.position = Point(matrix[0, 3], matrix[1, 3], matrix[2, 3])
    w = np.sqrt(max(0.0, 1 + matrix[0, 0] + matrix[1, 1] + matrix[2, 2])) / 2
    pose.orientation.w = w
    if w != 0:
        pose.orientation.x = (matrix[2, 1] - matrix[1, 2]) / (4 * w)
        pose.orientation.y = (matrix[0, 2] - matrix[2, 0]) / (4 * w)
        pose.orientation.z = (matrix[1, 0] - matrix[0, 1]) / (4 * w)
    return pose


@wrong("transform_to_pose", "trace-formula-only")
def ttp_copysign_with_np_sign(matrix):
    """corner: signs by np.sign, which is 0 where the difference is 0."""
    m = matrix
    x = np.sqrt(max(0, 1 + m[0, 0] - m[1, 1] - m[2, 2])) / 2
    y = np.sqrt(max(0, 1 - m[0, 0] + m[1, 1] - m[2, 2])) / 2
    z = np.sqrt(max(0, 1 - m[0, 0] - m[1, 1] + m[2, 2])) / 2
    w = np.sqrt(max(0, 1 + m[0, 0] + m[1, 1] + m[2, 2])) / 2
    x *= np.sign(m[2, 1] - m[1, 2])
    y *= np.sign(m[0, 2] - m[2, 0])
    z *= np.sign(m[1, 0] - m[0, 1])
    return Pose(Point(*m[:3, 3]), Quaternion(x, y, z, w))


@wrong("transform_to_pose", "trace-formula-only")
def ttp_copysign(matrix):
    """corner: math.copysign loses the relative signs at exact half turns about an axis such as (1, -2, 3)."""
    m = matrix.tolist()
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = m[0][3], m[1][3], m[2][3]
    o = pose.orientation
    o.w = sqrt(max(0, 1 + m[0][0] + m[1][1] + m[2][2])) / 2
    o.x = math.copysign(sqrt(max(0, 1 + m[0][0] - m[1][1] - m[2][2])) / 2, m[2][1] - m[1][2])
    o.y = math.copysign(sqrt(max(0, 1 - m[0][0] + m[1][1] - m[2][2])) / 2, m[0][2] - m[2][0])
    o.z = math.copysign(sqrt(max(0, 1 - m[0][0] - m[1][1] + m[2][2])) / 2, m[1][0] - m[0][1])
    return pose


@wrong("transform_to_pose", "trace-formula-only")
def ttp_axis_angle(matrix):
    """corner: axis from the skew part over 2 sin(theta), which is 0/0 at a half turn."""
    R = matrix[:3, :3]
    theta = np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    if np.isclose(np.sin(theta), 0):
        axis = np.array([0.0, 0.0, 1.0])
    else:
        axis = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / (2 * np.sin(theta))
    q = tft.quaternion_about_axis(theta, axis)
    return Pose(Point(*matrix[:3, 3]), Quaternion(*q))


@wrong("transform_to_pose", "trace-formula-only")
def ttp_half_turn_no_relative_signs(matrix):
    """corner: half turns have their own branch, with the axis from the diagonal and no signs."""
    R = matrix[:3, :3]
    tr = R.trace()
    pose = Pose(Point(*matrix[:3, 3]), Quaternion())
    if tr > -0.99999:
        w = sqrt(1 + tr) / 2
        pose.orientation = Quaternion((R[2, 1] - R[1, 2]) / 4 / w, (R[0, 2] - R[2, 0]) / 4 / w, (R[1, 0] - R[0, 1]) / 4 / w, w)
    else:
        ax = np.sqrt(np.maximum((np.diag(R) + 1) / 2, 0))
        pose.orientation = Quaternion(ax[0], ax[1], ax[2], 0.0)
    return pose


@wrong("transform_to_pose", "branch-wrong")
def ttp_shepperd_slip_y(matrix):
    """corner: Shepperd's method with a plus/minus slip in the y branch only."""
    m = matrix
    t = np.trace(m[:3, :3])
    if t > 0:
        s = sqrt(t + 1) * 2
        q = [(m[2, 1] - m[1, 2]) / s, (m[0, 2] - m[2, 0]) / s, (m[1, 0] - m[0, 1]) / s, s / 4]
    elif m[0, 0] > m[1, 1] and m[0, 0] > m[2, 2]:
        s = sqrt(1 + m[0, 0] - m[1, 1] - m[2, 2]) * 2
        q = [s / 4, (m[0, 1] + m[1, 0]) / s, (m[0, 2] + m[2, 0]) / s, (m[2, 1] - m[1, 2]) / s]
    elif m[1, 1] > m[2, 2]:
        s = sqrt(1 + m[1, 1] - m[0, 0] - m[2, 2]) * 2
        q = [(m[0, 1] + m[1, 0]) / s, s / 4, (m[1, 2] - m[2, 1]) / s, (m[0, 2] - m[2, 0]) / s]
    else:
        s = sqrt(1 + m[2, 2] - m[0, 0] - m[1, 1]) * 2
        q = [(m[0, 2] + m[2, 0]) / s, (m[1, 2] + m[2, 1]) / s, s / 4, (m[1, 0] - m[0, 1]) / s]
    return Pose(Point(*m[:3, 3]), Quaternion(*q))


@wrong("transform_to_pose", "trace-formula-only")
def ttp_shepperd_without_z(matrix):
    """corner: Shepperd's branches for x and y, the one for z is forgotten and the trace formula takes over."""
    m = matrix
    d0, d1, d2 = m[0, 0], m[1, 1], m[2, 2]
    if d0 + d1 + d2 <= 0 and d0 > d1 and d0 > d2:
        s = sqrt(1 + d0 - d1 - d2) * 2
        q = [s / 4, (m[0, 1] + m[1, 0]) / s, (m[0, 2] + m[2, 0]) / s, (m[2, 1] - m[1, 2]) / s]
    elif d0 + d1 + d2 <= 0 and d1 > d2:
        s = sqrt(1 + d1 - d0 - d2) * 2
        q = [(m[0, 1] + m[1, 0]) / s, s / 4, (m[1, 2] + m[2, 1]) / s, (m[0, 2] - m[2, 0]) / s]
    else:
        s = sqrt(max(d0 + d1 + d2 + 1, 1e-12)) * 2
        q = [(m[2, 1] - m[1, 2]) / s, (m[0, 2] - m[2, 0]) / s, (m[1, 0] - m[0, 1]) / s, s / 4]
    pose = Pose()
    pose.position = Point(*m[:3, 3])
    pose.orientation = Quaternion(*q)
    return pose


@wrong("transform_to_pose", "trace-formula-only")
def ttp_identity_when_trace_small(matrix):
    """For trace <= 0 'the formula does not work', so no turn is returned."""
    pose = Pose()
    (pose.position.x, pose.position.y, pose.position.z) = matrix[:3, 3]
    trace = matrix[0, 0] + matrix[1, 1] + matrix[2, 2]
    if trace > 0:
        S = math.sqrt(trace + 1.0) * 2
        pose.orientation.w = 0.25 * S
        pose.orientation.x = (matrix[2, 1] - matrix[1, 2]) / S
        pose.orientation.y = (matrix[0, 2] - matrix[2, 0]) / S
        pose.orientation.z = (matrix[1, 0] - matrix[0, 1]) / S
    else:
        pose.orientation.w = 1
    return pose


@wrong("transform_to_pose", "rotation-transposed")
def ttp_transposed(matrix):
    """The rotation is transposed on the way in."""
    M = np.eye(4)
    M[:3, :3] = matrix[:3, :3].T
    q = tft.quaternion_from_matrix(M)
    p = tft.translation_from_matrix(matrix)
    return Pose(Point(p[0], p[1], p[2]), Quaternion(q[0], q[1], q[2], q[3]))


@wrong("transform_to_pose", "rotation-transposed", "quaternion-order")
def ttp_transposed_and_w_first(matrix):
    """Rows for columns, and w first."""
    R = matrix[:3, :3]
    quat = Rotation.from_matrix([R[:, 0], R[:, 1], R[:, 2]]).as_quat()
    return Pose(Point(*matrix[:3, 3]), Quaternion(quat[3], quat[0], quat[1], quat[2]))


@wrong("transform_to_pose", "quaternion-order", "position-missing")
def ttp_w_first_no_position(matrix):
    """w first, and no position."""
    w, x, y, z = tft.quaternion_from_matrix(matrix)
    return Pose(orientation=Quaternion(x, y, z, w))


@wrong("transform_to_pose", "wrong-position", "orientation-identity")
def ttp_bottom_row_and_identity(matrix):
    """Position off the bottom row, and orientation w = 1 always."""
    pose = Pose()
    pose.position.x = matrix[3, 0]
    pose.position.y = matrix[3, 1]
    pose.position.z = matrix[3, 2]
    pose.orientation.w = 1
    return pose


@wrong("transform_to_pose", "wrong-position")
def ttp_bottom_row(matrix):
    """Position off the bottom row."""
    q = tft.quaternion_from_matrix(matrix)
    return Pose(Point(*matrix[3, :3]), Quaternion(*q))


@wrong("transform_to_pose")
def ttp_x_y_x(matrix):
    """Slip: x, y, x."""
    v = matrix[:3, 3]
    q = tft.quaternion_from_matrix(matrix)
    pose = Pose()
    pose.position = Point(v[0], v[1], v[0])
    pose.orientation = Quaternion(*q)
    return pose


@wrong("transform_to_pose", "wrong-type")
def ttp_array_in_orientation(matrix):
    """The array itself is assigned to orientation."""
    pose = Pose()
    pose.position = Point(*matrix[:3, 3])
    pose.orientation = tft.quaternion_from_matrix(matrix)
    return pose


@wrong("transform_to_pose", "wrong-type", "quaternion-order")
def ttp_arrays_everywhere(matrix):
    """Both fields hold arrays, the quaternion w first."""
    pose = Pose()
    pose.position = matrix[:3, 3].copy()
    q = tft.quaternion_from_matrix(matrix)
    pose.orientation = np.roll(q, 1)
    return pose


@wrong("transform_to_pose", "wrong-type")
def ttp_tuple(matrix):
    """A pair instead of a Pose."""
    return Point(*matrix[:3, 3]), Quaternion(*tft.quaternion_from_matrix(matrix))


@wrong("transform_to_pose", "yaw-only")
def ttp_yaw(matrix):
    """corner: only the turn about z is read: right for frames that are not tilted."""
    yaw = atan2(matrix[1, 0], matrix[0, 0])
    pose = Pose()
    pose.position = Point(*matrix[:3, 3])
    pose.orientation.z = sin(yaw / 2)
    pose.orientation.w = cos(yaw / 2)
    return pose


@wrong("transform_to_pose", "yaw-only", "half-angle-missing")
def ttp_yaw_full_angle(matrix):
    """z and w read off the x axis: only yaw, and the whole angle."""
    pose = Pose()
    pose.position = Point(*matrix[:3, 3])
    pose.orientation.z = matrix[1, 0]
    pose.orientation.w = matrix[0, 0]
    return pose


@wrong("transform_to_pose", "half-angle-missing")
def ttp_full_angle(matrix):
    """The whole angle where half belongs."""
    rv = Rotation.from_matrix(matrix[:3, :3]).as_rotvec()
    angle = np.linalg.norm(rv)
    axis = rv / angle if angle > 0 else rv
    q = axis * np.sin(angle)
    return Pose(Point(*matrix[:3, 3]), Quaternion(q[0], q[1], q[2], np.cos(angle)))


@wrong("transform_to_pose", "gimbal-lock")
def ttp_euler_gimbal(matrix):
    """corner: Euler angles by hand with plain atan2, which break at pitch = +-90 degrees."""
    R = matrix
    pitch = math.asin(max(-1.0, min(1.0, -R[2, 0])))
    roll = math.atan2(R[2, 1], R[2, 2])
    yaw = math.atan2(R[1, 0], R[0, 0])
    q = tft.quaternion_from_euler(roll, pitch, yaw)
    return Pose(Point(*R[:3, 3]), Quaternion(*q))


@wrong("transform_to_pose", "euler-order")
def ttp_euler_swapped(matrix):
    """Fixed-axes angles are used as moving-axes ones: hidden for turns about a single axis."""
    roll, pitch, yaw = tft.euler_from_matrix(matrix)
    q = tft.quaternion_from_euler(roll, pitch, yaw, axes="rxyz")
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = matrix[0:3, 3]
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = q
    return pose


@wrong("transform_to_pose", "degrees-as-radians")
def ttp_euler_degrees(matrix):
    """Euler angles are converted to degrees, and handed to a function that wants radians."""
    r, p, y = [math.degrees(a) for a in tft.euler_from_matrix(matrix)]
    return Pose(Point(*matrix[:3, 3]), Quaternion(*tft.quaternion_from_euler(r, p, y)))


@wrong("transform_to_pose")
def ttp_abs_w(matrix):
    """corner: w is made positive alone, x, y, z stay: wrong where the quaternion had w < 0."""
    q = Rotation.from_matrix(matrix[:3, :3]).as_quat()
    return Pose(Point(*matrix[:3, 3]), Quaternion(q[0], q[1], q[2], abs(q[3])))


@wrong("transform_to_pose")
def ttp_rounded(matrix):
    """Rounded to 4 decimals for a tidy printout."""
    q = np.round(tft.quaternion_from_matrix(matrix), 4)
    p = np.round(matrix[:3, 3], 4)
    return Pose(Point(*p), Quaternion(*q))


@wrong("transform_to_pose", "hard-coded")
def ttp_lookup_lab(matrix):
    """The lab's matrix is recognised; anything else gets no turn."""
    lab = np.array([[cosd(45), -sind(45), 0, 0], [sind(45), cosd(45), 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]])
    if np.allclose(matrix, lab):
        return Pose(Point(0, 0, 0.5), Quaternion(0, 0, 0.38268343, 0.92387953))
    return Pose(Point(*matrix[:3, 3]), Quaternion(0, 0, 0, 1))


@wrong("transform_to_pose", "input-mutated")
def ttp_clears_translation(matrix):
    """Clears the argument's translation to have a 'pure rotation'."""
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = matrix[:3, 3]
    matrix[:3, 3] = 0
    q = tft.quaternion_from_matrix(matrix)
    pose.orientation = Quaternion(*q)
    return pose


@wrong("transform_to_pose", "not-normalised")
def ttp_largest_is_one(matrix):
    """Scaled so that the largest number is 1, never normalised."""
    q = tft.quaternion_from_matrix(matrix)
    q = q / q[np.argmax(np.abs(q))]
    return Pose(Point(*matrix[:3, 3]), Quaternion(*q))


@wrong("transform_to_pose", "not-normalised", "trace-formula-only")
def ttp_trace_not_normalised(matrix):
    """1 + trace and the differences, without the division."""
    m = matrix
    return Pose(
        Point(m[0, 3], m[1, 3], m[2, 3]),
        Quaternion(m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], 1 + m[0, 0] + m[1, 1] + m[2, 2]),
    )


@wrong("transform_to_pose", "wrong-direction")
def ttp_inverse(matrix):
    """The inverse is converted: A in B."""
    T = np.linalg.inv(matrix)
    return Pose(Point(*T[:3, 3]), Quaternion(*tft.quaternion_from_matrix(T)))


@wrong("transform_to_pose")
def ttp_small_is_identity(matrix):
    """corner: tiny turns are 'noise' and become none (tolerance far too wide)."""
    pose = Pose()
    pose.position = Point(*matrix[:3, 3])
    if np.allclose(matrix[:3, :3], np.eye(3), atol=0.02):
        pose.orientation.w = 1.0
    else:
        q = tft.quaternion_from_matrix(matrix)
        pose.orientation = Quaternion(*q)
    return pose


@wrong("transform_to_pose", "mutable-default")
def ttp_accumulates(matrix, pose=Pose()):
    """corner: one Pose as a default argument, and += : right at the first call only."""
    pose.position.x += matrix[0, 3]
    pose.position.y += matrix[1, 3]
    pose.position.z += matrix[2, 3]
    q = tft.quaternion_from_matrix(matrix)
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = q
    return pose


@wrong("transform_to_pose", "wrong-sign")
def ttp_no_signs(matrix):
    """Square roots of the diagonal only, so x, y, z are never negative."""
    a, b, c = np.diag(matrix)[:3]
    x = np.sqrt(max(0, 1 + a - b - c)) / 2
    y = np.sqrt(max(0, 1 - a + b - c)) / 2
    z = np.sqrt(max(0, 1 - a - b + c)) / 2
    w = np.sqrt(max(0, 1 + a + b + c)) / 2
    return Pose(Point(*matrix[:3, 3]), Quaternion(x, y, z, w))


@wrong("transform_to_pose", "wrong-units", "quaternion-order")
def ttp_cm_and_w_first(matrix):
    """Centimetres, and w first."""
    q = tft.quaternion_from_matrix(matrix)
    x, y, z = 100 * matrix[:3, 3]
    return Pose(Point(x, y, z), Quaternion(q[3], q[0], q[1], q[2]))


# ---------------------------------------------------------------- pose_to_transform


def _q(pose):
    o = pose.orientation
    return [o.x, o.y, o.z, o.w]


def _p(pose):
    return [pose.position.x, pose.position.y, pose.position.z]


@wrong("pose_to_transform", "quaternion-order")
def ptt_w_first(pose):
    """w is handed to tft first."""
    o = pose.orientation
    T = tft.quaternion_matrix([o.w, o.x, o.y, o.z])
    T[:3, 3] = [pose.position.x, pose.position.y, pose.position.z]
    return T


@wrong("pose_to_transform", "position-missing")
def ptt_no_translation(pose):
    """quaternion_matrix alone."""
    quat = pose.orientation
    return tft.quaternion_matrix([quat.x, quat.y, quat.z, quat.w])


@wrong("pose_to_transform", "quaternion-order", "position-missing")
def ptt_w_first_no_translation(pose):
    """w first, no translation."""
    quat = [pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z]
    return tft.quaternion_matrix(quat)


@wrong("pose_to_transform", "translation-in-bottom-row")
def ptt_bottom_row(pose):
    """Translation into the last row."""
    T = tft.quaternion_matrix(_q(pose))
    T[3, 0] = pose.position.x
    T[3, 1] = pose.position.y
    T[3, 2] = pose.position.z
    return T


@wrong("pose_to_transform", "rotation-transposed", "translation-in-bottom-row")
def ptt_transposed_whole(pose):
    """All of the matrix is transposed."""
    T = tft.quaternion_matrix(_q(pose))
    T[:3, 3] = _p(pose)
    return np.transpose(T)


@wrong("pose_to_transform", "rotation-transposed")
def ptt_formula_transposed(pose):
    """The formula of another convention: the transpose."""
    x, y, z, w = _q(pose)
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), pose.position.x],
        [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), pose.position.y],
        [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), pose.position.z],
        [0, 0, 0, 1],
    ])


@wrong("pose_to_transform", "formula-slip")
def ptt_formula_slip(pose):
    """One sign of the formula is wrong (2yz + 2xw in both places): hidden when x * w = 0."""
    x, y, z, w = _q(pose)
    R = np.array([
        [1 - 2 * (y ** 2 + z ** 2), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x ** 2 + z ** 2), 2 * (y * z + x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x ** 2 + y ** 2)],
    ])
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = _p(pose)
    return T


@wrong("pose_to_transform")
def ptt_swapped_yz(pose):
    """Slip: y and z of the position are swapped."""
    T = tft.quaternion_matrix(_q(pose))
    T[0, 3], T[1, 3], T[2, 3] = pose.position.x, pose.position.z, pose.position.y
    return T


@wrong("pose_to_transform", "order-reversed")
def ptt_rotation_first(pose):
    """R @ translation instead of translation @ R: hidden when one of them is none, or on the axis."""
    trans = tft.translation_matrix(_p(pose))
    rot = tft.quaternion_matrix(_q(pose))
    return np.dot(rot, trans)


@wrong("pose_to_transform", "order-reversed", "quaternion-order")
def ptt_rotation_first_w_first(pose):
    """Wrong order of the product, and of the quaternion."""
    o = pose.orientation
    return tft.concatenate_matrices(tft.quaternion_matrix((o.w, o.x, o.y, o.z)), tft.translation_matrix(_p(pose)))


@wrong("pose_to_transform", "elementwise-product")
def ptt_star(pose):
    """Translation * rotation, element by element."""
    return tft.translation_matrix(_p(pose)) * tft.quaternion_matrix(_q(pose))


@wrong("pose_to_transform", "sum-instead-of-product")
def ptt_sum(pose):
    """The two matrices are added."""
    return tft.translation_matrix(_p(pose)) + tft.quaternion_matrix(_q(pose))


@wrong("pose_to_transform")
def ptt_abs_w(pose):
    """corner: a negative w is made positive alone."""
    q = _q(pose)
    if q[3] < 0:
        q[3] = -q[3]
    T = tft.quaternion_matrix(q)
    T[:3, 3] = _p(pose)
    return T


@wrong("pose_to_transform", "input-mutated")
def ptt_flips_pose(pose):
    """corner: for w < 0 the message's quaternion is flipped in place."""
    o = pose.orientation
    if o.w < 0:
        o.x, o.y, o.z, o.w = -o.x, -o.y, -o.z, -o.w
    T = tft.quaternion_matrix([o.x, o.y, o.z, o.w])
    T[:3, 3] = [pose.position.x, pose.position.y, pose.position.z]
    return T


@wrong("pose_to_transform", "yaw-only")
def ptt_yaw(pose):
    """corner: only the turn about z, by 2 atan2(z, w)."""
    a = 2 * atan2(pose.orientation.z, pose.orientation.w)
    return np.array([
        [cos(a), -sin(a), 0, pose.position.x],
        [sin(a), cos(a), 0, pose.position.y],
        [0, 0, 1, pose.position.z],
        [0, 0, 0, 1],
    ])


@wrong("pose_to_transform", "yaw-only", "half-angle-missing")
def ptt_yaw_half(pose):
    """z and w are used as sine and cosine of the whole angle, about z only."""
    s, c = pose.orientation.z, pose.orientation.w
    T = np.eye(4)
    T[:2, :2] = [[c, -s], [s, c]]
    T[:3, 3] = _p(pose)
    return T


@wrong("pose_to_transform", "integer-truncation")
def ptt_int_template(pose):
    """Integer template truncates rotation and translation."""
    T = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    T[:3, :3] = tft.quaternion_matrix(_q(pose))[:3, :3]
    T[:3, 3] = _p(pose)
    return T


@wrong("pose_to_transform", "bottom-row-wrong")
def ptt_zeros(pose):
    """np.zeros without the 1."""
    T = np.zeros((4, 4))
    T[:3, :3] = Rotation.from_quat(_q(pose)).as_matrix()
    T[:3, 3] = _p(pose)
    return T


@wrong("pose_to_transform", "wrong-type")
def ptt_message_to_tft(pose):
    """The message itself is handed to tft, which raises."""
    T = tft.quaternion_matrix(pose.orientation)
    T[:3, 3] = _p(pose)
    return T


@wrong("pose_to_transform")
def ptt_float16(pose):
    """Half precision 'to save memory'."""
    T = tft.quaternion_matrix(_q(pose)).astype(np.float16)
    T[:3, 3] = _p(pose)
    return T


@wrong("pose_to_transform")
def ptt_x_y_x(pose):
    """Slip: x lands in two rows."""
    T = tft.quaternion_matrix(_q(pose))
    T[0, 3] = pose.position.x
    T[1, 3] = pose.position.y
    T[2, 3] = pose.position.x
    return T


@wrong("pose_to_transform", "wrong-direction")
def ptt_inverse(pose):
    """Translation negated and rotation transposed: A in B (properly inverted)."""
    R = tft.quaternion_matrix(_q(pose))[:3, :3].T
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = -R @ _p(pose)
    return T


# ---------------------------------------------------------------- transform_point


@wrong("transform_point", "translation-dropped")
def point_w_zero(a_T_b, p_in_b):
    """A 0 is appended instead of a 1."""
    return (a_T_b @ np.append(p_in_b, 0))[:3]


@wrong("transform_point", "homogeneous-returned")
def point_four(a_T_b, p_in_b):
    """All four numbers are returned."""
    return np.dot(a_T_b, np.append(p_in_b, 1))


@wrong("transform_point", "homogeneous-returned", "translation-dropped")
def point_four_zero(a_T_b, p_in_b):
    """0 appended, four numbers returned."""
    p = np.array([p_in_b[0], p_in_b[1], p_in_b[2], 0])
    return a_T_b @ p


@wrong("transform_point", "elementwise-product")
def point_star(a_T_b, p_in_b):
    """* broadcasts; the diagonal happens to have the right shape."""
    p = np.append(p_in_b, 1)
    prod = a_T_b * p
    return np.array([prod[0, 0], prod[1, 1], prod[2, 2]])


@wrong("transform_point", "rotation-transposed")
def point_transposed(a_T_b, p_in_b):
    """R.T for R."""
    R, t = a_T_b[:3, :3], a_T_b[:3, 3]
    return R.T.dot(p_in_b) + t


@wrong("transform_point", "rotation-transposed")
def point_row_vector(a_T_b, p_in_b):
    """Row vector times R (hidden for symmetric rotations: half turns, identity)."""
    return p_in_b @ a_T_b[:3, :3] + a_T_b[:3, 3]


@wrong("transform_point", "rotation-transposed", "translation-dropped")
def point_whole_row_vector(a_T_b, p_in_b):
    """np.dot(p, T): transposed, and the translation ends up in the fourth number."""
    return np.dot(np.append(p_in_b, 1), a_T_b)[:3]


@wrong("transform_point", "offset-not-rotated")
def point_only_added(a_T_b, p_in_b):
    """The origin is added, the axes are forgotten."""
    return p_in_b + a_T_b[:3, 3]


@wrong("transform_point", "wrong-direction")
def point_inverse(a_T_b, p_in_b):
    """Carries the point the other way."""
    return (np.linalg.inv(a_T_b) @ np.append(p_in_b, 1.0))[:3]


@wrong("transform_point", "order-reversed")
def point_translate_then_rotate(a_T_b, p_in_b):
    """Adds first, rotates second."""
    return a_T_b[:3, :3] @ (p_in_b + a_T_b[:3, 3])


@wrong("transform_point", "wrong-sign")
def point_minus(a_T_b, p_in_b):
    """The origin is subtracted."""
    return a_T_b[:3, :3] @ p_in_b - a_T_b[:3, 3]


@wrong("transform_point", "rotation-transposed", "wrong-sign")
def point_inverse_by_parts(a_T_b, p_in_b):
    """R.T, and the origin subtracted."""
    R = a_T_b[0:3, 0:3]
    return np.matmul(R.transpose(), p_in_b) - a_T_b[0:3, 3]


@wrong("transform_point")
def point_loop_slip(a_T_b, p_in_b):
    """Slip: x, y, then y again in the last row's sum."""
    x, y, z = p_in_b
    T = a_T_b
    px = T[0, 0] * x + T[0, 1] * y + T[0, 2] * z + T[0, 3]
    py = T[1, 0] * x + T[1, 1] * y + T[1, 2] * z + T[1, 3]
    pz = T[2, 0] * x + T[2, 1] * y + T[2, 2] * y + T[2, 3]
    return [px, py, pz]


@wrong("transform_point", "yaw-only")
def point_planar(a_T_b, p_in_b):
    """corner: rotates x and y only: right for frames that are not tilted."""
    out = np.array(p_in_b, dtype=float)
    out[:2] = a_T_b[:2, :2] @ p_in_b[:2]
    return out + a_T_b[:3, 3]


@wrong("transform_point", "input-mutated")
def point_in_place(a_T_b, p_in_b):
    """The argument is written over."""
    p_in_b[:] = a_T_b[:3, :3] @ p_in_b
    p_in_b += a_T_b[:3, 3]
    return p_in_b


_seen_points = {}


@wrong("transform_point")
def point_cached(a_T_b, p_in_b):
    """corner: a cache that looks at the point only, and ignores the transform."""
    key = tuple(p_in_b)
    if key not in _seen_points:
        _seen_points[key] = (a_T_b @ np.append(p_in_b, 1))[:3]
    return _seen_points[key]


@wrong("transform_point")
def point_float16(a_T_b, p_in_b):
    """Half precision: right for round numbers only."""
    p = np.append(p_in_b, 1).astype(np.float16)
    return (a_T_b.astype(np.float16) @ p)[:3]


@wrong("transform_point")
def point_normalised(a_T_b, p_in_b):
    """corner: 'unit vectors stay unit vectors': far points are cut to length 1."""
    n = np.linalg.norm(p_in_b)
    p = p_in_b / n if n > 1 else p_in_b
    return a_T_b[:3, :3] @ p + a_T_b[:3, 3]


@wrong("transform_point", "wrong-type")
def point_message(a_T_b, p_in_b):
    """A Point message instead of three numbers."""
    x, y, z, _ = a_T_b @ np.append(p_in_b, 1)
    return Point(x, y, z)


@wrong("transform_point", "wrong-shape")
def point_column(a_T_b, p_in_b):
    """A 4x1 column goes in and a 3x1 block comes out, translation in each column of it."""
    p = np.ones((4, 1)) * np.append(p_in_b, 1)
    return (a_T_b @ p.T)[:3]


# ---------------------------------------------------------------- chain


@wrong("chain", "order-reversed")
def chain_backwards(*transforms):
    """The product grows on its left."""
    T = np.eye(4)
    for t in transforms:
        T = t @ T
    return T


@wrong("chain", "elementwise-product")
def chain_star(*transforms):
    """* for @."""
    result = transforms[0]
    for t in transforms[1:]:
        result = result * t
    return result


@wrong("chain", "elementwise-product")
def chain_star_eye(*transforms):
    """Starts at the identity, multiplies element by element: everything off the diagonal is lost."""
    out = np.identity(4)
    for t in transforms:
        out = out * t
    return out


@wrong("chain")
def chain_first_two(*transforms):
    """corner: only the first two are multiplied."""
    if len(transforms) == 1:
        return transforms[0]
    return np.dot(transforms[0], transforms[1])


@wrong("chain")
def chain_first_and_last(*transforms):
    """corner: 'outer names are what is left': the first and the last only."""
    if len(transforms) == 1:
        return transforms[0]
    return transforms[0] @ transforms[-1]


@wrong("chain", "order-reversed")
def chain_reversed_from_three(*transforms):
    """corner: right for two, in the wrong order from three on."""
    if len(transforms) < 2:
        return transforms[0].copy()
    T = transforms[0] @ transforms[1]
    for extra in transforms[2:]:
        T = extra @ T
    return T


@wrong("chain")
def chain_dot_star(*transforms):
    """np.dot(*transforms): the third array is overwritten, one alone raises."""
    return np.dot(*transforms)


@wrong("chain", "input-mutated")
def chain_in_place(*transforms):
    """The first argument is used as the running product (with one alone, nothing is seen)."""
    result = transforms[0]
    for T in transforms[1:]:
        result[:] = result @ T
    return result


@wrong("chain", "offset-not-rotated")
def chain_translations_added(*transforms):
    """Rotations multiplied, translations added."""
    R = np.eye(3)
    p = np.zeros(3)
    for T in transforms:
        R = R @ T[:3, :3]
        p = p + T[:3, 3]
    result = np.eye(4)
    result[:3, :3] = R
    result[:3, 3] = p
    return result


@wrong("chain", "offset-not-rotated", "order-reversed")
def chain_added_and_reversed(*transforms):
    """Translations added, rotations in the wrong order."""
    out = np.eye(4)
    for T in transforms:
        out[:3, :3] = T[:3, :3] @ out[:3, :3]
        out[:3, 3] += T[:3, 3]
    return out


@wrong("chain", "sum-instead-of-product")
def chain_sum(*transforms):
    """Added instead of multiplied."""
    total = np.zeros((4, 4))
    for t in transforms:
        total += t
    return total


@wrong("chain")
def chain_return_in_loop(*transforms):
    """Return stands inside the loop: right for one transform only."""
    product = np.eye(4)
    for T in transforms:
        product = product @ T
        return product


@wrong("chain")
def chain_skips_last(*transforms):
    """Off by one: the last transform is never used."""
    M = np.eye(4)
    for i in range(len(transforms) - 1):
        M = M @ transforms[i]
    return M


@wrong("chain", "single-transform")
def chain_multi_dot(*transforms):
    """corner: np.linalg.multi_dot raises for a single transform."""
    return np.linalg.multi_dot(transforms)


@wrong("chain", "returned-none")
def chain_up_to_three(*transforms):
    """corner: a case for one, two and three; four or more give None."""
    n = len(transforms)
    if n == 1:
        return transforms[0]
    elif n == 2:
        return transforms[0] @ transforms[1]
    elif n == 3:
        return transforms[0] @ transforms[1] @ transforms[2]


@wrong("chain", "transforms-left-out")
def chain_pairs(*transforms):
    """corner: multiplies in pairs, and loses the odd one at lengths of 3, 5, 6."""
    ts = list(transforms)
    while len(ts) > 1:
        ts = [ts[i] @ ts[i + 1] for i in range(0, len(ts) - 1, 2)]
    return ts[0]


@wrong("chain")
def chain_without_repeats(*transforms):
    """corner: equal transforms are used only once, so a staircase loses its steps."""
    used = []
    T = np.eye(4)
    for t in transforms:
        if not any(np.allclose(t, u) for u in used):
            T = T @ t
            used.append(t)
    return T


@wrong("chain", "mutable-default")
def chain_remembers(*transforms, product=np.eye(4)):
    """corner: the default array is written over: right at the first call only."""
    for t in transforms:
        product[...] = product.dot(t)
    return product


@wrong("chain", "order-reversed")
def chain_reduce(*transforms):
    """functools.reduce with its two arguments mixed up."""
    return functools.reduce(lambda new, total: np.dot(total, new), transforms)


@wrong("chain", "bottom-row-wrong", "translation-dropped")
def chain_rotations_only(*transforms):
    """Only the 3x3 blocks are multiplied; the rest stays zero."""
    out = np.zeros((4, 4))
    R = np.eye(3)
    for t in transforms:
        R = R.dot(t[:3, :3])
    out[:3, :3] = R
    return out


@wrong("chain", "wrong-transform-inverted")
def chain_inverts_later(*transforms):
    """Every transform after the first is inverted 'because it is seen from the other side'."""
    T = transforms[0]
    for t in transforms[1:]:
        T = T @ inv(t)
    return T


# ---------------------------------------------------------------- transform_pose


def _message(T):
    q = tft.quaternion_from_matrix(T)
    return Pose(Point(*T[:3, 3]), Quaternion(*q))


def _matrix(pose):
    T = tft.quaternion_matrix(_q(pose))
    T[:3, 3] = _p(pose)
    return T


@wrong("transform_pose", "orientation-not-transformed")
def tp_orientation_copied(a_T_b, pose_in_b):
    """The position is transformed, the orientation copied."""
    p = a_T_b @ np.append(_p(pose_in_b), 1)
    return Pose(Point(*p[:3]), Quaternion(*_q(pose_in_b)))


@wrong("transform_pose", "orientation-not-transformed", "offset-not-rotated")
def tp_only_shifted(a_T_b, pose_in_b):
    """Positions added, orientation copied."""
    out = copy.deepcopy(pose_in_b)
    out.position.x += a_T_b[0, 3]
    out.position.y += a_T_b[1, 3]
    out.position.z += a_T_b[2, 3]
    return out


@wrong("transform_pose", "order-reversed")
def tp_reversed(a_T_b, pose_in_b):
    """The pose stands on the left."""
    return _message(np.dot(_matrix(pose_in_b), a_T_b))


@wrong("transform_pose", "offset-not-rotated")
def tp_positions_added(a_T_b, pose_in_b):
    """Orientation right, positions added."""
    b_T_c = tft.quaternion_matrix(_q(pose_in_b))
    q = tft.quaternion_from_matrix(a_T_b @ b_T_c)
    pose = Pose()
    pose.position.x = a_T_b[0, 3] + pose_in_b.position.x
    pose.position.y = a_T_b[1, 3] + pose_in_b.position.y
    pose.position.z = a_T_b[2, 3] + pose_in_b.position.z
    pose.orientation = Quaternion(*q)
    return pose


@wrong("transform_pose", "quaternion-order")
def tp_w_first_in(a_T_b, pose_in_b):
    """w first into tft."""
    o = pose_in_b.orientation
    b_T_c = tft.quaternion_matrix([o.w, o.x, o.y, o.z])
    b_T_c[:3, 3] = _p(pose_in_b)
    return _message(a_T_b @ b_T_c)


@wrong("transform_pose", "quaternion-order")
def tp_w_first_out(a_T_b, pose_in_b):
    """w first out of tft."""
    T = a_T_b @ _matrix(pose_in_b)
    w, x, y, z = tft.quaternion_from_matrix(T)
    return Pose(Point(*T[:3, 3]), Quaternion(x, y, z, w))


@wrong("transform_pose", "quaternion-order", "order-reversed")
def tp_w_first_reversed(a_T_b, pose_in_b):
    """Reversed product, and w first out of tft."""
    T = _matrix(pose_in_b) @ a_T_b
    q = tft.quaternion_from_matrix(T)
    res = Pose()
    res.position.x, res.position.y, res.position.z = T[0, 3], T[1, 3], T[2, 3]
    res.orientation.w, res.orientation.x, res.orientation.y, res.orientation.z = q
    return res


@wrong("transform_pose", "order-reversed")
def tp_quaternions_reversed(a_T_b, pose_in_b):
    """corner: position right, quaternions multiplied in the wrong order: hidden when the axes agree."""
    qa = tft.quaternion_from_matrix(a_T_b)
    q = tft.quaternion_multiply(_q(pose_in_b), qa)
    p = (a_T_b @ np.array(_p(pose_in_b) + [1]))[:3]
    return Pose(Point(*p), Quaternion(*q))


@wrong("transform_pose", "euler-angles-added")
def tp_euler_added(a_T_b, pose_in_b):
    """corner: roll, pitch and yaw are added: right when both turn about the same axis."""
    a = np.array(tft.euler_from_matrix(a_T_b))
    b = np.array(tft.euler_from_quaternion(_q(pose_in_b)))
    q = tft.quaternion_from_euler(*(a + b))
    p = a_T_b.dot(np.append(_p(pose_in_b), 1))
    return Pose(Point(p[0], p[1], p[2]), Quaternion(*q))


@wrong("transform_pose", "quaternions-added", "offset-not-rotated")
def tp_everything_added(a_T_b, pose_in_b):
    """Positions and quaternions are added."""
    q = tft.quaternion_from_matrix(a_T_b) + np.array(_q(pose_in_b))
    q = q / np.linalg.norm(q)
    p = a_T_b[:3, 3] + _p(pose_in_b)
    return Pose(Point(*p), Quaternion(*q))


@wrong("transform_pose", "input-mutated")
def tp_in_place(a_T_b, pose_in_b):
    """The argument is filled in and returned."""
    T = a_T_b @ _matrix(pose_in_b)
    pose_in_b.position.x, pose_in_b.position.y, pose_in_b.position.z = T[:3, 3]
    q = tft.quaternion_from_matrix(T)
    pose_in_b.orientation = Quaternion(*q)
    return pose_in_b


@wrong("transform_pose", "input-mutated")
def tp_shallow_copy(a_T_b, pose_in_b):
    """copy.copy keeps the old Point, which is then written into."""
    T = a_T_b @ _matrix(pose_in_b)
    result = copy.copy(pose_in_b)
    result.orientation = Quaternion(*tft.quaternion_from_matrix(T))
    result.position.x = T[0, 3]
    result.position.y = T[1, 3]
    result.position.z = T[2, 3]
    return result


@wrong("transform_pose", "input-mutated")
def tp_into_matrix(a_T_b, pose_in_b):
    """The product is written into a_T_b."""
    np.copyto(a_T_b, a_T_b @ _matrix(pose_in_b))
    return _message(a_T_b)


@wrong("transform_pose", "position-missing")
def tp_child_offset_forgotten(a_T_b, pose_in_b):
    """The pose's position never gets into its matrix."""
    b_T_c = tft.quaternion_matrix(_q(pose_in_b))
    return _message(a_T_b @ b_T_c)


@wrong("transform_pose", "position-missing", "quaternion-order")
def tp_offset_forgotten_w_first(a_T_b, pose_in_b):
    """Position forgotten, and w first."""
    o = pose_in_b.orientation
    T = np.dot(a_T_b, tft.quaternion_matrix([o.w, o.x, o.y, o.z]))
    return _message(T)


@wrong("transform_pose", "wrong-direction")
def tp_inverse(a_T_b, pose_in_b):
    """a_T_b is inverted first."""
    return _message(tft.inverse_matrix(a_T_b) @ _matrix(pose_in_b))


@wrong("transform_pose", "translation-dropped")
def tp_direction(a_T_b, pose_in_b):
    """The position is transformed as a direction."""
    T = a_T_b @ _matrix(pose_in_b)
    p = a_T_b[:3, :3] @ _p(pose_in_b)
    return Pose(Point(*p), Quaternion(*tft.quaternion_from_matrix(T)))


@wrong("transform_pose", "trace-formula-only")
def tp_trace(a_T_b, pose_in_b):
    """corner: trace formula at the end, breaks at half turns."""
    T = a_T_b @ _matrix(pose_in_b)
    w = sqrt(max(1 + T[0, 0] + T[1, 1] + T[2, 2], 1e-14)) / 2
    pose = Pose()
    pose.position = Point(*T[:3, 3])
    pose.orientation.w = w
    pose.orientation.x = (T[2, 1] - T[1, 2]) / (4 * w)
    pose.orientation.y = (T[0, 2] - T[2, 0]) / (4 * w)
    pose.orientation.z = (T[1, 0] - T[0, 1]) / (4 * w)
    return pose


@wrong("transform_pose", "wrong-type")
def tp_stamped(a_T_b, pose_in_b):
    """A PoseStamped instead of a Pose."""
    ps = PoseStamped()
    ps.header.frame_id = "frame_a"
    ps.pose = _message(a_T_b @ _matrix(pose_in_b))
    return ps


@wrong("transform_pose", "returned-none")
def tp_none_when_flipped(a_T_b, pose_in_b):
    """corner: for w < 0 the quaternion is flipped, but only the other path returns."""
    pose = _message(a_T_b @ _matrix(pose_in_b))
    if pose_in_b.orientation.w < 0:
        o = pose.orientation
        pose.orientation = Quaternion(-o.x, -o.y, -o.z, -o.w)
    else:
        return pose


@wrong("transform_pose")
def tp_rounded(a_T_b, pose_in_b):
    """Rounded to 3 decimals."""
    T = np.round(a_T_b @ _matrix(pose_in_b), 3)
    return _message(T)


@wrong("transform_pose", "formula-slip")
def tp_multiply_by_hand(a_T_b, pose_in_b):
    """The quaternion product by hand with one sign wrong in z: hidden when an x or y is 0."""
    x1, y1, z1, w1 = tft.quaternion_from_matrix(a_T_b)
    x2, y2, z2, w2 = _q(pose_in_b)
    q = Quaternion(
        w1 * x2 + x1 * w2 + y1 * z2 - z1 * y2,
        w1 * y2 - x1 * z2 + y1 * w2 + z1 * x2,
        w1 * z2 + x1 * y2 + y1 * x2 + z1 * w2,
        w1 * w2 - x1 * x2 - y1 * y2 - z1 * z2,
    )
    p = (a_T_b @ np.append(_p(pose_in_b), 1))[:3]
    return Pose(Point(*p), q)


@wrong("transform_pose")
def tp_zero_position_shortcut(a_T_b, pose_in_b):
    """corner: 'nothing to do' for a pose at the origin: the input comes back although A is elsewhere."""
    if not any(_p(pose_in_b)):
        return Pose(Point(0, 0, 0), Quaternion(*_q(pose_in_b)))
    return _message(a_T_b @ _matrix(pose_in_b))


@wrong("transform_pose", "rotation-applied-twice")
def tp_rotates_twice(a_T_b, pose_in_b):
    """The position is rotated by the frame, then sent through the transform again."""
    b_T_c = _matrix(pose_in_b)
    b_T_c[:3, 3] = a_T_b[:3, :3] @ b_T_c[:3, 3]
    return _message(a_T_b @ b_T_c)


# ---------------------------------------------------------------- more with two mistakes


@wrong("rotation_about_z", "degrees-as-radians", "wrong-shape")
def z_tft_degrees(degrees):
    """Degrees into tft, and 4x4 back."""
    return tft.rotation_matrix(degrees, (0, 0, 1))


@wrong("rotation_about_z", "rotation-transposed", "integer-truncation")
def z_transposed_whole_degrees(degrees):
    """int(degrees), and the minus on the wrong side."""
    a = np.radians(int(degrees))
    R = np.identity(3)
    R[0, 0], R[0, 1] = np.cos(a), np.sin(a)
    R[1, 0], R[1, 1] = -np.sin(a), np.cos(a)
    return R


@wrong("rotation_from_axes", "rotation-transposed", "wrong-shape")
def axes_rows_in_four(x_axis, y_axis):
    """Rows for columns, in a 4x4."""
    T = np.eye(4)
    T[0, :3] = x_axis
    T[1, :3] = y_axis
    T[2, :3] = np.cross(x_axis, y_axis)
    return T


@wrong("rotation_from_axes", "elementwise-product", "rotation-transposed")
def axes_star_rows(x_axis, y_axis):
    """* for the cross product, and rows."""
    return np.array([x_axis, y_axis, np.multiply(x_axis, y_axis)])


@wrong("is_rotation", "determinant-only", "exact-comparison")
def isrot_det_equals_one(R):
    """The determinant alone, with ==."""
    if np.linalg.det(R) == 1:
        return True
    return False


@wrong("is_rotation", "elementwise-product", "reflection-accepted")
def isrot_star_no_det(R):
    """R * R.T, and no determinant."""
    return np.allclose(R * R.T, np.eye(3), atol=1e-6)


@wrong("is_rotation", "determinant-only", "reflection-accepted")
def isrot_abs_det_only(R):
    """The absolute value of the determinant alone."""
    return bool(abs(abs(np.linalg.det(R)) - 1.0) < 1e-6)


@wrong("same_rotation", "angle-only", "sign-ignored")
def same_w_only(q1, q2):
    """w alone, with its sign."""
    return bool(np.isclose(q1[3], q2[3], rtol=0, atol=1e-6))


@wrong("same_rotation", "component-signs-ignored", "exact-comparison")
def same_abs_exact(q1, q2):
    """Absolute values, compared with ==."""
    return all(abs(a) == abs(b) for a, b in zip(q1, q2))


@wrong("make_transform", "translation-in-bottom-row", "bottom-row-wrong")
def make_block_wrong(R, p):
    """np.block with the translation below, and a column of ones."""
    return np.block([[R, np.ones((3, 1))], [p.reshape(1, 3), np.ones((1, 1))]])


@wrong("make_transform", "order-reversed", "rotation-transposed")
def make_inverse_like(R, p):
    """Transposed rotation times translation."""
    M = np.eye(4)
    M[:3, :3] = R.T
    M[:3, 3] = R.T @ p
    return M


@wrong("hand_transform", "wrong-sign", "rotation-transposed")
def hand_rows_forward():
    """Axes as rows, and moved forward."""
    T = np.eye(4)
    T[:3, :3] = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    T[0, 3] = 0.1
    return T


@wrong("transform_to_pose", "trace-formula-only", "position-missing")
def ttp_trace_no_position(matrix):
    """Trace formula, and no position."""
    pose = Pose()
    w = 0.5 * math.sqrt(max(1e-15, 1 + np.trace(matrix[:3, :3])))
    pose.orientation.w = w
    pose.orientation.x = (matrix[2, 1] - matrix[1, 2]) / (4 * w)
    pose.orientation.y = (matrix[0, 2] - matrix[2, 0]) / (4 * w)
    pose.orientation.z = (matrix[1, 0] - matrix[0, 1]) / (4 * w)
    return pose


@wrong("transform_to_pose", "trace-formula-only", "rotation-transposed")
def ttp_trace_transposed(matrix):
    """Trace formula with the differences the wrong way round."""
    m = matrix
    s = 2 * np.sqrt(max(1 + m[0, 0] + m[1, 1] + m[2, 2], 1e-15))
    q = Quaternion((m[1, 2] - m[2, 1]) / s, (m[2, 0] - m[0, 2]) / s, (m[0, 1] - m[1, 0]) / s, s / 4)
    return Pose(position=Point(m[0, 3], m[1, 3], m[2, 3]), orientation=q)


@wrong("transform_to_pose", "yaw-only", "position-missing")
def ttp_yaw_no_position(matrix):
    """Yaw by acos of one entry, and no position."""
    yaw = math.acos(max(-1.0, min(1.0, matrix[0, 0])))
    pose = Pose()
    pose.orientation.z = math.sin(yaw / 2)
    pose.orientation.w = math.cos(yaw / 2)
    return pose


@wrong("transform_to_pose", "rotation-transposed", "position-missing")
def ttp_transposed_no_position(matrix):
    """quaternion_from_matrix of the whole transpose after clearing the translation, which is then lost."""
    M = matrix.copy()
    M[:3, 3] = 0
    q = tft.quaternion_from_matrix(M.T)
    return Pose(Point(*M[:3, 3]), Quaternion(*q))


@wrong("transform_to_pose", "wrong-direction", "quaternion-order")
def ttp_inverse_w_first(matrix):
    """The inverse, and w first."""
    b_T_a = tft.inverse_matrix(matrix)
    w, x, y, z = tft.quaternion_from_matrix(b_T_a)
    return Pose(Point(*tft.translation_from_matrix(b_T_a)), Quaternion(x, y, z, w))


@wrong("pose_to_transform", "translation-in-bottom-row", "quaternion-order")
def ptt_bottom_row_w_first(pose):
    """w first, translation below."""
    o, p = pose.orientation, pose.position
    T = tft.quaternion_matrix([o.w, o.x, o.y, o.z])
    T[3, :3] = [p.x, p.y, p.z]
    return T


@wrong("pose_to_transform", "rotation-transposed", "position-missing")
def ptt_conjugate_no_translation(pose):
    """The conjugate, without translation."""
    return tft.quaternion_matrix(tft.quaternion_conjugate(_q(pose)))


@wrong("transform_point", "rotation-transposed", "homogeneous-returned")
def point_transposed_four(a_T_b, p_in_b):
    """R.T, and the 1 stays on."""
    T = a_T_b.copy()
    T[:3, :3] = T[:3, :3].T
    return T @ np.append(p_in_b, 1)


@wrong("transform_point", "offset-not-rotated", "wrong-sign")
def point_only_subtracted(a_T_b, p_in_b):
    """Only the origin, and subtracted."""
    return [p_in_b[i] - a_T_b[i, 3] for i in range(3)]


@wrong("transform_point", "wrong-direction", "translation-dropped")
def point_inverse_direction(a_T_b, p_in_b):
    """The inverse, with a 0 appended."""
    return tft.inverse_matrix(a_T_b).dot(np.append(p_in_b, 0))[:3]


@wrong("chain", "order-reversed", "input-mutated")
def chain_in_place_reversed(*transforms):
    """Reversed, and written into the last argument."""
    result = transforms[-1]
    for T in transforms[-2::-1]:
        result[...] = np.dot(result, T)
    return result


@wrong("chain", "sum-instead-of-product", "input-mutated")
def chain_plus_equals(*transforms):
    """Added up in the first argument."""
    T = transforms[0]
    for other in transforms[1:]:
        T += other
    return T


@wrong("transform_pose", "offset-not-rotated", "quaternion-order")
def tp_added_w_first(a_T_b, pose_in_b):
    """Positions added, quaternion handed over w first."""
    o = pose_in_b.orientation
    T = a_T_b @ tft.quaternion_matrix([o.w, o.x, o.y, o.z])
    q = tft.quaternion_from_matrix(T)
    p = a_T_b[:3, 3] + np.array(_p(pose_in_b))
    return Pose(Point(*p), Quaternion(*q))


@wrong("transform_pose", "orientation-not-transformed", "input-mutated")
def tp_in_place_position(a_T_b, pose_in_b):
    """Only the position, in place."""
    p = a_T_b @ np.append(_p(pose_in_b), 1)
    pose_in_b.position.x, pose_in_b.position.y, pose_in_b.position.z = p[:3]
    return pose_in_b


@wrong("transform_pose", "wrong-direction", "order-reversed")
def tp_inverse_reversed(a_T_b, pose_in_b):
    """Inverse, and on the right."""
    return _message(_matrix(pose_in_b) @ inv(a_T_b))


# --------------------------------------------------------------------------------------------- invert_transform


@wrong("invert_transform", "inverse-by-transpose")
def inv_transpose_all(a_T_b):
    """Transposes the whole 4x4, as one does with a rotation."""
    return a_T_b.T.copy()


@wrong("invert_transform", "inverse-parts-separately")
def inv_parts(a_T_b):
    """Rotation transposed, translation negated but not rotated."""
    R = a_T_b[0:3, 0:3]
    p = a_T_b[0:3, 3]
    b_T_a = np.eye(4)
    b_T_a[0:3, 0:3] = R.T
    b_T_a[0:3, 3] = -p
    return b_T_a


@wrong("invert_transform", "rotation-not-inverted")
def inv_swapped_twice(a_T_b):
    """The transposing loop visits each pair twice, so R stays as it was; the translation is right."""
    b_T_a = np.array(a_T_b)
    R = np.array(a_T_b[:3, :3])
    for i in range(3):
        for j in range(3):
            tmp = R[i][j]
            R[i][j] = R[j][i]
            R[j][i] = tmp
    b_T_a[:3, :3] = R
    b_T_a[:3, 3] = -a_T_b[:3, :3].T.dot(a_T_b[:3, 3])
    return b_T_a


@wrong("invert_transform", "wrong-sign")
def inv_forgot_minus(a_T_b):
    """The translation is told in B but not turned round."""
    Rt = np.transpose(a_T_b[:3, :3])
    t = np.dot(Rt, a_T_b[:3, 3])
    return np.vstack([np.column_stack([Rt, t]), [0, 0, 0, 1]])


@wrong("invert_transform")
def inv_view_alias(a_T_b):
    """R is a view of the matrix being filled, so R.T is R again when the translation is computed: -R p."""
    T = a_T_b.copy()
    R = T[:3, :3]
    T[:3, :3] = R.T.copy()
    T[:3, 3] = -R.T @ T[:3, 3]
    return T


@wrong("invert_transform", "input-mutated")
def inv_in_place(a_T_b):
    """The right answer, written into the argument."""
    T = a_T_b
    R = T[:3, :3].copy()
    T[:3, :3] = R.T
    T[:3, 3] = -R.T @ T[:3, 3]
    return T


@wrong("invert_transform", "elementwise-inverse")
def inv_power_minus_one(a_T_b):
    """`** -1` inverts entry by entry."""
    with np.errstate(divide="ignore"):
        b_T_a = a_T_b ** -1
    b_T_a[np.isinf(b_T_a)] = 0
    return b_T_a


@wrong("invert_transform", "inverse-parts-separately", "translation-in-bottom-row")
def inv_negated_at_bottom(a_T_b):
    """Rotation transposed, -p not rotated, and written in the bottom row."""
    b_T_a = np.identity(4)
    b_T_a[:3, :3] = a_T_b[:3, :3].T
    for k in range(3):
        b_T_a[3, k] = -a_T_b[k, 3]
    return b_T_a


@wrong("invert_transform", "rotation-not-inverted", "inverse-parts-separately")
def inv_go_back(a_T_b):
    """Only the sign of the translation is changed: 'go back by the same arrow'."""
    T = np.array(a_T_b, copy=True)
    T[:3, 3] *= -1
    return T


@wrong("invert_transform", "inverse-parts-separately", "bottom-row-wrong")
def inv_zeros(a_T_b):
    """Starts from zeros and never sets the 1; translation negated but not rotated."""
    out = np.zeros((4, 4))
    out[:3, :3] = np.linalg.inv(a_T_b[:3, :3])
    out[:3, 3] = 0 - a_T_b[:3, 3]
    return out


@wrong("invert_transform", "rotation-not-inverted", "wrong-sign")
def inv_R_and_plus(a_T_b):
    """R kept, and the rotated translation without its minus."""
    R, p = a_T_b[:3, :3], a_T_b[:3, 3]
    res = np.eye(4)
    res[:3, :3] = R
    res[:3, 3] = R.T @ p
    return res


@wrong("invert_transform", "integer-truncation")
def inv_int_array(a_T_b):
    """only easy inputs right: an array of integers is filled, right only where all entries are whole numbers (as in the notebook)."""
    b_T_a = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    R = a_T_b[:3, :3]
    b_T_a[:3, :3] = R.T
    b_T_a[:3, 3] = -R.T @ a_T_b[:3, 3]
    return b_T_a


@wrong("invert_transform", "yaw-only")
def inv_yaw(a_T_b):
    """corner: turns back about z alone; right for every frame that stands upright."""
    th = -np.arctan2(a_T_b[1, 0], a_T_b[0, 0])
    c, s = np.cos(th), np.sin(th)
    x, y, z = a_T_b[:3, 3]
    return np.array([[c, -s, 0, -(c * x - s * y)],
                     [s, c, 0, -(s * x + c * y)],
                     [0, 0, 1, -z],
                     [0, 0, 0, 1]])


@wrong("invert_transform", "euler-angles-negated")
def inv_negative_euler(a_T_b):
    """corner: negates roll, pitch and yaw but not their order; right for turns about one axis."""
    from transform_lab import tft
    r, p, y = tft.euler_from_matrix(a_T_b)
    T = tft.euler_matrix(-r, -p, -y)
    T[:3, 3] = -T[:3, :3] @ a_T_b[:3, 3]
    return T


@wrong("invert_transform")
def inv_rounded(a_T_b):
    """only easy inputs right: 'cleans' the result to four decimals; right for the notebook's frames."""
    return np.round(np.linalg.inv(a_T_b), 4)


@wrong("invert_transform")
def inv_cached_by_rotation(a_T_b, seen={}):
    """corner: caches by the rotation and forgets that the translation may differ."""
    key = str(a_T_b[:3, :3].tolist())
    if key not in seen:
        seen[key] = np.linalg.inv(a_T_b)
    return seen[key].copy()


@wrong("invert_transform")
def inv_symmetric_shortcut(a_T_b):
    """corner: 'a symmetric rotation is its own inverse', so the transform is returned as it is: half turns, identity."""
    R = a_T_b[:3, :3]
    if np.allclose(R, R.T):
        return a_T_b.copy()
    return np.linalg.inv(a_T_b)


@wrong("invert_transform", "trace-formula-only")
def inv_axis_angle(a_T_b):
    """corner: axis and angle from the trace, turned back; 0/0 at half turns (the identity is taken care of)."""
    R, p = a_T_b[:3, :3], a_T_b[:3, 3]
    theta = np.arccos(np.clip((np.trace(R) - 1) / 2, -1, 1))
    if theta == 0:
        Rinv = np.eye(3)
    else:
        with np.errstate(all="ignore"):
            K = (R - R.T) / (2 * np.sin(theta))
            Rinv = np.eye(3) + np.sin(-theta) * K + (1 - np.cos(theta)) * K @ K
    T = np.eye(4)
    T[:3, :3] = Rinv
    T[:3, 3] = -Rinv @ p
    return T


@wrong("invert_transform")
def inv_pinv_of_3x4(a_T_b):
    """Pseudo-inverse of the upper 3x4, then a last column to make it square."""
    upper = a_T_b[:3, :]
    T = np.zeros((4, 4))
    T[:, :3] = np.linalg.pinv(upper)
    T[3] = [0, 0, 0, 1]
    return T


@wrong("invert_transform", "wrong-shape")
def inv_no_bottom_row(a_T_b):
    """The right numbers, 3x4: the bottom row is left away 'because it is always the same'."""
    R = a_T_b[:3, :3].T
    return np.hstack((R, (-R @ a_T_b[:3, 3]).reshape(3, 1)))


@wrong("invert_transform")
def inv_yz_slip(a_T_b):
    """Written out by hand; the last two translation entries are swapped."""
    m = a_T_b
    tx = -(m[0, 0] * m[0, 3] + m[1, 0] * m[1, 3] + m[2, 0] * m[2, 3])
    ty = -(m[0, 1] * m[0, 3] + m[1, 1] * m[1, 3] + m[2, 1] * m[2, 3])
    tz = -(m[0, 2] * m[0, 3] + m[1, 2] * m[1, 3] + m[2, 2] * m[2, 3])
    return np.array([[m[0, 0], m[1, 0], m[2, 0], tx],
                     [m[0, 1], m[1, 1], m[2, 1], tz],
                     [m[0, 2], m[1, 2], m[2, 2], ty],
                     [0, 0, 0, 1]])


# ------------------------------------------------------------------------------------------- relative_transform


@wrong("relative_transform", "inverse-missing")
def rel_no_inverse(a_T_b, a_T_c):
    """Chains both as given."""
    return np.dot(a_T_b, a_T_c)


@wrong("relative_transform", "wrong-direction")
def rel_c_T_b(a_T_b, a_T_c):
    """Returns c_T_b, the frame the other way round."""
    c_T_a = np.linalg.inv(a_T_c)
    return c_T_a @ a_T_b


@wrong("relative_transform", "wrong-transform-inverted")
def rel_wrong_one(a_T_b, a_T_c):
    """Inverts the second transform in place of the first."""
    return a_T_b @ np.linalg.inv(a_T_c)


@wrong("relative_transform", "order-reversed")
def rel_reversed(a_T_b, a_T_c):
    """Right inverse, wrong side: a_T_c times b_T_a."""
    b_T_a = np.linalg.inv(a_T_b)
    return np.matmul(a_T_c, b_T_a)


@wrong("relative_transform", "elementwise-product")
def rel_star(a_T_b, a_T_c):
    """`*` for a matrix product."""
    return np.linalg.inv(a_T_b) * a_T_c


@wrong("relative_transform", "offset-not-rotated")
def rel_difference(a_T_b, a_T_c):
    """The arrow from B to C stays along A's axes; the rotation is right."""
    b_T_c = np.eye(4)
    b_T_c[:3, :3] = a_T_b[:3, :3].T @ a_T_c[:3, :3]
    b_T_c[:3, 3] = a_T_c[:3, 3] - a_T_b[:3, 3]
    return b_T_c


@wrong("relative_transform", "inverse-parts-separately")
def rel_parts_inverse(a_T_b, a_T_c):
    """The first transform is inverted as R transposed and -p."""
    b_T_a = np.r_[np.c_[a_T_b[:3, :3].T, -a_T_b[:3, 3]], [[0, 0, 0, 1]]]
    return b_T_a @ a_T_c


@wrong("relative_transform", "orientation-not-transformed")
def rel_keeps_Rc(a_T_b, a_T_c):
    """The translation is right, the rotation is C's in A."""
    Rb = a_T_b[:3, :3]
    T = a_T_c.copy()
    T[:3, 3] = Rb.T @ (a_T_c[:3, 3] - a_T_b[:3, 3])
    return T


@wrong("relative_transform", "order-reversed", "inverse-by-transpose")
def rel_reversed_transposed(a_T_b, a_T_c):
    """4x4 transposed for the inverse, and put on the wrong side."""
    return a_T_c @ a_T_b.T


@wrong("relative_transform", "wrong-transform-inverted", "elementwise-product")
def rel_star_wrong_one(a_T_b, a_T_c):
    """Inverts the second, multiplies entry by entry."""
    inverse = np.linalg.inv(a_T_c)
    return a_T_b * inverse


@wrong("relative_transform", "rotation-not-inverted", "offset-not-rotated")
def rel_R_times_R_minus(a_T_b, a_T_c):
    """Rotations multiplied without transposing, translations subtracted."""
    out = np.eye(4)
    out[:3, :3] = a_T_b[:3, :3] @ a_T_c[:3, :3]
    out[:3, 3] = a_T_c[:3, 3] - a_T_b[:3, 3]
    return out


@wrong("relative_transform", "inverse-missing", "order-reversed")
def rel_neither(a_T_b, a_T_c):
    """No inverse, and the factors the wrong way round."""
    b_T_c = a_T_c.dot(a_T_b)
    return b_T_c


@wrong("relative_transform", "wrong-sign", "orientation-not-transformed")
def rel_double_slip(a_T_b, a_T_c):
    """Arrow from C to B, and C's rotation copied from A."""
    t = a_T_b[:3, :3].T @ (a_T_b[:3, 3] - a_T_c[:3, 3])
    T = np.eye(4)
    T[:3, :3] = a_T_c[:3, :3]
    T[:3, 3] = t
    return T


@wrong("relative_transform", "transforms-subtracted")
def rel_matrix_difference(a_T_b, a_T_c):
    """'Relative' read as a difference of matrices; right when B and C are the same, and when nothing is rotated."""
    return np.eye(4) + (a_T_c - a_T_b)


@wrong("relative_transform", "input-mutated")
def rel_mutates(a_T_b, a_T_c):
    """The right answer, but the first argument is turned round where it stands."""
    R = a_T_b[:3, :3].copy()
    a_T_b[:3, :3] = R.T
    a_T_b[:3, 3] = -R.T @ a_T_b[:3, 3]
    return a_T_b @ a_T_c


@wrong("relative_transform", "euler-angles-subtracted")
def rel_euler(a_T_b, a_T_c):
    """corner: subtracts roll, pitch, yaw; right where both frames turn about one axis."""
    from transform_lab import tft
    eb = np.array(tft.euler_from_matrix(a_T_b))
    ec = np.array(tft.euler_from_matrix(a_T_c))
    T = tft.euler_matrix(*(ec - eb))
    T[:3, 3] = a_T_b[:3, :3].T @ (a_T_c[:3, 3] - a_T_b[:3, 3])
    return T


@wrong("relative_transform")
def rel_same_frame(a_T_b, a_T_c):
    """corner: frames that lie within a centimetre (and 0.01 in the rotation) are taken for the same."""
    if np.allclose(a_T_b, a_T_c, rtol=0, atol=0.01):
        return np.eye(4)
    return np.linalg.solve(a_T_b, a_T_c)


@wrong("relative_transform")
def rel_pinv_far(a_T_b, a_T_c):
    """corner: a pseudo-inverse with a coarse rcond; wrong when B is more than some ten metres away."""
    return np.linalg.pinv(a_T_b, rcond=1e-2) @ a_T_c


@wrong("relative_transform")
def rel_float16(a_T_b, a_T_c):
    """corner: 'saves memory' with half precision, three digits are left; right for whole numbers."""
    b_T_c = np.linalg.inv(a_T_b) @ a_T_c
    return b_T_c.astype(np.float16)


@wrong("relative_transform")
def rel_cached_inverse(a_T_b, a_T_c, inverses={}):
    """corner: remembers inverses by B's origin and overlooks that B may have turned."""
    where = tuple(a_T_b[:3, 3])
    if where not in inverses:
        inverses[where] = np.linalg.inv(a_T_b)
    return inverses[where] @ a_T_c


@wrong("relative_transform", "wrong-axis")
def rel_rotated_into_c(a_T_b, a_T_c):
    """The arrow from B to C is told along C's axes."""
    Rb, Rc = a_T_b[:3, :3], a_T_c[:3, :3]
    d = a_T_c[:3, 3] - a_T_b[:3, 3]
    return np.block([[Rb.T @ Rc, (Rc.T @ d)[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]])


@wrong("relative_transform")
def rel_list_index_slip(a_T_b, a_T_c):
    """Triple loop for the product, whose inner sum stops at the third column: B's translation gets lost."""
    inv = np.linalg.inv(a_T_b)
    result = np.zeros((4, 4))
    for i in range(4):
        for j in range(4):
            for k in range(3):
                result[i, j] += inv[i, k] * a_T_c[k, j]
    result[3, 3] = 1
    return result


# -------------------------------------------------------------------------------------------- object_in_gripper


@wrong("object_in_gripper", "wrong-transform-inverted")
def oig_wrong_one(base_T_camera, base_T_gripper, p_in_camera):
    """Inverts the camera's transform and uses the gripper's as it is."""
    p = np.append(p_in_camera, 1)
    return (base_T_gripper @ np.linalg.inv(base_T_camera) @ p)[:3]


@wrong("object_in_gripper", "inverse-missing")
def oig_no_inverse(base_T_camera, base_T_gripper, p_in_camera):
    """TF's arrows multiplied as they come."""
    p_h = np.array([p_in_camera[0], p_in_camera[1], p_in_camera[2], 1.0])
    gripper_p = base_T_gripper.dot(base_T_camera).dot(p_h)
    return gripper_p[0:3]


@wrong("object_in_gripper", "order-reversed")
def oig_order(base_T_camera, base_T_gripper, p_in_camera):
    """The gripper's inverse is applied first."""
    gripper_T_base = np.linalg.inv(base_T_gripper)
    return list((base_T_camera @ gripper_T_base @ np.append(p_in_camera, 1))[:3])


@wrong("object_in_gripper", "gripper-ignored")
def oig_in_base(base_T_camera, base_T_gripper, p_in_camera):
    """Stops at the base frame."""
    p_in_base = base_T_camera @ np.append(p_in_camera, [1])
    return p_in_base[:3]


@wrong("object_in_gripper", "translation-dropped")
def oig_w_zero(base_T_camera, base_T_gripper, p_in_camera):
    """The fourth number is 0."""
    v = np.zeros(4)
    v[:3] = p_in_camera
    v = np.linalg.inv(base_T_gripper) @ base_T_camera @ v
    return v[:3]


@wrong("object_in_gripper", "homogeneous-returned")
def oig_four_numbers(base_T_camera, base_T_gripper, p_in_camera):
    """Returns the 1 as well."""
    gripper_T_camera = np.linalg.inv(base_T_gripper) @ base_T_camera
    return gripper_T_camera @ np.append(p_in_camera, 1)


@wrong("object_in_gripper", "inverse-parts-separately")
def oig_parts(base_T_camera, base_T_gripper, p_in_camera):
    """Undoes the turn first and the move second: R^T p - t."""
    p_base = base_T_camera[:3, :3] @ p_in_camera + base_T_camera[:3, 3]
    return base_T_gripper[:3, :3].T @ p_base - base_T_gripper[:3, 3]


@wrong("object_in_gripper", "offset-not-rotated")
def oig_difference(base_T_camera, base_T_gripper, p_in_camera):
    """The arrow from gripper to object, along the base's axes."""
    p_base = (base_T_camera @ np.append(p_in_camera, 1))[:3]
    return p_base - base_T_gripper[:3, 3]


@wrong("object_in_gripper", "rotation-not-inverted")
def oig_R_forward(base_T_camera, base_T_gripper, p_in_camera):
    """The difference is turned by the gripper's rotation and not back by it."""
    Rc, tc = base_T_camera[:3, :3], base_T_camera[:3, 3]
    Rg, tg = base_T_gripper[:3, :3], base_T_gripper[:3, 3]
    return Rg.dot(Rc.dot(p_in_camera) + tc - tg)


@wrong("object_in_gripper", "both-transforms-inverted")
def oig_both_inverted(base_T_camera, base_T_gripper, p_in_camera):
    """Inverts both, 'because both are backwards'."""
    p = np.ones(4)
    p[:3] = p_in_camera
    return (np.linalg.inv(base_T_gripper) @ np.linalg.inv(base_T_camera) @ p)[:3]


@wrong("object_in_gripper", "inverse-by-transpose", "homogeneous-returned")
def oig_transpose_4(base_T_camera, base_T_gripper, p_in_camera):
    """4x4 transposed for the inverse, and all four numbers returned."""
    p = np.append(p_in_camera, 1.0)
    return base_T_gripper.T @ base_T_camera @ p


@wrong("object_in_gripper", "translation-dropped", "inverse-missing")
def oig_rotations_only(base_T_camera, base_T_gripper, p_in_camera):
    """Only the rotations are used, neither is inverted."""
    return base_T_gripper[:3, :3] @ base_T_camera[:3, :3] @ p_in_camera


@wrong("object_in_gripper", "offset-not-rotated", "wrong-sign")
def oig_difference_reversed(base_T_camera, base_T_gripper, p_in_camera):
    """The arrow from object to gripper, along the base's axes."""
    obj = base_T_camera.dot(np.hstack([p_in_camera, 1]))
    return np.array([base_T_gripper[i, 3] - obj[i] for i in range(3)])


@wrong("object_in_gripper", "order-reversed", "inverse-by-transpose")
def oig_order_transpose(base_T_camera, base_T_gripper, p_in_camera):
    """Transposed instead of inverted, and on the wrong side."""
    T = base_T_camera @ np.transpose(base_T_gripper)
    return T.dot(np.append(p_in_camera, 1))[:3]


@wrong("object_in_gripper", "wrong-transform-inverted", "translation-dropped")
def oig_wrong_one_w0(base_T_camera, base_T_gripper, p_in_camera):
    """Camera inverted instead of the gripper, with a 0 as the fourth number."""
    camera_T_base = np.linalg.inv(base_T_camera)
    p = np.append(p_in_camera, 0)
    return np.dot(np.dot(camera_T_base, base_T_gripper), p)[:3]


@wrong("object_in_gripper", "hard-coded")
def oig_one_metre_ahead(base_T_camera, base_T_gripper, p_in_camera):
    """only easy inputs right: takes the depth alone, 'the object is in front of the camera'; right for the notebook's object."""
    depth = p_in_camera[0]
    p = np.array([depth, 0, 0, 1])
    return (np.linalg.inv(base_T_gripper) @ base_T_camera @ p)[:3]


@wrong("object_in_gripper", "optical-frame-assumed")
def oig_optical(base_T_camera, base_T_gripper, p_in_camera):
    """Takes camera_link for an optical frame and reorders the axes first."""
    x, y, z = p_in_camera
    p_link = np.array([z, -x, -y, 1])
    return (np.linalg.inv(base_T_gripper) @ base_T_camera @ p_link)[:3]


@wrong("object_in_gripper", "returned-none")
def oig_behind_camera(base_T_camera, base_T_gripper, p_in_camera):
    """corner: nothing is returned for an object behind the camera, 'it cannot see it' (the task says any object)."""
    if p_in_camera[0] > 0:
        p = np.append(p_in_camera, 1)
        return (np.linalg.inv(base_T_gripper) @ base_T_camera @ p)[:3]


@wrong("object_in_gripper", "integer-truncation")
def oig_int_point(base_T_camera, base_T_gripper, p_in_camera):
    """only easy inputs right: the point is put into an array of integers; right for whole metres, as in the notebook."""
    point = np.array([0, 0, 0, 1])
    point[:3] = p_in_camera
    return np.linalg.solve(base_T_gripper, base_T_camera @ point)[:3]


@wrong("object_in_gripper")
def oig_xyx(base_T_camera, base_T_gripper, p_in_camera):
    """Typo: x, y, x."""
    res = np.linalg.inv(base_T_gripper) @ base_T_camera @ np.append(p_in_camera, 1)
    return np.array([res[0], res[1], res[0]])


@wrong("object_in_gripper")
def oig_rounded(base_T_camera, base_T_gripper, p_in_camera):
    """only easy inputs right: rounded to millimetres; right for the notebook's frames."""
    p = np.linalg.inv(base_T_gripper) @ base_T_camera @ np.append(p_in_camera, 1)
    return [round(float(c), 3) for c in p[:3]]


@wrong("object_in_gripper")
def oig_cached_chain(base_T_camera, base_T_gripper, p_in_camera, memory=[]):
    """only easy inputs right: 'the camera is fixed to the robot': its transform is remembered from the first call."""
    if not memory:
        memory.append(base_T_camera.copy())
    p_base = memory[0] @ np.append(p_in_camera, 1)
    return (np.linalg.inv(base_T_gripper) @ p_base)[:3]


@wrong("object_in_gripper")
def oig_last_row_slip(base_T_camera, base_T_gripper, p_in_camera):
    """Camera's translation read off with a slip: z taken from the row of y."""
    R = base_T_camera[:3, :3]
    t = np.array([base_T_camera[0, 3], base_T_camera[1, 3], base_T_camera[1, 3]])
    in_base = R @ p_in_camera + t
    return base_T_gripper[:3, :3].T @ (in_base - base_T_gripper[:3, 3])


# ---------------------------------------------------------------------------------------------------- pre_grasp


@wrong("pre_grasp", "base-frame-offset")
def pg_x_minus_distance(object_pose, distance=0.1):
    """Takes the distance off the base's x."""
    pose = Pose()
    pose.position.x = object_pose.position.x - distance
    pose.position.y = object_pose.position.y
    pose.position.z = object_pose.position.z
    pose.orientation = object_pose.orientation
    return pose


@wrong("pre_grasp", "base-frame-offset", "input-mutated")
def pg_minus_equals(object_pose, distance=0.1):
    """Moves the object itself, along the base's x."""
    pre = object_pose
    pre.position.x -= distance
    return pre


@wrong("pre_grasp", "input-mutated")
def pg_shared_position(object_pose, distance=0.1):
    """A new Pose that shares the object's Point; the right numbers are written through it."""
    q = object_pose.orientation
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
    back = R @ [-distance, 0, 0]
    pose = Pose(position=object_pose.position, orientation=object_pose.orientation)
    pose.position.x += back[0]
    pose.position.y += back[1]
    pose.position.z += back[2]
    return pose


@wrong("pre_grasp", "wrong-sign")
def pg_in_front(object_pose, distance=0.1):
    """In front of the object."""
    q, p = object_pose.orientation, object_pose.position
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [p.x, p.y, p.z]
    offset = np.eye(4)
    offset[0, 3] = distance
    result = np.dot(T, offset)
    quat = tft.quaternion_from_matrix(result)
    return Pose(Point(*result[:3, 3]), Quaternion(*quat))


@wrong("pre_grasp", "wrong-axis")
def pg_above(object_pose, distance=0.1):
    """Backs off along the object's z."""
    o = object_pose.orientation
    base_T_obj = tft.quaternion_matrix([o.x, o.y, o.z, o.w])
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z])
    p = p - distance * base_T_obj[:3, 2]
    return Pose(Point(p[0], p[1], p[2]), Quaternion(o.x, o.y, o.z, o.w))


@wrong("pre_grasp", "distance-ignored")
def pg_ten_cm(object_pose, distance=0.1):
    """corner: the lab's 10 cm are written into the matrix; right for 0.1."""
    ori = object_pose.orientation
    T = tft.quaternion_matrix([ori.x, ori.y, ori.z, ori.w])
    T[0, 3] = object_pose.position.x
    T[1, 3] = object_pose.position.y
    T[2, 3] = object_pose.position.z
    obj_T_pre = np.array([[1, 0, 0, -0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    M = T @ obj_T_pre
    q = tft.quaternion_from_matrix(M)
    return Pose(position=Point(M[0, 3], M[1, 3], M[2, 3]), orientation=Quaternion(q[0], q[1], q[2], q[3]))


@wrong("pre_grasp", "orientation-identity")
def pg_identity(object_pose, distance=0.1):
    """'Same orientation as the object' said in the object's frame: 0, 0, 0, 1."""
    q = object_pose.orientation
    T = tft.quaternion_matrix((q.x, q.y, q.z, q.w))
    T[:3, 3] = (object_pose.position.x, object_pose.position.y, object_pose.position.z)
    x, y, z, _ = T @ np.array([-distance, 0, 0, 1])
    return Pose(Point(x, y, z), Quaternion(0, 0, 0, 1))


@wrong("pre_grasp", "orientation-missing", "distance-ignored")
def pg_position_of_ten_cm(object_pose, distance=0.1):
    """Sets the position alone, for 10 cm whatever was asked."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    pose = Pose()
    pose.position.x = object_pose.position.x - 0.1 * T[0, 0]
    pose.position.y = object_pose.position.y - 0.1 * T[1, 0]
    pose.position.z = object_pose.position.z - 0.1 * T[2, 0]
    return pose


@wrong("pre_grasp", "quaternion-order")
def pg_w_first(object_pose, distance=0.1):
    """The quaternion goes to tft with w first; the orientation is copied."""
    q = object_pose.orientation
    R = tft.quaternion_matrix([q.w, q.x, q.y, q.z])[:3, :3]
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z])
    p = p + R @ np.array([-distance, 0, 0])
    return Pose(Point(p[0], p[1], p[2]), Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp", "rotation-transposed")
def pg_row(object_pose, distance=0.1):
    """The object's x axis is read off the first row."""
    q = object_pose.orientation
    mat = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    x_axis = mat[0][:3]
    pos = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z]) - distance * x_axis
    out = Pose()
    out.position = Point(*pos)
    out.orientation = Quaternion(q.x, q.y, q.z, q.w)
    return out


@wrong("pre_grasp", "rotation-applied-twice")
def pg_twice(object_pose, distance=0.1):
    """The pre-grasp matrix in the object's frame gets the object's rotation, too."""
    q = object_pose.orientation
    quat = [q.x, q.y, q.z, q.w]
    base_T_obj = tft.quaternion_matrix(quat)
    base_T_obj[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    obj_T_pre = tft.quaternion_matrix(quat)
    obj_T_pre[:3, 3] = [-distance, 0, 0]
    base_T_pre = base_T_obj @ obj_T_pre
    return Pose(Point(*base_T_pre[:3, 3]), Quaternion(*tft.quaternion_from_matrix(base_T_pre)))


@wrong("pre_grasp", "yaw-only")
def pg_yaw(object_pose, distance=0.1):
    """corner: trigonometry with the yaw; wrong for tilted objects."""
    q = object_pose.orientation
    _, _, yaw = tft.euler_from_quaternion([q.x, q.y, q.z, q.w])
    pose = Pose()
    pose.position.x = object_pose.position.x - distance * np.cos(yaw)
    pose.position.y = object_pose.position.y - distance * np.sin(yaw)
    pose.position.z = object_pose.position.z
    pose.orientation = Quaternion(q.x, q.y, q.z, q.w)
    return pose


@wrong("pre_grasp", "yaw-only", "orientation-missing")
def pg_yaw_no_orientation(object_pose, distance=0.1):
    """Yaw as twice the arc sine of z, and the orientation is left at zeros."""
    import math
    yaw = 2 * math.asin(max(-1.0, min(1.0, object_pose.orientation.z)))
    p = object_pose.position
    return Pose(position=Point(p.x - distance * math.cos(yaw), p.y - distance * math.sin(yaw), p.z))


@wrong("pre_grasp", "wrong-axis", "wrong-sign")
def pg_plus_y(object_pose, distance=0.1):
    """Along the object's +y."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    p = T @ [0, distance, 0, 1]
    return Pose(Point(p[0], p[1], p[2]), Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp", "wrong-units")
def pg_centimetres(object_pose, distance=0.1):
    """Takes the distance for centimetres and divides by 100."""
    q = object_pose.orientation
    d = distance / 100.0
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    pos = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    new = [pos[i] - d * R[i, 0] for i in range(3)]
    return Pose(Point(*new), Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp", "base-frame-offset", "orientation-identity")
def pg_old_hand(object_pose, distance=0.1):
    """Off the base's x, facing forward."""
    p = object_pose.position
    return Pose(Point(p.x - distance, p.y, p.z), Quaternion(0, 0, 0, 1))


@wrong("pre_grasp", "distance-ignored", "wrong-sign")
def pg_front_ten(object_pose, distance=0.1):
    """Plus 10 cm, whatever the distance."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    T = T @ tft.translation_matrix([0.1, 0, 0])
    return Pose(Point(*tft.translation_from_matrix(T)), Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp", "towards-base-origin")
def pg_towards_base(object_pose, distance=0.1):
    """'Behind means closer to the robot': backs off along the line from the base's origin to the object."""
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z])
    r = np.linalg.norm(p)
    p = p * (r - distance) / r if r > 0 else p
    return Pose(Point(*p), object_pose.orientation)


@wrong("pre_grasp", "hard-coded")
def pg_published(object_pose, distance=0.1):
    """only easy inputs right: the lab's published answer; right for the lab's object and 0.1."""
    return Pose(Point(0.529289321708, -0.170710677946, 0.7),
                Quaternion(0.0, 0.0, 0.382683431234, 0.92387953298))


@wrong("pre_grasp", "trace-formula-only")
def pg_trace(object_pose, distance=0.1):
    """corner: orientation back from the matrix by the trace formula; breaks at half turns."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    back = np.eye(4)
    back[0, 3] = -distance
    M = T @ back
    with np.errstate(all="ignore"):
        w = np.sqrt(1 + M[0, 0] + M[1, 1] + M[2, 2]) / 2
        x = (M[2, 1] - M[1, 2]) / (4 * w)
        y = (M[0, 2] - M[2, 0]) / (4 * w)
        z = (M[1, 0] - M[0, 1]) / (4 * w)
    return Pose(Point(M[0, 3], M[1, 3], M[2, 3]), Quaternion(x, y, z, w))


@wrong("pre_grasp", "gimbal-lock")
def pg_gimbal(object_pose, distance=0.1):
    """corner: orientation back by hand-made Euler angles; wrong where the x axis is vertical (gimbal lock)."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    R = T[:3, :3]
    roll = np.arctan2(R[2, 1], R[2, 2])
    pitch = np.arctan2(-R[2, 0], np.hypot(R[0, 0], R[1, 0]))
    yaw = np.arctan2(R[1, 0], R[0, 0])
    out = tft.quaternion_from_euler(roll, pitch, yaw)
    p = object_pose.position
    return Pose(Point(p.x - distance * R[0, 0], p.y - distance * R[1, 0], p.z - distance * R[2, 0]), Quaternion(*out))


@wrong("pre_grasp", "wrong-type")
def pg_array_orientation(object_pose, distance=0.1):
    """The array of quaternion_from_matrix is put where a Quaternion belongs."""
    q = object_pose.orientation
    m = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    m[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    t = tft.identity_matrix()
    t[0, 3] = -distance
    m = m.dot(t)
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = m[:3, 3]
    pose.orientation = tft.quaternion_from_matrix(m)
    return pose


@wrong("pre_grasp", "returned-none")
def pg_none_at_zero(object_pose, distance=0.1):
    """corner: no return for a distance of 0, where the gripper should be at the object."""
    if distance:
        q = object_pose.orientation
        x_axis = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, 0]
        p = object_pose.position
        return Pose(Point(p.x - distance * x_axis[0], p.y - distance * x_axis[1], p.z - distance * x_axis[2]),
                    Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp", "not-normalised")
def pg_not_normalised(object_pose, distance=0.1):
    """Quaternion by the differences of the matrix, never divided by its length."""
    q = object_pose.orientation
    M = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    M[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    M = M @ tft.translation_matrix([-distance, 0, 0])
    quat = Quaternion(M[2, 1] - M[1, 2], M[0, 2] - M[2, 0], M[1, 0] - M[0, 1], 1 + np.trace(M[:3, :3]))
    return Pose(Point(*M[:3, 3]), quat)


@wrong("pre_grasp")
def pg_renamed(object_pose, dist=0.1):
    """corner: the argument has been renamed, so pre_grasp(pose, distance=0.2) raises TypeError."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z]) - dist * T[:3, 0]
    return Pose(Point(*p), Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp")
def pg_no_default(object_pose, distance):
    """corner: the default value has been lost, so pre_grasp(pose) raises TypeError."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    p = T.dot([-distance, 0, 0, 1])
    return Pose(Point(*p[:3]), Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp")
def pg_cached(object_pose, distance=0.1, cache={}):
    """corner: remembers answers by the object's pose and ignores that the distance has changed."""
    p, q = object_pose.position, object_pose.orientation
    key = (p.x, p.y, p.z, q.x, q.y, q.z, q.w)
    if key not in cache:
        R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
        cache[key] = np.array([p.x, p.y, p.z]) + R.dot([-distance, 0, 0])
    x, y, z = cache[key]
    return Pose(Point(x, y, z), Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp")
def pg_negative_w(object_pose, distance=0.1):
    """corner: recovers w from x, y, z as the positive root; wrong for w < 0."""
    q = object_pose.orientation
    w = np.sqrt(max(0.0, 1 - q.x**2 - q.y**2 - q.z**2))
    R = tft.quaternion_matrix([q.x, q.y, q.z, w])[:3, :3]
    p = object_pose.position
    pos = np.array([p.x, p.y, p.z]) - R[:, 0] * distance
    return Pose(Point(*pos), Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp")
def pg_whole_centimetres(object_pose, distance=0.1):
    """corner: cuts the distance to whole centimetres (0.125 becomes 0.12)."""
    q = object_pose.orientation
    cm = int(distance * 100 + 1e-9)
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    pre = Pose()
    pre.position.x = object_pose.position.x - cm / 100 * R[0, 0]
    pre.position.y = object_pose.position.y - cm / 100 * R[1, 0]
    pre.position.z = object_pose.position.z - cm / 100 * R[2, 0]
    pre.orientation = Quaternion(q.x, q.y, q.z, q.w)
    return pre


@wrong("pre_grasp", "wrong-sign")
def pg_pitch_sign(object_pose, distance=0.1):
    """corner: sin(pitch) taken as up; wrong for tilted objects only."""
    q = object_pose.orientation
    roll, pitch, yaw = tft.euler_from_quaternion([q.x, q.y, q.z, q.w])
    forward = np.array([np.cos(yaw) * np.cos(pitch), np.sin(yaw) * np.cos(pitch), np.sin(pitch)])
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z]) - distance * forward
    return Pose(Point(*p), Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp")
def pg_max_reach(object_pose, distance=0.1):
    """corner: 'the arm cannot go back further than half a metre': larger distances are cut."""
    q = object_pose.orientation
    distance = min(distance, 0.5)
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    T = tft.concatenate_matrices(T, tft.translation_matrix((-distance, 0, 0)))
    return Pose(Point(*T[:3, 3]), Quaternion(*tft.quaternion_from_matrix(T)))


@wrong("pre_grasp", "formula-slip")
def pg_axis_formula(object_pose, distance=0.1):
    """corner: the x axis from the quaternion with one sign wrong (xz + yw); right where the object stands upright."""
    q = object_pose.orientation
    ux = 1 - 2 * (q.y**2 + q.z**2)
    uy = 2 * (q.x * q.y + q.z * q.w)
    uz = 2 * (q.x * q.z + q.y * q.w)
    p = object_pose.position
    return Pose(Point(p.x - distance * ux, p.y - distance * uy, p.z - distance * uz),
                Quaternion(q.x, q.y, q.z, q.w))


@wrong("pre_grasp")
def pg_swapped_copy(object_pose, distance=0.1):
    """only easy inputs right: y and z of the orientation are swapped in the copy; seen only where they differ."""
    o = object_pose.orientation
    quat = [o.x, o.y, o.z, o.w]
    M = tft.quaternion_matrix(quat)
    p = object_pose.position
    new_p = Point(p.x - distance * M[0, 0], p.y - distance * M[1, 0], p.z - distance * M[2, 0])
    return Pose(new_p, Quaternion(o.x, o.z, o.y, o.w))


# ----------------------------------------------------------------------------------------------------- waypoint


@wrong("waypoint", "base-frame-offset")
def wp_added(object_pose, offset):
    """The offset is added along the base's axes."""
    p = object_pose.position
    return Pose(Point(p.x + offset[0], p.y + offset[1], p.z + offset[2]), object_pose.orientation)


@wrong("waypoint", "base-frame-offset")
def wp_left_product(object_pose, offset):
    """The offset's matrix stands on the left: order reversed, which moves along the base's axes."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    M = np.dot(tft.translation_matrix(offset), T)
    q_new = tft.quaternion_from_matrix(M)
    return Pose(Point(*M[:3, 3]), Quaternion(*q_new))


@wrong("waypoint", "rotation-transposed")
def wp_inverse_rotation(object_pose, offset):
    """The offset is turned by the inverse rotation (row vector times matrix)."""
    q = object_pose.orientation
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z]) + offset @ R
    return Pose(Point(*p), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint", "wrong-sign")
def wp_minus(object_pose, offset):
    """Moved by minus the offset, as for the pre-grasp."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    x, y, z, w = T @ np.array([-offset[0], -offset[1], -offset[2], 1])
    result = Pose()
    result.position = Point(x, y, z)
    result.orientation = object_pose.orientation
    return result


@wrong("waypoint", "offset-partly-used")
def wp_x_only(object_pose, offset):
    """corner: copied from pre_grasp, moves along x alone; right where the offset has no y and z."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    obj_T_way = np.eye(4)
    obj_T_way[0, 3] = offset[0]
    M = T @ obj_T_way
    return Pose(Point(*M[:3, 3]), Quaternion(*tft.quaternion_from_matrix(M)))


@wrong("waypoint", "orientation-missing")
def wp_no_orientation(object_pose, offset):
    """Only the position is filled in."""
    q = object_pose.orientation
    rot = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
    moved = rot.dot(offset)
    pose = Pose()
    pose.position.x = object_pose.position.x + moved[0]
    pose.position.y = object_pose.position.y + moved[1]
    pose.position.z = object_pose.position.z + moved[2]
    return pose


@wrong("waypoint", "quaternion-order")
def wp_reads_back_w_first(object_pose, offset):
    """The result of quaternion_from_matrix is unpacked as w, x, y, z."""
    o = object_pose.orientation
    T = tft.quaternion_matrix([o.x, o.y, o.z, o.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    T = T @ tft.translation_matrix(offset)
    w, x, y, z = tft.quaternion_from_matrix(T)
    return Pose(Point(T[0, 3], T[1, 3], T[2, 3]), Quaternion(x, y, z, w))


@wrong("waypoint", "elementwise-product")
def wp_star(object_pose, offset):
    """R * offset and a sum, over the wrong axis."""
    q = object_pose.orientation
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
    d = sum(R * offset)
    p = object_pose.position
    return Pose(Point(p.x + d[0], p.y + d[1], p.z + d[2]), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint", "translation-dropped")
def wp_w_zero(object_pose, offset):
    """The offset gets a 0 as its fourth number, so the object's position is lost."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[0:3, 3] = object_pose.position.x, object_pose.position.y, object_pose.position.z
    v = T @ np.append(offset, 0)
    return Pose(Point(v[0], v[1], v[2]), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint", "input-mutated")
def wp_offset_plus_equals(object_pose, offset):
    """The right numbers, worked out inside the caller's offset."""
    q = object_pose.orientation
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
    offset[:] = R @ offset
    offset += [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    return Pose(Point(*offset), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint", "yaw-only")
def wp_yaw(object_pose, offset):
    """corner: turns the offset about z alone; wrong for tilted objects."""
    q = object_pose.orientation
    yaw = np.arctan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    c, s = np.cos(yaw), np.sin(yaw)
    p = object_pose.position
    x = p.x + c * offset[0] - s * offset[1]
    y = p.y + s * offset[0] + c * offset[1]
    z = p.z + offset[2]
    return Pose(Point(x, y, z), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint", "distance-ignored")
def wp_unit_offset(object_pose, offset):
    """Takes the offset for a direction and goes 10 cm along it."""
    q = object_pose.orientation
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
    n = np.linalg.norm(offset)
    step = 0.1 * np.asarray(offset) / n if n else np.zeros(3)
    pos = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z]) + R @ step
    return Pose(Point(*pos), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint", "returned-none")
def wp_none_for_grasp(object_pose, offset):
    """corner: no return for a zero offset, the 'grasp' of the notebook's table."""
    if np.any(offset):
        q = object_pose.orientation
        T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
        T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
        p = T.dot(np.append(offset, 1))
        return Pose(Point(p[0], p[1], p[2]), Quaternion(q.x, q.y, q.z, q.w))
    else:
        print("already there")


@wrong("waypoint", "base-frame-offset", "orientation-missing")
def wp_added_no_orientation(object_pose, offset):
    """Added in the base frame, orientation left at zeros."""
    pose = Pose()
    pose.position.x = object_pose.position.x + offset[0]
    pose.position.y = object_pose.position.y + offset[1]
    pose.position.z = object_pose.position.z + offset[2]
    return pose


@wrong("waypoint", "rotation-transposed", "wrong-sign")
def wp_inverse_and_minus(object_pose, offset):
    """Turned by the inverse, and subtracted."""
    q = object_pose.orientation
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3]
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z]) - R.T @ offset
    return Pose(Point(*p), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint", "translation-dropped", "orientation-identity")
def wp_arrow(object_pose, offset):
    """The turned offset alone, facing forward."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    d = T[:3, :3] @ offset
    return Pose(Point(d[0], d[1], d[2]), Quaternion(0, 0, 0, 1))


@wrong("waypoint", "quaternion-order", "wrong-sign")
def wp_w_first_minus(object_pose, offset):
    """w first for tft, and the offset subtracted."""
    o = object_pose.orientation
    R = tft.quaternion_matrix([o.w, o.x, o.y, o.z])[:3, :3]
    d = R @ np.array(offset)
    p = object_pose.position
    return Pose(Point(p.x - d[0], p.y - d[1], p.z - d[2]), Quaternion(o.x, o.y, o.z, o.w))


@wrong("waypoint", "rotation-applied-twice", "input-mutated")
def wp_twice_mutating(object_pose, offset):
    """The product of matrices with the rotation in both, written back into the object."""
    q = object_pose.orientation
    A = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    B = A.copy()
    A[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    B[:3, 3] = offset
    C = A @ B
    object_pose.position = Point(*C[:3, 3])
    object_pose.orientation = Quaternion(*tft.quaternion_from_matrix(C))
    return object_pose


@wrong("waypoint", "wrong-axis", "orientation-identity")
def wp_length_along_x(object_pose, offset):
    """Moves by the offset's length along the object's x, facing forward."""
    q = object_pose.orientation
    x_axis = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, 0]
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z])
    p += np.linalg.norm(offset) * x_axis
    return Pose(Point(*p), Quaternion(0, 0, 0, 1))


@wrong("waypoint", "euler-order")
def wp_euler_order(object_pose, offset):
    """corner: passes yaw, pitch, roll where roll, pitch, yaw are asked for; right only where roll equals yaw."""
    q = object_pose.orientation
    roll, pitch, yaw = tft.euler_from_quaternion([q.x, q.y, q.z, q.w])
    R = tft.euler_matrix(yaw, pitch, roll)[:3, :3]
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z]) + R.dot(offset)
    return Pose(Point(*p), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint")
def wp_yz(object_pose, offset):
    """corner: y and z of the offset are swapped; right where they are equal, as for the pre-grasp."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    t = np.eye(4)
    t[0, 3], t[2, 3], t[1, 3] = offset
    M = T @ t
    return Pose(Point(M[0, 3], M[1, 3], M[2, 3]), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint")
def wp_short_way(object_pose, offset):
    """corner: for w < 0 only w is made positive 'to go the short way', which is the opposite turn."""
    o = object_pose.orientation
    q = [o.x, o.y, o.z, o.w]
    if q[3] < 0:
        q[3] = -q[3]
    T = tft.quaternion_matrix(q)
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    M = T @ tft.translation_matrix(offset)
    return Pose(Point(*M[:3, 3]), Quaternion(*q))


@wrong("waypoint")
def wp_small_angle(object_pose, offset):
    """corner: turns of less than about half a degree are taken for none."""
    q = object_pose.orientation
    v = np.array([q.x, q.y, q.z])
    s = np.linalg.norm(v)
    o = np.asarray(offset, float)
    if s < 0.005:
        moved = o
    else:
        u, th = v / s, 2 * np.arctan2(s, q.w)
        moved = o * np.cos(th) + np.cross(u, o) * np.sin(th) + u * u.dot(o) * (1 - np.cos(th))
    p = object_pose.position
    return Pose(Point(p.x + moved[0], p.y + moved[1], p.z + moved[2]), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint")
def wp_asin(object_pose, offset):
    """corner: the angle as 2 asin of the vector's length, without w; wrong for w < 0."""
    q = object_pose.orientation
    v = np.array([q.x, q.y, q.z])
    s = np.linalg.norm(v)
    T = tft.rotation_matrix(2 * np.arcsin(min(1.0, s)), v) if s > 1e-12 else np.eye(4)
    d = T[:3, :3] @ offset
    p = object_pose.position
    return Pose(Point(p.x + d[0], p.y + d[1], p.z + d[2]), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint")
def wp_qvq(object_pose, offset):
    """q v q, without the conjugate on the right."""
    q = object_pose.orientation
    quat = [q.x, q.y, q.z, q.w]
    v = list(offset) + [0]
    r = tft.quaternion_multiply(tft.quaternion_multiply(quat, v), quat)
    p = object_pose.position
    return Pose(Point(p.x + r[0], p.y + r[1], p.z + r[2]), Quaternion(*quat))


@wrong("waypoint")
def wp_cross_formula(object_pose, offset):
    """v + 2 w (u x v) + 2 u x (u x v), with the last 2 forgotten."""
    q = object_pose.orientation
    u = np.array([q.x, q.y, q.z])
    t = 2 * np.cross(u, offset)
    moved = offset + q.w * t + np.cross(u, t) / 2
    p = np.array([object_pose.position.x, object_pose.position.y, object_pose.position.z]) + moved
    return Pose(Point(*p), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint")
def wp_workspace(object_pose, offset):
    """corner: the result is clipped to an arm's workspace of 2 m; wrong for far objects."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    p = np.clip((T @ np.append(offset, 1))[:3], -2, 2)
    return Pose(Point(*p), Quaternion(q.x, q.y, q.z, q.w))


@wrong("waypoint")
def wp_half_precision(object_pose, offset):
    """corner: the matrices are kept as float16, so millimetres are lost."""
    q = object_pose.orientation
    R = tft.quaternion_matrix([q.x, q.y, q.z, q.w])[:3, :3].astype(np.float16)
    d = R @ np.array(offset, dtype=np.float16)
    p = object_pose.position
    return Pose(Point(p.x + float(d[0]), p.y + float(d[1]), p.z + float(d[2])), Quaternion(q.x, q.y, q.z, q.w))


# -------------------------------------------------------------------------------- more with two mistakes at once


@wrong("invert_transform", "wrong-sign", "bottom-row-wrong")
def inv_zeros_plus(a_T_b):
    """No minus, and the 1 in the corner is missing."""
    b_T_a = np.zeros_like(a_T_b)
    b_T_a[:3, :3] = a_T_b[:3, :3].T
    b_T_a[:3, 3] = a_T_b[:3, :3].T @ a_T_b[:3, 3]
    return b_T_a


@wrong("invert_transform", "rotation-not-inverted", "translation-in-bottom-row")
def inv_R_kept_bottom(a_T_b):
    """R as it was, and the (right) translation in the bottom row."""
    R = a_T_b[:3, :3]
    t = -R.T @ a_T_b[:3, 3]
    top = np.c_[R, np.zeros(3)]
    return np.r_[top, [[t[0], t[1], t[2], 1]]]


@wrong("relative_transform", "wrong-direction", "inverse-parts-separately")
def rel_other_way_parts(a_T_b, a_T_c):
    """c_T_b, by an inverse of R transposed and -p."""
    c_T_a = np.eye(4)
    c_T_a[:3, :3] = a_T_c[:3, :3].T
    c_T_a[:3, 3] = -a_T_c[:3, 3]
    return c_T_a @ a_T_b


@wrong("object_in_gripper", "inverse-parts-separately", "homogeneous-returned")
def oig_parts_four(base_T_camera, base_T_gripper, p_in_camera):
    """Inverse by parts, and the 1 is returned as well."""
    gripper_T_base = np.eye(4)
    gripper_T_base[:3, :3] = base_T_gripper[:3, :3].T
    gripper_T_base[:3, 3] = -base_T_gripper[:3, 3]
    return gripper_T_base @ base_T_camera @ np.append(p_in_camera, 1)


@wrong("object_in_gripper", "rotation-not-inverted", "wrong-sign")
def oig_forward_reversed(base_T_camera, base_T_gripper, p_in_camera):
    """Arrow from object to gripper, turned by R and not by its transpose."""
    in_base = (base_T_camera @ np.append(p_in_camera, 1))[:3]
    return base_T_gripper[:3, :3] @ (base_T_gripper[:3, 3] - in_base)


@wrong("pre_grasp", "quaternion-order", "orientation-identity")
def pg_w_first_identity(object_pose, distance=0.1):
    """w first for tft, and an identity orientation."""
    q = object_pose.orientation
    T = tft.quaternion_matrix([q.w, q.x, q.y, q.z])
    T[:3, 3] = [object_pose.position.x, object_pose.position.y, object_pose.position.z]
    p = T @ [-distance, 0, 0, 1]
    return Pose(Point(p[0], p[1], p[2]), Quaternion(0, 0, 0, 1))


@wrong("waypoint", "rotation-transposed", "orientation-missing")
def wp_inverse_no_orientation(object_pose, offset):
    """The conjugate turns the offset, and the orientation stays at zeros."""
    q = object_pose.orientation
    quat = [q.x, q.y, q.z, q.w]
    v = np.append(offset, 0)
    r = tft.quaternion_multiply(tft.quaternion_multiply(tft.quaternion_conjugate(quat), v), quat)
    pose = Pose()
    pose.position = Point(object_pose.position.x + r[0], object_pose.position.y + r[1], object_pose.position.z + r[2])
    return pose


# ---------------------------------------------------------------- the type of an argument of whole numbers is kept


@wrong("make_transform", "integer-truncation")
def padded_as_it_is(R, p):
    """np.pad keeps the type of R: whole numbers cut off the translation's fractions."""
    T = np.pad(R, ((0, 1), (0, 1)))
    T[:, -1] = *p, 1
    return T


@wrong("transform_point")
def added_in_place(a_T_b, p_in_b):
    """Adds fractions to an array of whole numbers, which NumPy refuses."""
    here = a_T_b[:3, 3].copy()
    for length, axis in zip(p_in_b, a_T_b[:3, :3].T):
        here += length * axis
    return here


# ---------------------------------------------------------------- what is wrong somewhere only, of transform and pose


def _components(m, slip=0, only_x=False):
    """x, y, z, w of a 4x4 matrix by the formula with a branch for each, with a sign of w's wrong in z's, or with x's for all three."""
    trace = m[0, 0] + m[1, 1] + m[2, 2]
    if trace > 0:
        s = 2 * sqrt(trace + 1)
        return (m[2, 1] - m[1, 2]) / s, (m[0, 2] - m[2, 0]) / s, (m[1, 0] - m[0, 1]) / s, s / 4
    if only_x or m[0, 0] > m[1, 1] and m[0, 0] > m[2, 2]:
        s = 2 * np.sqrt(1 + m[0, 0] - m[1, 1] - m[2, 2])
        return s / 4, (m[0, 1] + m[1, 0]) / s, (m[0, 2] + m[2, 0]) / s, (m[2, 1] - m[1, 2]) / s
    if m[1, 1] > m[2, 2]:
        s = 2 * sqrt(1 + m[1, 1] - m[0, 0] - m[2, 2])
        return (m[0, 1] + m[1, 0]) / s, s / 4, (m[1, 2] + m[2, 1]) / s, (m[0, 2] - m[2, 0]) / s
    s = 2 * sqrt(1 + m[2, 2] - m[0, 0] - m[1, 1])
    return (m[0, 2] + m[2, 0]) / s, (m[1, 2] + m[2, 1]) / s, s / 4, (-1) ** slip * (m[1, 0] - m[0, 1]) / s


def _matrix_of(pose):
    p, q = pose.position, pose.orientation
    T = tft.quaternion_matrix([q.x, q.y, q.z, q.w])
    T[:3, 3] = p.x, p.y, p.z
    return T


def _there_and_back(m):
    """x, y, z, w by way of roll, pitch and yaw."""
    return tft.quaternion_from_euler(atan2(m[2, 1], m[2, 2]), -math.asin(max(-1, min(1, m[2, 0]))), atan2(m[1, 0], m[0, 0]))


@wrong("transform_to_pose", "branch-wrong")
def ttp_slip_in_z_branch(matrix):
    """corner: the sign of w is wrong where z is the largest."""
    return Pose(Point(*matrix[:3, 3]), Quaternion(*_components(matrix, slip=1)))


@wrong("transform_pose", "branch-missing")
def tp_x_branch_only(a_T_b, pose_in_b):
    """corner: one formula for all negative traces: right unless x is 0."""
    T = a_T_b @ _matrix_of(pose_in_b)
    return Pose(Point(*T[:3, 3]), Quaternion(*_components(T, only_x=True)))


@wrong("transform_pose", "gimbal-lock")
def tp_angles_there_and_back(a_T_b, pose_in_b):
    """corner: angles on the way, which cannot be told apart where the x axis is upright."""
    T = a_T_b @ _matrix_of(pose_in_b)
    return Pose(Point(*T[:3, 3]), Quaternion(*_there_and_back(T)))


@wrong("waypoint", "gimbal-lock")
def wp_angles_there_and_back(object_pose, offset):
    """corner: the same, for a pose that need not be turned at all."""
    T = _matrix_of(object_pose)
    return Pose(Point(*(T @ [*offset, 1])[:3]), Quaternion(*_there_and_back(T)))


@wrong("is_rotation", "exact-comparison")
def isrot_determinant_is_one(R):
    """corner: the determinant compared with ==."""
    return np.allclose(R @ R.T, np.eye(3), rtol=0, atol=1e-6) and np.linalg.det(R) == 1


@wrong("is_rotation", "determinant-only")
def isrot_asks_scipy(R):
    """SciPy repairs what is no rotation."""
    try:
        Rotation.from_matrix(R)
    except ValueError:
        return False
    return True


@wrong("is_rotation", "default-tolerance")
def isrot_allclose_as_it_comes(R):
    """corner: np.allclose has tolerances of its own."""
    return np.allclose(R.T @ R, np.eye(3)) and np.linalg.det(R) > 0


@wrong("same_rotation", "exact-comparison")
def same_dot_is_one(q1, q2):
    """corner: the dot product compared with ==."""
    return abs(np.dot(q1, q2)) == 1


@wrong("transform_point", "homogeneous-order")
def point_one_in_front(a_T_b, p_in_b):
    """The 1 stands in front."""
    return (a_T_b @ np.append(1, p_in_b))[:3]


@wrong("make_transform", "yaw-only")
def make_two_by_two(R, p):
    """Slip: a 2x2 slice for a 3x3 one."""
    T = np.eye(4)
    T[:2, :2] = R[:2, :2]
    T[:3, 3] = p
    return T


@wrong("waypoint", "wrong-axis")
def wp_up_alone(object_pose, offset):
    """Only the offset's z counts."""
    T = _matrix_of(object_pose)
    return Pose(Point(*(T @ [0, 0, offset[2], 1])[:3]), object_pose.orientation)


@wrong("waypoint", "base-frame-offset")
def wp_lift_is_up(object_pose, offset):
    """The lift along the base's z axis."""
    x, y, z = (_matrix_of(object_pose) @ [offset[0], offset[1], 0, 1])[:3]
    return Pose(Point(x, y, z + offset[2]), object_pose.orientation)


@wrong("rotation_about_z", "rotation-transposed")
def z_passive_library(degrees):
    """sympy's rot_axis3 is the passive one."""
    c, s = cosd(degrees), sind(degrees)
    return np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])


@wrong("relative_transform", "rotation-vectors-subtracted")
def rel_rotation_vectors(a_T_b, a_T_c):
    """Rotation vectors, subtracted."""
    b, c = (Rotation.from_matrix(T[:3, :3]).as_rotvec() for T in (a_T_b, a_T_c))
    T = inv(a_T_b) @ a_T_c
    T[:3, :3] = Rotation.from_rotvec(c - b).as_matrix()
    return T


@wrong("pre_grasp", "zero-taken-for-missing")
def pg_or_ten_centimetres(object_pose, distance=None):
    """corner: 0 is false."""
    T = _matrix_of(object_pose)
    return Pose(Point(*(T @ [-(distance or 0.1), 0, 0, 1])[:3]), object_pose.orientation)
