"""The exercises of notebook 2: homogeneous transforms, poses, and points in another frame."""

import math

import numpy as np
from transform_lab.arithmetic import Rotation
from transform_lab.judging.naming import together

from .cases import (
    almost_half_turns,
    either_sign,
    far,
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
    small_turns,
    small_with_points,
    tilt,
    transform,
    vector,
    whole,
    whole_but_for_rounding,
    whole_pose,
    whole_transform,
    wide_turn,
    with_bottom_row,
    x_axis_upright,
)
from .conversions import (
    BEYOND_120,
    BREAKS_AT_HALF_TURN,
    BY_ANGLES,
    BY_BRANCHES,
    BY_TRACE,
    GIMBAL_LOCK,
    ORDERS,
    angle_not_halved,
    at_gimbal_lock,
    at_half_turns,
    axis_and_angle,
    by_tangents,
    from_euler,
    half_turn_by_tolerance,
    lengths_with_signs,
    near_gimbal_lock,
    near_half_turns,
    plain_angles,
    short_of_half_turns,
    slips,
    trace_formula,
    trace_formula_guarded,
    trace_formula_in_plain_python,
)
from .equivalent import IN_SINGLE_PRECISION, LISTS, MAKING_A_POSE, READING_A_POSE, WHOLE_STAY_WHOLE
from .features import of_orientation, of_pose, of_rotation, of_transform, of_vector, together_small
from .rotation import TRUNCATED
from .specification import Case, Exercise, Misconception

EXAMPLE_1 = transform(rotation_about((0, 0, 1), math.pi / 4), (0, 0, 0.5))  # the lab's: turned by 45 degrees and raised


def many_frames(rng):
    """{family: [(R, p), …]}: rotations of every kind, each with a translation that is not along its axis."""
    R, p = rotation(rng), vector(rng)  # each with two others: a function may not remember one by the other
    return {
        "a frame turned by quarter turns": [(R, vector(rng)) for R in signed_permutations()],
        "a tilted frame": [(R, p), (tilt(rng), p), (R, vector(rng)), (rotation(rng), np.zeros(3))],
        "a frame turned by more than 120 degrees": [(wide_turn(rng, axis), vector(rng)) for axis in range(3)],
        "a half turn about a slanted axis": [
            *((half_turn(rng, axis), vector(rng)) for axis in range(3)), (half_turn_to_rounding(rng), vector(rng)),
        ],
        "almost a half turn, or one almost about an axis of A": [
            (R, vector(rng)) for R in (*almost_half_turns(rng), *half_turns_about_almost_an_axis())
        ],
        "Example 1, and frames hardly turned and hardly moved": [
            (EXAMPLE_1[:3, :3], EXAMPLE_1[:3, 3]), *zip(small_turns(rng), near(rng)),
        ],
        "a frame far away": list(zip((tilt(rng), wide_turn(rng), tilt(rng)), far(rng))),
    }  # fmt: skip


# --- make_transform -------------------------------------------------------------------------------------------------


def make_transform(R, p):
    T = np.eye(4)
    T[:3, :3] = R
    T[:3, 3] = p
    return T


def make_transform_cases(rng):
    R, p = rotation(rng), vector(rng)
    families = {
        "a frame turned by quarter turns": [(R, vector(rng)) for R in signed_permutations()],
        "a tilted frame": [(R, p), (tilt(rng), p), (R, vector(rng)), (wide_turn(rng), np.zeros(3))],
        "a frame hardly turned and hardly moved": list(zip(small_turns(rng), near(rng))),
        "a frame far away": [(rotation(rng), p) for p in far(rng)],
        "rotation or translation in whole numbers": [
            (whole(signed_permutations()[1]), vector(rng)), (rotation(rng), np.array([1, -2, 3])),
            (whole(signed_permutations()[3]), np.array([3, 1, -2])),
        ],
    }  # fmt: skip
    return [Case(family, pair) for family, pairs in families.items() for pair in pairs]


ENTRY_BY_ENTRY = (
    "Your product multiplies entry by entry.",
    "`*` is not the matrix product in NumPy. Which operator is?",
)
BOTTOM_ROW = (
    "The bottom row of your matrix is not that of a homogeneous transform.",
    "Which four numbers does it always hold?",
)
TRANSLATION_BELOW = (
    "The translation stands in the bottom row.",
    "The translation vector is a column. In which corner of the matrix does it stand?",
)
ROWS_FOR_COLUMNS = (
    "The rotation is transposed: B's axes stand in its rows.",
    "The columns of the rotation matrix are B's axes, written in A.",
)
NO_TRANSLATION = (
    "The translation is missing.",
    "Where is B's origin in A? The transform has to say so.",
)
NO_ROTATION = (
    "The rotation is the identity.",
    "B's axes need not be parallel to A's: where does the rotation go?",
)
TRANSLATION_TURNED = (
    "The translation was turned by the rotation: the two are combined in the wrong order.",
    "The translation is B's origin, already written in A; nothing needs to be done to it.",
)
INVERSE_RETURNED = (
    "Your answer is the inverse: it describes frame A in terms of frame B.",
    "Read the names again: in a_T_b, frame B is described, and frame A is the one it is described in.",
)
TRANSLATION_NEGATED = (
    "The translation has the opposite sign.",
    "The translation is where B's origin is in A, seen from A's origin.",
)

PARTLY_COPIED = (
    "Not all numbers of the rotation have got into the matrix: only those of a turn about z.",
    "How many rows and columns does a rotation in space have? Look at the slice that you copy into.",
)
SUM_OF_BOTH = (
    "The matrices of rotation and translation were added.",
    "Which product of two matrices applies first one and then the other?",
)
NOT_ALL_OF_THE_POSITION = (
    "The translation is not p: one of its numbers is missing, or in another place.",
    "Check each component by itself: x, y and z, from top to bottom.",
)
INVERSE_TRANSLATION = (
    "The translation is that of the inverse: A's origin, seen from B.",
    "The translation is B's origin, already written in A; nothing needs to be done to it.",
)


def _turned_about_z_only(R):
    kept = np.eye(3)
    kept[:2, :2] = R[:2, :2]
    return kept


MAKE_TRANSFORM = Exercise(
    name="make_transform",
    returns="transform",
    answer="a_T_b",
    reference=make_transform,
    cases=make_transform_cases,
    features=(*of_rotation("R"), *of_vector("p"), together_small("R", "p")),
    equivalent=IN_SINGLE_PRECISION,
    credit={"rotation": 0.4, "translation": 0.4},
    weights={"a tilted frame": 2},
    misconceptions=(
        Misconception("translation-in-bottom-row", lambda R, p: make_transform(R.T, p).T, *TRANSLATION_BELOW),
        Misconception("rotation-transposed", lambda R, p: make_transform(R.T, p), *ROWS_FOR_COLUMNS),
        Misconception("position-missing", lambda R, p: make_transform(R, (0, 0, 0)), *NO_TRANSLATION),
        Misconception("orientation-identity", lambda R, p: make_transform(np.eye(3), p), *NO_ROTATION),
        *(
            Misconception(
                "bottom-row-wrong", lambda R, p, row=row: with_bottom_row(make_transform(R, p), row), *BOTTOM_ROW
            )
            for row in ((0, 0, 0, 0), (1, 1, 1, 1), (1, 0, 0, 0))
        ),
        Misconception("order-reversed", lambda R, p: make_transform(R, R @ p), *TRANSLATION_TURNED),
        Misconception(
            "order-reversed;rotation-transposed",
            lambda R, p: make_transform(R.T, R.T @ p),
            *together(TRANSLATION_TURNED, ROWS_FOR_COLUMNS),
        ),
        Misconception("integer-truncation", lambda R, p: np.trunc(make_transform(R, p)), *TRUNCATED),
        Misconception("wrong-direction", lambda R, p: np.linalg.inv(make_transform(R, p)), *INVERSE_RETURNED),
        Misconception("wrong-sign", lambda R, p: make_transform(R, -p), *TRANSLATION_NEGATED),
        Misconception("wrong-direction", lambda R, p: make_transform(R, -R.T @ p), *INVERSE_TRANSLATION),
        Misconception("yaw-only", lambda R, p: make_transform(_turned_about_z_only(R), p), *PARTLY_COPIED),
        *(
            Misconception("wrong-position", lambda R, p, of=of: make_transform(R, of(p)), *NOT_ALL_OF_THE_POSITION)
            for of in (
                *(lambda p, kept=kept: p * kept for kept in ([1, 1, 0], [1, 0, 1], [0, 1, 1])),
                *(lambda p, order=order: p[order] for order in ([2, 1, 0], [0, 2, 1], [1, 0, 2])),
            )
        ),
        Misconception(
            "added-not-multiplied",
            lambda R, p: make_transform(R, (0, 0, 0)) + make_transform(np.eye(3), p),
            *SUM_OF_BOTH,
        ),
        Misconception(
            "elementwise-product",
            lambda R, p: make_transform(R, (0, 0, 0)) * make_transform(np.eye(3), p),
            *ENTRY_BY_ENTRY,
        ),
        Misconception(
            "wrong-shape",
            lambda R, p: make_transform(R, p)[:3],
            "You returned a 3x4 matrix: rotation and translation are right, the bottom row is missing.",
            "A homogeneous transform has four rows; the last one always holds the same four numbers.",
        ),
        Misconception(
            "wrong-shape",
            lambda R, p: R,
            "You returned the 3x3 rotation alone.",
            "A homogeneous transform has four rows and four columns, and a place for the translation.",
        ),
    ),
)

# --- hand_transform -------------------------------------------------------------------------------------------------


def hand_transform():
    return np.array(
        [
            [1.0, 0.0, 0.0, -0.1],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def _hand(R=None, p=(-0.1, 0, 0)):
    """The answer of someone who has another rotation, or another translation, and the rest right."""
    return lambda: transform(hand_transform()[:3, :3] if R is None else R, p)


WRONG_LENGTH = (
    "The hand moved in the right direction, but not by the right distance.",
    "The task says centimetres; lengths in a transform are metres.",
)
MOVED_ELSEWHERE = (
    "The hand moved along another axis than the one that points away from you.",
    "Which finger points forward in the first pose, and which axis is it? Closer to you is along that axis.",
)
ROLLED_ABOUT_ANOTHER_AXIS = (
    "The hand turned about another axis than the index finger.",
    "Rolling leaves the index finger where it is: which column of the rotation must not change?",
)
LEFT_HANDED = (
    "Your frame is left-handed: a mirror image of one that a right hand can take, as when one axis points the opposite way.",
    "Hold up your right hand again: once two fingers are placed, the third has no choice.",
)

HAND_TRANSFORM = Exercise(
    name="hand_transform",
    returns="transform",
    answer="a_T_b",
    reference=hand_transform,
    cases=lambda rng: [Case("your hand, rolled to the left and moved closer")],
    credit={"rotation": 0.4, "translation": 0.4},
    equivalent={
        LISTS: (
            "hand_transform: np.array([[1.0, 0.0, 0.0, -0.1], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], "
            "[0.0, 0.0, 0.0, 1.0]]) -> [[1.0, 0.0, 0.0, -0.1], [0.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 0.0], "
            "[0.0, 0.0, 0.0, 1.0]]",
            "hand_transform: np.array([[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]) -> "
            "[[1, 0, 0, -0.1], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]]",
        )
    },
    misconceptions=(
        Misconception(
            "rotation-transposed",
            _hand(hand_transform()[:3, :3].T),
            "Your hand is rolled the other way; the rotation is transposed.",
            "Where does your thumb point after the roll? Its direction in the first pose is a column, not a row.",
        ),
        *(Misconception("wrong-units", _hand(p=(length, 0, 0)), *WRONG_LENGTH) for length in (-10, -0.01, -1, -100)),
        Misconception(
            "wrong-sign",
            _hand(p=(0.1, 0, 0)),
            "The hand moved away from you instead of closer.",
            "The index finger points forward, along +x. Which sign does a move towards you have?",
        ),
        *(
            Misconception("wrong-axis", _hand(p=p), *MOVED_ELSEWHERE)
            for p in ((0, -0.1, 0), (0, 0, -0.1), (0, 0.1, 0), (0, 0, 0.1))
        ),
        *(
            Misconception("wrong-axis", _hand(rotation_about(axis, angle).round()), *ROLLED_ABOUT_ANOTHER_AXIS)
            for axis in ((0, 1, 0), (0, 0, 1))
            for angle in (math.pi / 2, -math.pi / 2)
        ),
        Misconception("position-missing", _hand(p=(0, 0, 0)), *NO_TRANSLATION),
        Misconception("orientation-identity", _hand(np.eye(3)), *NO_ROTATION),
        *(Misconception("left-handed", _hand(-R), *LEFT_HANDED) for R in signed_permutations()),  # all mirror images
        Misconception(
            "degrees-as-radians",
            _hand(rotation_about((1, 0, 0), -90.0)),
            "A quarter turn was taken as 90 radians.",
            "NumPy's and Python's sine and cosine expect radians; and a quarter turn needs neither.",
        ),
        Misconception(
            "translation-in-bottom-row",
            lambda: with_bottom_row(_hand(p=(0, 0, 0))(), (-0.1, 0, 0, 1)),
            *TRANSLATION_BELOW,
        ),
        Misconception("bottom-row-wrong", lambda: with_bottom_row(hand_transform(), (0, 0, 0, 0)), *BOTTOM_ROW),
        Misconception(
            "wrong-direction",
            lambda: np.linalg.inv(hand_transform()),
            "Your answer is the inverse: the first pose in terms of the new one.",
            "The new pose is frame B, the one described; the first pose is frame A, the one it is described in.",
        ),
    ),
)

# --- transform_to_pose ----------------------------------------------------------------------------------------------


def transform_to_pose(matrix):
    return pose(matrix[:3, :3], matrix[:3, 3])


def transform_to_pose_cases(rng):
    whole_numbers = Case("a frame turned by quarter turns", (whole_transform(),))
    cases = [Case(family, (transform(R, p),)) for family, frames in many_frames(rng).items() for R, p in frames]
    return [whole_numbers, *cases]


def _to_pose_with(position=None, orientation=None):
    """`transform_to_pose` of someone who computes the position, or the quaternion, in another way."""

    def wrong(matrix):
        p = matrix[:3, 3] if position is None else position(matrix)
        q = quaternion(matrix[:3, :3]) if orientation is None else orientation(matrix)
        return pose_of(p, q)

    return wrong


_transposed = _to_pose_with(orientation=lambda matrix: quaternion(matrix[:3, :3].T))


def open_where(varies, fails, matrix_of, parts=("orientation",)):
    """The fields `varies` and `fails` of a misconception about these parts: two functions of a rotation, which is the upper
    left of `matrix_of` the arguments.
    """
    return {
        name: lambda *args, where=where, **kwargs: parts if where(matrix_of(*args, **kwargs)[:3, :3]) else ()
        for name, where in (("varies", varies), ("fails", fails))
    }


def at_lock(*matrices_of, parts=("orientation",)):
    """The field `varies` of who takes angles of matrices, each of them a function of the arguments: at gimbal lock roll and yaw
    are what one makes of them.
    """
    return lambda *args: parts if any(x_axis_upright(matrix_of(*args)) for matrix_of in matrices_of) else ()


def _read_as(order, matrix):
    """The quaternion's four numbers in another order."""
    return quaternion(matrix[:3, :3])[order]


def _yaw_alone(matrix):
    return Rotation.from_euler("z", math.atan2(matrix[1, 0], matrix[0, 0])).as_quat()


QUATERNION_ORDER = (
    "The four numbers of the quaternion are in another order than ROS's.",
    "Which comes first in `tf.transformations`, and which last: is w at the front or at the end?",
)
QUATERNION_TURNED = (
    "The orientation is the opposite turn: the rotation was transposed, or the quaternion conjugated.",
    "Check it with Example 1: for a turn by +45 degrees about z, which sign has z when w is positive?",
)
NO_ORIENTATION = (
    "The orientation was never set: it is 0, 0, 0, 0, which is no orientation at all.",
    "A fresh Quaternion() holds four zeros; where does the rotation of the frame go?",
)
ORIENTATION_IDENTITY = (
    "The orientation is 0, 0, 0, 1, which means no rotation.",
    "B's axes need not be parallel to A's: where does the rotation of the frame go?",
)
ANGLES_AS_QUATERNION = (
    "The orientation's x, y and z hold roll, pitch and yaw.",
    "A quaternion's components are not angles; look for a function that makes one from a matrix.",
)
POSITION_LEFT_OUT = (
    "The position is 0, 0, 0.",
    "Where in the matrix does the translation stand? Look at the row and the column you read it from.",
)
YAW_ALONE = (
    "Your orientation turns about z only; roll and pitch are lost.",
    "Frames can be tilted. Use the whole rotation, not an angle of it.",
)
WHOLE_ANGLE = (
    "The quaternion turns by twice the angle.",
    "A quaternion is made of sine and cosine of an angle: is it the whole angle of the rotation?",
)
HALF_THE_ANGLE = (
    "The rotation turns by half the angle.",
    "A quaternion holds sine and cosine of half an angle: how large is the whole one?",
)
WRONG_POSITION = (
    "The position is not B's origin in A.",
    "Check each component by itself: which row and which column of the matrix should it come from?",
)

TRANSFORM_TO_POSE = Exercise(
    name="transform_to_pose",
    returns="pose",
    answer="a_T_b",
    reference=transform_to_pose,
    cases=transform_to_pose_cases,
    features=(*of_transform("matrix"), *of_orientation("matrix")),
    credit={"position": 0.5, "orientation": 0.5},
    weights={"a tilted frame": 2},
    equivalent=MAKING_A_POSE | IN_SINGLE_PRECISION,
    misconceptions=(
        *(
            Misconception(
                "quaternion-order",
                _to_pose_with(orientation=lambda matrix, order=order: quaternion(matrix[:3, :3])[order]),
                *QUATERNION_ORDER,
            )
            for order in ORDERS
        ),
        Misconception(
            "rotation-transposed",
            _transposed,
            *QUATERNION_TURNED,
        ),
        *(
            Misconception(
                "quaternion-order;rotation-transposed",
                _to_pose_with(orientation=lambda matrix, order=order: _read_as(order, matrix.T)),
                *together(QUATERNION_ORDER, QUATERNION_TURNED),
            )
            for order in ORDERS
        ),
        *(
            Misconception(
                "quaternion-order;wrong-direction",
                _to_pose_with(
                    position=lambda matrix: np.linalg.inv(matrix)[:3, 3],
                    orientation=lambda matrix, order=order: _read_as(order, matrix.T),
                ),
                *together(QUATERNION_ORDER, INVERSE_RETURNED),
            )
            for order in ORDERS
        ),
        *(
            Misconception(
                identifier, _to_pose_with(orientation=wrong), *says, **open_where(varies, fails, lambda matrix: matrix)
            )
            for identifier, says, wrong, varies, fails in (BY_TRACE, BEYOND_120, BY_ANGLES, *BY_BRANCHES)
        ),
        Misconception(
            "trace-formula-only;rotation-transposed",
            _to_pose_with(orientation=lambda matrix: trace_formula_guarded(matrix.T)),
            *together(BREAKS_AT_HALF_TURN, QUATERNION_TURNED),
            **open_where(*BY_TRACE[-2:], lambda matrix: matrix),
        ),
        Misconception(
            "wrong-sign",
            _to_pose_with(orientation=lengths_with_signs(lambda sizes, differences: sizes)),
            "The quaternion's x, y and z are never negative.",
            "A square root gives the size of a number; where do the signs come from?",
        ),
        *(
            Misconception(
                "wrong-units",
                _to_pose_with(position=lambda matrix, factor=factor: factor * matrix[:3, 3]),
                "The position is in other units than metres.",
                "Lengths in a transform and in a Pose are metres: nothing needs to be converted.",
            )
            for factor in (100, 1000, 0.01, 0.001)
        ),
        Misconception(
            "degrees-as-radians",
            _to_pose_with(orientation=lambda matrix: from_euler(np.degrees(roll_pitch_yaw(matrix[:3, :3])))),
            "Angles in degrees were taken for radians on the way to the quaternion.",
            "Functions of angles expect radians; a function that goes from matrix to quaternion needs no angles.",
            varies=at_lock(lambda matrix: matrix),
        ),
        Misconception(
            "euler-order",
            _to_pose_with(orientation=lambda matrix: from_euler(roll_pitch_yaw(matrix[:3, :3]), "XYZ")),
            "Roll, pitch and yaw were put together in another order than they were taken apart.",
            "Fixed axes and moving axes are two orders; a function from matrix to quaternion needs neither.",
            varies=at_lock(lambda matrix: matrix),
        ),
        *(
            Misconception(
                "trace-formula-only",
                _to_pose_with(orientation=orientation),
                *BREAKS_AT_HALF_TURN,
                **open_where(short_of_half_turns, lambda R: False, lambda matrix: matrix),
            )
            for orientation in (trace_formula, trace_formula_in_plain_python, axis_and_angle)
        ),
        *(
            Misconception("trace-formula-only", _to_pose_with(orientation=orientation), *BREAKS_AT_HALF_TURN)
            for orientation in (
                half_turn_by_tolerance,
                lengths_with_signs(np.copysign),
                lengths_with_signs(lambda sizes, differences: sizes * np.sign(differences)),
            )
        ),
        Misconception("position-missing", _to_pose_with(position=lambda matrix: (0, 0, 0)), *POSITION_LEFT_OUT),
        Misconception("orientation-missing", _to_pose_with(orientation=lambda matrix: (0, 0, 0, 0)), *NO_ORIENTATION),
        Misconception(
            "orientation-identity", _to_pose_with(orientation=lambda matrix: (0, 0, 0, 1)), *ORIENTATION_IDENTITY
        ),
        *(
            Misconception("wrong-position", _to_pose_with(position=position), *WRONG_POSITION)
            for position in (
                lambda matrix: matrix[:3, 3] + matrix[:3, 0],  # the tip of the x axis
                lambda matrix: (0, 0, matrix[2, 3]),  # z alone
                lambda matrix: matrix[[0, 1, 0], 3],  # x, y, x
                lambda matrix: matrix[[2, 1, 0], 3],  # back to front
                lambda matrix: matrix[[0, 2, 1], 3],  # y and z swapped
                lambda matrix: matrix[[1, 0, 2], 3],  # x and y swapped
                lambda matrix: np.diag(matrix)[:3],
                lambda matrix: np.linalg.inv(matrix)[:3, 3],
                lambda matrix: matrix[:3, 2],  # the column beside it
                lambda matrix: matrix[:3, :3] @ matrix[:3, 3],
            )
        ),
        Misconception("wrong-direction", lambda matrix: transform_to_pose(np.linalg.inv(matrix)), *INVERSE_RETURNED),
        *(
            Misconception(
                "euler-as-quaternion",
                _to_pose_with(orientation=lambda matrix, w=w: np.append(roll_pitch_yaw(matrix[:3, :3]), w)),
                *ANGLES_AS_QUATERNION,
            )
            for w in (0.0, 1.0)
        ),
        *(
            Misconception("yaw-only", _to_pose_with(orientation=orientation), *YAW_ALONE)
            for orientation in (_yaw_alone, lambda matrix: from_euler([0.0, 0.0, roll_pitch_yaw(matrix[:3, :3])[2]]))
        ),
        Misconception(
            "yaw-only;angle-not-halved",
            _to_pose_with(orientation=lambda matrix: (0, 0, matrix[1, 0], matrix[0, 0])),
            *together(YAW_ALONE, WHOLE_ANGLE),
        ),
        Misconception(
            "angle-not-halved",
            _to_pose_with(orientation=angle_not_halved),
            *WHOLE_ANGLE,
        ),
    ),
)

# --- pose_to_transform ----------------------------------------------------------------------------------------------


def pose_to_transform(pose):
    return matrix(pose)


def pose_to_transform_cases(rng):
    cases = [
        Case(family, (frame,))
        for family, frames in many_frames(rng).items()
        for frame in either_sign([pose(R, p) for R, p in frames])
    ]
    simple = whole_pose(), *no_turn(vector(rng))
    return [*(Case("a frame turned by quarter turns", (frame,)) for frame in simple), *cases]


def _from_pose_with(rotation):
    """`pose_to_transform` of someone who makes the rotation in another way, from x, y, z, w."""
    return lambda pose: make_transform(rotation(orientation(pose)), position(pose))


def _by_angles(angles_of, axes):
    """From x, y, z, w to the rotation matrix, by way of three angles."""
    return lambda q: Rotation.from_euler(axes, angles_of(Rotation.from_quat(q).as_matrix())).as_matrix()


def _turned(pose):
    """The rotation alone, as a 4x4 matrix."""
    return make_transform(pose_to_transform(pose)[:3, :3], (0, 0, 0))


def _planar(q):
    return Rotation.from_euler("z", 2.0 * math.atan2(q[2], q[3])).as_matrix()


def _from_pose_with_translation(of):
    """`pose_to_transform` of someone whose rotation is right, and whose translation is `of(R, position)`."""
    return lambda pose: make_transform(matrix(pose)[:3, :3], of(matrix(pose)[:3, :3], position(pose)))


ONE_ENTRY = (
    "One number of the rotation is wrong: a sign or a term of the formula from quaternion to matrix.",
    "Which column of your matrix is not of length 1, or not at right angles to the others? It holds the slip.",
)

POSE_TO_TRANSFORM = Exercise(
    name="pose_to_transform",
    returns="transform",
    answer="a_T_b",
    reference=pose_to_transform,
    cases=pose_to_transform_cases,
    features=(*of_pose("pose"), *of_orientation("pose")),
    credit={"rotation": 0.4, "translation": 0.4},
    weights={"a tilted frame": 2},
    equivalent=READING_A_POSE | IN_SINGLE_PRECISION | {WHOLE_STAY_WHOLE: ("the answer in the type of pose",)},
    misconceptions=(
        *(
            Misconception(
                "quaternion-order",
                _from_pose_with(lambda q, order=order: Rotation.from_quat(q[order]).as_matrix()),
                *QUATERNION_ORDER,
            )
            for order in ORDERS
        ),
        Misconception(
            "rotation-transposed",
            _from_pose_with(lambda q: Rotation.from_quat(q).as_matrix().T),
            "The rotation is the opposite turn: it is transposed, or made from the conjugate quaternion.",
            "Check it with a turn by +90 degrees about z: where does B's x axis, the first column, point in A?",
        ),
        Misconception(
            "position-missing",
            lambda pose: make_transform(pose_to_transform(pose)[:3, :3], (0, 0, 0)),
            "The translation is missing.",
            "The pose also says where B's origin is in A: where does that go in the matrix?",
        ),
        Misconception("orientation-identity", _from_pose_with(lambda q: np.eye(3)), *NO_ROTATION),
        Misconception(
            "translation-in-bottom-row",
            lambda pose: make_transform(pose_to_transform(pose)[:3, :3].T, position(pose)).T,
            *TRANSLATION_BELOW,
        ),
        *(
            Misconception(
                "bottom-row-wrong", lambda pose, row=row: with_bottom_row(pose_to_transform(pose), row), *BOTTOM_ROW
            )
            for row in ((0, 0, 0, 0), (1, 1, 1, 1))
        ),
        Misconception(
            "order-reversed",
            lambda pose: _turned(pose) @ _from_pose_with(lambda q: np.eye(3))(pose),
            *TRANSLATION_TURNED,
        ),
        Misconception(
            "integer-truncation",
            lambda pose: np.trunc(pose_to_transform(pose)),
            *TRUNCATED,
            varies=lambda pose: ("rotation", "translation") if whole_but_for_rounding(matrix(pose)[:3, :3]) else (),
        ),
        Misconception(
            "elementwise-product",
            lambda pose: _turned(pose) * _from_pose_with(lambda q: np.eye(3))(pose),
            *ENTRY_BY_ENTRY,
        ),
        Misconception(
            "added-not-multiplied",
            lambda pose: _turned(pose) + _from_pose_with(lambda q: np.eye(3))(pose),
            *SUM_OF_BOTH,
        ),
        Misconception("wrong-direction", lambda pose: np.linalg.inv(pose_to_transform(pose)), *INVERSE_RETURNED),
        Misconception(
            "wrong-sign",
            lambda pose: make_transform(pose_to_transform(pose)[:3, :3], -position(pose)),
            *TRANSLATION_NEGATED,
        ),
        Misconception(
            "euler-as-quaternion",
            _from_pose_with(lambda q: Rotation.from_euler("xyz", q[:3]).as_matrix()),
            "The quaternion's x, y and z were taken for roll, pitch and yaw.",
            "A quaternion's components are not angles; look for a function that makes a matrix from a quaternion.",
        ),
        Misconception("yaw-only", _from_pose_with(_planar), *YAW_ALONE),
        Misconception(
            "euler-order",
            _from_pose_with(_by_angles(roll_pitch_yaw, "XYZ")),
            "Roll, pitch and yaw were put together in another order than they were taken apart.",
            "Fixed axes and moving axes are two orders; a function from quaternion to matrix needs neither.",
            varies=at_lock(matrix, parts=("rotation",)),
        ),
        Misconception(
            "gimbal-lock",
            _from_pose_with(_by_angles(plain_angles, "xyz")),
            *GIMBAL_LOCK,
            **open_where(near_gimbal_lock, at_gimbal_lock, matrix, ("rotation",)),
        ),
        Misconception(
            "angle-not-halved",
            _from_pose_with(lambda q: Rotation.from_rotvec(Rotation.from_quat(q).as_rotvec() / 2.0).as_matrix()),
            *HALF_THE_ANGLE,
        ),
        Misconception(
            "yaw-only;angle-not-halved",
            _from_pose_with(lambda q: np.array([[q[3], -q[2], 0], [q[2], q[3], 0], [0, 0, 1]])),
            *together(YAW_ALONE, HALF_THE_ANGLE),
        ),
        *(
            Misconception(
                "quaternion-order;rotation-transposed",
                _from_pose_with(lambda q, order=order: Rotation.from_quat(q[order]).as_matrix().T),
                *together(QUATERNION_ORDER, QUATERNION_TURNED),
            )
            for order in ORDERS
        ),
        *(
            Misconception(
                "order-reversed;quaternion-order",
                lambda pose, order=order: (
                    _turned(pose_of((0, 0, 0), orientation(pose)[order])) @ _from_pose_with(lambda q: np.eye(3))(pose)
                ),
                *together(TRANSLATION_TURNED, QUATERNION_ORDER),
            )
            for order in ORDERS
        ),
        *(
            Misconception(
                "wrong-position",
                lambda pose, order=order: make_transform(pose_to_transform(pose)[:3, :3], position(pose)[order]),
                "The translation is not the pose's position.",
                "Check each component by itself: x, y and z, from top to bottom.",
            )
            for order in ([0, 1, 0], [2, 1, 0], [0, 2, 1], [1, 0, 2])
        ),
        *(Misconception("formula-slip", _from_pose_with(of), *ONE_ENTRY) for of in slips(0, 1, 2)),
        Misconception(
            "half-turn-missed",
            _from_pose_with(by_tangents),
            "The rotation goes wrong at half turns, where w is 0.",
            "Your formula divides by w: which of the quaternion's numbers can be 0? The usual one divides by none of them.",
            **open_where(near_half_turns, at_half_turns, matrix, ("rotation",)),
        ),
        Misconception("wrong-direction", _from_pose_with_translation(lambda R, p: -R.T @ p), *INVERSE_TRANSLATION),
        Misconception(
            "sign-ignored",
            _from_pose_with(lambda q: Rotation.from_quat([*q[:3], abs(q[3])]).as_matrix()),
            "The rotation goes wrong when w is negative.",
            "Changing the sign of w alone gives another orientation; what happens if all four signs change?",
        ),
    ),
)

# --- transform_point ------------------------------------------------------------------------------------------------


def transform_point(a_T_b, p_in_b):
    return a_T_b[:3, :3] @ p_in_b + a_T_b[:3, 3]


def transform_point_cases(rng):
    x_axis, y_axis, z_axis = np.eye(3)
    T, p = transform(wide_turn(rng), vector(rng)), vector(rng)
    families = {
        "a frame turned by quarter turns": [(transform(R, vector(rng)), vector(rng)) for R in signed_permutations()],
        "a tilted frame": [
            (T, p), (transform(tilt(rng), vector(rng)), p), (T, vector(rng)),
            (transform(half_turn(rng), np.zeros(3)), vector(rng)), (np.eye(4), vector(rng)),
        ],
        "Example 1, and the tips of B's other axes": [
            (EXAMPLE_1, x_axis),
            (transform(rotation(rng), vector(rng)), y_axis),
            (transform(tilt(rng), vector(rng)), z_axis),
        ],
        "a frame hardly turned and hardly moved": small_with_points(rng),
        "a point near B's origin, or in it": [
            (transform(tilt(rng), vector(rng)), np.zeros(3)), *((transform(rotation(rng), vector(rng)), p) for p in near(rng)),
        ],
        "a frame far away, a point far away, or both": [
            *seen_from_afar(rng), *((transform(tilt(rng), p), vector(rng)) for p in far(rng)),
            *((transform(wide_turn(rng), vector(rng)), p) for p in far(rng)),
        ],
        "frame or point in whole numbers": [
            (whole_transform(), vector(rng)),
            (transform(rotation(rng), vector(rng)), np.array([1, -2, 3])),
        ],
    }  # fmt: skip
    return [Case(family, pair) for family, pairs in families.items() for pair in pairs]


def _turned_in_the_plane(a_T_b, p_in_b):
    in_plane = a_T_b[:2, :2] @ p_in_b[:2]
    return np.append(in_plane, p_in_b[2]) + a_T_b[:3, 3]


def _homogeneous(p):
    return np.append(p, 1.0)


FROM_A_TO_B = (
    "You took the point from A to B; asked for is from B to A.",
    "Which frame are the given coordinates in, and which frame does a_T_b lead to?",
)
POINT_TURNED_BACK = (
    "The point was turned the opposite way: the rotation is transposed.",
    "Check it with the tip of B's x axis: where is it in A, according to the first column?",
)
MOVED_BACK = (
    "The point was moved the opposite way.",
    "Where does B's own origin, the point 0, 0, 0, have to come out?",
)
AXES_TAKEN_AS_PARALLEL = (
    "The translation was added to the point's coordinates in B, as if B's axes were parallel to A's.",
    "The coordinates count along B's axes: how do these lie in A?",
)
IN_THE_WRONG_ORDER = (
    "Rotation and translation were applied in the wrong order, or the matrix from the wrong side.",
    "A matrix stands to the left of the point it transforms; and which of the two acts on the point first?",
)

ONE_IN_FRONT = (
    "The fourth number stands in front of the point's coordinates instead of behind them.",
    "Which column of a_T_b is the translation? The 1 has to meet it.",
)


def _overwriting(a_T_b, p_in_b):
    p = np.array(p_in_b, dtype=float)
    for row in range(3):
        p[row] = a_T_b[row, :3] @ p + a_T_b[row, 3]
    return p


TRANSFORM_POINT = Exercise(
    name="transform_point",
    returns="coordinates",
    answer="p_in_a",
    reference=transform_point,
    cases=transform_point_cases,
    features=(*of_transform("a_T_b"), *of_vector("p_in_b")),
    weights={"a tilted frame": 2},
    misconceptions=(
        Misconception(
            "rotation-transposed",
            lambda a_T_b, p_in_b: a_T_b[:3, :3].T @ p_in_b + a_T_b[:3, 3],
            *POINT_TURNED_BACK,
        ),
        Misconception(
            "rotation-transposed;wrong-sign",
            lambda a_T_b, p_in_b: a_T_b[:3, :3].T @ p_in_b - a_T_b[:3, 3],
            *together(POINT_TURNED_BACK, MOVED_BACK),
        ),
        Misconception(
            "offset-not-rotated;wrong-sign",
            lambda a_T_b, p_in_b: p_in_b - a_T_b[:3, 3],
            *together(AXES_TAKEN_AS_PARALLEL, MOVED_BACK),
        ),
        Misconception(
            "yaw-only",
            _turned_in_the_plane,
            "The point was turned about z only.",
            "Frames can be tilted: all three coordinates of the point take part in the turn.",
        ),
        Misconception(
            "translation-dropped",
            lambda a_T_b, p_in_b: a_T_b[:3, :3] @ p_in_b,
            "The point was turned, but not moved: the translation has dropped out.",
            "A fourth number is added to the point. Which one lets the translation in?",
        ),
        Misconception(
            "offset-not-rotated",
            lambda a_T_b, p_in_b: p_in_b + a_T_b[:3, 3],
            *AXES_TAKEN_AS_PARALLEL,
        ),
        Misconception(
            "wrong-direction",
            lambda a_T_b, p_in_b: transform_point(np.linalg.inv(a_T_b), p_in_b),
            *FROM_A_TO_B,
        ),
        Misconception(
            "homogeneous-returned",
            lambda a_T_b, p_in_b: a_T_b @ _homogeneous(p_in_b),
            "The three coordinates are right, but a fourth number is still there.",
            "The 1 at the end was needed for the multiplication only.",
        ),
        *(
            Misconception("elementwise-product", wrong, *ENTRY_BY_ENTRY)
            for wrong in (
                lambda a_T_b, p_in_b: a_T_b * _homogeneous(p_in_b),
                lambda a_T_b, p_in_b: (a_T_b * _homogeneous(p_in_b))[:3],
                lambda a_T_b, p_in_b: np.sum(a_T_b * _homogeneous(p_in_b), axis=0)[:3],
                lambda a_T_b, p_in_b: a_T_b[:3, :3] * p_in_b + a_T_b[:3, 3],
                lambda a_T_b, p_in_b: np.diag(a_T_b)[:3] * p_in_b + a_T_b[:3, 3],
                lambda a_T_b, p_in_b: np.diag(a_T_b)[:3] * p_in_b,
                lambda a_T_b, p_in_b: np.sum(a_T_b[:3, :3] * p_in_b, axis=0) + a_T_b[:3, 3],
            )
        ),
        *(
            Misconception("order-reversed", wrong, *IN_THE_WRONG_ORDER)
            for wrong in (
                lambda a_T_b, p_in_b: (_homogeneous(p_in_b) @ a_T_b)[:3],
                lambda a_T_b, p_in_b: a_T_b[:3, :3] @ (p_in_b + a_T_b[:3, 3]),
            )
        ),
        Misconception(
            "wrong-sign",
            lambda a_T_b, p_in_b: a_T_b[:3, :3] @ p_in_b - a_T_b[:3, 3],
            *MOVED_BACK,
        ),
        *(
            Misconception("homogeneous-order", wrong, *ONE_IN_FRONT)
            for wrong in (
                lambda a_T_b, p_in_b: (a_T_b @ np.append(1, p_in_b))[:3],
                lambda a_T_b, p_in_b: (a_T_b @ np.append(1, p_in_b))[1:],
            )
        ),
        Misconception(
            "homogeneous-order",
            lambda a_T_b, p_in_b: (a_T_b @ np.append(p_in_b, p_in_b[0]))[:3],
            "The fourth number is one of the point's coordinates.",
            "Which fourth number lets the translation in, once and as it is?",
        ),
        Misconception(
            "updated-too-early",
            _overwriting,
            "A coordinate is overwritten before the others have been worked out with it.",
            "Keep the point as it was until all three new coordinates are known.",
        ),
        Misconception(
            "zero-taken-for-missing",
            lambda a_T_b, p_in_b: transform_point(a_T_b, p_in_b) if np.any(p_in_b) else np.zeros(3),
            "The point 0, 0, 0 stays 0, 0, 0.",
            "That is B's own origin: where is it in A?",
        ),
        Misconception(
            "order-reversed;wrong-sign",
            lambda a_T_b, p_in_b: a_T_b[:3, :3] @ (p_in_b - a_T_b[:3, 3]),
            *together(IN_THE_WRONG_ORDER, MOVED_BACK),
        ),
        *(
            Misconception(
                "applied-twice",
                wrong,
                "The rotation or the translation is in the answer twice.",
                "How many steps are there from B to A?",
            )
            for wrong in (
                lambda a_T_b, p_in_b: transform_point(a_T_b, p_in_b) + a_T_b[:3, 3],
                lambda a_T_b, p_in_b: transform_point(a_T_b, transform_point(a_T_b, p_in_b)),
                lambda a_T_b, p_in_b: a_T_b[:3, :3] @ a_T_b[:3, :3] @ p_in_b + a_T_b[:3, 3],
            )
        ),
        Misconception(
            "rest-ignored",
            lambda a_T_b, p_in_b: a_T_b[:3, 3],
            "You returned B's origin in A, wherever the point is.",
            "The answer has to depend on the point too: start at B's origin and go along B's axes.",
        ),
    ),
)

EXERCISES = (MAKE_TRANSFORM, HAND_TRANSFORM, TRANSFORM_TO_POSE, POSE_TO_TRANSFORM, TRANSFORM_POINT)
