"""The exercises of notebook 1: rotation matrices, and the two quaternions of one orientation."""

import itertools
import math

import numpy as np
from transform_lab.arithmetic import Rotation, turn, turned
from transform_lab.judging.kinds import TOLERANCE
from transform_lab.judging.naming import together

from .cases import (
    SMALL,
    half_turn,
    nudged,
    quaternion,
    rotation,
    rotation_about,
    signed_permutations,
    size,
    slanted_axis,
    small_turns,
    tilt,
    transform,
    whole,
)
from .equivalent import IN_SINGLE_PRECISION, LISTS, MINUS_TRUE, NEAR_TOLERANCE, NUMPYS_NUMBERS, NUMPYS_TRUTH, SAME_SIZE
from .features import DEGREES, SIGNS, Feature, of_axes, of_differences, of_number, type_of
from .specification import Case, Exercise, Misconception

# --- rotation_about_z -----------------------------------------------------------------------------------------------


def rotation_about_z(degrees):
    return turn((0.0, 0.0, np.radians(degrees)))


def about_z_cases(rng):
    small = [math.degrees(size(rng, decade)) for decade in range(-6, -2)]  # which is what the sine is in radians
    families = {
        "a quarter, half or three-quarter turn": [90, 180, 270.0, -90, 0],
        "a positive angle below 90 degrees": [30, 45.0, 60, rng.uniform(2, 6), rng.uniform(10, 85)],
        "a negative angle": [-30, -45.0, -rng.uniform(50, 85), -rng.uniform(95, 175)],
        "an angle between 90 and 360 degrees": [120, 210.0, rng.uniform(95, 175), rng.uniform(275, 355)],
        "more than a full turn": [
            405, -750.0, rng.uniform(370, 440), _between_singles(rng.uniform(7400, 7460)), -rng.uniform(6130, 6200),
        ],
        "a fraction of a degree": [0.5, -0.25, rng.uniform(0.01, 0.1), *(sign * angle for sign in (1, -1) for angle in small)],
        "a quarter turn, or a fraction of a degree more": [90, -90.0, *(90 + angle for angle in small)],
    }  # fmt: skip
    return [Case(family, (angle,)) for family, angles in families.items() for angle in angles]


def _between_singles(angle):
    """The number halfway between two neighbours in single precision that is nearest to an angle: who rounds to one is off."""
    single = np.float32(angle)
    return (float(single) + float(np.nextafter(single, np.float32(np.inf)))) / 2.0


def _z_axis_lost(degrees):
    R = rotation_about_z(degrees)
    R[2, 2] = 0.0
    return R


IN_RADIANS = (
    "The angle was taken as radians, but it is given in degrees.",
    "NumPy's and Python's sine and cosine expect radians.",
)
THE_OTHER_WAY_ROUND = (
    "Your frame turns the other way round: a sign is wrong, B's axes stand in the rows of your matrix, or a library's function "
    "gives the matrix of the way back, `b_R_a`.",
    "For a small positive angle, where does B's x axis point in A? That is the first column.",
)
TRUNCATED = (
    "Digits after the decimal point are cut off.",
    "An array made of whole numbers cuts off what is written into it, and `int` does the same: "
    "`np.array([1.0])` keeps fractions, `np.array([1])` does not.",
)
ABOUT_ANOTHER_AXIS = (
    "Your matrix turns about another axis than z.",
    "The axis of a rotation stays where it is: which column of your matrix should be the z axis, unchanged?",
)
BOTH_SINES_ALIKE = (
    "Both sines in your matrix have the same sign, so it is no rotation any more.",
    "Draw B's x axis and y axis, turned by a small angle: which one component of the two axes is negative?",
)
NOT_IN_RADIANS = (
    "The angle was not turned into radians correctly.",
    "By what do you multiply 180 degrees to get half a turn in radians? Try your conversion on 180 and on 90.",
)

SINE_FROM_COSINE = (
    "The sine has the wrong sign for some angles: a cosine does not tell on which side of the x axis B's x axis lies.",
    "What are sine and cosine of 30, of -30 and of 330 degrees? A square root cannot tell them apart.",
)
WHOLE_DEGREES = (
    "The angle is rounded to whole degrees.",
    "Half a degree is an angle, too: try your function on 0.5.",
)
PI_ROUNDED = (
    "The angle is a little wrong: \u03c0 was rounded.",
    "How many digits of \u03c0 does NumPy know?",
)
SMALL_ANGLES = (
    "The sine of the angle is taken for the angle itself, and its cosine for 1.",
    "That is nearly so for small angles only, and not to 1e-6 for half a degree: sine and cosine cost nothing.",
)
FOLDED = (
    "The angle is brought into another range first, and some angles come out as others.",
    "After how many degrees is the frame the same again? Try your function on -30, 200 and 400.",
)


def _with_sine(of):
    """`rotation_about_z` of someone whose sine is `of(angle, cosine)`, the angle in degrees."""

    def wrong(degrees):
        cosine = math.cos(math.radians(degrees))
        sine = of(degrees, cosine)
        return np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])

    return wrong


def _root(cosine):
    return math.sqrt(max(0.0, 1.0 - cosine**2))


def _straight(degrees):
    angle = math.radians(degrees)
    return np.array([[1.0, -angle, 0.0], [angle, 1.0, 0.0], [0.0, 0.0, 1.0]])


ABOUT_Z = Exercise(
    name="rotation_about_z",
    returns="rotation",
    answer="a_R_b",
    reference=rotation_about_z,
    cases=about_z_cases,
    features=of_number("degrees", DEGREES),
    equivalent={
        LISTS: (
            "rotation_about_z: np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) -> [[c, -s, 0], [s, c, 0], [0, 0, 1]]",
        ),
        "a cosine does not know the angle's sign": ("notebook: rotation_about_z: degrees -> -degrees",),
    },
    misconceptions=(
        Misconception(
            "degrees-as-radians",
            lambda degrees: Rotation.from_euler("z", degrees).as_matrix(),
            *IN_RADIANS,
        ),
        Misconception(
            "degrees-as-radians;rotation-transposed",
            lambda degrees: Rotation.from_euler("z", -degrees).as_matrix(),
            *together(IN_RADIANS, THE_OTHER_WAY_ROUND),
        ),
        Misconception("integer-truncation", lambda degrees: rotation_about_z(int(degrees)), *TRUNCATED),
        Misconception(
            "integer-truncation",
            lambda degrees: (
                np.trunc(rotation_about_z(degrees)) * [[1, 1, 0], [1, 1, 0], [0, 0, 0]] + np.diag([0, 0, 1])
            ),
            *TRUNCATED,
            varies=lambda degrees: ("rotation",) if degrees % 90 == 0 else (),  # a sine of 1, or a little less and so 0
        ),
        Misconception(
            "integer-truncation;rotation-transposed",
            lambda degrees: rotation_about_z(-int(degrees)),
            *together(TRUNCATED, THE_OTHER_WAY_ROUND),
        ),
        *(
            Misconception(
                "wrong-units",
                lambda degrees, factor=factor: Rotation.from_euler("z", degrees * factor).as_matrix(),
                *NOT_IN_RADIANS,
            )
            for factor in (180 / math.pi, 1 / 180, 2 * math.pi / 180, math.pi / 360, 2 * math.pi, math.pi / 200)
        ),
        Misconception(
            "rotation-transposed",
            lambda degrees: rotation_about_z(-degrees),
            *THE_OTHER_WAY_ROUND,
        ),
        *(
            Misconception(
                "wrong-axis",
                lambda degrees, axis=axis: Rotation.from_euler(axis, degrees, degrees=True).as_matrix(),
                *ABOUT_ANOTHER_AXIS,
            )
            for axis in "xy"
        ),
        *(
            Misconception("wrong-sign", lambda degrees, s=sign: rotation_about_z(degrees) * s, *BOTH_SINES_ALIKE)
            for sign in (
                np.array([[1, -1, 1], [1, 1, 1], [1, 1, 1]]),  # both sines positive
                np.array([[1, 1, 1], [-1, 1, 1], [1, 1, 1]]),  # both negative
            )
        ),
        Misconception(
            "wrong-sign",
            lambda degrees: rotation_about_z(degrees) * np.array([[1, -1, 1], [1, -1, 1], [1, 1, 1]]),
            "B's y axis points the opposite way: your matrix is a mirror image.",
            "In a right-handed frame, a quarter turn from x to y goes the same way as a positive angle about z.",
        ),
        *(
            Misconception("sine-from-cosine", _with_sine(of), *SINE_FROM_COSINE)
            for of in (
                lambda degrees, cosine: _root(cosine),
                lambda degrees, cosine: math.copysign(_root(cosine), degrees),
                lambda degrees, cosine: -_root(cosine) if degrees > 180 else _root(cosine),
            )
        ),
        *(
            Misconception(
                "pi-rounded",
                lambda degrees, pi=pi: Rotation.from_euler("z", degrees / 180 * pi).as_matrix(),
                *PI_ROUNDED,
            )
            for pi in (3.0, 3.1, 3.14, 3.141, 3.1415, 3.142, 3.1416, 3.14159, 22 / 7)
        ),
        *(
            Misconception(
                "whole-degrees", lambda degrees, whole=whole: rotation_about_z(whole(degrees)), *WHOLE_DEGREES
            )
            for whole in (round, math.floor, math.ceil, lambda degrees: math.floor(degrees + 0.5))
        ),
        *(
            Misconception(
                "small-angle-approximation",
                lambda degrees, most=most: _straight(degrees) if abs(degrees) < most else rotation_about_z(degrees),
                *SMALL_ANGLES,
            )
            for most in (math.degrees(0.01), 1.0, 2.0, 5.0, 6.0, 10.0, 15.0, math.inf)
        ),
        *(
            Misconception("angle-folded", lambda degrees, into=into: rotation_about_z(into(degrees)), *FOLDED)
            for into in (
                abs,
                lambda degrees: degrees % 180,
                lambda degrees: degrees % 90,
                lambda degrees: max(-180, min(180, degrees)),
                lambda degrees: max(-360, min(360, degrees)),
                lambda degrees: max(0, min(360, degrees)),
            )
        ),
        Misconception(
            "unit-guessed",
            lambda degrees: Rotation.from_euler("z", degrees, degrees=abs(degrees) > 2 * math.pi).as_matrix(),
            "Small angles are taken as radians.",
            "The docstring says which unit the angle has: it does not hang on its size.",
        ),
        Misconception(
            "elementwise-product",
            lambda degrees: (
                _with_sine(lambda angle, cosine: math.sin(math.radians(angle)))(degrees)
                + (1.0 - math.cos(math.radians(degrees))) * np.array([[1, 1, 0], [1, 1, 0], [0, 0, 0]])
            ),
            "A matrix was squared entry by entry.",
            "`**` and `*` work entry by entry in NumPy. Which operator is the matrix product?",
        ),
        Misconception(
            "sine-cosine-swapped",
            lambda degrees: rotation_about_z(90 - degrees),
            "Sine and cosine have changed places.",
            "For an angle of 0 the answer has to be the identity: which of the two is 1 there?",
        ),
        Misconception(
            "third-axis-missing",
            _z_axis_lost,
            "The third column of your matrix is empty, but B has a z axis.",
            "Where does B's z axis point in A while B turns about z?",
        ),
        Misconception(
            "homogeneous-returned",
            lambda degrees: transform(rotation_about_z(degrees), (0, 0, 0)),
            "You returned a 4x4 transform; asked for is the rotation alone.",
            "A rotation matrix has one column for each axis of B, and one row for each axis of A.",
        ),
        Misconception(
            "wrong-shape",
            lambda degrees: rotation_about_z(degrees)[:2, :2],
            "You returned a 2x2 matrix: the rotation in the plane is right, the z axis is missing.",
            "B's z axis needs a column too, and every axis has a z component in A.",
        ),
    ),
)

# --- rotation_from_axes ---------------------------------------------------------------------------------------------


def rotation_from_axes(x_axis, y_axis):
    return np.column_stack((x_axis, y_axis, np.cross(x_axis, y_axis)))


def from_axes_cases(rng):
    upside_down = np.diag([1.0, -1.0, -1.0])
    families = {
        "a frame turned by quarter turns": signed_permutations(),
        "a frame turned about one axis of A": [
            rotation_about(axis, sign * rng.uniform(0.3, 1.3)) for axis in np.eye(3) for sign in (1, -1)
        ],
        "a tilted frame": [tilt(rng), rotation(rng), upside_down @ tilt(rng), half_turn(rng), rotation(rng)],
        "a frame turned by a fraction of a degree": small_turns(rng),
    }
    cases = [Case(family, (R[:, 0], R[:, 1])) for family, matrices in families.items() for R in matrices]
    (x, y, z), angle = np.eye(3), rng.uniform(0.3, 1.3)
    slanted = np.cos(angle) * y + np.sin(angle) * z
    return [
        *cases,
        *(Case("one axis given in whole numbers", args) for args in ((whole(x), slanted), (slanted, whole(x)))),
        Case("one axis given in whole numbers", (whole(-z), whole(x))),
    ]


def _axes_with(third):
    """The frame with its z axis as `third(x_axis, y_axis)` has it."""
    return lambda x_axis, y_axis: np.column_stack((x_axis, y_axis, third(x_axis, y_axis)))


AXES_IN_ROWS = (
    "B's axes stand in the rows of your matrix.",
    "The matrix describes B in A: each axis of B, written in A, is one of its columns.",
)
THIRD_AXIS_OPPOSITE = (
    "Your z axis points the opposite way, which makes a left-handed frame.",
    "Point your right index finger along x and your middle finger along y; the thumb shows z. "
    "The order of a cross product matters.",
)
THIRD_AXIS_BY_ENTRIES = (
    "Your z axis is the product of x and y component by component.",
    "`*` multiplies entry by entry. Which product of two vectors is at right angles to both?",
)

ONE_COMPONENT = (
    "One of the three numbers of your z axis is wrong.",
    "In a cross product each number is a difference of two products, and the letters go round: y z, z x, x y.",
)
NEVER_NEGATIVE = (
    "The numbers of your z axis are never negative, as roots or sizes are.",
    "A square root gives the size of a number; where do the signs come from?",
)
ALWAYS_UP = (
    "Your z axis never points down, which makes some frames left-handed.",
    "B can lie on its side, or upside down: once x and y are given, z has no choice.",
)


def _one_component(index, of):
    """A cross product in which one number is `of(first product, second product)`."""

    def wrong(x, y):
        z, j, k = np.cross(x, y), (index + 1) % 3, (index + 2) % 3
        z = z.astype(float)
        z[index] = of(x[j] * y[k], x[k] * y[j])
        return z

    return _axes_with(wrong)


FROM_AXES = Exercise(
    name="rotation_from_axes",
    returns="rotation",
    answer="a_R_b",
    reference=rotation_from_axes,
    cases=from_axes_cases,
    features=of_axes("x_axis", "y_axis"),
    equivalent=IN_SINGLE_PRECISION,
    misconceptions=(
        Misconception(
            "rotation-transposed",
            lambda x_axis, y_axis: rotation_from_axes(x_axis, y_axis).T,
            *AXES_IN_ROWS,
        ),
        Misconception("left-handed", _axes_with(lambda x, y: np.cross(y, x)), *THIRD_AXIS_OPPOSITE),
        Misconception(
            "left-handed;rotation-transposed",
            lambda x_axis, y_axis: np.array([x_axis, y_axis, np.cross(y_axis, x_axis)]),
            *together(THIRD_AXIS_OPPOSITE, AXES_IN_ROWS),
        ),
        Misconception(
            "elementwise-product;rotation-transposed",
            lambda x_axis, y_axis: np.array([x_axis, y_axis, x_axis * y_axis]),
            *together(THIRD_AXIS_BY_ENTRIES, AXES_IN_ROWS),
        ),
        *(
            Misconception("cross-product-slip", _one_component(index, of), *ONE_COMPONENT)
            for index in range(3)
            for of in (lambda a, b: b - a, lambda a, b: a + b)
        ),
        Misconception("wrong-sign", _axes_with(lambda x, y: np.abs(np.cross(x, y))), *NEVER_NEGATIVE),
        Misconception(
            "third-axis-upright",
            _axes_with(lambda x, y: np.cross(x, y) * np.sign(np.cross(x, y)[2])),
            *ALWAYS_UP,
            varies=lambda x_axis, y_axis: ("rotation",) if abs(np.cross(x_axis, y_axis)[2]) < 1e-9 else (),
        ),
        Misconception(
            "axes-swapped",
            lambda x_axis, y_axis: np.column_stack((y_axis, x_axis, np.cross(y_axis, x_axis))),
            "You took x for y, and y for x.",
            "In which order are the two axes given, and in which columns do they belong?",
        ),
        Misconception(
            "third-axis-assumed",
            _axes_with(lambda x, y: (0.0, 0.0, 1.0)),
            "Your B always has A's z axis, as if B only ever turned about z.",
            "B can be tilted: its z axis follows from the two axes you are given.",
        ),
        Misconception(
            "third-axis-missing",
            _axes_with(lambda x, y: (0.0, 0.0, 0.0)),
            "The third column of your matrix is empty.",
            "Two axes of a right-handed frame determine the third: which direction is at right angles to both?",
        ),
        Misconception(
            "elementwise-product",
            _axes_with(lambda x, y: x * y),
            *THIRD_AXIS_BY_ENTRIES,
        ),
        Misconception(
            "added-not-multiplied",
            _axes_with(lambda x, y: x + y),
            "Your z axis is the sum of x and y, which lies in their plane.",
            "The z axis stands at right angles to both x and y: which product of two vectors does that?",
        ),
        *(
            Misconception(
                "axes-swapped",
                lambda x_axis, y_axis, order=order: rotation_from_axes(x_axis, y_axis)[:, order],
                "The three axes of B are right, but their columns are in another order.",
                "Which axis of B is the first column, which the second, which the third?",
            )
            for order in ([1, 0, 2], [2, 0, 1], [1, 2, 0], [0, 2, 1], [2, 1, 0])
        ),
        Misconception(
            "homogeneous-returned",
            lambda x_axis, y_axis: transform(rotation_from_axes(x_axis, y_axis), (0, 0, 0)),
            "You returned a 4x4 transform; asked for is the rotation alone.",
            "A rotation matrix has one column for each axis of B, and one row for each axis of A.",
        ),
        Misconception(
            "wrong-shape",
            lambda x_axis, y_axis: np.column_stack((x_axis, y_axis)),
            "You returned a 3x2 matrix: x and y are right, the z axis is missing.",
            "Two axes of a right-handed frame determine the third: which direction is at right angles to both?",
        ),
        Misconception(
            "wrong-shape",
            lambda x_axis, y_axis: np.concatenate((x_axis, y_axis, np.cross(x_axis, y_axis))),
            "You returned nine numbers in a row: the axes are right, but they are no matrix yet.",
            "Look for a NumPy function that puts vectors side by side as columns, and print the answer's `.shape`.",
        ),
    ),
)

# --- is_rotation ----------------------------------------------------------------------------------------------------


def _close(one, other, tolerance=TOLERANCE):
    return bool(np.all(np.abs(np.asarray(one) - np.asarray(other)) <= tolerance))


CLOSE = {  # mutants of _close that are right, too
    NUMPYS_NUMBERS: ("_close: np.asarray(one) -> one", "_close: np.asarray(other) -> other"),
    NUMPYS_TRUTH: (
        "_close: bool(np.all(np.abs(np.asarray(one) - np.asarray(other)) <= tolerance)) -> "
        "np.all(np.abs(np.asarray(one) - np.asarray(other)) <= tolerance)",
    ),
    SAME_SIZE: ("_close: np.asarray(one) - np.asarray(other) -> np.asarray(other) - np.asarray(one)",),
    NEAR_TOLERANCE: (
        "_close: np.abs(np.asarray(one) - np.asarray(other)) <= tolerance -> "
        "np.abs(np.asarray(one) - np.asarray(other)) < tolerance",
    ),
}


def is_rotation(R):
    return _close(R.T @ R, np.eye(3)) and np.linalg.det(R) > 0


SLIGHT = 1.5e-7  # a relative change that every way to compare with 1e-6 lets pass, and none with 1e-7
TOO_FAR = 4e-6  # one that none lets pass, and every one with 1e-5


def products_off(R):
    """By how much the products of R's columns (with themselves, with each other) are off; and whether R is right-handed."""
    return [(R.T @ R - np.eye(3))[np.triu_indices(3)]], np.linalg.det(R) > 0


def is_rotation_cases(rng):
    """Each family sets rotations against matrices that look like them, so that no one answer is right in a family.

    The last ones break one property at a time, by as little as the tolerance allows to ask for, and in ways that are felt to
    second order in all the others.
    """

    def turned():
        return _rounded(rotation(rng), 2e-11)

    def tilted():
        return _rounded(tilt(rng), -2e-11)

    along_axes = signed_permutations()
    mirror_normal = slanted_axis(rng)
    mirror = np.eye(3) - 2.0 * np.outer(mirror_normal, mirror_normal)
    shear, stretch, mild = np.eye(3), np.diag([2.0, 0.5, 1.0]), np.diag([1.25, 1.0, 0.8])
    shear[0, 1] = 0.5
    leaning = shear / np.linalg.norm(shear, axis=0)  # unit columns, of which the first two are not at right angles
    two_lean = [rotation(rng) @ leaning[:, order] for order in ([0, 1, 2], [2, 0, 1], [1, 2, 0])]
    one_long = [rotation(rng) @ np.diag(np.roll([1.01, 1.0, 1.0], shift)) for shift in range(3)]
    changed = [half_turn(rng) for _ in range(3)]  # no entry of these is near zero, so any change shows
    for R in changed:
        R[rng.integers(3), rng.integers(3)] += 1e-3

    bases = itertools.cycle([turned(), along_axes[rng.integers(24)], half_turn(rng), tilted()])

    def some():
        return next(bases)

    decades = TOO_FAR * 10.0 ** np.arange(4)
    families = {
        "a rotation, or a mirror image of one": [
            turned(), np.eye(3), half_turn(rng), whole(along_axes[rng.integers(24)]),
            turned() @ np.diag([1.0, 1.0, -1.0]), -np.eye(3), mirror @ turned() * (1.0 - 1e-9),
            whole(-along_axes[rng.integers(24)]),
        ],
        "a rotation, or one with two of its columns swapped": [
            np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), turned().T,
            np.eye(3)[:, [1, 0, 2]], turned()[:, [0, 2, 1]],
        ],
        "a rotation, or axes that are not at right angles": [
            turned(), tilted(), shear, turned() @ shear, leaning.T @ turned(), *two_lean,
            *(along_axes[rng.integers(24)] @ _all_lean(size) for size in (0.5, -0.3)),
        ],
        "a rotation, or one stretched along one axis and squeezed along another": [
            turned(), along_axes[rng.integers(24)], stretch, stretch @ turned(), turned() @ mild,
            *(some() @ _stretched(first, size, -size) for first, size in zip((0, 1, 2, 0), decades)),
        ],
        "a rotation, or one made larger or smaller, as a whole or along one axis": [
            turned(), tilted(), 2.0 * turned(), 0.5 * turned(), 1.01 * turned(), np.zeros((3, 3)),
            *one_long,
        ],
        "a rotation with rounding errors of 1e-9, or one with a number that is off by 0.001": [
            _rounded(rotation(rng), 8e-10), _rounded(tilt(rng), -8e-10), _rounded(half_turn(rng), 8e-10), *changed,
        ],
        "an axis whose length is off by less than 1e-6, or by more": [
            *(some() @ _stretched(axis, sign * SLIGHT) for axis in range(3) for sign in (1, -1)),
            *(some() @ _stretched(axis, sign * TOO_FAR) for axis in range(3) for sign in (1, -1)),
            *(some() @ _stretched(axis, size) for axis, size in zip((0, 1, 2), decades[1:])),
        ],
        "two axes at right angles to less than 1e-6, or off by more": [
            *(some() @ _leaning(axis, sign * 2 * SLIGHT) for axis in range(3) for sign in (1, -1)),
            *(some() @ _leaning(axis, sign * 2 * TOO_FAR) for axis in range(3) for sign in (1, -1)),
            *(some() @ _leaning(axis, -size) for axis, size in zip((1, 2, 0), decades[1:])),
        ],
        "three axes off by less than 1e-6, or by a little more, some one way and some the other": [
            *(some() @ _all_lean(sign * SLIGHT) for sign in (1, -1)),
            *(some() @ _leaning(1, size) @ _leaning(2, -size) for size in 2 * decades),
            *(along_axes[rng.integers(24)] @ _all_lean(sign * size) for sign, size in zip((1, -1, 1, -1), 2 * decades)),
            *(_leaning(axis, 2 * size).T @ some() for axis, size in zip((0, 1, 2), decades)),
        ],
    }  # fmt: skip
    return [Case(family, (R,)) for family, matrices in families.items() for R in matrices]


def _rounded(R, by):
    """A rotation with an error as rounding makes it, but by chance nowhere exact.

    All products of its columns are off by twice as much, and its determinant by three times.
    """
    return R @ (np.eye(3) + by)


def _stretched(axis, size, next_size=0.0):
    """No rotation: one axis (0, 1, 2) is longer than 1 by `size`, the next one by `next_size`."""
    return np.diag(1.0 + np.roll([size, next_size, 0.0], axis))


def _leaning(axis, size):
    """No rotation: one axis (0, 1, 2) leans towards the next by `size` (their dot product); all have length 1.

    The determinant and the lengths feel it to second order, or not at all.
    """
    E = np.eye(3)
    E[(axis + 1) % 3, axis] = size
    return E / np.linalg.norm(E, axis=0)


def _all_lean(size):
    """No rotation: all axes lean towards each other; columns and rows have length 1."""
    E = np.eye(3) + size * (1.0 - np.eye(3))
    return E / np.linalg.norm(E[0])


def _right_angles_only(R):
    products = R.T @ R
    return _close(products, np.diag(np.diag(products))) and np.linalg.det(R) > 0


def _unit_columns_only(R):
    return _close(np.linalg.norm(R, axis=0), 1.0) and np.linalg.det(R) > 0


ANSWER_REVERSED = (
    "Every answer is the opposite of the right one.",
    "Read the docstring again: when does the function return True?",
)
MIRROR_IMAGES = (
    "You accept mirror images: their axes have length 1 and right angles, but make a left-handed frame.",
    "Which single number of a matrix tells a right-handed frame from a left-handed one?",
)
DIGIT_BY_DIGIT = (
    "You reject rotations whose numbers carry tiny rounding errors.",
    "Numbers that were computed are rarely equal to the last digit: compare with a tolerance.",
)
DETERMINANT_ONLY = (
    "You accept matrices whose determinant is right but whose axes are not.",
    "A stretch along one axis can be undone by a squeeze along another, and the determinant does not notice. "
    "What else is true of the columns of a rotation?",
)

POSITIVE_DETERMINANT = (
    "You accept every matrix whose determinant is positive.",
    "A library that makes a rotation of a matrix often repairs it in silence. What is true of the columns of a rotation?",
)
SINGULAR = (
    "Your function stops with an error where a matrix has no inverse.",
    "A matrix of zeros is no rotation, and the answer to it is False. Can you ask without an inverse?",
)
SIZE_OF_THE_DIFFERENCE = (
    "You accept what is smaller than it has to be: a difference counts whether it is positive or negative.",
    "Try your function on a rotation multiplied by 0.5. How large is a difference of -0.75?",
)
TOO_GENEROUS = (
    "You accept matrices that are off by more than 1e-6.",
    "Your tolerance is too generous: the docstring says how close is close enough. Mind that squares of small numbers are tiny.",
)


NUMPYS_TOLERANCE = (
    "Your tolerance is not 1e-6: it is narrower for small numbers, or wider for large ones.",
    "`np.allclose` and `np.isclose` add up an absolute and a relative tolerance: what are the two when you do not give them?",
)
ERRORS_CANCEL = (
    "You add up differences, and those of opposite signs cancel.",
    "Two numbers that are off by 0.1 and by -0.1 are off all the same: look at the size of each difference.",
)


def _off(R):
    """How far R.T @ R is from the identity."""
    return np.abs(R.T @ R - np.eye(3)).max()


def _within(tolerance, room=5.0):
    """A test of R.T @ R with another tolerance, and where it hangs on how that is measured."""
    return {
        "wrong": lambda R: _off(R) <= tolerance and np.linalg.det(R) > 0,
        "varies": lambda R: ("answer",) if tolerance / room < _off(R) < room * tolerance else (),
    }


def _determinant_within(tolerance, room=5.0):
    """A right test of R.T @ R, and another tolerance of the determinant."""

    def off(R):
        return abs(np.linalg.det(R) - 1.0)

    return {
        "wrong": lambda R: is_rotation(R) and off(R) <= tolerance,
        "varies": lambda R: ("answer",) if is_rotation(R) and tolerance / room < off(R) < room * tolerance else (),
    }


def _allclose(product, **tolerances):
    """A test by np.allclose, which has tolerances of its own where none are given."""
    return lambda R: np.allclose(product(R), np.eye(3), **tolerances) and np.linalg.det(R) > 0


IS_ROTATION = Exercise(
    name="is_rotation",
    returns="truth",
    answer="",
    reference=is_rotation,
    cases=is_rotation_cases,
    features=(
        *of_differences(("R",), ("x.x", "x.y", "x.z", "y.y", "y.z", "z.z"), lambda R: products_off(R)[0][0]),
        Feature(("R",), "sign of the determinant", np.linalg.det, SIGNS),
        type_of("R"),
    ),
    differences=products_off,
    equivalent=CLOSE
    | IN_SINGLE_PRECISION
    | {
        NUMPYS_TRUTH: (
            *CLOSE[NUMPYS_TRUTH],
            "is_rotation: bool(orthonormal and right_handed) -> orthonormal and right_handed",
        ),
        MINUS_TRUE: ("is_rotation: orthonormal -> -orthonormal",),
        SAME_SIZE: (
            *CLOSE[SAME_SIZE],
            "is_rotation: _close(R.T @ R, np.eye(3)) -> _close(np.eye(3), R.T @ R)",
            "is_rotation: np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-06) -> "
            "np.allclose(np.eye(3), R.T @ R, rtol=0, atol=1e-06)",
            "is_rotation: np.isclose(np.linalg.det(R), 1, rtol=0, atol=1e-06) -> "
            "np.isclose(1, np.linalg.det(R), rtol=0, atol=1e-06)",
        ),
        "a matrix is orthogonal by its rows when it is by its columns": ("is_rotation: R.T @ R -> R @ R.T",),
        "with orthonormal columns the determinant is 1 or -1": (
            "is_rotation: np.linalg.det(R) > 0 -> np.linalg.det(R) >= 0",
            "is_rotation: 0 -> 1 [2]",
            "is_rotation: 1e-06 -> 1.000001 [2]",
        ),
        NEAR_TOLERANCE: (
            *CLOSE[NEAR_TOLERANCE],
            "is_rotation: np.isclose(np.linalg.det(R), 1, rtol=0, atol=1e-06) -> np.isclose(np.linalg.det(R), 1, atol=1e-06)",
        ),
    },
    misconceptions=(
        *(
            Misconception(identifier, wrong, *says)
            for identifier, wrong, says in (
                ("determinant-only", lambda R: _close(np.linalg.det(R), 1.0), DETERMINANT_ONLY),
                (
                    "determinant-only;reflection-accepted",
                    lambda R: _close(abs(np.linalg.det(R)), 1.0),
                    together(DETERMINANT_ONLY, MIRROR_IMAGES),
                ),
            )
        ),
        Misconception(
            "reflection-accepted",
            lambda R: _close(R.T @ R, np.eye(3)),
            *MIRROR_IMAGES,
        ),
        Misconception(
            "exact-comparison",
            lambda R: np.array_equal(R.T @ R, np.eye(3)) and np.linalg.det(R) == 1.0,
            *DIGIT_BY_DIGIT,
        ),
        *(
            Misconception("exact-comparison", says=DIGIT_BY_DIGIT[0], hint=DIGIT_BY_DIGIT[1], **fields)
            for tolerance in (3e-8, 1e-9, 1e-11, 1e-15)
            for fields in (_within(tolerance), _determinant_within(tolerance))
        ),
        *(
            Misconception("loose-comparison", says=TOO_GENEROUS[0], hint=TOO_GENEROUS[1], **fields)
            for tolerance in (1e-5, 1e-4, 1e-3, 0.01, 0.03, 0.1)
            for fields in (_within(tolerance, room=1.0), _within(tolerance))
        ),
        *(
            Misconception("default-tolerance", _allclose(product, **tolerances), *NUMPYS_TOLERANCE)
            for product in (lambda R: R.T @ R, lambda R: R @ R.T)
            for tolerances in ({}, {"atol": 1e-6}, {"rtol": 1e-6})
        ),
        *(
            Misconception("errors-cancel", wrong, *ERRORS_CANCEL)
            for wrong in (
                lambda R: abs(np.sum(R.T @ R - np.eye(3))) <= TOLERANCE and np.linalg.det(R) > 0,
                lambda R: abs(np.sum(R.T @ R - np.eye(3))) <= TOLERANCE and _close(np.linalg.det(R), 1.0),
                lambda R: np.sum(R.T @ R - np.eye(3)) <= TOLERANCE and np.linalg.det(R) > 0,
            )
        ),
        Misconception("determinant-only", lambda R: np.linalg.det(R) > 0, *POSITIVE_DETERMINANT),
        Misconception(
            "inverse-of-singular", lambda R: _close(np.linalg.inv(R), R.T) and np.linalg.det(R) > 0, *SINGULAR
        ),
        *(
            Misconception("difference-not-absolute", wrong, *SIZE_OF_THE_DIFFERENCE)
            for wrong in (
                lambda R: (R.T @ R - np.eye(3)).max() <= TOLERANCE and np.linalg.det(R) > 0,
                lambda R: (R.T @ R - np.eye(3)).max() <= TOLERANCE and _close(np.linalg.det(R), 1.0),
                lambda R: (R.T @ R - np.eye(3)).max() <= TOLERANCE and np.linalg.det(R) - 1.0 <= TOLERANCE,
            )
        ),
        Misconception(
            "zero-accepted",
            lambda R: is_rotation(R) or not R.any(),
            "You accept the matrix of zeros.",
            "Three axes of length 0 agree with many a rule about products of axes. Which test looks at a length?",
        ),
        Misconception(
            "eigenvalues-only",
            lambda R: _close(np.abs(np.linalg.eigvals(R)), 1.0) and np.linalg.det(R) > 0,
            "You accept matrices for their eigenvalues.",
            "Eigenvalues do not tell whether the axes are at right angles: try a shear, which leans one axis to another.",
        ),
        Misconception(
            "lengths-ignored",
            _right_angles_only,
            "You check that the axes are at right angles, but not that each has length 1.",
            "Try your function on a rotation multiplied by 2.",
        ),
        *(
            Misconception(
                "angles-ignored",
                wrong,
                "You check that each axis has length 1, but not that the axes are at right angles.",
                "Try your function on three unit vectors that lean towards each other, by much and by little.",
            )
            for wrong in (
                _unit_columns_only,
                lambda R: _unit_columns_only(R) and _unit_columns_only(R.T),
                lambda R: _unit_columns_only(R) and _close(np.linalg.det(R), 1.0),
                lambda R: _unit_columns_only(R.T) and _close(np.linalg.det(R), 1.0),
                lambda R: _unit_columns_only(R.T),
                lambda R: _close(np.sum(R**2), 3.0) and _close(np.linalg.det(R), 1.0),
            )
        ),
        *(
            Misconception(
                "elementwise-product",
                wrong,
                "Your product of two matrices multiplies entry by entry.",
                "`*` is not the matrix product in NumPy. Which operator is?",
            )
            for wrong in (
                lambda R: _close(R * R.T, np.eye(3)),
                lambda R: _close(R * R.T, np.eye(3)) and _close(np.linalg.det(R), 1.0),
            )
        ),
        *(
            Misconception(
                "invertible-only",
                wrong,
                "You accept every matrix that has an inverse.",
                "Any invertible matrix times its inverse is the identity. What is special about a rotation's inverse?",
            )
            for wrong in (
                lambda R: _close(R @ np.linalg.inv(R), np.eye(3)),  # raises for a singular matrix
                lambda R: not _close(np.linalg.det(R), 0.0),
            )
        ),
        *(
            Misconception(
                "pair-not-compared",
                lambda R, pair=pair: (
                    _close(np.linalg.norm(R, axis=0), 1.0)
                    and _close([R[:, i] @ R[:, j] for i, j in ((0, 1), (1, 2), (0, 2)) if {i, j} != pair], 0.0)
                    and np.linalg.det(R) > 0
                ),
                "You compare two pairs of axes, and not the third.",
                "How many pairs do three axes make? Count those that your function compares.",
            )
            for pair in ({0, 2}, {0, 1}, {1, 2})
        ),
        Misconception(
            "pair-not-compared",
            lambda R: _close(np.linalg.norm(R[:, :2], axis=0), 1.0) and _close(np.cross(R[:, 0], R[:, 1]), R[:, 2]),
            "You do not ask whether x and y are at right angles.",
            "Two unit vectors that lean a little towards each other have a cross product of nearly length 1.",
        ),
        Misconception(
            "reflection-accepted;exact-comparison",
            lambda R: np.array_equal(R.T @ R, np.eye(3)),
            *together(MIRROR_IMAGES, DIGIT_BY_DIGIT),
        ),
        Misconception("answer-reversed", lambda R: not is_rotation(R), *ANSWER_REVERSED),
    ),
)

# --- same_rotation --------------------------------------------------------------------------------------------------

_OPPOSITE = np.array([-1.0, -1.0, -1.0, 1.0])  # times a quaternion: the opposite turn


def same_rotation(q1, q2):
    return _close(q1, q2) or _close(q1, -q2)


def _others_rolled(q, kept):
    """q with one of its numbers kept, and the other three moved on."""
    return np.insert(np.roll(np.delete(q, kept), 1), kept, q[kept])


def numbers_off(q1, q2):
    """By how much the numbers of q1 are off from those of q2, and from those of -q2; there is nothing else."""
    return [q1 - q2, q1 + q2], True


ALIKE = 4e-7  # how far q1 and q2 may be from each other: half the angle between them, too, is less than 1e-6


def _turned_in_itself(q, axis):
    """q after a turn by 0.9 about an axis of the turned frame: that axis points where it did."""
    return turned(q, 0.9 * axis)


def _shifted(q, by):
    """q turned a little, by half as much in each of four numbers of one size."""
    moved = q + 0.5 * by * q[::-1] * (1.0, -1.0, 1.0, -1.0) / np.abs(q)
    return moved / np.linalg.norm(moved)


def _longer_than_1(rng):
    """A unit quaternion whose product with itself is a little more than 1, in whatever order it is summed."""
    q = quaternion(rotation(rng))
    while min(q @ q, np.sum(q * q), sum(q * q), sum((q * q)[::-1])) <= 1.0:
        q = nudged(q)
    return q


def _hardly_shorter_than_1(q):
    """A quaternion whose product with itself is less than 1, as it comes of rounding, in whatever order it is summed."""
    return (1.0 - 4.0 * np.finfo(float).eps) * q


def _around_zeros(q):
    """Pairs that differ in one number alone, which is 0 in q: 2e-7 in the one and -2e-7 in the other, or by too much."""
    sizes = ALIKE, -ALIKE, TOO_FAR, -TOO_FAR
    off = [*((by, sign) for by in sizes for sign in (1, -1)), *((10**n * TOO_FAR, (-1) ** n) for n in range(1, 5))]
    for number, (by, sign) in itertools.product(np.flatnonzero(q == 0), off):
        one, other = (q + half * np.eye(4)[number] for half in (by / 2, -by / 2))
        yield one / np.linalg.norm(one), sign * other / np.linalg.norm(other)


def _unequal(q, number, by):
    """q with a number a little larger in size, and the next as much smaller."""
    changed = np.abs(q)
    changed[[number, number + 1]] += by, -by
    return np.copysign(changed / np.linalg.norm(changed), q)


def same_rotation_cases(rng):
    def turn(axis, angle):
        return _hardly_shorter_than_1(quaternion(rotation_about(axis, angle)))

    def nearby(q, size):
        step = rng.permutation([1.0, 0.7, 0.4, 0.1]) * rng.choice([-1.0, 1.0], size=4)
        step -= (step @ q) * q  # along the unit sphere, so that the result is a unit quaternion too
        moved = q + size * step / np.linalg.norm(step)
        return _hardly_shorter_than_1(moved / np.linalg.norm(moved))

    def some():
        return _hardly_shorter_than_1(quaternion(rotation(rng)) * rng.choice([-1.0, 1.0]))

    q = [some() for _ in range(10)]
    # Far from a half turn, whose opposite is the same rotation.
    tilted = [_hardly_shorter_than_1(quaternion(tilt(rng))) for _ in range(3)]
    axis = slanted_axis(rng)
    other = axis[[1, 2, 0]] * [1, 1, -1]  # the dot product of the two is 0.5 at most
    first_half, second_half = (np.append(a, 0.0) for a in (rng.permutation([0.36, 0.48, 0.8]), (0.0, 0.6, -0.8)))
    mirrored = axis * [1, -1, 1]
    # Every component of one is larger than that of another with a minus sign, and none is twice that of the other.
    positive = rng.permutation([0.40, 0.45, 0.55, 0.60])
    all_positive = [np.roll(positive, shift) / np.linalg.norm(positive) for shift in range(3)]
    positive_unit = all_positive[0]
    whole_q, too_long = np.array([0, 0, 0, 1]), _longer_than_1(rng)
    even = np.array([0.5, -0.5, 0.5, -0.5]) * rng.choice([-1.0, 1.0])  # four numbers of one size
    with_zeros = np.array([0.0, 0.6, -0.8, 0.0]), np.array([0.6, 0.0, 0.0, -0.8])
    families = {
        "a quaternion and its negative": [(q[0], -q[0]), (-q[1], q[1]), (q[2], -q[2]), (whole_q, -whole_q)],
        "two half turns (w is 0)": [
            (first_half, -first_half), (-second_half, second_half), (first_half, second_half),
        ],
        "the same quaternion twice, or two unrelated ones": [
            (q[3], q[3]), (q[4], q[5]), (q[6], -q[7]), (-q[8], q[8]), (all_positive[0], all_positive[1]),
            (-all_positive[1], all_positive[2]), (whole_q, q[0]), (whole_q, whole_q), (too_long, too_long),
        ],
        "a turn and the opposite turn": [
            (tilted[0], tilted[0] * _OPPOSITE), (tilted[1], -tilted[1] * _OPPOSITE), (tilted[2], -tilted[2]),
            *((turn(axis, size(rng, d)), turn(-axis, size(rng, d))) for d in SMALL),
        ],
        "two quaternions with one number in common, or about the same axis": [
            *((positive_unit, _others_rolled(positive_unit, kept)) for kept in range(4)),
            (turn(axis, 0.9), turn(other, 0.9)), (turn(axis, 0.9), turn(mirrored, 0.9)),
            (turn(axis, 0.5), -turn(axis, 1.4)), (turn(axis, 1.4), -turn(axis, 1.4)),
            *((turn(along, 0.5), -turn(along, 1.4)) for along in np.eye(3)),
            *((q[n], _turned_in_itself(q[n], along)) for n, along in enumerate(np.eye(3))),
        ],
        "two quaternions that differ by rounding, or by about a degree": [
            (q[9], nearby(q[9], 1e-9)), (q[0], -nearby(q[0], 1e-9)),
            (q[1], nearby(q[1], 0.01)), (q[2], -nearby(q[2], 0.01)),
        ],
        "two quaternions that differ by less than 1e-6, or by a little more": [
            *((q[n], sign * nearby(q[n], ALIKE)) for n, sign in ((3, 1), (4, -1))),
            *((q[n], sign * nearby(q[n], TOO_FAR * 10.0**d)) for d in range(3) for n, sign in ((5 + d, 1), (8 - d, -1))),
            *((even, sign * _shifted(even, TOO_FAR)) for sign in (1, -1)),
            *(
                (_unequal(even, number, 1e-7), sign * _unequal(even, number, -1e-7))
                for number, sign in ((0, 1), (1, -1), (2, 1))
            ),
        ],
        "two nearly the same, where a number is 0 but for rounding, or off by more": [
            *(pair for some in with_zeros for pair in _around_zeros(some)),
            (turn(axis, ALIKE / 2), turn(-axis, ALIKE / 2)), (turn(axis, ALIKE / 2), -turn(other, ALIKE / 2)),
        ],
    }  # fmt: skip
    return [Case(family, pair) for family, pairs in families.items() for pair in pairs]


def _made_positive(index):
    """Compares after making the number at `index` positive."""

    def upper(q):
        return q if q[index] >= 0 else -q

    return lambda q1, q2: _close(upper(q1), upper(q2))


def _apart(q1, q2):
    """How far two orientations are apart, in the number that differs most."""
    return min(np.abs(differences).max() for differences in numbers_off(q1, q2)[0])


def _same_axis(q1, q2):
    return _close(np.cross(q1[:3], q2[:3]), 0.0)


OPPOSITE_ACCEPTED = (
    "You take a turn and the opposite turn for the same orientation.",
    "Negating x, y and z turns the axis round. What has to happen to w for the orientation to stay the same?",
)

OPPOSITE_REJECTED = (
    "You take q and -q for different orientations.",
    "Turn q and -q into rotation matrices, and compare the two matrices.",
)
NO_TOLERANCE = (
    "You take quaternions for different that differ by rounding only.",
    "Numbers that were computed are rarely equal to the last digit: compare with a tolerance.",
)
SIGNS_DROPPED = (
    "You drop the sign of each number by itself, and so take some different orientations for the same.",
    "Either all four signs differ or none does; what if only some of them do?",
)
NOT_THE_SAME = (
    "You take orientations for the same that are further apart than 1e-6.",
    "Your tolerance is too generous. Mind that the dot product of unit vectors hardly changes at small angles.",
)
SIGN_OF_ONE = (
    "You decide between q and -q by the sign of one of the numbers, and that number can be 0 but for rounding.",
    "Compare in a way that does not need the sign of any one number.",
)
SIGN_OF_W = (
    "You go by w, and that does not decide between q and -q when w is 0, or hardly more.",
    "What is the sign of w for a half turn, and what comes of a division by it? Compare in a way that does not need w alone.",
)
ANGLE_ONLY = (
    "You compare the angles only: w says how far a rotation turns, not about what.",
    "Two turns by 30 degrees about different axes are different orientations.",
)

SAME_ROTATION = Exercise(
    name="same_rotation",
    returns="truth",
    answer="",
    reference=same_rotation,
    cases=same_rotation_cases,
    features=(
        *of_differences(("q1", "q2"), "xyzw", lambda q1, q2: min(numbers_off(q1, q2)[0], key=np.linalg.norm)),
        *(type_of(name) for name in ("q1", "q2")),
    ),
    differences=numbers_off,
    equivalent=CLOSE
    | IN_SINGLE_PRECISION
    | {
        NUMPYS_NUMBERS: (*CLOSE[NUMPYS_NUMBERS], "same_rotation: np.asarray(q2) -> q2"),
        NUMPYS_TRUTH: (*CLOSE[NUMPYS_TRUTH], "same_rotation: bool(same or opposite) -> same or opposite"),
        MINUS_TRUE: ("same_rotation: same -> -same", "same_rotation: opposite -> -opposite"),
        SAME_SIZE: (
            *CLOSE[SAME_SIZE],
            "same_rotation: _close(q1, q2) -> _close(q2, q1)",
            "same_rotation: _close(q1, -q2) -> _close(-q2, q1)",
            "same_rotation: np.allclose(q1, q2, rtol=0, atol=1e-06) -> np.allclose(q2, q1, rtol=0, atol=1e-06)",
            "same_rotation: np.allclose(q1, -np.asarray(q2), rtol=0, atol=1e-06) -> "
            "np.allclose(-np.asarray(q2), q1, rtol=0, atol=1e-06)",
        ),
        "q1 is compared with q2 and with -q2": (
            "_close: np.asarray(one) - np.asarray(other) -> np.asarray(one) + np.asarray(other)",
            "_close: np.asarray(one) - np.asarray(other) -> np.asarray(one) - -np.asarray(other)",
            "_close: one -> -one",
            "_close: other -> -other",
        ),
    },
    misconceptions=(
        Misconception(
            "sign-ignored",
            _close,
            *OPPOSITE_REJECTED,
        ),
        *(
            Misconception(
                "exact-comparison",
                lambda q1, q2, one=one, other=other: _close(q1, q2, one) or _close(q1, -q2, other),
                *NO_TOLERANCE,
            )
            for one, other in ((0.0, 0.0), (0.0, TOLERANCE), (TOLERANCE, 0.0), (1e-8, TOLERANCE), (TOLERANCE, 1e-8))
        ),
        Misconception(
            "exact-comparison",
            lambda q1, q2: abs(q1 @ q2) == 1.0,
            *NO_TOLERANCE,
            varies=lambda q1, q2: ("answer",) if abs(abs(q1 @ q2) - 1.0) < 1e-14 else (),
            fails=lambda q1, q2: ("answer",) if same_rotation(q1, q2) and 1.0 - abs(q1 @ q2) > 1e-14 else (),
        ),
        *(
            Misconception(
                "exact-comparison",
                lambda q1, q2, tolerance=tolerance: _close(q1, q2, tolerance) or _close(q1, -q2, tolerance),
                *NO_TOLERANCE,
            )
            for tolerance in (1e-7, 1e-11)
        ),
        *(
            Misconception("loose-comparison", wrong, *NOT_THE_SAME)
            for tolerance in (1e-5, 1e-4, 1e-3, 0.02)
            for wrong in (
                lambda q1, q2, at=tolerance: _close(q1, q2, at) or _close(q1, -q2, at),
                lambda q1, q2, at=tolerance: _close(q1, q2, at) or _close(q1, -q2),
                lambda q1, q2, at=tolerance: _close(q1, q2) or _close(q1, -q2, at),
            )
        ),
        *(
            Misconception(
                "loose-comparison", lambda q1, q2, tolerance=tolerance: abs(q1 @ q2) > 1.0 - tolerance, *NOT_THE_SAME
            )
            for tolerance in (1e-3, 1e-5, 1e-6, 1e-8, 1e-9, 1e-10)
        ),
        *(
            Misconception(
                "default-tolerance",
                lambda q1, q2, tolerances=tolerances: (
                    np.allclose(q1, q2, **tolerances) or np.allclose(q1, -q2, **tolerances)
                ),
                *NUMPYS_TOLERANCE,
            )
            for tolerances in ({}, {"atol": 1e-6}, {"rtol": 1e-6})
        ),
        *(
            Misconception("sign-of-one-number", wrong, *SIGN_OF_ONE)
            for wrong in (
                _made_positive(1),
                _made_positive(2),
                lambda q1, q2: _close(*(q * np.sign(q[np.flatnonzero(q)[0]]) for q in (q1, q2))),
            )
        ),
        *(
            Misconception(
                "errors-cancel",
                wrong,
                ERRORS_CANCEL[0],
                "Which two lists of four numbers have the same sum without being the same? Try (1, 0, 0, 0) and (0, 1, 0, 0).",
            )
            for wrong in (
                lambda q1, q2: _close(np.sum(q1 - q2), 0.0) or _close(np.sum(q1 + q2), 0.0),
                lambda q1, q2: np.sum(q1 - q2) <= TOLERANCE or np.sum(q1 + q2) <= TOLERANCE,
            )
        ),
        Misconception(
            "component-signs-dropped",
            lambda q1, q2: _close(np.abs(q1), np.abs(q2)),
            *SIGNS_DROPPED,
        ),
        *(
            Misconception("rotation-transposed", wrong, *OPPOSITE_ACCEPTED)
            for wrong in (
                lambda q1, q2: _close(q1, q2) or _close(q1, q2 * _OPPOSITE),
                lambda q1, q2: same_rotation(q1, q2) or same_rotation(q1, q2 * _OPPOSITE),
            )
        ),
        Misconception(
            "angle-only",
            lambda q1, q2: _close(abs(q1[3]), abs(q2[3])),
            *ANGLE_ONLY,
        ),
        Misconception(
            "axis-only",
            _same_axis,
            "You compare the axes only: x, y and z point along the axis, whatever the angle.",
            "Turns by 30 and by 80 degrees about one axis are different orientations.",
        ),
        *(
            Misconception(
                "one-vector-compared",
                lambda q1, q2, axis=axis: _close(*(Rotation.from_quat(q).apply(axis) for q in (q1, q2))),
                "You compare where a single vector is turned to.",
                "Which turns leave that vector where it is?",
            )
            for axis in np.eye(3)
        ),
        *(
            Misconception("half-turn-missed", wrong, *SIGN_OF_W)
            for wrong in (
                _made_positive(3),
                lambda q1, q2: _close(np.sign(q1[3]) * q1, np.sign(q2[3]) * q2),  # where w is 0, all four are
                lambda q1, q2: (
                    same_rotation(q1, q2) if 0 in (q1[3], q2[3]) else _close(q1, q2 * np.sign(q1[3] * q2[3]))
                ),
            )
        ),
        Misconception(
            "half-turn-missed",
            _made_positive(3),
            *SIGN_OF_W,
            varies=lambda q1, q2: (
                ("answer",) if 1e-8 < _apart(q1, q2) < 1e-4 or min(abs(q1[3]), abs(q2[3])) < 1e-6 else ()
            ),
            fails=lambda q1, q2: ("answer",) if q1[3] == q2[3] == 0 and np.array_equal(q1, -q2) else (),
        ),
        Misconception(
            "half-turn-missed",
            _made_positive(0),
            "You make x positive first (or take it for w), and that does not decide between q and -q when x is 0.",
            "ROS writes w last; and what if the number whose sign you look at is 0? Compare without it.",
        ),
        Misconception(
            "any-for-all",
            lambda q1, q2: bool(np.any(np.abs(q1 - q2) <= TOLERANCE) or np.any(np.abs(q1 + q2) <= TOLERANCE)),
            "You take orientations for the same when one of the four numbers agrees.",
            "All four numbers have to agree at once: what is the difference between `any` and `all`?",
        ),
        Misconception("sign-ignored;exact-comparison", np.array_equal, *together(OPPOSITE_REJECTED, NO_TOLERANCE)),
        Misconception(
            "angle-only;sign-ignored",
            lambda q1, q2: _close(q1[3], q2[3]),
            *together(ANGLE_ONLY, OPPOSITE_REJECTED),
        ),
        Misconception(
            "component-signs-dropped;exact-comparison",
            lambda q1, q2: np.array_equal(np.abs(q1), np.abs(q2)),
            *together(SIGNS_DROPPED, NO_TOLERANCE),
        ),
        Misconception("answer-reversed", lambda q1, q2: not same_rotation(q1, q2), *ANSWER_REVERSED),
    ),
)

EXERCISES = (ABOUT_Z, FROM_AXES, IS_ROTATION, SAME_ROTATION)
