"""Two mistakes at once: each wrong part of an answer (a pose's position, its orientation) explained by itself."""

from itertools import combinations

import numpy as np

from .answers import WRONG, as_told
from .kinds import KINDS, TOLERANCE
from .naming import GENERAL, Diagnosis, joined, shared
from .plain import has_to_be_wrong, open_parts_of
from .slips import STEPS, rounded_to

OPEN = object()  # a part of an answer that may be anything


def part_by_part(exercise, outcomes):
    """The Diagnosis of the wrong parts of the answer by themselves, together.

    There is one when exactly one set of misconceptions, no two touching the same part, explains all that is wrong.
    """
    parts = KINDS[exercise["returns"]].parts
    wrong = {part for part in parts if any(part not in outcome.parts for outcome in outcomes)}
    explained = {touched: shared(found) for touched, found in _partial_explanations(exercise, outcomes).items()}
    sets = [
        chosen
        for size in range(1, len(wrong) + 1)
        for chosen in combinations(sorted(explained, key=sorted), size)
        if sum(map(len, chosen)) == len(wrong) and set().union(*chosen) == wrong
    ]
    if len(sets) != 1 or None in (found := [explained[touched] for touched in sets[0]]):
        return Diagnosis()
    return joined(sorted(found, key=lambda one: one.ids))


def _partial_explanations(exercise, outcomes):
    """{parts that they touch: [misconceptions that explain the answers in these parts]}"""
    parts, found, loosely = KINDS[exercise["returns"]].parts, {}, {}
    for index, misconception in enumerate(exercise["misconceptions"]):
        told = [_of_each_part(case["wrong"][index], parts) for case in exercise["cases"]]
        if None in told:
            continue
        touched = frozenset(name for one in told for name, what in one.items() if what is not None)
        if touched and all(
            one[name] is OPEN or as_told(parts[name], name, one[name], outcome)
            for outcome, one in zip(outcomes, told)
            for name in touched
        ):
            exact = not any(what is OPEN for one in told for what in one.values())
            (found if exact else loosely).setdefault(touched, []).append(misconception)
    for name, part in parts.items():
        pairs = [(outcome.got[name], outcome.expected[name]) for outcome in outcomes]
        for identifier, fits in (("not-normalised", _not_normalised), ("rounded", _rounded)):
            if any(name not in outcome.parts for outcome in outcomes) and fits(part, pairs):
                says, hint = GENERAL[identifier]
                found.setdefault(frozenset([name]), []).append({"id": identifier, "says": says, "hint": hint})
    return loosely | found


def _of_each_part(wrong, parts):
    """What the key tells of a misconception's answer, {part: None where it is right, its fingerprint, OPEN, WRONG}.

    None for an answer that cannot be taken apart.
    """
    if open_parts := open_parts_of(wrong):
        what = WRONG if has_to_be_wrong(wrong) else OPEN
        return {name: what if name in open_parts else None for name in parts}
    if isinstance(wrong, dict):
        return None
    return dict(zip(parts, wrong or [None] * len(parts)))


def _not_normalised(part, pairs):
    """Whether all these quaternions are right but for their length."""
    if not part.quaternion:
        return False
    lengths = [np.linalg.norm(got) for got, _ in pairs]
    return all(length > TOLERANCE and part.agree(got / length, right) for length, (got, right) in zip(lengths, pairs))


def _rounded(part, pairs):
    """Whether all these values are the right ones, rounded to some number of decimals."""
    signs = (1, -1) if part.quaternion else (1,)  # q and -q are the same orientation
    return any(
        all(any(rounded_to(step, got, sign * right).all() for sign in signs) for got, right in pairs) for step in STEPS
    )
