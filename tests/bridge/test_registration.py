"""The gradebook follows the notebooks as long as nobody's work is in it; after that, what it cannot follow is told."""

import re
import shutil

import pytest
from editing import Edited
from support import marks, nbgrader, run, scores, verdicts

from autograder.bridge import nbgrader_api
from autograder.bridge.gradebook import Writer
from autograder.course import Course, CourseError
from autograder.grading.grade import Graded
from autograder.grading.marks import Marks
from autograder.handout import source
from autograder.pages import report


def less(folder):
    with Edited(folder, "1_rotation") as edited:
        edited.remove_exercise("is_rotation")
        edited.say_points(5)


def more(folder):
    with Edited(folder, "3_chaining") as edited:
        edited.add_question("mine", 1)
        edited.say_points(5)


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
        edited.say_points(8)


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
    """{(notebook, graded cell): points} as the gradebook has them."""
    notebooks = writer.gradebook.find_assignment("transforms").notebooks
    return {(notebook.name, cell.name): cell.max_score for notebook in notebooks for cell in notebook.grade_cells}


def asked(course):
    """The same of the released notebooks."""
    return {
        (name, cell): points
        for name, released in course.notebooks.items()
        for cell, points in {**released.points, **released.questions}.items()
    }


def hand_in(course, student):
    with Writer(course) as writer:
        given = {
            name: Marks(dict.fromkeys(cells, 0.0), dict.fromkeys(cells))
            for name, cells in {name: released.cells for name, released in course.notebooks.items()}.items()
        }
        notebooks = {name: released.text for name, released in course.notebooks.items()}
        course.submitted(student).mkdir(parents=True)
        writer.record(Graded(student, [], notebooks, given))


@pytest.mark.parametrize("change", [*CHANGES, repriced], ids=lambda change: change.__name__)
def test_a_gradebook_without_submissions_follows_the_notebooks(draft, change):
    """As after a colleague's release that came by `git pull`: nobody runs `release` here."""
    with Writer(draft) as writer:
        before = registered(writer)
        assert before == asked(draft)
    change(draft.release)
    changed = Course(draft.root)
    with Writer(changed) as writer:
        writer.can_record()
        assert registered(writer) == asked(changed) != before


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
def test_where_a_student_has_handed_in_a_change_of_cells_is_refused_in_words(draft, change):
    hand_in(draft, "alice")
    change(draft.release)
    changed = Course(draft.root)
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


def test_release_refuses_before_it_touches_anything(draft):
    hand_in(draft, "alice")
    less(draft.source)
    before = draft.release_contents(), (draft.package / "key.json").read_bytes()
    code, said = run(draft, "release")
    assert code == 2 and "1_rotation.ipynb: is_rotation is no longer there." in said
    assert "db assignment remove transforms --force" in said and "(0 and 0 now)" in said
    assert (draft.release_contents(), (draft.package / "key.json").read_bytes()) == before


def test_other_points_are_followed_and_grades_given_by_hand_stay(draft):
    hand_in(draft, "alice")
    with Writer(draft) as writer:
        grade = writer.gradebook.find_grade("question-which-frame", "5_pre_grasp", "transforms", "alice")
        grade.manual_score = 1.5
        writer.gradebook.db.commit()
    repriced(draft.release)
    changed = Course(draft.root)
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
def test_nbgraders_own_reason_is_told(draft, change, reason):
    """Its last words are "Please see the the above traceback"; the reason stands in its log."""
    hand_in(draft, "alice")
    change(draft.source)
    with pytest.raises(CourseError, match=reason):
        nbgrader_api.call(draft, "generate_assignment", "transforms")


def test_a_changed_course_from_release_to_export_and_again(draft):
    """Dropped and added before anybody hands in; then by the steps that the refusal gives; then other points."""
    less(draft.source), more(draft.source)
    code, said = run(draft, "release")
    assert code == 0 and "changed: 1_rotation.ipynb" in said and "changed: transform_lab/key.json" in said
    for student, folder in (("alice", draft.source), ("bob", draft.release)):
        shutil.copytree(folder, draft.submitted(student))
    code, said = run(draft, "grade", "--unsafe-no-sandbox")
    assert code == 0, said
    exercises = [name for notebook in source.notebooks(draft).values() for name in notebook.points]
    most = sum(sum(notebook.points.values()) for notebook in draft.notebooks.values())
    in_all = most + sum(sum(notebook.questions.values()) for notebook in draft.notebooks.values())
    assert "is_rotation" not in exercises
    assert [row["exercise"] for row in verdicts(draft)] == exercises * 2
    assert (sum(scores(draft, "alice").values()), sum(scores(draft, "bob").values())) == (most, 0)
    page = (draft.feedback("alice") / "index.html").read_text()
    assert "why?" in page and f"of {in_all:g} points so far" in page and "is_rotation" not in page
    assert "why?" in (draft.reports / "index.html").read_text()
    assert f"alice,{most},{in_all},yes" in run(draft, "export")[1]

    with Edited(draft.source, "4_inversion") as edited:
        edited.add_question("later", 1)
        edited.say_points(9)
    code, said = run(draft, "release")
    assert code == 2 and "the work of 2 students" in said and "4_inversion.ipynb: later is new." in said
    steps = re.findall(r"`(nbgrader db[^`]*|python3 -m autograder (?:release|grade))`", said)
    assert len(steps) == 3
    for step in steps:
        words = step.split()
        if words[0] == "nbgrader":
            assert nbgrader(draft, *words[1:]).returncode == 0
        else:
            code, said = run(draft, *words[3:], *(["--unsafe-no-sandbox"] if words[-1] == "grade" else []))
            assert code == 0, said
    assert f"alice,{most},{in_all + 1},yes" in run(draft, "export")[1]
    assert marks(draft)["alice", "4_inversion", "later comment"] == "No response."

    with Edited(draft.source, "2_homogeneous_transforms") as edited:
        edited.named("make_transform").metadata.nbgrader.points = 0
        edited.replace("`make_transform` (1 point)", "`make_transform` (0 points)")
        edited.named("transform_point").metadata.nbgrader.points = 4
        edited.replace("`transform_point` (2 points)", "`transform_point` (4 points)")
        edited.say_points(15)
    assert run(draft, "release")[0] == 0
    code, said = run(draft, "grade", "--unsafe-no-sandbox")
    assert code == 0 and "2 graded" in said and "set back" not in said
    assert (scores(draft, "alice")["make_transform"], scores(draft, "alice")["transform_point"]) == (0, 4)
    assert f"alice,{most + 1},{in_all + 2},yes" in run(draft, "export")[1]
