"""Runs one notebook in a sandbox and reaches a verdict at each test cell, outside the student's process.

A test cell's own code is never run: where it stands, the judge calls the function it names with the cases of the
exercise, and compares what comes back. So nothing a student redefines in the notebook has a say.
"""

import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, partial
from types import MappingProxyType

import nbformat
from transform_lab.judging import panel
from transform_lab.judging.plain import PlainExercise
from transform_lab.judging.status import STATUSES, refuse_unknown
from transform_lab.judging.verdict import Verdict, examine

from ..intake import python_text
from ..intake.restore import Intake
from ..released import Released
from ..sandbox import Ended, Sandbox
from ..untrusted import safe
from . import public_example
from .failed_cells import FailedCell, explained, failed, stopped

MOST_RESTARTS = 10  # times a notebook is run again without the cell or call that brought its process down


@dataclass(frozen=True)
class Row:
    """One student's exercise: a row of verdicts.csv without the student's name.

    status: one of transform_lab.judging.status.STATUSES
    misconception: ids, joined by ";"; empty when none explains the answers
    """

    notebook: str
    exercise: str
    score: float
    max_score: float
    status: str
    misconception: str = ""

    def __post_init__(self):
        refuse_unknown(self.status)

    @property
    def remark(self):
        """What a table says of it in a word: the misconceptions, or the status when it was not graded; else ""."""
        return self.misconception or ("" if self.status == "graded" else self.status)


def judge(
    intake: Intake,
    released: Released,
    keys: Mapping[str, PlainExercise],
    sandbox: Sandbox,
    public: Mapping[str, PlainExercise] = MappingProxyType({}),
) -> tuple[dict[str, Verdict], dict[str, str]]:
    """Fill in the outputs of `intake.notebook`; ({exercise: Verdict}, {exercise: example}).

    There is a verdict for each exercise of the notebook, and an example (see public_example) for wrong ones where one was found.

    keys: {exercise: plain data}, from autograder.exercises.key with the run's seed
    public: {exercise: plain data}, from public_example.public_cases
    """
    examples: dict[str, str] = {}
    verdicts = {name: Verdict(name, status, says=STATUSES[status].means) for name, status in intake.statuses.items()}
    if set(verdicts) != set(released.points):
        skip: dict[int, FailedCell] = {}
        deadline = time.monotonic() + sandbox.limits.notebook
        for _ in range(MOST_RESTARTS + 1):
            with sandbox.notebook(deadline) as process:
                culprit = _run(intake, released, keys, process, verdicts, skip, public, examples)
            if culprit is None or process.exhausted:
                break
        status = "timeout" if process.exhausted else "error"
        for name in released.points:
            verdicts.setdefault(name, Verdict(name, status, says="The notebook did not get as far as this cell."))
    for cell in intake.notebook.cells:
        name = _exercise(cell, released)
        if name:
            _show(cell, verdicts[name], released.points[name])
    return verdicts, examples


def rows(released: Released, verdicts: Mapping[str, Verdict]) -> list[Row]:
    """The Rows of a judged notebook, in the order of its exercises."""
    return [
        Row(released.name, name, score(verdict, points), points, verdict.status, ";".join(verdict.misconceptions))
        for name, points in released.points.items()
        for verdict in [verdicts[name]]
    ]


def score(verdict: Verdict, points: float) -> float:
    """Points to two decimals; all of them for a right solution alone."""
    return points if verdict.right else max(0.0, min(round(verdict.credit * points, 2), points - 0.01))


def _run(intake, released, keys, process, verdicts, skip, public, examples):
    """Run the notebook from its start; returns the position of a cell that brought the process down, or None.

    skip: {position: FailedCell} of those that did so before; that cell is added. What the course's own notebook imports is
    there from the start, whatever else a student has written into the cell that imports it.
    """
    failures = dict(skip)
    try:
        process.prepare(_imports(released))
    except Ended as ended:
        intake.say(released, f"it could not be started: {ended.reason}")
    for position, cell in enumerate(intake.notebook.cells):
        if cell.cell_type != "code" or position in skip:
            continue
        name = _exercise(cell, released)
        if name is None:
            try:
                run = process.run_cell(cell.source)
            except Ended as ended:
                cell.outputs = [nbformat.from_dict(_stopped(ended))]
                intake.say(released, f"cell {position + 1} had to be stopped: {ended.reason}")
                skip[position] = stopped(cell.source, ended.reason)
                return position
            cell.outputs = [nbformat.from_dict(output) for output in map(safe, run.outputs) if output]
            cell.execution_count = run.execution_count
            if run.failed:
                failures[position] = failed(cell.source, cell.outputs)
            if run.ended:
                _end(intake, released, verdicts, position)
                return None
        elif name not in verdicts:
            call = partial(process.call, name)
            verdicts[name] = examine(name, keys[name], call)
            if not verdicts[name].right:
                solution = _solution(intake, released, name)
                verdicts[name] = explained(verdicts[name], failures.values(), solution)
            if name in public and (example := public_example.find(verdicts[name], public[name], call)):
                examples[name] = example
            if process.gone:
                skip[position] = stopped(cell.source, "its function's process ended")
                return position
    return None


@cache
def _imports(released):
    """The import statements of a released notebook's cells."""
    found = (python_text.imports(cell.source) for cell in released.notebook.cells if cell.cell_type == "code")
    return "\n".join(dict.fromkeys(filter(None, found)))


def _solution(intake, released, exercise):
    """The text of the cell in which an exercise's function should be; "" without one."""
    for cell in intake.notebook.cells:
        name = cell.metadata.get("nbgrader", {}).get("grade_id")
        if name in released.cells and name != exercise:
            if exercise in python_text.defines(released.cells[name].source):
                return cell.source
    return ""


def _end(intake, released, verdicts, position):
    says = "The notebook ended before this cell: a cell above calls exit() or quit()."
    for cell in intake.notebook.cells[position:]:
        name = _exercise(cell, released)
        if name:
            verdicts.setdefault(name, Verdict(name, "error", says=says, hint="Take that call out."))


def _exercise(cell, released):
    """The exercise that a cell tests, or None."""
    nbgrader = cell.metadata.get("nbgrader", {})
    name = nbgrader.get("grade_id")
    return name if name in released.points and nbgrader.get("grade") else None


def _stopped(ended):
    return {
        "output_type": "error",
        "ename": "Stopped",
        "evalue": f"the grader stopped this cell: {ended.reason}",
        "traceback": [f"The grader stopped this cell: {ended.reason}. The cells after it were run without it."],
    }


def opinion(verdict):
    """What a Verdict says, as an output of its test cell."""
    data = {"text/plain": panel.text(verdict, numbers=False), "text/html": panel.html(verdict, numbers=False)}
    return {"output_type": "display_data", "data": data, "metadata": {}}


def _show(cell, verdict, points):
    """The verdict as the cell's output; nbgrader takes the number of its result as the cell's points."""
    earned = score(verdict, points)
    cell.execution_count = None
    result = {"text/plain": repr(earned), "text/html": f"<div>{earned:g} of {points:g} points</div>"}
    cell.outputs = nbformat.from_dict(
        [
            opinion(verdict),
            {"output_type": "execute_result", "data": result, "metadata": {}, "execution_count": None},
        ]
    )
