"""A misconception is named when it alone explains the answers, two when each explains a part, and else none."""

import math
import re
from itertools import product

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from solutions.wrong import WRONG
from support import SEEDS, judged, key_of
from transform_lab import Point, Pose, Quaternion
from transform_lab.judging import codec
from transform_lab.judging.answers import parts_of
from transform_lab.judging.kinds import KINDS, matrix_of
from transform_lab.judging.naming import GENERAL
from transform_lab.judging.verdict import Reply, examine

from autograder.exercises import EXERCISES, PUBLIC_SEED
from autograder.proving.mutants import mutants

every_exercise = pytest.mark.parametrize("name", EXERCISES)
MATRICES_AND_POSES = [name for name in EXERCISES if len(KINDS[EXERCISES[name].returns].parts) > 1]


def split(name, answer):
    return parts_of(EXERCISES[name].returns, answer)


def joined(name, parts):
    """An answer of these parts."""
    if EXERCISES[name].returns == "pose":
        return Pose(Point(*parts["position"]), Quaternion(*parts["orientation"]))
    return matrix_of(parts)


# --- one name -------------------------------------------------------------------------------------------------------


@every_exercise
def test_the_name_does_not_hang_on_the_cases(name, thorough):
    """Whatever a wrong program is called on some cases, it is called on others."""
    with np.errstate(all="ignore"):
        for mutant in mutants(EXERCISES[name].reference, "autograder.exercises")[:: 1 if thorough else 10]:
            called = {judged(name, mutant.function, seed).misconceptions for seed in SEEDS[:3]}
            assert len(called) == 1 or called <= {(), *((identifier,) for identifier in GENERAL)}, mutant.what


@every_exercise
def test_noise_gets_no_name(name, thorough):
    """Right answers with something added that no misconception explains."""
    exercise, rng = EXERCISES[name], np.random.default_rng(5)
    for size, seed in product((1e-5, 1e-2, 1.0), SEEDS if thorough else SEEDS[:2]):
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


TRUE = [KINDS["truth"].parts["answer"].fingerprint(np.array(1.0))]  # a misconception's answer, as the key has it


def test_no_name_when_two_fit():
    """A case on which two misconceptions agree does not tell them apart."""
    exercise = {
        "parameters": ["R"], "returns": "truth", "answer": "", "credit": {}, "weights": {"a case": 1},
        "misconceptions": [{"id": name, "says": name, "hint": name} for name in ("one", "two")],
        "cases": [{"family": "a case", "args": [n], "kwargs": {}, "expected": n > 0, "wrong": [TRUE, TRUE]}
                  for n in (-1, -2)],
    }  # fmt: skip

    def call(args, kwargs):
        return Reply("returned", True, [args, kwargs])

    assert examine("is_rotation", exercise, call).misconceptions == ("hard-coded",)
    exercise["cases"].append({"family": "a case", "args": [3], "kwargs": {}, "expected": False, "wrong": [TRUE, None]})
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

    assert judged("transform_to_pose", otherwise).misconceptions == ("half-turn-missed",)  # no more than where it fails


def _names(function):
    return " ".join(cell.cell_contents.__name__ for cell in function.__closure__ or () if callable(cell.cell_contents))


# The names in solutions/wrong.py are a teacher's, who had not seen ours. Ours, where they are other words for the same:
SYNONYMS = {
    "both-transforms-inverted": "wrong-transform-inverted",
    "component-signs-ignored": "component-signs-dropped",
    "gripper-ignored": "transform-left-out",
    "half-angle-missing": "angle-not-halved",
    "offset-partly-used": "wrong-axis",
    "orthogonality-not-checked": "angles-ignored",
    "sum-instead-of-product": "added-not-multiplied",
    "towards-base-origin": "towards-the-base",
    "transforms-subtracted": "subtracted",
}
# …and where ours is another one, or the teacher had none: {why: {solution: what it is called}}
OTHERWISE = {
    "no more is to be seen of an answer of the wrong shape or kind": {
        "z_four_by_four": {"homogeneous-returned"},
        "z_euler_matrix_wrong_slot": {"wrong-shape"},
        "z_tft_degrees": {"wrong-shape"},
        "axes_rows_in_four": {"wrong-shape"},
        "point_four_zero": {"wrong-shape"},
        "point_transposed_four": {"wrong-shape"},
        "ttp_arrays_everywhere": {"wrong-type"},
    },
    "one of our names stands for both of the teacher's": {
        "hand_moves_along_y": {"wrong-axis"},
        "inv_go_back": {"rotation-not-inverted"},
        "isrot_star_no_det": {"elementwise-product"},
        "pg_plus_y": {"wrong-axis"},
        "rel_neither": {"inverse-missing"},
    },
    "another mistake gives the same numbers, and the answers cannot tell which it was": {
        "hand_rounded_to_int": {"position-missing"},
        "hand_rows_forward": {"wrong-direction"},
        "pg_pitch_sign": {"quaternion-order"},  # what the student reads names both
        "point_inverse_direction": {"order-reversed"},
        "point_whole_row_vector": {"order-reversed"},
        "tp_child_offset_forgotten": {"wrong-position"},
        "tp_offset_forgotten_w_first": {"wrong-position", "quaternion-order"},
        "ttp_bottom_row": {"position-missing"},
        "ttp_bottom_row_and_identity": {"hard-coded"},
        "wp_arrow": {"position-missing", "orientation-identity"},
        "wp_w_zero": {"position-missing"},
    },
    "a narrower name than the teacher's, or a wider one": {
        "axes_z_is_up": {"third-axis-assumed"},
        "oig_one_metre_ahead": {"coordinates-ignored"},
        "same_w_first_sign": {"half-turn-missed"},
        "z_both_sines_positive": {"wrong-sign"},
    },
    "a name where the teacher had none": {
        "chain_dot_star": {"input-mutated"},
        "chain_first_and_last": {"transforms-left-out"},
        "chain_first_two": {"transforms-left-out"},
        "chain_return_in_loop": {"transforms-left-out"},
        "chain_skips_last": {"transforms-left-out"},
        "chain_without_repeats": {"transforms-left-out"},
        "inv_rounded": {"rounded"},
        "inv_view_alias": {"rotation-not-inverted"},
        "isrot_signed_sum": {"errors-cancel"},
        "isrot_two_pairs": {"pair-not-compared"},
        "oig_rounded": {"rounded"},
        "ptt_abs_w": {"sign-ignored"},
        "ptt_swapped_yz": {"wrong-position"},
        "ptt_x_y_x": {"wrong-position"},
        "same_any": {"any-for-all"},
        "same_dot_loose": {"loose-comparison"},
        "same_flip_by_w": {"half-turn-missed"},
        "ttp_rounded": {"rounded"},
        "ttp_x_y_x": {"wrong-position"},
    },
}


def expected_names(names, function):
    for solutions in OTHERWISE.values():
        if function.__name__ in solutions:
            return solutions[function.__name__]
    return {SYNONYMS.get(identifier, identifier) for identifier in names}


# What is only seen of an answer (slips.py), with the teacher's names for mistakes that look like that; those without a name may.
SEEN = {
    "sign-slip": {"wrong-sign", "sign-ignored"},
    "entry-slip": set(),
    "breaks-down": set(),
    "too-strict": {"exact-comparison"},
    "too-generous": {"loose-comparison", "reflection-accepted"},
    "integer-truncation": set(),
    "zero-special-case": {"zero-taken-for-missing"},
    "rounded": set(),
    "half-turn-missed": {"trace-formula-only"},
    "small-values-dropped": set(),
    "digits-lost": set(),
}


@pytest.mark.parametrize("name, names, function", [pytest.param(*w, id=f"{w[0]}-{w[2].__name__}") for w in WRONG])
def test_what_students_wrote_gets_its_own_name_or_none(name, names, function, thorough):
    for seed in SEEDS[: 3 if thorough else 1]:
        called = set(judged(name, function, seed).misconceptions)
        seen = [{identifier} for identifier, like in SEEN.items() if not names or set(names) <= like]
        expected = expected_names(names, function)
        assert (
            called in (expected, set(), *seen) or "input-mutated" in called <= expected
        )  # the rest may be its consequence


def test_every_exception_is_one():
    written = {function.__name__: set(names) for _, names, function in WRONG}
    for solutions in OTHERWISE.values():
        for solution, called in solutions.items():
            assert written[solution] != called


def test_most_of_what_students_wrote_has_a_name(slow):
    nameable = [(name, function) for name, names, function in WRONG if expected_names(names, function)]
    named = sum(bool(judged(name, function).misconceptions) for name, function in nameable)
    print(f"{named} of {len(nameable)} wrong solutions that have a name get it")
    assert named >= 0.9 * len(nameable)


# --- two mistakes at once -------------------------------------------------------------------------------------------


def of_one_part(name):
    """{part: [misconceptions that leave the other parts right]}"""
    exercise, found = EXERCISES[name], {}
    cases, parts = exercise.drawn(PUBLIC_SEED), KINDS[exercise.returns].parts
    for misconception in exercise.misconceptions:
        changed = set()
        try:
            with np.errstate(all="ignore"):
                for case in cases:
                    right = split(name, exercise.reference(*case.args, **case.kwargs))
                    wrong = split(name, misconception.wrong(*case.args, **case.kwargs))
                    changed |= {one for one, part in parts.items() if not part.agree(wrong[one], right[one])}
        except (ValueError, ArithmeticError, LookupError, TypeError):
            continue  # it answers something of another kind, or nothing
        if len(changed) == 1:
            found.setdefault(changed.pop(), []).append(misconception)
    return found


@pytest.mark.parametrize("name", MATRICES_AND_POSES)
def test_two_mistakes_in_two_parts_are_both_named(name, thorough):
    first_part, second_part = list(KINDS[EXERCISES[name].returns].parts)[:2]
    candidates = of_one_part(name)
    pairs = list(product(candidates.get(first_part, []), candidates.get(second_part, [])))
    if not thorough:
        pairs = pairs[:: len(pairs) // 10 + 1]
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


@pytest.mark.parametrize("name", [name for name in EXERCISES if EXERCISES[name].returns == "pose"])
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


@pytest.mark.parametrize("name", [name for name in EXERCISES if EXERCISES[name].returns != "truth"])
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


# --- names by the shape of the error --------------------------------------------------------------------------------


@every_exercise
def test_what_has_a_name_is_not_called_by_its_shape(name, thorough):
    """Names by the shape of the error are for what no misconception explains."""
    for misconception in EXERCISES[name].misconceptions:
        for seed in SEEDS[: 3 if thorough else 1]:
            called = set(judged(name, misconception.wrong, seed).misconceptions)
            assert called & set(SEEN) <= set(misconception.id.split(";")), misconception.id


def _entries(name):
    """The places of the numbers of an answer that vary from case to case: [(part, index)]"""
    answers = [split(name, codec.decode(case["expected"])) for case in key_of(name)["cases"]]
    return [
        (part, index)
        for part, value in answers[0].items()
        for index in np.ndindex(value.shape)
        if sum(abs(answer[part][index]) > 0.01 for answer in answers) > 5 and part != "bottom row"
    ]


def _with_entry(name, change, *places):
    """The reference with the numbers at these places changed."""

    def wrong(*args, **kwargs):
        parts = {part: value.copy() for part, value in split(name, EXERCISES[name].reference(*args, **kwargs)).items()}
        for part, index in places:
            parts[part][index] = change(parts[part][index])
        return joined(name, parts) if len(parts) > 1 else next(iter(parts.values()))

    return wrong


NUMBERS = [name for name in EXERCISES if EXERCISES[name].returns != "truth" and key_of(name)["parameters"]]


@pytest.mark.parametrize("name", NUMBERS)
def test_a_single_number_that_is_wrong_is_named_with_its_place(name, thorough):
    for place in _entries(name)[:: 1 if thorough else 3]:
        for identifier, change in (("sign-slip", lambda x: -x), ("entry-slip", lambda x: 1.5 * x + 0.01)):
            verdict = judged(name, _with_entry(name, change, place))
            if verdict.misconceptions != (identifier,):
                known = {one for m in EXERCISES[name].misconceptions for one in m.id.split(";")}
                assert verdict.misconceptions and set(verdict.misconceptions) <= known, (place, verdict.misconceptions)
                continue
            part, index = place
            if len(index) == 2:
                assert f"row {index[0] + 1}, column {index[1] + 1} (" in verdict.says
            else:
                assert f"{'xyzw'[index[0]]} of the {part}." in verdict.says


@pytest.mark.parametrize("name", NUMBERS)
def test_signs_alone_are_told_from_other_numbers(name):
    """Two signs are a slip of signs; two other numbers, or a number and a sign, have no name."""
    first, second = _entries(name)[:2]

    def both(*args, **kwargs):
        return _with_entry(name, lambda x: 1.5 * x + 0.01, first, second)(*args, **kwargs)

    (signs,) = judged(name, _with_entry(name, lambda x: -abs(x), first, second)).misconceptions
    assert signs in {m.id for m in EXERCISES[name].misconceptions} | {"sign-slip"}
    assert judged(name, both).misconceptions == ()


@pytest.mark.parametrize("name", [name for name in EXERCISES if EXERCISES[name].returns == "pose"])
def test_the_sign_of_a_whole_quaternion_is_no_slip(name):
    """q and -q are the same: a w that is wrong is found whichever of the two is answered."""
    flip = np.random.default_rng(1)

    def wrong(*args, **kwargs):
        parts = split(name, EXERCISES[name].reference(*args, **kwargs))
        q = parts["orientation"] * flip.choice([-1.0, 1.0])
        return joined(name, {**parts, "orientation": q * [1, 1, 1, 0.5]})

    verdict = judged(name, wrong)
    assert verdict.misconceptions == ("entry-slip",) and "w of the orientation" in verdict.says


@pytest.mark.parametrize("deserved, identifier", [(True, "too-strict"), (False, "too-generous")])
@pytest.mark.parametrize("name", [name for name in EXERCISES if EXERCISES[name].returns == "truth"])
def test_a_predicate_that_fails_on_one_side_alone(name, deserved, identifier):
    cases = [case for case in key_of(name)["cases"] if case["expected"] is deserved]
    odd = [case["args"] for case in cases[:: len(cases) // 4]]

    def answer(args, kwargs):
        (case,) = [case for case in key_of(name)["cases"] if case["args"] == args]
        return Reply("returned", case["expected"] != (args in odd), [args, kwargs])

    assert examine(name, key_of(name), answer).misconceptions == (identifier,)
    odd += [case["args"] for case in key_of(name)["cases"] if case["expected"] is not deserved][:2]
    assert examine(name, key_of(name), answer).misconceptions == ()


@pytest.mark.parametrize("error", ["1 / 0", "np.linalg.inv(np.zeros((2, 2)))", "math.sqrt(-1)"])
@pytest.mark.parametrize("name", ["transform_to_pose", "is_rotation", "chain"])
def test_a_formula_that_breaks_down_in_some_cases(name, error):
    """Named when all others are right; an error of another kind, or wrong answers beside it, are not called that."""
    number, wrong_beside, code = iter(range(10_000)), [], [error]

    def sometimes(*args):
        turn = next(number)
        if turn % 9 == 4:
            eval(code[0], {"np": np, "math": math})
        return None if wrong_beside and turn % 9 == 5 else EXERCISES[name].reference(*args)

    verdict = judged(name, sometimes)
    assert verdict.misconceptions == ("breaks-down",)
    assert "wherever its formula works" in verdict.says and re.search(r"in \d+ of \d+ cases", verdict.says)
    wrong_beside.append(True)
    assert "breaks-down" not in judged(name, sometimes).misconceptions
    wrong_beside.clear()
    code[0] = "[][0]"
    assert judged(name, sometimes).misconceptions == ()
