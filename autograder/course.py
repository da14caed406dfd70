"""Where things lie in a course: the facts that every command starts from."""

import os
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from . import ASSIGNMENT
from .names import odd
from .released import NotANotebook, Released, read


class CourseError(Exception):
    """Something about the course's folders is not as it has to be; the message says what and what to do."""


@dataclass(frozen=True)
class Course:
    """A course directory, as nbgrader understands it."""

    root: Path

    def __post_init__(self):
        if not self.source.is_dir():
            raise CourseError(self._no_source())

    def _no_source(self):
        """Why there is no source/transforms, as far as that can be seen."""
        others = sorted(path.parent.name for path in self.root.glob("source/*/transform_lab"))
        if others:
            return (
                f"The assignment's folder has to be called {ASSIGNMENT}, as the released one, those in "
                f"submitted/STUDENT/ and the gradebook's entry are. Rename it back: `mv source/{others[0]} source/{ASSIGNMENT}`. "
                "Names that are yours to choose: the course's in nbgrader's exchange, c.CourseDirectory.course_id in "
                "nbgrader_config.py, and the LMS's name for the points, `export --column`."
            )
        return (
            f"{self.root} is no course folder: there is no source/{ASSIGNMENT} in it. "
            "Change to the folder that holds nbgrader_config.py and run the command again."
        )

    @property
    def source(self) -> Path:
        return self.root / "source" / ASSIGNMENT

    @property
    def package(self) -> Path:
        """The students' package, as the instructor has it."""
        return self.source / "transform_lab"

    @property
    def release(self) -> Path:
        return self.root / "notebooks" / ASSIGNMENT

    def release_contents(self) -> dict[str, bytes]:
        """What students get, {path relative to the release: bytes}, in order; empty when nothing was released."""
        paths = (path for path in sorted(self.release.rglob("*")) if path.is_file() and "__pycache__" not in path.parts)
        return {path.relative_to(self.release).as_posix(): path.read_bytes() for path in paths}

    @property
    def reports(self) -> Path:
        return self.root / "reports" / ASSIGNMENT

    @property
    def gradebook(self) -> Path:
        return self.root / "gradebook.db"

    def submitted(self, student: str) -> Path:
        return self.root / "submitted" / student / ASSIGNMENT

    def autograded(self, student: str) -> Path:
        return self.root / "autograded" / student / ASSIGNMENT

    def feedback(self, student: str) -> Path:
        return self.root / "feedback" / student / ASSIGNMENT

    def students(self) -> list[str]:
        """Those who handed the assignment in, by the folders below submitted/."""
        folder = self.root / "submitted"
        if not folder.is_dir():
            raise CourseError(
                "There is no submitted/ folder. Put each student's files into "
                f"submitted/STUDENT/{ASSIGNMENT}/ (or run `nbgrader collect {ASSIGNMENT}`), then grade."
            )
        return sorted(name for name in self._folders() if self.submitted(name).is_dir() and not odd(name))

    def astray(self) -> dict[str, str]:
        """{what lies in submitted/ and is no student's folder with a submission of this assignment: what to do}"""
        there = sorted(path.name for path in (self.root / "submitted").iterdir() if not path.name.startswith("."))
        found = {}
        for name in there:
            if problem := odd(name):
                found[name] = f"its folder in submitted/ has to be called otherwise: {problem}"
            elif not self.submitted(name).is_dir():
                found[name] = f"its files have to be in submitted/{Path(name).stem}/{ASSIGNMENT}/"
        return found

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
    def notebooks(self) -> dict[str, Released]:
        """The released notebooks, {name: Released}, in order."""
        paths = sorted(self.release.glob("*.ipynb"))
        if not paths:
            raise CourseError(
                f"{ASSIGNMENT} was never released: there are no notebooks in notebooks/{ASSIGNMENT}. "
                "Run `python3 -m autograder release` first."
            )
        try:
            return {path.stem: read(path) for path in paths}
        except NotANotebook as error:
            raise CourseError(
                f"notebooks/{ASSIGNMENT}/{error}. Run `python3 -m autograder release`: it makes that folder anew."
            ) from None
