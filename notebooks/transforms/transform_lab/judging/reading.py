"""An answer as numbers, or why it is none: what the kinds of answers (kinds.py) are read with."""

import re

import numpy as np

from . import codec

METHODS = ("method", "builtin_function_or_method", "instancemethod")


class Unfit(ValueError):
    """The answer cannot be compared at all: `misconception` is the id, the message says what came instead."""

    def __init__(self, misconception, message):
        super().__init__(message)
        self.misconception = misconception


def array(answer, wanted, *shapes):
    """The answer (decoded) as a float64 array of one of these shapes; `wanted` says in words what it has to be.

    Raises Unfit for anything else. The shape () is that of a single number.
    """
    try:
        numbers = np.array(answer)
        if numbers.dtype.kind not in "iuf":
            raise ValueError("no numbers")
        numbers = numbers.astype(np.float64, copy=False)
    except (TypeError, ValueError) as error:
        raise Unfit("wrong-type", f"{_no_numbers(answer)} instead of {wanted}") from error
    if numbers.shape not in shapes:
        what = type_in_words(answer)
        if not isinstance(answer, np.ndarray) and numbers.ndim:
            what = f"{what.partition(' of ')[0]} of shape {numbers.shape}"
        raise Unfit("wrong-shape", f"{what} instead of {wanted}")
    return numbers


def _no_numbers(answer):
    """What is no array of numbers, in words that say why it is none."""
    if isinstance(answer, np.ndarray):  # decoded, it holds numbers or truths
        return f"{type_in_words(answer)} of True and False"
    if not isinstance(answer, (list, tuple)):
        return type_in_words(answer)
    what = type_in_words(answer)
    odd = [item for item in _innermost(answer) if isinstance(item, bool) or not isinstance(item, (int, float))]
    if not odd:
        return f"{what} of rows that differ in length"
    return what if " of " in what else f"{what} with {type_in_words(odd[0])} in it"


def _innermost(answer):
    """What lists in lists hold."""
    for item in answer:
        yield from _innermost(item) if isinstance(item, (list, tuple)) else [item]


def truth(answer, wanted):
    """The answer as 0.0 or 1.0; raises Unfit when it is neither true nor false."""
    value = answer.item() if isinstance(answer, np.ndarray) and answer.size == 1 else answer
    if isinstance(value, (bool, int, float)) and value in (0, 1):
        return np.float64(value)
    raise Unfit("wrong-type", f"{type_in_words(answer)} instead of {wanted}")


def fields(answer, wanted, **letters):
    """The fields of a message as arrays, {field: array}; `letters` are the numbers in each: position="xyz".

    Raises Unfit when one is not there, or holds something else than these numbers.
    """
    if not all(hasattr(answer, name) for name in letters):
        raise Unfit("wrong-type", f"{type_in_words(answer)} instead of {wanted}")
    return {name: _components(getattr(answer, name), name, of) for name, of in letters.items()}


def _components(message, name, letters):
    if not all(hasattr(message, letter) for letter in letters):
        filled = ", ".join(f"{name}.{letter}" for letter in letters)
        raise Unfit("wrong-type", f"{type_in_words(message)} in the field {name}; fill in {filled}")
    values = [getattr(message, letter) for letter in letters]
    for index, (letter, value) in enumerate(zip(letters, values)):
        if isinstance(value, np.ndarray) and value.size == 1:
            values[index] = value = value.item()
        if isinstance(value, codec.Other) and value.type_name in METHODS:
            raise Unfit("wrong-type", f"a method instead of a number in {name}.{letter}: call it, as in {letter}()")
        if not isinstance(value, (bool, int, float)):
            raise Unfit("wrong-type", f"{type_in_words(value)} instead of a number in {name}.{letter}")
    return np.array(values, dtype=np.float64)


def type_in_words(answer):
    """A decoded answer's type, for messages: "a list", "an array of shape (4, 4)", "a tuple of a Point and a Quaternion"."""
    if answer is None:
        return "None"
    if isinstance(answer, np.ndarray):
        return f"an array of shape {answer.shape}"
    if isinstance(answer, tuple) and len(answer) == 2 and not any(isinstance(item, tuple) for item in answer):
        return f"a tuple of {' and '.join(map(type_in_words, answer))}"
    name = answer.type_name if isinstance(answer, codec.Other) else type(answer).__name__
    if name.startswith("class "):
        return f"the {name} itself, without parentheses,"
    return f"{'an' if re.match('[aeio]|u(?!ni)', name, re.IGNORECASE) else 'a'} {name}"
