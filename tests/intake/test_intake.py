"""Whatever a student hands in becomes a notebook of the released shape, and what was mended is said."""

import copy
import json

import nbformat
import pytest
from nbgrader.utils import compute_checksum
from support import ROOT

from autograder.course import Course
from autograder.intake.restore import restore


@pytest.fixture(scope="module")
def released():
    return Course(ROOT).notebooks["2_homogeneous_transforms"]


@pytest.fixture
def notebook(released):
    return copy.deepcopy(released.notebook)


def graded(notebook, name):
    return next(cell for cell in notebook.cells if cell.metadata.get("nbgrader", {}).get("grade_id") == name)


def handed_in(notebook):
    return json.dumps(notebook).encode()


def test_an_untouched_notebook_is_as_released(released, notebook):
    intake = restore(handed_in(notebook), released)
    assert intake.problems == []
    assert intake.statuses == {}
    assert [(c.cell_type, c.source, c.metadata) for c in intake.notebook.cells if "nbgrader" in c.metadata] == [
        (c.cell_type, c.source, c.metadata) for c in released.notebook.cells if "nbgrader" in c.metadata
    ]


def test_outputs_are_dropped_even_when_damaged(released, notebook):
    raw = json.loads(nbformat.writes(notebook))
    code = next(cell for cell in raw["cells"] if cell["cell_type"] == "code")
    code["outputs"] = [{"output_type": "nonsense", "value": float("nan")}]
    intake = restore(json.dumps(raw).encode(), released)
    assert intake.statuses == {}
    assert not any(cell.get("outputs") for cell in intake.notebook.cells)


def test_of_duplicated_cells_the_last_one_counts(released, notebook):
    first = graded(notebook, "make_transform-solution")
    second = copy.deepcopy(first)
    second.source = "def make_transform(R, p):\n    return 'second'"
    notebook.cells.insert(notebook.cells.index(first) + 1, second)
    intake = restore(handed_in(notebook), released)
    assert "is there 2 times" in intake.problems[0]
    assert graded(intake.notebook, "make_transform-solution").source == second.source
    assert len({cell.id for cell in intake.notebook.cells}) == len(intake.notebook.cells)
    nbformat.validate(intake.notebook)


def test_changed_points_and_flags_are_set_back(released, notebook):
    meta = graded(notebook, "transform_to_pose").metadata.nbgrader
    meta.update(points=100, grade=False, solution=True, locked=False)
    intake = restore(handed_in(notebook), released)
    assert graded(intake.notebook, "transform_to_pose").metadata == released.cells["transform_to_pose"].metadata
    assert len(intake.problems) == 4
    assert "points 100" in intake.problems[0]


def test_points_of_an_earlier_release_are_no_change_of_the_students(released, notebook):
    cell = graded(notebook, "transform_to_pose")
    cell.metadata.nbgrader.points = 3
    cell.metadata.nbgrader.checksum = compute_checksum(cell)
    intake = restore(handed_in(notebook), released)
    assert graded(intake.notebook, "transform_to_pose").metadata == released.cells["transform_to_pose"].metadata
    assert intake.problems == []


@pytest.mark.parametrize("points", ["many", None, [1], 5])
def test_other_points_are_told_whatever_they_are(released, notebook, points):
    graded(notebook, "transform_to_pose").metadata.nbgrader.points = points
    (problem,) = restore(handed_in(notebook), released).problems
    assert f"said points {points!r}" in problem


def test_a_changed_test_cell_is_set_back(released, notebook):
    graded(notebook, "transform_to_pose").source = "pass"
    intake = restore(handed_in(notebook), released)
    assert graded(intake.notebook, "transform_to_pose").source == 'check("transform_to_pose", transform_to_pose)'
    assert "the test cell of transform_to_pose had been changed" in intake.problems[0]


def test_a_changed_cell_type_is_set_back_and_the_text_kept(released, notebook):
    cell = graded(notebook, "make_transform-solution")
    notebook.cells[notebook.cells.index(cell)] = nbformat.v4.new_raw_cell("def f(): ...", metadata=cell.metadata)
    intake = restore(handed_in(notebook), released)
    restored = graded(intake.notebook, "make_transform-solution")
    assert (restored.cell_type, restored.source) == ("code", "def f(): ...")
    nbformat.validate(intake.notebook)


def test_tags_and_unknown_grade_ids_go(released, notebook):
    graded(notebook, "transform_to_pose").metadata.tags = ["skip-execution"]
    extra = nbformat.v4.new_code_cell("1", metadata={"nbgrader": {"grade_id": "mine", "grade": True, "points": 50}})
    notebook.cells.append(extra)
    intake = restore(handed_in(notebook), released)
    assert "tags" not in graded(intake.notebook, "transform_to_pose").metadata
    assert "nbgrader" not in intake.notebook.cells[-1].metadata


@pytest.mark.parametrize("metadata", [7, "x", [], {"grade_id": 5}, {"grade_id": ["a"]}])
def test_damaged_nbgrader_metadata_is_no_obstacle(released, notebook, metadata):
    graded(notebook, "transform_to_pose-solution").metadata.nbgrader = metadata
    intake = restore(handed_in(notebook), released)
    assert intake.statuses == {}


def test_students_own_cells_stay(released, notebook):
    notebook.cells.insert(3, nbformat.v4.new_code_cell("mine = 1"))
    intake = restore(handed_in(notebook), released)
    assert intake.notebook.cells[3].source == "mine = 1"


def test_an_old_notebook_format_is_read(released, notebook):
    intake = restore(nbformat.writes(notebook, version=3).encode(), released)
    assert set(intake.statuses.values()) <= {"missing"}
    assert "cannot be read" not in " ".join(intake.problems)
