"""Calls everything that is to be tried on the cases of many seeds, and says what must not be."""

import logging
import os
import signal
import threading
import warnings
from collections import Counter
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass, field, replace

import numpy as np
from transform_lab.judging import codec
from transform_lab.judging.answers import is_right, parts_of
from transform_lab.judging.calling import reply, same_object
from transform_lab.judging.kinds import KINDS
from transform_lab.judging.verdict import examine

from ..exercises import PUBLIC_SEED, key
from ..exercises.specification import Arguments, order_of

NAMED_EVERY = 10  # seeds: what a misconception is called is asked for on each tenth, for it costs all the cases
LONGEST = 1.0  # seconds of processor time for the cases of one seed: a mutant's loop may have no end
LONGEST_RIGHT = 60.0  # for what has to be right, which nobody may cut short because a machine is slow


def seeds(number):
    """The seed of the public cases, and others that hidden cases are drawn from: `number` in all."""
    return (PUBLIC_SEED, *range(1000, 1000 + number - 1))


@dataclass
class Found:
    """What became of one function."""

    accepted: list = field(default_factory=list)  # seeds on all of whose cases it is right
    refused: dict = field(
        default_factory=dict
    )  # {seed: the number, in the specification, of a case in which it is not}
    called: Counter = field(default_factory=Counter)  # {misconceptions that it was called: number of seeds}

    def __iadd__(self, other):
        self.accepted += other.accepted
        self.refused |= other.refused
        self.called += other.called
        return self


class Cases:
    """The cases of a key, ready to be called with: arguments and right answers are decoded once for all functions."""

    def __init__(self, drawn):
        self.returns, self.plain = drawn["returns"], drawn["cases"]
        self.arguments = [Arguments(case["args"], case["kwargs"]) for case in self.plain]
        self.right = [parts_of(self.returns, codec.decode(case["expected"])) for case in self.plain]

    def passes(self, function, number):
        """Whether a function is right in one case: what `verdict.compare` says of `check.call`, without the words."""
        args, kwargs = self.arguments[number].fresh()
        try:
            answer = function(*args, **kwargs)
        except Exception:
            return False
        same = same_object(function, answer, codec.encode(answer), [*args, *kwargs.values()])
        return (
            is_right(self.returns, _as_sent(answer), self.right[number])
            and KINDS[self.returns].own(same)
            and self.arguments[number].are(args, kwargs)
        )

    def refusing(self, function, likely=0):
        """The number of a case in which a function is not right, or None; the case `likely` is tried first."""
        if 0 < likely < len(self.plain) and not self.passes(function, likely):
            return likely
        return next((number for number in range(len(self.plain)) if not self.passes(function, number)), None)


def measure(exercise, tried, seeds, named=()):
    """A Found for each of the functions that are tried, on the cases of `seeds`; names are asked for on those of `named`."""
    found = [Found() for _ in tried]
    likely = [0] * len(
        tried
    )  # the case (by its number in the specification) that refused it last: mostly it does again
    endless = set()  # what did not come to its end on one seed is not called again
    with quiet():
        for seed in seeds:
            drawn = key(exercise if seed in named else replace(exercise, misconceptions=()), seed)
            cases, order = Cases(drawn), order_of(len(drawn["cases"]), seed)
            for index, each in enumerate(tried):
                number = order.index(likely[index])
                if index not in endless:
                    try:
                        with bounded(LONGEST_RIGHT if each.right else LONGEST):
                            number = cases.refusing(each.fresh(), 0 if each.kind == "cheat" else number)
                    except TooLong:
                        endless.add(index)
                if number is None:
                    found[index].accepted.append(seed)
                else:
                    found[index].refused[seed] = likely[index] = order[number]
                if each.misconception and seed in named:
                    found[index].called[_called(exercise.name, drawn, cases, each.function)] += 1
    return found


def slips_through(each, found):
    """Whether something wrong is right in all the cases of some seed; cheats know the public ones."""
    return not each.right and bool(set(found.accepted) - ({PUBLIC_SEED} if each.kind == "cheat" else set()))


def refused(each, found):
    """Whether something right is not."""
    return each.right and bool(found.refused)


def misnamed(each, found):
    """Whether a misconception is called anything else than its own id alone."""
    return any(called != tuple(each.misconception.split(";")) for called in found.called)


def _called(name, drawn, cases, function):
    """The misconceptions that the judge calls a function."""
    arguments = iter(cases.arguments)
    return examine(name, drawn, lambda args, kwargs: reply(function, *next(arguments).fresh())).misconceptions


def _as_sent(answer):
    """An answer as the judge gets it from another process; most are the same there."""
    if type(answer) is bool or type(answer) is np.ndarray and answer.dtype == np.float64 and 1 <= answer.ndim <= 2:
        return answer
    return codec.decode(codec.encode(answer))


@contextmanager
def quiet():
    """A block in which students' functions may print, warn, log and divide by zero unheard."""
    before = logging.root.manager.disable
    logging.disable()
    try:
        with open(os.devnull, "w") as nowhere, redirect_stdout(nowhere), redirect_stderr(nowhere):
            with warnings.catch_warnings(), np.errstate(all="ignore"):
                warnings.simplefilter("ignore")
                yield
    finally:
        logging.disable(before)


class TooLong(BaseException):  # no Exception, which a function might catch
    """A function did not come to its end."""


@contextmanager
def bounded(seconds=LONGEST):
    """A block that raises TooLong after so much processor time."""

    def stop(*_):
        raise TooLong

    if threading.current_thread() is not threading.main_thread():  # which alone can set a signal's handler
        yield
        return
    before = signal.signal(signal.SIGVTALRM, stop)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        signal.signal(signal.SIGVTALRM, before)
