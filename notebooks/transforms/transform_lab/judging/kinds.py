"""The one table of kinds of answers: what each is made of, and how it is read, compared, put into words and drawn.

A new kind is one more entry of KINDS; `check`, the judge, the diagnosis and every page go by it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..messages import Point, Pose, Quaternion
from . import lines, reading

# What an answer may be instead of an object of its own
ARGUMENT = "argument"  # one of the call's own arguments: who changes the one changes the other
EARLIER_ANSWER = "earlier answer"  # the same object as an answer before, which has changed with this call
TOLERANCE = 1e-6  # absolute up to 1 (metre, or component of a unit vector), relative beyond
NOT_FINITE = "not finite"
# No sum of these with whole-numbered factors is zero, so that answers that differ have other fingerprints.
WEIGHTS = np.sqrt([2.0, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0, 19.0, 23.0]) / 5.0


@dataclass(frozen=True)
class Part:
    """A part of an answer, an array of numbers that is right or wrong as a whole.

    unit: of its numbers, "m", when the distance from the right ones says how far off they are
    words: from (got, expected) to how far off it is, where a distance does not say it
    quaternion: whether it is x, y, z, w of an orientation: q and -q are the same, and the length has to be 1
    """

    unit: str = ""
    words: Callable | None = None
    quaternion: bool = False

    def agree(self, got, expected):
        """Whether two values are the same to the tolerance."""
        if self.quaternion:
            return any(np.abs(other).max() <= TOLERANCE for other in (got - expected, got + expected))
        off = np.abs(got - expected)
        return bool(off.max() <= TOLERANCE or (off <= TOLERANCE * np.maximum(1.0, np.abs(expected))).all())

    @staticmethod
    def fingerprint(numbers):
        """One number for a value, by which a misconception's answer is known: a whole one would make a large key.

        NOT_FINITE for a value with NaN or infinity in it.
        """
        found = float(numbers.ravel() @ WEIGHTS[: numbers.size])
        return found if math.isfinite(found) else NOT_FINITE

    def has(self, got, fingerprint):
        """Whether a value has this fingerprint, to the tolerance of its numbers."""
        own = self.fingerprint(got)
        if NOT_FINITE in (own, fingerprint):
            return own == fingerprint
        room = TOLERANCE * self.fingerprint(np.maximum(1.0, np.abs(got)))
        return any(abs(sign * own - fingerprint) <= room for sign in ((1, -1) if self.quaternion else (1,)))

    def off(self, got, expected):
        """How far a value is off, in words: "off by 0.1 m"."""
        if self.agree(got, expected):
            return "right"
        if not np.isfinite(got).all():
            return "no numbers: NaN or infinity"
        if self.words:
            return self.words(got, expected)
        return f"off by {np.linalg.norm(got - expected):.3g} {self.unit}" if self.unit else "wrong"


def _rotation_off(got, expected):
    if np.abs(got.T @ got - np.eye(3)).max() > 1e-3:
        return "not a rotation: its columns are not all of length 1 and at right angles"
    if np.linalg.det(got) < 0:
        return "a mirror image, not a rotation: the axes are left-handed"
    return f"off by {_degrees('from_matrix', got, expected)}"


def _quaternion_off(got, expected):
    largest = np.abs(got).max()
    if largest < 1e-9:
        return "no orientation: all four numbers are 0"
    length, turn = np.linalg.norm(got), _degrees("from_quat", got / largest, expected)
    return f"off by {turn}" if abs(length - 1) < 1e-3 else f"off by {turn}, and of length {length:.3g}"


def _degrees(form, got, expected):
    from scipy.spatial.transform import Rotation  # only now: it takes long to import

    one, other = (getattr(Rotation, form)(value) for value in (got, expected))
    return f"{np.degrees((one.inv() * other).magnitude()):.3g} degrees"


ANYTHING = Part()  # there is nothing to say of it but "right" or "wrong"
PLACE = Part(unit="m")
ROTATION = Part(words=_rotation_off)
ORIENTATION = Part(words=_quaternion_off, quaternion=True)

# --- the expected answer and the student's as lines of text: (got, expected, {part: how far it is off}) -> [lines] --


def in_rows(got, expected, off):
    """Part by part, the expected one above the student's."""
    width = max(map(len, expected)) + 2 if len(expected) > 1 else 0
    found = []
    for part, right in expected.items():
        found.append(f"  {part if width else '':{width}}expected  {lines.row(right)}")
        found.append(f"  {'':{width}}yours     {lines.row(got[part])}   {off[part]}")
    return found


def as_matrices(got, expected, off):
    """Side by side."""
    left, right = lines.in_columns(matrix_of(expected), matrix_of(got))
    indent = len(left[0]) + 4
    rows = [f"  {'expected':{indent}}yours", *(f"  {one:{indent}}{other}" for one, other in zip(left, right))]
    return [*rows, *(f"  {part}: {what}" for part, what in off.items())]


def as_truths(got, expected, off):
    return [f"  {who:10}{bool(value['answer'])}" for who, value in (("expected", expected), ("yours", got))]


# --- one of them in a scene: (viewer, label, parts, whether it is drawn pale, the length of a matrix's axes) ---------


def draw_matrix(viewer, label, parts, ghost, length):
    viewer.add_matrix(label, matrix_of(parts), length=length, ghost=ghost)


def draw_pose(viewer, label, parts, ghost, length):
    p, q = Point(*parts["position"].tolist()), Quaternion(*parts["orientation"].tolist())
    viewer.add_frame(label, Pose(p, q), ghost=ghost)


def draw_point(viewer, label, parts, ghost, length):
    viewer.add_point(label, parts["coordinates"], ghost=ghost)


# --- the table ------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Kind:
    """A kind of answer.

    wanted: what the function has to return, in words: "a 4x4 array"
    parts: {name: Part}, which are right or wrong by themselves, and which an exercise gives credit for
    read: from (answer, wanted) to {name of the part: array}; raises reading.Unfit for what is no answer of this kind
    new: whether the answer may not be one of the arguments: a Pose can be changed in place, and docstrings promise a new one
    draw: adds an answer to a viewer, see above; None for what cannot be drawn
    show: compares two answers in lines of text, see above
    """

    wanted: str
    parts: dict
    read: Callable
    draw: Callable | None
    show: Callable = in_rows
    new: bool = False

    def own(self, same_object):
        """Whether an answer is an object of its own, as far as that was promised; see transform_lab.judging.verdict.Reply."""
        return not same_object or same_object == ARGUMENT and not self.new


def _transform(answer, wanted):
    matrix = reading.array(answer, wanted, (4, 4))
    return {"rotation": matrix[:3, :3], "translation": matrix[:3, 3], "bottom row": matrix[3]}


def matrix_of(parts):
    """The 3x3 or 4x4 matrix that has these parts."""
    if "translation" not in parts:
        return parts["rotation"]
    return np.vstack([np.column_stack([parts["rotation"], parts["translation"]]), parts["bottom row"]])


KINDS = {
    "rotation": Kind(
        wanted="a 3x3 array",
        parts={"rotation": ROTATION},
        read=lambda answer, wanted: {"rotation": reading.array(answer, wanted, (3, 3))},
        draw=draw_matrix,
        show=as_matrices,
    ),
    "transform": Kind(
        wanted="a 4x4 array",
        parts={"rotation": ROTATION, "translation": PLACE, "bottom row": ANYTHING},
        read=_transform,
        draw=draw_matrix,
        show=as_matrices,
    ),
    "pose": Kind(
        wanted="a Pose",
        parts={"position": PLACE, "orientation": ORIENTATION},
        read=lambda answer, wanted: reading.fields(answer, wanted, position="xyz", orientation="xyzw"),
        draw=draw_pose,
        new=True,
    ),
    "coordinates": Kind(
        wanted="an array of 3 coordinates",
        parts={"coordinates": PLACE},
        read=lambda answer, wanted: {"coordinates": reading.array(answer, wanted, (3,), (3, 1), (1, 3)).reshape(3)},
        draw=draw_point,
    ),
    "truth": Kind(
        wanted="True or False",
        parts={"answer": ANYTHING},
        read=lambda answer, wanted: {"answer": reading.truth(answer, wanted)},
        draw=None,
        show=as_truths,
    ),
}
