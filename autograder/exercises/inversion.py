"""The exercises of notebook 4: the inverse of a transform, and what it is good for."""

import numpy as np

from .cases import (
    generic_transform,
    half_turn,
    rotation,
    rotation_about,
    signed_permutations,
    slanted_axis,
    tilt,
    transform,
    vector,
    wide_turn,
)
from .homogeneous_transforms import ENTRY_BY_ENTRY
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
ROTATION_NOT_INVERTED = (
    "The inverse still turns the same way as the transform itself.",
    "If B is turned to the left in A, how is A turned in B?",
)

# --- invert_transform -----------------------------------------------------------------------------------------------


def invert_transform(a_T_b):
    return np.linalg.inv(a_T_b)


def invert_transform_cases(rng):
    families = {
        "a frame turned by quarter turns": [transform(R, vector(rng)) for R in signed_permutations()],
        "a tilted frame": [generic_transform(rng), generic_transform(rng), transform(half_turn(rng), vector(rng))],
        "a frame turned by more than 120 degrees": [transform(wide_turn(rng), vector(rng)) for _ in range(2)],
        "a frame turned by a fraction of a degree": [
            transform(rotation_about(slanted_axis(rng), angle), vector(rng)) for angle in (1e-2, 1e-3)
        ],
        "a frame far away": [transform(tilt(rng), vector(rng, length)) for length in (50.0, 20.0)],
    }
    return [Case(family, (T,)) for family, transforms in families.items() for T in transforms]


INVERT_TRANSFORM = Exercise(
    name="invert_transform",
    returns="transform",
    answer="b_T_a",
    reference=invert_transform,
    cases=invert_transform_cases,
    credit={"rotation": 0.3, "translation": 0.5},
    weights={"a tilted frame": 2},
    misconceptions=(
        Misconception("inverse-by-transpose", np.transpose, *INVERSE_BY_TRANSPOSE),
        Misconception("inverse-parts-separately", _parts_separately, *PARTS_SEPARATELY),
        Misconception("rotation-not-inverted", _rotation_kept, *ROTATION_NOT_INVERTED),
        Misconception(
            "rotation-not-inverted",
            _inverse_with(lambda R, p: R, lambda R, p: -R.T @ p),
            "The rotation is still that of B in A.",
            "If B is turned to the left in A, how is A turned in B?",
        ),
        Misconception(
            "rotation-not-inverted",
            _inverse_with(lambda R, p: R.T, lambda R, p: -R @ p),
            "The translation was turned by the rotation that is not inverted.",
            "A's origin has to be given along B's axes: which of the two rotations leads from A to B?",
        ),
        Misconception(
            "inverse-missing",
            lambda a_T_b: a_T_b,
            "Your answer is the transform itself, not its inverse.",
            "What does your function have to undo?",
        ),
        Misconception(
            "wrong-sign",
            _inverse_with(lambda R, p: R.T, lambda R, p: R.T @ p),
            "The translation has the right length and the opposite sign.",
            "If B's origin is in front of A, A's origin is behind B (when both look the same way).",
        ),
        Misconception(
            "wrong-sign",
            lambda a_T_b: -a_T_b,
            "You changed the sign of the whole matrix.",
            "A transform times its inverse gives the identity; a number's negative undoes a sum, not a product.",
        ),
        Misconception(
            "translation-not-inverted",
            _inverse_with(lambda R, p: R.T, lambda R, p: p),
            "The translation is still B's origin in A.",
            "The inverse has to say where A's origin is in B.",
        ),
        Misconception(
            "position-missing",
            _inverse_with(lambda R, p: R.T, lambda R, p: (0, 0, 0)),
            "The translation is missing.",
            "The inverse has to say where A's origin is in B.",
        ),
        Misconception(
            "elementwise-inverse",
            lambda a_T_b: a_T_b**-1,
            "Every entry was inverted by itself, and 1/0 is infinite.",
            "`**` works entry by entry in NumPy. Look among the functions of `np.linalg`.",
        ),
    ),
)

# --- relative_transform ---------------------------------------------------------------------------------------------


def relative_transform(a_T_b, a_T_c):
    return np.linalg.inv(a_T_b) @ a_T_c


def relative_transform_cases(rng):
    along_axes = [transform(R, vector(rng)) for R in signed_permutations()]
    shuffled = [along_axes[index] for index in rng.permutation(24)]
    R = rotation(rng)
    families = {
        "frames turned by quarter turns": list(zip(shuffled[:12], shuffled[12:])),
        "two tilted frames": [(generic_transform(rng), generic_transform(rng)) for _ in range(4)],
        "two frames turned by more than 120 degrees": [
            (transform(wide_turn(rng), vector(rng)), transform(wide_turn(rng), vector(rng))),
            (transform(half_turn(rng), vector(rng)), transform(wide_turn(rng), vector(rng))),
        ],
        "two frames that are close to each other and far from A": [
            (transform(R, far), transform(R @ tilt(rng), far + vector(rng, 0.1)))
            for far in (vector(rng, 20.0), vector(rng, 50.0))
        ],
    }
    return [Case(family, pair) for family, pairs in families.items() for pair in pairs]


BOTH_AS_THEY_ARE = (
    "Neither of the two transforms was inverted.",
    "Write the frames' names under your product: next to each other, the same frame has to stand twice.",
)
THE_OTHER_INVERTED = (
    "You inverted one transform, but not the one that points the wrong way.",
    "Write the frames' names under your product: which of the two transforms has to be turned round?",
)
PRODUCT_REVERSED = (
    "The right transform was inverted, but the product is in the wrong order.",
    "Write the frames' names under your product: next to each other, the same frame has to stand twice.",
)
NOT_INTO_THE_AXES = (
    "The translation is the difference of the two origins, still along A's axes.",
    "Seen from B, the same arrow has other components: B's axes are turned.",
)

RELATIVE_TRANSFORM = Exercise(
    name="relative_transform",
    returns="transform",
    answer="b_T_c",
    reference=relative_transform,
    cases=relative_transform_cases,
    credit={"rotation": 0.4, "translation": 0.4},
    weights={"two tilted frames": 2},
    misconceptions=(
        Misconception(
            "wrong-direction",
            lambda a_T_b, a_T_c: relative_transform(a_T_c, a_T_b),
            "Your answer is the inverse: it describes B in terms of C.",
            "Read the name b_T_c again: which frame is described, and which one is it described in?",
        ),
        Misconception("order-reversed", lambda a_T_b, a_T_c: a_T_c @ np.linalg.inv(a_T_b), *PRODUCT_REVERSED),
        Misconception("inverse-missing", lambda a_T_b, a_T_c: a_T_b @ a_T_c, *BOTH_AS_THEY_ARE),
        Misconception("inverse-missing", lambda a_T_b, a_T_c: a_T_c @ a_T_b, *BOTH_AS_THEY_ARE),
        Misconception(
            "wrong-transform-inverted", lambda a_T_b, a_T_c: a_T_b @ np.linalg.inv(a_T_c), *THE_OTHER_INVERTED
        ),
        Misconception("inverse-by-transpose", lambda a_T_b, a_T_c: a_T_b.T @ a_T_c, *INVERSE_BY_TRANSPOSE),
        Misconception(
            "inverse-parts-separately", lambda a_T_b, a_T_c: _parts_separately(a_T_b) @ a_T_c, *PARTS_SEPARATELY
        ),
        Misconception(
            "rotation-not-inverted", lambda a_T_b, a_T_c: _rotation_kept(a_T_b) @ a_T_c, *ROTATION_NOT_INVERTED
        ),
        Misconception(
            "offset-not-rotated",
            lambda a_T_b, a_T_c: transform(a_T_b[:3, :3].T @ a_T_c[:3, :3], a_T_c[:3, 3] - a_T_b[:3, 3]),
            *NOT_INTO_THE_AXES,
        ),
        Misconception(
            "subtracted",
            lambda a_T_b, a_T_c: a_T_c - a_T_b,
            "One matrix was subtracted from the other.",
            "The difference of two transforms is no transform: look at its bottom row. What undoes a product?",
        ),
        Misconception("elementwise-product", lambda a_T_b, a_T_c: np.linalg.inv(a_T_b) * a_T_c, *ENTRY_BY_ENTRY),
    ),
)

# --- object_in_gripper ----------------------------------------------------------------------------------------------


def object_in_gripper(base_T_camera, base_T_gripper, p_in_camera):
    return _apply(np.linalg.inv(base_T_gripper) @ base_T_camera, p_in_camera)


def object_in_gripper_cases(rng):
    along_axes = [transform(R, vector(rng)) for R in signed_permutations()]
    shuffled = [along_axes[index] for index in rng.permutation(24)]
    in_front = np.array([1.0, 0.0, 0.0])
    families = {
        "an object 1 m in front of the camera": [
            (generic_transform(rng), generic_transform(rng), in_front) for _ in range(3)
        ],
        "camera and gripper turned by quarter turns": [
            (camera, gripper, vector(rng)) for camera, gripper in zip(shuffled[:12], shuffled[12:])
        ],
        "a tilted camera and a tilted gripper": [
            (transform(tilt(rng), vector(rng)), transform(wide_turn(rng), vector(rng)), vector(rng)),
            (transform(half_turn(rng), vector(rng)), transform(tilt(rng), vector(rng)), vector(rng)),
            (generic_transform(rng), generic_transform(rng), vector(rng)),
        ],
        "camera, gripper and object far away": [
            (transform(tilt(rng), vector(rng, 20.0)), transform(tilt(rng), vector(rng, 30.0)), vector(rng, 50.0)),
            (transform(wide_turn(rng), vector(rng, 50.0)), transform(tilt(rng), vector(rng, 50.0)), vector(rng, 0.05)),
        ],
    }
    return [Case(family, args) for family, lists in families.items() for args in lists]


def _apply(T, p):
    return T[:3, :3] @ p + T[:3, 3]


_inv = np.linalg.inv

OBJECT_IN_GRIPPER = Exercise(
    name="object_in_gripper",
    returns="coordinates",
    answer="p_in_gripper",
    reference=object_in_gripper,
    cases=object_in_gripper_cases,
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
                "Write the frames' names under your product: which of the two transforms points the right way already?",
            )
            for wrong in (
                lambda camera, gripper, p: _apply(_inv(gripper) @ _inv(camera), p),
                lambda camera, gripper, p: _apply(_inv(camera) @ _inv(gripper), p),
            )
        ),
        Misconception(
            "order-reversed", lambda camera, gripper, p: _apply(camera @ _inv(gripper), p), *PRODUCT_REVERSED
        ),
        Misconception(
            "inverse-by-transpose", lambda camera, gripper, p: _apply(gripper.T @ camera, p), *INVERSE_BY_TRANSPOSE
        ),
        Misconception(
            "inverse-parts-separately",
            lambda camera, gripper, p: _apply(_parts_separately(gripper) @ camera, p),
            *PARTS_SEPARATELY,
        ),
        Misconception(
            "rotation-not-inverted",
            lambda camera, gripper, p: _apply(_rotation_kept(gripper) @ camera, p),
            *ROTATION_NOT_INVERTED,
        ),
        Misconception(
            "homogeneous-returned",
            lambda camera, gripper, p: _inv(gripper) @ camera @ np.append(p, 1.0),
            "The three coordinates are right, but a fourth number is still there.",
            "The 1 at the end was needed for the multiplication only.",
        ),
        Misconception(
            "translation-dropped",
            lambda camera, gripper, p: (_inv(gripper) @ camera)[:3, :3] @ p,
            "The point was turned into the gripper's axes, but not moved: the translations have dropped out.",
            "The lab adds a fourth number to the point. Which one lets the translation in?",
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
            "Your answer is the arrow from the gripper to the object, still along the axes of the base.",
            "Seen from the gripper, the same arrow has other components: the gripper's axes are turned.",
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
