"""The exercises of notebook 5: poses that are given relative to an object."""

import math

import numpy as np
from scipy.spatial.transform import Rotation

from .cases import (
    either_sign,
    matrix,
    near_half_turn,
    orientation,
    pose,
    pose_of,
    position,
    quaternion,
    rotation,
    rotation_about,
    signed_permutations,
    tilt,
    vector,
    wide_turn,
)
from .homogeneous_transforms import NO_ORIENTATION
from .specification import Case, Exercise, Misconception

LAB_OBJECT = pose_of((0.6, -0.1, 0.7), (0.0, 0.0, 0.38268343, 0.92387953))  # the lab's, as printed there


def waypoint(object_pose, offset):
    base_T_object = matrix(object_pose)
    return pose_of(base_T_object[:3, :3] @ offset + base_T_object[:3, 3], orientation(object_pose))


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, (-distance, 0.0, 0.0))


def _upright(rng):
    angles = math.pi / 6, -rng.uniform(1.7, 2.9), rng.uniform(1.0, 1.5)
    return [LAB_OBJECT, *(pose(rotation_about((0, 0, 1), angle), vector(rng)) for angle in angles)]


def _along_axes(rng):
    """Twelve of the 24, which is plenty here and keeps the public key small."""
    along_axes = signed_permutations()
    return either_sign([pose(along_axes[index], vector(rng)) for index in rng.permutation(24)[:12]])


def _tilted(rng):
    turns = tilt(rng), wide_turn(rng), rotation(rng), near_half_turn(rng, 1e-3)
    return either_sign([pose(R, vector(rng)) for R in turns])


def _far(rng):
    return either_sign([pose(tilt(rng), vector(rng, 50.0)), pose(wide_turn(rng), vector(rng, 20.0))])


def pre_grasp_cases(rng):
    return [
        *(Case("an object turned by quarter turns", (object_pose,)) for object_pose in _along_axes(rng)),
        *(Case("an upright object, the notebook's among them", (object_pose,)) for object_pose in _upright(rng)),
        *(Case("a tilted object", args) for args in zip(_tilted(rng), (0.25, 0.1, 0.05, 0.2))),
        *(Case("another distance", args) for args in zip(_tilted(rng), (0.25, 0.02, 1.0, 0.1))),
        *(
            Case("a distance given by its name", (object_pose,), {"distance": distance})
            for object_pose, distance in zip(_tilted(rng), (0.25, 0.02, 0.15))
        ),
        *(Case("an object far away", args) for args in zip(_far(rng), (0.3, 0.02))),
    ]


def waypoint_cases(rng):
    steps = np.array([[-0.1, 0.0, 0.0], [0.0, 0.05, 0.0], [0.1, 0.0, 0.2], [0.0, -0.2, 0.1]])
    return [
        *(Case("an object turned by quarter turns", (frame, vector(rng, 0.5))) for frame in _along_axes(rng)),
        *(Case("an upright object, the notebook's among them", args) for args in zip(_upright(rng), steps)),
        *(Case("a tilted object", (object_pose, vector(rng, 0.3))) for object_pose in _tilted(rng)),
        *(Case("a step along one axis of a tilted object", args) for args in zip(_tilted(rng), 0.1 * np.eye(3))),
        *(
            Case("an object far away, and steps of several sizes", (object_pose, vector(rng, length)))
            for object_pose, length in zip(_far(rng), (20.0, 0.01))
        ),
    ]


# --- misconceptions: the two exercises differ in where the offset comes from only -------------------------------------


def _moved(position_with, orientation_with=orientation):
    """`waypoint` of someone whose position is `position_with(p, R, offset)`, and whose quaternion is another."""

    def wrong(object_pose, offset):
        R = matrix(object_pose)[:3, :3]
        return pose_of(position_with(position(object_pose), R, np.asarray(offset)), orientation_with(object_pose))

    return wrong


def _right_position(p, R, offset):
    return p + R @ offset


def _yaw(angle):
    return Rotation.from_euler("z", angle).as_matrix()


def _yaw_of_quaternion(object_pose, offset):
    x, y, z, w = orientation(object_pose)
    return pose_of(position(object_pose) + _yaw(2.0 * math.atan2(z, w)) @ offset, (x, y, z, w))


def _with_quaternion_read(order, copied):
    """Reads the object's quaternion in another order; its orientation is copied, or made from what was read."""

    def wrong(object_pose, offset):
        read = orientation(object_pose)[order]
        R = Rotation.from_quat(read).as_matrix()
        return pose_of(position(object_pose) + R @ offset, orientation(object_pose) if copied else read)

    return wrong


def _with_quaternion_written(order):
    def wrong(object_pose, offset):
        right = waypoint(object_pose, offset)
        return pose_of(position(right), orientation(right)[order])

    return wrong


def _turned_twice(object_pose):
    R = matrix(object_pose)[:3, :3]
    return quaternion(R @ R)


SHARED = [
    (
        "base-frame-offset",
        _moved(lambda p, R, offset: p + offset),
        "The offset was added along the axes of the base, as if the object were not turned.",
        "The offset is given in the object's frame: how do the object's axes lie in the base frame?",
    ),
    (
        "wrong-sign",
        _moved(lambda p, R, offset: p - R @ offset),
        "The answer lies on the opposite side of the object.",
        "The object's frame tells which side is which: in which direction does its x axis point?",
    ),
    (
        "rotation-transposed",
        _moved(lambda p, R, offset: p + R.T @ offset),
        "The offset was turned the opposite way.",
        "The columns of the object's rotation are its axes in the base frame; the rows are not.",
    ),
    (
        "position-missing",
        _moved(lambda p, R, offset: R @ offset),
        "The answer is the offset alone, seen from the base's origin.",
        "Where does the object itself come in?",
    ),
    (
        "offset-missing",
        _moved(lambda p, R, offset: p),
        "The answer is at the object itself: the offset is not in it.",
        "Move along the object's axes, starting where the object is.",
    ),
    (
        "order-reversed",
        _moved(lambda p, R, offset: R @ (p + offset)),
        "The object's own position was turned too.",
        "The position is already given in the base frame; only the offset is given in the object's.",
    ),
    (
        "orientation-missing",
        _moved(_right_position, lambda object_pose: (0, 0, 0, 0)),
        *NO_ORIENTATION,
    ),
    (
        "orientation-identity",
        _moved(_right_position, lambda object_pose: (0, 0, 0, 1)),
        "The orientation is 0, 0, 0, 1: aligned with the base, not with the object.",
        "Relative to the object the answer is not turned; relative to the base the object itself is.",
    ),
    (
        "rotation-applied-twice",
        _moved(_right_position, _turned_twice),
        "The object's rotation is in the orientation twice.",
        "How is the answer turned relative to the object, before you go to the base frame?",
    ),
    (
        "yaw-only",
        _moved(lambda p, R, offset: p + _yaw(math.atan2(R[1, 0], R[0, 0])) @ offset),
        "The offset was turned about z only, as if every object stood upright.",
        "Objects can be tilted. Use the whole rotation, not an angle of it.",
    ),
    (
        "yaw-only",
        _yaw_of_quaternion,
        "The offset was turned about z only, as if every object stood upright.",
        "Objects can be tilted. Use the whole rotation, not an angle of it.",
    ),
    *(
        (
            "quaternion-order",
            wrong,
            f"The numbers of the quaternion were {done} in another order than ROS's.",
            "Which comes first in `tf.transformations`, and which last: is w at the front or at the end?",
        )
        for order in ([3, 0, 1, 2], [1, 2, 3, 0], [3, 2, 1, 0])
        for done, wrong in (
            ("read", _with_quaternion_read(order, copied=True)),
            ("read", _with_quaternion_read(order, copied=False)),
            ("written", _with_quaternion_written(order)),
        )
    ),
]


def _behind(wrong):
    """The wrong `waypoint` as a wrong `pre_grasp`."""
    return lambda object_pose, distance=0.1: wrong(object_pose, (-distance, 0.0, 0.0))


PRE_GRASP = Exercise(
    name="pre_grasp",
    returns="pose",
    answer="base_T_pre_grasp",
    reference=pre_grasp,
    cases=pre_grasp_cases,
    credit={"position": 0.5},
    weights={"a tilted object": 2},
    misconceptions=(
        *(Misconception(identifier, _behind(wrong), says, hint) for identifier, wrong, says, hint in SHARED),
        Misconception(
            "distance-ignored",
            lambda object_pose, distance=0.1: pre_grasp(object_pose),
            "The answer is always 10 cm behind the object, whatever distance is asked for.",
            "Your function has a second argument; 0.1 is only what it is when nobody gives it.",
        ),
        *(
            Misconception(
                "wrong-axis",
                lambda object_pose, distance=0.1, axis=axis: waypoint(object_pose, -distance * axis),
                "The answer lies beside, above or below the object, not behind it.",
                "Along which axis of the object does the gripper approach?",
            )
            for axis in (*np.eye(3)[1:], *-np.eye(3)[1:])
        ),
        Misconception(
            "towards-the-base",
            _behind(_moved(lambda p, R, offset: p + offset[0] * p / np.linalg.norm(p))),
            "The answer lies on the line from the object to the origin of the base.",
            '"Behind" is meant along an axis of the object, wherever the base is.',
        ),
    ),
)

WAYPOINT = Exercise(
    name="waypoint",
    returns="pose",
    answer="base_T_waypoint",
    reference=waypoint,
    cases=waypoint_cases,
    credit={"position": 0.5},
    weights={"a tilted object": 2},
    misconceptions=(
        *(Misconception(identifier, wrong, says, hint) for identifier, wrong, says, hint in SHARED),
        Misconception(
            "wrong-axis",
            _moved(lambda p, R, offset: p + R[:, 0] * offset[0]),
            "Only the first number of the offset is used.",
            "The offset can go along all three axes of the object.",
        ),
        Misconception(
            "rotation-applied-twice",
            _moved(lambda p, R, offset: p + R @ R @ offset),
            "The offset was turned twice.",
            "From the object's frame to the base frame is one step.",
        ),
    ),
)

EXERCISES = (PRE_GRASP, WAYPOINT)
