"""A notebook as students got it: what it asks for, how many points that is worth, and where it is taught."""

import hashlib
import re
from dataclasses import dataclass
from functools import cached_property


def without_points(heading):
    """A heading without the "(2 points, …)" at its end."""
    return re.sub(r" \(\d+ points?\b.*\)$", "", heading)


@dataclass(frozen=True)
class Released:
    """A notebook as students got it: the measure for what they hand in."""

    name: str
    text: str

    @cached_property
    def notebook(self):
        import nbformat  # here and below: a command that only starts another program need not wait for these

        return nbformat.reads(self.text, as_version=4)

    @cached_property
    def cells(self):
        """The cells nbgrader knows about, {grade_id: cell}, in order."""
        return {cell.metadata.nbgrader.grade_id: cell for cell in self.notebook.cells if "nbgrader" in cell.metadata}

    @cached_property
    def points(self):
        """The exercises in this notebook, {name: points}, in order."""
        from .exercises import EXERCISES

        return {
            name: float(cell.metadata.nbgrader.points)
            for name, cell in self.cells.items()
            if cell.metadata.nbgrader.grade and name in EXERCISES
        }

    @cached_property
    def questions(self):
        """What a human grades in this notebook, {name: points}, in order."""
        graded = {name: cell.metadata.nbgrader for name, cell in self.cells.items() if cell.metadata.nbgrader.grade}
        return {name: float(nbgrader.points) for name, nbgrader in graded.items() if name not in self.points}

    def section(self, name):
        """The heading (`## …`, as it is read) of the part of the notebook that leads to an exercise or a question."""
        found = ""
        for cell in self.notebook.cells:
            if cell.metadata.get("nbgrader", {}).get("grade_id") in (name, f"{name}-solution"):
                return found
            if cell.cell_type == "markdown":
                headings = re.findall(r"^## (?!Exercise)(.+)", cell.source, re.MULTILINE)
                found = headings[-1].replace("`", "").strip() if headings else found
        return ""

    @property
    def title(self):
        """The notebook's first heading."""
        cells = (cell.source for cell in self.notebook.cells if cell.cell_type == "markdown")
        return next(
            (found[1] for found in map(re.compile("^# +(.*?) *$", re.MULTILINE).search, cells) if found), self.name
        )

    @property
    def digest(self):
        return hashlib.sha256(self.text.encode()).hexdigest()
