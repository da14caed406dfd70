"""Jinja, as the pages that we make without nbgrader use it."""

from functools import cache

import jinja2
from markupsafe import Markup
from transform_lab.judging import panel

from .markdown import heading


def points(number):
    """Points as they are said: 2, 1.33."""
    return f"{round(number, 2):g}"


@cache
def environment():
    """Jinja, as the pages that we make without nbgrader use it."""
    made = jinja2.Environment(
        loader=jinja2.PackageLoader("autograder.pages"), autoescape=True, trim_blocks=True, lstrip_blocks=True
    )
    made.filters["points"] = points
    made.filters["with_code"] = lambda sentence: Markup(panel.with_code(sentence))
    made.filters["inline"] = lambda text: Markup(heading(text)[1])
    made.filters["time"] = lambda time: time.astimezone().strftime("%Y-%m-%d %H:%M %Z")
    return made
