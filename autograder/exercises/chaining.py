"""The exercises of notebook 3: chains of transforms, and a pose in another frame."""

from functools import reduce
from itertools import pairwise

import numpy as np
from transform_lab.arithmetic import Rotation
from transform_lab.judging.naming import together

from .cases import (
    almost_half_turns,
    either_sign,
    generic_pose,
    generic_transform,
    half_turn,
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
    seen_from_afar,
    signed_permutations,
    small_transforms,
    small_turns,
    small_with_points,
    tilt,
    transform,
    vector,
    whole_pose,
    whole_transform,
    wide_turn,
    x_axis_upright,
)
from .conversions import (
    BEYOND_120,
    BY_ANGLES,
    BY_BRANCHES,
    BY_TRACE,
    ORDERS,
    from_euler,
    near_half_turns,
    product,
    rotation_vector,
)
from .equivalent import MAKING_A_POSE, READING_A_POSE
from .features import number_of, of_each, of_pose, of_product, of_transform
from .homogeneous_transforms import (
    BOTTOM_ROW,
    ENTRY_BY_ENTRY,
    NO_ORIENTATION,
    QUATERNION_ORDER,
    at_lock,
    open_where,
)
from .specification import Case, Exercise, Misconception

# --- chain ----------------------------------------------------------------------------------------------------------


def chain(*transforms):
    return reduce(np.matmul, transforms)


def chain_cases(rng):
    def some(number):
        return tuple(generic_transform(rng) for _ in range(number))

    along_axes = [transform(R, vector(rng)) for R in signed_permutations()]
    shuffled = [along_axes[index] for index in rng.permutation(24)]
    first, second, third = some(3)
    still, whole_numbers = np.eye(4), whole_transform()
    small = small_transforms(rng)
    families = {
        "two frames, each turned by quarter turns": list(zip(shuffled[:12], shuffled[12:])),
        "one or two transforms": [(first, second), some(1), (first, third), some(1), (still, second), (first, first)],
        "three transforms": [(first, second, third), (second, third, first), (third, third, third)],
        "four to six transforms": [some(4), (first, second, still, third, second), some(6), (first,) * 4],
        "frames hardly turned and hardly moved": [
            *((T, transform(rotation(rng), p)) for T, p in small_with_points(rng)), (*some(1), small[0]), tuple(small),
        ],
        "frames far away and close by": [
            (transform(tilt(rng), vector(rng, 50.0)), transform(half_turn(rng), vector(rng, 0.01))),
            (transform(wide_turn(rng), vector(rng, 0.01)), transform(tilt(rng), vector(rng, 50.0)), *some(1)),
            *((T, transform(tilt(rng), p)) for T, p in seen_from_afar(rng)),
        ],
        "one transform in whole numbers": [(whole_numbers, second), (first, whole_numbers, third)],
    }  # fmt: skip
    return [Case(family, args) for family, lists in families.items() for args in lists]


def _earlier(T, others):
    return any(np.array_equal(T, other) for other in others)


def _with_rotation(of):
    """`chain` of someone whose rotation is `of(the rotations)`, and who adds the translations."""
    return lambda *transforms: transform(of([T[:3, :3] for T in transforms]), sum(T[:3, 3] for T in transforms))


def _pairs(transforms, alone):
    """`chain` of someone for whom a single transform is something else."""
    return chain(*transforms) if len(transforms) > 1 else alone


def _alone(error):
    """`chain` that raises an error for a single transform."""

    def wrong(*transforms):
        if len(transforms) == 1:
            raise error
        return chain(*transforms)

    return wrong


def _in_pairs(*transforms):
    """Multiplied two by two until one is left; one that has no partner is lost."""
    row = list(transforms)
    while len(row) > 1:
        row = [first @ second for first, second in zip(row[::2], row[1::2])]
    return row[0]


def _rotation_first(*transforms):
    R, p = np.eye(3), np.zeros(3)
    for T in transforms:
        R = R @ T[:3, :3]
        p = p + R @ T[:3, 3]
    return transform(R, p)


def _translation_last(*transforms):
    """From the last link on, each translation turned by the rotation of the link that it belongs to."""
    R, p = np.eye(3), np.zeros(3)
    for T in reversed(transforms):
        R = T[:3, :3] @ R
        p = T[:3, 3] + R @ p
    return transform(R, p)


ALONE = (
    "Your function goes wrong for a single transform.",
    "A chain can have one link only: what is its last frame, described in its first?",
)
SOME_LEFT_OUT = (
    "Some of the transforms did not get into the product.",
    "Try your function on one, on two, and on five transforms, and count how many it multiplies.",
)
MATCH_THE_NAMES = "Write the frames' names under the product: next to each other, the same frame has to stand twice."
REVERSED = (
    "The transforms were multiplied in the reverse order.",
    MATCH_THE_NAMES,
)
EACH_BY_ITSELF = (
    "The translations were added, each as it is.",
    "Each translation counts along the axes of its own frame: the transforms before have turned these.",
)
ONE_INVERTED = (
    "Transforms were inverted on the way.",
    "Write the frames' names under the product: a chain whose inner names fit needs no inverse.",
)

CHAIN = Exercise(
    name="chain",
    returns="transform",
    answer="first_T_last",
    reference=chain,
    cases=chain_cases,
    features=(*number_of("transforms", 6), *of_each("transforms", of_transform("transforms"))),
    credit={"rotation": 0.4, "translation": 0.4},
    weights={"three transforms": 2},
    misconceptions=(
        *(
            Misconception("order-reversed", wrong, *REVERSED)
            for wrong in (
                lambda *transforms: chain(*reversed(transforms)),
                lambda *transforms: chain(*(transforms if len(transforms) < 3 else reversed(transforms))),
                lambda *transforms: chain(*reversed(transforms[2:]), *transforms[:2]),  # right for two
                lambda *transforms: chain(*reversed(transforms[:-1]), transforms[-1]),  # right for two, too
                lambda *transforms: chain(transforms[-1], *transforms[:-1]),
                lambda *transforms: chain(*transforms[-2:], *reversed(transforms[:-2])),  # each time the rest in front
            )
        ),
        *(
            Misconception("elementwise-product", wrong, *ENTRY_BY_ENTRY)
            for wrong in (
                lambda *transforms: reduce(np.multiply, transforms),
                lambda *transforms: reduce(np.multiply, transforms, np.eye(4)),
            )
        ),
        *(Misconception("single-transform", _alone(error), *ALONE) for error in (IndexError, TypeError, ValueError)),
        *(
            Misconception("single-transform", lambda *transforms, alone=alone: _pairs(transforms, alone), *ALONE)
            for alone in (np.eye(4), np.zeros((4, 4)))
        ),
        *(
            Misconception(
                "updated-too-early",
                wrong,
                "Rotation and translation are worked out one after the other, and the second with the first one's new value.",
                "Which rotation do the axes have along which the next translation counts: that before this link, or after it?",
            )
            for wrong in (_rotation_first, _translation_last)
        ),
        Misconception(
            "order-reversed",
            lambda *transforms: transform(chain(*transforms[::-1])[:3, :3], chain(*transforms)[:3, 3]),
            "The translation is right, but the rotations were multiplied in the reverse order.",
            MATCH_THE_NAMES,
        ),
        Misconception(
            "order-reversed",
            lambda *transforms: transform(chain(*transforms)[:3, :3], chain(*transforms[::-1])[:3, 3]),
            "The rotation is right, but the translations were put together in the reverse order.",
            MATCH_THE_NAMES,
        ),
        Misconception("offset-not-rotated", _with_rotation(lambda rotations: chain(*rotations)), *EACH_BY_ITSELF),
        Misconception(
            "offset-not-rotated",
            lambda *transforms: transform(
                chain(*transforms)[:3, :3],
                sum(chain(*pair)[:3, 3] - pair[0][:3, 3] for pair in pairwise((np.eye(4), *transforms))),
            ),
            "Each translation is turned by the link before it alone.",
            "All links before it turn it: keep their product.",
        ),
        Misconception(
            "offset-not-rotated;order-reversed",
            _with_rotation(lambda rotations: chain(*reversed(rotations))),
            *together(EACH_BY_ITSELF, REVERSED),
        ),
        Misconception(
            "orientation-not-transformed",
            lambda *transforms: transform(transforms[-1][:3, :3], chain(*transforms)[:3, 3]),
            "The rotation is that of the last transform alone.",
            "Every link turns all that come after it.",
        ),
        Misconception(
            "orientation-identity",
            lambda *transforms: transform(np.eye(3), chain(*transforms)[:3, 3]),
            "The rotation is the identity.",
            "Every link turns all that come after it.",
        ),
        Misconception(
            "translation-dropped",
            lambda *transforms: transform(chain(*transforms)[:3, :3], (0, 0, 0)),
            "The translation is missing.",
            "Multiply the whole 4x4 matrices: rotations alone do not say where the last frame is.",
        ),
        Misconception(
            "bottom-row-wrong",
            lambda *transforms: np.vstack((chain(*transforms)[:3], np.zeros(4))),
            *BOTTOM_ROW,
        ),
        *(
            Misconception("transforms-left-out", wrong, *SOME_LEFT_OUT)
            for wrong in (
                lambda *transforms: chain(*transforms[:2]),
                lambda *transforms: transforms[0] @ transforms[1],  # fails for a single one
                lambda *transforms: chain(*transforms[-2:]),
                lambda *transforms: chain(transforms[0], transforms[-1]) if len(transforms) > 1 else transforms[0],
                lambda *transforms: chain(np.eye(4), *transforms[1:]),
                lambda *transforms: chain(np.eye(4), *transforms[:-1]),
                lambda *transforms: transforms[0],
                lambda *transforms: transforms[-1],
                lambda *transforms: chain(transforms[0], *transforms[1:-1]),
                lambda *transforms: chain(*transforms[:3]),
                lambda *transforms: chain(*transforms[:4]),
                _in_pairs,
                lambda *transforms: chain(np.eye(4), *transforms[: len(transforms) // 2 * 2]),
                lambda *transforms: chain(*(T for i, T in enumerate(transforms) if not _earlier(T, transforms[:i]))),
            )
        ),
        Misconception(
            "too-few-arguments",
            lambda first, second: first @ second,
            "Your function takes exactly two transforms.",
            "A chain can have any number of links: what does a star before a parameter do?",
        ),
        *(
            Misconception(
                "applied-twice",
                wrong,
                "Some of the transforms are in the product twice.",
                "Write down, for two and for three transforms, which of them your product takes in which step.",
            )
            for wrong in (
                lambda *transforms: chain(transforms[0], *transforms),
                lambda *transforms: chain(*transforms, transforms[-1]),
                lambda *transforms: chain(np.eye(4), *(T for pair in pairwise(transforms) for T in pair)),
            )
        ),
        Misconception(
            "added-not-multiplied",
            lambda *transforms: sum(transforms),
            "The matrices were added.",
            "Which operation takes a point through one transform and then through the next?",
        ),
        Misconception(
            "wrong-direction",
            lambda *transforms: np.linalg.inv(chain(*transforms)),
            "Your answer is the inverse: it describes the first frame in terms of the last.",
            "Which frame is described, and which one is it described in?",
        ),
        *(
            Misconception("wrong-transform-inverted", wrong, *ONE_INVERTED)
            for wrong in (
                lambda *transforms: chain(transforms[0], *map(np.linalg.inv, transforms[1:])),
                lambda *transforms: chain(np.linalg.inv(transforms[0]), *transforms[1:]),
                lambda *transforms: chain(*transforms[:-1], np.linalg.inv(transforms[-1])),
                lambda *transforms: chain(*map(np.linalg.inv, transforms)),
            )
        ),
    ),
)

# --- transform_pose -------------------------------------------------------------------------------------------------


def transform_pose(a_T_b, pose_in_b):
    T = a_T_b @ matrix(pose_in_b)
    return pose(T[:3, :3], T[:3, 3])


def transform_pose_cases(rng):
    along_axes = signed_permutations()
    shuffled = [along_axes[index] for index in rng.permutation(24)]
    T, p = generic_transform(rng), generic_pose(rng)
    families = {
        "frames turned by quarter turns": [
            (transform(R, vector(rng)), pose(R.T @ S, vector(rng)))
            for R, S in zip(shuffled, along_axes)
            if np.diag(S).all()
            or x_axis_upright(S)  # no turn and half turns about an axis, and gimbal lock, in all: twelve
        ],
        "tilted frames": [
            (T, p),
            (T, generic_pose(rng)),
            (generic_transform(rng), p),
            (generic_transform(rng), pose(rotation(rng), np.zeros(3))),
            (generic_transform(rng), pose(np.eye(3), vector(rng))),
            (transform(rotation(rng), np.zeros(3)), generic_pose(rng)),
            (transform(np.eye(3), vector(rng)), generic_pose(rng)),
            (np.eye(4), generic_pose(rng)),
            (generic_transform(rng), pose(np.eye(3), np.zeros(3))),
            (generic_transform(rng), pose_of(vector(rng), (0.5, 0.5, -0.5, 0.5))),  # its trace is 0
        ],
        "frames turned by more than 120 degrees": [
            (transform(R, vector(rng)), pose(S, vector(rng)))
            for R, S in ((wide_turn(rng), wide_turn(rng)), (half_turn(rng), tilt(rng)), (tilt(rng), half_turn(rng)))
        ],
        "turned by more than 120 degrees in all": [
            (transform(R, vector(rng)), pose(R.T @ turn(rng, axis), vector(rng)))
            for R, turn, axis in ((rotation(rng), turn, axis) for turn in (wide_turn, half_turn) for axis in range(3))
        ],
        "almost a half turn in all, or one almost about an axis of A": [
            *(
                (transform(R, vector(rng)), pose(R.T @ almost, vector(rng)))
                for R, almost in ((rotation(rng), almost) for almost in almost_half_turns(rng))
            ),
            *((transform(np.eye(3), vector(rng)), pose(R, vector(rng))) for R in half_turns_about_almost_an_axis()),
        ],
        "frames hardly turned and hardly moved": [
            *((T, pose(R, p)) for (T, p), R in zip(small_with_points(rng), small_turns(rng))),
            *((transform(rotation(rng), vector(rng)), pose(R, p)) for R, p in zip(small_turns(rng), near(rng))),
        ],
        "frames far away and close by": [
            (transform(tilt(rng), vector(rng, 50.0)), pose(wide_turn(rng), vector(rng, 0.01))),
            *((T, pose(tilt(rng), p)) for T, p in seen_from_afar(rng, (0, -1, 0))),
        ],
    }
    cases = [
        Case(family, (T, pose_in_b))
        for family, pairs in families.items()
        for T, pose_in_b in zip([T for T, _ in pairs], either_sign([pose_in_b for _, pose_in_b in pairs]))
    ]
    return [
        *cases,
        Case("frame or pose in whole numbers", (whole_transform(), generic_pose(rng))),
        *(
            Case("frame or pose in whole numbers", (generic_transform(rng), frame))
            for frame in (whole_pose(), *no_turn(vector(rng)))
        ),
    ]


def _with_position(of):
    """`transform_pose` of someone whose orientation is right and whose position is `of(a_T_b, position in B)`."""
    return lambda a_T_b, pose_in_b: pose_of(
        of(a_T_b, position(pose_in_b)), orientation(transform_pose(a_T_b, pose_in_b))
    )


def _with_orientation(of):
    """`transform_pose` of someone whose position is right and whose quaternion is `of(a_T_b, pose_in_b)`."""
    return lambda a_T_b, pose_in_b: pose_of(a_T_b[:3, :3] @ position(pose_in_b) + a_T_b[:3, 3], of(a_T_b, pose_in_b))


def _as_pose(T, order=slice(None)):
    """The Pose of a transform, the quaternion's numbers in some order."""
    return pose_of(T[:3, 3], quaternion(T[:3, :3])[order])


def _read_in_another_order(a_T_b, pose_in_b, order):
    return orientation(transform_pose(a_T_b, pose_of(position(pose_in_b), orientation(pose_in_b)[order])))


def _added(first, second):
    return (first + second) / np.linalg.norm(first + second)


def _angles_added(a_T_b, pose_in_b):
    return from_euler(sum(roll_pitch_yaw(T[:3, :3]) for T in (a_T_b, matrix(pose_in_b))))


def _rotation_vectors_added(T, pose_in_b):
    return Rotation.from_rotvec(sum(rotation_vector(M[:3, :3]) for M in (T, matrix(pose_in_b)))).as_quat()


def _quaternion_product(row, column):
    """The product of quaternions with one sign wrong in one of its four sums."""

    def wrong(T, pose_in_b):
        first, second = quaternion(T[:3, :3]), orientation(pose_in_b)
        units = np.eye(4)
        result = product(first, second)
        result[row] -= 2.0 * product(first, units[column])[row] * second[column]
        return result

    return wrong


def _cross_product_reversed(number):
    """The product of quaternions with two signs wrong in one number: the cross product's."""

    def wrong(T, pose_in_b):
        first, second = quaternion(T[:3, :3]), orientation(pose_in_b)
        result = product(first, second)
        result[number] -= 2.0 * np.cross(first[:3], second[:3])[number]
        return result

    return wrong


def _with_positive_w(q):
    return np.append(q[:3], abs(q[3]))


ONE_SIGN = (
    "One of the orientation's four numbers is wrong: a sign in the product of quaternions.",
    "Multiply by a turn about x, about y and about z, one after the other, and compare with what tft makes of them.",
)
ONE_TURNED_BACK = (
    "One of the two rotations was used the opposite way round: transposed, or its quaternion conjugated.",
    "The pose is turned in B, and B is turned in A: neither has to be undone.",
)
THE_WRONG_WAY_ROUND = (
    "The two transforms were multiplied in the wrong order.",
    MATCH_THE_NAMES,
)

FROM_A_TO_B = (
    "You took the pose from A to B; asked for is from B to A.",
    "Which frame is the given pose in, and which frame does a_T_b lead to?",
)

TRANSFORM_POSE = Exercise(
    name="transform_pose",
    returns="pose",
    answer="pose_in_a",
    reference=transform_pose,
    cases=transform_pose_cases,
    features=(*of_transform("a_T_b"), *of_pose("pose_in_b"), *of_product("a_T_b", "pose_in_b")),
    credit={"position": 0.5, "orientation": 0.5},
    weights={"tilted frames": 2},
    equivalent=READING_A_POSE | MAKING_A_POSE,
    misconceptions=(
        Misconception(
            "orientation-not-transformed",
            _with_orientation(lambda a_T_b, pose_in_b: orientation(pose_in_b)),
            "The orientation is still the one in B.",
            "If B is tilted in A, can the pose have the same quaternion in both frames?",
        ),
        Misconception(
            "position-not-transformed",
            _with_position(lambda a_T_b, p_in_b: p_in_b),
            "The position is still the one in B.",
            "If B's origin is elsewhere in A, can the pose have the same coordinates in both frames?",
        ),
        Misconception(
            "offset-not-rotated",
            _with_position(lambda a_T_b, p_in_b: p_in_b + a_T_b[:3, 3]),
            "The two translations were added, as if B's axes were parallel to A's.",
            "The position counts along B's axes: how do these lie in A?",
        ),
        Misconception(
            "translation-dropped",
            _with_position(lambda a_T_b, p_in_b: a_T_b[:3, :3] @ p_in_b),
            "The position was turned, but not moved: B's own translation has dropped out.",
            "Where in A does a pose come out that lies in B's origin?",
        ),
        Misconception(
            "position-missing",
            _with_position(lambda a_T_b, p_in_b: (0, 0, 0)),
            "The position is 0, 0, 0.",
            "The message has two fields; the transform of the result has a translation.",
        ),
        Misconception(
            "wrong-position",
            _with_position(lambda a_T_b, p_in_b: a_T_b[:3, 3]),
            "The position is that of B's origin.",
            "The pose lies elsewhere in B: its own position has to be in the answer too.",
        ),
        Misconception(
            "order-reversed",
            lambda a_T_b, pose_in_b: _as_pose(matrix(pose_in_b) @ a_T_b),
            *THE_WRONG_WAY_ROUND,
        ),
        Misconception(
            "order-reversed",
            _with_orientation(lambda a_T_b, pose_in_b: quaternion(matrix(pose_in_b)[:3, :3] @ a_T_b[:3, :3])),
            "The two rotations were multiplied in the wrong order.",
            "A product of quaternions has an order too, and it is that of the matrices.",
        ),
        Misconception(
            "wrong-direction",
            lambda a_T_b, pose_in_b: _as_pose(np.linalg.inv(a_T_b) @ matrix(pose_in_b)),
            *FROM_A_TO_B,
        ),
        Misconception(
            "wrong-direction",
            lambda a_T_b, pose_in_b: _as_pose(np.linalg.inv(a_T_b @ matrix(pose_in_b))),
            "Your answer is the inverse: it describes A in terms of the pose.",
            "Read the names again: which frame is described, and which one is it described in?",
        ),
        Misconception(
            "orientation-identity",
            _with_orientation(lambda a_T_b, pose_in_b: (0, 0, 0, 1)),
            "The orientation is 0, 0, 0, 1, which means no rotation.",
            "The pose is turned in B, and B is turned in A: both belong in the answer.",
        ),
        Misconception("orientation-missing", _with_orientation(lambda a_T_b, pose_in_b: (0, 0, 0, 0)), *NO_ORIENTATION),
        Misconception(
            "wrong-orientation",
            _with_orientation(lambda a_T_b, pose_in_b: quaternion(a_T_b[:3, :3])),
            "The orientation is B's alone.",
            "The pose is turned in B, and B is turned in A: both belong in the answer.",
        ),
        Misconception(
            "rotation-transposed",
            _with_orientation(lambda a_T_b, pose_in_b: quaternion((a_T_b @ matrix(pose_in_b))[:3, :3].T)),
            "The orientation is the opposite turn.",
            "Was a rotation transposed, or a quaternion conjugated, on the way to the answer?",
        ),
        *(
            Misconception(
                "quaternion-order",
                _with_orientation(lambda T, p, order=order: orientation(transform_pose(T, p))[order]),
                *QUATERNION_ORDER,
            )
            for order in ORDERS
        ),
        *(
            Misconception(
                "quaternion-order",
                _with_orientation(lambda T, p, order=order, back=back: _read_in_another_order(T, p, order)[back]),
                *QUATERNION_ORDER,
            )
            for order in ORDERS
            for back in ([0, 1, 2, 3], np.argsort(order))
        ),
        *(
            Misconception(
                "order-reversed;quaternion-order",
                lambda a_T_b, pose_in_b, order=order: _as_pose(matrix(pose_in_b) @ a_T_b, order),
                *together(THE_WRONG_WAY_ROUND, QUATERNION_ORDER),
            )
            for order in ORDERS
        ),
        *(
            Misconception(
                "wrong-direction;quaternion-order",
                lambda a_T_b, pose_in_b, order=order: _as_pose(np.linalg.inv(a_T_b) @ matrix(pose_in_b), order),
                *together(FROM_A_TO_B, QUATERNION_ORDER),
            )
            for order in ORDERS
        ),
        Misconception(
            "wrong-direction;order-reversed",
            lambda a_T_b, pose_in_b: _as_pose(matrix(pose_in_b) @ np.linalg.inv(a_T_b)),
            *together(FROM_A_TO_B, THE_WRONG_WAY_ROUND),
        ),
        *(
            Misconception(
                identifier,
                _with_orientation(lambda T, p, wrong=wrong: wrong(T @ matrix(p))),
                *says,
                **open_where(varies, fails, lambda T, p: T @ matrix(p)),
            )
            for identifier, says, wrong, varies, fails in (BY_TRACE, BEYOND_120, BY_ANGLES, *BY_BRANCHES)
        ),
        *(
            Misconception(  # the quaternion of a_T_b, multiplied with the one that is given
                identifier,
                _with_orientation(lambda T, p, wrong=wrong: product(wrong(T), orientation(p))),
                *says,
                **open_where(varies, fails, lambda T, p: T),
            )
            for identifier, says, wrong, varies, fails in (BY_TRACE, BEYOND_120)
        ),
        *(
            Misconception(
                "quaternions-added",
                _with_orientation(lambda T, p, of=of: of(quaternion(T[:3, :3]), orientation(p))),
                "The two quaternions were added.",
                "One rotation after another is a product, of quaternions as of matrices.",
            )
            for of in (_added, np.add)
        ),
        Misconception(
            "euler-angles-added",
            _with_orientation(_angles_added),
            "Roll, pitch and yaw of the two rotations were added.",
            "Angles add up when both turns share an axis. One rotation after another is a product.",
            varies=at_lock(lambda T, p: T, lambda T, p: matrix(p)),
        ),
        Misconception(
            "rotation-vectors-added",
            _with_orientation(_rotation_vectors_added),
            "The rotation vectors (axis times angle) of the two rotations were added.",
            "They add up when both turns share an axis. One rotation after another is a product.",
            varies=lambda T, p: ("orientation",) if any(near_half_turns(M[:3, :3]) for M in (T, matrix(p))) else (),
        ),
        Misconception(
            "elementwise-product",
            _with_orientation(lambda T, p: quaternion(T[:3, :3]) * orientation(p)),
            "The two quaternions were multiplied number by number.",
            "The product of two quaternions mixes their numbers: tft has a function for it.",
        ),
        Misconception(
            "change-of-basis",
            _with_orientation(lambda T, p: np.append(T[:3, :3] @ orientation(p)[:3], orientation(p)[3])),
            "The turn is told along A's axes, but B's own turn is not in the answer.",
            "The pose is turned in B, and B is turned in A: what is the whole turn from A to the pose?",
        ),
        *(
            Misconception("formula-slip", _with_orientation(_quaternion_product(row, column)), *ONE_SIGN)
            for row in range(4)
            for column in range(4)
        ),
        *(Misconception("formula-slip", _with_orientation(_cross_product_reversed(k)), *ONE_SIGN) for k in range(3)),
        Misconception(
            "sign-ignored",
            _with_orientation(lambda T, p: _with_positive_w(product(quaternion(T[:3, :3]), orientation(p)))),
            "The orientation goes wrong where the product's w is negative.",
            "Changing the sign of w alone gives another orientation; what happens if all four signs change?",
        ),
        *(
            Misconception("rotation-transposed", _with_orientation(of), *ONE_TURNED_BACK)
            for of in (
                lambda T, p: quaternion(T[:3, :3].T @ matrix(p)[:3, :3]),
                lambda T, p: quaternion(T[:3, :3] @ matrix(p)[:3, :3].T),
            )
        ),
        Misconception(
            "rotation-applied-twice",
            _with_position(lambda T, p_in_b: T[:3, :3] @ T[:3, :3] @ p_in_b + T[:3, 3]),
            "The position was turned twice.",
            "The transform turns the position already.",
        ),
        Misconception(
            "rotation-transposed",
            _with_position(lambda T, p_in_b: T[:3, :3].T @ p_in_b + T[:3, 3]),
            "The position was turned the opposite way.",
            "The columns of B's rotation are its axes in A; the rows are not.",
        ),
    ),
)

EXERCISES = (CHAIN, TRANSFORM_POSE)
