"""Names by the shape of the error, where no misconception explains the answers: what all that is wrong has in common.

They say what is seen, and no more: only signs are wrong, a single number is, or a predicate fails on one side alone.
"""

import numpy as np

from . import codec
from .answers import parts_of
from .kinds import KINDS, TOLERANCE
from .naming import GENERAL, Diagnosis, general

AT_LEAST = 2  # failing cases; a single one shows nothing that they have in common


def by_shape(exercise, outcomes):
    """The Diagnosis of wrong answers (all of which could be compared) by what is wrong with each of them."""
    expected = [parts_of(exercise["returns"], codec.decode(case["expected"])) for case in exercise["cases"]]
    failing = [(outcome.got, right) for outcome, right in zip(outcomes, expected) if not outcome.answered]
    if len(failing) < AT_LEAST:
        return Diagnosis()
    if exercise["returns"] == "truth":
        return _one_sided([bool(right["answer"]) for _, right in failing])
    parts = KINDS[exercise["returns"]].parts
    slips = [_slips(parts, got, right) for got, right in failing]
    places = {place for slip in slips for place in slip}
    sizes_right = all(size_right for slip in slips for size_right, _ in slip.values())
    telling = any(telling for slip in slips for _, telling in slip.values())
    if sizes_right and telling:
        (where,) = places if len(places) == 1 else [""]
        says, hint = GENERAL["sign-slip"]
        return general("sign-slip", f"A sign is wrong: {where}. All else is right." if where else says, hint)
    if len(places) == 1 and telling and sum(value.size for value in expected[0].values()) > 1:
        return general(
            "entry-slip", f"A single number is wrong, always the same: {places.pop()}. All others are right."
        )
    return Diagnosis()


def _one_sided(deserved):
    """The Diagnosis of a predicate's wrong answers, from the right ones."""
    if len(set(deserved)) != 1:
        return Diagnosis()
    return general("too-strict" if deserved[0] else "too-generous")


def _slips(parts, got, expected):
    """The wrong numbers of an answer, as {place: (whether its size is right, whether that tells anything)}.

    Of q and -q, which are the same orientation, the one is taken in which fewer numbers are wrong.
    """
    found = {}
    for name, part in parts.items():
        signs = (1, -1) if part.quaternion else (1,)
        slips = min((_of_part(name, part, sign * got[name], expected[name]) for sign in signs), key=len)
        found |= slips
    return found


def _of_part(name, part, got, expected):
    slack = TOLERANCE * np.maximum(1.0, np.abs(expected))
    sizes = np.abs(np.abs(got) - np.abs(expected)) <= slack
    return {
        _place(name, part, index): (bool(sizes[index]), _telling(expected[index]))
        for index in map(tuple, np.argwhere(np.abs(got - expected) > slack).tolist())
    }


def _telling(number):
    """Whether another formula hardly gives this number by chance, as it does 0, 1, and the sine of 30 or 45 degrees."""
    return bool(abs(4 * number**2 - round(4 * number**2)) > 1e-3)


def _place(name, part, index):
    if len(index) == 2:
        return f"row {index[0] + 1}, column {index[1] + 1} (`[{index[0]}, {index[1]}]` in NumPy)"
    if part.unit == "m" or part.quaternion:
        return f"the {name}'s {'xyzw'[index[0]]}"
    return f"number {index[0] + 1} of the {name}"
