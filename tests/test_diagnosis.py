"""A misconception is named when it alone explains the answers, two when each explains a part, and else none."""

from itertools import product

import numpy as np
import pytest
from mutants import mutants
from scipy.spatial.transform import Rotation
from solutions.wrong import WRONG
from test_exercises import NAMES, SEEDS, judged, poses
from transform_lab import Point, Pose, Quaternion
from transform_lab.answers import PARTS, agree, matrix_of, parts_of
from transform_lab.diagnosis import GENERAL
from transform_lab.verdict import Reply, examine

from autograder.exercises import EXERCISES, PUBLIC_SEED

every_exercise = pytest.mark.parametrize("name", NAMES)
MATRICES_AND_POSES = [name for name in NAMES if len(PARTS[EXERCISES[name].returns]) > 1]


def split(name, answer):
    return parts_of(EXERCISES[name].returns, answer)


def joined(name, parts):
    """An answer of these parts."""
    if EXERCISES[name].returns == "pose":
        return Pose(Point(*parts["position"]), Quaternion(*parts["orientation"]))
    return matrix_of(parts)


# --- one name -------------------------------------------------------------------------------------------------------


@every_exercise
def test_the_name_does_not_hang_on_the_cases(name):
    """Whatever a wrong program is called on some cases, it is called on others."""
    with np.errstate(all="ignore"):
        for what, mutant in mutants(EXERCISES[name].reference, "autograder.exercises"):
            called = {judged(name, mutant, seed).misconceptions for seed in SEEDS[:3]}
            assert len(called) == 1 or called <= {(), *((identifier,) for identifier in GENERAL)}, what


@every_exercise
def test_noise_gets_no_name(name):
    """Right answers with something added that no misconception explains."""
    exercise, rng = EXERCISES[name], np.random.default_rng(5)
    for size, seed in product((1e-5, 1e-2, 1.0), SEEDS):
        offset, turn = size * rng.uniform(0.3, 1.0, size=3), Rotation.from_rotvec(size * rng.uniform(0.3, 1.0, size=3))

        def noisy(*args, **kwargs):
            answer = exercise.reference(*args, **kwargs)
            if exercise.returns == "truth":
                return bool(rng.integers(2))
            parts = split(name, answer)
            for part, value in parts.items():
                if part == "rotation":
                    parts[part] = turn.as_matrix() @ value
                elif part == "orientation":
                    parts[part] = (turn * Rotation.from_quat(value)).as_quat()
                elif part != "bottom row":
                    parts[part] = value + offset
            return joined(name, parts) if len(parts) > 1 else next(iter(parts.values()))

        verdict = judged(name, noisy, seed)
        assert (verdict.right, verdict.misconceptions) == (False, ())


def test_no_name_when_two_fit():
    """A case on which two misconceptions agree does not tell them apart."""
    exercise = {
        "parameters": ["R"], "returns": "truth", "answer": "", "credit": {}, "weights": {"a case": 1},
        "misconceptions": [{"id": name, "says": name, "hint": name} for name in ("one", "two")],
        "cases": [{"family": "a case", "args": [n], "kwargs": {}, "expected": n > 0, "wrong": [True, True]}
                  for n in (-1, -2)],
    }  # fmt: skip

    def call(args, kwargs):
        return Reply("returned", True, [args, kwargs])

    assert examine("is_rotation", exercise, call).misconceptions == ("hard-coded",)
    exercise["cases"].append({"family": "a case", "args": [3], "kwargs": {}, "expected": False, "wrong": [True, None]})
    assert examine("is_rotation", exercise, lambda args, kwargs: Reply("returned", args[0] < 0, [args, kwargs])
                   ).misconceptions == ("two",)  # fmt: skip
    exercise["cases"][-1]["wrong"] = [None, None]
    assert examine("is_rotation", exercise, lambda args, kwargs: Reply("returned", args[0] < 0, [args, kwargs])
                   ).misconceptions == ()  # fmt: skip


def test_another_error_than_the_misconceptions_own_is_not_named():
    """The trace formula in plain Python divides by zero at a half turn; another error is another problem."""
    (wrong,) = (m.wrong for m in EXERCISES["transform_to_pose"].misconceptions if "plain_python" in _names(m.wrong))
    assert judged("transform_to_pose", wrong).misconceptions == ("trace-formula-only",)

    def otherwise(matrix):
        try:
            return wrong(matrix)
        except ZeroDivisionError:
            raise IndexError("of another kind") from None

    assert judged("transform_to_pose", otherwise).misconceptions == ()


def _names(function):
    return " ".join(cell.cell_contents.__name__ for cell in function.__closure__ or () if callable(cell.cell_contents))


@pytest.mark.parametrize("name, names, function", [pytest.param(*w, id=f"{w[0]}-{w[2].__name__}") for w in WRONG])
def test_what_students_wrote_gets_its_own_name_or_none(name, names, function):
    """The names are a teacher's who had not seen ours; where ours say the same in another word, that one is taken."""
    for seed in SEEDS[:3]:
        assert set(judged(name, function, seed).misconceptions) in (set(names), set())


def test_most_of_what_students_wrote_has_a_name():
    named = sum(bool(judged(name, function).misconceptions) for name, names, function in WRONG if names)
    expected = sum(bool(names) for _, names, _ in WRONG)
    print(f"{named} of {expected} wrong solutions that a teacher has a name for are named")
    assert named >= 0.9 * expected


# --- two mistakes at once -------------------------------------------------------------------------------------------


def of_one_part(name):
    """{part: [misconceptions that leave the other parts right]}"""
    exercise, found = EXERCISES[name], {}
    cases = exercise.cases(np.random.default_rng(PUBLIC_SEED))
    for misconception in exercise.misconceptions:
        changed = set()
        try:
            with np.errstate(all="ignore"):
                for case in cases:
                    right = split(name, exercise.reference(*case.args, **case.kwargs))
                    wrong = split(name, misconception.wrong(*case.args, **case.kwargs))
                    changed |= {part for part in right if not agree(part, wrong[part], right[part])}
        except (ValueError, ArithmeticError, LookupError, TypeError):
            continue  # it answers something of another kind, or nothing
        if len(changed) == 1:
            found.setdefault(changed.pop(), []).append(misconception)
    return found


@pytest.mark.parametrize("name", MATRICES_AND_POSES)
def test_two_mistakes_in_two_parts_are_both_named(name):
    first_part, second_part = PARTS[EXERCISES[name].returns][:2]
    candidates = of_one_part(name)
    pairs = list(product(candidates.get(first_part, []), candidates.get(second_part, [])))
    whole, right = {misconception.id for misconception in EXERCISES[name].misconceptions}, 0
    assert pairs
    for first, second in pairs:

        def both(*args, first=first, second=second, **kwargs):
            parts = split(name, second.wrong(*args, **kwargs))
            parts[first_part] = split(name, first.wrong(*args, **kwargs))[first_part]
            return joined(name, parts)

        verdict = judged(name, both)
        named = ";".join(verdict.misconceptions)
        if set(verdict.misconceptions) == {*first.id.split(";"), *second.id.split(";")}:
            right += 1
        else:  # the two are a misconception of their own, or a constant; or the second has two explanations
            assert not verdict.right and (named in whole or named in ("", "hard-coded")), (first.id, second.id, named)
    print(f"{name}: {right} of {len(pairs)} pairs are called by both names")
    assert right >= 0.6 * len(pairs)


@pytest.mark.parametrize("name", poses())
def test_a_quaternion_of_another_length_beside_another_mistake(name):
    def wrong(*args, **kwargs):
        parts = split(name, EXERCISES[name].reference(*args, **kwargs))
        return joined(name, {"position": parts["position"], "orientation": 2.0 * parts["orientation"]})

    def doubly_wrong(*args, **kwargs):
        answer = wrong(*args, **kwargs)
        answer.position = Point(0, 0, 0)
        return answer

    assert judged(name, wrong).misconceptions == ("not-normalised",)
    if name in ("transform_to_pose", "transform_pose"):  # elsewhere 0, 0, 0 is no way to get the position wrong
        assert judged(name, doubly_wrong).misconceptions == ("not-normalised", "position-missing")


@pytest.mark.parametrize("name", [name for name in NAMES if EXERCISES[name].returns != "truth"])
def test_rounded_answers_are_named(name):
    def rounding(decimals):
        def rounded(*args, **kwargs):
            answer = EXERCISES[name].reference(*args, **kwargs)
            if EXERCISES[name].returns == "pose":
                return joined(name, {part: value.round(decimals) for part, value in split(name, answer).items()})
            return np.round(answer, decimals)

        return rounded

    for decimals in (2, 3, 5):
        verdict = judged(name, rounding(decimals))
        if not verdict.right:  # as in those exercises that have no decimals
            assert verdict.misconceptions == ("rounded",)
