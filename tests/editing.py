"""Notebooks of a course: solved as a student does, changed as an instructor does."""

import json
import re

import nbformat
from support import ROOT

from autograder.course import ASSIGNMENT, Course


def solution(name):
    """A solved notebook as JSON data, as students hand one in: with outputs, and its written answer given."""
    notebook = json.loads((ROOT / "source" / ASSIGNMENT / f"{name}.ipynb").read_text())
    released = {
        cell["metadata"]["nbgrader"]["grade_id"]: cell
        for cell in json.loads(Course(ROOT).notebooks[name].text)["cells"]
        if "nbgrader" in cell["metadata"]
    }
    for number, cell in enumerate(notebook["cells"]):
        entry = cell["metadata"].get("nbgrader")
        if entry:
            cell["metadata"]["nbgrader"] = released[entry["grade_id"]]["metadata"]["nbgrader"]
            if entry["grade"] and entry["solution"]:
                cell["source"] = ["The bottle's own z axis,\n", "because a gripper knows nothing of the table."]
        if cell["cell_type"] == "code":
            cell["execution_count"] = number
            cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": ["1\n"]}]
    return notebook


def solve(notebook, exercise, source):
    """Put a solution of one's own into a notebook."""
    for cell in notebook.cells:
        if cell.metadata.get("nbgrader", {}).get("grade_id") == f"{exercise}-solution":
            cell.source = source


class Edited:
    """A notebook while it is changed; a context manager that writes it back.

    folder: of source/ or of notebooks/
    """

    def __init__(self, folder, name):
        self.path = folder / f"{name}.ipynb"

    def __enter__(self):
        self.notebook = nbformat.read(self.path, as_version=4)
        return self

    def __exit__(self, *_):
        self.path.write_text(json.dumps(self.notebook))  # unlike nbformat, as it is

    def named(self, name):
        (found,) = (c for c in self.notebook.cells if c.metadata.get("nbgrader", {}).get("grade_id") == name)
        return found

    def with_text(self, text):
        return next(cell for cell in self.notebook.cells if text in cell.source)

    def replace(self, old, new):
        cell = self.with_text(old)
        cell.source = cell.source.replace(old, new)

    def remove(self, *cells):
        self.notebook.cells = [cell for cell in self.notebook.cells if not any(cell is gone for gone in cells)]

    def remove_exercise(self, name):
        """All that has to go with an exercise: its heading, both of its cells, and the cells that use the function."""
        gone = [
            cell for cell in self.notebook.cells if cell.cell_type == "code" and re.search(rf"\b{name}\b", cell.source)
        ]
        self.remove(self.with_text(f"### Exercise: `{name}`"), *gone)

    def add_question(self, name, points, heading="## Question: why? (1 point, read by a person)"):
        meta = {"schema_version": 3, "grade": True, "solution": True, "locked": False, "task": False}
        answer = nbformat.v4.new_markdown_cell(
            "Because.", metadata={"nbgrader": {**meta, "grade_id": name, "points": points}}
        )
        self.notebook.cells[-1:-1] = [nbformat.v4.new_markdown_cell(heading), answer]

    def say_points(self, points=None):
        """Write so many points into the opening line; as many as the cells say now, when none are given."""
        if points is None:
            points = sum(cell.metadata.get("nbgrader", {}).get("points", 0) for cell in self.notebook.cells)
        opening = self.notebook.cells[0]
        opening.source = re.sub(r"\d+(\s+)points?\.$", rf"{points:g}\1points.", opening.source)
