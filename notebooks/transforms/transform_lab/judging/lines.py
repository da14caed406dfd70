"""Values as lines of text, as a student reads them."""

import numpy as np

from . import codec
from .reading import type_in_words

ROUNDING = 1e-9  # what a number is off by when it was computed


def labelled(label, value):
    """Lines that show a value of any kind under its name."""
    if hasattr(value, "position") and hasattr(value, "orientation"):
        fields = {name: getattr(value, name) for name in ("position", "orientation")}
        return [f"  {label}", *(f"    {name:13}{_field(field)}" for name, field in fields.items())]
    if isinstance(value, (list, tuple, np.ndarray)):
        try:
            array = np.array(value, dtype=float)
        except (TypeError, ValueError):
            return [f"  {label}  {str(value)[:200]}"]
        if not 0 < array.size <= 16:
            return [f"  {label}  {type_in_words(array)}"]
        if array.ndim == 2:
            return [f"  {label}", *(f"    {line}" for line in in_columns(array)[0])]
        return [f"  {label}  {row(array)}" if array.ndim == 1 else f"  {label}  {type_in_words(array)}"]
    if isinstance(value, codec.Other):
        return [f"  {label}  an object of type {value.type_name}"]
    return [f"  {label}  {_short(value)}"]


def in_columns(*matrices):
    """For each matrix the lines that show its rows, all columns of the same width."""
    cells = [[[_short(number) for number in numbers] for numbers in matrix] for matrix in matrices]
    width = max(len(cell) for rows in cells for numbers in rows for cell in numbers)
    return [["  ".join(f"{cell:>{width}}" for cell in numbers) for numbers in rows] for rows in cells]


def row(value):
    """A vector, a quaternion or a message's fields in one line, each number with its letter where it has one."""
    if isinstance(value, np.ndarray):
        value = value.reshape(-1).tolist()
    elif hasattr(value, "x"):
        value = [getattr(value, letter) for letter in "xyzw" if hasattr(value, letter)]
    if not isinstance(value, (list, tuple)):
        return str(value)
    letters = "xyzw" if len(value) in (3, 4) else [""] * len(value)
    return "   ".join(f"{letter} {_short(number)}".strip() for letter, number in zip(letters, value))


def _field(value):
    """A field of a Pose; what is no message is said to be what it is."""
    if hasattr(value, "x"):
        return row(value)
    return type_in_words(value) if isinstance(value, codec.Other) else f"{type_in_words(value)}: {row(value)}"


def _short(number):
    if isinstance(number, (float, np.floating)):
        number = float(number)
        short, simple = round(number, 4), round(number, 1)
        almost = short == simple and abs(number - simple) > ROUNDING  # what makes it another number has to be seen
        return f"{round(number, 7):.8g}" if almost else f"{short + 0.0:g}"
    return repr(number) if isinstance(number, str) else str(number)
