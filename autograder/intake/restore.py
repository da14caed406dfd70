"""A file that a student handed in, made into a notebook of the released shape.

Whatever the file holds, the result is a valid notebook with each of the released graded cells exactly once, with its
points, its flags and (where it is locked) its text as released. Work that is there counts, wherever it lies and whatever a
tool did to the cells around it. What had to be mended is said in words.
"""

import copy
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from difflib import SequenceMatcher

import nbformat

from ..released import Released
from .python_text import binds, checks, parsed
from .reading import Cell, Unreadable, cells

EMPTY = "*(This cell was left as it was given out. What stands beside it was written by the student.)*"
ADDED = "*(This cell was not in the file that was handed in. The grader has added it.)*"
ELSEWHERE = "# The function stands in another cell of this notebook."


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
        intake = Intake(copy.deepcopy(released.notebook), dict.fromkeys(released.points, "unreadable"))
        intake.say(released, f"it cannot be read: {unreadable}")
        note = nbformat.v4.new_markdown_cell(f"**This notebook could not be read:** {unreadable}.", id="note")
        intake.notebook.cells.insert(0, note)
        return intake
    work = Restoration(found, released)
    work.recognise()
    work.choose_solutions()
    work.place_checks()
    work.place_answers()
    work.place_others()
    intake = Intake(work.notebook(), work.statuses)
    for line in work.said:
        intake.say(released, line)
    return intake


class Restoration:
    """The cells of one file on their way into the released shape; its public methods are the steps, in order.

    cells: as the notebook will have them, in order; name: {cell: the released cell that it is}, for those that are one
    """

    def __init__(self, found: Iterable[Cell], released: Released):
        self.released, self.cells = released, list(found)
        self.name: dict[Cell, str] = {}
        self.said: list[str] = []
        self.entries = any(cell.entry for cell in self.cells)  # where there are none, one line says so for all
        self.statuses: dict[str, str] = {}
        self.checks = list(released.points)
        self.answers = [name for name in released.questions if released.cells[name].metadata.nbgrader.solution]
        self.given = {name: _plain(cell.source) for name, cell in released.cells.items()}
        # {solution's cell: the exercises that it defines}
        self.solves = {
            name: binds(cell.source) & set(self.checks)
            for name, cell in released.cells.items()
            if cell.metadata.nbgrader.solution and name not in self.answers
        }
        unknown = Counter(cell.unknown for cell in self.cells if cell.unknown)
        self.said += [
            f"{number} cell{'s' * (number > 1)} of the unknown type {kind!r} taken for text"
            for kind, number in unknown.items()
        ]

    def notebook(self) -> nbformat.NotebookNode:
        """What became of the file: a valid notebook, with the released metadata around each cell."""
        metadata = {name: cell.metadata for name, cell in self.released.cells.items()}
        made: list[dict] = []
        for position, cell in enumerate(self.cells):
            own = metadata[self.name[cell]] if cell in self.name else {}
            made.append({"cell_type": cell.kind, "id": f"cell-{position}", "metadata": own, "source": cell.source})
            if cell.kind == "code":
                made[-1] |= {"outputs": [], "execution_count": None}
            elif cell.attachments:
                made[-1]["attachments"] = cell.attachments
        around = {"metadata": self.released.notebook.metadata, "nbformat": 4, "nbformat_minor": 5}
        notebook = nbformat.from_dict({"cells": made, **around})  # a copy, all the way down
        nbformat.validate(notebook)
        return notebook

    # --- which cell is which ------------------------------------------------------------------------------------------

    def recognise(self):
        """Name cells: by nbgrader's entry; a check's by its call; where the entry is lost, by their text or their place."""
        lost = [cell for cell in self.cells if self._recognise_by_entry(cell) and not cell.entry]
        lost += self._recognise_by_text()
        if lost and not self.entries:
            self.said.append("nbgrader's data of all cells were lost; they were recognised by what stands in them")
        elif checks_of := [self.name[cell] for cell in lost if self.name[cell] in self.checks]:
            self.said.append(
                f"the test cell of {', '.join(checks_of)} had lost its nbgrader data; it was recognised by its call"
            )

    def _recognise_by_entry(self, cell):
        """Name a cell by its entry, or by its one call of `check`; whether it was named."""
        claimed = cell.entry.get("grade_id")
        called, alone = checks(cell.source)
        if alone and called[0] in self.checks:
            claimed = called[0]
        elif claimed in self.checks and cell.source.strip():
            return False  # typed into, joined or split: it is the student's own, and the check is put back
        if claimed in self.released.cells:
            self.name[cell] = claimed
        return cell in self.name

    def _recognise_by_text(self):
        """Name the cells that have the text of one released cell alone, where nothing else is that cell."""
        texts = Counter(_plain(cell.source) for cell in self.released.notebook.cells)
        of_text = {text: name for name, text in self.given.items() if texts[text] == 1 and not self._all(name)}
        found = [cell for cell in self.cells if cell not in self.name and _plain(cell.source) in of_text]
        for cell in found:
            self.name[cell] = of_text[_plain(cell.source)]
        return found

    def _all(self, name):
        return [cell for cell in self.cells if self.name.get(cell) == name]

    def _is_given(self, cell, name):
        """Whether a cell holds what was given out as `name`, and nothing of the student's."""
        return _plain(cell.source) in ("", self.given[name])

    # --- one of each --------------------------------------------------------------------------------------------------

    def choose_solutions(self):
        """Have one cell for each solution: of copies the one that is not as given out, of several the last."""
        for name, solves in self.solves.items():
            chosen = self._one_of(name)
            if chosen is None or self._is_given(chosen, name):
                others = [cell for cell in self._writers(solves) if cell not in self.name] or self._as_text(solves)
                if others:
                    self._drop(chosen)  # it would define the function once more, and undo the student's
                    self.name[others[-1]] = name
                    if self.entries:
                        self.said.append(f"the function of {name} stands in another cell, which was graded")
                    self._set_kind(others[-1], name)
                elif writers := self._writers(solves):  # in another solution's cell
                    if chosen is None:
                        chosen = Cell("code", "")
                        self.cells.insert(self.cells.index(writers[0]), chosen)
                        self.name[chosen] = name
                    chosen.source = ELSEWHERE
                    self.said.append(f"the function of {name} stands in another exercise's cell, and was graded there")
            else:
                self._set_kind(chosen, name)

    def _one_of(self, name):
        """The one cell that counts as `name`, or None; the others are the student's own, or dropped when as given out."""
        found = self._all(name)
        if not found:
            return None
        written = [cell for cell in found if not self._is_given(cell, name)]
        chosen = (written or found)[-1]
        if len(found) > 1:
            which = "the last one that was written in" if len(written) > 1 else "the one that was written in"
            self.said.append(
                f"the cell {name} is there {len(found)} times; {which if written else 'the last one'} was graded"
            )
        for cell in found:
            if cell is not chosen:
                del self.name[cell]
                if cell not in written:
                    self._drop(cell)
        return chosen

    def _writers(self, exercises):
        """The code cells that define one of these, in the student's own words, in order."""
        given = {self.given[name] for name in self.solves}
        return [
            cell
            for cell in self.cells
            if cell.kind == "code" and self._defines(cell, exercises) and _plain(cell.source) not in given
        ]

    def _as_text(self, exercises):
        """Text cells that are the Python which defines one of these: a cell's type is changed by a single key."""
        return [
            cell
            for cell in self.cells
            if cell.kind == "markdown"
            and cell not in self.name
            and self._defines(cell, exercises)
            and parsed(cell.source) is not None
        ]

    def _defines(self, cell, exercises):
        return any(name in cell.source for name in exercises) and not binds(cell.source).isdisjoint(exercises)

    def _set_kind(self, cell, name):
        kind = self.released.cells[name].cell_type
        if cell.kind != kind:
            cell.kind = kind
            self.said.append(f"the cell {name} had another type; it was set back")

    def _drop(self, cell):
        if cell is not None:
            self.name.pop(cell, None)
            self.cells.remove(cell)

    # --- checks -------------------------------------------------------------------------------------------------------

    def place_checks(self):
        """Have one test cell for each exercise, as released, after the function that it tests."""
        for name in self.checks:
            solutions = [
                cell for solution, solves in self.solves.items() if name in solves for cell in self._all(solution)
            ]
            writers = self._writers([name])
            if found := self._all(name):
                self._keep_check(found, name)
                self._move_check(name, writers, [cell for cell in solutions if cell in writers])
                continue
            check = Cell("code", self.released.cells[name].source)
            self.name[check] = name
            tried = [
                cell for cell in self.cells if cell.entry.get("grade_id") == name or name in checks(cell.source)[0]
            ]
            places = solutions + tried or writers
            if places or writers:
                self.cells.insert(max(map(self.cells.index, places)) + 1, check)
                said = (
                    "had been changed; what stands there was run, and the test cell put back behind it"
                    if tried
                    else "is missing; it was put back behind its solution"
                )
                self.said.append(f"the test cell of {name} {said}")
            else:
                self.cells.append(check)
                self.statuses[name] = "missing"
                self.said.append(
                    f"the test cell of {name} is missing, and so is the function: 0 points; both have to be in the file, "
                    "under the names that they were given out with"
                )

    def _keep_check(self, found, name):
        """Of several test cells the last; more of them are the student's, and change nothing."""
        check = next((cell for cell in reversed(found) if cell.entry.get("grade_id") == name), found[-1])
        for other in found:
            if other is not check:
                del self.name[other]
        if not checks(check.source)[1]:
            self.said.append(f"the locked cell {name} had been changed; its text was set back")
        self._set_kind(check, name)
        check.source = self.released.cells[name].source

    def _move_check(self, name, writers, solutions):
        """Move a test cell that stands before all cells that define its function, or before the solution that counts."""
        (check,) = self._all(name)
        here = self.cells.index(check)
        behind = [cell for cell in solutions if self.cells.index(cell) > here]
        if not any(self.cells.index(cell) < here for cell in writers):
            behind = behind or writers
        if behind:
            place = self.cells.index(behind[-1])
            self.cells.insert(place, self.cells.pop(here))
            self.said.append(f"the test cell of {name} stood before its solution; it was moved behind it")

    # --- written answers ----------------------------------------------------------------------------------------------

    def place_answers(self):
        """Have one cell for each question. Where anything was written for it, its text is not the released one.

        nbgrader gives 0 points to an answer that stands there as released; all others wait for a person.
        """
        for name in self.answers:
            answer, beside = self._one_of(name), self._beside(name)
            if answer is None:
                self._add_answer(name, beside)
            elif self._is_given(answer, name):
                words = [cell for cell in beside if cell.kind == "markdown"]
                if len(beside) == 1 and words:
                    self._drop(answer)
                    self.name[words[0]] = name
                    self.said.append(f"the answer to {name} stands in a cell of its own; a person reads it there")
                elif beside:
                    answer.source = EMPTY
                    self.said.append(f"the answer to {name} seems to stand beside its cell; a person reads it there")
            else:
                self._set_kind(answer, name)

    def _add_answer(self, name, beside):
        words = [cell for cell in beside if cell.kind == "markdown"]
        if len(words) == 1:
            self.name[words[0]] = name
            if self.entries:
                self.said.append(f"the cell {name} has lost its nbgrader data; it was recognised by its place")
            return
        cell = Cell("markdown", EMPTY if beside else ADDED)
        self.cells.insert(self._region(name)[1], cell)
        self.name[cell] = name
        self.said.append(
            f"the cell {name} is missing, or has lost its nbgrader data; a person looks whether it was answered"
        )

    def _beside(self, name):
        """The student's own cells with text between the released cells that come before and after a question's."""
        start, end = self._region(name)
        given = {"", *(_plain(cell.source) for cell in self.released.notebook.cells)}
        return [cell for cell in self.cells[start:end] if cell not in self.name and _plain(cell.source) not in given]

    def _region(self, name):
        """(start, end) of the cells that stand where the question stood when it was given out."""
        ours = [
            self._token(cell.metadata.get("nbgrader", {}).get("grade_id"), cell.source)
            for cell in self.released.notebook.cells
        ]
        theirs = [self._token(self.name.get(cell), cell.source) for cell in self.cells]
        question = ours.index(name)
        start, end = 0, len(theirs)
        for block in SequenceMatcher(None, ours, theirs, autojunk=False).get_matching_blocks():
            for a, b in zip(range(block.a, block.a + block.size), range(block.b, block.b + block.size)):
                if a < question:
                    start = b + 1
                elif a > question:
                    return start, max(start, b)
        return start, end

    def _token(self, name, source):
        return name or _plain(source)

    # --- the rest -----------------------------------------------------------------------------------------------------

    def place_others(self):
        """Whatever else nbgrader knows: locked cells as released; solutions that are nowhere, as given out, at the end."""
        for name, original in self.released.cells.items():
            entry = original.metadata.nbgrader
            cell = self._one_of(name)
            if cell and entry.locked and name not in self.checks and cell.source != original.source:
                cell.source, cell.kind = original.source, original.cell_type
                self.said.append(f"the locked cell {name} had been changed; its text was set back")
            elif not cell and (entry.solution or entry.grade):
                cell = Cell(original.cell_type, original.source)
                self.cells.append(cell)
                self.name[cell] = name
                self.said.append(f"the cell {name} is missing; it was added as it was given out")
        self._set_flags_back()

    def _set_flags_back(self):
        for cell, name in self.name.items():
            entry = self.released.cells[name].metadata.nbgrader
            for flag in ("points", "grade", "solution", "locked"):
                right = entry.get(flag)
                claimed = cell.entry.get(flag, right) if cell.entry.get("grade_id") == name else right
                if claimed != right and not (flag == "points" and self._was_worth(name, cell.entry)):
                    self.said.append(f"the cell {name} said {flag} {claimed!r:.40}; it was set back to {right!r}")

    def _was_worth(self, name, entry):
        """Whether an earlier release gave the cell the points that the file claims: nbgrader's checksum counts them in."""
        from nbgrader import utils  # here, because it takes longer than to check one student's files

        earlier = copy.deepcopy(self.released.cells[name])
        earlier.metadata.nbgrader.points = entry["points"]
        try:
            return entry.get("checksum") == utils.compute_checksum(earlier)
        except (TypeError, ValueError):  # no number
            return False


def _plain(source):
    """A cell's text without the white space that editors and formatters change."""
    return "\n".join(line.rstrip() for line in source.strip().split("\n"))
