"""The last cell of a notebook: what is done, the points so far, what to hand in, and where in the course this is."""

import json
from html import escape
from pathlib import Path

from .check import exercises, notebook_data, notebooks, verdict_on
from .judging import panel
from .jupyter import being_graded, names, shell
from .outdated import OUT_OF_DATE, missing, outdated

__all__ = ["sum_up"]


def sum_up(notebook):
    """Check all exercises of `notebook`, such as "1_rotation", and show them as a table, with what to hand in.

    The points are those that the cases of `check` give; the grader uses other cases of the same kinds. Below stands a map of the
    course: of the other notebooks, what their checks said when they were saved in this folder.
    """
    if being_graded():
        print("The grader sums up by itself.")
        return
    asked, questions = notebook_data(notebook)
    rows = [_row(name, exercise, names().get(name)) for name, exercise in asked.items()]
    right, earned, most = (sum(row[i] for row in rows) for i in ("right", "earned", "points"))
    sentences = [
        f"Right so far: {right} of {len(rows)} exercises, {earned:g} of {most:g} points. Grading uses other numbers.",
        *(
            f"Question “{title}”: {n:g} points, read by a person. Have you written your answer?"
            for title, n in questions
        ),
        f"To hand in: save this notebook, and hand in the file {notebook}.ipynb under this name.",
    ]
    lines = [f"{row['exercise']}  {row['earned']:g} of {row['points']:g}  {row['says']}" for row in rows]
    course = [(name, right if name == notebook else _saved(name), len(notebook_data(name)[0])) for name in notebooks()]
    text = "\n".join([*lines, *sentences, "The course: " + ", ".join(_place(*part) for part in course)])
    if shell() is None:
        print(text)
        return
    from IPython.display import display

    display({"text/plain": text, "text/html": _table(rows, sentences) + _map(course, notebook)}, raw=True)


def _row(name, exercise, function):
    """What there is to say about one exercise."""
    row = {
        "exercise": name,
        "mark": "…",
        "right": False,
        "earned": 0.0,
        "points": exercise["points"],
        "says": "it is no function",
    }
    if name not in names():
        row["says"] = missing(name, exercises())
    elif (old := outdated(name, function, exercises())) and old.certain:
        row["says"] = f"{OUT_OF_DATE}: {old.happened}"
    elif callable(function):
        verdict = verdict_on(name, exercise, function)
        row["mark"] = "✓" if verdict.right else "✗" if verdict.done else "…"
        row["right"], row["earned"] = verdict.right, round(verdict.credit * exercise["points"], 2)
        row["says"] = panel.title(verdict).partition(": ")[2].rstrip(".")
    return row


def _saved(notebook):
    """How many exercises of a notebook in this folder were right when it was saved; 0 where nothing tells."""
    try:
        cells = json.loads(Path(f"{notebook}.ipynb").read_text(encoding="utf-8"))["cells"]
        said = [
            str(output["data"].get("text/plain"))
            for cell in cells
            for output in cell.get("outputs", ())
            if "data" in output
        ]
    except (OSError, ValueError, LookupError, TypeError, AttributeError):  # it is not there, or no notebook
        return 0
    return sum(any(f"{name}: all right." in text for text in said) for name in notebook_data(notebook)[0])


def _place(notebook, right, number):
    """A notebook on the map, in words: "1 rotation ✓", "2 homogeneous transforms 3 of 5"."""
    return f"{notebook.replace('_', ' ')} {'✓' if right == number else f'{right} of {number}'}"


def _map(course, here):
    """The notebooks in a row of links, and where we are."""
    places = []
    for notebook, right, number in course:
        words = escape(_place(notebook, right, number))
        places.append(f"<strong>{words}</strong>" if notebook == here else f'<a href="{notebook}.ipynb">{words}</a>')
    return f"<p>{' → '.join(places)}</p>"


def _table(rows, sentences):
    left = ' style="text-align:left"'
    cells = "".join(
        f"<tr><td>{row['mark']}</td><td{left}><code>{row['exercise']}</code></td>"
        f"<td>{row['earned']:g} of {row['points']:g}</td><td{left}>{panel.with_code(row['says'])}</td></tr>"
        for row in rows
    )
    head = f"<tr><th></th><th{left}>exercise</th><th>points</th><th{left}>what the check says</th></tr>"
    return f'<div style="overflow-x:auto"><table>{head}{cells}</table></div>' + "".join(
        f"<p>{escape(sentence)}</p>" for sentence in sentences
    )
