"""What an instructor changes when work is handed in already: it holds for everybody, and nothing that a person gave is lost."""

import csv
import re
from datetime import datetime

import pytest
from support import points, points_by_hand, run, scores, verdicts

from autograder.bridge.gradebook import Writer

QUESTION, ITS_NOTEBOOK = "question-which-frame", "5_pre_grasp"
ALICE = ("3_chaining", ITS_NOTEBOOK)
DUE = datetime(2026, 11, 18, 12)
HANDED_IN = "2026-11-20 12:00:00 UTC"  # two days late


@pytest.fixture
def handed_in(course, hand_in, solved, slow):
    """A graded course: alice has handed in two notebooks, two days after what will be due; bob one, without a time."""
    hand_in(course, "alice", {name: solved[name] for name in ALICE})
    (course.submitted("alice") / "timestamp.txt").write_text(HANDED_IN)
    hand_in(course, "bob", {"1_rotation": solved["1_rotation"]})
    graded(course)
    return course


def graded(course, *options):
    """Grade; what was printed."""
    code, said = run(course, "grade", "--unsafe-no-sandbox", *options)
    assert code == 0, said
    return said


def due(course, when):
    with Writer(course) as writer:
        writer.gradebook.find_assignment("transforms").duedate = when
        writer.gradebook.db.commit()


def configure(course, lines):
    with open(course.root / "nbgrader_config.py", "a", encoding="utf-8") as file:
        file.write(f"\n{lines}\n")


def give(course, student, notebook, cell, points):
    """A person gives points, as the formgrader records them."""
    with Writer(course) as writer:
        grade = writer.gradebook.find_grade(cell, notebook, "transforms", student)
        grade.manual_score, grade.needs_manual_grade = points, False
        writer.gradebook.db.commit()


def waits(course, student, notebook, cell):
    with Writer(course) as writer:
        return writer.grades()[student][notebook].cells[cell].waiting


def exported(course):
    with open(course.reports / "grades.csv", newline="", encoding="utf-8") as file:
        return {row["student_id"]: row for row in csv.DictReader(file)}


def score(course, student):
    return float(exported(course)[student]["score"])


# --- late -----------------------------------------------------------------------------------------------------------

UNSAFE = "--Exporter.unsafe_no_sandbox=True"
ZERO = "c.LateSubmissionPlugin.penalty_method = 'zero'"


def test_a_due_date_a_policy_and_an_extension_hold_whenever_they_are_set(handed_in, nbgrader):
    due(handed_in, DUE)
    graded(handed_in)
    assert score(handed_in, "alice") == points(*ALICE)  # late, which costs nothing
    configure(handed_in, ZERO)
    said = graded(handed_in)
    assert score(handed_in, "alice") == 0 and "0 graded" in said and score(handed_in, "bob") == points("1_rotation")
    assert "taken off" in (handed_in.feedback("alice") / f"{ITS_NOTEBOOK}.html").read_text()

    code, said = run(handed_in, "extend", "alice", "--days", "1")
    assert code == 0 and "due 2026-11-19 12:00 UTC, handed in 2026-11-20 12:00 UTC: 1 day, 0:00:00 late" in said
    code, said = run(handed_in, "extend", "alice", "--days", "1.5", "--hours", "12")
    assert code == 0 and "not late" in said
    assert "0 graded" in graded(handed_in) and score(handed_in, "alice") == points(*ALICE)
    assert "taken off" not in (handed_in.feedback("alice") / f"{ITS_NOTEBOOK}.html").read_text()
    graded(handed_in, "--force")
    assert score(handed_in, "alice") == points(*ALICE)  # it is not forgotten
    assert nbgrader(handed_in, "autograde", "transforms", "--student", "alice", "--force", UNSAFE).returncode == 0
    graded(handed_in)
    assert score(handed_in, "alice") == points(*ALICE)

    assert "late, which costs" in run(handed_in, "extend", "alice")[1]
    graded(handed_in)
    assert score(handed_in, "alice") == 0
    due(handed_in, datetime(2026, 12, 1))
    graded(handed_in)
    assert score(handed_in, "alice") == points(*ALICE)


def test_who_is_late_is_so_for_what_a_person_gives_later_too(handed_in):
    due(handed_in, DUE)
    configure(handed_in, ZERO)
    graded(handed_in)
    give(handed_in, "alice", ITS_NOTEBOOK, QUESTION, 1.5)
    graded(handed_in)
    assert score(handed_in, "alice") == 0


@pytest.mark.parametrize(
    "lines, words",
    [
        ("c.AssignLatePenalties.plugin_class = 'no_such_module.Plugin'", "no_such_module"),
        (
            "from nbgrader.plugins import LateSubmissionPlugin\nclass Mine(LateSubmissionPlugin):\n"
            "    def late_submission_penalty(self, *_):\n        raise ValueError('no such day')\n"
            "c.AssignLatePenalties.plugin_class = Mine",
            "ValueError: no such day",
        ),
    ],
    ids=["not there", "fails"],
)
def test_a_policy_that_fails_is_said_and_costs_nobody_anything(handed_in, lines, words):
    due(handed_in, DUE)
    before = (handed_in.reports / "verdicts.csv").read_bytes()
    configure(handed_in, lines)
    for options in ((), ("--force",)):
        code, said = run(handed_in, "grade", "--unsafe-no-sandbox", *options)
        assert code == 2 and words in said and "nbgrader_config.py" in said and "Traceback" not in said
    assert (handed_in.reports / "verdicts.csv").read_bytes() == before


def test_an_extension_that_nobody_can_have_is_refused_in_words(handed_in):
    code, said = run(handed_in, "extend", "alice", "--days", "1")
    assert code == 2 and "no due date" in said and "nbgrader db assignment add transforms --duedate" in said
    due(handed_in, DUE)
    code, said = run(handed_in, "extend", "carol", "--days", "1")
    assert code == 2 and "carol" in said and "grade it first" in said
    assert run(handed_in, "extend", "alice", "--days", "-1")[0] == 2


# --- by hand --------------------------------------------------------------------------------------------------------


def test_points_that_a_person_gives_are_the_same_everywhere_and_are_told(handed_in):
    assert not any("by_hand" in row for row in verdicts(handed_in)) and "by_hand" not in exported(handed_in)["bob"]
    give(handed_in, "alice", "3_chaining", "chain", 0.5)
    said = graded(handed_in)
    less = points(*ALICE) - points("3_chaining") / 2 + 0.5
    said = " ".join(said.split())
    assert f"alice {less:g} of {points():g} " in said and "points by hand (chain)" in said
    assert (scores(handed_in, "alice")["chain"], score(handed_in, "alice")) == (0.5, less)
    told = {(row["student"], row["exercise"]): row["by_hand"] for row in verdicts(handed_in)}
    assert [of for of, by_hand in told.items() if by_hand] == [("alice", "chain")]
    assert {who: row["by_hand"] for who, row in exported(handed_in).items()} == {"alice": "chain", "bob": ""}
    assert f"alice,{less},{points() + points_by_hand()},yes" in run(handed_in, "export")[1]
    assert "chain 0.5 of 2 (points by hand)" in run(handed_in, "export", "--format", "moodle")[1]
    page = (handed_in.reports / "index.html").read_text()
    assert "Points given by hand in the grader's place: 1 student" in page
    assert re.search(r"<code>chain</code></a>\s+2 → 0.5", page)
    assert "0.5 of 2, given by a person" in (handed_in.feedback("alice") / "index.html").read_text()
    assert "points by hand (chain)" in " ".join(graded(handed_in).split())  # also when there is nothing new


def test_what_a_person_gave_survives_any_grading_and_is_looked_at_again_where_the_work_is_another(handed_in):
    give(handed_in, "alice", ITS_NOTEBOOK, QUESTION, 1.5)
    give(handed_in, "alice", "3_chaining", "chain", 0.5)
    given = [(ITS_NOTEBOOK, QUESTION), ("3_chaining", "chain")]
    for options in ((), ("--force",), ("alice", "--force"), ("--seed", "3")):
        graded(handed_in, *options)
        assert [waits(handed_in, "alice", *cell) for cell in given] == [False, False]
        assert (score(handed_in, "alice"), scores(handed_in, "alice")["chain"]) == (points(*ALICE) + 1.5 - 1.5, 0.5)

    path = handed_in.submitted("alice") / f"{ITS_NOTEBOOK}.ipynb"
    path.write_text(path.read_text().replace('"import numpy', '"# once more\\n", "import numpy', 1))
    graded(handed_in)
    assert not waits(handed_in, "alice", ITS_NOTEBOOK, QUESTION)  # other code is no other answer
    answer = "In the frame of the object, of course."
    text = path.read_text()
    path.write_text(_answered(text, QUESTION, answer))
    graded(handed_in)
    assert waits(handed_in, "alice", ITS_NOTEBOOK, QUESTION) and not waits(handed_in, "alice", "3_chaining", "chain")
    assert score(handed_in, "alice") == points(*ALICE)  # and counts until somebody has looked

    path = handed_in.submitted("alice") / "3_chaining.ipynb"
    path.write_text(path.read_text().replace("def chain(", "def chain(  "))
    graded(handed_in)
    assert waits(handed_in, "alice", "3_chaining", "chain") and scores(handed_in, "alice")["chain"] == 0.5


def _answered(text, question, answer):
    import nbformat

    notebook = nbformat.reads(text, as_version=4)
    for cell in notebook.cells:
        if cell.metadata.get("nbgrader", {}).get("grade_id") == question:
            cell.source = answer
    return nbformat.writes(notebook)


def test_one_student_is_graded_again_and_nobody_else(handed_in):
    def files(student):
        folders = handed_in.autograded(student), handed_in.feedback(student)
        return {path: path.read_bytes() for folder in folders for path in folder.iterdir()}

    alice, bob = files("alice"), files("bob")
    said = graded(handed_in, "alice", "--force")
    assert "1 graded" in said and "bob" not in said
    assert files("bob") == bob and files("alice").keys() == alice.keys() and files("alice") != alice
    assert {row["student"] for row in verdicts(handed_in)} == {"alice", "bob"}
