"""The one writer: graded submissions into nbgrader's gradebook and the autograded/ folder.

The marks are those that nbgrader's own SaveAutoGrades would record from the same notebooks, written student by student
instead of cell by cell.
"""

import json
import logging
import shutil
import sqlite3
import time
from contextlib import closing
from importlib import resources

from nbgrader.api import (
    Assignment,
    BaseCell,
    Comment,
    Grade,
    Gradebook,
    MissingEntry,
    Notebook,
    SubmittedAssignment,
    SubmittedNotebook,
)
from sqlalchemy import Engine, create_engine, event, func, inspect, literal_column, or_, select, update
from sqlalchemy.exc import DatabaseError, OperationalError

from ..course import ASSIGNMENT, CourseError
from ..files import replace
from ..grading.marks import CellGrade, NotebookGrades
from ..grading.records import ALONE
from ..intake.submission import TIMESTAMP
from ..names import table
from . import lateness, registration
from .nbgrader_api import db_url
from .settings import settings

EXPORTED = (
    *("assignment", "duedate", "timestamp", "student_id", "last_name", "first_name", "email"),
    *("raw_score", "late_submission_penalty", "score", "max_score"),
)  # the columns of `nbgrader export`
BY_HAND = "by_hand"  # a last column of tables, where a person has given points in the grader's place
PATIENCE = 60.0  # seconds to wait for a database that somebody else has locked


logging.getLogger("tornado.application").setLevel(logging.CRITICAL)  # nbgrader's: what fails is said by ours


@event.listens_for(Engine, "connect")
def _wait_for_locks(connection, _):
    """Have SQLite wait when somebody else, such as the formgrader, writes; it gives up after 5 seconds by itself."""
    if isinstance(connection, sqlite3.Connection):
        connection.execute(f"PRAGMA busy_timeout = {int(PATIENCE * 1000)}")


def opened(course):
    """nbgrader's Gradebook of a course, made where there is none; raises CourseError when it cannot be read."""
    url = db_url(course)
    try:
        _stamp(url)
        return Gradebook(url)
    except DatabaseError as error:
        if "locked" in str(error):
            raise CourseError(
                f"Another program has held the gradebook for {PATIENCE:g} s ({error.orig}). When that has ended (a formgrader, "
                "nbgrader's commands, a tool that looks at databases), try again."
            ) from None
        raise CourseError(
            f"The gradebook cannot be read ({error.orig}). Put a backup in its place; or move it away, and "
            "`python3 -m autograder grade --force` makes a new one from submitted/ (without hand-given grades)."
        ) from None


def _stamp(url):
    """Note in a new database which version of nbgrader's tables it has: nbgrader starts a program to find that out."""
    engine = create_engine(url)
    try:
        if not inspect(engine).get_table_names():
            from alembic.migration import MigrationContext
            from alembic.script import ScriptDirectory

            with engine.begin() as connection:
                MigrationContext.configure(connection).stamp(
                    ScriptDirectory(str(resources.files("nbgrader") / "alembic")), "heads"
                )
    finally:
        engine.dispose()


def grades(gradebook, *only):
    """What students are told of their points, {student: {notebook: NotebookGrades}}, in three queries.

    only: SQLAlchemy's conditions, such as `SubmittedAssignment.student_id == "ada"`
    """
    found = {}

    def of(table, *columns):
        whose = select(SubmittedAssignment.student_id, Notebook.name, *columns).select_from(table)
        if table is not SubmittedNotebook:
            whose = whose.join(SubmittedNotebook, SubmittedNotebook.id == table.notebook_id)
            whose = whose.join(BaseCell, BaseCell.id == table.cell_id)
        whose = whose.join(SubmittedAssignment, SubmittedAssignment.id == SubmittedNotebook.assignment_id)
        whose = whose.join(Assignment, Assignment.id == SubmittedAssignment.assignment_id)
        whose = whose.join(Notebook, Notebook.id == SubmittedNotebook.notebook_id)
        for student, notebook, *values in gradebook.db.execute(whose.where(Assignment.name == ASSIGNMENT, *only)):
            yield found.setdefault(student, {}).setdefault(notebook, NotebookGrades()), *values

    for told, penalty in of(SubmittedNotebook, SubmittedNotebook.late_submission_penalty):
        told.penalty = penalty or 0.0
    by_hand = or_(Grade.manual_score.is_not(None), Grade.extra_credit != 0.0)
    points = Grade.score, Grade.max_score, Grade.needs_manual_grade, func.coalesce(by_hand, False)
    for told, cell, *points in of(Grade, BaseCell.name, *points):
        told.cells[cell] = CellGrade(*points)
    for told, cell, comment in of(Comment, BaseCell.name, Comment.comment):
        if comment:
            told.comments[cell] = comment
    return found


class Writer:
    """Records Graded submissions; a context manager that holds the gradebook open."""

    def __init__(self, course):
        self.course, self.config, self.db_url = course, settings(course), db_url(course)

    def __enter__(self):
        released = self.course.notebooks  # raises CourseError when there are none, before a gradebook is made
        self.gradebook = opened(self.course)
        try:
            registration.follow(self.gradebook, released, self.config, self.db_url)
            self.stale = None
        except CourseError as error:
            self.stale = error  # the gradebook may be read and cleared; who wants to record first asks `can_record`
        lateness.penalize(self.gradebook, self.config)
        cells = self.gradebook.db.execute(select(BaseCell.id, BaseCell.name)).all()
        self.cells = {identifier: name for identifier, name in cells}
        return self

    def can_record(self):
        """Raise CourseError when the released notebooks have other cells than the gradebook, which holds students' work."""
        if self.stale:
            raise self.stale

    def __exit__(self, *_):
        self.gradebook.close()

    def students(self):
        """Those who have a submission in the gradebook."""
        asked = select(SubmittedAssignment.student_id).join(Assignment).where(Assignment.name == ASSIGNMENT)
        return set(self.gradebook.db.scalars(asked))

    def record(self, graded):
        """Write one Graded: first the marks, then the files, whose records say that all is done."""
        start = time.monotonic()
        while True:
            try:
                self._write_marks(graded)
                break
            except OperationalError as error:
                self.gradebook.db.rollback()
                if "locked" not in str(error) or time.monotonic() - start > PATIENCE:
                    raise
                time.sleep(0.5)
        shutil.rmtree(self.course.feedback(graded.student), ignore_errors=True)  # made anew, or it would be out of date
        self._write_files(graded)

    def export(self, path, grades):
        """Write the grades as `nbgrader export` does, but in one order, and so that a name stays in its cell, and is not run.

        grades: as of `grades`; where a person has given points in the grader's place, a last column names the exercises
        """
        exercises = [(name, cell) for name, released in self.course.notebooks.items() for cell in released.points]
        by_hand = {
            student: ";".join(cell for name, cell in exercises if name in told and told[name].by_hand(cell))
            for student, told in grades.items()
        }
        assignment = self.gradebook.find_assignment(ASSIGNMENT)
        most, due = assignment.max_score, assignment.duedate
        of = SubmittedAssignment
        asked = self.gradebook.db.execute(
            select(of.student_id, of.id, of.timestamp).where(of.assignment_id == assignment.id)
        )
        done = {student: values for student, *values in asked}
        added_up = self._added_up()
        rows = [EXPORTED]
        for who in sorted(self.gradebook.students, key=lambda who: (who.last_name or "", who.first_name or "", who.id)):
            when, points, penalty = None, 0.0, 0.0
            if who.id in done:
                identifier, when = done[who.id]
                points, penalty = added_up(identifier)
            told = who.id, who.last_name, who.first_name, who.email
            total = max(0.0, points - penalty)
            rows.append((ASSIGNMENT, due, when, *told, points, penalty, total, most))
        if any(by_hand.values()):
            rows = [(*rows[0], BY_HAND), *((*row, by_hand.get(row[3], "")) for row in rows[1:])]
        replace(path, table(rows))

    def _added_up(self):
        """From the id of a submission to (points, penalty), to the last digit as nbgrader asks for them: for each by itself.

        For each of them SQLite reads all grades. So they are read once, and added up by SQLite in that same order.
        """
        ask, of = self.gradebook.db.execute, SubmittedAssignment
        if not self.db_url.startswith("sqlite"):
            return lambda identifier: ask(select(of.score, of.late_submission_penalty).where(of.id == identifier)).one()
        notebook, sums = SubmittedNotebook, []
        scores = select(notebook.assignment_id, Grade.score).join(notebook, Grade.notebook_id == notebook.id)
        penalties = select(notebook.assignment_id, notebook.late_submission_penalty)
        for numbers in (
            scores.order_by(literal_column("grade.rowid")),
            penalties.order_by(literal_column("submitted_notebook.rowid")),
        ):
            with closing(sqlite3.connect(":memory:")) as memory:
                memory.execute("CREATE TABLE n (id, place, number, PRIMARY KEY (id, place)) WITHOUT ROWID")
                rows = ((identifier, place, number) for place, (identifier, number) in enumerate(ask(numbers)))
                memory.executemany("INSERT INTO n VALUES (?, ?, ?)", rows)
                sums.append(dict(memory.execute("SELECT id, coalesce(sum(number), 0.0) FROM n GROUP BY id")))
        return lambda identifier: tuple(found.get(identifier, 0.0) for found in sums)

    def grades(self):
        """What students are told of their points, {student: {notebook: NotebookGrades}}."""
        return grades(self.gradebook)

    def remove(self, student):
        """Forget a student and all that was made for them."""
        for folder in ("submitted", "autograded", "feedback"):
            shutil.rmtree(self.course.root / folder / student, ignore_errors=True)
        try:
            self.gradebook.remove_student(student)
        except MissingEntry:
            return

    def _write_files(self, graded):
        """Each file is replaced in one step, so that nobody ever reads half of one."""
        folder = self.course.autograded(graded.student)
        folder.mkdir(parents=True, exist_ok=True)
        files = {f"{name}.ipynb": text for name, text in graded.notebooks.items()} | graded.receipts
        if graded.record:
            files[ALONE] = json.dumps(graded.record)
        for stale in {path.name for path in folder.iterdir()} - set(files):
            path = folder / stale
            shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()
        for name, text in files.items():
            replace(folder / name, text)

    def _write_marks(self, graded):
        book = self.gradebook
        book.update_or_create_student(graded.student)
        given = {"timestamp": graded.receipts[TIMESTAMP]} if TIMESTAMP in graded.receipts else {}
        submission = book.update_or_create_submission(ASSIGNMENT, graded.student, **given)
        notebooks = {notebook.id: notebook.name for notebook in submission.notebooks}
        grades, comments = [], []
        by_hand = Grade.manual_score, Grade.needs_manual_grade
        for identifier, notebook, cell, manual_score, waited in self._rows(Grade, notebooks, *by_hand):
            marks, name = graded.marks.get(notebooks[notebook]), self.cells[cell]
            score = marks.scores[name] if marks else 0
            waiting = marks is not None and (manual_score is not None or score is None)
            if manual_score is not None and name in self._as_before(graded, notebooks[notebook]):
                waiting = waited  # what a person gave still is for what they saw
            grades.append({"id": identifier, "auto_score": score, "needs_manual_grade": waiting})
        for identifier, notebook, cell in self._rows(Comment, notebooks):
            if marks := graded.marks.get(notebooks[notebook]):
                comments.append({"id": identifier, "auto_comment": marks.comments[self.cells[cell]]})
        for kind, rows in ((Grade, grades), (Comment, comments)):
            if rows:
                book.db.execute(update(kind), rows)
        book.db.commit()
        lateness.penalize(book, self.config, graded.student)

    def _as_before(self, graded, name):
        """The cells of a notebook of which a person would see the same as when it was graded last: of a question its answer, of
        an exercise all of the student's code."""
        try:
            text = (self.course.autograded(graded.student) / f"{name}.ipynb").read_text(encoding="utf-8")
            before, now = map(_work, (text, graded.notebooks[name]))
        except (OSError, ValueError, LookupError, TypeError, AttributeError):
            return set()  # not handed in then or now; or somebody has damaged the file
        return {cell for cell, work in now.items() if before.get(cell) == work}

    def _rows(self, table, notebooks, *columns):
        """(id, notebook, cell, *columns) of what a submission has in a table; one query instead of one for each cell."""
        columns = select(table.id, table.notebook_id, table.cell_id, *columns)
        return self.gradebook.db.execute(columns.where(table.notebook_id.in_(notebooks))).all()


def _work(text):
    """{graded cell: what of the student's work it is for} of an autograded notebook."""
    cells = json.loads(text)["cells"]
    code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    told = ((cell["metadata"].get("nbgrader", {}), cell) for cell in cells)
    return {
        entry["grade_id"]: ["".join(cell["source"]), cell.get("attachments")] if entry.get("solution") else code
        for entry, cell in told
        if entry.get("grade")
    }
