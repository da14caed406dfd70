"""Name the misconception behind wrong answers, when exactly one explains all of them.

A misconception explains a function's answers when they equal its own wherever it differs from the right answer, and are
right everywhere else. Two mistakes at once are named when each wrong part of the answer (a pose's position and its
orientation, say) has exactly one explanation that leaves the other parts right. When none fits, or several do, nothing
is named: a wrong name is worse than none.
"""

import re
from collections import Counter
from itertools import combinations
from typing import NamedTuple

import numpy as np

from . import codec
from .answers import parts_of, same
from .kinds import KINDS, TOLERANCE

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
        "Whoever called it still needs the original. A plain `=` copies nothing, it only gives a second name: build a new object "
        "from the numbers, or work on a copy.",
    ),
    "hard-coded": (
        "Your function gives the same answer whatever it is given.",
        "Compute the answer from the arguments; the check calls it with many different ones.",
    ),
    "mutable-default": (
        "Your function gives another answer when it is called again with the same arguments.",
        "It remembers earlier calls. Does it change a default argument, such as `pose=Pose()`, or something made outside of it? "
        "Make a new object in each call.",
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
NO_NUMBER = r"ZeroDivisionError|FloatingPointError|ValueError: .*(math domain|zero norm)"  # where a formula breaks down
TRY_BY_HAND = "Call it yourself, in a cell of its own, with arguments of the kind that the docstring describes."
PRINT_IS_NOT_RETURN = "`print` shows a value to you; only `return` hands it to whoever called the function."
ADVICE = (  # for errors whose message says little to a beginner: (pattern, what helps)
    (r"^NameError", "Each notebook starts empty: is that name defined in this one, in a cell above?"),
    (
        r"truth value of an array",
        "`==` of two arrays gives a True or False for each entry; `np.allclose(A, B, rtol=0, atol=1e-6)` gives a single one.",
    ),
    (
        r"numpy.linalg.* has no attribute",
        "The inverse of a matrix M is `np.linalg.inv(M)`, its determinant `np.linalg.det(M)`.",
    ),
    (
        r"ndarray.* has no attribute 'append'",
        "An array has no `append`; `np.append(v, 1)` makes a new one that is longer by 1.",
    ),
    (
        r"'member_descriptor' object",
        "A message is made with parentheses: `Pose()`.",
    ),
    (r"^NotImplementedError", "Write this one from NumPy and tft, so that it works by itself."),
    (
        r"size 3 is different from 4|\(4,4\) and \(3,\) not aligned",
        "A point has three numbers, a 4x4 matrix takes four: what belongs in the fourth place?",
    ),
)


OPEN = object()  # a part of an answer that may be anything
WRONG = object()  # one that is wrong, in whatever way


class Diagnosis(NamedTuple):
    """ids of the misconceptions (none when nothing explains the answers), what they show, and what helps."""

    ids: tuple = ()
    says: str = ""
    hint: str = ""


REMEMBERS = Diagnosis(("mutable-default",), *GENERAL["mutable-default"])


def diagnose(exercise, replies, outcomes, tell=str):
    """The Diagnosis of the answers to all cases of `exercise`; see transform_lab.judging.verdict for the arguments.

    That a call changed its arguments is said first, and hides nothing else.
    """
    found = _explain(exercise, replies, outcomes, tell)
    if not any(outcome.mutated for outcome in outcomes):
        return found
    says, hint = GENERAL["input-mutated"]
    if all(outcome.answered for outcome in outcomes):
        says = f"Your answers are right, but your function {says.removeprefix('Your function ')}"
    return _joined([Diagnosis(("input-mutated",), says, hint), found])


def constant(replies):
    """Whether a function of arguments answers the same to all of them."""
    return len(replies) > 1 and all(
        reply.outcome == "returned" and reply.value == replies[0].value for reply in replies
    )


def _explain(exercise, replies, outcomes, tell):
    if all(outcome.answered for outcome in outcomes):
        return Diagnosis()
    misconceptions = exercise["misconceptions"]
    fits = [_fit(index, exercise, replies, outcomes) for index in range(len(misconceptions))]
    best = max(fits, default=0)
    found = _one_of([misconception for misconception, fit in zip(misconceptions, fits) if fit == best > 0])
    if found is not None:
        return found
    problems = [outcome.problem for outcome in outcomes if outcome.problem]
    if problems:
        return _general(problems, replies, tell)
    if constant(replies):
        return Diagnosis(("hard-coded",), *GENERAL["hard-coded"])
    return _part_by_part(exercise, outcomes)


def _one_of(fitting):
    """The Diagnosis that these misconceptions share; None without any, and when they have different names."""
    if len({misconception["id"] for misconception in fitting}) != 1:
        return None
    return Diagnosis(tuple(fitting[0]["id"].split(";")), fitting[0]["says"], fitting[0]["hint"])


def _joined(found):
    """Several Diagnoses as one: a line for each mistake in what is said, and the same line in the hint."""
    ids = tuple(dict.fromkeys(identifier for one in found for identifier in one.ids))
    return Diagnosis(ids, *together(*((one.says, one.hint) for one in found if one.says)))


def together(*messages: tuple[str, str]) -> tuple[str, str]:
    """(says, hint) of several mistakes, from the (says, hint) of each: the n-th line of both is about the n-th mistake."""
    says, hints = zip(*dict.fromkeys(messages))
    return "\n".join(says), "\n".join(hints)


def _fit(index, exercise, replies, outcomes):
    """How well a misconception explains the answers.

    0: not. 3: they equal its own wherever it differs from the right one, and are right elsewhere. 2: so they do, where
    its own are not open. 1: none of its own is told, but they are wrong wherever it has to be, and right wherever it is.
    """
    parts = set(KINDS[exercise["returns"]].parts)
    fails = equals = is_open = False
    for case, reply, outcome in zip(exercise["cases"], replies, outcomes):
        wrong = case["wrong"][index]
        if wrong is None:
            if not outcome.answered:
                return 0
        elif open_parts := open_parts_of(wrong):
            came_to_nothing = outcome.got is None and _broke_down(outcome)
            if not came_to_nothing and not parts - open_parts <= outcome.parts:
                return 0
            if not has_to_be_wrong(wrong):
                is_open = True
            elif open_parts & outcome.parts:
                return 0
            else:
                fails = True
        elif outcome.answered or not _equals(wrong, exercise["returns"], reply, outcome):
            return 0
        else:
            equals = True
    return (2 if is_open else 3) if equals else int(fails)


def _equals(wrong, returns, reply, outcome):
    if raises := error_of(wrong):
        return reply.outcome == "raised" and reply.error.partition(":")[0] == raises
    if outcome.got is None:
        return reply.outcome == "returned" and "unfit" in wrong and same(returns, reply.value, wrong["unfit"])
    return isinstance(wrong, list) and all(
        _as_told(part, name, fingerprint, outcome)
        for (name, part), fingerprint in zip(KINDS[returns].parts.items(), wrong)
    )


def _as_told(part, name, fingerprint, outcome):
    """Whether a part of an answer is what the key tells of a misconception's: its fingerprint, None where it is right, WRONG."""
    if fingerprint is None or name in outcome.parts:
        return fingerprint is None and name in outcome.parts
    return fingerprint is WRONG or part.has(outcome.got[name], fingerprint)


def _broke_down(outcome):
    """Whether a formula came to its end: NaN came out, or arithmetic raised an error."""
    identifier, what = outcome.problem or (None, "")
    return identifier == "not-finite" or (identifier == "" and re.match(NO_NUMBER, what) is not None)


def error_of(wrong):
    """The name of the exception that a misconception's answer in the key stands for, or None."""
    return wrong.get("raises") if isinstance(wrong, dict) else None


def open_parts_of(wrong):
    """The parts of the answer whose numbers hang on how exactly a misconception computes them."""
    return set(wrong.get("any", wrong.get("not", ()))) if isinstance(wrong, dict) else set()


def has_to_be_wrong(wrong):
    """Whether these parts are wrong, each of them, whatever they are; else they may be anything."""
    return isinstance(wrong, dict) and "not" in wrong


def _general(problems, replies, tell):
    """The failure that most of the calls share: an exception, or an answer that cannot be compared at all."""
    identifier, times = Counter(identifier for identifier, _ in problems).most_common(1)[0]
    what = next(what for problem, what in problems if problem == identifier)
    if not identifier:
        where = "" if times == len(replies) else f" in {times} of {len(replies)} cases"
        hint = next((advice for pattern, advice in ADVICE if re.search(pattern, what)), TRY_BY_HAND)
        told = tell(what)
        return Diagnosis((), f"Your function raised an error{where}{f': {told}' if told else '.'}", hint)
    says, hint = GENERAL[identifier]
    if identifier == "not-finite":
        return Diagnosis((identifier,), says, hint)
    if identifier != "returned-none":
        told = tell(what)
        return Diagnosis((identifier,), f"{says[:-1]}: {told}." if told else says, hint)
    if any(reply.printed for reply in replies):
        return Diagnosis((identifier,), "Your function printed something, but returned None.", PRINT_IS_NOT_RETURN)
    return Diagnosis((identifier,), says, hint)


# --- two mistakes at once -------------------------------------------------------------------------------------------


def _part_by_part(exercise, outcomes):
    """The Diagnosis of the wrong parts of the answer by themselves, together.

    There is one when exactly one set of misconceptions, no two touching the same part, explains all that is wrong.
    """
    parts = KINDS[exercise["returns"]].parts
    wrong = {part for part in parts if any(part not in outcome.parts for outcome in outcomes)}
    explained = {touched: _one_of(found) for touched, found in _partial_explanations(exercise, outcomes).items()}
    sets = [
        chosen
        for size in range(1, len(wrong) + 1)
        for chosen in combinations(sorted(explained, key=sorted), size)
        if sum(map(len, chosen)) == len(wrong) and set().union(*chosen) == wrong
    ]
    if len(sets) != 1 or None in (found := [explained[touched] for touched in sets[0]]):
        return Diagnosis()
    return _joined(sorted(found, key=lambda one: one.ids))


def _partial_explanations(exercise, outcomes):
    """{parts that they touch: [misconceptions that explain the answers in these parts]}"""
    parts, found, loosely = KINDS[exercise["returns"]].parts, {}, {}
    for index, misconception in enumerate(exercise["misconceptions"]):
        told = [_of_each_part(case["wrong"][index], parts) for case in exercise["cases"]]
        if not all(told):
            continue
        touched = frozenset(name for one in told for name, what in one.items() if what is not None)
        if touched and all(
            one[name] is OPEN or _as_told(parts[name], name, one[name], outcome)
            for outcome, one in zip(outcomes, told)
            for name in touched
        ):
            exact = not any(what is OPEN for one in told for what in one.values())
            (found if exact else loosely).setdefault(touched, []).append(misconception)
    expected = [parts_of(exercise["returns"], codec.decode(case["expected"])) for case in exercise["cases"]]
    for name, part in parts.items():
        pairs = [(outcome.got[name], right[name]) for outcome, right in zip(outcomes, expected)]
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
        all(
            np.abs(got - step * np.round(got / step)).max() < 1e-9
            and any(np.abs(got - sign * right).max() <= 0.5 * step + 1e-9 for sign in signs)
            for got, right in pairs
        )
        for step in (0.1, 0.01, 1e-3, 1e-4, 1e-5)
    )
