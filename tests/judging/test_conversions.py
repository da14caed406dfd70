"""`numpify` and `msgify`: as ros_numpy's, and the exercises of notebook 2 done right."""

import numpy as np
import pytest
from transform_lab import Point, Pose, PoseStamped, Quaternion, conversions, msgify, numpify, tft

from autograder.exercises import EXERCISES


@pytest.mark.parametrize("seed", range(5))
def test_they_do_what_the_exercises_of_notebook_2_ask_for(seed):
    random = np.random.default_rng(seed)
    a_T_b = tft.random_rotation_matrix(random.random(3))
    a_T_b[:3, 3] = random.uniform(-2, 2, 3)
    pose = EXERCISES["transform_to_pose"].reference(a_T_b)
    np.testing.assert_allclose(numpify(pose), EXERCISES["pose_to_transform"].reference(pose), atol=1e-12)
    np.testing.assert_allclose(numpify(msgify(Pose, a_T_b)), a_T_b, atol=1e-12)
    assert [type(value) for value in (msgify(Pose, a_T_b).position.x, msgify(Pose, a_T_b).orientation.w)] == [
        float,
        float,
    ]


@pytest.mark.parametrize(
    "call, error, message",
    [
        (lambda: numpify(np.eye(4)), TypeError, "takes a Pose here; got ndarray"),
        (lambda: numpify(PoseStamped()), TypeError, "in the field pose"),
        (lambda: numpify(Pose()), ValueError, "A fresh Quaternion"),
        (lambda: numpify(Pose(orientation=Quaternion(0, 0, 2, 2))), ValueError, "length 1"),
        (lambda: msgify(np.eye(4), Pose), TypeError, "kind of message first"),
        (lambda: msgify(Point, np.eye(4)), TypeError, "makes a Pose"),
        (lambda: msgify(Pose, np.eye(3)), ValueError, "4x4"),
        (lambda: msgify(Pose, np.diag([1, 1, -1, 1])), ValueError, "determinant"),
    ],
)
def test_what_is_no_pose_and_no_transform_is_refused(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_in_notebook_2_they_are_the_exercise(monkeypatch):
    monkeypatch.setattr(conversions, "names", lambda: {"hand_transform": None})
    for call in (lambda: numpify(Pose()), lambda: msgify(Pose, np.eye(4))):
        with pytest.raises(ValueError, match="by hand"):
            call()
