"""The course's own settings of nbgrader; to read them, nbgrader itself need not be loaded."""

from traitlets.config import PyFileConfigLoader


def settings(course):
    """nbgrader's configuration of this course: database, late penalties and what else nbgrader_config.py sets."""
    return PyFileConfigLoader("nbgrader_config.py", path=str(course.root)).load_config()
