"""`check("exercise", function)`: an opinion on a student's function at once, in the notebook.

The cases come from key.json beside this file: arguments, the right answers, and the answers that known misconceptions
give. It holds numbers only; there is no solution in it to find. The grader uses other cases, in another process.
"""

import io
import json
import os
import sys
import traceback
from contextlib import contextmanager, redirect_stdout
from functools import cache
from pathlib import Path

from . import codec, comparison, panel
from .verdict import LOOP, Reply, Verdict, examine

MOST_PRINTED = 200  # characters of what a function prints while it is checked
KEY = Path(__file__).with_name("key.json")


class CheckFailed(AssertionError):
    """An exercise is not right yet. IPython shows the one line instead of a traceback."""

    def _render_traceback_(self):
        return [str(self)]


def check(name, function):
    """Call `function` on the public cases of the exercise `name` and show what is right and what is not.

    A right function gets one green line. A stub that is not filled in yet says so calmly. Anything else shows what was
    expected, what came, and the misconception behind it when exactly one explains all answers; then raises CheckFailed.
    """
    if os.environ.get("TRANSFORM_LAB_GRADING"):
        print(f"{name}: the grader calls this function itself.")
        return
    if not isinstance(name, str):
        raise CheckFailed('check takes the exercise\'s name in quotes first: check("chain", chain)')
    exercise = _exercise(name)
    if not callable(function):
        raise CheckFailed(f'check takes the function itself, without parentheses: check("{name}", {name})')
    verdict = verdict_on(name, exercise, function)
    points = round(verdict.credit * exercise["points"], 2), exercise["points"]
    _show(verdict, points)
    if verdict.done and not verdict.right:
        raise CheckFailed(panel.title(verdict))


def verdict_on(name, exercise, function):
    """The Verdict on `function` for the public cases of the exercise `name`, given as plain data."""
    try:
        return examine(name, exercise, lambda args, kwargs: call(function, args, kwargs))
    except KeyboardInterrupt:
        return Verdict(name, "timeout", says="Your function was interrupted before it was done.", hint=LOOP)


@contextmanager
def once_done(name):
    """Run a block that needs the student's function `name`; say one calm line while that is not possible yet."""
    try:
        yield
    except NotImplementedError:
        print(f"This part appears once {name} is done.")
    except Exception as error:  # whatever the student's function raised, or what its answer led to
        print(f"This part appears once {name} is right; now it stops with {one_line(error)}")


def call(function, args, kwargs):
    """The Reply of `function` to plain arguments: fresh objects for each call, and what became of them after it."""
    return reply(
        function, [codec.decode(arg) for arg in args], {key: codec.decode(arg) for key, arg in kwargs.items()}
    )


def reply(function, args, kwargs):
    """The Reply of `function` to decoded arguments, which have to be fresh."""
    printed = io.StringIO()
    try:
        with redirect_stdout(printed):
            value = function(*args, **kwargs)
    except Exception as error:
        if isinstance(error, NotImplementedError) and _raised_in(function, error):
            return Reply("not done")
        return Reply("raised", error=one_line(error))
    after = [[codec.encode(arg) for arg in args], {key: codec.encode(arg) for key, arg in kwargs.items()}]
    return Reply("returned", codec.encode(value), after, printed=printed.getvalue()[:MOST_PRINTED])


def _raised_in(function, error):
    """Whether the function itself raised the error, and none that it calls."""
    step = error.__traceback__
    while step.tb_next is not None:
        step = step.tb_next
    return step.tb_frame.f_code is getattr(function, "__code__", step.tb_frame.f_code)


def one_line(error):
    """An exception in one line of bounded length, with the student's own line in which it came up, if there is one."""
    where = ""
    for step in traceback.extract_tb(error.__traceback__):
        if step.filename.startswith("<ipython-input") or "ipykernel_" in step.filename:
            where = f", in your line {step.lineno}: `{_shortened(step.line, 80)}`"
    message = _shortened(f"{type(error).__name__}: {' '.join(str(error).split())}", 180).rstrip(".: ")
    return message + where


def _shortened(text, most):
    return text if len(text) <= most else f"{text[: most - 1]}…"


@cache
def _key():
    try:
        return json.loads(KEY.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise CheckFailed("transform_lab/key.json is missing: fetch the assignment's folder again.") from None


def _exercise(name):
    known = _key()["exercises"]
    if name not in known:
        raise CheckFailed(f"There is no exercise called {name!r}; there are {', '.join(known)}.")
    return known[name]


def notebook_data(name):
    """The exercises of the notebook `name`, as {name: plain data}, and its questions for a person, as [[title, points], …]."""
    notebooks = _key()["notebooks"]
    if name not in notebooks:
        raise CheckFailed(f"There is no notebook called {name!r}; there are {', '.join(notebooks)}.")
    return {exercise: _exercise(exercise) for exercise in notebooks[name]["exercises"]}, notebooks[name]["questions"]


def _show(verdict, points):
    ipython = shell()
    if ipython is None:
        print(panel.text(verdict, None if verdict.right else points))
        return
    from IPython.display import display

    pictured = comparison.scene(verdict)
    display(
        {
            "text/plain": panel.text(verdict, None if verdict.right else points),
            "text/html": panel.html(verdict) + (pictured.figure() if pictured else ""),
        },
        raw=True,
    )
    if not verdict.right:
        # nbgrader reads the cell's first result as the points it earned; without this line a stub would earn them all.
        ipython.displayhook(_Points(*points))


class _Points:
    """A number of points: the bare number as text, which is how nbgrader takes partial credit."""

    def __init__(self, earned, most):
        self.earned, self.most = earned, most

    def _repr_mimebundle_(self, include=None, exclude=None):
        note = f"<span>{self.earned:g} of {self.most:g} points with these cases</span>"
        return {"text/plain": f"{self.earned:g}", "text/html": note}


def shell():
    """IPython's shell where there is one; a plain `python` script has none."""
    if "IPython" not in sys.modules:
        return None
    from IPython import get_ipython

    return get_ipython()
