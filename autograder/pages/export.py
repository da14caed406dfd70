"""The gradebook's points as CSV: a plain table, or what Canvas and Moodle import.

Names, addresses and LMS ids are those of nbgrader's student table; who a student is here is the folder's name in
submitted/. What is not known stays empty, and `remarks` says so.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from nbgrader.api import Student

from ..bridge.gradebook import grades
from ..course import ASSIGNMENT, CourseError
from ..names import runs, table
from . import report_data as findings


@dataclass(frozen=True)
class StudentTotal:
    """The points of a student (nbgrader's Student), automatic and hand-given ones together, and less what being late costs.

    waiting: whether a human has to grade yet; grades: {notebook: NotebookGrades}
    """

    student: Student
    score: float
    waiting: bool
    grades: dict


def totals(gradebook):
    """[StudentTotal] of those in nbgrader's gradebook who handed the assignment in, by their ids."""
    found, told = [], grades(gradebook)
    for done in gradebook.assignment_submissions(ASSIGNMENT):
        score = max(0.0, done.score - (done.late_submission_penalty or 0.0))  # as nbgrader reckons
        grades_of_one = told.get(done.student_id, {})
        found.append(StudentTotal(done.student, score, bool(done.needs_manual_grade), grades_of_one))
    return sorted(found, key=lambda total: total.student.id)


def absent(gradebook):
    """[nbgrader's Student] of the class who have handed nothing in."""
    there = {done.student_id for done in gradebook.assignment_submissions(ASSIGNMENT)}
    return sorted(
        (student for student in gradebook.students if student.id not in there), key=lambda student: student.id
    )


def plain(course, assignment, found, column, absent):
    yield "student", "score", "max_score", "needs_manual_grade"
    for total in found:
        yield total.student.id, round(total.score, 2), assignment.max_score, "yes" if total.waiting else "no"
    for student in absent:
        yield student.id, 0, assignment.max_score, "nothing handed in"


def canvas(course, assignment, found, column, absent):
    """Canvas finds a student by the first of these that it knows: ID (its own number), SIS User ID, SIS Login ID, name."""
    yield "Student", "ID", "SIS User ID", "SIS Login ID", "Section", column
    yield "Points Possible", "", "", "", "", assignment.max_score
    for total in found:
        who = total.student
        name = ", ".join(part for part in (who.last_name, who.first_name) if part)
        lms_id = who.lms_user_id or ""
        # Canvas would read a number out of the beginning of any other id, and may so find somebody else.
        ids = (lms_id, "") if re.fullmatch("[0-9]+", lms_id) else ("", lms_id)
        yield name, *ids, who.id, "", round(total.score, 2)


def moodle(course, assignment, found, column, absent):
    """The columns of Moodle's own export; which of the first ones tells who a student is, is chosen in its preview."""
    yield "First name", "Last name", "Username", "ID number", "Email address", column, f"{column} (feedback)"
    for total in found:
        who = total.student
        work = findings.work(course, who.id)
        work.take(total.grades)
        feedback = "; ".join(_said(row, work.remark(row)) for row in work.rows)
        yield who.first_name, who.last_name, who.id, who.lms_user_id, who.email, round(total.score, 2), feedback


class Format(NamedTuple):
    """A table of points. rows: from (course, assignment, [StudentTotal], column, [Student who is absent]) to the rows of cells,
    the head among them; shown: what it has of a student besides the id, as nbgrader's student table calls it
    """

    rows: Callable
    shown: tuple = ()


FORMATS = {
    "plain": Format(plain),
    "canvas": Format(canvas, ("first_name", "last_name", "lms_user_id")),
    "moodle": Format(moodle, ("first_name", "last_name", "email", "lms_user_id")),
}


def known_format(name):
    """The Format of that name; raises CourseError when there is none."""
    if name not in FORMATS:
        raise CourseError(f"There is no format {name!r}; choose from {', '.join(FORMATS)}.")
    return FORMATS[name]


def text(course, gradebook, found, name, column=ASSIGNMENT):
    """(CSV text of a format of FORMATS, {id of a student who is left out: the cells that a spreadsheet would run}).

    Changed, such a cell would no longer be who it names. column: what the points' column is called in the table, as the LMS
    calls the assignment. Raises CourseError when there is no such format, and when `column` is one of these cells.
    """
    assignment, rows = gradebook.find_assignment(ASSIGNMENT), known_format(name).rows

    def lines(found, absent):
        return list(rows(course, assignment, found, column, absent))

    head = lines([], [])
    if runs(column):
        raise CourseError(
            f"Nothing was written: a spreadsheet would run {column!r} as a formula; give another --column."
        )
    each = [(total.student, lines([total], [])) for total in found]
    each += [(student, lines([], [student])) for student in absent(gradebook)]
    left_out = {who.id: cells for who, own in each if (cells := [cell for row in own for cell in row if runs(cell)])}
    kept = [row for who, own in each if who.id not in left_out for row in own[len(head) :]]
    return table([*head, *kept]), left_out


def told(left_out):
    """Lines about who is not in the table, as `text` gives them, and what to do."""
    for student, cells in left_out.items():
        yield f"{student!r}: left out; a spreadsheet would run this as a formula: {', '.join(map(repr, cells))}."
    if left_out:
        yield (
            "To have them in the table, too: a name, address or LMS id is changed by `nbgrader db student import FILE.csv` "
            "(columns id,first_name,last_name,email,lms_user_id, or some of them); a student's id by renaming the folder in "
            "submitted/ and grading again."
        )


def remarks(found, name, absent=()):
    """Lines about what the table does not tell: points that are not final, who is absent, and who is not known by name.

    An LMS gets no row for who is absent: what it does to a grade that it has is not ours to decide.
    """
    if not found:
        yield "Nobody is in the gradebook yet: run `python3 -m autograder grade` first."
    if waiting := sum(total.waiting for total in found):
        whose = f"{waiting} of {len(found)} students" if len(found) > 1 else "the one student"
        yield (
            f"These points are not final: written answers of {whose} wait to be graded by hand "
            "(`jupyter lab`, then Nbgrader > Formgrader)."
        )
    if absent:
        row = "" if name == "plain" else ", and not in the table, so that no grade is changed"
        yield f"In the class, nothing handed in{row}: {', '.join(student.id for student in absent)}."
    nameless = sum(not all(getattr(total.student, field) for field in known_format(name).shown) for total in found)
    if nameless:
        fields = ", ".join(known_format(name).shown)
        yield (
            f"The gradebook does not know {fields} of {nameless} of {len(found)} students; what it lacks is empty here. "
            f"To add it: `nbgrader db student import FILE.csv` (columns id,{fields.replace(' ', '')}), then export again."
        )


def _said(row, remark):
    """One exercise of Moodle's feedback, such as "chain 0 of 2 (order-reversed)"."""
    why = ", ".join(part.strip() for part in remark.split(";"))
    return f"{row.exercise} {row.score:g} of {row.max_score:g}" + (f" ({why})" if why else "")
