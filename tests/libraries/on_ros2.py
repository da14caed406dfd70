"""Runs notebooks' cells and their solutions with the messages of ROS 2, which check their fields where they are told to.

Reads {"code": [expression], "notebooks": {name: [cell]}, "solutions": {exercise: {"cells": [cell], "cases": [[args, kwargs]]}}}.
Writes {"code": [repr, or the error's name], "notebooks": {name: what stopped it, or null}, "solutions": {exercise: [[answer,
whether the arguments are as they were]]}}.
"""

import contextlib
import io
import json
import sys
import traceback

from geometry_msgs import msg as geometry_msgs
from std_msgs import msg as std_msgs
from transform_lab.judging import codec
from transform_lab.messages import fields
from visualization_msgs import msg as visualization_msgs

NAMES = {**vars(std_msgs), **vars(geometry_msgs), **vars(visualization_msgs)}


def of_ros2(value):
    """A decoded argument with ROS 2's messages in the place of ours: numbers as its fields take them."""
    if not hasattr(value, "__dataclass_fields__"):
        return value
    given = {field.name: of_ros2(getattr(value, field.name)) for field in fields(type(value))}
    return NAMES[type(value).__name__](**{name: float(one) if type(one) is int else one for name, one in given.items()})


def evaluated(code):
    try:
        return repr(eval(code, dict(NAMES)))
    except Exception as error:
        return type(error).__name__


def stopped(cells):
    names = {"__name__": "__main__"}
    try:
        for cell in cells:
            exec(compile(cell, "<cell>", "exec"), names)
    except Exception:
        return f"{cell}\n{traceback.format_exc(limit=-3)}"


def answers(name, cells, cases):
    names = {}
    for cell in cells:
        exec(cell, names)
    for args, kwargs in cases:
        given = [
            [of_ros2(codec.decode(arg)) for arg in args], {key: of_ros2(codec.decode(arg)) for key, arg in kwargs.items()},
        ]  # fmt: skip
        before = repr(given)
        yield codec.encode(names[name](*given[0], **given[1])), repr(given) == before


if __name__ == "__main__":
    asked = json.load(sys.stdin)
    with contextlib.redirect_stdout(io.StringIO()):
        found = {
            "code": [evaluated(code) for code in asked["code"]],
            "notebooks": {name: stopped(cells) for name, cells in asked["notebooks"].items()},
            "solutions": {name: list(answers(name, **given)) for name, given in asked["solutions"].items()},
        }
    print(json.dumps(found))
