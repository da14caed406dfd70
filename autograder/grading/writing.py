"""A graded notebook as text. It is nbformat's text, of which each cell is kept: most cells of a class are the same."""

import json
from functools import lru_cache

import nbformat

MOST_KEPT = 20_000  # characters of a cell; pictures differ from student to student
START, END = '{\n "cells": [\n', '\n ],\n "metadata": {},\n "nbformat": 4,\n "nbformat_minor": 5\n}'


def text_of(notebook: nbformat.NotebookNode) -> str:
    """What nbformat writes of a notebook of format 4.5."""
    around = nbformat.v4.writes(nbformat.NotebookNode({**notebook, "cells": []}))
    cells = ",\n".join(_cell(json.dumps(cell, ensure_ascii=False)) for cell in notebook.cells)
    return around.replace('"cells": []', f'"cells": [\n{cells}\n ]', 1) if cells else around


def _cell(cell):
    """The lines of a cell (JSON)."""
    return _kept(cell) if len(cell) <= MOST_KEPT else _written(cell)


def _written(cell):
    notebook = {"cells": [json.loads(cell)], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}
    return nbformat.v4.writes(nbformat.from_dict(notebook)).removeprefix(START).removesuffix(END)


_kept = lru_cache(maxsize=1_000)(_written)
