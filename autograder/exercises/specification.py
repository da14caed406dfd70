"""What an exercise is: a reference solution, a generator of cases, and the ways students get it wrong.

One specification feeds everything: the public key that `check` reads in the notebooks, the hidden cases of the judge,
the diagnosis in feedback and report, and the tests that prove the grader.
"""

import math
import pickle
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from inspect import signature

import numpy as np
from transform_lab.judging import codec
from transform_lab.judging.answers import parts_of
from transform_lab.judging.comparison import frames_of
from transform_lab.judging.kinds import KINDS, NOT_FINITE
from transform_lab.judging.plain import PlainCase, PlainExercise, error_of
from transform_lab.judging.reading import Unfit

from .draws import PUBLIC_SEED, Draws
from .features import Feature, special_of

ORDER = 1  # with the seed, what the order of the cases is drawn from
NOISE = 1e-15  # an argument smaller than that is what sines and products leave in the place of zero
DIGITS = 12  # of right answers: far below the tolerance of 1e-6
DIGITS_WRONG = 7  # of wrong ones, which are most of the key
PROTOCOL = 4  # of pickle; from 5 on, arrays do not own their numbers


@dataclass(frozen=True)
class Case:
    """Arguments for one call, and the family of cases it stands for, in words a student understands."""

    family: str  # "a half turn about a slanted axis"
    args: tuple = ()
    kwargs: dict = field(default_factory=dict)


@dataclass(frozen=True)
class Misconception:
    """One way to get an exercise wrong, as code: `wrong` answers the exercise's arguments as that student would."""

    id: str  # as verdicts.csv has it, such as "wrong-axis"; two of them, joined by ";", for two mistakes at once
    wrong: Callable
    says: str  # what the answer shows
    hint: str  # helps without giving the solution away
    # From the arguments to the parts of the answer that hang on how exactly it is computed: others answer otherwise.
    varies: Callable = lambda *args, **kwargs: ()
    # …and to those that are wrong however it is computed: without any, what is left open could be anybody's.
    fails: Callable = lambda *args, **kwargs: ()


@dataclass(frozen=True)
class Exercise:
    """One exercise.

    name: of the student's function, of its test cell, and of the row in every report
    returns: the kind of answer, a key of transform_lab.judging.kinds.KINDS
    answer: its name, "b_T_a" or "p_in_a", which tells the frame it is given in; names of parameters do the same. Empty for
        what is given in none, and not drawn
    reference: the right solution
    cases: from Draws, a NumPy random generator, to a list of Case; the same families for every seed
    misconceptions: see Misconception
    credit: what each part of the answer is worth alone; all parts together are worth 1
    weights: how much a family of cases counts; 1 for one that is not here
    features: what its arguments can be measured by, see autograder.exercises.features: there is a case in every band
    differences: of a predicate, from the arguments to what it compares with its tolerance, ([array, …], rest): it is true when
        one of the arrays is all within the tolerance, and the rest is true
    equivalent: mutants and shortcuts that are right, too, as {reason: (what was changed, …)}; see autograder.exercises.equivalent
    """

    name: str
    returns: str
    answer: str
    reference: Callable
    cases: Callable[[Draws], list]
    misconceptions: tuple = ()
    credit: dict = field(default_factory=dict)
    weights: dict = field(default_factory=dict)
    features: tuple[Feature, ...] = ()
    differences: Callable | None = None
    equivalent: dict = field(default_factory=dict)

    def __post_init__(self):
        if self.returns not in KINDS:
            raise ValueError(f"{self.name}: {self.returns!r} is no kind of answer; there are {', '.join(KINDS)}")
        if self.answer and not frames_of(self.answer):
            raise ValueError(
                f"{self.name}: {self.answer!r} tells no frame; call the answer b_T_a or p_in_a, or nothing"
            )
        unknown = set(self.credit) - set(KINDS[self.returns].parts)
        if unknown or sum(self.credit.values()) > 1:
            raise ValueError(f"{self.name}: credit {self.credit} does not fit an answer of kind {self.returns}")

    def drawn(self, seed):
        """The list of cases of a seed."""
        return self.cases(Draws(seed))

    def bound(self, args, kwargs):
        """The arguments of a call, {parameter: value}; a parameter with a star has a tuple of values."""
        return dict(signature(self.reference).bind(*args, **kwargs).arguments)


def key(exercise: Exercise, seed: int, when_asked: bool = False) -> PlainExercise:
    """The exercise with the cases drawn from `seed`, as the plain data that `transform_lab.judging.verdict.examine` takes.

    when_asked: leave each of the misconceptions' answers until somebody asks for it

    Hidden cases come in an order of their own, so that a call's number tells nothing about it; public ones, which are read,
    as the specification has them.
    """
    cases = exercise.drawn(seed)
    return {
        "parameters": [str(p).partition("=")[0] for p in signature(exercise.reference).parameters.values()],
        "returns": exercise.returns,
        "answer": exercise.answer,
        "credit": exercise.credit,
        "weights": {case.family: exercise.weights.get(case.family, 1) for case in cases},
        "misconceptions": [{"id": m.id, "says": m.says, "hint": m.hint} for m in exercise.misconceptions],
        "cases": [_case(exercise, cases[number], when_asked) for number in order_of(len(cases), seed)],
    }


def order_of(number, seed):
    """The order in which a key has so many cases: their numbers in the specification."""
    return (
        list(range(number))
        if seed == PUBLIC_SEED
        else np.random.default_rng([seed, ORDER]).permutation(number).tolist()
    )


class WrongAnswers(Sequence):
    """What the key tells of each misconception in one case, worked out when it is asked for: a right solution needs none."""

    def __init__(self, misconceptions, tell):
        self.misconceptions, self.tell, self.told = misconceptions, tell, {}

    def __len__(self):
        return len(self.misconceptions)

    def __getitem__(self, index):
        if index not in self.told:
            self.told[index] = self.tell(self.misconceptions[index])
        return self.told[index]


class Arguments:
    """A case's arguments (plain data), decoded once: a copy takes a fraction of the time that it takes to decode them."""

    def __init__(self, args, kwargs):
        self.plain = args, kwargs
        decoded = [codec.decode(arg) for arg in args], {name: codec.decode(arg) for name, arg in kwargs.items()}
        self._pickled = pickle.dumps(decoded, PROTOCOL)

    def fresh(self):
        """The positional and the keyword arguments, as objects of the caller's own: a function may change them."""
        return pickle.loads(self._pickled)

    def are(self, args, kwargs):
        """Whether these arguments are still what they were."""
        if pickle.dumps((args, kwargs), PROTOCOL) == self._pickled:
            return True
        return self.plain == (
            [codec.encode(arg) for arg in args],
            {name: codec.encode(arg) for name, arg in kwargs.items()},
        )


def _case(exercise, case, when_asked) -> PlainCase:
    args = [_each_float(codec.encode(arg), _without_noise) for arg in case.args]
    kwargs = {name: _each_float(codec.encode(arg), _without_noise) for name, arg in case.kwargs.items()}
    fresh = Arguments(args, kwargs).fresh
    expected = _answer(exercise.reference, fresh)
    right = _parts_of_the_right(exercise, case, expected)
    given, named = fresh()
    wrong = WrongAnswers(
        exercise.misconceptions,
        lambda one: _untold(one, given, named) or _wrong_answer(exercise.returns, one, fresh, right),
    )
    return {
        "family": case.family,
        "special": special_of(exercise.features, exercise.bound(given, named)),
        "args": args,
        "kwargs": kwargs,
        "expected": expected,
        "wrong": wrong if when_asked else list(wrong),
    }


def _parts_of_the_right(exercise, case, expected):
    where = f"{exercise.name}: the reference's answer to a case of {case.family!r}"
    if error_of(expected):
        raise ValueError(f"{where} is an error, {error_of(expected)}")
    try:
        parts = parts_of(exercise.returns, codec.decode(expected))
    except Unfit as unfit:
        raise ValueError(f"{where} is {unfit}") from unfit
    if not all(np.isfinite(value).all() for value in parts.values()):
        raise ValueError(f"{where} has NaN or infinity in it")
    return parts


def _untold(misconception, args, kwargs):
    """What the key says of an answer that hangs on how exactly it is computed; None where it does not."""
    if wrong_parts := misconception.fails(*args, **kwargs):
        return {"not": list(wrong_parts)}
    if open_parts := misconception.varies(*args, **kwargs):
        return {"any": list(open_parts)}
    return None


def _wrong_answer(returns, misconception, fresh, right):
    """The answer of a misconception as the key has it; see PlainCase."""
    answer = _answer(misconception.wrong, fresh)
    if answer is None:
        raise ValueError(f"{misconception.id}: to return None is a misconception of every exercise already")
    if error_of(answer):
        return answer
    try:
        got = parts_of(returns, codec.decode(answer))
    except Unfit:
        return {"unfit": _rounded(answer, DIGITS_WRONG)}
    told = [
        None if part.agree(got[name], right[name]) else _short(part.fingerprint(got[name]))
        for name, part in KINDS[returns].parts.items()
    ]
    return told if any(fingerprint is not None for fingerprint in told) else None


def _answer(function, fresh):
    args, kwargs = fresh()
    with np.errstate(all="ignore"):  # wrong implementations divide by zero; that is their point
        try:
            return _rounded(codec.encode(function(*args, **kwargs)))
        except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError, np.linalg.LinAlgError) as error:
            return {"raises": type(error).__name__}


def _short(number):
    """A fingerprint in as few characters as the tolerance allows, which is relative beyond 1."""
    if number == NOT_FINITE:
        return number
    short = round(number, DIGITS_WRONG - max(0, math.frexp(number)[1] * 3 // 10))
    return int(short) if short.is_integer() else short


def _without_noise(number):
    """An argument with all its digits: libraries that are strict about rotations take nothing less."""
    return number if abs(number) >= NOISE else 0.0


def _rounded(plain, digits=DIGITS):
    return _each_float(plain, lambda number: round(number, digits) + 0.0)


def _each_float(plain, changed):
    """Plain data with each float in it replaced by what `changed` makes of it."""
    if isinstance(plain, float):
        return changed(plain)
    if isinstance(plain, list):
        return [changed(item) if type(item) is float else _each_float(item, changed) for item in plain]
    if isinstance(plain, dict):
        return {name: _each_float(item, changed) for name, item in plain.items()}
    return plain
