"""The path of a submission, from the files a student handed in to verdicts and graded notebooks. Read it top to bottom.

    files -> intake.restore -> judge.judge (in a sandbox) -> Graded

`grade_submission` is a pure function of its arguments, so any concurrent.futures.Executor can run it anywhere.
"""

import hashlib
import json
import os
import secrets
import stat
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path

import nbformat

from .exercises import EXERCISES, key
from .intake import LARGEST, restore
from .judge import Row, judge, rows
from .sandbox import Limits, Sandbox

MOST_FILES = 200  # handed in besides the notebooks
LARGEST_FILE = 5_000_000  # bytes
RECORD = "transform_lab"  # the entry of an autograded notebook's metadata that holds its verdicts


@dataclass(frozen=True)
class Submission:
    """What one student handed in, in memory: {path relative to the assignment's folder: bytes}."""

    student: str
    files: dict
    problems: tuple = ()

    @property
    def digest(self):
        """Changes when anything of the submission changes."""
        total = hashlib.sha256()
        for path, content in sorted(self.files.items()):
            total.update(f"{path}\0{len(content)}\0".encode() + content)
        return total.hexdigest()


@dataclass(frozen=True)
class Assignment:
    """What submissions are graded against: released notebooks, this run's hidden cases, the students' package."""

    released: dict  # {notebook name: course.Released}
    keys: dict  # {exercise: plain data}
    package: Path
    seed: int
    digest: str
    limits: Limits = Limits()
    isolated: bool = True

    def sandbox(self, submission):
        """A Sandbox for one submission, with the files that its notebooks may import or read."""
        helpers = {path: content for path, content in submission.files.items() if not path.endswith(".ipynb")}
        return Sandbox(self.package, helpers, self.limits, self.isolated)


@dataclass
class Graded:
    """The result: a Row for each exercise, the graded notebooks as text, and what was odd, in words."""

    student: str
    rows: list = field(default_factory=list)
    notebooks: dict = field(default_factory=dict)  # {notebook name: JSON text}; none for a missing file
    problems: list = field(default_factory=list)


def assignment(course, seed, limits=Limits(), isolated=True):
    """The Assignment of a course, with the hidden cases drawn from `seed`."""
    names = [name for released in course.notebooks.values() for name in released.points]
    keys = {name: key(EXERCISES[name], seed) for name in names}
    return Assignment(dict(course.notebooks), keys, course.package, seed, specification(course), limits, isolated)


def new_seed():
    """A seed nobody can know before: hidden cases are drawn anew for each grading run."""
    return secrets.randbits(32)


def specification(course):
    """A digest of all that decides a grade: the released notebooks, the grader, the students' package."""
    total = hashlib.sha256()
    for released in course.notebooks.values():
        total.update(released.digest.encode())
    for folder in (Path(__file__).parent, course.package):
        for path in sorted(folder.rglob("*.py")):
            total.update(path.read_bytes())
    return total.hexdigest()


def collect(course, student):
    """The Submission in submitted/STUDENT; links, devices and huge files are left where they are, and said."""
    folder, files, problems = course.submitted(student), {}, []
    for path in sorted(folder.rglob("*")):
        relative = path.relative_to(folder)
        if relative.parts[0] == "transform_lab" or any(
            part.startswith(".") or part == "__pycache__" for part in relative.parts
        ):
            continue  # the grader uses the course's own package
        content, problem = _read(path)
        if problem:
            problems.append(f"{relative}: {problem}.")
        elif content is not None and len(files) >= MOST_FILES:
            problems.append(f"{relative}: left out; at most {MOST_FILES} files are taken.")
        elif content is not None:
            files[relative.as_posix()] = content
    for name in (path for path in files if path.endswith(".ipynb") and Path(path).stem not in course.notebooks):
        wanted = ", ".join(f"{released}.ipynb" for released in course.notebooks)
        problems.append(
            f"{name}: no notebook of this assignment has that name; rename it to one of {wanted} and grade again."
        )
    for name in (name for name in course.notebooks if f"{name}.ipynb" not in files):
        problems.append(f"{name}.ipynb: not handed in; 0 points.")
    return Submission(student, files, tuple(problems))


def grade_submission(submission, assignment):
    """Grade one student's submission: a Graded with a row for every exercise of the assignment."""
    graded = Graded(submission.student, problems=list(submission.problems))
    with assignment.sandbox(submission) as sandbox:
        for name, released in assignment.released.items():
            content = submission.files.get(f"{name}.ipynb")
            if content is None:
                graded.rows += missing(released)
                continue
            text, notebook_rows, problems = grade_notebook(content, released, assignment, sandbox, submission.digest)
            graded.notebooks[name] = text
            graded.rows += notebook_rows
            graded.problems += problems
    return graded


def grade_notebook(content, released, assignment, sandbox, digest=""):
    """Grade one notebook file (bytes): (the graded notebook as text, its Rows, what was odd)."""
    intake = restore(content, released)
    verdicts = judge(intake, released, assignment.keys, sandbox)
    found = rows(released, verdicts)
    intake.notebook.metadata[RECORD] = record(found, intake.problems, assignment, digest)
    return nbformat.writes(intake.notebook) + "\n", found, intake.problems


def record(found, problems, assignment, digest):
    """What an autograded notebook says of itself: the source of reports, and of what need not be graded again."""
    return {
        "rows": [asdict(row) for row in found],
        "problems": list(problems),
        "seed": assignment.seed,
        "graded": datetime.now(UTC).isoformat(timespec="seconds"),
        "submission": digest,
        "specification": assignment.digest,
    }


def recorded(course, student):
    """({notebook: record}) of what is already graded; a damaged file counts as not graded."""
    found = {}
    for name in course.notebooks:
        try:
            text = (course.autograded(student) / f"{name}.ipynb").read_text(encoding="utf-8")
            found[name] = json.loads(text)["metadata"][RECORD]
        except (OSError, ValueError, KeyError):
            continue
    return found


def missing(released):
    """The Rows of a notebook that was not handed in."""
    return [Row(released.name, name, 0.0, points, "missing") for name, points in released.points.items()]


def _read(path):
    """(bytes or None, what is wrong with it or None)"""
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as error:
        return None, f"left out; it cannot be opened ({error.strerror})"
    with open(descriptor, "rb") as file:
        status = os.fstat(descriptor)
        if stat.S_ISDIR(status.st_mode):
            return None, None
        if not stat.S_ISREG(status.st_mode):
            return None, "left out; it is no regular file"
        if status.st_size > LARGEST_FILE and path.suffix != ".ipynb":
            return None, f"left out; it has more than {LARGEST_FILE / 1e6:.0f} MB"
        return file.read(LARGEST + 1), None
