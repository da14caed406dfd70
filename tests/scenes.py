"""The scenes that the notebooks show, without a kernel and without a browser."""

import ast
import copy
import io
from contextlib import redirect_stdout
from functools import cache

import nbformat
import pytest
from support import ROOT
from transform_lab import Viewer

NOTEBOOKS = sorted((ROOT / "source/transforms").glob("*.ipynb"))


@cache
def scenes(path):
    """[(cell id, Viewer)] of all scenes that a solved notebook shows."""
    names, shown, here = {"__name__": "__main__"}, [], None

    def show(viewer):
        taken = copy.copy(viewer)  # a later cell may add to it, or look at it from elsewhere
        vars(taken).update({name: copy.copy(value) for name, value in vars(viewer).items() if isinstance(value, dict)})
        shown.append((here, taken))

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TRANSFORM_LAB_GRADING", "1")
        patch.setattr(Viewer, "show", show)
        patch.setattr(Viewer, "description", lambda viewer: show(viewer) or "")  # by show_mistake
        for cell in nbformat.read(path, as_version=4).cells:
            if cell.cell_type != "code":
                continue
            here, tree = cell.id, ast.parse(cell.source)
            last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
            with redirect_stdout(io.StringIO()):
                exec(compile(tree, here, "exec"), names)
                value = last and eval(compile(ast.Expression(last.value), here, "eval"), names)
            if isinstance(value, Viewer):
                show(value)
    return shown
