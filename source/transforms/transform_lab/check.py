"""`check("exercise", function)`: an opinion on a student's function at once, in the notebook.

The cases come from key.json beside this file: arguments, the right answers, and the answers that known misconceptions
give. It holds numbers only; there is no solution in it to find. The grader uses other cases, in another process.
"""

import json
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from .judging import comparison, panel
from .judging.calling import call, one_line
from .judging.verdict import LOOP, Verdict, examine
from .jupyter import being_graded, shell

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
    if being_graded():
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
