"""The last cell of a notebook: what is done, the points so far, and what to hand in."""

import os
from html import escape

from . import panel
from .check import call, notebook_data, shell
from .verdict import examine

__all__ = ["sum_up"]

UNDEFINED = "its cell has not been run"


def sum_up(notebook):
    """Check all exercises of `notebook`, such as "1_rotation", and show them as a table, with what to hand in.

    The points are those that the cases of `check` give; the grader uses other cases of the same kinds.
    """
    if os.environ.get("TRANSFORM_LAB_GRADING"):
        print("The grader sums up by itself.")
        return
    exercises, questions = notebook_data(notebook)
    names = vars(__import__("__main__")) if shell() is None else shell().user_ns
    rows = [_row(name, exercise, names.get(name)) for name, exercise in exercises.items()]
    done, most = sum(row[1] == row[2] for row in rows), sum(row[2] for row in rows)
    total = f"{done} of {len(rows)} exercises are right: {sum(row[1] for row in rows):g} of {most:g} points with these cases."
    asked = [
        f"Question “{title}”: {points:g} points, read by a person. Have you written your answer?" for title, points in questions
    ]
    file = f"{notebook}.ipynb"
    hand_in = f"To hand in: save this notebook, and hand in the file {file} under this name."
    lines = [f"{name}  {earned:g} of {points:g}  {says}" for name, earned, points, says in rows]
    text = "\n".join([*lines, total, *asked, hand_in])
    if shell() is None:
        print(text)
        return
    from IPython.display import display

    display({"text/plain": text, "text/html": _table(rows, [total, *asked, hand_in])}, raw=True)


def _row(name, exercise, function):
    """(exercise, points earned, points, what is to be said about it)."""
    points = exercise["points"]
    if not callable(function):
        return name, 0.0, points, UNDEFINED
    verdict = examine(name, exercise, lambda args, kwargs: call(function, args, kwargs))
    return name, round(verdict.credit * points, 2), points, panel.title(verdict).partition(": ")[2].rstrip(".")


def _table(rows, sentences):
    left = ' style="text-align:left"'
    cells = "".join(
        f"<tr><td>{'✓' if earned == points else '…' if not earned else '✗'}</td><td{left}><code>{name}</code></td>"
        f"<td>{earned:g} of {points:g}</td><td{left}>{escape(says)}</td></tr>"
        for name, earned, points, says in rows
    )
    head = f"<tr><th></th><th{left}>exercise</th><th>points</th><th{left}>what the check says</th></tr>"
    return f"<table>{head}{cells}</table>" + "".join(f"<p>{escape(sentence)}</p>" for sentence in sentences)
