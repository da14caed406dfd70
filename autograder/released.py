"""A notebook as students got it: what it asks for, how many points that is worth, and where it is taught."""

import hashlib
import json
import re
from dataclasses import dataclass
from functools import cached_property

POINTS = r" \((\d+(?:\.\d+)?) points?\b.*\)$"  # the end of a heading that says what is earned below it


class NotANotebook(ValueError):
    """A file of the course's is no Jupyter notebook; the message begins with its name and says why."""


def without_points(heading: str) -> str:
    """A heading without the "(2 points, …)" at its end."""
    return re.sub(POINTS, "", heading)


def read(path):
    """The notebook in a file of the course's, as Released; raises NotANotebook."""
    import nbformat

    try:
        text = path.read_text(encoding="utf-8")
        _look_at(json.loads(text))
        notebook = Released(path.stem, text)
        nbformat.validate(notebook.notebook)
    except json.JSONDecodeError as error:
        lines = enumerate(text.splitlines(), 1)
        marks = [number for number, line in lines if line.startswith(("<<<<<<< ", ">>>>>>> "))]
        why = f"it is not JSON ({error.msg}, line {error.lineno})"
        if marks:
            why = f"a merge has left its conflict marks in it (line {marks[0]}): decide for one side and take them out"
    except NotANotebook as error:
        why = str(error)
    except Exception as error:  # nbformat raises what it happens to meet in a file of another shape
        place = " ".join(map(str, getattr(error, "relative_path", ())))
        why = f"it is not a Jupyter notebook ({f'{place}: ' if place else ''}{str(error).partition(chr(10))[0][:200]})"
    else:
        return notebook
    raise NotANotebook(f"{path.name}: {why}")


def _look_at(raw):
    """Raise NotANotebook where nbformat's own words would not say what a notebook's JSON lacks, or in which cell."""
    if not (isinstance(raw, dict) and {"cells", "nbformat", "nbformat_minor", "metadata"} <= raw.keys()):
        raise NotANotebook("it is not a Jupyter notebook (a list of cells, metadata and nbformat have to be in it)")
    for number, cell in enumerate(raw["cells"], 1):
        lacks = {"cell_type", "metadata", "source"} - cell.keys() if isinstance(cell, dict) else {"cell_type"}
        if lacks:
            raise NotANotebook(f"it is not a Jupyter notebook (cell {number} has no {' and no '.join(sorted(lacks))})")


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
        return {cell.metadata.nbgrader.grade_id: cell for cell in self.notebook.cells if cell.metadata.get("nbgrader")}

    @cached_property
    def points(self) -> dict[str, float]:
        """The exercises in this notebook, {name: points}, in order."""
        from .exercises import EXERCISES

        return {
            name: float(cell.metadata.nbgrader.points)
            for name, cell in self.cells.items()
            if cell.metadata.nbgrader.grade and name in EXERCISES
        }

    @cached_property
    def questions(self) -> dict[str, float]:
        """What a human grades in this notebook, {name: points}, in order."""
        graded = {name: cell.metadata.nbgrader for name, cell in self.cells.items() if cell.metadata.nbgrader.grade}
        return {name: float(nbgrader.points) for name, nbgrader in graded.items() if name not in self.points}

    def section(self, name: str) -> str:
        """The heading (`## …`, as it is read) of the part of the notebook that leads to an exercise or a question."""
        return self._sections.get(name, "")

    @cached_property
    def _sections(self):
        """{cell nbgrader knows about, also without "-solution": the heading above it}"""
        found, sections = "", {}
        for cell in self.notebook.cells:
            if cell.cell_type == "markdown":
                headings = re.findall(r"^(?:## (?!Exercise)|#+ (?=Question))(.+)", cell.source, re.MULTILINE)
                found = headings[-1].replace("`", "").strip() if headings else found
            if name := cell.metadata.get("nbgrader", {}).get("grade_id"):
                sections.setdefault(name, found)
                sections.setdefault(name.removesuffix("-solution"), found)
        return sections

    @property
    def title(self) -> str:
        """The notebook's first heading."""
        cells = (cell.source for cell in self.notebook.cells if cell.cell_type == "markdown")
        return next(
            (found[1] for found in map(re.compile("^# +(.*?) *$", re.MULTILINE).search, cells) if found), self.name
        )

    @property
    def digest(self) -> str:
        return hashlib.sha256(self.text.encode()).hexdigest()
