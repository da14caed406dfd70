"""The one writer: graded submissions into nbgrader's gradebook and the autograded/ folder.

The marks are those that nbgrader's own SaveAutoGrades would record from the same notebooks, written student by student
instead of cell by cell.
"""

import copy
import csv
import io
import shutil
import time
from pathlib import Path

import nbformat
from nbgrader import utils
from nbgrader.api import Gradebook, MissingEntry
from nbgrader.coursedir import CourseDirectory
from nbgrader.preprocessors import AssignLatePenalties, SaveCells
from sqlalchemy.exc import DatabaseError, OperationalError

from .api import settings
from .course import ASSIGNMENT, CourseError
from .submission import timestamp

PATIENCE = 60.0  # seconds to wait for a database that somebody else has locked


class Writer:
    """Records Graded submissions; a context manager that holds the gradebook open."""

    def __init__(self, course):
        self.course, self.config = course, settings(course)
        self.db_url = CourseDirectory(config=self.config).db_url

    def __enter__(self):
        released = self.course.notebooks  # raises CourseError when there are none, before a gradebook is made
        try:
            self.gradebook = Gradebook(self.db_url)
        except DatabaseError as error:
            raise CourseError(
                f"The gradebook cannot be read ({error.orig}). Put a backup in its place; or move it away, and "
                "`python3 -m autograder grade --force` makes a new one from submitted/ (without hand-given grades)."
            ) from None
        try:
            self.gradebook.find_assignment(ASSIGNMENT)
        except MissingEntry:
            self._register(released)
        return self

    def __exit__(self, *_):
        self.gradebook.close()

    def students(self):
        """Those who have a submission in the gradebook."""
        return {submission.student_id for submission in self.gradebook.assignment_submissions(ASSIGNMENT)}

    def record(self, graded):
        """Write one Graded: first the marks, then the files, whose records say that all is done."""
        fresh = self._prepare_files(graded)
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
        folder = self.course.autograded(graded.student)
        for stale in (folder, self.course.feedback(graded.student)):  # feedback is made anew, or would be out of date
            shutil.rmtree(stale, ignore_errors=True)
        fresh.rename(folder)

    def totals(self):
        """CSV text: each student's points, automatic and manual, as the gradebook has them."""
        table = io.StringIO()
        writer = csv.writer(table, lineterminator="\n")
        writer.writerow(("student", "score", "max_score", "needs_manual_grade"))
        for submission in sorted(self.gradebook.assignment_submissions(ASSIGNMENT), key=lambda found: found.student_id):
            waiting = "yes" if submission.needs_manual_grade else "no"
            writer.writerow((submission.student_id, submission.score, submission.max_score, waiting))
        return table.getvalue()

    def remove(self, student):
        """Forget a student and all that was made for them."""
        for folder in ("submitted", "autograded", "feedback"):
            shutil.rmtree(self.course.root / folder / student, ignore_errors=True)
        try:
            self.gradebook.remove_student(student)
        except MissingEntry:
            return

    def _prepare_files(self, graded):
        folder = self.course.autograded(graded.student)
        fresh = folder.with_name(f".{folder.name}.new")
        shutil.rmtree(fresh, ignore_errors=True)
        fresh.mkdir(parents=True)
        for name, text in graded.notebooks.items():
            Path(fresh, f"{name}.ipynb").write_text(text, encoding="utf-8")
        when, _ = timestamp(self.course, graded.student)
        if when:
            Path(fresh, "timestamp.txt").write_text(when, encoding="utf-8")
        return fresh

    def _write_marks(self, graded):
        book = self.gradebook
        book.update_or_create_student(graded.student)
        when, _ = timestamp(self.course, graded.student)
        given = {"timestamp": when} if when else {}
        submission = book.update_or_create_submission(ASSIGNMENT, graded.student, **given)
        for notebook in submission.notebooks:
            text = graded.notebooks.get(notebook.name)
            if text is None:
                for grade in notebook.grades:
                    grade.auto_score, grade.needs_manual_grade = 0, False
                continue
            cells = {
                cell.metadata.nbgrader.grade_id: cell
                for cell in nbformat.reads(text, as_version=4).cells
                if "nbgrader" in cell.metadata
            }
            for grade in notebook.grades:
                grade.auto_score, _ = utils.determine_grade(cells[grade.name])
                grade.needs_manual_grade = grade.manual_score is not None or grade.auto_score is None
            for comment in notebook.comments:
                cell = cells[comment.name]
                unchanged = cell.metadata.nbgrader.get("checksum") == utils.compute_checksum(cell)
                comment.auto_comment = "No response." if unchanged else None
            notebook.late_submission_penalty = None
        book.db.commit()
        if submission.total_seconds_late > 0:
            self._penalize(graded)

    def _register(self, released):
        """A gradebook that does not know the assignment (a fresh clone) learns it from the released notebooks.

        This is the step of nbgrader's generate_assignment that fills the gradebook; the notebooks stay as they are.
        """
        self.gradebook.update_or_create_assignment(ASSIGNMENT)
        for name, notebook in released.items():
            resources = {"notebook": name, "assignment": ASSIGNMENT, "db_url": self.db_url}
            SaveCells(config=self.config).preprocess(copy.deepcopy(notebook.notebook), {"nbgrader": resources})

    def _penalize(self, graded):
        """Late penalties are nbgrader's to decide, by the plug-in that its configuration names."""
        for name in graded.notebooks:
            resources = {"notebook": name, "assignment": ASSIGNMENT, "student": graded.student, "db_url": self.db_url}
            AssignLatePenalties(config=self.config).preprocess(nbformat.v4.new_notebook(), {"nbgrader": resources})
