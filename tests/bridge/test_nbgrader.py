"""Real nbgrader: its autograde with and without our plug-in, its validate, its formgrader."""

import json
import shutil
import subprocess
import sys

import pytest
from support import NAMES, asked, jupyter_server, marks, points, points_by_hand, without_plugin

from autograder.course import ASSIGNMENT, Course
from autograder.demo import enroll


def test_stock_nbgrader_gives_the_solutions_full_points(course, hand_in, solved, nbgrader):
    without_plugin(course)
    hand_in(course, "alice", solved)
    result = nbgrader(course, "autograde", ASSIGNMENT)
    assert result.returncode == 0, result.stderr
    automatic = {
        cell: mark
        for cell, mark in marks(course).items()
        if isinstance(mark, tuple) and not cell[2].startswith("question")
    }
    assert sorted(cell for _, _, cell in automatic) == sorted(NAMES)
    assert all(auto == most for auto, _, most, _ in automatic.values())


def test_stock_nbgrader_gives_untouched_notebooks_nothing_and_part_answers_a_part(course, hand_in, nbgrader):
    without_plugin(course)
    notebooks = {name: course.release / f"{name}.ipynb" for name in course.notebooks}
    text = notebooks["2_homogeneous_transforms"].read_text()
    raw = json.loads(text)
    for cell in raw["cells"]:
        if cell["metadata"].get("nbgrader", {}).get("grade_id") == "transform_to_pose-solution":
            cell["source"] = (
                "from transform_lab import Point, Pose, Quaternion\n"
                "def transform_to_pose(matrix):\n"
                "    return Pose(Point(*matrix[:3, 3]), Quaternion(0, 0, 0, 1))\n"
            )
    notebooks["2_homogeneous_transforms"] = json.dumps(raw).encode()
    hand_in(course, "bob", notebooks)
    result = nbgrader(course, "autograde", ASSIGNMENT)
    assert result.returncode == 0, result.stderr
    found = {cell[2]: mark[0] for cell, mark in marks(course).items() if isinstance(mark, tuple)}
    assert 0 < found.pop("transform_to_pose") < 4
    assert set(found.values()) == {0}


def test_both_ways_of_grading_give_the_same_gradebook(released, tmp_path, sandboxed):
    """Every cell of the demo's class: `nbgrader autograde` with our plug-in, and `python3 -m autograder grade`."""
    books = []
    for name, command in (
        ("nbgrader", [sys.executable, "-m", "nbgrader", "autograde", ASSIGNMENT]),
        ("autograder", [sys.executable, "-m", "autograder", "grade", "--no-feedback"]),
    ):
        shutil.copytree(released.root, tmp_path / name)
        course = Course(tmp_path / name)
        enroll(course)
        result = subprocess.run(command, cwd=course.root, capture_output=True, text=True, timeout=1200)
        assert result.returncode == 0, result.stderr
        books.append(marks(course))
    assert len({student for student, _, _ in books[0]}) >= 12
    assert len(books[0]) >= 12 * 19
    assert books[0] == books[1]
    assert len({mark for mark in books[0].values() if mark is not None}) > 5


@pytest.mark.parametrize("name", ["1_rotation", "2_homogeneous_transforms"])
def test_validate_passes_on_solved_and_fails_on_untouched_notebooks(course, solved, name, nbgrader):
    passed = nbgrader(course, "validate", str(solved[name]))
    assert "Success! Your notebook passes all the tests." in passed.stdout, passed.stdout + passed.stderr
    failed = nbgrader(course, "validate", str(course.release / f"{name}.ipynb"))
    assert "VALIDATION FAILED ON" in failed.stdout, failed.stdout + failed.stderr
    for exercise in course.notebooks[name].points:
        assert f'check("{exercise}", {exercise})' in failed.stdout


def test_a_wrong_answer_fails_validation_with_one_line(course, nbgrader):
    path = course.release / "1_rotation.ipynb"
    raw = json.loads(path.read_text())
    for cell in raw["cells"]:
        if cell["metadata"].get("nbgrader", {}).get("grade_id") == "rotation_about_z-solution":
            cell["source"] = "import numpy as np\ndef rotation_about_z(degrees):\n    return np.eye(3)\n"
    path.write_text(json.dumps(raw))
    result = nbgrader(course, "validate", str(path))
    assert "rotation_about_z: not right yet" in result.stdout
    assert "Traceback" not in result.stdout + result.stderr


@pytest.fixture
def formgrader(course, hand_in, solved, sandboxed):
    """The address of a real Jupyter server in a course with one submission."""
    hand_in(course, "alice", solved)
    with jupyter_server(course) as address:
        yield address


def test_the_formgraders_pages_answer_and_its_button_grades(course, formgrader):
    assert "nbgrader formgrade" in asked(formgrader, "/formgrader")
    (assignment,) = json.loads(asked(formgrader, "/formgrader/api/assignments"))
    assert assignment["name"] == ASSIGNMENT and assignment["max_score"] == points() + points_by_hand()
    result = json.loads(asked(formgrader, f"/formgrader/api/submission/{ASSIGNMENT}/alice/autograde", "POST"))
    assert result["success"], result
    (submission,) = json.loads(asked(formgrader, f"/formgrader/api/submissions/{ASSIGNMENT}"))
    assert submission["autograded"] and submission["code_score"] == points()
    for path in (
        "manage_submissions/transforms",
        "gradebook",
        "gradebook/transforms",
        "gradebook/transforms/2_homogeneous_transforms",
    ):
        assert "nbgrader formgrade" in asked(formgrader, f"/formgrader/{path}"), path
    (found,) = json.loads(
        asked(formgrader, f"/formgrader/api/submitted_notebooks/{ASSIGNMENT}/2_homogeneous_transforms")
    )
    shown = asked(formgrader, f"/formgrader/submissions/{found['id']}")
    assert "transform_to_pose: all right." in shown and "4 of 4 points" in shown
