"""nbgrader's own commands, called from ours with the course's own settings."""

import logging

from nbgrader.apps import NbGraderAPI
from nbgrader.coursedir import CourseDirectory
from traitlets.config import PyFileConfigLoader

from ..course import CourseError


def settings(course):
    """nbgrader's configuration of this course: database, late penalties and what else nbgrader_config.py sets."""
    return PyFileConfigLoader("nbgrader_config.py", path=str(course.root)).load_config()


def call(course, command, *arguments):
    """Run a method of nbgrader's API, such as "generate_feedback"; raises CourseError with the reason when it fails."""
    config = settings(course)
    logging.getLogger("traitlets").setLevel(logging.CRITICAL)  # a failure is told below; progress by our own bars
    api = NbGraderAPI(CourseDirectory(config=config), config=config)
    result = getattr(api, command)(*arguments, force=True)
    if not result["success"]:
        lines = (result.get("error") or result.get("log") or "").strip().splitlines()
        raise CourseError(lines[-1] if lines else "no reason given")
