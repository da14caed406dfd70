"""The gradebook follows the notebooks as long as nobody's work is in it; after that, what it cannot follow is told."""

import re
import shutil

import pytest
from editing import Edited
from support import marks, run, scores, verdicts

from autograder.bridge import nbgrader_api
from autograder.bridge.gradebook import Writer
from autograder.course import Course, CourseError
from autograder.grading.grade import Graded
from autograder.grading.marks import Marks
from autograder.handout import release as handout
from autograder.handout import source
from autograder.pages import report


def less(folder):
    with Edited(folder, "1_rotation") as edited:
        edited.remove_exercise("is_rotation")
        edited.say_points()


def more(folder):
    with Edited(folder, "3_chaining") as edited:
        edited.add_question("mine", 1)
        edited.say_points()


def renamed(folder):
    shutil.move(folder / "5_pre_grasp.ipynb", folder / "5_grasp.ipynb")
    with Edited(folder, "5_grasp") as edited:
        edited.replace('sum_up("5_pre_grasp")', 'sum_up("5_grasp")')


def regraded(folder):
    """From now on, people grade an exercise: the same cell, in another way."""
    with Edited(folder, "4_inversion") as edited:
        edited.named("invert_transform").metadata.nbgrader.update(solution=True, locked=False)


def repriced(folder):
    with Edited(folder, "1_rotation") as edited:
        edited.named("rotation_about_z").metadata.nbgrader.points = 3
        edited.replace("`rotation_about_z` (2 points)", "`rotation_about_z` (3 points)")
        edited.say_points()


# {change of notebooks: what is said of it where it is too late}
CHANGES = {
    less: [
        "1_rotation.ipynb: is_rotation is no longer there",
        "1_rotation.ipynb: is_rotation-solution is no longer there",
    ],
    more: ["3_chaining.ipynb: mine is new"],
    renamed: ["5_pre_grasp.ipynb is no longer there", "5_grasp.ipynb is new"],
    regraded: ["4_inversion.ipynb: invert_transform is graded in another way"],
}


def registered(writer):
    """{(notebook, cell): its points or None, for each way in which nbgrader keeps it} of the gradebook."""
    found = {}
    for notebook in writer.gradebook.find_assignment("transforms").notebooks:
        for cell in (*notebook.grade_cells, *notebook.solution_cells):
            found.setdefault((notebook.name, cell.name), set()).add(getattr(cell, "max_score", None))
    return found


def asked(course):
    """The same of the released notebooks."""
    return {
        (name, cell.metadata.nbgrader.grade_id): {
            *([cell.metadata.nbgrader.points] if cell.metadata.nbgrader.grade else []),
            *([None] if cell.metadata.nbgrader.solution else []),
        }
        for name, released in course.notebooks.items()
        for cell in released.cells.values()
    }


@pytest.fixture(scope="module")
def handed_in(released, tmp_path_factory):
    """A course with one student's work in its gradebook; not to be changed by tests."""
    root = tmp_path_factory.mktemp("course") / "handed_in"
    shutil.copytree(released.root, root)
    course = Course(root)
    marks = {
        name: Marks(dict.fromkeys(notebook.cells, 0.0), dict.fromkeys(notebook.cells))
        for name, notebook in course.notebooks.items()
    }
    course.submitted("alice").mkdir(parents=True)
    with Writer(course) as writer:
        writer.record(Graded("alice", [], {name: of.text for name, of in course.notebooks.items()}, marks))
    return course


@pytest.fixture
def taken(handed_in, tmp_path):
    """Such a course of the test's own."""
    shutil.copytree(handed_in.root, tmp_path / "taken")
    return Course(tmp_path / "taken")


@pytest.mark.parametrize("change", [*CHANGES, repriced], ids=lambda change: change.__name__)
def test_a_gradebook_without_submissions_follows_the_notebooks(course, change):
    """As after a colleague's release that came by `git pull`: nobody runs `release` here."""
    with Writer(course) as writer:
        before = registered(writer)
        assert before == asked(course)
    change(course.release)
    changed = Course(course.root)
    with Writer(changed) as writer:
        writer.can_record()
        assert registered(writer) == asked(changed) != before


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
def test_where_a_student_has_handed_in_a_change_of_cells_is_refused_in_words(taken, change):
    change(taken.release)
    changed = Course(taken.root)
    with Writer(changed) as writer:
        with pytest.raises(CourseError) as refused:
            writer.can_record()
        said = str(refused.value)
        assert "the work of 1 student," in said and all(f"  {line}.\n" in said for line in CHANGES[change])
        report.write(changed, writer)  # what is there can be looked at
        writer.remove("alice")
    with Writer(changed) as writer:
        writer.can_record()
        assert registered(writer) == asked(changed)


def test_release_refuses_before_it_touches_anything(taken):
    less(taken.source)
    before = taken.release_contents(), (taken.package / "key.json").read_bytes()
    code, said = run(taken, "release")
    assert code == 2 and "1_rotation.ipynb: is_rotation is no longer there." in said
    assert "db assignment remove transforms --force" in said and "(0 and 0 now)" in said
    assert (taken.release_contents(), (taken.package / "key.json").read_bytes()) == before


def test_other_points_are_followed_and_grades_given_by_hand_stay(taken):
    with Writer(taken) as writer:
        grade = writer.gradebook.find_grade("question-which-frame", "5_pre_grasp", "transforms", "alice")
        grade.manual_score = 1.5
        writer.gradebook.db.commit()
    repriced(taken.release)
    changed = Course(taken.root)
    with Writer(changed) as writer:
        writer.can_record()
        assert registered(writer) == asked(changed)
        grades = writer.grades()["alice"]
    assert grades["5_pre_grasp"].cells["question-which-frame"].earned == 1.5
    assert grades["1_rotation"].cells["rotation_about_z"].most == 3


def duplicated(folder):
    with Edited(folder, "1_rotation") as edited:
        edited.named("is_rotation").metadata.nbgrader.grade_id = "same_rotation"


def endless(folder):
    with Edited(folder, "1_rotation") as edited:
        edited.replace("### END SOLUTION", "### the end")


@pytest.mark.parametrize(
    "change, reason",
    [
        (duplicated, "Duplicate grade id: same_rotation"),
        (endless, "no end solution statement found"),
        (less, "Cannot add or remove cells for notebook '1_rotation'"),
        (renamed, "Cannot modify existing assignment"),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_nbgraders_own_reason_is_told(taken, change, reason):
    """Its last words are "Please see the the above traceback"; the reason stands in its log."""
    change(taken.source)
    with pytest.raises(CourseError, match=reason):
        nbgrader_api.call(taken, "generate_assignment", "transforms")


def with_solutions(course, student):
    """Hand in the released notebooks, filled in as in source/."""
    solutions = source.notebooks(course)
    shutil.copytree(course.release, course.submitted(student))
    for name in course.notebooks:
        with Edited(course.submitted(student), name) as edited:
            for cell in edited.notebook.cells:
                nbgrader = cell.metadata.get("nbgrader", {})
                if nbgrader.get("solution"):
                    cell.source = solutions[name].cells[nbgrader.grade_id].source


def graded(course):
    """Grade all; what was printed."""
    code, said = run(course, "grade", "--unsafe-no-sandbox")
    assert code == 0, said
    return said


def most(course):
    """(points for exercises, points for all) of a course."""
    notebooks = Course(course.root).notebooks.values()
    exercises, questions = (sum(sum(getattr(n, of).values()) for n in notebooks) for of in ("points", "questions"))
    return exercises, exercises + questions


def test_a_changed_course_from_release_to_export_and_again(course, nbgrader):
    """An exercise dropped and a question added before anybody hands in; then other points; then one question more."""
    less(course.source)
    more(course.source)
    assert {"changed: 1_rotation.ipynb", "changed: 3_chaining.ipynb"} < set(handout.release(course))
    with_solutions(course, "alice")
    shutil.copytree(course.release, course.submitted("bob"))
    graded(course)
    exercises, in_all = most(course)
    names = [name for notebook in Course(course.root).notebooks.values() for name in notebook.points]
    assert "is_rotation" not in names and [row["exercise"] for row in verdicts(course)] == names * 2
    assert (sum(scores(course, "alice").values()), sum(scores(course, "bob").values())) == (exercises, 0)
    page = (course.feedback("alice") / "index.html").read_text()
    assert "why?" in page and f"{exercises:g} of {in_all:g} points so far" in page and "is_rotation" not in page
    assert "why?" in (course.reports / "index.html").read_text()
    assert f"alice,{exercises},{in_all},yes" in run(course, "export")[1]

    with Edited(course.source, "2_homogeneous_transforms") as edited:
        edited.named("make_transform").metadata.nbgrader.points = 0
        edited.replace("`make_transform` (1 point)", "`make_transform` (0 points)")
        edited.named("transform_point").metadata.nbgrader.points = 4
        edited.replace("`transform_point` (2 points)", "`transform_point` (4 points)")
        edited.say_points()
    handout.release(course)
    said = graded(course)
    assert "2 graded" in said and "set back" not in said
    assert (scores(course, "alice")["make_transform"], scores(course, "alice")["transform_point"]) == (0, 4)
    assert most(course) == (exercises + 1, in_all + 1)
    assert f"alice,{exercises + 1},{in_all + 1},yes" in run(course, "export")[1]

    with Edited(course.source, "4_inversion") as edited:
        edited.add_question("later", 1)
        edited.say_points()
    with pytest.raises(CourseError) as refused:
        handout.release(course)
    said = str(refused.value)
    assert "the work of 2 students" in said and "4_inversion.ipynb: later is new." in said
    removal, *others = re.findall(r"`(nbgrader db[^`]*|python3 -m autograder (?:release|grade))`", said)
    assert others == ["python3 -m autograder release", "python3 -m autograder grade"]
    assert nbgrader(course, *removal.split()[1:]).returncode == 0
    assert "changed: 4_inversion.ipynb" in handout.release(course)
    graded(course)
    assert f"alice,{exercises + 1},{in_all + 2},yes" in run(course, "export")[1]
    *_, waits = marks(course)["alice", "4_inversion", "later"]  # nobody could have answered it: a person looks
    assert waits and marks(course)["alice", "4_inversion", "later comment"] is None
