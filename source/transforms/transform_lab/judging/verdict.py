"""Reach a verdict on one exercise: call the student's function on each case, compare, and name the misconception.

The same code serves the notebook (`check`, on the public cases of key.json) and the grader (hidden cases, the function
called in another process), so a student and an instructor never see two opinions.
"""

import json
import marshal
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, lru_cache

import numpy as np

from . import codec
from .answers import alike, parts_of
from .diagnosis import REMEMBERS, constant, diagnose
from .kinds import EARLIER_ANSWER, KINDS
from .plain import Plain, PlainCase, PlainExercise
from .reading import Unfit
from .status import refuse_unknown

LOOP = "Look for a loop that never ends, or a function that calls itself for ever."


@dataclass
class Reply:
    """What came of one call: `outcome` is "returned", "raised", "not done", "undefined", "timeout" or "killed"."""

    outcome: str
    value: Plain = None  # the answer, as plain data
    arguments: Plain = None  # the positional and keyword arguments after the call, as plain data: [list, dict]
    error: str = ""  # the student's own error, or why the call had to be stopped; in one line
    printed: str = ""  # the beginning of what it printed
    same_object: str = ""  # ARGUMENT or EARLIER_ANSWER (kinds.py), when the answer is no object of its own

    @cached_property
    def answer(self) -> object:
        """The answer, decoded, which nobody may change; raises codec.NotPlain for a value that is no plain data."""
        return codec.decode(self.value)

    @property
    def finished(self) -> bool:
        """Whether the call came to its end, with an answer or an error."""
        return self.outcome in ("returned", "raised")


@dataclass
class Outcome:
    """One answer compared with the right one."""

    parts: frozenset = frozenset()  # the parts of the answer that are right
    answered: bool = False  # all of them are
    got: dict | None = None  # the answer's parts; None when nothing could be compared
    expected: dict | None = None  # and the right answer's
    problem: tuple | None = None  # why not, or that NaN is in it: (id of a general misconception or "", what came)
    mutated: bool = False  # the call changed its arguments
    same_object: str = ""  # as in the Reply, where the answer has to be an object of its own

    @property
    def untouched(self) -> bool:
        """Whether the call left everything else as it was, and its answer to its caller."""
        return not self.mutated and not self.same_object

    @property
    def right(self) -> bool:
        return self.answered and self.untouched


@dataclass
class Verdict:
    """What is known about one exercise of one student.

    status: one of transform_lab.judging.status.STATUSES
    credit: from 0 to 1; 1 only when every case is right
    misconceptions: ids; more than one when the answer has several mistakes at once
    """

    exercise: str
    status: str = "graded"
    credit: float = 0.0
    done: bool = True  # False for a stub that nobody has filled in
    misconceptions: tuple[str, ...] = ()
    says: str = ""  # what the answer shows
    hint: str = ""  # what helps
    parts: dict[str, int] = field(default_factory=dict)  # part of the answer: number of cases in which it is right
    cases: int = 0
    returns: str = ""  # the kind of answer
    wanted: str = ""  # the answer's name, such as "b_T_a"
    parameters: tuple[str, ...] = ()  # names of the function's parameters, to show a case by
    failing: PlainCase | None = None  # the first case with a wrong answer, or none
    answer: object = None  # the student's answer to it, decoded
    error: str = ""  # or the error that was raised instead
    undefined: bool = False  # there is no function of that name

    def __post_init__(self):
        refuse_unknown(self.status)

    @property
    def right(self) -> bool:
        return self.credit == 1.0


def examine(
    name: str,
    exercise: PlainExercise,
    call: Callable[[list, dict], Reply],
    again: Callable[[], Reply] | None = None,
    tell: Callable[[str], str] = str,
) -> Verdict:
    """The Verdict on the function that `call(args, kwargs) -> Reply` calls, over all cases of `exercise`.

    It depends on the answers alone, not on the order of the cases.

    again: calls the function with the first case once more: whether it remembers earlier calls is told by it
    tell: from what is wrong with a reply, in words that the student's process may have chosen, to what may be said of it
    """
    returns, answered = exercise["returns"], []
    for case in exercise["cases"]:
        reply = call(case["args"], case["kwargs"])
        if not reply.finished:
            return _unfinished(name, reply, case)
        answered.append((case, reply, compare(returns, case, reply)))
    if any(outcome.same_object == EARLIER_ANSWER for _, _, outcome in answered):  # then so is the first one
        for _, _, outcome in answered:
            outcome.same_object = EARLIER_ANSWER
    right = all(outcome.right for _, _, outcome in answered)
    remembers = not right and again is not None and _differ(returns, answered[0], again())
    if not right:
        families = list(exercise["weights"])
        answered.sort(key=lambda one: _easy_first(one[0], families))
    cases, replies, outcomes = map(list, zip(*answered))
    verdict = Verdict(
        name,
        "error" if all(reply.outcome == "raised" for reply in replies) else "graded",
        credit=credit(exercise, cases, outcomes),
        parts={part: sum(part in outcome.parts for outcome in outcomes) for part in KINDS[returns].parts},
        cases=len(cases),
        returns=returns,
        wanted=exercise["answer"],
        parameters=tuple(exercise["parameters"]),
    )
    if right:
        return verdict
    if remembers:
        verdict.parts = {part: times if times == len(cases) else 0 for part, times in verdict.parts.items()}
        verdict.credit = sum(exercise["credit"].get(part, 0.0) for part, times in verdict.parts.items() if times)
    if constant(replies):
        verdict.credit = 0.0
    verdict.misconceptions, verdict.says, verdict.hint = diagnose(
        name, {**exercise, "cases": cases}, replies, outcomes, tell
    )
    if remembers:
        verdict.misconceptions, verdict.says, verdict.hint = REMEMBERS
    for case, reply, outcome in answered:
        if not outcome.answered:  # there is none when calls only changed their arguments
            verdict.failing, verdict.error = case, reply.error
            verdict.answer = reply.answer if reply.outcome == "returned" else None
            break
    return verdict


def _differ(returns, answered, reply):
    """Whether the same arguments gave another answer: a function that is wrong may still be so in one way alone."""
    case, before, outcome = answered
    if before.outcome != reply.outcome:
        return True
    now = compare(returns, case, reply)
    if outcome.got is None or now.got is None:
        return (outcome.got is None) != (now.got is None)
    parts = KINDS[returns].parts
    return not all(alike(part, now.got[name], outcome.got[name]) for name, part in parts.items())


def _easy_first(case: PlainCase, families: list[str]) -> tuple[int, int, str]:
    """Sorts cases: the better example is the one that is easier to redo by hand, and of these the shorter to write."""
    given = [case["args"], case["kwargs"]]
    return _effort(given), families.index(case["family"]), json.dumps(given)


def _effort(plain: Plain) -> int:
    """How hard these arguments are to reckon with by hand: each number that is not 0 counts, and most so one with many digits."""
    if isinstance(plain, dict):
        return sum(map(_effort, [fields for what, fields in plain.items() if what != "shape"]))
    if isinstance(plain, list):
        return sum(map(_effort, plain))
    if not isinstance(plain, (int, float)) or plain == 0:
        return 0
    if plain == int(plain) and (abs(plain) < 10 or plain % 90 == 0):
        return 1
    of_a_quarter_turn = abs(plain**2 - 0.5) < 1e-9
    return 2 if of_a_quarter_turn or round(plain, 2) == plain else 8


def _unfinished(name: str, reply: Reply, case: PlainCase) -> Verdict:
    if reply.outcome == "not done":
        return Verdict(name, "error", done=False, says="Not done yet.")
    if reply.outcome == "undefined":
        hint = "Run the cell that defines it, and keep its name as it was."
        return Verdict(name, "error", says=f"There is no function called {name}.", hint=hint, undefined=True)
    if reply.outcome == "timeout":
        why = f": {reply.error}" if reply.error else ""
        return Verdict(name, "timeout", says=f"Your function did not finish in time{why}.", hint=LOOP, failing=case)
    says = f"Your function had to be stopped: {reply.error or 'it used too much'}."
    hint = "Look for a loop or a list that grows without end."
    return Verdict(name, "killed", says=says, hint=hint, failing=case)


def compare(returns: str, case: PlainCase, reply: Reply) -> Outcome:
    """The Outcome of one case."""
    if reply.outcome == "raised":
        return Outcome(problem=("", reply.error))
    mutated = reply.arguments != [case["args"], case["kwargs"]]
    expected, parts = _parts_of_right(returns, Itself(case["expected"])), KINDS[returns].parts
    if is_right_itself(case, reply.value):
        got, good = expected, frozenset(parts)
    else:
        try:
            got = parts_of(returns, reply.answer)
        except Unfit as unfit:
            return Outcome(problem=(unfit.misconception, str(unfit)), mutated=mutated)
        good = frozenset(name for name, part in parts.items() if part.agree(got[name], expected[name]))
    answered = len(good) == len(parts)
    finite = answered or all(np.isfinite(value).all() for value in got.values())
    same = "" if KINDS[returns].own(reply.same_object) else reply.same_object
    problem = None if finite else ("not-finite", "NaN or infinity")
    return Outcome(good, answered, got, expected, problem, mutated, same)


class Itself:
    """An object in the key of a cache, which is found again by that very object alone, and keeps it."""

    __slots__ = ("value",)

    def __init__(self, value):
        self.value = value

    def __hash__(self):
        return id(self.value)

    def __eq__(self, other):
        return self.value is other.value


def is_right_itself(case: PlainCase, value: Plain) -> bool:
    """Whether an answer is the very data that the case expects, as most are; then there is nothing to decode or to compare."""
    return _to_the_bit(value) == _right_to_the_bit(Itself(case.get("expected")))


def _to_the_bit(value):
    return marshal.dumps(value, 2)  # tells 1 from 1.0 and from True; of this version, equal data are equal bytes


@lru_cache(maxsize=4_000)
def _right_to_the_bit(answer):
    return _to_the_bit(answer.value)


@lru_cache(maxsize=4_000)
def _parts_of_right(returns, answer):
    """The parts of a case's right answer (as Itself), which is compared with the answers of a whole class."""
    return parts_of(returns, codec.decode(answer.value))


def credit(exercise: PlainExercise, cases: list[PlainCase], outcomes: list[Outcome]) -> float:
    """Each family of cases counts by its weight; within it, a part earns its share when it is right in every case.

    A family in which a call changed its arguments earns half of that: the numbers are right, the function is of no use yet.
    """
    if all(outcome.right for outcome in outcomes):
        return 1.0
    families: dict[str, list[Outcome]] = {}
    for case, outcome in zip(cases, outcomes):
        families.setdefault(case["family"], []).append(outcome)
    earned = 0.0
    for family, members in families.items():
        parts = frozenset.intersection(*(member.parts for member in members))
        complete = all(member.answered for member in members)
        share = 1.0 if complete else sum(exercise["credit"].get(part, 0.0) for part in parts)
        untouched = all(member.untouched for member in members)
        earned += exercise["weights"][family] * share * (1.0 if untouched else 0.5)
    return earned / sum(exercise["weights"][family] for family in families)
