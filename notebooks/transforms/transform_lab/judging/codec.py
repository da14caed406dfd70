"""Values as plain data: the one form in which arguments and answers are compared, stored and sent.

Plain data is what JSON can hold, and nothing in it can act: numbers, text, lists, numeric arrays with their shape, and
messages by their fields. `key.json` is written in it, and the grader speaks it with the process that runs a student's
notebook. Whatever an object claims about itself, only these numbers reach the judge.

| value                                 | plain data                                                   |
|---------------------------------------|--------------------------------------------------------------|
| None, bool, int, float, str           | itself; NaN and infinities as `{"float": "nan"}`             |
| list                                  | a list                                                       |
| tuple                                 | `{"tuple": [things]}`                                        |
| numeric array, `np.matrix`, scalar    | `{"array": [numbers, row by row], "shape": [rows, columns]}` |
| an object of another library           | what it stands for, see transform_lab.libraries              |
| message, or any object with its fields | `{"message": "Pose", "fields": {"position": …, …}}`         |
| anything else                         | `{"other": "name of its type"}`                              |
"""

import math
from operator import attrgetter
from typing import Any

import numpy as np

from .. import libraries, messages
from .plain import Plain

LARGEST_ARRAY = 1_000  # numbers; the largest right answer has 16
LONGEST_LIST = 100
LONGEST_TEXT = 500
DEEPEST = 6
LARGEST_INTEGER = 2**53  # beyond it a float64 no longer holds every integer

# In this order: a pose stamped has no position of its own, a quaternion has a point's fields and one more.
MESSAGES = {
    "Pose": ("position", "orientation"),
    "PoseStamped": ("header", "pose"),
    "Quaternion": ("x", "y", "z", "w"),
    "Point": ("x", "y", "z"),
    "Header": ("seq", "stamp", "frame_id"),
}
OURS = {getattr(messages, name): attrgetter(*fields) for name, fields in MESSAGES.items()}


class NotPlain(ValueError):
    """What was received is not plain data of a permitted size."""


def encode(value: object, depth: int = 0, room: list[int] | None = None, in_field: bool = False) -> Plain:
    """Plain data for `value`, of bounded size; what has no plain form becomes `{"other": type name}`.

    room: how many more things may be in the outermost list, as its one item; None outside of lists
    in_field: whether it is in the field of a message, where three numbers with names are a Point whatever else they are
    """
    if type(value) is float:  # most of all there is
        return _number(value)
    if type(value) in OURS and depth < DEEPEST and (values := _values(value)):
        return _filled(type(value).__name__, values, depth, room)
    if value is None or isinstance(value, (bool, np.bool_)):
        return None if value is None else bool(value)
    if isinstance(value, (int, np.integer)):
        return int(value) if abs(int(value)) <= LARGEST_INTEGER else _other(value)
    if isinstance(value, (float, np.floating)):
        return _number(float(value))
    if isinstance(value, str):
        return value[:LONGEST_TEXT]
    if isinstance(value, np.ndarray):
        _take(room, value.size)
        return _array(value)
    if depth >= DEEPEST or isinstance(value, type):  # a class has its messages' fields, too
        return _other(value)
    if (name := _message(value)) is not None and (in_field or name != "Point" or not libraries.is_array(value)):
        return _filled(name, [getattr(value, field) for field in MESSAGES[name]], depth, room)
    if isinstance(value, (list, tuple)) and not libraries.is_matrix(value):  # JAX's Rotation is a tuple, too
        if len(value) > LONGEST_LIST:
            return _other(value)
        if room is not None:
            return _things(value, depth, room)
        try:
            return _things(value, depth, [LARGEST_ARRAY])
        except _Full:
            return _other(value)
    found = libraries.taken(value)
    return _other(value, in_field) if found is None else encode(found, depth, room)


def _values(message):
    """The values of all fields of one of our messages; None where one has been deleted."""
    try:
        return OURS[type(message)](message)
    except AttributeError:
        return None


def _filled(name, values, depth, room):
    """A message with these values in its fields; another library's rotation is no Quaternion, and is called what it is."""
    fields = {}
    for field, value in zip(MESSAGES[name], values):
        if type(value) is float:
            fields[field] = _number(value)
        else:
            fields[field] = _other(value, True) if libraries.is_matrix(value) else encode(value, depth + 1, room, True)
    return {"message": name, "fields": fields}


def _things(value, depth, room):
    _take(room, len(value))
    things = [encode(item, depth + 1, room) for item in value]
    return {"tuple": things} if isinstance(value, tuple) else things


class _Full(Exception):
    """There is too much in a list."""


def _take(room, things):
    if room is not None:
        room[0] -= things
        if room[0] < 0:
            raise _Full


def _message(value):
    """The name of the message that has the fields of `value`, or None."""
    if libraries.is_transform(value):  # spatialmath's SE3 has x, y and z
        return None
    for name, fields in MESSAGES.items():
        for field in fields:
            if not hasattr(value, field):
                break
        else:
            return name
    return None


def decode(plain: Plain, depth: int = 0) -> Any:
    """The value that `plain` stands for: arrays as float64 (int64 of integers, bool), messages as those of `transform_lab`.

    Raises NotPlain for anything that `encode` cannot have written, so it is safe on bytes from an untrusted process.
    What has no plain form comes back as an `Other` with the name of its type.
    """
    if depth > DEEPEST:
        raise NotPlain("nested too deeply")
    if plain is None or isinstance(plain, (bool, float)):
        return plain
    if isinstance(plain, int):
        return _checked(plain, abs(plain) <= LARGEST_INTEGER, "an integer out of range")
    if isinstance(plain, str):
        return _checked(plain, len(plain) <= LONGEST_TEXT, "text too long")
    if isinstance(plain, list):
        _checked(plain, len(plain) <= LONGEST_LIST, "a list too long")
        _checked(plain, depth or _items(plain) <= LARGEST_ARRAY, "too much in a list")
        return [decode(item, depth + 1) for item in plain]
    if isinstance(plain, dict):
        kind = next(iter(plain), None)
        if kind == "tuple" and plain.keys() == {"tuple"} and isinstance(plain["tuple"], list):
            return tuple(decode(plain["tuple"], depth))
        if kind == "float" and plain.keys() == {"float"} and plain["float"] in ("nan", "inf", "-inf"):
            return float(plain["float"])
        if kind == "array" and plain.keys() == {"array", "shape"}:
            return _decode_array(plain["array"], plain["shape"])
        if kind == "message" and plain.keys() == {"message", "fields"}:
            return _decode_message(plain["message"], plain["fields"], depth)
        if kind == "other" and plain.keys() == {"other"} and isinstance(plain["other"], str):
            return Other(plain["other"][:LONGEST_TEXT])
    raise NotPlain("an unknown form")


def _items(plain):
    """The number of things in a list and the lists in it; stops counting when there are too many."""
    waiting, items = [plain], 0
    while waiting and items <= LARGEST_ARRAY:
        for item in waiting.pop():
            items += 1
            if isinstance(item, dict):
                item = item.get("tuple")
            if isinstance(item, list):
                waiting.append(item)
    return items


class Other:
    """Stands for a value that has no plain form; `type_name` says what it was."""

    def __init__(self, type_name):
        self.type_name = type_name

    def __repr__(self):
        return f"<{self.type_name}>"


def _checked(plain, fine, problem):
    if not fine:
        raise NotPlain(problem)
    return plain


def _number(value):
    return value if math.isfinite(value) else {"float": repr(value)}


def _other(value, in_field=False):
    calls = libraries.TO_QUATERNION if in_field else libraries.CALLS
    name = f"class {value.__name__}" if isinstance(value, type) else libraries.described(value, calls)
    return {"other": name[:LONGEST_TEXT]}


def _array(value):
    if value.size > LARGEST_ARRAY or value.ndim > DEEPEST or max(value.shape, default=0) > LARGEST_ARRAY:
        return {"other": f"array of shape {value.shape}"}
    if value.dtype.kind == "O" and (found := libraries.taken(value)) is not None:
        value = np.asarray(found)
    if value.dtype.kind not in "biuf":
        return {"other": f"array of {value.dtype}"[:LONGEST_TEXT]}
    numbers = np.asarray(value)
    if numbers.dtype.kind not in "biuf":  # an array of itself, for ever
        raise TypeError(f"{type(value).__name__} claims to be an array of numbers, and is none")
    if value.ndim == 0:
        return encode(numbers.item())  # a length of astropy's is its own item, for ever
    numbers = numbers.ravel()
    if numbers.dtype.kind in "iu" and np.any(np.abs(numbers.astype(np.float64)) > LARGEST_INTEGER):
        return {"other": "array of integers out of range"}
    flat = numbers.tolist()
    if numbers.dtype.char not in "df" or not math.isfinite(sum(flat)):
        flat = [encode(item) for item in flat]
    return {"array": flat, "shape": list(value.shape)}


def _decode_array(flat, shape):
    if not (isinstance(flat, list) and isinstance(shape, list) and 1 <= len(shape) <= DEEPEST):
        raise NotPlain("an array of an unknown form")
    if not all(type(length) is int and 0 <= length <= LARGEST_ARRAY for length in shape):
        raise NotPlain("an array with an impossible shape")
    if len(flat) > LARGEST_ARRAY or math.prod(shape) != len(flat):
        raise NotPlain("an array too large, or not of its shape")
    kinds = set(map(type, flat))
    if kinds != {float}:
        flat = [decode(item, DEEPEST) for item in flat]
        kinds = set(map(type, flat))
        if not kinds <= {bool, int, float}:
            raise NotPlain("an array of something else than numbers")
    dtype = {bool: bool, int: np.int64}.get(*kinds, np.float64) if len(kinds) == 1 else np.float64
    return np.array(flat, dtype=dtype).reshape(shape)


def _decode_message(name, fields, depth):
    if not isinstance(name, str) or name not in MESSAGES or not isinstance(fields, dict):
        raise NotPlain("an unknown message")
    if fields.keys() != set(MESSAGES[name]):
        raise NotPlain(f"a {name} without its fields")
    kind = getattr(messages, name)
    message = kind.__new__(kind)  # no defaults: all the fields follow
    for field in MESSAGES[name]:
        setattr(message, field, decode(fields[field], depth + 1))
    return message
