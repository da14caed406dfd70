"""An exercise as plain data: what `key.json` holds of it, and what the judge draws anew for each run. See codec.py."""

from collections.abc import Sequence
from typing import Any, NotRequired, TypedDict

Plain = Any  # what JSON can hold, in the forms of codec.py


class PlainCase(TypedDict):
    """The arguments of one call, with the right answer to them and the wrong ones.

    family: which kind of case it is, in a student's words
    special: what is special of its arguments: some of "integers", "zero", "half turn", "small" and "far"
    wrong: what each misconception of the exercise would answer: null where it happens to be right; else a list with the
        fingerprint of each part of the answer (see kinds.Part), null for a part that is right; {"unfit": plain data} where it is
        no answer of the kind, {"raises": name of the exception} where it raises, {"any": [parts of the answer]} where these may
        be anything, {"not": [parts]} where each of these is wrong, in whatever way. Left out where only right answers are told
        (public_example.py)
    """

    family: str
    special: NotRequired[list[str]]
    args: list[Plain]
    kwargs: dict[str, Plain]
    expected: Plain
    wrong: NotRequired[Sequence[Plain]]


class PlainMisconception(TypedDict):
    """id: as verdicts.csv has it; says: what the answer shows; hint: what helps"""

    id: str
    says: str
    hint: str


class PlainExercise(TypedDict):
    """One exercise with its cases.

    parameters: the names of the function's parameters, a star before one that takes any number of arguments
    returns: the kind of answer, a key of kinds.KINDS; answer: its name, such as "b_T_a"
    credit: {part of the answer: what that part alone is worth}, as shares of the points; all parts are worth 1
    weights: {family of cases: how much it counts}
    points: what it is worth in its notebook; in key.json alone
    """

    parameters: list[str]
    returns: str
    answer: str
    credit: dict[str, float]
    weights: dict[str, float]
    misconceptions: list[PlainMisconception]
    cases: list[PlainCase]
    points: NotRequired[float]


def error_of(wrong):
    """The name of the exception that a misconception's answer in the key stands for, or None."""
    return wrong.get("raises") if isinstance(wrong, dict) else None


def open_parts_of(wrong):
    """The parts of the answer whose numbers hang on how exactly a misconception computes them."""
    return set(wrong.get("any", wrong.get("not", ()))) if isinstance(wrong, dict) else set()


def has_to_be_wrong(wrong):
    """Whether these parts are wrong, each of them, whatever they are; else they may be anything."""
    return isinstance(wrong, dict) and "not" in wrong
