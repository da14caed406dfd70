"""A file that a student handed in, made into a notebook of the released shape.

Whatever the file holds, the result is a valid notebook with each of the released graded cells exactly once, with its
points, its flags and (where it is locked) its text as released. Work that is there counts, wherever it lies and whatever a
tool did to the cells around it. What had to be mended is said in words.
"""

import copy
from dataclasses import dataclass, field

import nbformat

from ..released import Released
from .reading import Unreadable, cells
from .restoration import Restoration
from .written_answers import place_answers


@dataclass
class Intake:
    """notebook: ready to run; statuses: {exercise: "missing" or "unreadable"} for what cannot be graded."""

    notebook: nbformat.NotebookNode
    statuses: dict[str, str] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)

    def say(self, released: Released, problem: str) -> None:
        self.problems.append(f"{released.name}.ipynb: {problem}.")


def restore(content: bytes, released: Released) -> Intake:
    """The Intake of `content` (bytes of a submitted file), measured against the Released notebook of that name."""
    try:
        found = cells(content)
    except Unreadable as unreadable:
        return without_work(
            released, "unreadable", f"it cannot be read: {unreadable}", f"could not be read:** {unreadable}"
        )
    work = Restoration(found, released)
    work.recognise()
    work.join_halves()
    work.choose_solutions()
    work.place_checks()
    place_answers(work)
    work.place_others()
    intake = Intake(work.notebook(), work.statuses)
    for line in work.said:
        intake.say(released, line)
    return intake


def without_work(released: Released, status: str, problem: str, note: str = "") -> Intake:
    """The Intake of a file of which nothing can be judged: as released, with a note on top.

    status: of all exercises; problem: why, as the end of a sentence; note: how the note ends that begins "**This notebook"
    """
    intake = Intake(copy.deepcopy(released.notebook), dict.fromkeys(released.points, status))
    intake.say(released, problem)
    text = f"**This notebook {note or f'was not judged:** {problem}'}."
    intake.notebook.cells.insert(0, nbformat.v4.new_markdown_cell(text, id="note"))
    return intake
