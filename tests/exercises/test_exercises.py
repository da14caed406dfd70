"""The exercises prove themselves: the reference is right, misconceptions are caught and named, stubs earn nothing."""

import copy
import io
import json
import math
import re
from inspect import signature
from itertools import permutations
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation
from support import NAMES, ROOT, SEEDS, judged, key_of
from transform_lab import Point, Pose, Quaternion
from transform_lab.judging.answers import parts_of
from transform_lab.judging.kinds import KINDS, TOLERANCE

from autograder.exercises import EXERCISES, PUBLIC_SEED, key
from autograder.exercises.cases import either_sign, half_turn
from autograder.handout.exercises_page import PAGE, PICTURE, earned, page, picture

pytestmark = pytest.mark.filterwarnings("ignore:the matrix subclass")  # np.matrix, which students still use

every_exercise = pytest.mark.parametrize("name", EXERCISES)
every_seed = pytest.mark.parametrize("seed", SEEDS)


def changed(name, change):
    """The reference solution, its answer passed through `change`."""
    return lambda *args, **kwargs: change(EXERCISES[name].reference(*args, **kwargs))


def poses():
    return [name for name in EXERCISES if EXERCISES[name].returns == "pose"]


def arrays():
    return [name for name in EXERCISES if EXERCISES[name].returns in ("rotation", "transform", "coordinates")]


def test_the_exercises_are_those_of_the_notebooks_in_their_order():
    assert NAMES == [name for name in EXERCISES if name in NAMES]


@every_seed
@every_exercise
def test_reference_is_right(name, seed):
    verdict = judged(name, EXERCISES[name].reference, seed)
    assert verdict.credit == 1.0
    assert verdict.misconceptions == ()


# --- misconceptions -------------------------------------------------------------------------------------------------


@every_exercise
def test_misconceptions_say_their_own_sentences_and_earn_what_the_page_says(name):
    for index, misconception in enumerate(EXERCISES[name].misconceptions):
        verdict = judged(name, misconception.wrong)
        assert earned(EXERCISES[name], key_of(name), index) == int(round(100 * verdict.credit, 9))
        assert verdict.misconceptions == tuple(misconception.id.split(";"))
        assert (verdict.says, verdict.hint) == (misconception.says, misconception.hint)


@every_exercise
def test_two_mistakes_at_once_are_made_of_single_ones(name):
    """So that the class report, which counts each by itself, has a sentence for it."""
    single = {misconception.id for misconception in EXERCISES[name].misconceptions}
    for misconception in EXERCISES[name].misconceptions:
        assert set(misconception.id.split(";")) <= single


@every_exercise
def test_misconceptions_are_written_for_students(name):
    misconceptions = EXERCISES[name].misconceptions
    assert misconceptions
    for misconception in misconceptions:
        assert re.fullmatch(r"[a-z-]+(;[a-z-]+)?", misconception.id)
        for sentence in (misconception.says, misconception.hint):
            assert sentence[0].isupper() or sentence[0] in '`"*', sentence
            assert sentence[-1] in ".?", sentence


@pytest.mark.parametrize("name, misconception, least, most", [
    ("transform_to_pose", "position-missing", 0.5, 0.5),
    ("transform_to_pose", "trace-formula-only", 0.5, 0.95),
    ("make_transform", "position-missing", 0.4, 0.4),
    ("invert_transform", "inverse-missing", 0.0, 0.0),
    ("invert_transform", "inverse-parts-separately", 0.3, 0.3),
    ("same_rotation", "sign-ignored", 0.0, 0.2),
    ("is_rotation", "determinant-only", 0.2, 0.7),
    ("pre_grasp", "base-frame-offset", 0.0, 0.0),
    ("pre_grasp", "orientation-identity", 0.5, 0.5),
    ("pre_grasp", "distance-ignored", 0.15, 0.4),
])  # fmt: skip
def test_partial_credit(name, misconception, least, most):
    for wrong in (m.wrong for m in EXERCISES[name].misconceptions if m.id == misconception):
        assert least - 1e-9 <= judged(name, wrong).credit <= most + 1e-9


# --- answers that are none ------------------------------------------------------------------------------------------


def upright():
    return Pose(Point(), Quaternion(0, 0, 0, 1))


CONSTANTS = [np.eye(4), np.eye(3), np.zeros((4, 4)), np.zeros((3, 3)), np.zeros(3), Pose(), upright(), True, False, 0.0]


@every_seed
@every_exercise
def test_a_constant_earns_nothing(name, seed):
    first = next(iter(EXERCISES[name].drawn(seed)))
    known = [] if name == "hand_transform" else [EXERCISES[name].reference(*first.args, **first.kwargs)]
    for constant in CONSTANTS + known:
        assert judged(name, lambda *args, **kwargs: constant, seed).credit == 0.0
    for constant in known:
        assert judged(name, lambda *args, **kwargs: constant, seed).misconceptions != ()


@every_seed
@pytest.mark.parametrize("name", [name for name in EXERCISES if name != "hand_transform"])
def test_an_unchanged_argument_earns_nothing(name, seed):
    for which in (0, -1):
        assert judged(name, lambda *args, **kwargs: args[which], seed).credit == 0.0


@every_exercise
def test_none_is_told(name):
    verdict = judged(name, lambda *args, **kwargs: None)
    assert (verdict.status, verdict.credit, verdict.misconceptions) == ("graded", 0.0, ("returned-none",))


@every_exercise
def test_wrong_shape_and_wrong_type_are_told(name):
    expected = "wrong-shape" if name in arrays() else "wrong-type"
    verdict = judged(name, lambda *args, **kwargs: np.zeros((2, 7)))
    assert (verdict.status, verdict.credit, verdict.misconceptions) == ("graded", 0.0, (expected,))
    verdict = judged(name, lambda *args, **kwargs: "an answer in words")
    assert (verdict.status, verdict.credit, verdict.misconceptions) == ("graded", 0.0, ("wrong-type",))


@pytest.mark.parametrize("name", [name for name in EXERCISES if name in arrays() + poses()])
def test_not_a_number_is_told(name):
    def spoilt(answer):
        if hasattr(answer, "orientation"):
            answer.orientation.x = math.nan
        else:
            answer = answer * np.nan
        return answer

    verdict = judged(name, changed(name, spoilt))
    credit = EXERCISES[name].credit.get("position", 0.0)  # which is right
    assert (verdict.status, verdict.credit, verdict.misconceptions) == ("graded", credit, ("not-finite",))


@every_exercise
def test_a_stub_is_not_done_and_an_exception_is_an_error(name):
    def stub(*args, **kwargs):
        raise NotImplementedError

    def broken(*args, **kwargs):
        raise KeyError("rotation")

    verdict = judged(name, stub)
    assert (verdict.status, verdict.credit, verdict.done) == ("error", 0.0, False)
    verdict = judged(name, broken)
    assert (verdict.status, verdict.credit, verdict.done, verdict.misconceptions) == ("error", 0.0, True, ())
    assert "KeyError" in verdict.says


# --- right answers in other forms -----------------------------------------------------------------------------------


@every_seed
@pytest.mark.parametrize("name", poses())
def test_both_signs_of_a_quaternion_are_right(name, seed):
    def negated(pose):
        q = pose.orientation
        return Pose(pose.position, Quaternion(-q.x, -q.y, -q.z, -q.w))

    assert judged(name, changed(name, negated), seed).credit == 1.0
    assert judged(name, changed(name, lambda pose: pose), seed).credit == 1.0


@pytest.mark.parametrize("name", arrays())
def test_lists_matrices_and_float32_are_right(name):
    for form in (np.ndarray.tolist, np.matrix, np.float32):
        assert judged(name, changed(name, lambda answer: form(np.array(answer)))).credit == 1.0


def as_namespace(pose):
    """A pose of another library: nothing but the same fields."""
    p, q = pose.position, pose.orientation
    return SimpleNamespace(
        position=SimpleNamespace(x=p.x, y=p.y, z=p.z), orientation=SimpleNamespace(x=q.x, y=q.y, z=q.z, w=q.w)
    )


@pytest.mark.parametrize("name", poses())
def test_float32_and_other_classes_of_pose_are_right(name):
    def in_float32(pose):
        p, q = pose.position, pose.orientation
        return Pose(Point(*np.float32([p.x, p.y, p.z])), Quaternion(*np.float32([q.x, q.y, q.z, q.w])))

    assert judged(name, changed(name, in_float32)).credit == 1.0
    assert judged(name, changed(name, as_namespace)).credit == 1.0


@pytest.mark.parametrize("name", [name for name in EXERCISES if EXERCISES[name].returns == "truth"])
def test_truth_in_other_types_is_right(name):
    for form in (np.bool_, int, float, np.array):
        assert judged(name, changed(name, form)).credit == 1.0


def first_case(name):
    return EXERCISES[name].drawn(PUBLIC_SEED)[0]


def can_be_changed(arg):
    return hasattr(arg, "position") or isinstance(arg, np.ndarray)


@pytest.mark.parametrize("name", [name for name in EXERCISES if any(map(can_be_changed, first_case(name).args))])
def test_a_changed_argument_is_noticed(name):
    def spoiling(*args, **kwargs):
        answer = copy.deepcopy(EXERCISES[name].reference(*args, **kwargs))
        *_, last = filter(can_be_changed, args)
        if hasattr(last, "position"):
            last.position.x -= 0.1
        else:
            last[..., 0] += 1
        return answer

    verdict = judged(name, spoiling)
    assert verdict.credit == pytest.approx(0.5)
    assert verdict.misconceptions == ("input-mutated",)


# --- cases and keys -------------------------------------------------------------------------------------------------


@every_exercise
def test_keys_are_plain_data_and_follow_from_the_seed(name):
    exercise = EXERCISES[name]
    public = key(exercise, PUBLIC_SEED)
    assert json.loads(json.dumps(public, allow_nan=False)) == public
    assert key(exercise, PUBLIC_SEED) == public
    hidden = key(exercise, PUBLIC_SEED + 1)
    assert sorted(case["family"] for case in hidden["cases"]) == sorted(case["family"] for case in public["cases"])
    if name != "hand_transform":  # it has no arguments
        shown = [case["args"] for case in public["cases"]]
        assert any(case["args"] not in shown for case in hidden["cases"])


@every_exercise
def test_arguments_have_the_promised_types(name):
    parameters = list(signature(EXERCISES[name].reference).parameters)
    for seed in SEEDS:
        for case in EXERCISES[name].drawn(seed):
            named = [*zip(parameters, case.args), *case.kwargs.items()] if len(case.args) <= len(parameters) else []
            for parameter, arg in named or [("", arg) for arg in case.args]:  # chain(*transforms) takes any number
                if isinstance(arg, np.ndarray):
                    assert arg.dtype in (np.float64, np.int64)
                    assert arg.shape in ((3,), (4,), (3, 3), (4, 4))
                    if arg.shape == (4,):
                        assert abs(np.linalg.norm(arg) - 1.0) < 1e-12
                elif isinstance(arg, Pose):
                    q = arg.orientation
                    assert abs(np.linalg.norm([q.x, q.y, q.z, q.w]) - 1.0) < 1e-8
                else:
                    assert isinstance(arg, (int, float)) and parameter in ("degrees", "distance")


def test_truths_are_far_from_the_tolerance():
    for seed in range(100):
        for case in EXERCISES["is_rotation"].drawn(seed):
            R = case.args[0]
            if np.linalg.det(R) < 0:
                continue
            off = np.abs(R.T @ R - np.eye(3)).max()
            nearest = np.abs(R - nearest_rotation(R)).max()  # a fair way to compare, too
            assert (
                off < 0.35 * TOLERANCE and nearest < 0.25 * TOLERANCE or off > 4 * TOLERANCE and nearest > 2 * TOLERANCE
            )
        for case in EXERCISES["same_rotation"].drawn(seed):
            q1, q2 = case.args
            off = min(np.abs(q1 - q2).max(), np.abs(q1 + q2).max())
            angle = 2 * np.arcsin(
                min(np.linalg.norm(q1 - q2), np.linalg.norm(q1 + q2), 2.0) / 2
            )  # of which half, or all, is compared
            assert off < 0.5 * TOLERANCE and angle < 0.9 * TOLERANCE or off > 1.9 * TOLERANCE and angle > 3 * TOLERANCE


def nearest_rotation(R):
    U, _, Vt = np.linalg.svd(R)
    return U @ np.diag([1.0, 1.0, np.linalg.det(U @ Vt)]) @ Vt


def test_every_family_of_truths_has_no_single_answer_but_negatives():
    """So that an answer that is True (or False) nearly always earns next to nothing."""
    for name in ("is_rotation", "same_rotation"):
        answers = {}
        for case in key_of(name)["cases"]:
            answers.setdefault(case["family"], set()).add(case["expected"])
        one_sided = [family for family, seen in answers.items() if len(seen) == 1]
        assert one_sided == ([] if name == "is_rotation" else ["a quaternion and its negative"])


def test_rotations_of_all_kinds_reach_transform_to_pose():
    for seed in SEEDS:
        traces, exact = [], set()
        for case in EXERCISES["transform_to_pose"].drawn(seed):
            R = case.args[0][:3, :3]
            assert np.allclose(R.T @ R, np.eye(3), atol=1e-12) and np.linalg.det(R) > 0
            traces.append(np.trace(R))
            if np.array_equal(R, R.round()):
                exact.add(tuple(R.ravel()))
        assert len(exact) == 24
        half_turns = sum(abs(trace + 1.0) < 1e-12 for trace in traces)
        # nine of the 24, four about slanted axes, six about almost an axis of A (and those that are almost half turns)
        assert half_turns >= 9 + 4 + 6
        assert any(-1.0 + 1e-7 < trace < -1.0 + 1e-4 for trace in traces)  # almost half turns
        assert any(3.0 - 1e-4 < trace < 3.0 for trace in traces)


def test_half_turns_have_a_trace_of_exactly_minus_one():
    """However the trace is summed, so that a formula that divides by w = 0 gives one and the same answer."""
    for seed in range(200):
        diagonal = np.diag(half_turn(np.random.default_rng(seed))).round(12)
        assert all(((a + b) + c) + d == 0.0 for a, b, c, d in permutations((1.0, *diagonal)))


def test_quaternions_of_either_sign_are_arguments():
    pose = Pose(Point(1, 2, 3), Quaternion(0.5, 0.5, -0.5, 0.5))
    negated = Pose(Point(1, 2, 3), Quaternion(-0.5, -0.5, 0.5, -0.5))
    assert either_sign([negated, pose, pose]) == [pose, negated, pose]
    for name in ("pose_to_transform", "transform_pose", "pre_grasp", "waypoint"):
        cases = EXERCISES[name].drawn(PUBLIC_SEED)
        w = [arg.orientation.w for case in cases for arg in case.args if isinstance(arg, Pose)]
        assert sum(number < -0.1 for number in w) >= 5 and sum(number > 0.1 for number in w) >= 5


def test_chains_and_distances_are_of_all_kinds():
    for seed in SEEDS:
        chains = EXERCISES["chain"].drawn(seed)
        assert {len(case.args) for case in chains} == {1, 2, 3, 4, 5, 6}
        calls = EXERCISES["pre_grasp"].drawn(seed)
        assert {(len(case.args), tuple(case.kwargs)) for case in calls} == {(1, ()), (2, ()), (1, ("distance",))}
        distances = {case.args[1] for case in calls if len(case.args) == 2}
        assert {0.25, 0.02} <= distances


def test_public_key_is_small():
    sizes = {name: len(json.dumps(key(EXERCISES[name], PUBLIC_SEED))) for name in EXERCISES}
    print(f"public key: {sum(sizes.values()):,} bytes", sizes)
    assert sum(sizes.values()) < 1_500_000  # a tenth of that when zipped


@every_exercise
def test_credit_is_counted_by_families_and_their_weights(name):
    """Right in all families but one: that one's share of the weights is lost, or a part of it."""
    public = key_of(name)
    assert set(EXERCISES[name].weights) <= set(public["weights"])
    total = sum(public["weights"].values())
    for family, weight in public["weights"].items():
        cases = iter(public["cases"])

        def wrong_in_one_family(*args, family=family, cases=cases, **kwargs):
            return None if next(cases)["family"] == family else EXERCISES[name].reference(*args, **kwargs)

        assert judged(name, wrong_in_one_family).credit == pytest.approx(1.0 - weight / total)


def test_the_picture_in_the_readme_is_up_to_date():
    kept, now = (np.array(Image.open(file).convert("L")).astype(int) for file in (PICTURE, io.BytesIO(picture())))
    assert (np.abs(kept - now) > 40).mean() < 0.002, "run `.venv/bin/python -m autograder.handout.exercises_page`"
    assert PICTURE.stat().st_size < 40_000


def test_the_page_for_instructors_is_up_to_date():
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    assert text == page({name: key_of(name) for name in EXERCISES}), "run `python3 -m autograder release`"
    for exercise in EXERCISES.values():
        for misconception in exercise.misconceptions:
            assert misconception.says.replace("\n", "<br>") in text and misconception.hint.replace("\n", "<br>") in text


def test_there_are_enough_misconceptions():
    least = {"transform_to_pose": 20, "pre_grasp": 10, "invert_transform": 10, "object_in_gripper": 10}
    least |= {"pose_to_transform": 10, "transform_point": 10, "chain": 10}
    for name, number in least.items():
        assert len(EXERCISES[name].misconceptions) >= number
    assert sum(len(exercise.misconceptions) for exercise in EXERCISES.values()) >= 400


# --- what the lab publishes -----------------------------------------------------------------------------------------


def flat(pose):
    p, q = pose.position, pose.orientation
    return [p.x, p.y, p.z, q.x, q.y, q.z, q.w]


def test_pre_grasp_of_the_lab():
    object_pose = Pose(Point(0.6, -0.1, 0.7), Quaternion(0, 0, 0.38268343, 0.92387953))
    answer = EXERCISES["pre_grasp"].reference(object_pose)
    position, q = answer.position, answer.orientation
    assert [position.x, position.y, position.z] == pytest.approx([0.529289321708, -0.170710677946, 0.7], abs=1e-10)
    assert [q.x, q.y, q.z, q.w] == pytest.approx([0.0, 0.0, 0.382683431234, 0.92387953298], abs=1e-8)
    asked = [flat(case.args[0]) for case in EXERCISES["pre_grasp"].drawn(PUBLIC_SEED)]
    assert any(np.allclose(flat(object_pose), pose, rtol=0, atol=1e-8) for pose in asked)


def test_example_1_of_the_lab():
    c = math.cos(math.pi / 4)
    example = np.array([[c, -c, 0, 0], [c, c, 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]])
    pose = EXERCISES["transform_to_pose"].reference(example)
    assert [pose.position.x, pose.position.y, pose.position.z] == [0.0, 0.0, 0.5]
    q = parts_of("pose", pose)["orientation"]
    assert KINDS["pose"].parts["orientation"].agree(q, np.array([0.0, 0.0, 0.38268343, 0.92387953]))
    assert np.allclose(EXERCISES["pose_to_transform"].reference(pose), example)
    point = EXERCISES["transform_point"].reference(example, np.array([1.0, 0.0, 0.0]))
    assert point == pytest.approx([c, c, 0.5])
    shown = [case.args[0] for case in EXERCISES["transform_to_pose"].drawn(PUBLIC_SEED)]
    assert any(np.allclose(matrix, example) for matrix in shown)


def test_example_2_of_the_lab():
    """Thumb (z) to the left, middle finger (y) down, index finger (x) still forward, 10 cm closer."""
    forward, left, up = np.eye(3)
    hand = EXERCISES["hand_transform"].reference()
    assert np.array_equal(hand[:3, :3], np.column_stack((forward, -up, left)))
    assert np.array_equal(hand[:3, 3], -0.1 * forward)
    assert np.array_equal(hand[3], [0, 0, 0, 1])


def test_object_in_gripper_of_the_lab():
    """The object 1 m in front of the camera; the gripper looks down from 0.2 m above the object."""
    base_T_camera, base_T_gripper = np.eye(4), np.eye(4)
    base_T_camera[:3, 3] = 0.1, 0.0, 1.0
    base_T_gripper[:3, :3] = Rotation.from_euler("y", 90, degrees=True).as_matrix()  # its x axis points down
    base_T_gripper[:3, 3] = 1.1, 0.0, 1.2
    answer = EXERCISES["object_in_gripper"].reference(base_T_camera, base_T_gripper, np.array([1.0, 0.0, 0.0]))
    assert answer == pytest.approx([0.2, 0.0, 0.0], abs=1e-12)
