"""The solved notebooks' code, as it is on a robot, and the verdict on what it answered there."""

import json

import nbformat
from support import ASKED, ROOT, key_of
from transform_lab.judging.verdict import Reply, examine


def cells(notebook):
    """The code cells of a notebook with its solutions."""
    path = ROOT / f"source/transforms/{notebook}.ipynb"
    return [cell for cell in nbformat.read(path, 4).cells if cell.cell_type == "code"]


def solutions(on_the_robot):
    """{exercise: the "cells" that solve it, and its public "cases"}; on_the_robot: from a cell's code to what it is there."""
    found = {}
    for notebook in ASKED:
        first, *others = cells(notebook)
        for cell in others:
            name, _, kind = cell.metadata.get("nbgrader", {}).get("grade_id", "").partition("-")
            if kind == "solution":
                cases = [[case["args"], case["kwargs"]] for case in key_of(name)["cases"]]
                found[name] = {"cells": [on_the_robot(first.source), on_the_robot(cell.source)], "cases": cases}
    return found


def judged_there(name, answers):
    """The Verdict of our judge on a solution; answers: [(answer, arguments afterwards)] to the public cases, as plain data."""
    key = key_of(name)
    replies = {
        json.dumps([case["args"], case["kwargs"]]): Reply("returned", answer, after)
        for case, (answer, after) in zip(key["cases"], answers, strict=True)
    }
    return examine(name, key, lambda args, kwargs: replies[json.dumps([args, kwargs])])
