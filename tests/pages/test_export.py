"""Points as CSV: read back with the csv module, by the columns that Canvas and Moodle document."""

import csv
import io
import random
from datetime import datetime

import pytest
from nbgrader.api import Grade, SubmittedAssignment, SubmittedNotebook
from sqlalchemy import event, select
from support import points, points_by_hand, run

from autograder.bridge.gradebook import Writer
from autograder.course import CourseError
from autograder.grading.grade import Graded
from autograder.grading.judge import Row
from autograder.grading.marks import Marks
from autograder.pages import export

MOST = str(points() + points_by_hand())
PEOPLE = {
    "ada": {"first_name": "Ada", "last_name": "Lovelace", "email": "ada@example.org", "lms_user_id": "1815"},
    "joerg": {"first_name": 'Jörg "Jojo"', "last_name": "Müller, Jr.", "email": "j@example.org", "lms_user_id": "3f2a"},
    "zoë": {},
}


@pytest.fixture
def graded(course):
    """A course with three students in its gradebook, and a fourth who has handed nothing in."""
    with Writer(course) as writer:
        for student, known in PEOPLE.items():
            put(writer, student, 1.5)
            writer.gradebook.update_or_create_student(student, **known)
        writer.gradebook.update_or_create_student(
            "absent", first_name="Nobody", last_name="Here", email="n@example.org"
        )
    return course


def put(writer, student, points, answered=True):
    """Record a submission with so many points for the first exercise, and for every written question one point."""
    rows = [Row("1_rotation", "rotation_about_z", points, 2.0, "graded", "degrees-as-radians")]
    marks = {}
    for name, released in writer.course.notebooks.items():
        grades = [name for name, cell in released.cells.items() if cell.metadata.nbgrader.grade]
        scores = {cell: 0.0 if cell in released.points else None for cell in grades}
        comments = {cell: None for cell in released.cells}
        marks[name] = Marks(scores, comments)
    marks["1_rotation"].scores["rotation_about_z"] = points
    notebooks = {name: released.text for name, released in writer.course.notebooks.items()}
    writer.record(Graded(student, rows, notebooks, marks))


def table(course, name, column="transforms"):
    """The rows of a format, read back."""
    return exported(course, name, column)[0]


def exported(course, name, column="transforms"):
    """(the rows of a format, read back; who was left out)"""
    with Writer(course) as writer:
        found = export.totals(writer.gradebook)
        text, left_out = export.text(course, writer.gradebook, found, name, column)
        return list(csv.reader(io.StringIO(text))), left_out


def remarks(course, name):
    with Writer(course) as writer:
        return list(export.remarks(export.totals(writer.gradebook), name))


def test_a_plain_table(graded):
    assert table(graded, "plain") == [
        ["student", "score", "max_score", "needs_manual_grade"],
        *([student, "1.5", MOST, "yes"] for student in sorted(PEOPLE)),
        ["absent", "0", MOST, "nothing handed in"],
    ]


def test_who_handed_nothing_in_is_said_and_gets_no_row_in_an_lms(graded):
    with Writer(graded) as writer:
        missing = export.absent(writer.gradebook)
        assert [student.id for student in missing] == ["absent"]
        for name in ("canvas", "moodle"):
            lines = list(export.remarks(export.totals(writer.gradebook), name, missing))
            assert (
                "In the class, nothing handed in, and not in the table, so that no grade is changed: absent." in lines
            )
            assert not [row for row in table(graded, name) if "absent" in row or "Nobody" in row]


def test_the_columns_of_canvas(graded):
    assert table(graded, "canvas", "Transforms, part 1 (4711)") == [
        ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Transforms, part 1 (4711)"],
        ["Points Possible", "", "", "", "", MOST],
        ["Lovelace, Ada", "1815", "", "ada", "", "1.5"],
        # an id that only begins with a number would be read as 3
        ['Müller, Jr., Jörg "Jojo"', "", "3f2a", "joerg", "", "1.5"],
        ["", "", "", "zoë", "", "1.5"],
    ]


def test_the_columns_of_moodle(graded):
    header, ada, joerg, zoe = table(graded, "moodle")
    who = ["First name", "Last name", "Username", "ID number", "Email address"]
    assert header == [*who, "transforms", "transforms (feedback)"]
    assert ada[:6] == ["Ada", "Lovelace", "ada", "1815", "ada@example.org", "1.5"]
    assert joerg[:6] == ['Jörg "Jojo"', "Müller, Jr.", "joerg", "3f2a", "j@example.org", "1.5"]
    assert zoe[:6] == ["", "", "zoë", "", "", "1.5"]


def test_the_feedback_for_moodle_names_what_was_found(course, hand_in, solved, sandboxed):
    hand_in(course, "alice", {"3_chaining": solved["3_chaining"]})
    assert run(course, "grade", "--no-feedback")[0] == 0
    feedback = table(course, "moodle")[1][6]
    assert "chain 2 of 2; transform_pose 2 of 2; invert_transform 0 of 2 (missing)" in feedback


LATE = """
from nbgrader.plugins import LateSubmissionPlugin

class HalfAPointADay(LateSubmissionPlugin):
    def late_submission_penalty(self, student_id, score, total_seconds_late):
        return total_seconds_late / 86_400 / 2

c.AssignLatePenalties.plugin_class = HalfAPointADay
"""


def test_late_work_is_exported_with_its_penalty(graded):
    with Writer(graded) as writer:
        submission = writer.gradebook.find_submission("transforms", "ada")
        submission.assignment.duedate, submission.timestamp = datetime(2026, 11, 1), datetime(2026, 11, 3)
        writer.gradebook.db.commit()
    with open(graded.root / "nbgrader_config.py", "a", encoding="utf-8") as file:
        file.write(LATE)
    assert {row[0]: row[1] for row in table(graded, "plain")[1:]}["ada"] == "0.5"
    assert {row[3]: row[5] for row in table(graded, "canvas")[2:]}["ada"] == "0.5"


def test_what_is_not_final_and_who_is_not_known_is_said(graded):
    final, known = remarks(graded, "canvas")
    assert "not final: written answers of 3 of 3 students wait" in final
    assert "first_name, last_name, lms_user_id of 1 of 3 students" in known and "nbgrader db student import" in known
    (final,) = remarks(graded, "plain")
    with Writer(graded) as writer:
        for grade in writer.gradebook.find_submission("transforms", "ada").notebooks[1].grades:
            grade.needs_manual_grade = False
        writer.gradebook.db.commit()
    assert remarks(graded, "plain") == [final]  # two notebooks of hers still wait
    with Writer(graded) as writer:
        for notebook in writer.gradebook.find_submission("transforms", "ada").notebooks:
            for grade in notebook.grades:
                grade.needs_manual_grade = False
        writer.gradebook.db.commit()
    assert "written answers of 2 of 3 students" in remarks(graded, "plain")[0]


FORMULA = '=HYPERLINK("http://example.org")'  # tests/test_names.py has all kinds


@pytest.mark.parametrize("field", ["last_name", "email", "lms_user_id"])
def test_who_has_a_cell_that_a_spreadsheet_would_run_is_left_out_and_the_class_is_not(graded, field):
    with Writer(graded) as writer:
        writer.gradebook.update_or_create_student("ada", **{**PEOPLE["ada"], field: FORMULA})
    rows, left_out = exported(graded, "moodle")
    assert left_out == {"ada": [FORMULA]}
    assert [row[2] for row in rows] == ["Username", "joerg", "zoë"]
    assert exported(graded, "plain")[1] == {}  # it is not in there
    with Writer(graded) as writer:
        writer.gradebook.update_or_create_student("absent", last_name=FORMULA)
    assert exported(graded, "plain")[1] == {}


def test_the_id_of_a_student_is_never_changed(graded):
    with Writer(graded) as writer:
        put(writer, "=1+1", 2.0)
        writer.gradebook.update_or_create_student("@absent")
    for name in export.FORMATS:
        rows, left_out = exported(graded, name)
        assert left_out == {"=1+1": ["=1+1"]} | ({"@absent": ["@absent"]} if name == "plain" else {})
        assert len(rows) == len(PEOPLE) + {"plain": 2, "canvas": 2, "moodle": 1}[name]


def test_a_column_that_a_spreadsheet_would_run_is_refused(graded):
    with pytest.raises(CourseError, match="give another --column"):
        table(graded, "canvas", "=1+1")


def test_the_command_says_who_was_left_out(graded, slow):
    with Writer(graded) as writer:
        writer.gradebook.update_or_create_student("ada", last_name=FORMULA)
    code, said = run(graded, "export", "--format", "canvas", "--output", "points.csv")
    assert code == 1 and said.startswith("points.csv is written.")
    assert f"'ada': left out; a spreadsheet would run this as a formula: '{FORMULA}, Ada'." in said
    assert "nbgrader db student import FILE.csv" in said
    assert "joerg" in (graded.root / "points.csv").read_text()


def test_the_command(graded, slow):
    code, said = run(graded, "export", "--format", "canvas", "--column", "Lab 3", "--output", "points.csv")
    assert code == 0
    assert said.splitlines()[0] == "points.csv is written." and "not final" in said
    with open(graded.root / "points.csv", encoding="utf-8", newline="") as file:
        assert next(csv.reader(file))[5] == "Lab 3"
    code, said = run(graded, "export", "--output", "nowhere/points.csv")
    assert code == 2 and "there is no folder nowhere" in said
    code, said = run(graded, "export", "--format", "xml")
    assert code == 2 and f"choose from {', '.join(export.FORMATS)}." in said


def test_an_empty_gradebook_is_said(course):
    assert table(course, "canvas")[2:] == []
    assert remarks(course, "canvas") == ["Nobody is in the gradebook yet: run `python3 -m autograder grade` first."]


def test_the_command_knows_every_format(course, slow):
    for name in export.FORMATS:
        code, said = run(course, "export", "--format", name)
        assert code == 0 and said.startswith(",".join(table(course, name)[0]) + "\n")


def test_points_are_added_up_as_nbgrader_does_to_the_last_digit_and_in_two_questions(course):
    draw, asked = random.Random(4), []
    with Writer(course) as writer:
        for number in draw.sample(range(100), 9):
            put(writer, f"s{number}", 1.5)
        book = writer.gradebook.db
        for grade in book.execute(select(Grade)).scalars():
            grade.auto_score, grade.extra_credit = (
                draw.choice([None, 0.1, 1 / 3, 1e16]),
                draw.choice([None, 0.7, -1e16]),
            )
            grade.manual_score = draw.choice([None, None, 2 / 3])
        for notebook in book.execute(select(SubmittedNotebook)).scalars():
            notebook.late_submission_penalty = draw.choice([None, 0.1, 0.2, 1 / 7])
        book.commit()
        of = SubmittedAssignment
        alone = {found.id: (found.score, found.late_submission_penalty) for found in book.execute(select(of)).scalars()}
        event.listen(book.get_bind(), "before_cursor_execute", lambda *statement: asked.append(statement))
        added_up = writer._added_up()
        assert {identifier: added_up(identifier) for identifier in alone} == alone and len(asked) == 2
        assert added_up("who has no notebooks") == (0.0, 0.0)
    assert len(alone) == 9 and len(set(alone.values())) > 5
