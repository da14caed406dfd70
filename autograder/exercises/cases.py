"""Rotations, translations, points and poses that the exercises' cases are made of, with why each kind is there."""

from itertools import permutations, product

import numpy as np
from transform_lab import Point, Pose, Quaternion
from transform_lab.arithmetic import Rotation, matrix_of, quaternion_of, turn, vector_of

SMALL = range(-6, 0)  # decades of metres and radians below 1 that are felt at a tolerance of 1e-6
FAR = range(1, 4)  # decades of metres beyond 10


def signed_permutations():
    """The 24 rotations that map axes onto axes, with exact integer entries.

    The rotations students try first, half turns among them. Exact entries matter: the 1e-16 noise of `cos(pi)` hides
    formulas that break at a half turn.
    """
    rotations = []
    for order, signs in product(permutations(range(3)), product((1.0, -1.0), repeat=3)):
        R = np.zeros((3, 3))
        R[range(3), order] = signs
        if np.linalg.det(R) > 0:
            rotations.append(R)
    return rotations


def rotation(rng):
    """A generic rotation by 80 to 170 degrees: no number of its quaternion is near zero, and no two are nearly alike in size.

    Nor is its trace near zero, which is negative in every second one: formulas that have a branch for each agree on which.
    """
    sizes = rng.permutation([0.15, 0.36, 0.56, 0.73]) + rng.uniform(-0.04, 0.04, size=4)
    return matrix_of(sizes * rng.choice([-1.0, 1.0], size=4))


def rotation_about(axis, angle):
    """The rotation by `angle` (radians) about `axis` (any length)."""
    return turn(angle * np.asarray(axis, dtype=float) / np.linalg.norm(axis))


def half_turn(rng, largest=None):
    """A half turn about a slanted axis: catches formulas that lose the relative signs of the axis.

    The axis is (0.36, 0.48, 0.8) in some order and with some signs. With it the entries have four decimals and the
    trace is exactly -1 in whatever order it is summed, so a formula that breaks at a half turn breaks in one way only.
    `largest` (0, 1, 2) is the component of the axis that is largest, for formulas that have a branch for each.
    """
    axis = _with_largest(largest, rng.permutation([0.36, 0.48, 0.8])) * rng.choice([-1.0, 1.0], size=3)
    return _half_turn_about(axis).round(4)


def _half_turn_about(axis):
    return 2.0 * np.outer(axis, axis) - np.eye(3)


def half_turn_to_rounding(rng):
    """A half turn about a slanted axis whose trace is a little more than -1, as it comes out of most computations."""
    axis = slanted_axis(rng)
    while True:
        R = _half_turn_about(axis)
        if (np.trace(R) - 1.0) / 2.0 > -1.0:
            return R
        axis = nudged(axis)


def nudged(unit):
    """Another unit vector, or quaternion, about a hundredth away: where a property hangs on rounding, one has it in the end."""
    moved = unit + 0.01 * np.roll(unit, 1)
    return moved / np.linalg.norm(moved)


def half_turns_about_almost_an_axis():
    """Half turns about a coordinate axis that leans towards another by 6e-7, each towards each.

    A formula that divides by the small component loses all digits, and one that compares only some of the diagonal's entries
    chooses it.
    """
    return [rotation_about(np.eye(3)[one] + 6e-7 * np.eye(3)[other], np.pi) for one, other in permutations(range(3), 2)]


def almost_half_turns(rng):
    """Turns about slanted axes that are short of a half turn by an angle in each decade below 1 radian.

    In the last decade w is too small to be felt by itself, but who divides by it loses all digits of x, y and z: there a
    formula is right or wrong for good, a decade before it would be a matter of luck.
    """
    return [rotation_about(slanted_axis(rng), np.pi - size(rng, decade)) for decade in (*SMALL[::-1], -7)]


def wide_turn(rng, largest=None):
    """A turn by 125 to 170 degrees about a slanted axis: the trace is negative. `largest`: see `half_turn`."""
    return rotation_about(slanted_axis(rng, largest), np.radians(rng.uniform(125.0, 170.0)))


def tilt(rng):
    """A turn by 20 to 80 degrees about a slanted axis: tilted, and the trace is positive."""
    return rotation_about(slanted_axis(rng), np.radians(rng.uniform(20.0, 80.0)))


def slanted_axis(rng, largest=None):
    """A unit vector of mixed signs; no number is near zero, and no two are nearly alike in size. `largest`: see `half_turn`."""
    sizes = _with_largest(largest, rng.permutation([0.4, 0.65, 0.9]) + rng.uniform(-0.05, 0.05, size=3))
    axis = sizes * rng.choice([-1.0, 1.0], size=3)
    return axis / np.linalg.norm(axis)


def _with_largest(index, sizes):
    """The three sizes, rolled until the largest is at `index`."""
    return sizes if index is None else np.roll(sizes, index - np.argmax(sizes))


def vector(rng, length=1.0):
    """A generic vector of about this length: three components, none near zero and no two nearly alike in size."""
    sizes = rng.permutation([0.3, 0.6, 0.9]) + rng.uniform(-0.1, 0.1, size=3)
    return length * sizes * rng.choice([-1.0, 1.0], size=3)


def size(rng, decade):
    """A length (metres) or an angle (radians) in [10^decade, 10^(decade + 1)).

    A `vector` of this length is in the decade, too, and so are x, y and z of the quaternion of one of the `small_turns`.
    """
    return rng.uniform(6.0, 7.5) * 10.0**decade


def far(rng):
    """Vectors with a length in each decade of FAR, near its beginning: four decimals are not enough for the first."""
    return [vector(rng, size(rng, decade) / 5.0) for decade in FAR]


def near(rng):
    """Vectors with a length in each decade of SMALL."""
    return [vector(rng, size(rng, decade)) for decade in SMALL]


def small_turns(rng):
    """Turns about slanted axes by an angle in each decade of SMALL."""
    axes = (rng.permutation([0.36, 0.48, 0.8]) * rng.choice([-1.0, 1.0], size=3) for _ in SMALL)
    return [rotation_about(axis, size(rng, decade)) for axis, decade in zip(axes, SMALL)]


def small_transforms(rng):
    """Frames that are hardly turned and hardly moved, both by as little, in each decade of SMALL."""
    return [transform(R, p) for R, p in zip(small_turns(rng), near(rng))]


def transform(R, p):
    """The 4x4 homogeneous transform of a rotation and a translation."""
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = R, p
    return result


def at_right_angles(*turned):
    """A point 1 m away that a turn (3x3 or 4x4) moves most, at right angles to its axis; to those of both, for two turns."""
    axes = [vector_of(each[:3, :3]) for each in turned]
    return np.linalg.svd([axis / np.linalg.norm(axis) for axis in axes])[2][-1]


def with_its_turn(T, p):
    """The transform, its translation turned round where need be: it adds to what the turn does to p, and hides it not."""
    by_turning = T[:3, :3] @ p - p
    return transform(T[:3, :3], np.copysign(1.0, by_turning @ T[:3, 3]) * T[:3, 3])


def small_with_points(rng):
    """(T, p): each of the `small_transforms`, and a point that it moves far, for its size."""
    frames = small_transforms(rng)
    return [(with_its_turn(T, p), p) for T, p in zip(frames, map(at_right_angles, frames))]


def seen_from_afar(rng, decades=SMALL):
    """(a_T_b, p_in_b): B is tilted and far from A, the point p near A's origin; its distance is in each of the decades.

    Of large numbers that cancel, single precision keeps too few digits.
    """
    frames = [transform(tilt(rng), vector(rng, size(rng, FAR[index % len(FAR)]))) for index in range(len(decades))]
    points = [vector(rng, size(rng, decade)) for decade in decades]
    return [(T, T[:3, :3].T @ (p - T[:3, 3])) for T, p in zip(frames, points)]


def whole(T):
    """The same matrix, as an array of integers: who builds the answer in an array of this type cuts off its fractions."""
    return T.astype(int)


def whole_transform():
    """A transform of integers, as one types it: quarter turns, and a few metres."""
    return whole(transform(signed_permutations()[5], (1, -2, 3)))


def no_turn(p):
    """Poses at p that are not turned: of the two quaternions for it, the second has w = -1."""
    return [pose_of(p, (0, 0, 0, w)) for w in (1, -1)]


def whole_pose():
    """A pose of integers, as one types it: a half turn about x."""
    return Pose(Point(1, -2, 3), Quaternion(1, 0, 0, 0))


def is_whole(value):
    """Whether an array, a Pose or a number is of integers."""
    if isinstance(value, Pose):
        return type(value.position.x) is int
    return value.dtype.kind == "i" if isinstance(value, np.ndarray) else type(value) is int


def whole_but_for_rounding(numbers):
    """Whether one of the numbers is a whole one, and not 0, but for rounding: cut off, its fraction may take a 1 along."""
    return bool(np.any((np.abs(numbers) > 0.5) & (np.abs(numbers - np.round(numbers)) < 1e-9)))


def generic_transform(rng):
    """A tilted frame somewhere: a generic rotation and a translation that is not along its axis."""
    return transform(rotation(rng), vector(rng))


def quaternion(R):
    """x, y, z, w of a rotation matrix."""
    return quaternion_of(R)


def pose_of(p, q):
    """The Pose of a position x, y, z and a quaternion x, y, z, w."""
    return Pose(Point(*(float(c) for c in p)), Quaternion(*(float(c) for c in q)))


def pose(R, p):
    """The Pose of a rotation and a translation."""
    return pose_of(p, quaternion(R))


def position(pose):
    """x, y, z of a Pose's position."""
    return np.array([pose.position.x, pose.position.y, pose.position.z])


def orientation(pose):
    """x, y, z, w of a Pose's orientation."""
    q = pose.orientation
    return np.array([q.x, q.y, q.z, q.w])


def matrix(pose):
    """The 4x4 transform of a Pose; needs a quaternion other than 0, 0, 0, 0."""
    return transform(matrix_of(orientation(pose)), position(pose))


def generic_pose(rng):
    """A tilted frame somewhere, as a Pose."""
    return pose(rotation(rng), vector(rng))


def either_sign(poses):
    """The poses, with w < 0 in every second quaternion and w > 0 in the others: q and -q are the same orientation."""
    result = []
    for index, pose in enumerate(poses):
        q = orientation(pose)
        result.append(pose_of(position(pose), q * (-1) ** index * np.copysign(1.0, q[3])))
    return result


def roll_pitch_yaw(R):
    """Angles (radians) about the fixed axes x, y and z, in this order; at gimbal lock, the yaw is 0."""
    return Rotation.from_matrix(R).as_euler("xyz", suppress_warnings=True)


def from_roll_pitch_yaw(angles):
    """The rotation matrix of such angles."""
    return Rotation.from_euler("xyz", angles).as_matrix()


def off_diagonal(R):
    """Twice the sine of the angle times the axis; zero for a half turn."""
    return np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])


def with_bottom_row(T, row):
    """The transform T, its bottom row another."""
    return np.vstack((T[:3], row))


def x_axis_upright(R):
    """Whether B's x axis points straight up or down, where roll and yaw cannot be told apart."""
    return abs(R[2, 0]) > 1.0 - 1e-9
