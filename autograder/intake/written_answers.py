"""Answers to the questions that a person grades: whatever was written for one, wherever, that person is to see.

nbgrader gives 0 points to an answer that stands there as released. So where anything was written for it, or the grader had to
add its cell, its text is another one.
"""

import ast
import re
from difflib import SequenceMatcher

from .python_text import parsed
from .reading import Cell
from .restoration import Restoration, plain

ADDED = "*(This cell was not in the file that was handed in. The grader has added it.)*"
EMPTY = "*(This cell was left as it was given out. What may be meant as the answer was written elsewhere in this notebook:)*"
NAMES_ITSELF = re.compile(r"\b(answer|question|antwort|frage|réponse|respuesta|risposta)\b", re.IGNORECASE)
QUOTED = 3_000  # characters of what is written elsewhere


def place_answers(work: Restoration) -> None:
    """Have one cell for each question, whose text is as released only where nothing was written for it."""
    for name in work.answers:
        answer = work.one_of(name)
        if answer is not None and not work.is_given(answer, name):
            work.set_kind(answer, name)
            _show_pictures(answer)
            continue
        start, end = _region(work, name)
        own = [cell for cell in work.cells if cell not in work.name and _added(work, cell)]
        beside = [cell for cell in own if cell in work.cells[start:end]]
        if len(beside) == 1 and beside[0].kind == "markdown":
            if answer is not None:
                work.cells.remove(answer)
                del work.name[answer]
            work.name[beside[0]] = name
            _show_pictures(beside[0])
            if work.entries:
                work.said.append(f"the answer to {name} was found in another cell; a person reads it there")
            continue
        behind = [cell for cell in own if work.cells.index(cell) >= end and _is_text(cell)]
        about = [cell for cell in work.cells if cell is not answer and _is_about(work, cell, name)]
        elsewhere = [cell for cell in work.cells if cell in {*beside, *behind, *about}]
        if answer is None:
            answer = Cell("markdown", ADDED)
            work.cells.insert(end, answer)
            work.name[answer] = name
            work.said.append(
                f"the cell {name} is missing, or has lost its nbgrader data; a person looks whether it was answered"
            )
        elif elsewhere:
            work.said.append(
                f"the answer to {name} may stand elsewhere in the notebook; a person looks whether it does"
            )
        if elsewhere:
            words = "\n\n".join(_added(work, cell) for cell in elsewhere)[:QUOTED]
            answer.source = EMPTY + "\n\n" + "\n".join(f"> {line}".rstrip() for line in words.split("\n"))
            for cell in elsewhere:
                answer.attachments |= cell.attachments


def _show_pictures(answer):
    """Pictures that are attached to a cell and named nowhere in it would not be seen."""
    for name in answer.attachments:
        if f"attachment:{name}" not in answer.source:
            answer.source += f"\n\n![{name}](<attachment:{name}>)"


def _region(work, name):
    """(start, end) of the cells that stand where the question stood when it was given out: between its neighbours."""
    ours = [
        cell.metadata.get("nbgrader", {}).get("grade_id") or plain(cell.source) for cell in work.released.notebook.cells
    ]
    theirs = [work.name.get(cell) or plain(cell.source) for cell in work.cells]
    question = ours.index(name)
    start, end = 0, len(theirs)
    for block in SequenceMatcher(None, ours, theirs, autojunk=False).get_matching_blocks():
        for a, b in zip(range(block.a, block.a + block.size), range(block.b, block.b + block.size)):
            if a < question:
                start = b + 1
            elif a > question:
                return start, max(start, b)
    return start, end


def _added(work, cell):
    """The lines of a cell that were not given out, and the pictures in it, as text; "" where there are none."""
    lines = [line for line in cell.source.split("\n") if line.strip() and line.strip() not in work.given_lines]
    return "\n".join([*lines, *(f"![{name}](<attachment:{name}>)" for name in cell.attachments)])


def _is_text(cell):
    """Whether a cell holds words: a text cell, or code of comments and strings alone."""
    if cell.kind == "markdown":
        return True
    tree = parsed(cell.source)
    lines = [line for line in tree.body if not isinstance(line, (ast.Import, ast.ImportFrom))] if tree else []
    words = lines or ("#" in cell.source and tree)
    return bool(words) and all(isinstance(line, ast.Expr) and _has_words(line) for line in lines)


def _has_words(line):
    texts = (part.value for part in ast.walk(line) if isinstance(part, ast.Constant))
    return any(isinstance(text, str) and text.count(" ") > 2 for text in texts)


def _is_about(work, cell, name):
    """Whether what the student has added to a cell calls itself an answer, or says the question's own heading."""
    added = _added(work, cell)
    if cell.kind == "code":
        added = "\n".join(re.findall(r"#.*|\"\"\".*?\"\"\"|'''.*?'''", added, re.DOTALL))
    heading = work.released.section(name).partition(": ")[2].partition("(")[0].strip(" ?").lower()
    return bool(NAMES_ITSELF.search(added)) or (len(heading) > 8 and heading in added.lower())
