"""notebooks/ is what source/ gives, the same bytes each time, and holds nothing that students must not see."""

import ast
import json
from dataclasses import replace

import nbformat
import pytest
from support import NAMES, ROOT, points, points_by_hand

from autograder.course import Course, CourseError
from autograder.exercises import EXERCISES, key
from autograder.handout.release import public_key, release


def contents(folder):
    paths = (path for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts)
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def test_notebooks_are_what_source_gives(draft):
    assert release(draft) == [], "run `python3 -m autograder release`"
    assert contents(ROOT / "notebooks" / "transforms") == contents(draft.release)


def test_the_public_key_is_up_to_date():
    assert (ROOT / "source/transforms/transform_lab/key.json").read_text(encoding="utf-8") == public_key(Course(ROOT))


def test_releasing_again_changes_nothing(course, slow, monkeypatch):
    release(course)
    monkeypatch.setattr("autograder.handout.release.key", lambda *_: pytest.fail("cases were drawn again"))
    assert release(course) == []


def test_a_change_in_source_is_said(course, slow):
    path = course.source / "1_rotation.ipynb"
    notebook = nbformat.read(path, as_version=4)
    notebook.cells[0].source += "\n\nOne more sentence."
    nbformat.write(notebook, path)
    assert release(course) == ["changed: 1_rotation.ipynb"]


def test_every_exercise_has_one_test_cell_of_one_line():
    found = []
    for path in sorted((ROOT / "notebooks/transforms").glob("*.ipynb")):
        for cell in nbformat.read(path, as_version=4).cells:
            meta = cell.metadata.get("nbgrader", {})
            if meta.get("grade_id") in EXERCISES:
                name = meta["grade_id"]
                assert cell.source == f'check("{name}", {name})'
                assert (meta["grade"], meta["locked"], meta["solution"]) == (True, True, False)
                found.append(name)
    assert found == NAMES == [name for name in EXERCISES if name in found]


def test_released_notebooks_are_worth_what_their_sources_are():
    cells = [
        cell.metadata.get("nbgrader", {})
        for path in (ROOT / "notebooks/transforms").glob("*.ipynb")
        for cell in nbformat.read(path, as_version=4).cells
    ]
    assert sum(meta.get("points", 0) for meta in cells if meta.get("grade")) == points() + points_by_hand() > 0


def test_hand_graded_questions_are_in_notebooks_2_4_and_5():
    for name in ("2_homogeneous_transforms", "4_inversion", "5_pre_grasp"):
        notebook = nbformat.read(ROOT / f"notebooks/transforms/{name}.ipynb", as_version=4)
        metas = [cell.metadata.get("nbgrader", {}) for cell in notebook.cells if cell.cell_type == "markdown"]
        assert any(meta.get("grade") and meta.get("solution") for meta in metas), name


@pytest.mark.parametrize("folder", ["source", "notebooks"])
def test_notebooks_are_kept_without_outputs(folder):
    for path in sorted((ROOT / folder / "transforms").glob("*.ipynb")):
        for cell in nbformat.read(path, as_version=4).cells:
            assert not cell.get("outputs") and not cell.get("execution_count"), (path.name, cell.id)


def solutions():
    """The lines of every solution in source/ that are long enough to be told from other code."""
    lines = set()
    for path in (ROOT / "source/transforms").glob("*.ipynb"):
        for cell in nbformat.read(path, as_version=4).cells:
            if "### BEGIN SOLUTION" in cell.source:
                body = cell.source.partition("### BEGIN SOLUTION")[2].partition("### END SOLUTION")[0]
                lines |= {line.strip() for line in body.splitlines() if len(line.strip()) > 24}
    return lines


def test_no_solution_is_released():
    assert len(solutions()) > 20
    for path, content in contents(ROOT / "notebooks").items():
        text = content.decode("utf-8")
        plain = (
            "\n".join("".join(cell["source"]) for cell in json.loads(text)["cells"])
            if path.endswith(".ipynb")
            else text
        )
        assert "BEGIN SOLUTION" not in plain, path
        found = [line for line in solutions() if line in plain]
        assert not found, (path, found)


def test_the_released_package_defines_no_exercise():
    for path in (ROOT / "notebooks/transforms/transform_lab").glob("*.py"):
        defined = {node.name for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.FunctionDef)}
        assert not defined & set(EXERCISES), path.name


def test_the_key_does_not_hold_the_hidden_cases():
    """Special angles and the like are in both; the drawn cases, which a copied key would fail, are not."""
    released = json.loads((ROOT / "notebooks/transforms/transform_lab/key.json").read_text())["exercises"]
    for name, exercise in EXERCISES.items():
        if name == "hand_transform":  # it has no arguments: one case, which the exercise's text describes
            continue
        public = [(case["args"], case["kwargs"]) for case in released[name]["cases"]]
        alone = replace(exercise, misconceptions=())
        hidden = [(case["args"], case["kwargs"]) for case in key(alone, 12345)["cases"]]
        assert sum(case not in public for case in hidden) >= 5, name


def test_a_failed_release_leaves_the_notebooks_as_they_were(course):
    """nbgrader copies what lies beside the notebooks, and cannot where a link leads nowhere."""
    before = contents(course.release)
    (course.source / "data.csv").symlink_to("nowhere")
    with pytest.raises(CourseError, match="notebooks/ is as before: .*No such file or directory: .*data.csv"):
        release(course)
    assert contents(course.release) == before
