"""Name the misconception behind wrong answers, when exactly one explains all of them.

A misconception explains a function's answers when they equal its own wherever it differs from the right answer, and are
right everywhere else. Two mistakes at once are named when each wrong part of the answer (a pose's position and its
orientation, say) has exactly one explanation that leaves the other parts right. When none fits, or several do, nothing
is named: a wrong name is worse than none.
"""

import re
from collections import Counter
from typing import NamedTuple

import numpy as np

from . import codec
from .answers import PARTS, TOLERANCE, Unfit, agree, parts_of, same

# Failures that any exercise can have: what the answer shows, and what helps.
GENERAL = {
    "returned-none": ("Your function returned None.", "Does every path through it end in a `return` with a value?"),
    "wrong-type": (
        "Your function returned something of the wrong kind.",
        "Look at what the docstring says it returns.",
    ),
    "wrong-shape": ("Your function returned an array of the wrong shape.", "Print the answer's `.shape` and compare."),
    "not-finite": (
        "Your answer contains NaN or infinity.",
        "Look for a division by zero, or a root of a negative number.",
    ),
    "input-mutated": (
        "Your function changed one of its arguments.",
        "Whoever called it still needs the original: work on a copy, or build a new object.",
    ),
    "hard-coded": (
        "Your function gives the same answer whatever it is given.",
        "Compute the answer from the arguments; the check calls it with many different ones.",
    ),
    "not-normalised": (
        "Your quaternion has the right direction, but its length is not 1.",
        "An orientation is a unit quaternion: divide by its length.",
    ),
    "rounded": (
        "Your answer is right, but rounded.",
        "Return all the digits there are; round when you print.",
    ),
}
TRY_BY_HAND = "Call it yourself, in a cell of its own, with arguments of the kind that the docstring describes."
PRINT_IS_NOT_RETURN = "`print` shows a value to you; only `return` hands it to whoever called the function."
ADVICE = (  # for errors whose message says little to a beginner: (pattern, what helps)
    (r"^NameError", "Each notebook starts empty: is that name defined in this one, in a cell above?"),
    (r"^NotImplementedError", "Write this one from NumPy and tft, so that it works by itself."),
    (
        r"size 3 is different from 4|\(4,4\) and \(3,\) not aligned",
        "A point has three numbers, a 4x4 matrix takes four: what belongs in the fourth place?",
    ),
)


class Diagnosis(NamedTuple):
    """ids of the misconceptions (none when nothing explains the answers), what they show, and what helps."""

    ids: tuple = ()
    says: str = ""
    hint: str = ""


def diagnose(exercise, replies, outcomes):
    """The Diagnosis of the answers to all cases of `exercise`; see transform_lab.verdict for the three arguments.

    That a call changed its arguments is said first, and hides nothing else.
    """
    found = _explain(exercise, replies, outcomes)
    if not any(outcome.mutated for outcome in outcomes):
        return found
    return _together([Diagnosis(("input-mutated",), *GENERAL["input-mutated"]), found])


def constant(replies):
    """Whether a function of arguments answers the same to all of them."""
    return len(replies) > 1 and all(
        reply.outcome == "returned" and reply.value == replies[0].value for reply in replies
    )


def _explain(exercise, replies, outcomes):
    if all(outcome.answered for outcome in outcomes):
        return Diagnosis()
    found = _one_of(
        misconception
        for index, misconception in enumerate(exercise["misconceptions"])
        if _explains(index, exercise, replies, outcomes)
    )
    if found is not None:
        return found
    problems = [outcome.problem for outcome in outcomes if outcome.problem]
    if problems:
        return _general(problems, replies)
    if constant(replies):
        return Diagnosis(("hard-coded",), *GENERAL["hard-coded"])
    return _part_by_part(exercise, outcomes)


def _one_of(misconceptions):
    """The Diagnosis that these misconceptions share; None without any, and when they have different names."""
    fitting = list(misconceptions)
    if len({misconception["id"] for misconception in fitting}) != 1:
        return None
    return Diagnosis(tuple(fitting[0]["id"].split(";")), fitting[0]["says"], fitting[0]["hint"])


def _together(found):
    """Several Diagnoses as one."""
    ids = tuple(dict.fromkeys(identifier for one in found for identifier in one.ids))
    says, hint = (" ".join(filter(None, dict.fromkeys(texts))) for texts in list(zip(*found))[1:])
    return Diagnosis(ids, says, hint)


def _explains(index, exercise, replies, outcomes):
    """Whether the answers equal this misconception's where it differs from the right one, and are right elsewhere."""
    differs = False
    for case, reply, outcome in zip(exercise["cases"], replies, outcomes):
        wrong = case["wrong"][index]
        if wrong is None:
            if not outcome.answered:
                return False
            continue
        differs = True
        if outcome.answered:
            return False
        if raises := error_of(wrong):
            if reply.outcome != "raised" or reply.error.partition(":")[0] != raises:
                return False
        elif reply.outcome != "returned" or not same(exercise["returns"], reply.value, wrong):
            return False
    return differs


def error_of(wrong):
    """The name of the exception that a misconception's answer in the key stands for, or None."""
    return wrong.get("raises") if isinstance(wrong, dict) else None


def _general(problems, replies):
    """The failure that most of the calls share: an exception, or an answer that cannot be compared at all."""
    identifier, times = Counter(identifier for identifier, _ in problems).most_common(1)[0]
    what = next(what for problem, what in problems if problem == identifier)
    if not identifier:
        where = "" if times == len(replies) else f" in {times} of {len(replies)} cases"
        hint = next((advice for pattern, advice in ADVICE if re.search(pattern, what)), TRY_BY_HAND)
        return Diagnosis((), f"Your function raised an error{where}: {what}", hint)
    says, hint = GENERAL[identifier]
    if identifier != "returned-none":
        return Diagnosis((identifier,), f"{says[:-1]}: {what}.", hint)
    if any(reply.printed for reply in replies):
        return Diagnosis((identifier,), "Your function printed something, but returned None.", PRINT_IS_NOT_RETURN)
    return Diagnosis((identifier,), says, hint)


# --- two mistakes at once -------------------------------------------------------------------------------------------


def _part_by_part(exercise, outcomes):
    """The Diagnosis of each wrong part of the answer by itself, together; none unless every one has exactly one."""
    if exercise["returns"] == "truth":
        return Diagnosis()
    parts = PARTS[exercise["returns"]]
    wrong = [part for part in parts if any(part not in outcome.parts for outcome in outcomes)]
    expected = [parts_of(exercise["returns"], codec.decode(case["expected"])) for case in exercise["cases"]]
    candidates = {part: [] for part in parts}
    for index, misconception in enumerate(exercise["misconceptions"]):
        answers = _parts_of_misconception(index, exercise, expected)
        changed = {part for answer, right in zip(answers, expected) for part in parts
                   if not agree(part, answer[part], right[part])}  # fmt: skip
        if len(changed) == 1:
            (part,) = changed
            if all(agree(part, outcome.got[part], answer[part]) for outcome, answer in zip(outcomes, answers)):
                candidates[part].append(misconception)
    found = []
    for part in wrong:
        pairs = [(outcome.got[part], right[part]) for outcome, right in zip(outcomes, expected)]
        for identifier, fits in (("not-normalised", _not_normalised), ("rounded", _rounded)):
            if fits(part, pairs):
                says, hint = GENERAL[identifier]
                candidates[part].append({"id": identifier, "says": says, "hint": hint})
        found.append(_one_of(candidates[part]))
    return Diagnosis() if None in found else _together(found)


def _parts_of_misconception(index, exercise, expected):
    """This misconception's answers, each as its parts; none where one of them cannot be compared part by part."""
    answers = []
    for case, right in zip(exercise["cases"], expected):
        wrong = case["wrong"][index]
        if error_of(wrong):
            return []
        try:
            answers.append(right if wrong is None else parts_of(exercise["returns"], codec.decode(wrong)))
        except Unfit:
            return []
    return answers


def _not_normalised(part, pairs):
    """Whether all these quaternions are right but for their length."""
    lengths = [np.linalg.norm(got) for got, _ in pairs]
    return part == "orientation" and all(
        length > TOLERANCE and agree(part, got / length, right) for length, (got, right) in zip(lengths, pairs)
    )


def _rounded(part, pairs):
    """Whether all these values are the right ones, rounded to some number of decimals."""
    for step in (10.0**-decimals for decimals in range(1, 6)):
        if all(
            np.all(np.abs(got - step * np.round(got / step)) < 1e-9)
            and any(np.abs(got - sign * right).max() <= 0.5 * step + 1e-9 for sign in ((1, -1) if part == "orientation" else (1,)))
            for got, right in pairs
        ):
            return True
    return False
