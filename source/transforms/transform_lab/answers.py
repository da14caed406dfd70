"""What an answer is made of, and when two of them are the same.

An exercise returns one of five kinds of answer: "rotation", "transform", "pose", "coordinates" or "truth".
"""

import numpy as np

from . import codec

TOLERANCE = 1e-6  # absolute up to 1 (metre, or component of a unit vector), relative beyond

PARTS = {  # what each kind of answer is made of
    "rotation": ("rotation",),
    "transform": ("rotation", "translation", "bottom row"),
    "pose": ("position", "orientation"),
    "coordinates": ("coordinates",),
    "truth": ("answer",),
}
WANTED = {
    "rotation": "a 3x3 array",
    "transform": "a 4x4 array",
    "pose": "a Pose",
    "coordinates": "an array of 3 coordinates",
    "truth": "True or False",
}


class Unfit(ValueError):
    """The answer cannot be compared at all: `misconception` is the id, the message says what came instead."""

    def __init__(self, misconception, message):
        super().__init__(message)
        self.misconception = misconception


def parts_of(returns, answer):
    """`answer` (decoded) as the parts of PARTS[returns], each a float64 array; raises Unfit when it is none."""
    if answer is None:
        raise Unfit("returned-none", "None")
    if returns == "truth":
        return {"answer": _truth(answer)}
    if returns == "pose":
        return _pose_parts(answer)
    matrix = _numbers(answer, WANTED[returns])
    if returns == "coordinates":
        if matrix.shape not in ((3,), (3, 1), (1, 3)):
            raise Unfit("wrong-shape", f"an array of shape {matrix.shape} instead of {WANTED[returns]}")
        return {"coordinates": _finite(matrix.reshape(3))}
    shape = (3, 3) if returns == "rotation" else (4, 4)
    if matrix.shape != shape:
        raise Unfit("wrong-shape", f"an array of shape {matrix.shape} instead of {WANTED[returns]}")
    _finite(matrix)
    if returns == "rotation":
        return {"rotation": matrix}
    return {"rotation": matrix[:3, :3], "translation": matrix[:3, 3], "bottom row": matrix[3]}


def agree(part, got, expected):
    """Whether two values of one part are the same to the tolerance; q and -q are the same orientation."""
    if part == "orientation":
        return bool(min(np.abs(got - expected).max(), np.abs(got + expected).max()) <= TOLERANCE)
    return bool((np.abs(got - expected) <= TOLERANCE * np.maximum(1.0, np.abs(expected))).all())


def _truth(answer):
    value = answer.item() if isinstance(answer, np.ndarray) and answer.size == 1 else answer
    if isinstance(value, (bool, int, float)) and value in (0, 1):
        return np.float64(value)
    raise Unfit("wrong-type", f"{kind_of(answer)} instead of True or False")


def _pose_parts(answer):
    if not hasattr(answer, "position") or not hasattr(answer, "orientation"):
        raise Unfit("wrong-type", f"{kind_of(answer)} instead of a Pose")
    return {
        "position": _components(answer.position, "position", "xyz"),
        "orientation": _components(answer.orientation, "orientation", "xyzw"),
    }


def _components(message, name, letters):
    if not all(hasattr(message, letter) for letter in letters):
        what = f"{kind_of(message)} in the field {name}; fill in {', '.join(f'{name}.{c}' for c in letters)}"
        raise Unfit("wrong-type", what)
    values = [getattr(message, letter) for letter in letters]
    for index, (letter, value) in enumerate(zip(letters, values)):
        if isinstance(value, np.ndarray) and value.size == 1:
            values[index] = value = value.item()
        if not isinstance(value, (bool, int, float)):
            raise Unfit("wrong-type", f"{kind_of(value)} instead of a number in {name}.{letter}")
    return _finite(np.array(values, dtype=np.float64))


def _numbers(answer, wanted):
    try:
        array = np.array(answer)
        if array.dtype.kind not in "iuf":
            raise ValueError("no numbers")
        return array.astype(np.float64)
    except (TypeError, ValueError) as error:
        raise Unfit("wrong-type", f"{kind_of(answer)} instead of {wanted}") from error


def _finite(numbers):
    if not np.isfinite(numbers).all():
        raise Unfit("not-finite", "NaN or infinity")
    return numbers


def kind_of(answer):
    """A decoded answer's type in words, for messages: "a list", "an array of shape (4, 4)"."""
    if isinstance(answer, np.ndarray):
        return f"an array of shape {answer.shape}"
    name = answer.type_name if isinstance(answer, codec.Other) else type(answer).__name__
    if name.startswith("array"):
        return f"an {name}"
    return f"{'an' if name[:1].lower() in 'aeiou' else 'a'} {name}"


def same(returns, one, other):
    """Whether two answers (plain data) are the same: part by part where both fit the exercise, else as they are."""
    one, other = codec.decode(one), codec.decode(other)
    try:
        first = parts_of(returns, one)
    except Unfit as unfit:
        return _same_unfit(returns, unfit, one, other)
    return made_of(returns, first, other)


def is_right(returns, answer, expected):
    """Whether `answer` (decoded) agrees with the right answer, given as its parts."""
    try:
        got = parts_of(returns, answer)
    except Unfit:
        return False
    return all(agree(part, got[part], expected[part]) for part in expected)


def made_of(returns, parts, answer):
    """Whether `answer` (decoded) has just these parts."""
    try:
        others = parts_of(returns, answer)
    except Unfit:
        return False
    return all(agree(part, parts[part], others[part]) for part in PARTS[returns])


def matrix_of(parts):
    """The 3x3 or 4x4 matrix that has these parts."""
    if "translation" not in parts:
        return parts["rotation"]
    return np.vstack([np.column_stack([parts["rotation"], parts["translation"]]), parts["bottom row"]])


def _same_unfit(returns, unfit, one, other):
    try:
        parts_of(returns, other)
        return False
    except Unfit as second:
        if unfit.misconception != second.misconception:
            return False
    try:
        first, second = _all_numbers(one), _all_numbers(other)
    except (AttributeError, TypeError, ValueError):  # something else than numbers
        return kind_of(one) == kind_of(other) and str(one) == str(other)
    return first.shape == second.shape and np.allclose(first, second, atol=TOLERANCE, equal_nan=True)


def _all_numbers(answer):
    """The numbers of an array, or of a message's fields, as an array."""
    if hasattr(answer, "position"):
        p, q = answer.position, answer.orientation
        return np.array([p.x, p.y, p.z, q.x, q.y, q.z, q.w], dtype=float)
    return np.array(answer, dtype=float)
