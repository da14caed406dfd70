"""What nbgrader calls: `nbgrader autograde`, and the formgrader's button, through our intake and judge.

nbgrader_config.py names the two classes here. nbgrader keeps its own part: folders, gradebook, late penalties.
"""

import io
import os
from functools import cached_property
from pathlib import Path

import nbformat
from nbconvert.exporters import NotebookExporter
from nbgrader.converters.base import NbGraderException
from nbgrader.preprocessors import NbGraderPreprocessor
from traitlets import Bool

from .. import sandbox
from ..course import ASSIGNMENT, Course
from ..grading.grade import grade_notebook, grading_run, new_seed
from ..grading.records import RECORD
from ..intake.restore import Intake, restore
from ..intake.submission import submission_of


class Exporter(NotebookExporter):
    """Reads notebooks for `nbgrader autograde`: a submitted one goes through the intake, so none stops the batch.

    nbgrader makes one for each run; the run's hidden cases live as long.
    """

    unsafe_no_sandbox = Bool(False, help="Run students' code without protection, as this user.").tag(config=True)

    @cached_property
    def course(self):
        return Course(Path.cwd())  # nbgrader works from the course's root

    @cached_property
    def run(self):
        problem = sandbox.refusal(self.course.root)
        if problem and not self.unsafe_no_sandbox:
            raise NbGraderException(f"{problem} To grade without protection: --Exporter.unsafe_no_sandbox=True")
        return grading_run(self.course, new_seed(), isolated=not self.unsafe_no_sandbox)

    def from_filename(self, filename, resources=None, **kwargs):
        path = Path(os.path.abspath(filename))
        if not path.is_relative_to(self.course.root / "submitted"):
            return super().from_filename(filename, resources, **kwargs)
        if path.parent.name != ASSIGNMENT:
            raise NbGraderException(
                f"This course's grader knows the assignment {ASSIGNMENT} alone. Grade {path.parent.name} in a course folder "
                "of its own, whose nbgrader_config.py does not name our classes."
            )
        submission = submission_of(
            self.course, path.parent.parent.name
        )  # which may hold a better file for this notebook
        intake = restore(submission.files.get(path.name, b""), self.course.notebooks[path.stem])
        for line in (*submission.problems, *intake.problems):
            self.log.warning(line)
        intake.notebook.metadata[RECORD] = {"statuses": intake.statuses, "problems": intake.problems}
        return self.from_file(io.StringIO(nbformat.writes(intake.notebook)), resources, **kwargs)


class Judge(NbGraderPreprocessor):
    """Takes the place of nbgrader's Execute: runs the notebook in a sandbox and puts a verdict at each test cell."""

    def preprocess(self, nb, resources):
        names = resources["nbgrader"]
        run = self.parent.run
        intake = Intake(nb, dict(nb.metadata[RECORD]["statuses"]), list(nb.metadata[RECORD]["problems"]))
        submission = submission_of(self.parent.course, names["student"])
        with run.sandbox(submission) as box:
            grade_notebook(intake, run.released[names["notebook"]], run, box, submission)
        return nb, resources
