"""The last cell of a notebook, and the pictures of mistakes: as text, as HTML, and with what students do to them."""

import json
import re

import numpy as np
import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from support import ASKED, points
from transform_lab import Point, Pose, Quaternion, Viewer, show_mistake, sum_up, tft
from transform_lab.check import CheckFailed

from autograder.exercises import EXERCISES


@pytest.fixture
def shell():
    """IPython, as a notebook has it."""
    yield InteractiveShell.instance()
    InteractiveShell.clear_instance()


def summed_up(shell, notebook, **functions):
    """(text, HTML) of the last cell of a notebook in which these functions are defined."""
    shell.user_ns.update(functions)
    with capture_output() as captured:
        sum_up(notebook)
    (output,) = captured.outputs
    return output.data["text/plain"], output.data["text/html"]


def test_each_exercise_is_looked_at_anew(shell):
    def stub(q1, q2):
        raise NotImplementedError

    text, html = summed_up(
        shell,
        "1_rotation",
        rotation_about_z=EXERCISES["rotation_about_z"].reference,
        rotation_from_axes=lambda x_axis, y_axis: np.column_stack([x_axis, y_axis, np.cross(y_axis, x_axis)]),
        same_rotation=stub,
    )
    lines = text.splitlines()
    assert lines[0] == "rotation_about_z  2 of 2  all right"
    assert lines[1].startswith("rotation_from_axes  0 of 2  not right yet")
    assert lines[2] == "is_rotation  0 of 2  run the cell that defines it, and keep its name"
    assert lines[3] == "same_rotation  0 of 1  not done yet"
    asked = len(ASKED["1_rotation"].points)
    so_far = f"1 of {asked} exercises, 2 of {points('1_rotation'):g} points"
    assert lines[asked] == f"Right so far: {so_far}. Grading uses other numbers."
    assert "hand in the file 1_rotation.ipynb under this name" in lines[-2]
    assert lines[-1].startswith(f"The course: 1 rotation 1 of {asked}, 2 homogeneous transforms 0 of ")
    assert [re.sub("<.*?>", "", row)[0] for row in re.findall("<tr><td>.*?</tr>", html)] == [
        "✓", "✗", *["…"] * (asked - 2)
    ]  # fmt: skip


def test_the_map_says_what_was_saved_of_the_other_notebooks(shell, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = [
        {"cell_type": "code", "outputs": [{"data": {"text/plain": f"{name}: all right."}}]}
        for name in ASKED["3_chaining"].points
    ]
    (tmp_path / "3_chaining.ipynb").write_text(json.dumps({"cells": done}))
    (tmp_path / "4_inversion.ipynb").write_text(
        json.dumps({"cells": [*done, {"cell_type": "raw"}, {"outputs": [{"text": ""}]}]})
    )
    (tmp_path / "5_pre_grasp.ipynb").write_text('{"cells": 1}')
    text, html = summed_up(shell, "1_rotation", rotation_about_z=EXERCISES["rotation_about_z"].reference)
    course = "1 rotation 1 of 4, 2 homogeneous transforms 0 of 5, 3 chaining ✓, 4 inversion 0 of 3, 5 pre grasp 0 of 2"
    assert text.splitlines()[-1] == f"The course: {course}"
    assert '<strong>1 rotation 1 of 4</strong> → <a href="2_homogeneous_transforms.ipynb">' in html


def test_questions_for_a_person_are_listed(shell):
    text, _ = summed_up(shell, "4_inversion", transform_point=None)
    assert "Question “why not transpose?”: 2 points, read by a person. Have you written your answer?" in text


def test_a_function_that_prints_or_raises_disturbs_nothing(shell):
    def noisy(*transforms):
        print("here")
        return transforms[7]

    text, _ = summed_up(shell, "3_chaining", chain=noisy)
    assert "here" not in text
    assert "chain  0 of 2  not right yet" in text


def test_a_notebook_that_is_none(shell):
    with pytest.raises(CheckFailed, match="no notebook called 'rotation'; there are 1_rotation, "):
        sum_up("rotation")


def shown(shell, *mistake, **options):
    with capture_output() as captured:
        show_mistake(*mistake, **options)
    (output,) = captured.outputs
    return output.data["text/plain"], output.data["text/html"]


def test_a_mistake_is_a_still_picture_of_both_frames(shell):
    right = tft.rotation_matrix(np.radians(30), [0, 0, 1])
    text, html = shown(shell, right, right.T)
    assert "frame frame_b in frame_a: position (0, 0, 0), x axis (0.866, 0.5, 0)" in text
    assert "frame mistake in frame_a: position (0, 0, 0), x axis (0.866, -0.5, 0)" in text
    assert re.search(r'<img src="data:image/webp;base64,[^"]{5000,}" alt="Scene in the fixed frame frame_a', html)
    assert "<iframe" not in html


def test_a_mistake_may_be_a_point_a_pose_or_no_frame_at_all(shell):
    text, _ = shown(shell, [1, 0, 0.5], [1, 0, 0], name="p")
    assert "point p in frame_a: (1, 0, 0.5)" in text and "point mistake in frame_a: (1, 0, 0)" in text
    text, _ = shown(shell, np.eye(4), Pose(Point(1, 2, 3), Quaternion(0, 0, 1, 0)))
    assert "frame mistake in frame_a: position (1, 2, 3), x axis (-1, 0, 0)" in text
    text, _ = shown(shell, np.eye(3), np.diag([1, 1, -1]))
    assert "arrow z of mistake in frame_a: from (0, 0, 0) to (0, 0, -1)" in text


def test_a_mistake_is_shown_among_what_a_viewer_holds(shell):
    viewer = Viewer("base_link")
    viewer.add_frame("object", tft.translation_matrix([1, 0, 0]))
    text, _ = shown(shell, tft.translation_matrix([0.9, 0, 0]), tft.translation_matrix([1.1, 0, 0]), "stop", viewer)
    assert "frame object in base_link" in text and "frame stop in base_link: position (0.9, 0, 0)" in text


def test_while_a_notebook_is_graded_nothing_is_drawn(shell, monkeypatch):
    monkeypatch.setenv("TRANSFORM_LAB_GRADING", "1")
    with capture_output() as captured:
        show_mistake(np.eye(3), -np.eye(3))
        sum_up("1_rotation")
    assert not captured.outputs
    assert "the mistake puts it" in captured.stdout and "The grader sums up by itself." in captured.stdout
