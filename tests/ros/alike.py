"""Compares what came of the robot with what came of us: numbers to rounding, all else exactly."""

import math
import re

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+\.?\d*(?:e[-+]?\d+)?(?!\w)")


def differences(there, here, where=""):
    """Yield a line for each difference of two values made of dictionaries, lists, texts and numbers."""
    if isinstance(there, dict) and isinstance(here, dict) and there.keys() == here.keys():
        for name in there:
            yield from differences(there[name], here[name], f"{where}.{name}")
    elif isinstance(there, (list, tuple)) and isinstance(here, (list, tuple)) and len(there) == len(here):
        for i, pair in enumerate(zip(there, here)):
            yield from differences(*pair, f"{where}[{i}]")
    elif isinstance(there, str) and isinstance(here, str):
        if _words(there) != _words(here) or not all(map(_close, _numbers(there), _numbers(here))):
            yield f"{where}: {there!r} there, {here!r} here"
    elif isinstance(there, (int, float)) and isinstance(here, (int, float)):
        if not _close(there, here):
            yield f"{where}: {there} there, {here} here"
    elif there is not None or here is not None:
        yield f"{where}: {there!r} there, {here!r} here"


def _close(one, other):
    """Whether two numbers differ by rounding alone: by that of NumPy's eight digits, in a text."""
    return math.isclose(one, other, rel_tol=1e-7, abs_tol=1e-8)


def _words(text):
    """A text without its numbers; columns are wider where one of NumPy's zeros has a minus."""
    return " ".join(NUMBER.sub("#", text).split()).replace("[ ", "[")


def _numbers(text):
    return [float(number) for number in NUMBER.findall(text)]
