"""Reach a verdict on one exercise: call the student's function on each case, compare, and name the misconception.

The same code serves the notebook (`check`, on the public cases of key.json) and the grader (hidden cases, the function
called in another process), so a student and an instructor never see two opinions.

An exercise, as `examine` takes it, is a dictionary of plain data:

- `parameters`: the names of the function's parameters
- `returns`: "rotation", "transform", "pose", "coordinates" or "truth"; what the answer has to be
- `credit`: {part of the answer: what that part alone is worth}, as shares of the points; all parts are worth 1
- `misconceptions`: [{"id", "says", "hint"}, …]
- `cases`: [{"family", "args", "kwargs", "expected", "wrong"}, …], where `wrong` holds what each misconception would
  answer: null where it happens to be right, {"raises": true} where it raises
"""

import re
from collections import Counter
from dataclasses import dataclass, field

import numpy as np

from . import codec

TOLERANCE = 1e-6  # absolute up to 1 (metre, or component of a unit vector), relative beyond

# What each kind of answer is made of, with the shape of every part.
PARTS = {
    "rotation": {"rotation": (3, 3)},
    "transform": {"rotation": (3, 3), "translation": (3,), "bottom row": (4,)},
    "pose": {"position": (3,), "orientation": (4,)},
    "coordinates": {"coordinates": (3,)},
    "truth": {"answer": ()},
}
WANTED = {
    "rotation": "a 3x3 array",
    "transform": "a 4x4 array",
    "pose": "a Pose",
    "coordinates": "an array of 3 coordinates",
    "truth": "True or False",
}

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
}


LOOP = "Look for a loop that never ends, or a function that calls itself for ever."
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


@dataclass
class Reply:
    """What came of one call: `outcome` is "returned", "raised", "not done", "undefined", "timeout" or "killed"."""

    outcome: str
    value: object = None  # the answer, as plain data
    arguments: object = None  # the positional and keyword arguments after the call, as plain data: [list, dict]
    error: str = ""  # the student's own error, in one line
    printed: str = ""  # the beginning of what it printed


@dataclass
class Verdict:
    """What is known about one exercise of one student.

    status: "graded", "error", "timeout", "killed", "missing" or "unreadable" (see the design's verdicts.csv)
    credit: from 0 to 1; 1 only when every case is right
    misconceptions: ids; more than one when their answers cannot be told apart
    """

    exercise: str
    status: str = "graded"
    credit: float = 0.0
    done: bool = True  # False for a stub that nobody has filled in
    misconceptions: tuple = ()
    says: str = ""  # what the answer shows
    hint: str = ""  # what helps
    parts: dict = field(default_factory=dict)  # part of the answer: number of cases in which it is right
    cases: int = 0
    parameters: tuple = ()  # names of the function's parameters, to show a case by
    failing: dict | None = None  # the first case that is not right
    answer: object = None  # the student's answer to it, decoded

    @property
    def right(self):
        return self.credit == 1.0


class Unfit(ValueError):
    """The answer cannot be compared at all: `misconception` is the id, the message says what came instead."""

    def __init__(self, misconception, message):
        super().__init__(message)
        self.misconception = misconception


def examine(name, exercise, call):
    """The Verdict on the function that `call(args, kwargs) -> Reply` calls, over all cases of `exercise`."""
    cases, returns = exercise["cases"], exercise["returns"]
    replies = []
    for case in cases:
        reply = call(case["args"], case["kwargs"])
        replies.append(reply)
        if reply.outcome not in ("returned", "raised"):
            return _unfinished(name, reply, case)
    outcomes = [_compare(returns, case, reply) for case, reply in zip(cases, replies)]
    verdict = Verdict(name, cases=len(cases), credit=_credit(exercise, outcomes))
    verdict.parameters = tuple(exercise["parameters"])
    verdict.parts = {part: sum(part in outcome.parts for outcome in outcomes) for part in PARTS[returns]}
    if all(outcome.right for outcome in outcomes):
        return verdict
    if all(reply.outcome == "raised" for reply in replies):
        verdict.status = "error"
    if _constant(returns, cases, replies):
        verdict.credit = 0.0
    verdict.misconceptions, verdict.says, verdict.hint = _diagnose(exercise, replies, outcomes)
    for case, reply, outcome in zip(cases, replies, outcomes):
        if not outcome.answered:  # there is none when calls only changed their arguments
            verdict.failing = case
            verdict.answer = codec.decode(reply.value) if reply.outcome == "returned" else None
            break
    return verdict


def _unfinished(name, reply, case):
    if reply.outcome == "not done":
        return Verdict(name, "error", done=False, says="Not done yet.")
    if reply.outcome == "undefined":
        hint = "Run the cell that defines it, and keep its name as it was."
        return Verdict(name, "error", says=f"There is no function called {name}.", hint=hint)
    if reply.outcome == "timeout":
        return Verdict(name, "timeout", says="Your function did not finish in time.", hint=LOOP, failing=case)
    hint = "Look for a loop or a list that grows without end."
    return Verdict(name, "killed", says="Your function had to be stopped: it used too much.", hint=hint, failing=case)


# --- comparing one answer -------------------------------------------------------------------------------------------


@dataclass
class _Outcome:
    parts: frozenset = frozenset()  # the parts of the answer that are right
    answered: bool = False  # all of them are
    problem: tuple | None = None  # (id of a general misconception, what came), when nothing could be compared
    unnormalised: bool = False  # right but for the quaternion's length
    mutated: bool = False  # the call changed its arguments, which costs the case

    @property
    def right(self):
        return self.answered and not self.mutated


def _compare(returns, case, reply):
    if reply.outcome == "raised":
        return _Outcome(problem=("", reply.error))
    mutated = reply.arguments != [case["args"], case["kwargs"]]
    expected = parts_of(returns, codec.decode(case["expected"]))
    try:
        got = parts_of(returns, codec.decode(reply.value))
    except Unfit as unfit:
        return _Outcome(problem=(unfit.misconception, str(unfit)), mutated=mutated)
    good = frozenset(part for part in PARTS[returns] if agree(part, got[part], expected[part]))
    unnormalised = False
    if good == {"position"} and np.linalg.norm(got["orientation"]) > TOLERANCE:
        unit = got["orientation"] / np.linalg.norm(got["orientation"])
        unnormalised = agree("orientation", unit, expected["orientation"])
    return _Outcome(good, len(good) == len(PARTS[returns]), unnormalised=unnormalised, mutated=mutated)


def parts_of(returns, answer):
    """`answer` (decoded) as the parts of PARTS[returns], each a float64 array; raises Unfit when it is none."""
    if answer is None:
        raise Unfit("returned-none", "None")
    if returns == "truth":
        return {"answer": _truth(answer)}
    if returns == "pose":
        return _pose_parts(answer)
    matrix = _numbers(answer, WANTED[returns])
    if returns == "coordinates":
        if matrix.shape not in ((3,), (3, 1), (1, 3)):
            raise Unfit("wrong-shape", f"an array of shape {matrix.shape}")
        return {"coordinates": _finite(matrix.reshape(3))}
    shape = (3, 3) if returns == "rotation" else (4, 4)
    if matrix.shape != shape:
        raise Unfit("wrong-shape", f"an array of shape {matrix.shape}")
    _finite(matrix)
    if returns == "rotation":
        return {"rotation": matrix}
    return {"rotation": matrix[:3, :3], "translation": matrix[:3, 3], "bottom row": matrix[3]}


def agree(part, got, expected):
    """Whether two values of one part are the same to the tolerance; q and -q are the same orientation."""
    if part == "orientation":
        return bool(min(np.abs(got - expected).max(), np.abs(got + expected).max()) <= TOLERANCE)
    return bool(np.all(np.abs(got - expected) <= TOLERANCE * np.maximum(1.0, np.abs(expected))))


def _truth(answer):
    value = answer.item() if isinstance(answer, np.ndarray) and answer.size == 1 else answer
    if isinstance(value, (bool, int, float)) and value in (0, 1):
        return np.float64(value)
    raise Unfit("wrong-type", f"{kind_of(answer)} instead of True or False")


def _pose_parts(answer):
    if not hasattr(answer, "position") or not hasattr(answer, "orientation"):
        raise Unfit("wrong-type", f"{kind_of(answer)} instead of a Pose")
    return {
        "position": _components(answer.position, "position", "xyz"),
        "orientation": _components(answer.orientation, "orientation", "xyzw"),
    }


def _components(message, name, letters):
    if not all(hasattr(message, letter) for letter in letters):
        what = f"{kind_of(message)} in the field {name}; fill in {', '.join(f'{name}.{c}' for c in letters)}"
        raise Unfit("wrong-type", what)
    values = [np.asarray(getattr(message, letter)) for letter in letters]
    for letter, value in zip(letters, values):
        if value.dtype.kind not in "bif" or value.size != 1:
            raise Unfit("wrong-type", f"{kind_of(getattr(message, letter))} instead of a number in {name}.{letter}")
    return _finite(np.array([value.item() for value in values], dtype=np.float64))


def _numbers(answer, wanted):
    try:
        if isinstance(answer, (bool, str, codec.Other)) or hasattr(answer, "__slots__"):
            raise ValueError("no array")
        return np.array(answer, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise Unfit("wrong-type", f"{kind_of(answer)} instead of {wanted}") from error


def _finite(numbers):
    if not np.all(np.isfinite(numbers)):
        raise Unfit("not-finite", "NaN or infinity")
    return numbers


def kind_of(answer):
    """A decoded answer's type in words, for messages: "a list", "an array of shape (4, 4)"."""
    if isinstance(answer, np.ndarray):
        return f"an array of shape {answer.shape}"
    name = answer.type_name if isinstance(answer, codec.Other) else type(answer).__name__
    if name.startswith("array"):
        return f"an {name}"
    return f"{'an' if name[:1].lower() in 'aeiou' else 'a'} {name}"


# --- credit and diagnosis -------------------------------------------------------------------------------------------


def _credit(exercise, outcomes):
    """Each family of cases counts the same; within it, a part earns its share when it is right in every case."""
    if all(outcome.right for outcome in outcomes):
        return 1.0
    families = {}
    for case, outcome in zip(exercise["cases"], outcomes):
        families.setdefault(case["family"], []).append(outcome)
    earned = 0.0
    for members in families.values():
        shared = frozenset.intersection(*(frozenset() if member.mutated else member.parts for member in members))
        complete = all(member.right for member in members)
        earned += 1.0 if complete else sum(exercise["credit"].get(part, 0.0) for part in shared)
    return earned / len(families)


def _constant(returns, cases, replies):
    """Whether a function of arguments answers the same to all of them."""
    values = [reply.value for reply in replies]
    return (
        len(cases) > 1 and all(reply.outcome == "returned" for reply in replies) and all(v == values[0] for v in values)
    )


def _diagnose(exercise, replies, outcomes):
    """What `_explain` finds in the answers; that a call changed its arguments comes first, and hides nothing else."""
    ids, says, hint = _explain(exercise, replies, outcomes)
    if not any(outcome.mutated for outcome in outcomes):
        return ids, says, hint
    spoilt, advice = GENERAL["input-mutated"]
    return ("input-mutated", *ids), f"{spoilt} {says}".strip(), f"{advice} {hint}".strip()


def _explain(exercise, replies, outcomes):
    """(ids, says, hint): a misconception only when exactly one explanation fits all the answers."""
    problems = [outcome.problem for outcome in outcomes if outcome.problem]
    fitting = [
        misconception
        for index, misconception in enumerate(exercise["misconceptions"])
        if _explains(index, exercise, replies, outcomes)
    ]
    if fitting:
        ids = tuple(dict.fromkeys(misconception["id"] for misconception in fitting))
        return ids, fitting[0]["says"], fitting[0]["hint"]
    if problems:
        identifier, times = Counter(identifier for identifier, _ in problems).most_common(1)[0]
        what = next(what for problem, what in problems if problem == identifier)
        if not identifier:
            where = "" if times == len(outcomes) else f" in {times} of {len(outcomes)} cases"
            hint = next((advice for pattern, advice in ADVICE if re.search(pattern, what)), TRY_BY_HAND)
            return (), f"Your function raised an error{where}: {what}", hint
        if identifier == "returned-none" and any(reply.printed for reply in replies):
            return (identifier,), "Your function printed something, but returned None.", PRINT_IS_NOT_RETURN
        says, hint = GENERAL[identifier]
        return (identifier,), f"{says[:-1]}: {what}." if what and identifier != "returned-none" else says, hint
    if all(outcome.answered for outcome in outcomes):
        return (), "", ""
    if all(outcome.answered or outcome.unnormalised for outcome in outcomes):
        return ("not-normalised",), *GENERAL["not-normalised"]
    if _constant(exercise["returns"], exercise["cases"], replies):
        return ("hard-coded",), *GENERAL["hard-coded"]
    return (), "", ""


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
        if wrong == {"raises": True}:
            if reply.outcome != "raised":
                return False
        elif reply.outcome != "returned" or not same(exercise["returns"], reply.value, wrong):
            return False
    return differs


def same(returns, one, other):
    """Whether two answers (plain data) are the same: part by part where both fit the exercise, else as they are."""
    one, other = codec.decode(one), codec.decode(other)
    try:
        first = parts_of(returns, one)
    except Unfit as unfit:
        return _same_unfit(returns, unfit, one, other)
    try:
        second = parts_of(returns, other)
    except Unfit:
        return False
    return all(agree(part, first[part], second[part]) for part in PARTS[returns])


def _same_unfit(returns, unfit, one, other):
    try:
        parts_of(returns, other)
        return False
    except Unfit as second:
        if unfit.misconception != second.misconception:
            return False
    if isinstance(one, (list, np.ndarray)) and isinstance(other, (list, np.ndarray)):
        first, second = np.asarray(one, dtype=object), np.asarray(other, dtype=object)
        if first.shape != second.shape:
            return False
        try:
            return bool(np.allclose(first.astype(float), second.astype(float), atol=TOLERANCE, equal_nan=True))
        except (TypeError, ValueError):
            return False
    return kind_of(one) == kind_of(other) and str(one) == str(other)
