"""The path of a submission, from the files a student handed in to verdicts and graded notebooks. Read it top to bottom.

    submission.submission_of -> restore.restore -> judge.judge (in a sandbox) -> Graded

`grade_submission` is a pure function of its arguments, so any concurrent.futures.Executor can run it anywhere.
"""

import os
import secrets
from collections.abc import Callable, Iterable
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

import nbformat
from transform_lab.judging.plain import PlainExercise
from transform_lab.judging.verdict import Verdict

from ..course import Course
from ..exercises import EXERCISES, key
from ..intake.restore import Intake, restore, without_work
from ..intake.submission import Submission, receipts
from ..released import Released
from ..sandbox import Limits, Sandbox
from . import digests
from .failure import Failure
from .judge import Row, judge, rows
from .public_example import public_cases
from .records import RECORD, missing, told
from .writing import text_of

if TYPE_CHECKING:
    from .marks import Marks


NOT_JUDGED = "it could not be judged ({}); look at it by hand"


class Keys(dict):
    """The hidden cases of a run, {exercise: plain data}. Another process that gets them draws them again."""

    def __init__(self, names: Iterable[str], seed: int):
        super().__init__({name: key(EXERCISES[name], seed, when_asked=True) for name in names})
        self.drawn = tuple(names), seed

    def __reduce__(self):
        return Keys, self.drawn


@dataclass(frozen=True)
class GradingRun:
    """What submissions are graded against: released notebooks, this run's hidden cases, the students' package."""

    released: dict[str, Released]  # by the notebook's name
    keys: dict[str, PlainExercise]
    package: Path
    seed: int
    digest: str
    limits: Limits = Limits()
    isolated: bool | str = True
    public: dict[str, PlainExercise] = field(default_factory=dict)  # the cases of the students' own `check`

    def sandbox(self, submission: Submission) -> Sandbox:
        """A Sandbox for one submission, with the files that its notebooks may import or read."""
        return Sandbox(self.package, submission.helpers, self.limits, self.isolated)


@dataclass
class Graded:
    """The result: a Row for each exercise, the graded notebooks as text, and what was odd, in words.

    final: False where the next `grade` tries again
    """

    student: str
    rows: list[Row] = field(default_factory=list)
    notebooks: dict[str, str] = field(default_factory=dict)  # {notebook name: JSON text}; none for a missing file
    marks: dict[str, "Marks"] = field(default_factory=dict)  # {notebook name: Marks}
    problems: list[str] = field(default_factory=list)
    receipts: dict[str, str] = field(default_factory=dict)  # {file name: text}, see submission.receipts
    record: dict = field(default_factory=dict)  # of the submission, where there is no notebook that could hold it
    final: bool = True

    def add(
        self, released: Released, intake: Intake, verdicts: dict[str, Verdict], written: tuple[str, "Marks"]
    ) -> None:
        """One graded notebook."""
        self.rows += rows(released, verdicts)
        self.notebooks[released.name], self.marks[released.name] = written
        self.problems += intake.problems


def grading_run(
    course: Course,
    seed: int,
    limits: Limits = Limits(),
    isolated: bool | str = True,
    notebooks: list[str] | None = None,
) -> GradingRun:
    """The GradingRun of a course, with the hidden cases drawn from `seed` (for all notebooks, or those named)."""
    wanted = course.notebooks if notebooks is None else notebooks
    names = [name for notebook in wanted for name in course.notebooks[notebook].points]
    key_file = course.release / "transform_lab" / "key.json"
    public = public_cases(key_file.read_text(encoding="utf-8")) if key_file.is_file() else {}
    digest = digests.of_grades(course, limits)
    return GradingRun(dict(course.notebooks), Keys(names, seed), course.package, seed, digest, limits, isolated, public)


def new_seed() -> int:
    """A seed nobody can know before: hidden cases are drawn anew for each grading run."""
    return secrets.randbits(32)


def grade_submission(submission: Submission, run: GradingRun) -> Graded:
    """Grade one student's submission: a Graded with a row for every exercise of the assignment."""
    graded = Graded(submission.student, problems=list(submission.problems), receipts=submission.receipts)
    with run.sandbox(submission) as sandbox:
        for name, released in run.released.items():
            content = submission.files.get(f"{name}.ipynb")
            if content is None:
                graded.rows += missing(released)
                continue
            graded.add(released, *judged(content, released, run, sandbox, submission, _written))
    if not graded.notebooks:
        graded.record = {"problems": graded.problems, **_grading(submission, run)}
    return graded


def not_judged(course: Course, student: str, run: GradingRun, why: str) -> Graded:
    """The Graded of a submission that this machine could not read or judge; it is tried again with the next `grade`.

    why: as the end of a sentence
    """
    folder = course.submitted(student)
    there = [name for name in run.released if os.path.lexists(folder / f"{name}.ipynb")] or list(run.released)
    graded = Graded(student, receipts=receipts(folder)[0], final=False)
    with run.sandbox(empty := Submission(student, {})) as sandbox:
        for name, released in run.released.items():
            if name in there:
                intake = without_work(released, "killed", NOT_JUDGED.format(why))
                verdicts = grade_notebook(intake, released, run, sandbox, empty)
                graded.add(released, intake, verdicts, _written(intake))
            else:
                graded.rows += missing(released)
    return graded


def judged(
    content: bytes,
    released: Released,
    run: GradingRun,
    sandbox: Sandbox,
    submission: Submission,
    then: Callable[[Intake], Any] = lambda intake: None,
) -> tuple[Intake, dict[str, Verdict], Any]:
    """(Intake, its Verdicts, what `then` makes of it) of a file's content; of what the grader fails on, nothing is judged."""
    try:
        intake = restore(content, released)
        return intake, grade_notebook(intake, released, run, sandbox, submission), then(intake)
    except Exception as error:
        failure = Failure.of(error)
        if not failure.of_content:
            raise
    intake = without_work(released, "unreadable", NOT_JUDGED.format(failure.words))
    return intake, grade_notebook(intake, released, run, sandbox, submission), then(intake)


def _written(intake):
    """A graded notebook as text, and its Marks."""
    from .marks import marks  # here, because it imports nbgrader, which takes longer than to check one student's files

    return text_of(intake.notebook) + "\n", marks(intake.notebook)


def _grading(submission, run):
    """What a record says of its grading, which also tells whether it need be done again."""
    return {
        "seed": run.seed,
        "graded": datetime.now(UTC).isoformat(timespec="seconds"),
        "submission": submission.digest,
        "specification": run.digest,
    }


def grade_notebook(
    intake: Intake, released: Released, run: GradingRun, sandbox: Sandbox, submission: Submission
) -> dict[str, Verdict]:
    """Judge one notebook: {exercise: Verdict}; its outputs, and its record in the metadata, are filled in.

    The record is what reports and feedback are made from, and tells what need not be graded again.
    """
    left = sandbox.allowance.left
    verdicts, examples = judge(intake, released, run.keys, sandbox, run.public)
    intake.notebook.metadata[RECORD] = nbformat.from_dict(
        {
            "rows": [asdict(row) for row in rows(released, verdicts)],
            "verdicts": {name: told(verdict) for name, verdict in verdicts.items()},
            "examples": examples,
            "problems": [*submission.problems, *intake.problems],
            "seconds": round(left - sandbox.allowance.left, 3),
            **_grading(submission, run),
        }
    )
    return verdicts
