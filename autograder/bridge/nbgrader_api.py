"""nbgrader's own commands, called from ours with the course's own settings."""

import logging
import sys
from pathlib import Path

from nbgrader.apps import NbGraderAPI
from nbgrader.apps.baseapp import NbGrader
from nbgrader.coursedir import CourseDirectory
from nbgrader.exchange.default import Exchange
from traitlets.config import PyFileConfigLoader

from ..course import CourseError

logger = logging.getLogger("traitlets")  # nbgrader's; a failure is told by ours, and so is progress
logger.addHandler(logging.NullHandler())  # or Python would print what nobody handles


def settings(course):
    """nbgrader's configuration of this course: database, late penalties and what else nbgrader_config.py sets."""
    return PyFileConfigLoader("nbgrader_config.py", path=str(course.root)).load_config()


def db_url(course):
    """Where the gradebook is, as SQLAlchemy writes it: SQLite in the course's folder, or what nbgrader_config.py sets."""
    return CourseDirectory(config=settings(course)).db_url


def exchange(course):
    """(the folder of nbgrader's exchange, what the course is called in it), as this machine and the course configure them."""
    app = NbGrader()
    app.initialize([], root=str(course.root))
    return Path(Exchange(config=app.config, coursedir=app.coursedir).root), app.coursedir.course_id


def call(course, command, *arguments, changed=None):
    """Run a method of nbgrader's API, such as "generate_feedback"; raises CourseError with the reason when it fails.

    changed: traitlets' Config of settings that are others than the course's this time
    Returns what nbgrader told of as an error and went on, in words.
    """
    config = settings(course)
    config.merge(changed or {})
    api = NbGraderAPI(CourseDirectory(config=config), config=config)
    reasons = _Reasons(logging.ERROR)
    logger.addHandler(reasons)
    try:
        result = getattr(api, command)(*arguments, force=True)
    finally:
        logger.removeHandler(reasons)
    if not result["success"]:
        lines = (result.get("error") or result.get("log") or "").strip().splitlines()
        raise CourseError(reasons.words() or (lines[-1] if lines else "no reason given")) from reasons.first
    return reasons.words()


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
