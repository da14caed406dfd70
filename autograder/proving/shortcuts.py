"""Shortcuts, generated from what arguments can be measured by: answers that are right but beyond some threshold.

Students save themselves a case, a copy or a digit: what is small is taken for zero, a tolerance is ten times too wide, an
array keeps the type of the first argument, one message is filled in again and again. `mutants` changes what a function says,
this what it passes over.
"""

from inspect import Parameter, signature

import numpy as np
from transform_lab import Pose
from transform_lab.judging.answers import parts_of
from transform_lab.judging.kinds import KINDS, TOLERANCE

from ..exercises import PUBLIC_SEED, cases

THRESHOLDS = [10.0**decade for decade in range(-5, 1)]  # below them a measure is dropped,
CEILINGS = [10.0**decade for decade in range(1, 4)]  # above these
TOLERANCES = (0.01, 0.1, 10, 100)  # times the right one
DECIMALS = range(1, 6)
PARTS = {"transform": ("rotation", "translation"), "pose": ("position", "orientation")}  # of answers that have several


def shortcuts(exercise):
    """{what is done: a function that does it}"""
    found = {}
    for feature in exercise.features:
        found |= _beyond_thresholds(exercise, feature)
    found |= _in_another_type(exercise) | _answers(exercise) | _same_objects(exercise)
    if exercise.differences:
        found |= _comparisons(exercise)
    return found


def _beyond_thresholds(exercise, feature):
    """The answers to arguments whose small (or large) values are taken for something simpler; in one part alone, too."""
    found = {}
    if feature.dropped is None:
        return found
    felt = _felt_in(exercise, feature)
    for low, high, told in _limits(feature):

        def answer(arguments, low=low, high=high):
            return _call(exercise, feature.without(arguments, low, high))

        label = f"{feature.name} {told}, taken for {feature.taken_for}"
        found |= _wholly_and_in_parts(exercise, label, answer, felt)
    return found


def _limits(feature):
    """[(lowest, highest measure that is dropped, what this is in words)]"""
    reach = [limits for name, limits in feature.bands.items() if name.startswith("1e")]
    if not reach:  # a sign
        return [(-np.inf, 0.0, "negative")]
    lowest, highest = reach[0][0], reach[-1][1]
    below = [(0.0, limit, f"below {limit:g}") for limit in THRESHOLDS if lowest < limit < highest]
    return below + [(limit, np.inf, f"above {limit:g}") for limit in CEILINGS if lowest < limit < highest]


def _felt_in(exercise, feature):
    """The parts of the answer that hang on what the feature measures; none when there is but one part."""
    parts = PARTS.get(exercise.returns, ())
    felt = set()
    for case in exercise.drawn(PUBLIC_SEED) if feature.in_parts else ():
        right = parts_of(exercise.returns, exercise.reference(*case.args, **case.kwargs))
        without = feature.without(exercise.bound(case.args, case.kwargs), -np.inf, np.inf)
        wrong = parts_of(exercise.returns, _call(exercise, without))
        felt |= {part for part in parts if not KINDS[exercise.returns].parts[part].agree(wrong[part], right[part])}
    return [part for part in parts if part in felt] if len(felt) > 1 else []


def _wholly_and_in_parts(exercise, label, answer, parts):
    """A wrong answer as it is, and with all parts but one put right."""

    def wholly(*args, **kwargs):
        return answer(exercise.bound(args, kwargs))

    def in_part(part):
        return lambda *args, **kwargs: _mixed(exercise.reference(*args, **kwargs), wholly(*args, **kwargs), part)

    return {label: wholly} | {f"{label} (in the {part} alone)": in_part(part) for part in parts}


def _mixed(right, wrong, part):
    """The right answer, with this part of a wrong one."""
    if isinstance(right, Pose):
        setattr(right, part, getattr(wrong, part))
        return right
    rows_and_columns = (slice(3), slice(3) if part == "rotation" else 3)
    mixed = right.copy()
    mixed[rows_and_columns] = wrong[rows_and_columns]
    return mixed


def _in_another_type(exercise):
    """The answer in the integers of one argument, or in single precision."""

    def kept(name):
        def answer(*args, **kwargs):
            given, right = exercise.bound(args, kwargs).get(name), exercise.reference(*args, **kwargs)
            first = given[0] if isinstance(given, tuple) else given
            return _each_number(right, np.trunc) if cases.is_whole(first) else right

        return answer

    def single(*args, **kwargs):
        args, kwargs = [_single(arg) for arg in args], {name: _single(arg) for name, arg in kwargs.items()}
        return _each_number(exercise.reference(*args, **kwargs), np.float32)

    names = list(signature(exercise.reference).parameters)
    types = {f"the answer in the type of {name}": kept(name) for name in names if exercise.returns != "truth"}
    return types | ({"all in single precision": single} if names else {})


def _answers(exercise):
    """Right answers, rounded, or with what is small set to zero."""
    if exercise.returns == "truth" or not signature(exercise.reference).parameters:
        return {}

    def rounded(decimals):
        return lambda *args, **kwargs: _each_number(
            exercise.reference(*args, **kwargs), lambda n: np.round(n, decimals)
        )

    def cleaned(limit):
        return lambda *args, **kwargs: _each_number(
            exercise.reference(*args, **kwargs), lambda n: np.where(np.abs(n) < limit, 0.0, n)
        )

    return {f"the answer rounded to {decimals} decimals": rounded(decimals) for decimals in DECIMALS} | {
        f"numbers of the answer below {limit:g} taken for 0": cleaned(limit) for limit in THRESHOLDS[:-1]
    }


def _same_objects(exercise):
    """One object handed out by every call, and an argument handed back where the answer has the same numbers."""
    found = {}
    if exercise.returns == "truth" or not signature(exercise.reference).parameters:
        return found

    def one_for_all():
        kept = []

        def answer(*args, **kwargs):
            right = exercise.reference(*args, **kwargs)
            if not kept:
                kept.append(right)
            if isinstance(right, Pose):
                kept[0].position, kept[0].orientation = right.position, right.orientation
            else:
                kept[0][...] = right
            return kept[0]

        return answer

    found["one object is the answer to every call"] = one_for_all()
    public = exercise.drawn(PUBLIC_SEED)
    if KINDS[exercise.returns].new and any(isinstance(arg, Pose) for case in public for arg in case.args):

        def handed_back(*args, **kwargs):
            right = exercise.reference(*args, **kwargs)
            return next((arg for arg in args if isinstance(arg, Pose) and _equal(arg, right)), right)

        found["an argument is the answer where it has the same numbers"] = handed_back
    return found


def _comparisons(exercise):
    """What a predicate compares, with another tolerance, one way only, or not at all; see Exercise.differences."""
    alternatives, _ = exercise.differences(*exercise.drawn(PUBLIC_SEED)[0].args)
    numbers = len(alternatives[0])

    def with_test(test, which=slice(None)):
        def answer(*args, **kwargs):
            alternatives, rest = exercise.differences(*args, **kwargs)
            return bool(rest and any(test(np.asarray(differences)) for differences in alternatives[which]))

        return answer

    def within(tolerances):
        return lambda differences: np.all(np.abs(differences) <= tolerances)

    found = {
        f"the tolerance is {factor * TOLERANCE:g}": with_test(within(factor * TOLERANCE)) for factor in TOLERANCES
    } | {
        "only what is too large is seen": with_test(lambda differences: np.all(differences <= TOLERANCE)),
        "only what is too small is seen": with_test(lambda differences: np.all(differences >= -TOLERANCE)),
        "the differences are added": with_test(lambda differences: abs(np.sum(differences)) <= TOLERANCE),
        "their squares are compared with the tolerance": with_test(
            lambda differences: np.sum(differences**2) <= TOLERANCE
        ),
        "the smallest of them is compared": with_test(lambda differences: np.min(np.abs(differences)) <= TOLERANCE),
    }
    for number in range(numbers):
        for factor in (*TOLERANCES, np.inf):
            tolerances = np.full(numbers, TOLERANCE)
            tolerances[number] *= factor
            found[f"difference {number + 1} is compared with {tolerances[number]:g}"] = with_test(within(tolerances))
    for index in range(len(alternatives) if len(alternatives) > 1 else 0):
        found[f"alternative {index + 1} alone"] = with_test(within(TOLERANCE), slice(index, index + 1))
    return found


def _call(exercise, arguments):
    """The reference's answer to {parameter: value}."""
    args, kwargs = [], {}
    for name, parameter in signature(exercise.reference).parameters.items():
        if parameter.kind is Parameter.VAR_POSITIONAL:
            args += arguments[name]
        elif name in arguments:
            kwargs[name] = arguments[name]
    return exercise.reference(*args, **kwargs)


def _single(value):
    if isinstance(value, (np.ndarray, Pose)):
        return _each_number(value, np.float32)
    return float(np.float32(value)) if isinstance(value, float) else value


def _each_number(value, change):
    """An array, or a Pose, with `change` made of its numbers."""
    if isinstance(value, Pose):
        return cases.pose_of(change(cases.position(value)), change(cases.orientation(value)))
    return change(value) if isinstance(value, np.ndarray) else value


def _equal(one, other):
    parts = KINDS["pose"].parts
    first, second = parts_of("pose", one), parts_of("pose", other)
    return all(part.agree(first[name], second[name]) for name, part in parts.items())
