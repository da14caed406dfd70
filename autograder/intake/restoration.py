"""The steps by which the cells of a file come into the released shape: which cell is which, one of each, each in its place."""

import copy
from collections import Counter
from collections.abc import Iterable

import nbformat

from ..released import Released
from .python_text import checks, code_in, code_of, continues, defines, may_define_unseen, takes, uses
from .reading import Cell

ELSEWHERE = "# The function stands in another cell of this notebook."


class Restoration:
    """The cells of one file on their way into the released shape.

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
        self.given = {name: plain(cell.source) for name, cell in released.cells.items()}
        self.given_lines = {line.strip() for cell in released.notebook.cells for line in cell.source.split("\n")}
        # {solution's cell: the exercises that it defines}
        self.solves = {
            name: set(self.checks).intersection(defines(cell.source))
            for name, cell in released.cells.items()
            if cell.metadata.nbgrader.solution and name not in self.answers
        }
        unknown = Counter(cell.unknown for cell in self.cells if cell.unknown)
        self.said += [
            f"{number} cell{'s' * (number > 1)} of the unknown type {kind!r} {'were' if number > 1 else 'was'} taken for text"
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
        texts = Counter(plain(cell.source) for cell in self.released.notebook.cells)
        of_text = {text: name for name, text in self.given.items() if texts[text] == 1 and not self.all(name)}
        found = [cell for cell in self.cells if cell not in self.name and plain(cell.source) in of_text]
        for cell in found:
            self.name[cell] = of_text[plain(cell.source)]
        return found

    def all(self, name):
        """The cells that are this released cell, in order."""
        return [cell for cell in self.cells if self.name.get(cell) == name]

    def is_given(self, cell, name):
        """Whether a cell holds what was given out as `name`, and nothing of the student's."""
        given = self.released.cells[name]
        if cell.kind == "code" == given.cell_type and (code := code_of(given.source)) and code_of(cell.source) == code:
            return True  # with a comment more, which is no work
        return plain(cell.source) in ("", self.given[name]) and not cell.attachments

    # --- one of each --------------------------------------------------------------------------------------------------

    def join_halves(self):
        """Put together the solutions that were split in the middle of a function."""
        for name, solves in self.solves.items():
            for place in range(len(self.cells) - 2, -1, -1):
                first, second = self.cells[place : place + 2]
                own = self.name.get(first) == name or not solves.isdisjoint(defines(first.source))
                if first.kind == second.kind == "code" and own and self.name.get(second, name) == name:
                    if second.source.strip() and continues(first.source, second.source):
                        first.source += "\n" + second.source
                        self._drop(second)
                        self.said.append(f"the cell {name} had been split; its halves were put together")

    def choose_solutions(self):
        """Have one cell for each solution: of copies the one that is not as given out, of several the last."""
        for name, solves in self.solves.items():
            chosen = self.one_of(name)
            if chosen is not None and not self.is_given(chosen, name):
                self._as_code(chosen, name)
                unnamed = [cell for cell in self.cells if cell not in self.name and cell.source.strip()]
                for stub in [cell for cell in unnamed if self.is_given(cell, name)]:
                    self._drop(stub)  # it would define the function once more, and undo the student's
                continue
            others = [cell for cell in self._writers(solves) if cell not in self.name] or self._texts(solves)
            if chosen is None and not others:
                others = [cell for cell in self._takers(solves) if cell not in self.name]
            if others:
                self._drop(chosen)
                self.name[self._best(others, solves)] = name
                if self.entries:
                    self.said.append(f"the function of {name} stands in another cell, which was graded")
                self._as_code(self.all(name)[0], name)
            elif writers := self._writers(solves):  # in another solution's cell
                if chosen is None:
                    chosen = Cell("code", "")
                    self.cells.insert(self.cells.index(writers[0]), chosen)
                    self.name[chosen] = name
                chosen.source = ELSEWHERE
                self.said.append(f"the function of {name} stands in another exercise's cell, and was graded there")

    def _best(self, writers, exercises):
        """The last of these that stands above its test cell; where none does, the last one."""
        places = [self.cells.index(cell) for name in exercises for cell in self.all(name)]
        above = [cell for cell in writers if self.cells.index(cell) < max(places, default=0)]
        return (above or writers)[-1]

    def one_of(self, name):
        """The one cell that counts as `name`, or None; the others are the student's own, or dropped when as given out."""
        found = self.all(name)
        if not found:
            return None
        written = [cell for cell in found if not self.is_given(cell, name)]
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
        """The code cells that define one of these functions, in the student's own words, in order."""
        return self._code(exercises, defines)

    def _takers(self, exercises):
        """The code cells that take one of these functions from elsewhere, in order."""
        return self._code(exercises, takes)

    def _code(self, exercises, names):
        own = [cell for cell in self.cells if cell.kind == "code" and any(name in cell.source for name in exercises)]
        own = [cell for cell in own if not set(exercises).isdisjoint(names(cell.source))]
        return [cell for cell in own if not any(self.is_given(cell, name) for name in self.solves)]

    def _texts(self, exercises):
        """Text cells with the Python that defines one of these: a cell's type is changed by a single key."""
        texts = [cell for cell in self.cells if cell.kind == "markdown" and cell not in self.name]
        texts = [cell for cell in texts if any(f"def {name}" in cell.source for name in exercises)]
        return [cell for cell in texts if not set(exercises).isdisjoint(defines(code_in(cell.source) or ""))]

    def _as_code(self, cell, name):
        if cell.kind != "code":
            cell.source = code_in(cell.source) or cell.source
        self.set_kind(cell, name)

    def set_kind(self, cell, name):
        """Set a cell's type back to that of the released cell `name`."""
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
                cell for solution, solves in self.solves.items() if name in solves for cell in self.all(solution)
            ]
            writers = self._writers([name]) or self._takers([name])
            if found := self.all(name):
                self._keep_check(found, name)
                self._move_check(name, writers, [cell for cell in solutions if cell in writers])
            else:
                self._put_check_back(name, writers, solutions)

    def _put_check_back(self, name, writers, solutions):
        """Behind the solution that counts, and behind what the student has made of the test cell."""
        check = Cell("code", self.released.cells[name].source)
        self.name[check] = name
        tried = [cell for cell in self.cells if cell.entry.get("grade_id") == name or name in checks(cell.source)[0]]
        places = [cell for cell in solutions if cell in writers] or writers or solutions
        if not places:  # it may come from where its name is not seen
            places = [cell for cell in self.cells if cell.kind == "code" and may_define_unseen(cell.source)]
        if places:
            self.cells.insert(max(map(self.cells.index, places + tried)) + 1, check)
            if tried:
                self.said.append(
                    f"the test cell of {name} had been changed; what stands there was run, and the test cell put back behind it"
                )
            else:
                self.said.append(f"the test cell of {name} is missing; it was put back behind its solution")
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
        if not checks(check.source)[1] or name not in uses(check.source):
            self.said.append(f"the locked cell {name} had been changed; its text was set back")
        self.set_kind(check, name)
        check.source = self.released.cells[name].source

    def _move_check(self, name, writers, solutions):
        """Move a test cell that stands before all cells that define its function, or before the solution that counts."""
        (check,) = self.all(name)
        here = self.cells.index(check)
        behind = [cell for cell in solutions if self.cells.index(cell) > here]
        if not any(self.cells.index(cell) < here for cell in writers):
            behind = behind or writers
        if behind:
            place = self.cells.index(behind[-1])
            self.cells.insert(place, self.cells.pop(here))
            self.said.append(f"the test cell of {name} stood before its solution; it was moved behind it")

    # --- the rest -----------------------------------------------------------------------------------------------------

    def place_others(self):
        """Whatever else nbgrader knows: locked cells as released; solutions that are nowhere, as given out, at the end."""
        for name, original in self.released.cells.items():
            entry = original.metadata.nbgrader
            cell = self.one_of(name)
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


def plain(source):
    """A cell's text without the white space that editors and formatters change."""
    return "\n".join(line.rstrip() for line in source.strip().split("\n"))
