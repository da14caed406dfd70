"""What arguments can be measured by: a length, an angle, a sign, a type.

The cases of an exercise have an argument in every band of every feature that it declares, and every shortcut that answers
otherwise beyond some threshold of a feature has to be caught; `autograder.proving` asks for both.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from transform_lab.arithmetic import angle_of, matrix_of, quaternion_of, vector_of

from . import cases

ROUNDING = 1e-9  # what is smaller is zero that was computed


@dataclass(frozen=True)
class Feature:
    """Something that the values of one parameter, or of two together, can be measured by.

    of: names of these parameters; with a star, every value of the parameter by itself
    what: it is measured, in words: "length"
    measure: from the values to a number
    bands: {name of a band: (lowest, highest number in it)}
    taken_for: what a shortcut takes a value for that is small in this, in words
    dropped: from the values to what it takes them for, a tuple
    in_parts: whether a shortcut may be felt in any part of the answer by itself
    """

    of: tuple[str, ...]
    what: str
    measure: Callable[..., float]
    bands: dict[str, tuple[float, float]]
    taken_for: str = ""
    dropped: Callable[..., tuple] | None = None
    in_parts: bool = True

    @property
    def name(self):
        return f"{' and '.join(self.of)}: {self.what}"

    def values(self, arguments):
        """The values (each a tuple, one for each parameter of `of`) in arguments, {parameter: value}."""
        if self.of[0].startswith("*"):
            return [(value,) for value in arguments[self.of[0][1:]]]
        return [tuple(arguments[name] for name in self.of)] if all(name in arguments for name in self.of) else []

    def bands_of(self, arguments):
        """The names of the bands that arguments lie in."""
        measured = [self.measure(*values) for values in self.values(arguments)]
        return {name for name, (low, high) in self.bands.items() if any(low <= number <= high for number in measured)}

    def without(self, arguments, low, high):
        """The arguments, with every value dropped whose measure is in [low, high)."""
        changed = [
            self.dropped(*values) if low <= self.measure(*values) < high else values
            for values in self.values(arguments)
        ]
        if self.of[0].startswith("*"):
            return arguments | {self.of[0][1:]: tuple(value for (value,) in changed)}
        return arguments | dict(zip(self.of, *changed)) if changed else arguments


def decades(lowest, highest):
    """Bands from 10^lowest to 10^(highest + 1), each named by the power of ten that it begins with."""
    return {
        f"1e{decade}": (10.0**decade, math.nextafter(10.0 ** (decade + 1), 0)) for decade in range(lowest, highest + 1)
    }


LENGTHS = {"0": (0.0, ROUNDING)} | decades(-6, 3)  # metres
TURNS = {"0": (0.0, ROUNDING)} | decades(-6, 0)  # radians
SMALL_TOGETHER = decades(-6, -1)  # metres and radians
SHORT_OF_HALF = {"0": (0.0, 2e-8)} | decades(-7, -1)  # radians; a cosine knows an angle near π to 1e-8
COMPONENTS = {"0": (0.0, ROUNDING)} | decades(-6, -1)
SIGNS = {"-": (-math.inf, -ROUNDING), "0": (-1e-15, 1e-15), "+": (ROUNDING, math.inf)}
DEGREES = {"0": (0.0, 0.0)} | decades(-4, 3)
TYPES = {"fractions": (0, 0), "integers": (1, 1)}


# Of a difference from what a predicate asks for: within the tolerance of 1e-6, and beyond it
OFF = {
    "-1e-6": (-1e-5, -1e-6),
    "-1e-7": (-1e-6, -5e-8),
    "0": (-1e-8, 1e-8),
    "+1e-7": (5e-8, 1e-6),
    "+1e-6": (1e-6, 1e-5),
}
FAR_OFF = decades(-5, -2)


# What is special of arguments, by the bands of a feature that they lie in: the table of the features' bands is the key
SPECIAL = (
    ("integers", (TYPES,), {"integers"}),
    ("zero", (LENGTHS, TURNS), {"0"}),
    ("half turn", (SHORT_OF_HALF,), {"0", *list(SHORT_OF_HALF)[1:7]}),
    ("small", (LENGTHS, TURNS, DEGREES), {f"1e{decade}" for decade in range(-6, -1)}),
    ("far", (LENGTHS,), {"1e1", "1e2", "1e3"}),
    ("far", (DEGREES,), {"1e3"}),
)


def special_of(features, arguments):
    """What is special of arguments, {parameter: value}; see transform_lab.judging.places."""
    found = set()
    for feature in features:
        if sorts := [(what, names) for what, tables, names in SPECIAL if feature.bands in tables]:
            lies_in = feature.bands_of(arguments)
            found |= {what for what, names in sorts if lies_in & names}
    return list(dict.fromkeys(what for what, _, _ in SPECIAL if what in found))


def of_differences(parameters, names, differences):
    """Features of what a predicate compares with its tolerance: `differences` from the arguments to numbers with these names."""
    return tuple(
        Feature(parameters, f"{name} {what}".strip(), lambda *v, i=index, by=by: by(differences(*v)[i]), bands)
        for index, name in enumerate(names)
        for what, by, bands in (("off by", float, OFF), ("far off by", abs, FAR_OFF))
    )


def of_number(name, bands):
    """Features of a number."""
    return (
        Feature((name,), "size", abs, bands, "0", lambda number: (0.0,)),
        Feature((name,), "sign", float, SIGNS, "its size", lambda number: (abs(number),)),
        type_of(name),
    )


def of_vector(name):
    """Features of an array of 3 coordinates in metres."""
    return (
        Feature((name,), "length", np.linalg.norm, LENGTHS, "0", lambda p: (0.0 * p,)),
        *(
            Feature((name,), f"sign of {letter}", lambda p, i=index: p[i], SIGNS, "their sizes", lambda p: (abs(p),))
            for index, letter in enumerate("xyz")
        ),
        type_of(name),
    )


def of_rotation(name, read=lambda R: R, write=lambda R, value: R):
    """Features of a rotation matrix, which `read` takes from the parameter's value and `write` puts into a new one."""
    return (
        Feature((name,), "angle", lambda v: _angle(read(v)), TURNS, "no turn", lambda v: (write(np.eye(3), v),)),
        Feature((name,), "sign of the trace", lambda v: np.trace(read(v)), SIGNS),
        type_of(name),
    )


def together_small(rotation, translation):
    """The feature of a rotation and a translation that are given by themselves: how small they are, both."""
    return Feature(
        (rotation, translation), "angle and distance together", lambda R, p: _larger_of_both(cases.transform(R, p)),
        SMALL_TOGETHER, "the identity", lambda R, p: (np.eye(3), np.zeros(3)),
    )  # fmt: skip


def of_transform(name):
    """Features of a 4x4 transform."""
    return (
        *of_rotation(name, _rotation, lambda R, value: _like(value, R, _matrix(value)[:3, 3])),
        *(_of_translation(feature) for feature in of_vector(name)[:-1]),
        Feature(
            (name,), "angle and distance together", _larger_of_both, SMALL_TOGETHER, "the identity",
            lambda value: (_like(value, np.eye(3), np.zeros(3)),),
        ),
    )  # fmt: skip


def of_orientation(name):
    """Features of the rotation of a 4x4 transform or of a Pose that matter where it is, or becomes, a quaternion."""

    def component(value, index):
        return abs(quaternion_of(_rotation(value))[index])

    return (
        Feature((name,), "short of a half turn", _short_of_half, SHORT_OF_HALF, "a half turn", lambda v: (_half(v),)),
        *(
            Feature(
                (name,), f"size of the quaternion's {letter}", lambda v, i=index: component(v, i), COMPONENTS, "0",
                lambda v, i=index: (_without_component(v, i),), in_parts=False,
            )
            for index, letter in enumerate("xyzw")
        ),
    )  # fmt: skip


def of_product(one, other):
    """Features of the orientation that one transform and another (or a Pose) make together."""
    return (
        Feature(
            (one, other), "their product short of a half turn", lambda T, v: _short_of_half(T @ _matrix(v)), SHORT_OF_HALF
        ),
    )  # fmt: skip


def of_axes(one, other):
    """Features of the frame whose x and y axes are these."""
    return (
        Feature((one, other), "sign of the trace", lambda x, y: np.trace(_frame(x, y)), SIGNS),
        Feature(
            (one, other),
            "angle",
            lambda x, y: _angle(_frame(x, y)),
            TURNS,
            "no turn",
            lambda x, y: tuple(np.eye(3)[:2]),
        ),
        *(type_of(name) for name in (one, other)),
    )


def _frame(x, y):
    return np.column_stack((x, y, np.cross(x, y)))


def of_pose(name):
    """Features of a Pose; see of_orientation, too."""
    return (
        *of_transform(name),
        Feature(
            (name,), "sign of w", lambda pose: pose.orientation.w, SIGNS, "its size", lambda pose: (_w_positive(pose),)
        ),
    )


def of_two_frames(one, other):
    """Features of two transforms in one frame: how far they are from each other."""
    frames, same = (one, other), lambda A, B: (A, A)
    return (
        Feature(frames, "angle between them", lambda A, B: _angle(_between(A, B)[:3, :3]), TURNS, "equal", _same_rotation),
        Feature(
            frames, "distance between them", lambda A, B: np.linalg.norm(A[:3, 3] - B[:3, 3]), LENGTHS, "equal",
            lambda A, B: (A, cases.transform(B[:3, :3], A[:3, 3])),
        ),
        Feature(frames, "both together", lambda A, B: _larger_of_both(_between(A, B)), SMALL_TOGETHER, "equal", same),
    )  # fmt: skip


def of_each(name, features):
    """Features of every value of a parameter with a star, and how many there are (1 to 6)."""
    return tuple(replace(feature, of=(f"*{name}",)) for feature in features)


def number_of(name, most):
    """How many values a parameter with a star has."""
    return (Feature((name,), "number", len, {str(number): (number, number) for number in range(1, most + 1)}),)


def _of_translation(feature):
    """A feature of vectors, of the translation of a transform (or of a Pose's position)."""
    measure, dropped = feature.measure, feature.dropped

    def without(value):
        T = _matrix(value)
        return (_like(value, T[:3, :3], dropped(T[:3, 3])[0]),)

    return replace(
        feature, what=feature.what.replace("length", "distance"), measure=lambda value: measure(_matrix(value)[:3, 3]),
        dropped=without,
    )  # fmt: skip


def type_of(name):
    """The feature of an array, a Pose or a number: whether it is of integers."""
    return Feature((name,), "type", cases.is_whole, TYPES)


def _matrix(value):
    return value if isinstance(value, np.ndarray) else cases.matrix(value)


def _like(value, R, p):
    """A value of the same kind, with another rotation and another place."""
    return cases.transform(R, p) if isinstance(value, np.ndarray) else cases.pose(R, p)


def _rotation(value):
    return _matrix(value)[:3, :3]


def _angle(R):
    return angle_of(R)


def _short_of_half(value):
    return np.pi - _angle(_rotation(value))


def _larger_of_both(value):
    T = _matrix(value)
    return max(_angle(T[:3, :3]), float(np.linalg.norm(T[:3, 3])))


def _between(A, B):
    return np.linalg.inv(A) @ B


def _same_rotation(A, B):
    return A, cases.transform(A[:3, :3], B[:3, 3])


def _half(value):
    vector = vector_of(_rotation(value))
    axis = vector if vector.any() else (0, 0, 1)
    return _like(value, cases.rotation_about(axis, np.pi), _matrix(value)[:3, 3])


def _without_component(value, index):
    q = quaternion_of(_rotation(value))
    if abs(q[index]) < 1.0:
        q[index] = 0.0
    return _like(value, matrix_of(q), _matrix(value)[:3, 3])


def _w_positive(pose):
    x, y, z, w = cases.orientation(pose)
    return cases.pose_of(cases.position(pose), (x, y, z, abs(w)))
