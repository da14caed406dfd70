"""An error in what an author wrote, in one line that says where."""

import os
import traceback

from ..course import CourseError


def told(error):
    """What went wrong, and the last line of a specification or solution that led to it."""
    if isinstance(error, CourseError):
        return str(error)
    if isinstance(error, SyntaxError):
        return f"{error.msg} ({os.path.basename(error.filename or '')}, line {error.lineno})"
    steps = traceback.extract_tb(error.__traceback__)
    own = [step for step in steps if {"exercises", "solutions"} & set(os.path.dirname(step.filename).split(os.sep))]
    where = f" ({os.path.basename(own[-1].filename)}, line {own[-1].lineno}: {own[-1].line})" if own else ""
    return f"{type(error).__name__}: {error}{where}"
