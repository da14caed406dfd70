"""The exercises of notebook 5: poses that are given relative to an object."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
from transform_lab.arithmetic import Rotation
from transform_lab.judging.naming import together

from .cases import (
    FAR,
    SMALL,
    almost_half_turns,
    at_right_angles,
    either_sign,
    far,
    from_roll_pitch_yaw,
    half_turn,
    half_turn_to_rounding,
    half_turns_about_almost_an_axis,
    matrix,
    near,
    no_turn,
    orientation,
    pose,
    pose_of,
    position,
    quaternion,
    roll_pitch_yaw,
    rotation,
    rotation_about,
    seen_from_afar,
    signed_permutations,
    size,
    small_turns,
    tilt,
    vector,
    whole_pose,
    wide_turn,
    x_axis_upright,
)
from .conversions import (
    BEYOND_120,
    BY_ANGLES,
    BY_TRACE,
    ORDERS,
    TURNED_WITH_A_TERM_MISSING,
    at_half_turns,
    by_tangents,
    near_half_turns,
    slips,
)
from .equivalent import MAKING_A_POSE, READING_A_POSE, UPPER_LEFT
from .features import LENGTHS, of_number, of_orientation, of_pose, of_vector
from .homogeneous_transforms import ENTRY_BY_ENTRY, NO_ORIENTATION, QUATERNION_ORDER, at_lock, open_where
from .specification import Case, Exercise, Misconception

LAB_OBJECT = pose_of((0.6, -0.1, 0.7), (0.0, 0.0, math.sin(math.pi / 8), math.cos(math.pi / 8)))  # the lab's


def waypoint(object_pose, offset):
    base_T_object = matrix(object_pose)
    return pose_of(base_T_object[:3, :3] @ offset + base_T_object[:3, 3], orientation(object_pose))


def pre_grasp(object_pose, distance=0.1):
    return waypoint(object_pose, (-distance, 0.0, 0.0))


def _upright(rng):
    angles = math.pi / 6, -rng.uniform(1.7, 2.9), rng.uniform(1.0, 1.5)
    return [LAB_OBJECT, *(pose(rotation_about((0, 0, 1), angle), vector(rng)) for angle in angles)]


def _along_axes(rng):
    """Twelve of the 24, which is plenty here and keeps the public key small; four of them with the x axis upright."""
    along_axes = rng.permutation(signed_permutations())
    upright = sorted(filter(x_axis_upright, along_axes), key=lambda R: -np.trace(R))  # first a quarter turn about y
    others = [R for R in along_axes if not x_axis_upright(R)]
    return [
        whole_pose(), *no_turn(vector(rng)), *either_sign([pose(R, vector(rng)) for R in (*upright[:4], *others[:8])]),
    ]  # fmt: skip


def _tilted(rng):
    return either_sign(
        [pose(R, vector(rng)) for R in (tilt(rng), wide_turn(rng), rotation(rng), tilt(rng), half_turn(rng))]
    )


def _almost_half_turned(rng):
    turns = *almost_half_turns(rng), half_turn_to_rounding(rng), *half_turns_about_almost_an_axis()
    return either_sign([pose(R, vector(rng)) for R in turns])


def _hardly_turned(rng):
    """At the base's origin, or hardly off it."""
    return either_sign([pose(R, p) for R, p in zip((np.eye(3), *small_turns(rng)), (np.zeros(3), *near(rng)))])


def _far(rng):
    return either_sign([pose(R, p) for R, p in zip((tilt(rng), wide_turn(rng), tilt(rng)), far(rng))])


def _across(object_pose):
    """A step of 2 m at right angles to the axis that the object is turned about, if it is turned."""
    R = matrix(object_pose)[:3, :3]
    return 2.0 * (np.eye(3)[0] if np.array_equal(R, np.eye(3)) else at_right_angles(R))


def pre_grasp_cases(rng):
    tilted, others = _tilted(rng), _tilted(rng)
    odd = rng.uniform(0.111, 0.119)  # no whole number of centimetres
    return [
        *(Case("an object turned by quarter turns", (object_pose,)) for object_pose in _along_axes(rng)),
        *(Case("an upright object, the notebook's among them", (object_pose,)) for object_pose in _upright(rng)),
        *(Case("a tilted object", args) for args in zip(tilted, (0.25, 0.1, 0.05, odd, 0.2))),
        *(Case("another distance", args) for args in zip(tilted, (0.02, 1, odd, 0.1))),
        *(Case("no distance, or a negative one: in front of the object", args) for args in zip(others, (0.0, -0.05, 0))),
        *(Case("a short distance", (pose(rotation(rng), vector(rng)), s * size(rng, d))) for s, d in zip((1, -1) * 3, SMALL)),
        *(
            Case("a distance given by its name", (object_pose,), {"distance": distance})
            for object_pose, distance in zip((*others[2:], tilted[0]), (0.25, 0.02, 0.15, odd))
        ),
        *(Case("an object that is almost turned by a half turn", (p, 3.0)) for p in _almost_half_turned(rng)),
        *(Case("an object hardly turned, almost at the base", (p, d)) for p, d in zip(_hardly_turned(rng), (0.2, *[3.0] * 6))),
        *(Case("an object far away", args) for args in zip(_far(rng), (0.3, 0.02, 20.0))),
        *(
            Case("an object far away", (pose(R, distance * R[:, 0] + vector(rng)), distance))  # the answer is near
            for R, distance in ((tilt(rng), size(rng, decade)) for decade in FAR)
        ),
    ]  # fmt: skip


def waypoint_cases(rng):
    steps = np.array([[-0.1, 0.0, 0.0], [0.0, 0.05, 0.0], [0.1, 0.0, 0.2], [0.0, -0.2, 0.1]])
    tilted, offset = _tilted(rng), vector(rng, 0.3)
    return [
        *(Case("an object turned by quarter turns", (frame, vector(rng, 0.5))) for frame in _along_axes(rng)),
        *(Case("an upright object, the notebook's among them", args) for args in zip(_upright(rng), steps)),
        *(Case("a tilted object", (object_pose, offset)) for object_pose in tilted),
        *(Case("a step along one axis of a tilted object, or none", args) for args in zip(tilted, 0.1 * np.eye(4, 3))),
        Case("a step along one axis of a tilted object, or none", (tilted[4], np.array([1, 0, -2]))),
        *(Case("a short step", (pose(rotation(rng), vector(rng)), step)) for step in near(rng)),
        *(Case("an object that is almost turned by a half turn", (p, _across(p))) for p in _almost_half_turned(rng)),
        *(Case("an object hardly turned, almost at the base", (p, _across(p))) for p in _hardly_turned(rng)),
        *(Case("an object far away, and long steps", args) for args in zip(_far(rng), (vector(rng, 0.01), *far(rng)[:2]))),
        *(
            Case("an object far away, and long steps", (pose(T[:3, :3], T[:3, 3]), p))
            for T, p in seen_from_afar(rng, (0, -1, 0))
        ),
    ]  # fmt: skip


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


def _open(part, where):
    """The part in which implementations differ, for objects turned in a way that `where(R)` is true of."""
    return lambda object_pose, offset: (part,) if where(matrix(object_pose)[:3, :3]) else ()


def _turned_twice(object_pose):
    R = matrix(object_pose)[:3, :3]
    return quaternion(R @ R)


def _moved_by(step):
    """`waypoint` of someone who goes by `step(x y z w, offset)`."""

    def wrong(object_pose, offset):
        q = orientation(object_pose)
        return pose_of(position(object_pose) + step(q, np.asarray(offset)), q)

    return wrong


def _with_sign_of_w(object_pose, offset):
    """Makes w positive by its sign, which is 0 where w is: four zeros are left of the quaternion, and nothing is turned."""
    if orientation(object_pose)[3]:
        return waypoint(object_pose, offset)
    return pose_of(position(object_pose) + offset, (0, 0, 0, 0))


AT_HALF_TURNS = (
    "The answer goes wrong for objects that are turned by half a turn, where the quaternion's w is 0.",
    "What does your function do with w: is something divided by it, or multiplied by its sign?",
)
ONE_TERM = (
    "The offset is not turned quite right: a sign or a term of the formula with the quaternion's numbers is missing.",
    "Turning changes no length: which offsets come out longer or shorter than they were?",
)
PARTLY_IN_THE_BASE = (
    "One number of the offset was added along an axis of the base, the others along those of the object.",
    "An object can lie on its side: where does its own z axis point then?",
)
IN_THE_BASE = (
    "The offset was added along the axes of the base, as if the object were not turned.",
    "Behind, beside and above are meant along the object's axes: how do these lie in the base frame?",
)
OPPOSITE_SIDE = (
    "The answer lies on the opposite side of the object.",
    "The object's axes tell which side is which. Do you add the step, or subtract it?",
)
TURNED_BACK = (
    "The offset was turned the opposite way.",
    "The columns of the object's rotation are its axes in the base frame; the rows are not.",
)
UPRIGHT_ONLY = (
    "The offset was turned about z only, as if every object stood upright.",
    "Objects can be tilted. Use the whole rotation, not an angle of it.",
)
READ_IN_ANOTHER_ORDER = (
    "The numbers of the quaternion were read in another order than ROS's.",
    QUATERNION_ORDER[1],
)

_back_to_front = _with_quaternion_read(ORDERS[2], copied=True)

SHARED: tuple[Misconception, ...] = (
    Misconception("base-frame-offset", _moved(lambda p, R, offset: p + offset), *IN_THE_BASE),
    Misconception("wrong-sign", _moved(lambda p, R, offset: p - R @ offset), *OPPOSITE_SIDE),
    Misconception(
        "base-frame-offset;wrong-sign",
        _moved(lambda p, R, offset: p - offset),
        *together(IN_THE_BASE, OPPOSITE_SIDE),
    ),
    Misconception("rotation-transposed", _moved(lambda p, R, offset: p + R.T @ offset), *TURNED_BACK),
    Misconception(
        "rotation-transposed;wrong-sign",
        _moved(lambda p, R, offset: p - R.T @ offset),
        *together(TURNED_BACK, OPPOSITE_SIDE),
    ),
    *(
        Misconception(
            identifier,
            _moved(_right_position, lambda object_pose, wrong=wrong: wrong(matrix(object_pose))),
            *says,
            **open_where(varies, fails, lambda object_pose, offset: matrix(object_pose)),
        )
        for identifier, says, wrong, varies, fails in (BY_TRACE, BEYOND_120, BY_ANGLES)
    ),
    Misconception(
        "position-missing",
        _moved(lambda p, R, offset: R @ offset),
        "The answer is the offset alone, seen from the base's origin.",
        "Where does the object itself come in?",
    ),
    Misconception(
        "product-missing",
        _moved(lambda p, R, offset: offset),
        "The position is still the one in the object's frame.",
        "Which product carries a point of the object's frame to the base frame?",
    ),
    Misconception(
        "offset-missing",
        _moved(lambda p, R, offset: p),
        "The answer is at the object itself: the offset is not in it.",
        "Move along the object's axes, starting where the object is.",
    ),
    Misconception(
        "order-reversed",
        _moved(lambda p, R, offset: R @ (p + offset)),
        "The object's own position was turned too.",
        "The position is already given in the base frame; only the offset is given in the object's.",
    ),
    Misconception(
        "orientation-missing",
        _moved(_right_position, lambda object_pose: (0, 0, 0, 0)),
        *NO_ORIENTATION,
    ),
    Misconception(
        "orientation-identity",
        _moved(_right_position, lambda object_pose: (0, 0, 0, 1)),
        "The orientation is 0, 0, 0, 1: aligned with the base, not with the object.",
        "Relative to the object the answer is not turned; relative to the base the object itself is.",
    ),
    Misconception(
        "rotation-applied-twice",
        _moved(_right_position, _turned_twice),
        "The object's rotation is in the orientation twice.",
        "How is the answer turned relative to the object, before you go to the base frame?",
    ),
    Misconception(
        "yaw-only",
        _moved(lambda p, R, offset: p + _yaw(math.atan2(R[1, 0], R[0, 0])) @ offset),
        *UPRIGHT_ONLY,
        _open("position", x_axis_upright),  # where there is no yaw
    ),
    Misconception("yaw-only", _yaw_of_quaternion, *UPRIGHT_ONLY),
    Misconception(
        "half-turn-missed",
        _moved_by(lambda q, offset: by_tangents(q) @ offset),
        *AT_HALF_TURNS,
        **open_where(
            near_half_turns, at_half_turns, lambda object_pose, offset: matrix(object_pose), parts=("position",)
        ),
    ),
    Misconception("half-turn-missed", _with_sign_of_w, *AT_HALF_TURNS),
    *(
        Misconception("formula-slip", _moved_by(lambda q, offset, turned=turned: turned(q, offset)), *ONE_TERM)
        for turned in TURNED_WITH_A_TERM_MISSING
    ),
    *(
        Misconception("quaternion-order", wrong, *READ_IN_ANOTHER_ORDER)
        for wrong in (
            *(_with_quaternion_read(order, copied=False) for order in ORDERS),
            *(_with_quaternion_read(order, copied=True) for order in ORDERS[:2]),
            _back_to_front,
        )
    ),
    *(
        Misconception(
            "quaternion-order",
            _with_quaternion_written(order),
            "The numbers of the quaternion were written in another order than ROS's.",
            READ_IN_ANOTHER_ORDER[1],
        )
        for order in ORDERS
    ),
    *(
        Misconception(
            "quaternion-order;wrong-sign",
            lambda object_pose, offset, wrong=wrong: wrong(object_pose, -np.asarray(offset)),
            *together(READ_IN_ANOTHER_ORDER, OPPOSITE_SIDE),
        )
        for order in ORDERS
        for wrong in (_with_quaternion_read(order, copied=True), _with_quaternion_read(order, copied=False))
    ),
)


def _behind(of_offset):
    """What does something with an object's pose and an offset, as something with the pose and a distance."""
    return lambda object_pose, distance=0.1: of_offset(object_pose, (-distance, 0.0, 0.0))


ALWAYS_TEN = (
    "The answer is always 10 cm away from the object, whatever distance is asked for.",
    "Your function has a second argument; 0.1 is only what it is when nobody gives it.",
)

# With an offset along x alone, a quaternion that is read back to front gives what a pitch of the wrong sign gives.
UPSIDE_DOWN = {
    "says": "The approach is upside down: the quaternion was read back to front, or a pitch has the wrong sign.",
    "hint": "For an object that points straight down, where is the gripper before it grasps: above, or below?",
}


def _without_distance(object_pose, distance=None):
    return ("position",) if distance is None else ()


PRE_GRASP = Exercise(
    name="pre_grasp",
    returns="pose",
    answer="base_T_pre_grasp",
    reference=pre_grasp,
    cases=pre_grasp_cases,
    features=(*of_pose("object_pose"), *of_orientation("object_pose"), *of_number("distance", LENGTHS)),
    credit={"position": 0.5},
    weights={"a tilted object": 2},
    equivalent=READING_A_POSE | MAKING_A_POSE | {UPPER_LEFT: ("transform: 4 -> 5",)},
    misconceptions=(
        *(
            replace(
                shared,
                wrong=_behind(shared.wrong),
                varies=_behind(shared.varies),
                fails=_behind(shared.fails),
                **(UPSIDE_DOWN if shared.wrong is _back_to_front else {}),
            )
            for shared in SHARED
        ),
        Misconception("distance-ignored", lambda object_pose, distance=0.1: pre_grasp(object_pose), *ALWAYS_TEN),
        Misconception(
            "distance-ignored;wrong-sign",
            lambda object_pose, distance=0.1: pre_grasp(object_pose, -0.1),
            *together(ALWAYS_TEN, OPPOSITE_SIDE),
        ),
        Misconception(
            "distance-ignored;base-frame-offset",
            _behind(_moved(lambda p, R, offset: p - (0.1, 0, 0))),
            *together(ALWAYS_TEN, IN_THE_BASE),
        ),
        Misconception(
            "wrong-default",
            lambda object_pose, distance=0.2: pre_grasp(object_pose, distance),
            "The answer goes wrong where no distance is given.",
            "How far behind the object is the gripper then? The docstring says it; a parameter can have a default.",
            varies=_without_distance,
            fails=_without_distance,
        ),
        Misconception(
            "wrong-sign",
            lambda object_pose, distance=0.1: pre_grasp(object_pose, abs(distance)),
            "The sign of the distance is ignored.",
            "A negative distance behind the object is a place in front of it.",
        ),
        *(
            Misconception(
                "wrong-units",
                lambda object_pose, distance=0.1, factor=factor: pre_grasp(object_pose, factor * distance),
                "The distance was converted to other units.",
                "The distance is in metres, as all lengths are: nothing needs to be converted.",
            )
            for factor in (100, 0.01)
        ),
        *(
            Misconception(
                "wrong-axis",
                lambda object_pose, distance=0.1, axis=axis: waypoint(object_pose, -distance * axis),
                "You moved along another axis of the object than its x axis.",
                "Along which axis of the object does the gripper approach?",
            )
            for axis in (*np.eye(3)[1:], *-np.eye(3)[1:])
        ),
        *(
            Misconception("formula-slip", _behind(_moved_by(lambda q, offset, of=of: of(q) @ offset)), *ONE_TERM)
            for of in slips(0)
        ),
        Misconception(
            "zero-taken-for-missing",
            lambda object_pose, distance=0.1: pre_grasp(object_pose, distance or 0.1),
            "A distance of 0 is taken for 0.1.",
            "A distance of 0 is one, too, though Python takes it for False: what tells it from one that is missing?",
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
    features=(*of_pose("object_pose"), *of_orientation("object_pose"), *of_vector("offset")),
    credit={"position": 0.5},
    weights={"a tilted object": 2},
    equivalent=READING_A_POSE | MAKING_A_POSE | {UPPER_LEFT: ("transform: 4 -> 5",)},
    misconceptions=(
        *SHARED,
        *(
            Misconception(
                "wrong-axis",
                _moved(lambda p, R, offset, used=used: p + R @ (offset * used)),
                "Not all three numbers of the offset are used.",
                "The offset can go along all three axes of the object.",
            )
            for used in product((1, 0), repeat=3)
            if 0 < sum(used) < 3
        ),
        *(
            Misconception(
                "base-frame-offset", _moved(lambda p, R, v, k=k: p + R @ (v * (1 - k)) + v * k), *PARTLY_IN_THE_BASE
            )
            for k in np.eye(3, dtype=int)
        ),
        *(
            Misconception(
                "wrong-sign",
                _moved(lambda p, R, offset, signs=signs: p + R @ (offset * signs)),
                "One number of the offset goes the opposite way.",
                "All three numbers of the offset count along the object's axes as they are, each with its own sign.",
            )
            for signs in 1 - 2 * np.eye(3)
        ),
        Misconception(
            "wrong-axis",
            _moved(lambda p, R, offset: p + R[:, 0] * np.linalg.norm(offset)),
            "You move along the object's x axis, by the length of the offset.",
            "The offset has a direction, too: its three numbers count along the object's three axes.",
        ),
        *(
            Misconception(
                "elementwise-product",
                _moved(lambda p, R, offset, of=of: p + of(R, offset)),
                "Rotation and offset were multiplied entry by entry.",
                ENTRY_BY_ENTRY[1],
            )
            for of in (lambda R, offset: np.sum(R * offset, axis=0), lambda R, offset: np.diag(R) * offset)
        ),
        Misconception(
            "distance-ignored",
            _moved(lambda p, R, offset: p + 0.1 * R @ offset / max(np.linalg.norm(offset), 1e-12)),
            "The answer is always 10 cm away, whatever the length of the offset.",
            "The offset says how far to go, not only in which direction.",
        ),
        *(
            Misconception(
                "euler-order",
                _moved(lambda p, R, offset, again=again: p + again(roll_pitch_yaw(R)) @ offset),
                "Roll, pitch and yaw were put together in another order than they were taken apart.",
                "A rotation matrix or a quaternion can be used as it is, without any angles.",
                varies=at_lock(lambda object_pose, offset: matrix(object_pose), parts=("position",)),
            )
            for again in (
                lambda angles: from_roll_pitch_yaw(angles[::-1]),
                lambda angles: Rotation.from_euler("XYZ", angles).as_matrix(),
            )
        ),
        *(
            Misconception("formula-slip", _moved_by(lambda q, offset, of=of: of(q) @ offset), *ONE_TERM)
            for of in slips(0, 1, 2)
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
