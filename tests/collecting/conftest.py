"""What tests of downloads share: notebooks of a student's own, and a course without any submission."""

import json
import shutil

import pytest
from support import ASKED, ROOT

from autograder.course import ASSIGNMENT, Course

MARK = "whose work this is"


@pytest.fixture(scope="session")
def work():
    """work(whose, *notebooks): {file name: bytes} of released notebooks in which somebody has done something."""
    made = {}
    for name in ASKED:
        raw = json.loads((ROOT / "notebooks" / ASSIGNMENT / f"{name}.ipynb").read_text(encoding="utf-8"))
        cell = next(c for c in raw["cells"] if c["metadata"].get("nbgrader", {}).get("solution"))
        cell["source"] = [f"# {MARK}"]
        made[f"{name}.ipynb"] = json.dumps(raw)

    def of(whose, *names):
        return {
            name: text.replace(MARK, str(whose)).encode()
            for name, text in made.items()
            if not names or name[:-6] in names
        }

    return of


@pytest.fixture
def submitted(course):
    """submitted(): {student: {path: bytes}} of what is in submitted/."""

    def read():
        found = {}
        for path in sorted((course.root / "submitted").rglob("*")):
            if path.is_file() and not path.name.startswith("."):
                student, assignment, *inside = path.relative_to(course.root / "submitted").parts
                assert assignment == ASSIGNMENT
                found.setdefault(student, {})["/".join(inside)] = path.read_bytes()
        return found

    return read


@pytest.fixture
def course(released, tmp_path):
    """A released course of the test's own, as far as `collect` looks at one: code and source are not copied."""
    folder = tmp_path / "course"
    folder.mkdir()
    for name in ("nbgrader_config.py", "gradebook.db", "notebooks"):
        path = released.root / name
        (shutil.copytree if path.is_dir() else shutil.copy)(path, folder / name)
    for name in ("autograder", "source"):
        (folder / name).symlink_to(released.root / name)
    return Course(folder)
