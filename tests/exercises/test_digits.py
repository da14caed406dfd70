"""Arguments have all their digits, and nothing that is told of a wrong answer hangs on the last of them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from support import SEEDS, key_of
from transform_lab.judging import codec
from transform_lab.judging.kinds import KINDS

from autograder.exercises import EXERCISES
from autograder.exercises.specification import NOISE, Case, key
from autograder.proving.adequacy import quiet

STRICT = 20 * np.finfo(float).eps  # the strictest library there is takes no rotation that is farther off
NEARLY_WHOLE = 8  # characters of a number that somebody typed; a computed one has more


def floats(plain):
    """All floats in plain data."""
    if isinstance(plain, dict):
        plain = list(plain.values())
    if isinstance(plain, (list, tuple)):
        return [number for item in plain for number in floats(item)]
    return [plain] if isinstance(plain, float) else []


def each(value, changed):
    """A decoded argument with each of its floats changed."""
    if isinstance(value, float):
        return changed(value)
    if isinstance(value, np.ndarray):
        return value if value.dtype.kind == "i" else np.vectorize(changed, otypes=[float])(value)
    if hasattr(value, "__dataclass_fields__"):
        return type(value)(*(each(getattr(value, name), changed) for name in value.__dataclass_fields__))
    return value


def next_double(number):
    """Its neighbour, this side or that: the same for the same number, and the negative one for its negative."""
    if number == 0 or len(repr(abs(number))) <= NEARLY_WHOLE:
        return number
    away = math.frexp(number)[0].hex()[-2] in "02468ace"
    return math.copysign(np.nextafter(abs(number), math.inf if away else 0.0), number)


def rotations_and_quaternions(value):
    if isinstance(value, np.ndarray) and value.ndim == 2:
        return [value[:3, :3]], []
    if hasattr(value, "orientation"):
        q = value.orientation
        return [], [np.array([q.x, q.y, q.z, q.w])]
    return [], [value] if isinstance(value, np.ndarray) and value.shape == (4,) else []


@pytest.mark.parametrize("seed", SEEDS[:3])
@pytest.mark.parametrize("name", [name for name in EXERCISES if name != "is_rotation"])
def test_rotations_are_rotations_to_rounding(name, seed):
    for case in key_of(name, seed)["cases"]:
        for plain in (*case["args"], *case["kwargs"].values()):
            matrices, quaternions = rotations_and_quaternions(codec.decode(plain))
            for R in matrices:
                assert np.linalg.norm(R @ R.T - np.eye(3)) < STRICT and np.linalg.det(R) > 0
            for q in quaternions:
                assert abs(np.linalg.norm(q) - 1.0) < STRICT


@pytest.mark.parametrize("name", EXERCISES)
def test_arguments_are_what_was_drawn(name):
    exercise = EXERCISES[name]
    drawn = [[*case.args, *case.kwargs.values()] for case in exercise.drawn(SEEDS[0])]
    for case, values in zip(key_of(name, SEEDS[0])["cases"], drawn, strict=True):
        given = floats([*case["args"], *case["kwargs"].values()])
        wanted = floats([codec.encode(value) for value in values])
        assert all(one == other or one == 0.0 and abs(other) < NOISE for one, other in zip(given, wanted, strict=True))


@pytest.mark.parametrize("name", EXERCISES)
def test_no_misconception_hangs_on_the_last_digit(name, thorough):
    exercise, different = EXERCISES[name], set()
    with quiet():
        for seed in SEEDS[: 3 if thorough else 1]:
            cases = [
                Case(
                    case.family,
                    tuple(each(value, next_double) for value in case.args),
                    {given: each(value, next_double) for given, value in case.kwargs.items()},
                )
                for case in exercise.drawn(seed)
            ]
            nudged = key(replace(exercise, cases=lambda draws, cases=cases: cases), seed)
            for case, other in zip(key_of(name, seed)["cases"], nudged["cases"], strict=True):
                for misconception, *told in zip(exercise.misconceptions, case["wrong"], other["wrong"], strict=True):
                    if not told_alike(exercise, *told):
                        number = exercise.misconceptions.index(misconception)
                        different.add((misconception.id, number, case["family"], str(told)))
    assert not different, "\n".join(map(str, sorted(different)))


def told_alike(exercise, one, other):
    """Whether the key tells the same of two answers; what it leaves open is like anything."""
    parts = KINDS[exercise.returns].parts
    left_open = [name for told in (one, other) if isinstance(told, dict) for name in told.get("any", ())]
    if left_open:
        return set(left_open) == set(parts) or one == other
    if not (isinstance(one, list) and isinstance(other, list)):
        return one == other
    return all(
        a == b or isinstance(a, (int, float)) and isinstance(b, (int, float))
        # rounded to seven digits, and of a quaternion or its negative
        and any(math.isclose(sign * a, b, rel_tol=2e-6, abs_tol=2e-6) for sign in ((1, -1) if part.quaternion else (1,)))
        for part, a, b in zip(parts.values(), one, other, strict=True)
    )  # fmt: skip
