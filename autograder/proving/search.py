"""Searches for a case that tells a wrong function from the right one.

Candidates are made from the exercise's own arguments: in place of one of them, or of several, what the generators of
`exercises.cases` make (axes along axes, half turns, turns that are almost none, what is near, far or zero); the same value
twice, or with its opposite; the cases that other seeds draw; and all of this combined anew. What is true of all of the
exercise's own arguments (a unit vector, a rotation, two axes at right angles) has to be true of these, too, and all solutions
that are known to be right have to agree on the answer: what remains is a question that the exercise may ask.
"""

import json
from dataclasses import replace
from inspect import Parameter, signature
from itertools import combinations, islice, permutations

import numpy as np
from transform_lab import Pose

from ..exercises import PUBLIC_SEED, Case, cases, key
from .adequacy import Cases, TooLong, bounded, quiet

OTHER_SEEDS = range(5000, 5008)
MOST = 3000  # candidates for one exercise
FARTHEST = 100  # times the largest number among the exercise's own arguments
FAMILY = "a name for this family of cases"


class Search:
    """The search for one exercise; candidates are made, and answered by the reference, once for all functions.

    known_right: other right solutions
    """

    def __init__(self, exercise, known_right=()):
        self.exercise, self.known_right = exercise, known_right
        self._candidates, self._answered = Candidates(exercise).all(), []

    def case_for(self, function):
        """A case, as code to paste, in which `function` is not right; None where none is found."""
        with quiet():
            for text, answered in self._all():
                if not _right(function, answered) and all(_right(right, answered) for right in self.known_right):
                    return text
        return None

    def _all(self):
        yield from self._answered
        for case in self._candidates:
            text = code(case)
            try:
                answered = answered_by_reference(self.exercise, text)
            except ValueError:  # the reference has no answer to it
                continue
            self._answered.append((text, answered))
            yield text, answered


def answered_by_reference(exercise, text):
    """A case, given as code, as the Cases of one."""
    case = eval(text, {"Case": Case, "np": np, "pose_of": cases.pose_of})
    return Cases(key(replace(exercise, cases=lambda rng: [case], misconceptions=()), PUBLIC_SEED))


def _right(function, answered):
    try:
        with bounded():
            return answered.refusing(function) is None
    except TooLong:
        return False


def code(case):
    """A case as an author writes it, with the digits that a key keeps."""
    args = ", ".join(map(_text, case.args)) + ("," if len(case.args) == 1 else "")
    named = ", ".join(f"{quoted(name)}: {_text(value)}" for name, value in case.kwargs.items())
    return f"Case({quoted(case.family)}, ({args}){f', {{{named}}}' if named else ''})"


def quoted(text):
    """Text as it stands in our code."""
    return json.dumps(text, ensure_ascii=False)


def code_of(exercise, seed, number):
    """A case that `seed` draws, as code."""
    return code(exercise.drawn(seed)[number])


def _text(value):
    if isinstance(value, np.ndarray):
        return f"np.array({_digits(value)})"
    if isinstance(value, Pose):
        return f"pose_of({_digits(cases.position(value))}, {_digits(cases.orientation(value))})"
    return repr(value.item() if isinstance(value, np.generic) else value)


def _digits(array):
    return (np.round(np.asarray(array, dtype=float), 12) + 0.0).tolist()


class Candidates:
    """Cases that the exercise might have, made from those that it has; arguments are {parameter: value}.

    A parameter with a star has a tuple of values.
    """

    def __init__(self, exercise):
        self.parameters = signature(exercise.reference).parameters
        self.rng = np.random.default_rng(PUBLIC_SEED)
        self.own = [case for seed in (PUBLIC_SEED, *OTHER_SEEDS) for case in exercise.drawn(seed)]
        self.by_name = {name for case in self.own for name in case.kwargs}
        self.bound = [exercise.bound(case.args, case.kwargs) for case in self.own]
        true = [_true_of(arguments) for arguments in self.bound]
        self.promised = {
            what
            for what in set().union(*true)
            if all(what in each for each, arguments in zip(true, self.bound) if what[0] <= arguments.keys())
        }
        self.reach = FARTHEST * max([1.0, *(_size(value) for each in self.bound for value in _values(each))])
        self.rotations = _rotations(self.rng)
        self.vectors = _vectors(self.rng)
        self.pools = {name: self._pool(name) for name in self.parameters}

    def all(self):
        """At most MOST of them, simple ones first."""
        yield from islice(self._proposed(), MOST)

    def _proposed(self):
        simple = sorted(self.bound, key=lambda arguments: sum(len(_text(value)) for value in _values(arguments)))[:40:8]
        for arguments in (*self._one_changed(simple), *self._alike(simple), *self._at_right_angles(simple)):
            if self._may_be_asked(arguments):
                yield self._case(arguments)
        yield from self.own
        while self.parameters:
            arguments = self._combined()
            if self._may_be_asked(arguments):
                yield self._case(arguments)

    def _one_changed(self, simple):
        for base in simple:
            for name, pool in self.pools.items():
                yield from (base | {name: value} for value in pool)

    def _alike(self, simple):
        """The same value, or its opposite, for two parameters of a kind."""
        for base in simple:
            for one, other in permutations(base, 2):
                yield base | {one: base[other]}
                yield from (base | {one: opposite} for opposite in _opposites(base[other]))

    def _at_right_angles(self, simple):
        """Axes of one frame, for parameters that are at right angles."""
        names = sorted(set().union(*(names for names, what in self.promised if what == "at right angles")))
        for R in self.rotations if names else ():
            yield simple[0] | {name: R[:, index] for index, name in enumerate(names[:3])}

    def _combined(self):
        arguments = dict(self.bound[self.rng.integers(len(self.bound))])
        for name, pool in self.pools.items():
            choice = self.rng.integers(4)
            if choice == 0 and pool:
                arguments[name] = pool[self.rng.integers(len(pool))]
            elif choice == 1:
                arguments |= {name: value for value in [self._any_own(name)] if value is not None}
            elif choice == 2 and self.parameters[name].default is not Parameter.empty:
                arguments.pop(name, None)
        return {name: arguments[name] for name in self.parameters if name in arguments}

    def _any_own(self, name):
        return self.bound[self.rng.integers(len(self.bound))].get(name)

    def _pool(self, name):
        """Values that the parameter might have."""
        examples = [each[name] for each in self.bound if name in each] or [self.parameters[name].default]
        if self.parameters[name].kind is not Parameter.VAR_POSITIONAL:
            return self._of_kind(examples[0])
        single = self._of_kind(examples[0][0]) if examples[0] else []
        few, many = min(map(len, examples)), max(map(len, examples)) + 1
        starts = [0, 5, *self.rng.integers(len(single), size=20)] if single else []
        return [tuple(np.roll(single, -start, axis=0)[:count]) for start in starts for count in range(few, many + 1)]

    def _of_kind(self, value):
        shape = value.shape if isinstance(value, np.ndarray) else None
        some = [(R, self.vectors[index % len(self.vectors)]) for index, R in enumerate(self.rotations)]
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            return [0, 1, -1, 2, 0.5, -0.5, 0.1, 10, 30, 45, 90, -90, 180, -180, 270, 360, 720, 1e-3, -1e-3, 123.4]
        if shape == (3,):
            return [*self.vectors, *(R[:, 0] for R in self.rotations)]
        if shape == (4,):
            return [sign * cases.quaternion(R) for R in self.rotations for sign in (1.0, -1.0)]
        if shape == (3, 3):
            return [*self.rotations, *_no_rotations(self.rotations)]
        if shape == (4, 4):
            return [cases.transform(R, p) for R, p in some]
        if isinstance(value, Pose):
            return cases.either_sign(cases.pose(R, p) for R, p in some)
        return []

    def _may_be_asked(self, arguments):
        true = _true_of(arguments)
        kept = all(what in true for what in self.promised if what[0] <= arguments.keys())
        return kept and all(_size(value) <= self.reach for value in _values(arguments))

    def _case(self, arguments):
        args, kwargs = [], {}
        for name, parameter in self.parameters.items():
            if parameter.kind is Parameter.VAR_POSITIONAL:
                args += arguments.get(name, ())
            elif name in arguments and (kwargs or name in self.by_name or parameter.kind is Parameter.KEYWORD_ONLY):
                kwargs[name] = arguments[name]
            elif name in arguments:
                args.append(arguments[name])
        return Case(FAMILY, tuple(args), kwargs)


def _values(arguments):
    for value in arguments.values():
        yield from value if isinstance(value, tuple) else (value,)


def _size(value):
    """The largest number in a value."""
    if isinstance(value, Pose):
        value = cases.position(value)
    return float(np.abs(value).max(initial=0)) if isinstance(value, (int, float, np.ndarray)) else 0.0


def _true_of(arguments):
    """What is true of arguments, as {(parameters, what)}; of a tuple, what is true of each in it."""
    found = set()
    for name, value in arguments.items():
        each = [_kinds(one) for one in (value if isinstance(value, tuple) else (value,))]
        found |= {(frozenset([name]), what) for what in set.intersection(*each)} if each else set()
    for (one, first), (other, second) in combinations(arguments.items(), 2):
        if np.shape(first) == np.shape(second) == (3,) and abs(np.dot(first, second)) < 1e-9:
            found.add((frozenset([one, other]), "at right angles"))
    return found


def _kinds(value):
    if isinstance(value, (bool, np.bool_)):
        return {"truth"}
    if isinstance(value, (int, float)):
        return {"number"}
    if isinstance(value, Pose):
        return {"Pose", *(["unit quaternion"] if _is_unit(cases.orientation(value)) else [])}
    if not isinstance(value, np.ndarray):
        return {type(value).__name__}
    found = {f"array of shape {value.shape}"}
    if value.ndim == 1:
        found |= {"unit"} if _is_unit(value) else set()
    elif value.shape in ((3, 3), (4, 4)):
        R = value[:3, :3]
        if np.abs(R.T @ R - np.eye(3)).max() < 1e-9 and np.linalg.det(R) > 0:
            found.add("rotation")
        if value.shape == (4, 4) and np.array_equal(value[3], (0, 0, 0, 1)):
            found.add("bottom row 0, 0, 0, 1")
    return found


def _is_unit(values):
    return abs(np.linalg.norm(values) - 1) < 1e-7  # some are written with eight digits


def _opposites(value):
    """What undoes a value, and what points the other way."""
    if isinstance(value, (int, float)):
        return [-value]
    if not isinstance(value, np.ndarray):
        return []
    if value.ndim == 1:
        return [-value, *([value * (-1, -1, -1, 1)] if len(value) == 4 else [])]
    return [np.linalg.inv(value)] if value.shape in ((3, 3), (4, 4)) and np.linalg.det(value) else []


def _rotations(rng):
    return [
        *cases.signed_permutations(),
        *(cases.half_turn(rng, largest) for largest in (0, 1, 2)),
        *(cases.rotation_about(axis, angle) for axis in np.eye(3) for angle in np.radians([30, -45, 120])),
        *cases.small_turns(rng),
        *cases.almost_half_turns(rng),
        cases.half_turn_to_rounding(rng),
        *cases.half_turns_about_almost_an_axis(),
        *(cases.wide_turn(rng, largest) for largest in (0, 1, 2)),
        *(cases.tilt(rng) for _ in range(5)),
        *(cases.rotation(rng) for _ in range(10)),
    ]


def _vectors(rng):
    return [
        np.array([0.3, -0.6, 0.9]),
        np.zeros(3),
        *np.eye(3),
        *-np.eye(3),
        np.array([1.0, 2.0, 3.0]),
        np.array([-0.01, 0.02, 0.03]),
        np.array([50.0, -20.0, 30.0]),
        *(cases.vector(rng) for _ in range(3)),
        *cases.near(rng),
        *cases.far(rng)[:1],
    ]


def _no_rotations(rotations):
    """Matrices that are none, in ways that are easily overlooked."""
    for R in (rotations[0], *rotations[24:27], *rotations[-3:]):
        yield from (R * signs for signs in ((1, 1, -1), (-1, 1, 1), (-1, -1, -1)))
        yield from (factor * R for factor in (0.0, 0.5, 2.0, 1.01))
        yield from (R + size * np.eye(3)[[0, 2, 1]] for size in (1.0, 1e-2, 1e-4))
        yield R @ np.diag([2.0, 0.5, 1.0])
        yield R @ np.array([[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
        yield R[:, [1, 0, 2]]
        yield R[:, [0, 0, 2]]
