"""Features, bands and the shortcuts that are generated from them: what each is, and that a hole in the cases is told by them."""

from dataclasses import replace

import numpy as np
import pytest
from transform_lab import Point, Pose, Quaternion

from autograder.exercises import EXERCISES, Case
from autograder.exercises.cases import pose, rotation_about, transform
from autograder.exercises.features import (
    LENGTHS,
    of_number,
    of_orientation,
    of_pose,
    of_transform,
    of_two_frames,
    of_vector,
)
from autograder.proving.adequacy import measure, seeds
from autograder.proving.bands import empty_bands
from autograder.proving.shortcuts import shortcuts
from autograder.proving.solutions import Tried

ABOUT_SLANTED = rotation_about((0.36, 0.48, 0.8), 2e-4)


def features(made):
    return {feature.what: feature for feature in made}


def slips_through(exercise, label):
    """Whether a shortcut is right in all the cases of two seeds."""
    (found,) = measure(exercise, [Tried("shortcut", label, shortcuts(exercise)[label])], seeds(2))
    return len(found.accepted) == 2


def with_cases(exercise, kept):
    """The exercise with those of its cases alone that `kept` is true of."""
    return replace(exercise, cases=lambda rng: [case for case in exercise.cases(rng) if kept(case)])


@pytest.mark.parametrize("what, bands", [
    ("angle", {"1e-4"}), ("distance", {"1e1"}), ("sign of x", {"-"}), ("sign of y", {"0"}), ("sign of the trace", {"+"}),
    ("type", {"fractions"}), ("angle and distance together", set()),
])  # fmt: skip
def test_a_transform_is_measured(what, bands):
    T = transform(ABOUT_SLANTED, (-30.0, 0.0, 5.0))
    assert features(of_transform("T"))[what].bands_of({"T": T}) == bands


@pytest.mark.parametrize("what, bands", [
    ("angle", {"1e-4"}), ("distance", {"1e-3"}), ("sign of w", {"-"}), ("type", {"fractions"}),
    ("size of the quaternion's x", {"1e-5"}), ("short of a half turn", set()), ("angle and distance together", {"1e-3"}),
])  # fmt: skip
def test_a_pose_is_measured(what, bands):
    near = pose(ABOUT_SLANTED, (0.0, 0.0, 2e-3))
    q = near.orientation
    q.x, q.y, q.z, q.w = -q.x, -q.y, -q.z, -q.w
    assert features((*of_pose("p"), *of_orientation("p")))[what].bands_of({"p": near}) == bands


def test_integers_and_half_turns_are_known():
    assert features(of_pose("p"))["type"].bands_of({"p": Pose(Point(1, 2, 3), Quaternion(1, 0, 0, 0))}) == {"integers"}
    assert features(of_transform("T"))["type"].bands_of({"T": np.eye(4, dtype=int)}) == {"integers"}
    almost = transform(rotation_about((1, 2, 3), np.pi - 3e-5), (0, 0, 0))
    assert features(of_orientation("T"))["short of a half turn"].bands_of({"T": almost}) == {"1e-5"}
    exactly = transform(np.diag([1.0, -1.0, -1.0]), (0, 0, 0))
    assert features(of_orientation("T"))["short of a half turn"].bands_of({"T": exactly}) == {"0"}


def test_two_frames_are_measured_from_each_other():
    A, B = transform(np.eye(3), (5.0, 0.0, 0.0)), transform(ABOUT_SLANTED, (5.0, 0.0, 0.02))
    found = {what: feature.bands_of({"A": A, "B": B}) for what, feature in features(of_two_frames("A", "B")).items()}
    assert found == {"angle between them": {"1e-4"}, "distance between them": {"1e-2"}, "both together": {"1e-2"}}


def test_what_is_small_is_dropped_and_nothing_else():
    T = transform(ABOUT_SLANTED, (0.5, 0.0, 0.0))
    angle, distance = (features(of_transform("T"))[what] for what in ("angle", "distance"))
    assert np.array_equal(angle.without({"T": T}, 0, 1e-3)["T"], transform(np.eye(3), (0.5, 0.0, 0.0)))
    assert np.array_equal(angle.without({"T": T}, 0, 1e-4)["T"], T)
    assert np.array_equal(distance.without({"T": T}, 0, 1.0)["T"], transform(ABOUT_SLANTED, (0, 0, 0)))
    length, number = features(of_vector("p"))["length"], features(of_number("d", LENGTHS))["size"]
    assert not length.without({"p": np.array([3.0, 4.0, 0.0])}, 1, 10)["p"].any()
    assert number.without({}, 0, 1) == {}  # left to its default


@pytest.mark.parametrize("name", [name for name in EXERCISES if name != "hand_transform"])
def test_every_exercise_declares_what_its_arguments_are_measured_by(name):
    assert EXERCISES[name].features
    assert not empty_bands(EXERCISES[name], seeds(2))


@pytest.mark.parametrize("name, kept, slips", [
    ("transform_point", lambda case: np.linalg.norm(case.args[1]) > 1e-2 or not case.args[1].any(),
     "p_in_b: length below 0.001, taken for 0"),
    ("transform_point", lambda case: case.args[0].dtype != int, "the answer in the type of a_T_b"),
    ("relative_transform", lambda case: np.abs(case.args[0] - case.args[1]).max() > 1e-2 or case.args[0] is case.args[1],
     "a_T_b and a_T_c: both together below 0.001, taken for equal"),
    ("chain", lambda case: all(np.abs(T - np.eye(4)).max() > 0.1 or not (T - np.eye(4)).any() for T in case.args),
     "*transforms: angle and distance together below 0.1, taken for the identity"),
    ("is_rotation", lambda case: not 2e-6 < np.abs(case.args[0].T @ case.args[0] - np.eye(3)).max() < 1e-4,
     "the tolerance is 1e-05"),
    ("same_rotation", lambda case: np.dot(*case.args) < 0, "alternative 2 alone"),
    ("waypoint", lambda case: case.args[1].any(), "an argument is the answer where it has the same numbers"),
])  # fmt: skip
def test_a_hole_in_the_cases_lets_a_shortcut_through(name, kept, slips):
    exercise = EXERCISES[name]
    assert slips_through(with_cases(exercise, kept), slips)
    assert not slips_through(exercise, slips)


def test_an_empty_band_is_told():
    exercise = with_cases(EXERCISES["waypoint"], lambda case: case.args[0].orientation.w > -0.5)
    assert ("object_pose: sign of w", "-") not in empty_bands(exercise, seeds(2))
    exercise = with_cases(EXERCISES["waypoint"], lambda case: case.args[0].orientation.w > 0)
    assert empty_bands(exercise, seeds(2))["object_pose: sign of w", "-"] == list(seeds(2))


def test_shortcuts_are_right_but_beyond_their_threshold():
    p = np.array([0.0, 0.0, 0.02])
    exercise = replace(EXERCISES["transform_point"], cases=lambda rng: [Case("one", (np.eye(4), p))])
    assert slips_through(exercise, "p_in_b: length below 0.01, taken for 0")
    assert not slips_through(exercise, "p_in_b: length below 0.1, taken for 0")
