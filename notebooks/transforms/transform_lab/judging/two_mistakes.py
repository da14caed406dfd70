"""Two mistakes at once: each wrong part of an answer (a pose's position, its orientation) explained by itself."""

from itertools import combinations

import numpy as np

from . import codec
from .answers import alike, parts_of
from .kinds import KINDS, TOLERANCE
from .naming import GENERAL, Diagnosis, joined, shared
from .plain import error_of, open_parts_of
from .reading import Unfit


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
    expected = [parts_of(exercise["returns"], codec.decode(case["expected"])) for case in exercise["cases"]]
    for index, misconception in enumerate(exercise["misconceptions"]):
        wrong = _parts_of_misconception(index, exercise, expected)
        touched = frozenset(
            name
            for answer, right in zip(wrong, expected)
            for name, part in parts.items()
            if answer[name] is None or not part.agree(answer[name], right[name])
        )
        if touched and all(
            answer[name] is None or alike(parts[name], outcome.got[name], answer[name])
            for outcome, answer in zip(outcomes, wrong)
            for name in touched
        ):
            exact = all(part is not None for answer in wrong for part in answer.values())
            (found if exact else loosely).setdefault(touched, []).append(misconception)
    for name, part in parts.items():
        pairs = [(outcome.got[name], right[name]) for outcome, right in zip(outcomes, expected)]
        for identifier, fits in (("not-normalised", _not_normalised), ("rounded", _rounded)):
            if any(name not in outcome.parts for outcome in outcomes) and fits(part, pairs):
                says, hint = GENERAL[identifier]
                found.setdefault(frozenset([name]), []).append({"id": identifier, "says": says, "hint": hint})
    return loosely | found


def _parts_of_misconception(index, exercise, expected):
    """This misconception's answers, each as its parts, None for one that may be anything.

    Nothing when one of the answers cannot be taken apart.
    """
    answers = []
    for case, right in zip(exercise["cases"], expected):
        wrong = case["wrong"][index]
        if error_of(wrong):
            return []
        if open_parts := open_parts_of(wrong):
            answers.append({part: None if part in open_parts else value for part, value in right.items()})
            continue
        try:
            answers.append(right if wrong is None else parts_of(exercise["returns"], codec.decode(wrong)))
        except Unfit:
            return []
    return answers


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
        all(
            np.abs(got - step * np.round(got / step)).max() < 1e-9
            and any(np.abs(got - sign * right).max() <= 0.5 * step + 1e-9 for sign in signs)
            for got, right in pairs
        )
        for step in (0.1, 0.01, 1e-3, 1e-4, 1e-5)
    )
