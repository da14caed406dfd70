"""What a student reads about a function that is older than its cell, or that is not there."""

from difflib import get_close_matches
from typing import NamedTuple

from .cells import Cells, functions, parameters_of
from .judging.plain import PlainExercise
from .jupyter import being_graded, names, shell

RUN_ABOVE = "run the cells above from the top (Run > Run All Above Selected Cell)"
OUT_OF_DATE = "not checked, Python still has an older version of it"
_followed: Cells | None = None  # the cells of the notebook in which this runs


class Outdated(NamedTuple):
    """happened: why a function is not what its cell says; helps: what to do; certain: False where it may be all the same"""

    happened: str
    helps: str
    certain: bool


def follow(after_each):
    """From now on, know what cells make; call `after_each(result)` after each. Nothing where there are no cells."""
    global _followed
    ipython = shell()
    if ipython is None or being_graded() or (_followed and _followed.shell is ipython):
        return
    _followed = Cells(ipython)
    ipython.events.register("post_run_cell", after_each)


def outdated(name: str, function, exercises: dict[str, PlainExercise]) -> Outdated | None:
    """Why `function` is not, or perhaps not, what its cell in the notebook says now; None when all is well."""
    change = _followed.change(name, function) if _followed else None
    if change is None:
        return None
    again = "then run this one again."
    if change.stopped and change.certain:
        return Outdated(f"its cell stopped with {change.stopped}", f"Mend that cell and run it, {again}", True)
    if change.stopped:
        return Outdated(f"another cell that defines it stopped with {change.stopped}", "", False)
    other = _one_like(exercises[name], [other for other in change.instead if other not in exercises])
    if other:
        return Outdated(
            f"its cell now defines `{other}`" if change.certain else f"`{other}` was defined after it",
            f"Rename `{other}` to `{name}` and run that cell, {again}",
            change.certain,
        )
    if change.certain:
        return Outdated("its cell no longer defines it", f"Run the cell that does, {again}", True)
    return None


def missing(name: str, exercises: dict[str, PlainExercise]) -> str:
    """Why there is no function of this name."""
    change = _followed.change(name) if _followed else None
    if change and change.stopped:
        return f"its cell stopped with {change.stopped}"
    made = {other: parameters_of(function) for other, function in functions(names()).items() if other not in exercises}
    wanted = tuple(exercises[name]["parameters"])
    alike = get_close_matches(name, made, n=2, cutoff=0.8) or [
        other for other, parameters in made.items() if parameters == wanted != ()
    ]
    if len(alike) == 1:
        return f"you have `{alike[0]}`; if that is it, rename it to `{name}` and run its cell"
    return "run the cell that defines it, and keep its name"


def _one_like(exercise, others):
    """The one of these functions that may be the exercise's under another name, or None."""
    if len(others) > 1:
        there = functions(names())
        others = [
            other for other in others if other in there and parameters_of(there[other]) == tuple(exercise["parameters"])
        ]
    return others[0] if len(others) == 1 else None
