"""nbgrader's own commands, called from ours with the course's own settings."""

import logging
import sys
from contextlib import chdir, contextmanager
from pathlib import Path

from nbconvert.writers import FilesWriter
from nbgrader.apps import NbGraderAPI
from nbgrader.apps.baseapp import NbGrader
from nbgrader.converters import GenerateFeedback
from nbgrader.coursedir import CourseDirectory
from nbgrader.exchange.default import Exchange
from traitlets.config import Config

from ..course import ASSIGNMENT, CourseError
from ..grading.marks import CellGrade, NotebookGrades
from .settings import settings

logger = logging.getLogger("traitlets")  # nbgrader's; a failure is told by ours, and so is progress
logger.addHandler(logging.NullHandler())  # or Python would print what nobody handles


def db_url(course):
    """Where the gradebook is, as SQLAlchemy writes it: SQLite in the course's folder, or what nbgrader_config.py sets."""
    return CourseDirectory(config=settings(course)).db_url


def exchange(course):
    """(the folder of nbgrader's exchange, what the course is called in it), as this machine and the course configure them."""
    app = NbGrader()
    app.initialize([], root=str(course.root))
    return Path(Exchange(config=app.config, coursedir=app.coursedir).root), app.coursedir.course_id


def call(course, command, *arguments):
    """Run a method of nbgrader's API, such as "generate_assignment"; raises CourseError with the reason when it fails.

    Returns what nbgrader told of as an error and went on, in words.
    """
    config = settings(course)
    api = NbGraderAPI(CourseDirectory(config=config), config=config)
    with _reasons() as reasons:
        result = getattr(api, command)(*arguments, force=True)
    if not result["success"]:
        lines = (result.get("error") or result.get("log") or "").strip().splitlines()
        raise CourseError(reasons.words() or (lines[-1] if lines else "no reason given")) from reasons.first
    return reasons.words()


class FeedbackPages(GenerateFeedback):
    """nbgrader's generate_feedback for one student after the other.

    Its exporter is made once, and is told the grades: to read the settings, make it, and ask the gradebook for every cell
    takes as long as the pages.
    """

    def __init__(self, course, changed=None, shared=None):
        """changed: traitlets' Config of settings that are others than the course's this time
        shared: the folder in which the processes of a run leave each other parts of pages
        """
        config = settings(course)
        config.merge(Config(GenerateFeedback={"force": True}, HTMLExporter={"template_name": "feedback"}))
        config.merge(changed or {})
        super().__init__(CourseDirectory(config=config, assignment_id=ASSIGNMENT), config=config)
        self.exporter = self.exporter_class(parent=self, config=self.config)
        for step in self.preprocessors:
            self.exporter.register_preprocessor(step)
        self.exporter.pieces.folder = shared

    def prepare(self, notebooks):
        """Make the parts of pages that everybody has, which are those of the Released notebooks."""
        for released in notebooks:
            cells = {name: CellGrade(0.0, most, False) for name, most in (released.points | released.questions).items()}
            told = {"notebook": released.name, "grades": NotebookGrades(cells)}
            self.exporter.from_notebook_node(released.notebook, {"nbgrader": told})

    def make(self, student, grades):
        """Write the pages of a student with these {notebook: NotebookGrades}; raises and returns as `call` does."""
        self.coursedir.student_id, self.grades = student, grades
        self.writer = FilesWriter(parent=self, config=self.config)  # it makes the folder once
        with _reasons() as reasons:
            try:
                self.init_notebooks()
                with chdir(self.coursedir.root):
                    self.convert_notebooks()
            except (Exception, SystemExit) as error:
                raise CourseError(reasons.words() or _short(f"{type(error).__name__}: {error}")) from (
                    reasons.first or error
                )
        return reasons.words()

    def init_single_notebook_resources(self, notebook_filename):
        made = super().init_single_notebook_resources(notebook_filename)
        made["nbgrader"]["grades"] = self.grades[made["nbgrader"]["notebook"]]
        return made


@contextmanager
def _reasons():
    reasons = _Reasons(logging.ERROR)
    logger.addHandler(reasons)
    try:
        yield reasons
    finally:
        logger.removeHandler(reasons)


class _Reasons(logging.Handler):
    """Why nbgrader failed: it logs that and then raises "Please see the the above traceback", which nobody is shown."""

    def __init__(self, level):
        super().__init__(level)
        self.first = None  # exception
        self.errors, self.messages = {}, {}  # in words; in order, each once

    def emit(self, record):
        if error := sys.exc_info()[1]:
            self.first = self.first or error
            self.errors[_short(str(error) or type(error).__name__)] = None
        else:
            self.messages[_short(record.getMessage())] = None

    def words(self):
        """Of the exceptions; what nbgrader says besides refers to them, or is all that there is."""
        return "; ".join(self.errors or self.messages)


def _short(text):
    return " ".join(text.split())[:500]
