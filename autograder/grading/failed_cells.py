"""Cells that stopped with an error, and what is missing because of them: a verdict names the cell, not its consequence."""

import re
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from transform_lab.judging.verdict import Verdict

from ..intake.looks_like import CONFLICT
from ..intake.python_text import binds, defines, may_define_unseen

MEND = "See what that cell says, mend it, and run the notebook from the top (Run > Restart Kernel and Run All Cells)."
MISSING_NAME = re.compile(r"NameError: name '(\w+)' is not defined")
SHORT = 60  # characters of a line that is quoted
LONG = 200  # of an error


@dataclass(frozen=True)
class FailedCell:
    """A cell of the student's that did not run to its end; error: what happened, as the end of a sentence"""

    source: str
    error: str

    def would_bind(self, name):
        """Whether the cell gives the name a meaning, or may do so in a way that its text does not show."""
        mentioned = re.search(rf"\b(?:def|class|import)\b.*\b{name}\b|\b{name}\s*=[^=]", self.source)
        return name in binds(self.source) or mentioned is not None or may_define_unseen(self.source)

    @property
    def words(self):
        """The cell and its error, in words."""
        first = next((line for line in self.source.splitlines() if line.strip()), "").strip().replace("`", "'")
        first = first if len(first) <= SHORT else f"{first[:SHORT]}…"
        return f"the cell that begins with `{first}` {self.error}"


def stopped(source: str, reason: str) -> FailedCell:
    """A cell that the grader had to stop."""
    return FailedCell(source, f"had to be stopped: {_line(reason)}")


def failed(source: str, outputs: Iterable[Mapping]) -> FailedCell:
    """A cell that raised an error; outputs: nbformat's, of a process that is not trusted"""
    error = next((output for output in reversed(list(outputs)) if output["output_type"] == "error"), None)
    if error is None:  # as for a magic that IPython does not know
        texts = [str(output.get("text", "")).strip() for output in outputs if output["output_type"] == "stream"]
        return FailedCell(source, f"stopped with {_line(texts[-1])}" if any(texts) else "stopped")
    name, value = _line(error["ename"]), _line(error["evalue"])
    if name == "Interrupted":
        return stopped(source, "it took too long")
    if any(map(CONFLICT.match, source.split("\n"))):
        value = "a merge has left its conflict marks in it"
    value = re.sub(r" \([^()]*, line (\d+)\)$", r", in its line \1", value)  # of a file that the kernel has made up
    return FailedCell(source, f"stopped with {name}: {value}" if value else f"stopped with {name}")


def explained(verdict: Verdict, cells: Iterable[FailedCell], solution: str = "") -> Verdict:
    """The Verdict, which names the cell to blame where a function, or a name that it uses, is not there because of it.

    cells: those that failed above; solution: the text of the cell in which the function should be
    """
    cells = list(cells)
    undefined = verdict.undefined
    missing = verdict.exercise if undefined else _missing(verdict.error)
    if missing and (cell := _to_blame(missing, cells)):
        what = f"`{missing}` is not there" if not undefined else f"`{missing}` could not be defined"
        return replace(verdict, says=f"{what}, because {cell.words}.", hint=MEND)
    if undefined and (hint := _hint(verdict.exercise, defines(solution), solution)):
        return replace(verdict, hint=hint)
    return verdict


def _hint(name, there, solution):
    """What helps where there is no function of this name, and no cell that failed is to blame."""
    others = [other for other in there if not other.startswith("_") and other != name]
    if name in there:
        magic = re.match(r"\s*(%%\w+)", solution)
        if magic:
            return f"Its cell begins with `{magic[1]}`, which keeps what it defines to itself: take that line out."
        return f"Its cell defines `{name}`, and another cell then removes the name, or gives it to something else."
    if len(others) == 1:
        strange = next((letter for letter in others[0] if not letter.isascii()), "")
        strange = f" (its `{strange}` is {unicodedata.name(strange, 'no letter').lower()})" if strange else ""
        return f"Its cell defines `{others[0]}`{strange}: give the function its own name again, `{name}`."
    return ""


def _missing(error):
    found = MISSING_NAME.match(error)
    return found and found[1]


def _to_blame(name, cells):
    """The cell that would have bound the name; where it stopped for want of another such name, the cell to blame for that."""
    for _ in range(len(cells)):
        cell = next((cell for cell in reversed(cells) if cell.would_bind(name)), None)
        above = cell and re.search(MISSING_NAME, cell.error)
        if not above or above[1] == name or not any(other.would_bind(above[1]) for other in cells):
            return cell
        name = above[1]
    return None


def _line(text):
    text = " ".join(str(text).split()).replace("`", "'")
    return text if len(text) <= LONG else f"{text[:LONG]}…"
