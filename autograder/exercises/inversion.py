"""The exercises of notebook 4: the inverse of a transform, and what it is good for."""

import numpy as np
from transform_lab.arithmetic import Rotation
from transform_lab.judging.naming import together

from .cases import (
    FAR,
    at_right_angles,
    far,
    from_roll_pitch_yaw,
    generic_transform,
    half_turn,
    near,
    off_diagonal,
    roll_pitch_yaw,
    rotation,
    seen_from_afar,
    signed_permutations,
    size,
    small_transforms,
    small_turns,
    small_with_points,
    tilt,
    transform,
    vector,
    whole,
    whole_transform,
    wide_turn,
    with_bottom_row,
    with_its_turn,
)
from .conversions import BY_TRACE, near_half_turns, rotation_vector
from .equivalent import WHOLE_STAY_WHOLE
from .features import of_transform, of_two_frames, of_vector
from .homogeneous_transforms import BOTTOM_ROW, ENTRY_BY_ENTRY, ONE_IN_FRONT, YAW_ALONE, at_lock, open_where
from .rotation import TRUNCATED
from .specification import Case, Exercise, Misconception


def _parts(T):
    return T[:3, :3], T[:3, 3]


def _inverse_with(rotation, translation):
    """An inverse whose two parts are `rotation(R, p)` and `translation(R, p)`."""
    return lambda T: transform(rotation(*_parts(T)), translation(*_parts(T)))


# Wrong inverses, shared by the exercises that need an inverse
_parts_separately = _inverse_with(lambda R, p: R.T, lambda R, p: -p)
_rotation_kept = _inverse_with(lambda R, p: R, lambda R, p: -p)

INVERSE_BY_TRANSPOSE = (
    "The whole 4x4 matrix was transposed.",
    "The transpose inverts a rotation, but not a transform: look where the translation has gone.",
)
PARTS_SEPARATELY = (
    "Rotation and translation were inverted each by itself.",
    "The translation of the inverse is A's origin as seen from B, along B's axes, and these are turned.",
)
ONE_BELOW = (
    "The translation stands in the bottom row.",
    "The bottom row of a transform is 0, 0, 0, 1; so is that of its inverse.",
)
ROTATION_NOT_INVERTED = (
    "The inverse still turns the same way as the transform itself.",
    "If B is turned to the left in A, how is A turned in B?",
)

TRANSLATION_NOT_TURNED_BACK = (
    "The translation was turned by the rotation that is not inverted.",
    "A's origin has to be given along B's axes: which of the two rotations leads from A to B?",
)
STILL_B_IN_A = (
    "The rotation is still that of B in A.",
    "If B is turned to the left in A, how is A turned in B?",
)
OPPOSITE_TRANSLATION = (
    "The translation has the right length and the opposite sign.",
    "If B's origin is in front of A, A's origin is behind B (when both look the same way).",
)
STILL_B_ORIGIN = (
    "The translation is still B's origin in A.",
    "The inverse has to say where A's origin is in B.",
)
ALL_SIGNS = (
    "You changed signs to invert: of the whole matrix, or of the rotation.",
    "A transform times its inverse gives the identity; a number's negative undoes a sum, not a product.",
)
# Wrong inverses that the steps after them can go on with: (id, what is said, the inverse)
WRONG_INVERSES = [
    ("inverse-by-transpose", INVERSE_BY_TRANSPOSE, np.transpose),
    ("inverse-parts-separately", PARTS_SEPARATELY, _parts_separately),
    ("rotation-not-inverted", ROTATION_NOT_INVERTED, _rotation_kept),
    ("rotation-not-inverted", STILL_B_IN_A, _inverse_with(lambda R, p: R, lambda R, p: -R.T @ p)),
    ("rotation-not-inverted", TRANSLATION_NOT_TURNED_BACK, _inverse_with(lambda R, p: R.T, lambda R, p: -R @ p)),
    ("wrong-sign", OPPOSITE_TRANSLATION, _inverse_with(lambda R, p: R.T, lambda R, p: R.T @ p)),
    ("wrong-sign", ALL_SIGNS, _inverse_with(lambda R, p: -R, lambda R, p: -p)),
    ("translation-not-inverted", STILL_B_ORIGIN, _inverse_with(lambda R, p: R.T, lambda R, p: p)),
]

OF_THE_ANSWER = (STILL_B_IN_A, OPPOSITE_TRANSLATION, STILL_B_ORIGIN, TRANSLATION_NOT_TURNED_BACK)

# --- invert_transform -----------------------------------------------------------------------------------------------


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def invert_transform_cases(rng):
    R, p = rotation(rng), vector(rng)  # each with another: a function may not remember one by the other
    families = {
        "a frame turned by quarter turns": [transform(R, vector(rng)) for R in signed_permutations()],
        "a tilted frame": [
            transform(R, p), transform(rotation(rng), p), transform(R, vector(rng)),
            transform(half_turn(rng), vector(rng)), transform(rotation(rng), np.zeros(3)),
        ],
        "a frame turned by more than 120 degrees": [transform(wide_turn(rng), vector(rng)) for _ in range(2)],
        "a frame hardly turned": [transform(R, at_right_angles(R)) for R in small_turns(rng)],
        "a frame hardly turned and hardly moved": small_transforms(rng),
        "a frame far away": [
            *(transform(tilt(rng), p) for p in far(rng)),
            *(
                transform(R, R @ (size(rng, decade), 0.4, -0.7))  # the answer has small numbers, too
                for R, decade in zip((rotation(rng), wide_turn(rng), tilt(rng)), FAR)
            ),
        ],
        "a frame in whole numbers": [whole(transform(R, (1, -2, 3))) for R in (np.eye(3), signed_permutations()[5])],
    }  # fmt: skip
    return [Case(family, (T,)) for family, transforms in families.items() for T in transforms]


def _by_axis_and_angle(a_T_b):
    """Turned back by the angle about the axis, which is 0/0 at a half turn."""
    R = a_T_b[:3, :3]
    angle = np.arccos(np.clip((np.trace(R) - 1.0) / 2.0, -1.0, 1.0))
    axis = off_diagonal(R) / (2.0 * np.sin(angle)) if angle > 1e-9 else off_diagonal(R)
    back = Rotation.from_rotvec(-angle * axis).as_matrix()
    return transform(back, -back @ a_T_b[:3, 3])


def _angles_negated(a_T_b):
    R = from_roll_pitch_yaw(-roll_pitch_yaw(a_T_b[:3, :3]))
    return transform(R, -R @ a_T_b[:3, 3])


def _yaw_turned_back(a_T_b):
    R = Rotation.from_euler("z", -np.arctan2(a_T_b[1, 0], a_T_b[0, 0])).as_matrix()
    return transform(R, -R @ a_T_b[:3, 3])


INVERT_TRANSFORM = Exercise(
    name="invert_transform",
    returns="transform",
    answer="b_T_a",
    reference=invert_transform,
    cases=invert_transform_cases,
    features=of_transform("a_T_b"),
    equivalent={WHOLE_STAY_WHOLE: ("the answer in the type of a_T_b",)},
    credit={"rotation": 0.3, "translation": 0.5},
    weights={"a tilted frame": 2},
    misconceptions=(
        *(Misconception(identifier, wrong, *says) for identifier, says, wrong in WRONG_INVERSES),
        Misconception(
            "trace-formula-only",
            _by_axis_and_angle,
            "Your inverse goes wrong at or near a half turn.",
            "Axis and angle cannot be read off the matrix's differences there. Turning back needs neither.",
            **open_where(*BY_TRACE[-2:], lambda a_T_b: a_T_b, ("rotation", "translation")),
        ),
        Misconception("integer-truncation", lambda a_T_b: np.trunc(invert_transform(a_T_b)), *TRUNCATED),
        Misconception(
            "yaw-only",
            _yaw_turned_back,
            "You turn back about z only; roll and pitch are lost.",
            YAW_ALONE[1],
        ),
        Misconception(
            "euler-angles-negated",
            _angles_negated,
            "Roll, pitch and yaw were negated, but not undone in the reverse order.",
            "What was done last has to be undone first. A matrix needs no angles for that.",
            varies=at_lock(lambda a_T_b: a_T_b, parts=("rotation", "translation")),
        ),
        Misconception(
            "translation-in-bottom-row",
            lambda a_T_b: transform(a_T_b[:3, :3], invert_transform(a_T_b)[:3, 3]).T,
            *ONE_BELOW,
        ),
        Misconception(
            "inverse-parts-separately;translation-in-bottom-row",
            lambda a_T_b: transform(a_T_b[:3, :3], -a_T_b[:3, 3]).T,
            *together(PARTS_SEPARATELY, ONE_BELOW),
        ),
        *(
            Misconception(
                "bottom-row-wrong", lambda a_T_b, row=row: with_bottom_row(invert_transform(a_T_b), row), *BOTTOM_ROW
            )
            for row in ((0, 0, 0, 0), (1, 1, 1, 1))
        ),
        Misconception(
            "inverse-missing",
            lambda a_T_b: a_T_b,
            "Your answer is the transform itself, not its inverse.",
            "What does your function have to undo?",
        ),
        Misconception("wrong-sign", lambda a_T_b: -a_T_b, *ALL_SIGNS),
        Misconception(
            "position-missing",
            _inverse_with(lambda R, p: R.T, lambda R, p: (0, 0, 0)),
            "The translation is missing.",
            "The inverse has to say where A's origin is in B.",
        ),
        *(
            Misconception(
                "elementwise-inverse",
                wrong,
                "Every entry was inverted by itself.",
                "`**` and `/` work entry by entry in NumPy. Look among the functions of `np.linalg`.",
            )
            for wrong in (
                lambda a_T_b: a_T_b**-1,
                lambda a_T_b: np.divide(1, a_T_b, np.zeros((4, 4)), where=a_T_b != 0),
            )
        ),
    ),
)

# --- relative_transform ---------------------------------------------------------------------------------------------


def relative_transform(a_T_b, a_T_c):
    return np.linalg.inv(a_T_b) @ a_T_c


def relative_transform_cases(rng):
    along_axes = [transform(R, vector(rng)) for R in signed_permutations()]
    shuffled = [along_axes[index] for index in rng.permutation(24)]
    R, p = rotation(rng), vector(rng)
    B, C, turned = transform(R, p), generic_transform(rng), transform(tilt(rng), p)
    whole_numbers = whole_transform()
    families = {
        "frames turned by quarter turns": list(zip(shuffled[:12], shuffled[12:])),
        "two tilted frames": [(B, C), (B, generic_transform(rng)), (turned, C), (B, turned)],
        "two frames turned by more than 120 degrees": [
            (transform(wide_turn(rng), vector(rng)), transform(wide_turn(rng), vector(rng))),
            (transform(half_turn(rng), vector(rng)), transform(wide_turn(rng), vector(rng))),
        ],
        "two frames that are close to each other, or the same": [
            (C, C), *((C, C @ T) for T in small_transforms(rng)),
        ],
        "two frames far away, or far from each other": [
            *((transform(R, far_away), transform(R @ tilt(rng), far_away + vector(rng))) for far_away in far(rng)),
            *((C, transform(rotation(rng), p)) for p in far(rng)),
            *((transform(R, far_away), transform(R, far_away + p)) for far_away, p in zip((*far(rng), *far(rng)), near(rng))),
        ],
        "a frame hardly turned and hardly moved, or not at all": [
            (np.eye(4), B), (C, np.eye(4)), *zip(small_transforms(rng), small_transforms(rng)),
            *((T, transform(rotation(rng), p)) for T, p in small_with_points(rng)),
        ],
        "one frame in whole numbers": [(whole_numbers, C), (B, whole_numbers)],
    }  # fmt: skip
    return [Case(family, pair) for family, pairs in families.items() for pair in pairs]


MATCH_THE_NAMES = "Write the frames' names under your product: next to each other, the same frame has to stand twice."
ONE_POINTS_RIGHT = (
    "Write the frames' names under your product: which of the two transforms points the right way already?"
)
BOTH_AS_THEY_ARE = (
    "Neither of the two transforms was inverted.",
    MATCH_THE_NAMES,
)
THE_OTHER_INVERTED = (
    "You inverted one transform, but not the one that points the wrong way.",
    "Write the frames' names under your product: which of the two transforms has to be turned round?",
)
PRODUCT_REVERSED = (
    "The right transform was inverted, but the product is in the wrong order.",
    MATCH_THE_NAMES,
)
B_FROM_C = (
    "Your answer is the inverse: it describes B in terms of C.",
    "Read the name b_T_c again: which frame is described, and which one is it described in?",
)
NOT_INTO_THE_AXES = (
    "The translation is the difference of the two origins, still along A's axes.",
    "Seen from B, the same arrow has other components: B's axes are turned.",
)

ALONG_OTHER_AXES = (
    "The arrow from B to C is told along the axes of another frame than B.",
    "Asked for is C as seen from B: along whose axes do its coordinates count?",
)


def of_the_inverse(says):
    """What is said of a wrong inverse, where it is a step on the way only."""
    return (f"The inverse that you multiply with is not one. {says[0]}", says[1]) if says in OF_THE_ANSWER else says


def _relative_with(rotation, along):
    """`relative_transform` of someone whose rotation is `rotation(R_b, R_c)`, and who tells the arrow from B to C `along`."""

    def wrong(a_T_b, a_T_c):
        (b, from_a), (c, to) = _parts(a_T_b), _parts(a_T_c)
        return transform(rotation(b, c), along(b, c, to - from_a))

    return wrong


def _arrow_along_b(b, c, arrow):
    return b.T @ arrow


def _half_turned(T):
    """Whether the rotation vector may as well be the opposite one."""
    return near_half_turns(T[:3, :3])


RELATIVE_TRANSFORM = Exercise(
    name="relative_transform",
    returns="transform",
    answer="b_T_c",
    reference=relative_transform,
    cases=relative_transform_cases,
    features=(*of_transform("a_T_b"), *of_transform("a_T_c"), *of_two_frames("a_T_b", "a_T_c")),
    credit={"rotation": 0.4, "translation": 0.4},
    weights={"two tilted frames": 2},
    misconceptions=(
        Misconception(
            "wrong-direction",
            lambda a_T_b, a_T_c: relative_transform(a_T_c, a_T_b),
            *B_FROM_C,
        ),
        Misconception("order-reversed", lambda a_T_b, a_T_c: a_T_c @ np.linalg.inv(a_T_b), *PRODUCT_REVERSED),
        Misconception(
            "order-reversed;inverse-by-transpose",
            lambda a_T_b, a_T_c: a_T_c @ a_T_b.T,
            *together(PRODUCT_REVERSED, INVERSE_BY_TRANSPOSE),
        ),
        Misconception(
            "wrong-direction;inverse-parts-separately",
            lambda a_T_b, a_T_c: _parts_separately(a_T_c) @ a_T_b,
            *together(B_FROM_C, PARTS_SEPARATELY),
        ),
        Misconception(
            "orientation-not-transformed",
            lambda a_T_b, a_T_c: transform(a_T_c[:3, :3], relative_transform(a_T_b, a_T_c)[:3, 3]),
            "The rotation is still that of C in A.",
            "If B is turned in A, C is turned differently in B than in A.",
        ),
        Misconception(
            "rotation-not-inverted",
            lambda a_T_b, a_T_c: transform(a_T_b[:3, :3] @ a_T_c[:3, :3], relative_transform(a_T_b, a_T_c)[:3, 3]),
            "The two rotations were multiplied, neither of them inverted.",
            "To get from B to C by way of A, one of the two rotations has to be undone.",
        ),
        Misconception(
            "rotation-not-inverted",
            lambda a_T_b, a_T_c: transform(
                a_T_b[:3, :3].T @ a_T_c[:3, :3], a_T_b[:3, :3] @ (a_T_c[:3, 3] - a_T_b[:3, 3])
            ),
            "The translation was turned by B's rotation, which is not inverted.",
            "The arrow from B to C is known along A's axes: which rotation leads from these to B's?",
        ),
        Misconception(
            "euler-angles-subtracted",
            lambda a_T_b, a_T_c: transform(
                from_roll_pitch_yaw(roll_pitch_yaw(a_T_c[:3, :3]) - roll_pitch_yaw(a_T_b[:3, :3])),
                relative_transform(a_T_b, a_T_c)[:3, 3],
            ),
            "Roll, pitch and yaw of the two rotations were subtracted.",
            "Angles may be subtracted when both turns share an axis. What undoes a rotation is its inverse.",
            varies=at_lock(lambda a_T_b, a_T_c: a_T_b, lambda a_T_b, a_T_c: a_T_c, parts=("rotation",)),
        ),
        Misconception(
            "wrong-sign",
            lambda a_T_b, a_T_c: transform(
                a_T_b[:3, :3].T @ a_T_c[:3, :3], a_T_b[:3, :3].T @ (a_T_b[:3, 3] - a_T_c[:3, 3])
            ),
            "The translation points from C to B.",
            "C is described: the arrow goes from B's origin to C's.",
        ),
        Misconception(
            "position-missing",
            lambda a_T_b, a_T_c: transform(relative_transform(a_T_b, a_T_c)[:3, :3], (0, 0, 0)),
            "The translation is missing.",
            "The answer has to say where C's origin is in B.",
        ),
        Misconception(
            "bottom-row-wrong",
            lambda a_T_b, a_T_c: with_bottom_row(relative_transform(a_T_b, a_T_c), np.zeros(4)),
            *BOTTOM_ROW,
        ),
        Misconception(
            "wrong-transform-inverted",
            lambda a_T_b, a_T_c: np.linalg.inv(a_T_b) @ np.linalg.inv(a_T_c),
            "You inverted both transforms.",
            ONE_POINTS_RIGHT,
        ),
        Misconception(
            "transform-left-out",
            lambda a_T_b, a_T_c: np.linalg.inv(a_T_b),
            "C is not in your answer: it is A described in B.",
            "From B to C there are two steps, by way of A: what is the second?",
        ),
        Misconception("inverse-missing", lambda a_T_b, a_T_c: a_T_b @ a_T_c, *BOTH_AS_THEY_ARE),
        Misconception("inverse-missing", lambda a_T_b, a_T_c: a_T_c @ a_T_b, *BOTH_AS_THEY_ARE),
        Misconception(
            "wrong-transform-inverted", lambda a_T_b, a_T_c: a_T_b @ np.linalg.inv(a_T_c), *THE_OTHER_INVERTED
        ),
        *(
            Misconception(
                identifier, lambda a_T_b, a_T_c, inverse=inverse: inverse(a_T_b) @ a_T_c, *of_the_inverse(says)
            )
            for identifier, says, inverse in WRONG_INVERSES
        ),
        Misconception(
            "order-reversed",
            _relative_with(lambda b, c: c @ b.T, _arrow_along_b),
            "The translation is right, but the two rotations were multiplied in the wrong order.",
            MATCH_THE_NAMES,
        ),
        *(
            Misconception("wrong-axis", _relative_with(lambda b, c: b.T @ c, along), *ALONG_OTHER_AXES)
            for along in (
                lambda b, c, arrow: c.T @ arrow,
                lambda b, c, arrow: b.T @ c @ arrow,
                lambda b, c, arrow: (b.T @ c).T @ arrow,
                lambda b, c, arrow: c @ arrow,
            )
        ),
        Misconception(
            "rotation-vectors-subtracted",
            _relative_with(
                lambda b, c: Rotation.from_rotvec(rotation_vector(c) - rotation_vector(b)).as_matrix(), _arrow_along_b
            ),
            "The rotation vectors (axis times angle) of the two rotations were subtracted.",
            "They may be subtracted when both turns share an axis. What undoes a rotation is its inverse.",
            varies=lambda a_T_b, a_T_c: ("rotation",) if any(map(_half_turned, (a_T_b, a_T_c))) else (),
        ),
        Misconception(
            "offset-not-rotated",
            lambda a_T_b, a_T_c: transform(a_T_b[:3, :3].T @ a_T_c[:3, :3], a_T_c[:3, 3] - a_T_b[:3, 3]),
            *NOT_INTO_THE_AXES,
        ),
        *(
            Misconception(
                "subtracted",
                wrong,
                "One matrix was subtracted from the other.",
                "The difference of two rotations is no rotation: look at its columns. What undoes a product?",
            )
            for wrong in (lambda a_T_b, a_T_c: a_T_c - a_T_b, lambda a_T_b, a_T_c: np.eye(4) + a_T_c - a_T_b)
        ),
        Misconception("elementwise-product", lambda a_T_b, a_T_c: np.linalg.inv(a_T_b) * a_T_c, *ENTRY_BY_ENTRY),
        Misconception(
            "wrong-transform-inverted;elementwise-product",
            lambda a_T_b, a_T_c: a_T_b * np.linalg.inv(a_T_c),
            *together(THE_OTHER_INVERTED, ENTRY_BY_ENTRY),
        ),
    ),
)

# --- object_in_gripper ----------------------------------------------------------------------------------------------


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return _apply(np.linalg.inv(base_T_gripper) @ base_T_camera, p_in_camera)


def object_in_gripper_cases(rng):
    along_axes = [transform(R, vector(rng)) for R in signed_permutations()]
    shuffled = [along_axes[index] for index in rng.permutation(24)]
    in_front = np.array([1.0, 0.0, 0.0])
    C, G = transform(tilt(rng), vector(rng)), transform(wide_turn(rng), vector(rng))
    p, R, whole_numbers = vector(rng), rotation(rng), whole_transform()
    families = {
        "an object 1 m in front of the camera": [
            (generic_transform(rng), generic_transform(rng), in_front) for _ in range(3)
        ],
        "camera and gripper turned by quarter turns": [
            (camera, gripper, vector(rng)) for camera, gripper in zip(shuffled[:12], shuffled[12:])
        ],
        "a tilted camera and a tilted gripper": [
            (C, G, p), (C, G, vector(rng)), (C, generic_transform(rng), p),
            (transform(half_turn(rng), vector(rng)), G, p), (G, C, np.zeros(3)), (G, G, p),
            (np.eye(4), G, p), (C, np.eye(4), p),
        ],
        "camera and gripper hardly turned and hardly moved": [
            (with_its_turn(camera, p), with_its_turn(gripper, p), p)
            for camera, gripper in zip(small_transforms(rng), small_transforms(rng))
            for p in [at_right_angles(camera, gripper)]
        ],
        "camera and gripper close to each other": [(G, G @ T, p) for T, p in small_with_points(rng)],
        "the object close to the camera": [(C, generic_transform(rng), p) for p in near(rng)],
        "camera, gripper and object far away": [
            (transform(tilt(rng), vector(rng, 20.0)), transform(tilt(rng), vector(rng, 30.0)), vector(rng, 50.0)),
            *((T, transform(tilt(rng), np.zeros(3)), p) for T, p in seen_from_afar(rng)),
            *((transform(R, p), transform(wide_turn(rng), p + vector(rng)), vector(rng)) for p in far(rng)),
        ],
        "the camera, the gripper or the object in whole numbers": [
            (whole_numbers, G, p), (C, whole_numbers, p), (C, G, np.array([1, -2, 3])),
        ],
    }  # fmt: skip
    return [Case(family, args) for family, lists in families.items() for args in lists]


def _apply(T, p):
    return T[:3, :3] @ p + T[:3, 3]


_inv = np.linalg.inv

FOURTH_NUMBER = (
    "There is a fourth number besides the three coordinates.",
    "The 1 at the end was needed for the multiplication only.",
)
NOT_MOVED = (
    "The point was turned, but not moved: the translations have dropped out.",
    "A fourth number is added to the point. Which one lets the translation in?",
)
ALONG_THE_BASE = (
    "Your answer is an arrow between the gripper and the object, still along the axes of the base.",
    "Seen from the gripper, the same arrow has other components: the gripper's axes are turned.",
)
GRIPPER_NOT_INVERTED = (
    "The gripper's rotation was used as it is, not inverted.",
    "The columns of base_T_gripper's rotation are the gripper's axes: how far does the arrow go along each of them?",
)
OF_THE_GRIPPER = {  # where the answer shows something else of a wrong inverse than in other exercises
    _rotation_kept: GRIPPER_NOT_INVERTED,
    np.transpose: (
        "The point was turned into the gripper's axes, but not counted from the gripper's origin: so it comes out when the whole "
        "4x4 matrix is transposed to invert it.",
        "The gripper's own origin has to come out as 0, 0, 0. And where has the translation gone in a transposed matrix?",
    ),
}
FROM_THE_OBJECT = (
    "The arrow goes from the object to the gripper.",
    "Asked for is where the object is, seen from the gripper: which of the two does the arrow start at?",
)

CAMERA_NOT_TURNED = (
    "The camera's origin was added to the point, as if the camera's axes were parallel to those of the base.",
    "The coordinates count along the camera's axes: how do these lie in the base frame?",
)
CAMERA_NOT_MOVED = (
    "The point was turned into the base's axes, but where the camera stands has dropped out.",
    "Where in the base frame is a point that lies in the camera's origin?",
)
CAMERA_TURNED_BACK = (
    "The camera's rotation was used the opposite way round: transposed.",
    "The columns of base_T_camera's rotation are the camera's axes, written in the base frame.",
)
CAMERA_MOVED_FIRST = (
    "The camera's translation was turned by the camera's own rotation.",
    "The translation is already given along the base's axes: which of the two acts on the point first?",
)

OBJECT_IN_GRIPPER = Exercise(
    name="object_in_gripper",
    returns="coordinates",
    answer="p_in_gripper",
    reference=object_in_gripper,
    cases=object_in_gripper_cases,
    features=(
        *of_transform("base_T_camera"),
        *of_transform("base_T_gripper"),
        *of_two_frames("base_T_camera", "base_T_gripper"),
        *of_vector("p_in_camera"),
    ),
    weights={"a tilted camera and a tilted gripper": 2},
    misconceptions=(
        Misconception("inverse-missing", lambda camera, gripper, p: _apply(gripper @ camera, p), *BOTH_AS_THEY_ARE),
        Misconception("inverse-missing", lambda camera, gripper, p: _apply(camera @ gripper, p), *BOTH_AS_THEY_ARE),
        *(
            Misconception("wrong-transform-inverted", wrong, *THE_OTHER_INVERTED)
            for wrong in (
                lambda camera, gripper, p: _apply(gripper @ _inv(camera), p),
                lambda camera, gripper, p: _apply(_inv(camera) @ gripper, p),
            )
        ),
        *(
            Misconception(
                "wrong-transform-inverted",
                wrong,
                "You inverted both transforms.",
                ONE_POINTS_RIGHT,
            )
            for wrong in (
                lambda camera, gripper, p: _apply(_inv(gripper) @ _inv(camera), p),
                lambda camera, gripper, p: _apply(_inv(camera) @ _inv(gripper), p),
            )
        ),
        Misconception(
            "order-reversed", lambda camera, gripper, p: _apply(camera @ _inv(gripper), p), *PRODUCT_REVERSED
        ),
        *(
            Misconception(
                identifier,
                lambda camera, gripper, p, inverse=inverse: _apply(inverse(gripper) @ camera, p),
                *OF_THE_GRIPPER.get(inverse, of_the_inverse(says)),
            )
            for identifier, says, inverse in WRONG_INVERSES
        ),
        *(
            Misconception(identifier, lambda c, g, p, of=of: _apply(_inv(g), of(c, p)), *says)
            for identifier, says, of in (
                ("offset-not-rotated", CAMERA_NOT_TURNED, lambda camera, p: p + camera[:3, 3]),
                ("translation-dropped", CAMERA_NOT_MOVED, lambda camera, p: camera[:3, :3] @ p),
                ("rotation-transposed", CAMERA_TURNED_BACK, lambda camera, p: camera[:3, :3].T @ p + camera[:3, 3]),
                ("order-reversed", CAMERA_MOVED_FIRST, lambda camera, p: camera[:3, :3] @ (p + camera[:3, 3])),
                ("homogeneous-order", ONE_IN_FRONT, lambda camera, p: (camera @ np.append(1.0, p))[:3]),
            )
        ),
        Misconception(
            "homogeneous-order",
            lambda camera, gripper, p: (_inv(gripper) @ camera @ np.append(1.0, p))[:3],
            *ONE_IN_FRONT,
        ),
        Misconception(
            "homogeneous-returned",
            lambda camera, gripper, p: _inv(gripper) @ camera @ np.append(p, 1.0),
            *FOURTH_NUMBER,
        ),
        Misconception(
            "translation-dropped", lambda camera, gripper, p: (_inv(gripper) @ camera)[:3, :3] @ p, *NOT_MOVED
        ),
        Misconception(
            "transform-left-out",
            lambda camera, gripper, p: _apply(_inv(gripper), p),
            "The camera's transform is not in your product: the point is taken as if it were given in the base frame.",
            "From the camera to the gripper there are two steps: what is the first?",
        ),
        Misconception(
            "transform-left-out",
            lambda camera, gripper, p: _apply(camera, p),
            "Your answer is where the object is in the base frame; the step into the gripper's frame is missing.",
            "From the camera to the gripper there are two steps: what is the second?",
        ),
        Misconception(
            "offset-not-rotated",
            lambda camera, gripper, p: _apply(camera, p) - gripper[:3, 3],
            *ALONG_THE_BASE,
        ),
        Misconception(
            "yaw-only",
            lambda camera, gripper, p: _apply(_yaw_turned_back(gripper), _apply(camera, p)),
            "The way into the gripper's frame is turned about z only, as if the gripper were never tilted.",
            "Use the gripper's whole rotation, not an angle of it.",
        ),
        Misconception(
            "offset-not-rotated;wrong-sign",
            lambda camera, gripper, p: gripper[:3, 3] - _apply(camera, p),
            *together(ALONG_THE_BASE, FROM_THE_OBJECT),
        ),
        Misconception(
            "wrong-sign",
            lambda camera, gripper, p: gripper[:3, :3].T @ (gripper[:3, 3] - _apply(camera, p)),
            *FROM_THE_OBJECT,
        ),
        Misconception(
            "rotation-not-inverted",
            lambda camera, gripper, p: gripper[:3, :3] @ (_apply(camera, p) - gripper[:3, 3]),
            *GRIPPER_NOT_INVERTED,
        ),
        Misconception(
            "rotation-not-inverted;wrong-sign",
            lambda camera, gripper, p: gripper[:3, :3] @ (gripper[:3, 3] - _apply(camera, p)),
            *together(GRIPPER_NOT_INVERTED, FROM_THE_OBJECT),
        ),
        Misconception("integer-truncation", lambda c, g, p: object_in_gripper(c, g, np.trunc(p)), *TRUNCATED),
        Misconception(
            "optical-frame-assumed",
            lambda c, g, p: object_in_gripper(c, g, np.array([p[2], -p[0], -p[1]])),
            "The camera's axes were reordered, as if its z axis pointed forward.",
            "The camera frame of this exercise is no optical frame: nothing has to be reordered.",
        ),
        Misconception(
            "coordinates-ignored",
            lambda c, g, p: object_in_gripper(c, g, np.array([p[0], 0.0, 0.0])),
            "Only the first of the object's coordinates is used.",
            "The object need not be straight in front of the camera.",
        ),
        *(
            Misconception(identifier, wrong, *together(*messages))
            for identifier, wrong, messages in (
                (
                    "translation-dropped;inverse-missing",
                    lambda c, g, p: g[:3, :3] @ c[:3, :3] @ p,
                    (NOT_MOVED, BOTH_AS_THEY_ARE),
                ),
                (
                    "wrong-transform-inverted;translation-dropped",
                    lambda c, g, p: g[:3, :3] @ c[:3, :3].T @ p,
                    (THE_OTHER_INVERTED, NOT_MOVED),
                ),
                (
                    "wrong-transform-inverted;translation-dropped",
                    lambda c, g, p: c[:3, :3].T @ g[:3, :3] @ p,
                    (THE_OTHER_INVERTED, NOT_MOVED),
                ),
                (
                    "order-reversed;inverse-by-transpose",
                    lambda c, g, p: _apply(c @ g.T, p),
                    (PRODUCT_REVERSED, INVERSE_BY_TRANSPOSE),
                ),
                (
                    "homogeneous-returned;inverse-by-transpose",
                    lambda c, g, p: g.T @ c @ np.append(p, 1.0),
                    (FOURTH_NUMBER, INVERSE_BY_TRANSPOSE),
                ),
                (
                    "homogeneous-returned;inverse-parts-separately",
                    lambda c, g, p: _parts_separately(g) @ c @ np.append(p, 1.0),
                    (FOURTH_NUMBER, PARTS_SEPARATELY),
                ),
            )
        ),
        *(
            Misconception("elementwise-product", wrong, *ENTRY_BY_ENTRY)
            for wrong in (
                lambda camera, gripper, p: _inv(gripper) * camera * np.append(p, 1.0),
                lambda camera, gripper, p: _apply(_inv(gripper) * camera, p),
            )
        ),
    ),
)

EXERCISES = (INVERT_TRANSFORM, RELATIVE_TRANSFORM, OBJECT_IN_GRIPPER)
