"""Takes answers apart, and says when two of them are the same. What differs from kind to kind stands in kinds.py."""

import numpy as np

from . import codec
from .kinds import KINDS, TOLERANCE
from .reading import Unfit, type_in_words

WRONG = object()  # a part of an answer that is wrong, in whatever way


def parts_of(returns, answer):
    """`answer` (decoded) as the parts of its kind, {name: float64 array}; raises Unfit when it is none.

    Numbers may be NaN or infinite, which are never right: each part is judged by itself.
    """
    if answer is None:
        raise Unfit("returned-none", "None")
    kind = KINDS[returns]
    return kind.read(answer, kind.wanted)


def same(returns, one, other):
    """Whether two answers (plain data) are the same: part by part where both fit the exercise, else as they are."""
    one, other = codec.decode(one), codec.decode(other)
    try:
        first = parts_of(returns, one)
    except Unfit as unfit:
        return _same_unfit(returns, unfit, one, other)
    return made_of(returns, first, other)


def is_right(returns, answer, expected):
    """Whether `answer` (decoded) agrees with the right one, given as its parts."""
    try:
        got = parts_of(returns, answer)
    except Unfit:
        return False
    return all(part.agree(got[name], expected[name]) for name, part in KINDS[returns].parts.items())


def made_of(returns, parts, answer):
    """Whether `answer` (decoded) has just these parts."""
    try:
        others = parts_of(returns, answer)
    except Unfit:
        return False
    return all(alike(part, parts[name], others[name]) for name, part in KINDS[returns].parts.items())


def alike(part, one, other):
    """Whether two answers' values of a part are the same: NaN and infinity are like each other, and like nothing else."""
    finite = np.isfinite(one)
    if not np.array_equal(finite, np.isfinite(other)):
        return False
    return part.agree(np.where(finite, one, 0.0), np.where(finite, other, 0.0))


def as_told(part, name, fingerprint, outcome):
    """Whether a part of an answer is as the key tells of a misconception's: its fingerprint, None where it is right, WRONG."""
    if fingerprint is None or name in outcome.parts:
        return fingerprint is None and name in outcome.parts
    return fingerprint is WRONG or part.has(outcome.got[name], fingerprint)


def _same_unfit(returns, unfit, one, other):
    try:
        parts_of(returns, other)
        return False
    except Unfit as other_unfit:
        if unfit.misconception != other_unfit.misconception:
            return False
    try:
        first, second = _all_numbers(one), _all_numbers(other)
    except (AttributeError, TypeError, ValueError):  # something else than numbers
        return type_in_words(one) == type_in_words(other) and str(one) == str(other)
    return first.shape == second.shape and np.allclose(first, second, atol=TOLERANCE, equal_nan=True)


def _all_numbers(answer):
    """The numbers of an array, or of a message's fields, as an array."""
    if hasattr(answer, "position"):
        p, q = answer.position, answer.orientation
        return np.array([p.x, p.y, p.z, q.x, q.y, q.z, q.w], dtype=float)
    return np.array(answer, dtype=float)
