"""Calls functions of ROS's tf.transformations: reads [[function, arguments], …], writes what each gives, or its error's name."""

import json
import sys

import numpy as np
from tf import transformations

np.seterr(all="ignore")  # ROS divides by zero where it has to be told so


def plain(value):
    if isinstance(value, (tuple, list, np.ndarray)):
        return [plain(item) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def given(argument):
    """JSON has no tuples."""
    return tuple(argument["tuple"]) if isinstance(argument, dict) else argument


def answer(name, arguments):
    try:
        return {"gives": plain(getattr(transformations, name)(*map(given, arguments)))}
    except Exception as error:
        return {"raises": type(error).__name__}


print(json.dumps([answer(name, arguments) for name, arguments in json.load(sys.stdin)]))
