"""How much of what students wrote and displayed a page holds: what it takes to make one is in proportion to that."""

import html
import re

import nbformat
from nbconvert.preprocessors import Preprocessor
from nbformat import NotebookNode
from nbgrader.utils import is_grade
from traitlets import Int

from .markdown import is_short

TAKES = {"code": 5, "markdown": 2}  # bytes of the page for each byte of a cell's source: colours, formulas
CELL, OUTPUT = 600, 300  # bytes of the page around what is in one
LEFT_OUT = "[not shown here, or this page would be too large; it is in the notebook that was handed in]"
BARE = (
    "*What was written and displayed is not shown here, because no page could be made of it; it is in the notebook that "
    "was handed in. Points and verdicts are as they are.*"
)
NOTE = nbformat.v4.new_output("stream", text=LEFT_OUT)
TURNING = re.compile("[\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")  # what sets words in another order
MARKS = "\u0300-\u036f\u0483-\u0489\u1ab0-\u1aff\u1dc0-\u1dff\u20d0-\u20f0\ufe20-\ufe2f"
STACKED = re.compile(f"([{MARKS}]{{2}})[{MARKS}]+")  # what is drawn over the lines above and below


class Bounded(Preprocessor):
    """The step before nbconvert's templates, in the formgrader: `shortened`."""

    budget = Int(150_000, help="Bytes of what a student wrote and displayed that a page holds.").tag(config=True)

    def preprocess(self, nb, resources):
        return shortened(nb, self.budget), resources


def is_test(cell):
    """Whether the outputs of a cell are what the grader says."""
    return cell.cell_type == "code" and is_grade(cell)


def shortened(nb, budget):
    """A copy of the notebook in which what a student wrote and displayed takes about `budget` bytes of the page.

    All that still fits is kept: first of the cells that are asked for, and then of the others, from the top. The verdicts
    are kept, but for characters of a student's in them that would set the grader's words in another order, or hide them.
    """
    nb, left = NotebookNode({**nb, "metadata": NotebookNode(nb.metadata), "cells": list(map(_own, nb.cells))}), budget

    def fits(text, weight=1, around=0):
        nonlocal left
        size = weight * len(html.escape(text).encode("utf-8", "replace")) + around
        if size > left:
            return False
        left -= size
        return True

    for cell in sorted(nb.cells, key=lambda cell: "nbgrader" not in cell.metadata):
        asked = "nbgrader" in cell.metadata
        if not fits(cell.source, TAKES.get(cell.cell_type, 1), 0 if asked else CELL):
            cell.source = LEFT_OUT
            cell.metadata.left_out = not asked
        attachments = cell.get("attachments", {})
        cell.attachments = {name: data for name, data in attachments.items() if fits("".join(map(str, data.values())))}
        if cell.cell_type != "code":
            continue
        if is_test(cell):
            cell.outputs = [_in_order(output) for output in cell.outputs]
        else:
            shown = [output for output in cell.outputs if fits(_text(output), around=OUTPUT)]
            cell.outputs = shown if len(shown) == len(cell.outputs) else [*shown, NOTE]
        if cell.source.lstrip().startswith("%%") or not is_short(cell.source):
            cell.metadata.magics_language = "text"  # for nbconvert: no lexer of another language, nor for endless lines
    gone = [cell for cell in nb.cells if cell.metadata.pop("left_out", False)]
    dropped = {id(cell) for cell in gone[1:]}  # one stands for them all, or thousands would fill the page
    nb.cells = [cell for cell in nb.cells if id(cell) not in dropped]
    for cell in gone[:1]:
        cell.outputs = []
    return nb


def bared(nb):
    """A copy of the notebook with the grader's own cells and verdicts, and a sentence in place of what is the student's."""
    cells = [nbformat.v4.new_markdown_cell(BARE)]
    for cell in nbformat.from_dict(nb.cells):
        if "nbgrader" in cell.metadata:
            if not is_test(cell):
                cell.source, cell.attachments, cell.outputs = "", {}, []
            cells.append(cell)
    return nbformat.from_dict({**nb, "cells": cells})


def _text(output):
    """All that an output shows, as one text."""
    parts = [output.get("text", ""), *output.get("traceback", ()), *output.get("data", {}).values()]
    return "".join(map(str, parts))


def _own(cell):
    """A copy of a cell, and of what a step towards the page may change in it: what it says of it."""
    metadata = NotebookNode(cell.metadata)
    if metadata.get("nbgrader"):
        metadata.nbgrader = NotebookNode(metadata.nbgrader)
    return NotebookNode({**cell, "metadata": metadata})


def _in_order(output):
    """A copy of an output of the grader's, in which a student's error message may stand."""
    if "data" not in output:
        return output
    data = NotebookNode(output.data)
    for mime in [mime for mime, text in data.items() if mime.startswith("text/") and isinstance(text, str)]:
        data[mime] = STACKED.sub(r"\1", TURNING.sub("", data[mime]))
    return NotebookNode({**output, "data": data})
