"""Names by the shape of the error, where no misconception explains the answers: what all that is wrong has in common.

They say what is seen, and no more: only signs are wrong, a single number is, or a predicate fails on one side alone.
"""

from functools import partial
from itertools import product

import numpy as np

from .kinds import KINDS, TOLERANCE
from .naming import Diagnosis, general

AT_LEAST, MANY = 2, 4  # failing cases: one shows nothing that they have in common; many need no number that tells
SMALL = 0.1  # metres, or of an entry or a component
STEPS = (0.1, 0.01, 1e-3, 1e-4, 1e-5)  # to which people round


def by_shape(exercise, outcomes):
    """The Diagnosis of wrong answers (all of which could be compared) by what is wrong with each of them."""
    failing = [outcome for outcome in outcomes if not outcome.answered]
    if exercise["returns"] == "truth":
        deserved = {bool(outcome.expected["answer"]) for outcome in failing}
        met = {bool(outcome.expected["answer"]) for outcome in outcomes if outcome.answered}
        one_sided = len(deserved) == 1 and not deserved >= met
        return general("too-strict" if True in deserved else "too-generous") if one_sided else Diagnosis()
    parts = KINDS[exercise["returns"]].parts
    if len(failing) < AT_LEAST or sum(part.size for part in outcomes[0].expected.values()) == 1:
        return Diagnosis()
    return _slip([_readings(parts, outcome) for outcome in failing])


def cut_short(exercise, outcomes):
    """The Diagnosis of answers whose wrong numbers are the right ones, but 0 where these are small, whole, or rounded."""
    failing = [outcome for outcome in outcomes if not outcome.answered]
    if exercise["returns"] == "truth" or any(outcome.got is None for outcome in failing):
        return Diagnosis()
    readings = [_readings(KINDS[exercise["returns"]].parts, outcome) for outcome in failing]
    for identifier, says, least, cut, telling in CUT:
        chosen = [
            next((one for one in each if all(cut(w.got, w.expected) for w in one.values())), None) for each in readings
        ]
        if None not in chosen and sum(telling(w.got) for one in chosen for w in one.values()) >= least:
            return general(identifier, says)
    return Diagnosis()


def rounded_to(step, got, expected):
    """Which numbers are others, rounded to steps of this size."""
    with np.errstate(invalid="ignore"):  # infinity is not
        return (np.abs(got - step * np.round(got / step)) < 1e-9) & (np.abs(got - expected) <= 0.5 * step + 1e-9)


# What was done to numbers: the name, what to say of it, how many have to show it, what it makes of one, and whether that tells
CUT = (
    (
        "small-values-dropped", "Where a number of the answer is small, yours is 0.", AT_LEAST,
        lambda got, expected: got == 0.0 and abs(expected) < SMALL, lambda got: True,
    ),
    (
        "integer-truncation", "The numbers that are wrong are the right ones without their fractions.", AT_LEAST,
        lambda got, expected: got == int(expected), lambda got: got != 0.0,
    ),
    *(
        (
            "rounded", "The numbers that are wrong are the right ones, rounded.", MANY,
            partial(rounded_to, step), lambda got: got % 1.0 != 0.0,
        )
        for step in STEPS
    ),
)  # fmt: skip


def _slip(failing):
    """The Diagnosis of wrong numbers, from the `_readings` of each failing case."""
    slips = [slip for readings in failing for slip in readings[0].values()]
    if not any(slip.telling for slip in slips) and len(failing) < MANY:
        return Diagnosis()
    alone = [{place for reading in readings if len(reading) == 1 for place in reading} for readings in failing]
    places = set.intersection(*alone)
    where = f"{places.pop()}. All others are right." if len(places) == 1 else ""
    if all(slip.size_right for slip in slips):
        return general("sign-slip", f"A single sign is wrong, always the same: {where}" if where else "")
    return general("entry-slip", f"A single number is wrong, always the same: {where}") if where else Diagnosis()


class _Wrong:
    """A wrong number and the right one: whether its size is right, and whether that tells anything."""

    def __init__(self, got, expected):
        self.got, self.expected = float(got), float(expected)
        self.size_right = abs(abs(got) - abs(expected)) <= TOLERANCE * max(1.0, abs(expected))
        # Another formula hardly gives this number by chance, as it does 0, 1, and the sine of 30, 45 or 60 degrees.
        self.telling = abs(4 * expected**2 - round(4 * expected**2)) > 1e-3


def _readings(parts, outcome):
    """The wrong numbers of an answer, as [{place: _Wrong}, …]: one for each sign of its quaternion, for q and -q are the same."""
    got, expected = outcome.got, outcome.expected
    signs = [(1, -1) if part.quaternion else (1,) for part in parts.values()]
    return [
        {
            _place(name, part, index): _Wrong(sign * got[name][index], expected[name][index])
            for sign, (name, part) in zip(chosen, parts.items())
            for index in np.ndindex(got[name].shape)
            if abs(sign * got[name][index] - expected[name][index]) > TOLERANCE * max(1.0, abs(expected[name][index]))
        }
        for chosen in product(*signs)
    ]


def _place(name, part, index):
    """Where a number stands in an answer, in words."""
    if len(index) == 2:
        return f"row {index[0] + 1}, column {index[1] + 1} (`[{index[0]}, {index[1]}]` in NumPy)"
    if part.unit == "m" or part.quaternion:
        return f"{'xyzw'[index[0]]} of the {name}"
    return f"number {index[0] + 1} of the {name}"
