"""Where things lie in a course, and what was released: the facts that every command starts from."""

import hashlib
import os
import re
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

ASSIGNMENT = "transforms"


def replace(path, text):
    """Write a file in one step: whoever reads it finds the old text or the new one, and never half of it."""
    fresh = path.with_name(f".{path.name}.new")
    try:
        fresh.write_text(text, encoding="utf-8")
        os.replace(fresh, path)
    except OSError:
        fresh.unlink(missing_ok=True)
        raise


def without_points(heading):
    """A heading without the "(2 points, …)" at its end."""
    return re.sub(r" \(\d+ points?\b.*\)$", "", heading)


class CourseError(Exception):
    """Something about the course's folders is not as it has to be; the message says what and what to do."""


@dataclass(frozen=True)
class Course:
    """A course directory, as nbgrader understands it."""

    root: Path

    def __post_init__(self):
        if not self.source.is_dir():
            raise CourseError(
                f"{self.root} is no course folder: there is no source/{ASSIGNMENT} in it. "
                "Change to the folder that holds nbgrader_config.py and run the command again."
            )

    @property
    def source(self):
        return self.root / "source" / ASSIGNMENT

    @property
    def package(self):
        """The students' package, as the instructor has it."""
        return self.source / "transform_lab"

    @property
    def release(self):
        return self.root / "notebooks" / ASSIGNMENT

    def release_contents(self):
        """What students get, {path relative to the release: bytes}, in order; empty when nothing was released."""
        paths = (path for path in sorted(self.release.rglob("*")) if path.is_file() and "__pycache__" not in path.parts)
        return {path.relative_to(self.release).as_posix(): path.read_bytes() for path in paths}

    @property
    def reports(self):
        return self.root / "reports" / ASSIGNMENT

    @property
    def gradebook(self):
        return self.root / "gradebook.db"

    def submitted(self, student):
        return self.root / "submitted" / student / ASSIGNMENT

    def autograded(self, student):
        return self.root / "autograded" / student / ASSIGNMENT

    def feedback(self, student):
        return self.root / "feedback" / student / ASSIGNMENT

    def students(self):
        """Those who handed the assignment in, by the folders below submitted/."""
        folder = self.root / "submitted"
        if not folder.is_dir():
            raise CourseError(
                "There is no submitted/ folder. Put each student's files into "
                f"submitted/STUDENT/{ASSIGNMENT}/ (or run `nbgrader collect {ASSIGNMENT}`), then grade."
            )
        return sorted(name for name in self._folders() if self.submitted(name).is_dir())

    def astray(self):
        """The folders below submitted/ that hold no submission of this assignment."""
        return sorted(name for name in self._folders() if not self.submitted(name).is_dir())

    def _folders(self):
        folders = (self.root / "submitted").iterdir()
        return [path.name for path in folders if path.is_dir() and not path.name.startswith(".")]

    @contextmanager
    def one_grader_at_a_time(self, busy):
        """Wait while another process grades this course, having called `busy` to say so; a killed one does not count."""
        import fcntl  # not on Windows, where nobody else gets this far either

        folder = os.open(self.root / "submitted", os.O_RDONLY)
        try:
            try:
                fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                busy()
                fcntl.flock(folder, fcntl.LOCK_EX)
            yield
        finally:
            os.close(folder)

    @cached_property
    def notebooks(self):
        """The released notebooks, {name: Released}, in order."""
        paths = sorted(self.release.glob("*.ipynb"))
        if not paths:
            raise CourseError(
                f"{ASSIGNMENT} was never released: there are no notebooks in notebooks/{ASSIGNMENT}. "
                "Run `python3 -m autograder release` first."
            )
        return {path.stem: Released(path.stem, path.read_text(encoding="utf-8")) for path in paths}


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
