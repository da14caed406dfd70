"""A file that a student handed in, made into a notebook of the released shape.

Whatever the file holds, the result is a valid notebook with each of the released graded cells exactly once, with its
points, its flags and (where it is locked) its text as released. What had to be mended is said in words.
"""

import copy
import json
import re
from dataclasses import dataclass, field

import nbformat

from ..untrusted import printable

LARGEST = 20_000_000  # bytes of one notebook file; the released ones are below 100 kB, pictures included
MOST_CELLS = 2_000
CELL_FIELDS = {"cell_type", "id", "metadata", "source", "attachments", "outputs", "execution_count"}


@dataclass
class Intake:
    """notebook: ready to run; statuses: {exercise: "missing" or "unreadable"} for what cannot be graded."""

    notebook: nbformat.NotebookNode
    statuses: dict = field(default_factory=dict)
    problems: list = field(default_factory=list)

    def say(self, released, problem):
        self.problems.append(f"{released.name}.ipynb: {problem}.")


def restore(content, released):
    """The Intake of `content` (bytes of a submitted file), measured against the Released notebook of that name."""
    try:
        notebook = _parse(content)
    except Unreadable as unreadable:
        intake = Intake(copy.deepcopy(released.notebook), dict.fromkeys(released.points, "unreadable"))
        intake.say(released, f"it cannot be read: {unreadable}; it has to be handed in again")
        intake.notebook.cells.insert(0, _note(released, f"**This notebook could not be read:** {unreadable}."))
        return intake
    intake = Intake(notebook)
    notebook.metadata = copy.deepcopy(released.notebook.metadata)
    kept = _keep_one_of_each(intake, released)
    for grade_id, (cell, claimed) in kept.items():
        _restore_cell(intake, released, grade_id, cell, claimed)
    for grade_id, original in released.cells.items():
        if grade_id not in kept:
            _add_missing(intake, released, grade_id, original)
    _unique_cell_ids(notebook)
    return intake


class Unreadable(Exception):
    """The file holds no notebook; the message says why."""


def _parse(content):
    if len(content) > LARGEST:
        raise Unreadable(f"it has {len(content) / 1e6:.0f} MB; at most {LARGEST / 1e6:.0f} MB are accepted")
    try:
        raw = json.loads(content.decode("utf-8-sig"))
    except (UnicodeDecodeError, RecursionError, ValueError) as error:
        raise Unreadable(f"it is not JSON ({_short(error)})") from error
    _bounded(raw.get("cells") if isinstance(raw, dict) else None)  # before time is spent on each of them
    try:
        text = printable(json.dumps(_known_fields(raw), ensure_ascii=False))
        notebook = nbformat.convert(nbformat.reader.reads(text), 4)
        for cell in notebook.cells:
            if cell.cell_type == "code":
                cell.outputs, cell.execution_count = [], None
            elif cell.cell_type == "raw":
                cell.cell_type = "markdown"  # pages show raw cells unfiltered
        notebook.nbformat, notebook.nbformat_minor = 4, 5
        _unique_cell_ids(notebook)
        nbformat.validate(notebook)
    except Exception as error:  # nbformat raises what it happens to meet in a file of another shape
        raise Unreadable(f"it is not a Jupyter notebook ({_short(error)})") from error
    _bounded(notebook.cells)
    return notebook


def _bounded(cells):
    if isinstance(cells, list) and len(cells) > MOST_CELLS:
        raise Unreadable(f"it has {len(cells)} cells; at most {MOST_CELLS} are accepted")


def _known_fields(raw):
    """The notebook's JSON without what editors add to cells beyond the format; that must not cost the notebook."""
    if isinstance(raw, dict) and raw.get("nbformat") == 4 and isinstance(raw.get("cells"), list):
        for cell in filter(lambda cell: isinstance(cell, dict), raw["cells"]):
            for field in cell.keys() - CELL_FIELDS:
                del cell[field]
            if not isinstance(cell.get("metadata"), dict):
                cell["metadata"] = {}
    return raw


def _short(error):
    return " ".join(str(error).split())[:120]


def _keep_one_of_each(intake, released):
    """{grade_id: (cell, what the file says about it)}; of duplicates the last one counts, as in nbgrader.

    All other metadata goes: tags and hidden inputs change how a cell is run or shown. A test cell is known by its text,
    too: some editors drop the metadata.
    """
    by_source = {
        cell.source.strip(): grade_id for grade_id, cell in released.cells.items() if grade_id in released.points
    }
    found, known_by_text = {}, {}
    for cell in intake.notebook.cells:
        claimed = cell.metadata.get("nbgrader")
        cell.metadata = nbformat.NotebookNode()
        grade_id = claimed.get("grade_id") if isinstance(claimed, dict) else None
        if isinstance(grade_id, str) and grade_id in released.cells:
            found.setdefault(grade_id, []).append((cell, claimed))
        elif cell.cell_type == "code" and cell.source.strip() in by_source:
            known_by_text[by_source[cell.source.strip()]] = cell
    for grade_id, cell in known_by_text.items():
        if grade_id not in found:
            found[grade_id] = [(cell, {})]
            intake.say(
                released, f"the test cell of {grade_id} had lost its nbgrader data; it was recognised by its text"
            )
    for grade_id, cells in found.items():
        if len(cells) > 1:
            intake.say(released, f"the cell {grade_id} is there {len(cells)} times; the last one was graded")
    return {grade_id: cells[-1] for grade_id, cells in found.items()}


def _restore_cell(intake, released, grade_id, cell, claimed):
    original = released.cells[grade_id]
    if cell.cell_type != original.cell_type:
        source, identifier = cell.source, cell.id
        cell.clear()
        cell.update(copy.deepcopy(original), source=source, id=identifier)
        intake.say(released, f"the cell {grade_id} had another type; it was set back")
    for flag in ("points", "grade", "solution", "locked"):
        right = original.metadata.nbgrader.get(flag)
        if flag in claimed and claimed[flag] != right and not (flag == "points" and _was_worth(original, claimed)):
            intake.say(released, f"the cell {grade_id} said {flag} {claimed[flag]!r:.40}; it was set back to {right!r}")
    cell.metadata = copy.deepcopy(original.metadata)
    if original.metadata.nbgrader.locked and cell.source != original.source:
        cell.source = original.source
        intake.say(released, f"the locked cell {grade_id} had been changed; its text was set back")


def _was_worth(original, claimed):
    """Whether an earlier release gave the cell the points that the file claims: nbgrader's checksum counts them in."""
    from nbgrader import utils  # here, because it takes longer than to check one student's files

    earlier = copy.deepcopy(original)
    earlier.metadata.nbgrader.points = claimed["points"]
    try:
        return claimed.get("checksum") == utils.compute_checksum(earlier)
    except (TypeError, ValueError):  # no number
        return False


def _add_missing(intake, released, grade_id, original):
    nbgrader = original.metadata.nbgrader
    if not (nbgrader.grade or nbgrader.solution):
        return
    intake.notebook.cells.append(copy.deepcopy(original))
    if grade_id in released.points:
        intake.statuses[grade_id] = "missing"
        intake.say(
            released, f"the test cell of {grade_id} is missing: 0 points; it has to be in the file, as it was given out"
        )
    else:
        intake.say(released, f"the cell {grade_id} is missing, or has lost its nbgrader data; an empty one was added")


def _note(released, text):
    return nbformat.v4.new_markdown_cell(text, id=f"note-{released.digest[:8]}")


def _valid_id(identifier):
    return isinstance(identifier, str) and re.fullmatch(r"[a-zA-Z0-9_-]{1,64}", identifier) is not None


def _unique_cell_ids(notebook):
    seen = set()
    for position, cell in enumerate(notebook.cells):
        if not _valid_id(cell.get("id")) or cell["id"] in seen:
            cell["id"] = f"cell-{position}"
            while cell["id"] in seen:
                cell["id"] += "x"
        seen.add(cell["id"])
