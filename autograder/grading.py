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

import dateutil.parser
import nbformat

from .exercises import EXERCISES, key
from .intake import LARGEST, restore
from .judge import Row, judge, rows
from .outputs import printable
from .sandbox import Limits, Sandbox

MOST_FILES = 200  # handed in besides the notebooks
LARGEST_FILES = 4_000_000  # bytes, all of them together
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
    """The Submission in submitted/STUDENT; links, devices and what is too much are left where they are, and said."""
    folder, files, problems, size = course.submitted(student), {}, [], 0
    expected = [folder / f"{name}.ipynb" for name in course.notebooks]
    others = sorted(path for path in folder.rglob("*") if path not in expected and not _ignored(path, folder))
    for path in expected + others:
        name = printable(path.relative_to(folder).as_posix())
        if path in others and path.is_dir() and not path.is_symlink():
            continue
        content, problem = read(path)
        if path in others and content is not None:
            size += len(content)
            if len(files) >= MOST_FILES + len(expected) or size > LARGEST_FILES:
                problem = (
                    f"left out; besides notebooks, {MOST_FILES} files of {LARGEST_FILES / 1e6:g} MB in all are taken"
                )
        if path in expected and not os.path.lexists(path):
            problem = "not handed in; 0 points"
        if problem:
            problems.append(f"{name}: {problem}.")
        if content is not None and not problem:
            files[name] = content
        elif path in expected and os.path.lexists(path):
            files[name] = b""  # something is there, but no file to read: the intake calls it unreadable
        if path in others and path.suffix == ".ipynb":
            wanted = ", ".join(f"{released}.ipynb" for released in course.notebooks)
            problems.append(
                f"{name}: no notebook of this assignment has that name; rename it to one of {wanted} and grade again."
            )
    _, problem = timestamp(course, student)
    return Submission(student, files, tuple(problems + [problem] if problem else problems))


def timestamp(course, student):
    """(when the work was handed in, as text that nbgrader can read, or None; what is wrong with timestamp.txt or None)"""
    path = course.submitted(student) / "timestamp.txt"
    content, _ = read(path)
    text = (content or b"").decode("utf-8", "replace").strip()
    try:
        return (text, None) if text and dateutil.parser.parse(text) else (None, None)
    except (ValueError, OverflowError):
        return None, f"timestamp.txt: {text[:60]!r} is no date; graded as if there were none."


def _ignored(path, folder):
    """The grader uses the course's own package; caches and hidden files are nobody's work."""
    parts = path.relative_to(folder).parts
    return parts[0] == "transform_lab" or any(part.startswith(".") or part == "__pycache__" for part in parts)


def grade_submission(submission, assignment):
    """Grade one student's submission: a Graded with a row for every exercise of the assignment."""
    graded = Graded(submission.student, problems=list(submission.problems))
    with assignment.sandbox(submission) as sandbox:
        for name, released in assignment.released.items():
            content = submission.files.get(f"{name}.ipynb")
            if content is None:
                graded.rows += missing(released)
                continue
            intake = restore(content, released)
            verdicts = grade_notebook(intake, released, assignment, sandbox, submission)
            graded.rows += rows(released, verdicts)
            graded.notebooks[name] = nbformat.writes(intake.notebook) + "\n"
            graded.problems += intake.problems
    return graded


def grade_notebook(intake, released, assignment, sandbox, submission):
    """Judge one notebook: {exercise: Verdict}; its outputs, and its record in the metadata, are filled in.

    The record is what reports are made from, and tells what need not be graded again.
    """
    verdicts = judge(intake, released, assignment.keys, sandbox)
    intake.notebook.metadata[RECORD] = nbformat.from_dict(
        {
            "rows": [asdict(row) for row in rows(released, verdicts)],
            "problems": [*submission.problems, *intake.problems],
            "seed": assignment.seed,
            "graded": datetime.now(UTC).isoformat(timespec="seconds"),
            "submission": submission.digest,
            "specification": assignment.digest,
        }
    )
    return verdicts


def recorded(course, student):
    """({notebook: record}) of what is already graded; a damaged or outdated record counts as not graded."""
    found = {}
    for name, released in course.notebooks.items():
        try:
            text = (course.autograded(student) / f"{name}.ipynb").read_text(encoding="utf-8")
            record = json.loads(text)["metadata"][RECORD]
            record["rows"] = [Row(**row) for row in record["rows"]]
            if [row.exercise for row in record["rows"]] == list(released.points):
                found[name] = record
        except (OSError, ValueError, KeyError, TypeError):
            continue
    return found


def missing(released):
    """The Rows of a notebook that was not handed in."""
    return [Row(released.name, name, 0.0, points, "missing") for name, points in released.points.items()]


def read(path):
    """(the bytes of a regular file or None, what is wrong with it or None); follows no link, waits for nobody."""
    if path.is_symlink():
        return None, "left out; it is a link"
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError as error:
        return None, f"left out; it cannot be opened ({error.strerror})"
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            return None, "left out; it is no regular file"
        with open(descriptor, "rb", closefd=False) as file:
            return file.read(LARGEST + 1), None
    finally:
        os.close(descriptor)
