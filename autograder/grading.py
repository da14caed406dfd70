"""The path of a submission, from the files a student handed in to verdicts and graded notebooks. Read it top to bottom.

    submission.collect -> intake.restore -> judge.judge (in a sandbox) -> Graded

`grade_submission` is a pure function of its arguments, so any concurrent.futures.Executor can run it anywhere.
"""

import hashlib
import json
import secrets
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path

import nbformat
from transform_lab.judging import panel

from .exercises import EXERCISES, key
from .intake import restore
from .judge import Row, judge, rows
from .public_example import public_cases
from .sandbox import Limits, Sandbox

RECORD = "transform_lab"  # the entry of an autograded notebook's metadata that holds its verdicts


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
    public: dict = field(default_factory=dict)  # {exercise: plain data}: the cases of the students' own `check`

    def sandbox(self, submission):
        """A Sandbox for one submission, with the files that its notebooks may import or read."""
        return Sandbox(self.package, submission.helpers, self.limits, self.isolated)


@dataclass
class Graded:
    """The result: a Row for each exercise, the graded notebooks as text, and what was odd, in words."""

    student: str
    rows: list = field(default_factory=list)
    notebooks: dict = field(default_factory=dict)  # {notebook name: JSON text}; none for a missing file
    marks: dict = field(default_factory=dict)  # {notebook name: Marks}
    problems: list = field(default_factory=list)
    receipts: dict = field(default_factory=dict)  # {file name: text}, see submission.receipts


def assignment(course, seed, limits=Limits(), isolated=True, notebooks=None):
    """The Assignment of a course, with the hidden cases drawn from `seed` (for all notebooks, or those named)."""
    wanted = course.notebooks if notebooks is None else notebooks
    names = [name for notebook in wanted for name in course.notebooks[notebook].points]
    keys = {name: key(EXERCISES[name], seed) for name in names}
    key_file = course.release / "transform_lab" / "key.json"
    public = public_cases(key_file.read_text(encoding="utf-8")) if key_file.is_file() else {}
    digest = specification(course)
    return Assignment(dict(course.notebooks), keys, course.package, seed, digest, limits, isolated, public)


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


def grade_submission(submission, assignment):
    """Grade one student's submission: a Graded with a row for every exercise of the assignment."""
    from .marks import marks  # here, because it imports nbgrader, which takes longer than to check one student's files

    graded = Graded(submission.student, problems=list(submission.problems), receipts=submission.receipts)
    with assignment.sandbox(submission) as sandbox:
        for name, released in assignment.released.items():
            content = submission.files.get(f"{name}.ipynb")
            if content is None:
                graded.rows += missing(released)
                continue
            intake = restore(content, released)
            verdicts = grade_notebook(intake, released, assignment, sandbox, submission)
            graded.rows += rows(released, verdicts)
            graded.notebooks[name] = nbformat.v4.writes(intake.notebook) + "\n"
            graded.marks[name] = marks(intake.notebook)
            graded.problems += intake.problems
    return graded


def grade_notebook(intake, released, assignment, sandbox, submission):
    """Judge one notebook: {exercise: Verdict}; its outputs, and its record in the metadata, are filled in.

    The record is what reports and feedback are made from, and tells what need not be graded again.
    """
    verdicts, examples = judge(intake, released, assignment.keys, sandbox, assignment.public)
    intake.notebook.metadata[RECORD] = nbformat.from_dict(
        {
            "rows": [asdict(row) for row in rows(released, verdicts)],
            "mistakes": {name: panel.mistakes(verdict) for name, verdict in verdicts.items()},
            "undone": [name for name, verdict in verdicts.items() if not verdict.done],
            "examples": examples,
            "problems": [*submission.problems, *intake.problems],
            "seed": assignment.seed,
            "graded": datetime.now(UTC).isoformat(timespec="seconds"),
            "submission": submission.digest,
            "specification": assignment.digest,
        }
    )
    return verdicts


def recorded(course, student):
    """{notebook: record} of what is already graded; a damaged or outdated record counts as not graded."""
    found = {}
    for name, released in course.notebooks.items():
        try:
            text = (course.autograded(student) / f"{name}.ipynb").read_text(encoding="utf-8")
            record = json.loads(text)["metadata"][RECORD]
            record["rows"] = [Row(**row) for row in record["rows"]]
            datetime.fromisoformat(record["graded"])
            if [row.exercise for row in record["rows"]] == list(released.points) and {
                "seed",
                "problems",
            } <= record.keys():
                found[name] = record
        except (OSError, ValueError, KeyError, TypeError):
            continue
    return found


def missing(released):
    """The Rows of a notebook that was not handed in."""
    return [Row(released.name, name, 0.0, points, "missing") for name, points in released.points.items()]
