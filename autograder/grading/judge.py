"""Runs one notebook in a sandbox and reaches a verdict at each test cell, outside the student's process.

A test cell's own code is never run: where it stands, the judge calls the function it names with the cases of the
exercise, and compares what comes back. So nothing a student redefines in the notebook has a say.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
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
from .telling import Telling

MOST_RESTARTS = 10  # times a notebook is run again without the cell or call that brought its process down
RESTART = 1.0  # seconds of the notebook's time that each costs besides


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
        run = _Run(intake, released, keys, public, verdicts, examples)
        time, over, runs = sandbox.time(), False, 0
        cells = [cell.source for cell in intake.notebook.cells if cell.cell_type == "code"]
        while set(verdicts) != set(released.points) and runs <= MOST_RESTARTS and not over:
            if runs:
                time.cells.use(RESTART)
            with sandbox.notebook(time, cells, _given(released)) as process:
                run.through(process)
                over = process.over
            runs += 1
        status = "timeout" if over else "error"
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


class _Run:
    """A notebook that is run from its start, once, or again without the cells that brought its process down.

    What a function is asked with must not be seen in the notebook's outputs: others would have it from the pages. So all
    cells are run first, and each exercise is judged in a snapshot of the process, taken where its test cell stands. A process
    with threads has no snapshots that work: there the function is kept as it is, and judged after the last cell.
    """

    def __init__(self, intake, released, keys, public, verdicts, examples):
        self.intake, self.released, self.keys, self.public = intake, released, keys, public
        self.verdicts, self.examples = verdicts, examples  # to be filled in
        self.aside: set[str] = set()  # exercises of which a snapshot could not be made, or was ended
        self.skip: dict[int, FailedCell] = {}  # {position: the cell that brought the process down}
        self.failures: dict[int, FailedCell] = {}

    def through(self, process):
        """Run all cells, then judge; what is not judged then needs another run.

        What the course's own notebook imports is there from the start, whatever else a student has written into the cell that
        imports it. Those that are set aside come last: judged at once, where their test cells stand, in the notebook's own
        process, whose outputs are then not kept.
        """
        at_once = set(self.released.points) <= self.verdicts.keys() | self.aside
        self.failures, snapshots, kept = {**(self.failures if at_once else {}), **self.skip}, {}, []
        try:
            process.prepare(_imports(self.released))
        except Ended as ended:
            self.intake.say(self.released, f"it could not be started: {ended.reason}")
        for position, cell in enumerate(self.intake.notebook.cells):
            name = _exercise(cell, self.released)
            if cell.cell_type != "code" or position in self.skip or name in self.verdicts:
                continue
            if name in self.aside and not at_once:
                continue
            try:
                if name is None and self._run_cell(process, cell, position, at_once):
                    _end(self.intake, self.released, self.verdicts, position)
                    break
                elif name and at_once:
                    self._judge(name, process)
                elif name and process.threaded:
                    process.keep(name)
                    kept.append(name)
                elif name:
                    snapshots[name] = process.snapshot()
            except Ended as ended:
                if not at_once:
                    cell.outputs = [nbformat.from_dict(_stopped(ended))]
                self.intake.say(self.released, f"cell {position + 1} had to be stopped: {ended.reason}")
                self.skip[position] = stopped(cell.source, ended.reason)
                if process.exhausted:
                    break
                return
            if process.gone:
                self.skip[position] = stopped(cell.source, "its function's process ended")
                return
        asked = {name: taken for name, taken in snapshots.items() if taken.meets()}
        self.aside |= snapshots.keys() - asked.keys()
        asked |= dict.fromkeys(kept, process)
        # All public cases before the first hidden one: what they give is shown.
        answers = {name: public_example.answers(name, self.public.get(name), taken) for name, taken in asked.items()}
        for name, taken in asked.items():
            if taken is process and process.gone:  # ended by another function
                self.aside.add(name)
                continue
            self._judge(name, taken, answers[name])
            if self.verdicts[name].status == "killed":
                # Whether its function has ended it, or something else here, shows where it is judged at once.
                del self.verdicts[name]
                self.aside.add(name)

    def _run_cell(self, process, cell, position, at_once):
        """Run a cell of the student's; whether it ended the notebook."""
        run = process.run_cell(cell.source)
        if not at_once:
            run.cell, cell.execution_count = cell, run.execution_count
            for shown in (run, *run.changed):
                shown.cell.outputs = [nbformat.from_dict(output) for output in map(safe, shown.outputs) if output]
            if run.failed:
                self.failures[position] = failed(cell.source, cell.outputs)
        return run.ended

    def _judge(self, name, process, answers=()):
        """Reach the verdict on an exercise; by the `answers` to public cases alone where one of those calls had no end."""
        solution = _solution(self.intake, self.released, name)
        cases = self.keys[name]["cases"]
        replies = process.calls(name, [*cases, cases[0]])
        if answers and not answers[-1].reply.finished:
            replies = iter([answers[-1].reply])
        verdict = examine(
            name, self.keys[name], lambda *_: next(replies), lambda: next(replies), Telling(answers, solution)
        )
        if not verdict.right:
            verdict = explained(verdict, self.failures.values(), solution)
            if example := public_example.find(verdict, self.public.get(name), answers):
                self.examples[name] = example
        self.verdicts[name] = verdict


@cache
def _imports(released):
    """The import statements of a released notebook's cells."""
    found = (python_text.imports(cell.source) for cell in released.notebook.cells if cell.cell_type == "code")
    return "\n".join(dict.fromkeys(filter(None, found)))


@cache
def _given(released):
    """The texts of a released notebook's cells that students run, most of them as they are."""
    cells = (cell for cell in released.notebook.cells if cell.cell_type == "code")
    return frozenset(cell.source for cell in cells if _exercise(cell, released) is None)


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
