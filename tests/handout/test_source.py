"""What instructors may change in source/, and what `release` says of mistakes there before nbgrader makes anything of them."""

import json
import shutil

import pytest
from editing import Edited
from support import ASKED, run

from autograder.course import CourseError
from autograder.handout import source


def said(course):
    with pytest.raises(CourseError) as error:
        source.notebooks(course)
    return str(error.value)


def test_headings_and_openings_say_the_points_of_the_cells(draft):
    """In every notebook, of every exercise and question: one point more in nbgrader's cell is told for each of them."""
    wanted = []
    for name, released in ASKED.items():
        graded = released.points | released.questions
        with Edited(draft.source, name) as edited:
            for cell, points in graded.items():
                edited.named(cell).metadata.nbgrader.points = points + 1
                wanted.append(f"says {source._said(points)}, the cell {cell} {source._said(points + 1)}.")
        most = sum(graded.values())
        wanted.append(
            f"{name}.ipynb: its opening says {most:g} points, its cells {most + len(graded):g} points in all."
        )
    lines = said(draft).splitlines()[1:]
    assert len(lines) == len(wanted)
    assert all(any(line.endswith(words) for line in lines) for words in wanted)


def test_other_points_are_fine_when_they_are_said_everywhere(draft):
    with Edited(draft.source, "1_rotation") as edited:
        edited.named("is_rotation").metadata.nbgrader.points = 0.5
        edited.replace("`is_rotation` (2 points)", "`is_rotation` (0.5 points)")
        edited.say_points(sum(ASKED["1_rotation"].points.values()) - 1.5)
    assert source.notebooks(draft)["1_rotation"].points["is_rotation"] == 0.5


@pytest.mark.parametrize("position", [0, -1])
def test_an_exercise_may_be_dropped(draft, position):
    """The first of each notebook, or the last."""
    for name, released in ASKED.items():
        gone = list(released.points)[position]
        with Edited(draft.source, name) as edited:
            edited.remove_exercise(gone)
            edited.say_points(sum((released.points | released.questions).values()) - released.points[gone])
    found = source.notebooks(draft)
    for name, released in ASKED.items():
        kept = dict(released.points)
        del kept[list(kept)[position]]
        assert found[name].points == kept and found[name].questions == released.questions


@pytest.mark.parametrize("level", ["##", "###"])
def test_a_question_may_be_added(draft, level):
    with Edited(draft.source, "3_chaining") as edited:
        edited.add_question("mine", 1, f"{level} Question: why? (1 point, read by a person)")
        edited.say_points(sum(ASKED["3_chaining"].points.values()) + 1)
    notebook = source.notebooks(draft)["3_chaining"]
    assert notebook.questions == {"mine": 1.0} and notebook.section("mine").startswith("Question: why?")


def metadata(name, **changes):
    def change(edited):
        edited.named(name).metadata.nbgrader.update(changes)

    return change


def without(name, key):
    def change(edited):
        del edited.named(name).metadata.nbgrader[key]

    return change


def removed(*names):
    def change(edited):
        edited.remove(*map(edited.named, names))

    return change


def text(old, new):
    return lambda edited: edited.replace(old, new)


def question(**arguments):
    return lambda edited: edited.add_question(**{"name": "mine", "points": 1, **arguments})


def as_code(edited):
    cell = edited.named("question-which-frame")
    cell.metadata.nbgrader.update(grade_id="waypoint-2", solution=False)
    cell.update(cell_type="code", outputs=[], execution_count=None, source="assert True")


def as_task(edited):
    cell = edited.named("question-which-frame")
    cell.source = "Which way is up?"
    cell.metadata.nbgrader.update(task=True, grade=False, solution=False, locked=True)


def of_other_type(edited):
    cell = edited.named("waypoint")
    del cell["outputs"], cell["execution_count"]
    cell.cell_type = "markdown"


# {what an instructor did to notebook 5: (the change, words that `release` has for it)}
MISTAKES = {
    "a typing error in a test cell's name": (metadata("waypoint", grade_id="waypiont"), "did you mean waypoint?"),
    "a test of no exercise": (as_code, "the test cell waypoint-2 has no exercise of this name"),
    "a test cell of another exercise": (metadata("waypoint", grade_id="chain"), 'the one line check("chain", chain)'),
    "a test cell of another text": (
        text('check("waypoint", waypoint)', "assert True"),
        "the test cell waypoint has to be",
    ),
    "a written answer named as an exercise": (metadata("question-which-frame", grade_id="chain"), "another grade_id"),
    "a task": (as_task, "make it a manually graded answer"),
    "two cells of one name": (
        metadata("question-which-frame", grade_id="pre_grasp"),
        "2 cells have the grade_id pre_grasp",
    ),
    "a solution without its test": (removed("waypoint"), "waypoint-solution is there without a test cell waypoint"),
    "a heading without its cells": (removed("waypoint", "waypoint-solution"), "no graded cell below it"),
    "cells that use a function that is gone": (
        removed("waypoint", "waypoint-solution"),
        "it uses waypoint, which is no exercise of this notebook",
    ),
    "cells without their heading": (text("### Exercise: `waypoint` (2 points)", ""), "waypoint has no heading"),
    "a heading without points": (
        text("`waypoint` (2 points)", "`waypoint`"),
        "says no points, the cell waypoint 2 points",
    ),
    "a heading of another exercise": (
        text("Exercise: `waypoint`", "Exercise: `chain`"),
        "the heading above waypoint is",
    ),
    "a question without a heading": (question(heading="Why?"), "mine has no heading: write `## Question: … (1 point)`"),
    "a question of other points": (question(points=2), "says 1 point, the cell mine 2 points"),
    "negative points": (metadata("waypoint", points=-1), "points: -1 is less than the minimum"),
    "points in words": (metadata("waypoint", points="two"), "points: 'two' is not of type 'number'"),
    "no points": (without("waypoint", "points"), "'waypoint' does not have points"),
    "no flag": (without("waypoint-solution", "solution"), "'solution' is a required property"),
    "an odd name": (metadata("waypoint", grade_id="way point"), "grade_id: 'way point' does not match"),
    "metadata of long ago": (metadata("waypoint", schema_version=1), "run `nbgrader update source/transforms`"),
    "metadata of the future": (metadata("waypoint", schema_version=9), "of a newer nbgrader"),
    "a test cell of another type": (of_other_type, "not marked as a solution cell"),
    "a solution that does not end": (text("### END SOLUTION", "### the end"), "no end solution statement found"),
    "a solution in a solution": (text("### BEGIN SOLUTION", "### BEGIN SOLUTION\n### BEGIN SOLUTION"), "nested begin"),
    "a solution where none is cleared": (
        text("sum_up(", "### BEGIN SOLUTION\n### END SOLUTION\nsum_up("),
        "non-solution",
    ),
    "another notebook summed up": (text('sum_up("5_pre_grasp")', 'sum_up("5")'), 'has to be sum_up("5_pre_grasp")'),
}


@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_mistake_is_told_in_words(draft, mistake):
    change, words = MISTAKES[mistake]
    with Edited(draft.source, "5_pre_grasp") as edited:
        change(edited)
    lines = said(draft).splitlines()
    assert "notebooks/ is as before" in lines[0]
    assert any(line.startswith("  5_pre_grasp.ipynb") and words in line for line in lines[1:]), "\n".join(lines)


def broken(change):
    """A file's text after its JSON was changed by a function."""

    def text(before):
        raw = json.loads(before)
        change(raw)
        return json.dumps(raw)

    return text


FILES = {
    "nothing": (lambda text: "", "it is not JSON"),
    "half a file": (lambda text: text[: len(text) // 2], "it is not JSON"),
    "a merge's conflict": (lambda text: "<<<<<<< HEAD\n{\n=======\n" + text + ">>>>>>> theirs\n", "conflict marks"),
    "no notebook": (lambda text: "[]", "it is not a Jupyter notebook"),
    "no format": (broken(lambda raw: raw.pop("nbformat")), "nbformat have to be in it"),
    "a cell without metadata": (broken(lambda raw: raw["cells"][3].pop("metadata")), "cell 4 has no metadata"),
    "a cell that is none": (broken(lambda raw: raw["cells"].insert(2, 5)), "cell 3 has no cell_type"),
    "a cell of an unknown type": (broken(lambda raw: raw["cells"][3].update(cell_type="song")), "cells 3"),
    "a source that is no text": (broken(lambda raw: raw["cells"][3].update(source=5)), "cells 3 source: 5"),
    "bytes": (lambda text: b"\xff\xfe", "it is not a Jupyter notebook ('utf-8' codec"),
}


@pytest.mark.parametrize("file", FILES)
def test_a_damaged_file_is_named(draft, file):
    change, words = FILES[file]
    path = draft.source / "2_homogeneous_transforms.ipynb"
    content = change(path.read_text(encoding="utf-8"))
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    (_, line) = said(draft).splitlines()
    assert line.startswith("  2_homogeneous_transforms.ipynb: ") and words in line


def test_a_damaged_released_notebook_is_named(draft):
    (draft.release / "3_chaining.ipynb").write_text("<<<<<<< HEAD\n")
    with pytest.raises(
        CourseError, match=r"notebooks/transforms/3_chaining.ipynb: .*conflict marks.*autograder release"
    ):
        draft.notebooks  # noqa: B018


def test_all_mistakes_are_told_at_once(draft):
    (draft.source / "1_rotation.ipynb").write_text("{")
    shutil.copy(draft.source / "3_chaining.ipynb", draft.source / "3_chaining-Copy1.ipynb")
    with Edited(draft.source, "4_inversion") as edited:
        edited.say_points(99)
        edited.named("invert_transform").metadata.nbgrader.points = -1
    told = said(draft)
    for words in ("1_rotation.ipynb: it is not JSON", "3_chaining-Copy1.ipynb, cell", "4_inversion.ipynb, cell"):
        assert words in told


def test_an_exercise_belongs_to_one_notebook(draft):
    shutil.copy(draft.source / "3_chaining.ipynb", draft.source / "6_again.ipynb")
    with Edited(draft.source, "6_again") as edited:
        edited.replace('sum_up("3_chaining")', 'sum_up("6_again")')
    told = said(draft)
    for name in ASKED["3_chaining"].points:
        assert f"{name} is tested in 3_chaining and 6_again" in told


def test_a_source_without_notebooks(draft):
    for path in draft.source.glob("*.ipynb"):
        path.unlink()
    assert "there is no notebook in it" in said(draft)


def test_release_says_it_without_a_traceback(draft):
    with Edited(draft.source, "1_rotation") as edited:
        edited.say_points(99)
    code, told = run(draft, "release")
    assert code == 2 and "1_rotation.ipynb: its opening says 99 points" in told
    assert not draft.gradebook.exists()


def test_another_name_of_the_assignment_is_refused_in_words(draft):
    draft.source.rename(draft.root / "source" / "lab3")
    for command in (["release"], ["grade"], ["check", "."]):
        code, told = run(draft.root, *command)
        assert code == 2 and "`mv source/lab3 source/transforms`" in told and "course_id" in told
