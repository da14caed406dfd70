"""What is told of where an answer goes wrong, and of answers that are no objects of their own."""

import copy

import numpy as np
import pytest
from support import SEEDS, judged
from transform_lab import Point, Pose, Quaternion
from transform_lab.judging import codec
from transform_lab.judging.calling import call
from transform_lab.judging.kinds import ARGUMENT, EARLIER_ANSWER, KINDS

from autograder.exercises import EXERCISES
from autograder.exercises.cases import matrix, position

every_seed = pytest.mark.parametrize("seed", SEEDS)


def right(name):
    return EXERCISES[name].reference


# --- where ----------------------------------------------------------------------------------------------------------


def like_the_point(a_T_b, p_in_b):
    answer = np.zeros_like(p_in_b)
    answer[:] = right("transform_point")(a_T_b, p_in_b)
    return answer


def like_the_first(*transforms):
    product = transforms[0].copy()
    for T in transforms[1:]:
        product[:] = product @ T
    return product


def small_turn_is_none(matrix):
    pose = right("transform_to_pose")(matrix)
    if np.trace(matrix[:3, :3]) > 3.0 - 1e-5:
        pose.orientation = Quaternion(0, 0, 0, 1)
    return pose


def cut_off(a_T_b):
    return np.linalg.pinv(a_T_b, rcond=1e-5)


def cleaned(name, below):
    def answer(*args, **kwargs):
        exact = right(name)(*args, **kwargs)
        return np.where(np.abs(exact) < below, 0.0, exact)

    return answer


def whole_numbers_alone(pose):
    T = np.diag([1, 1, 1, 1])
    T[:3, 3] = position(pose)
    return T @ np.block([[matrix(pose)[:3, :3], np.zeros((3, 1))], [0, 0, 0, 1]])


def last_column_rounded(x_axis, y_axis):
    return np.column_stack((x_axis, y_axis, np.cross(x_axis, y_axis).round(3)))


def unturned_is_forgotten(*transforms):
    return right("chain")(
        *(T for T in transforms if not np.allclose(T[:3, :3], np.eye(3), rtol=0, atol=1e-12)), np.eye(4)
    )


def no_translation_is_nothing(R, p):
    return right("make_transform")(R, p) if np.any(p) else np.eye(4)


def in_single_precision(degrees):
    return right("rotation_about_z")(float(np.float32(degrees)))


def raises_at_half_turns(matrix):
    if abs(np.trace(matrix[:3, :3]) + 1.0) < 1e-9:
        raise IndexError("no such branch")
    return right("transform_to_pose")(matrix)


@every_seed
@pytest.mark.parametrize("name, wrong, called", [
    ("transform_point", like_the_point, "integer-truncation"),
    ("chain", like_the_first, "integer-truncation"),
    ("make_transform", lambda R, p: np.vstack((np.column_stack((R, p.astype(R.dtype))), [0, 0, 0, 1])), "integer-truncation"),
    ("transform_to_pose", small_turn_is_none, "small-values-dropped"),
    ("invert_transform", cut_off, "digits-lost"),
    *((name, cleaned(name, below), "small-values-dropped")
      for name in ("transform_point", "object_in_gripper", "chain", "invert_transform", "make_transform")
      for below in (1e-5, 1e-3, 0.05)),
    ("transform_to_pose", raises_at_half_turns, "half-turn-missed"),
    ("pose_to_transform", whole_numbers_alone, "integer-truncation"),
    ("rotation_from_axes", last_column_rounded, "rounded"),
    ("chain", unturned_is_forgotten, "zero-special-case"),
    ("make_transform", no_translation_is_nothing, "zero-special-case"),
    ("rotation_about_z", in_single_precision, "digits-lost"),
])  # fmt: skip
def test_cases_of_one_sort_give_the_name(name, wrong, called, seed):
    verdict = judged(name, wrong, seed)
    assert verdict.misconceptions == (called,)
    assert 0 < verdict.credit < 1 and verdict.says and verdict.hint


def test_an_error_in_one_sort_of_cases_stays_the_error():
    verdict = judged("transform_to_pose", raises_at_half_turns)
    assert "IndexError: no such branch" in verdict.says and "half turn" not in verdict.says


def test_a_single_case_that_many_others_are_like_gives_no_name():
    failing = iter([False] * 5 + [True] + [False] * 1000)

    def wrong(a_T_b, a_T_c):
        answer = right("relative_transform")(a_T_b, a_T_c)
        small = np.abs(np.linalg.inv(a_T_b) @ a_T_c - np.eye(4)).max() < 1e-2
        return answer + 0.1 * np.random.default_rng(0).normal(size=(4, 4)) if small and next(failing) else answer

    assert judged("relative_transform", wrong).misconceptions == ()


# --- objects of their own -------------------------------------------------------------------------------------------


def filled_in_again(R, p, T=np.eye(4)):
    T[:3, :3], T[:3, 3] = R, p
    return T


KEPT = Pose()


def one_message(a_T_b, pose_in_b):
    answer = right("transform_pose")(a_T_b, pose_in_b)
    KEPT.position, KEPT.orientation = answer.position, answer.orientation
    return KEPT


def stays_where_it_is(object_pose, offset):
    return right("waypoint")(object_pose, offset) if np.any(offset) else object_pose


@every_seed
@pytest.mark.parametrize("name, wrong, called, least, most", [
    ("make_transform", filled_in_again, "mutable-default", 0.5, 0.5),
    ("transform_pose", one_message, "mutable-default", 0.5, 0.5),
    ("waypoint", stays_where_it_is, "argument-returned", 0.9, 0.99),
])  # fmt: skip
def test_an_answer_that_is_no_object_of_its_own_costs_half(name, wrong, called, least, most, seed):
    verdict = judged(name, wrong, seed)
    assert verdict.misconceptions == (called,)
    assert least <= verdict.credit <= most
    assert all(times == verdict.cases for times in verdict.parts.values())


def with_its_orientation(object_pose, offset):
    """A new pose; its orientation is the object's own."""
    return Pose(right("waypoint")(object_pose, offset).position, object_pose.orientation)


@pytest.mark.parametrize("name, function", [
    ("chain", lambda *transforms: transforms[0] if len(transforms) == 1 else right("chain")(*transforms)),
    ("waypoint", with_its_orientation),
    ("waypoint", lambda object_pose, offset: right("waypoint")(copy.deepcopy(object_pose), offset)),
    ("hand_transform", lambda answer=right("hand_transform")(): answer),
    ("pose_to_transform", lambda pose, kept={}: kept.setdefault(matrix(pose).tobytes(), matrix(pose))),  # noqa: B006
])  # fmt: skip
def test_what_harms_nobody_is_right(name, function):
    assert judged(name, function).right


def test_a_reply_tells_what_the_answer_is():
    shared = np.zeros(3)

    def counting(step):
        shared[:] += step
        return shared

    replies = [call(counting, [step], {}) for step in (1.0, 0.0, 2.0)]
    assert [reply.same_object for reply in replies] == ["", "", EARLIER_ANSWER]  # nothing has changed with the second
    given = codec.encode(Pose(Point(1, 2, 3), Quaternion(0, 0, 0, 1)))
    assert call(lambda pose: pose, [given], {}).same_object == ARGUMENT
    assert call(copy.copy, [given], {}).same_object == ""
    assert KINDS["transform"].own(ARGUMENT) and not KINDS["pose"].own(ARGUMENT)
    assert not KINDS["transform"].own(EARLIER_ANSWER)


# --- what a key is made of ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "array", [np.array([1, -2, 3]), np.eye(4, dtype=int), np.array([1.0, 2.0]), np.array([[True]])]
)
def test_arrays_keep_their_type(array):
    there_and_back = codec.decode(codec.encode(array))
    assert there_and_back.dtype == array.dtype and np.array_equal(there_and_back, array)


def test_a_fingerprint_tells_values_apart():
    rng = np.random.default_rng(3)
    part = KINDS["rotation"].parts["rotation"]
    for _ in range(100):
        R = rng.integers(-1, 2, size=(3, 3)).astype(float)
        other = R.copy()
        other[tuple(rng.integers(3, size=2))] += rng.choice([-1.0, 1.0, 2.0])
        assert part.has(R + 4e-7, part.fingerprint(R)) and not part.has(R, part.fingerprint(other))
    q = np.array([0.1, 0.7, -0.1, 0.7])
    orientation = KINDS["pose"].parts["orientation"]
    assert orientation.has(-q, orientation.fingerprint(q)) and not part.has(-R, part.fingerprint(R + 0.5))
    nothing = np.array([np.nan, 0.0, 0.0])
    place = KINDS["pose"].parts["position"]
    assert place.has(nothing, place.fingerprint(nothing)) and not place.has(np.zeros(3), place.fingerprint(nothing))
