"""`check("exercise", function)`: an opinion on a student's function at once, in the notebook.

The cases come from key.json beside this file: arguments, the right answers, and the answers that known misconceptions
give. It holds numbers only; there is no solution in it to find. The grader uses other cases, in another process.
"""

import json
import re
from contextlib import contextmanager
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from traceback import walk_tb

from .judging import comparison, panel
from .judging.calling import call, one_line
from .judging.verdict import LOOP, Verdict, examine
from .jupyter import being_graded, names, shell
from .outdated import OUT_OF_DATE, RUN_ABOVE, missing, outdated

# What a function that is interrupted may have been waiting for: (pattern of the line, what helps).
WAITS = (
    (
        r"\b(input|getpass)\(",
        "It waits for somebody to type something in. All that it needs comes as arguments: take that out.",
    ),
    (r"\b(sleep|wait|join|acquire)\(", "It waits there. Nothing has to be waited for: take that out."),
)
KEY = Path(__file__).with_name("key.json")


class CheckFailed(AssertionError):
    """An exercise is not right yet. IPython shows the one line instead of a traceback."""

    def _render_traceback_(self):
        return [str(self)]


def check(name, function=None):
    """Call `function` on the public cases of the exercise `name` and show what is right and what is not.

    A right function gets one green line. A stub that is not filled in yet says so calmly. Anything else shows what was
    expected, what came, and the misconception behind it when exactly one explains all answers; then raises CheckFailed.
    So does a function that is older than its cell's text, on which there is no verdict.
    """
    if being_graded():
        print(f"{name}: the grader calls this function itself.")
        return
    exercise = _asked(name, function)
    old = outdated(name, function, exercises())
    if old and old.certain:
        title = f"{name}: {OUT_OF_DATE}."
        sentences = [f"{old.happened[0].upper()}{old.happened[1:]}.", old.helps]
        _display("\n".join([title, *sentences]), panel.headed(title, sentences, "waiting"))
        raise CheckFailed(title)
    if old:
        print(f"This is about {name} as it was before: {old.happened}.")
    given = getattr(function, "__name__", name)
    if given != name and names().get(given) is function and name not in names():
        print(f"Grading looks for {name}, and there is none: rename {given} to it.")
    verdict = verdict_on(name, exercise, function)
    points = round(verdict.credit * exercise["points"], 2), exercise["points"]
    _show(verdict, points)
    if verdict.done and not verdict.right:
        raise CheckFailed(panel.title(verdict))


def _asked(name, function):
    """The exercise that a call of `check` is about; CheckFailed says how to call it when it was called in another way."""
    if not isinstance(name, str):
        meant = function if isinstance(function, str) else getattr(name, "__name__", None)
        meant = meant if meant in exercises() else "chain"
        raise CheckFailed(f"check takes the exercise's name in quotes first, then the function: {_call(meant)}")
    exercise = _exercise(name)
    if not callable(function):
        without = "quotes" if isinstance(function, str) else "parentheses"
        raise CheckFailed(f"check takes, after the name, the function itself, without {without}: {_call(name)}")
    return exercise


def _call(name):
    return f'check("{name}", {name})'


def say_what_is_missing(result):
    """After a cell that stopped because the function to check is not there: what may have become of it."""
    error = result and result.error_in_exec
    if type(error) is NameError and re.search(r"\bcheck\(", result.info.raw_cell) and error.name in exercises():
        print(f"{error.name} is not there: {missing(error.name, exercises())}.")


def verdict_on(name, exercise, function):
    """The Verdict on `function` for the public cases of the exercise `name`, given as plain data."""
    first = exercise["cases"][0]
    try:
        return examine(
            name,
            exercise,
            lambda args, kwargs: call(function, args, kwargs),
            lambda: call(function, first["args"], first["kwargs"]),
        )
    except KeyboardInterrupt as interrupt:
        where = re.search(r", in your line .*", one_line(interrupt))
        line = where[0] if where else ""
        helps = next((helps for waits, helps in WAITS if re.search(waits, line)), LOOP)
        says = f"Your function was interrupted before it was done{line}."
        return Verdict(name, "timeout", says=says, hint=helps)


@contextmanager
def once_done(name):
    """Run a block that needs the student's function `name`; say one calm line while that is not possible yet."""
    try:
        yield
    except NotImplementedError:
        print(f"This part appears once {name} is done.")
    except Exception as error:
        print(_why_not(name, error))


def _why_not(name, error):
    """One line on the error of a block that needs `name`: is it the function's, or that of the notebook's own lines?"""
    stopped = one_line(error)
    if being_graded():  # nobody reads it, and nothing is checked here
        return stopped
    function = names().get(name)
    frames = [frame for frame, _ in walk_tb(error.__traceback__)]
    theirs = getattr(function, "__code__", None) in [frame.f_code for frame in frames]
    if type(error) is NameError and error.name and not theirs and frames[-1].f_globals.get("__name__") == "__main__":
        if error.name != name:
            return f"{error.name} is not there: {RUN_ABOVE}, or mend the name if it is a slip."
        return f"This part appears once {name} is done: {missing(name, exercises())}."
    old = outdated(name, function, exercises())
    if old and old.certain:
        return f"This part needs {name} as it is now: {old.happened}. {old.helps}"
    if callable(function) and verdict_on(name, _exercise(name), function).right:
        return f"{name} is right, but this cell stops with {stopped}. If you changed its lines, undo that; if not, {RUN_ABOVE}."
    return f"This part appears once {name} is right; now it stops with {stopped}"


@cache
def _key():
    try:
        return json.loads(KEY.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise CheckFailed("transform_lab/key.json is missing: fetch the assignment's folder again.") from None


def exercises():
    """All exercises, as {name: plain data}."""
    return _key()["exercises"]


def _exercise(name):
    if name not in exercises():
        alike = get_close_matches(name, exercises(), n=1)
        instead = f"did you mean {_call(alike[0])}?" if alike else f"there are {', '.join(exercises())}."
        raise CheckFailed(f"There is no exercise called {name!r}; {instead}")
    return exercises()[name]


def notebooks():
    """The names of all notebooks, in the order in which they are worked through."""
    return list(_key()["notebooks"])


def notebook_data(name):
    """The exercises of the notebook `name`, as {name: plain data}, and its questions for a person, as [[title, points], …]."""
    notebooks = _key()["notebooks"]
    if name not in notebooks:
        raise CheckFailed(f"There is no notebook called {name!r}; there are {', '.join(notebooks)}.")
    return {exercise: _exercise(exercise) for exercise in notebooks[name]["exercises"]}, notebooks[name]["questions"]


def _show(verdict, points):
    text = panel.text(verdict, None if verdict.right else points)
    if shell() is None:
        print(text)
        return
    pictured = comparison.scene(verdict)
    _display(text, panel.html(verdict) + (pictured.figure() if pictured else ""))
    if not verdict.right:
        # nbgrader reads the cell's first result as the points it earned; without this line a stub would earn them all.
        shell().displayhook(_Points(*points))


def _display(text, html):
    if shell() is None:
        print(text)
        return
    from IPython.display import display

    display({"text/plain": text, "text/html": html}, raw=True)


class _Points:
    """A number of points: the bare number as text, which is how nbgrader takes partial credit."""

    def __init__(self, earned, most):
        self.earned, self.most = earned, most

    def _repr_mimebundle_(self, include=None, exclude=None):
        note = f"<span>{self.earned:g} of {self.most:g} points with these cases</span>"
        return {"text/plain": f"{self.earned:g}", "text/html": note}
