"""A mistake with numbers: where the hidden cases show that a function is wrong, a public case that shows it, too.

Feedback may not tell a hidden case's numbers, or the next student has them. The public cases are in every student's notebook, so
one of them, with the student's own answer to it, may be shown as `check` shows it: in numbers and as a scene.
"""

import json
import time

from transform_lab.judging.status import STATUSES, STOPPED
from transform_lab.judging.verdict import compare

from ..untrusted import printable

MOST_CALLS = 8  # of a function that is known to be wrong
MOST_SECONDS = 1.0  # of such calls; the notebook's time is for its exercises


def public_cases(key):
    """What `find` takes, {exercise: plain data}, of a key.json (text): its cases without the answers of misconceptions."""
    return {
        name: {
            **exercise,
            "misconceptions": [],
            "cases": [
                {field: value for field, value in case.items() if field != "wrong"} for case in exercise["cases"]
            ],
        }
        for name, exercise in json.loads(key)["exercises"].items()
    }


def find(verdict, exercise, call):
    """A public case that the function answers wrongly, as JSON text for the notebook's record; None without any.

    verdict: on the hidden cases; those of the failing family are tried first
    exercise: plain data, of public_cases
    call: (args, kwargs) -> Reply of the student's function; its replies are untrusted
    """
    if verdict.failing is None or STATUSES[verdict.status].look == STOPPED:
        return None
    family, latest = verdict.failing["family"], time.monotonic() + MOST_SECONDS
    for case in sorted(exercise["cases"], key=lambda case: case["family"] != family)[:MOST_CALLS]:
        reply = call(case["args"], case["kwargs"])
        if reply.outcome not in ("returned", "raised") or time.monotonic() > latest:
            return None
        if not compare(exercise["returns"], case, reply).answered:
            alone = {**exercise, "cases": [case], "weights": {case["family"]: 1}}
            return _kept({"exercise": alone, "outcome": reply.outcome, "value": reply.value, "error": reply.error})
    return None


def _kept(example):
    """The example as text (nbformat would sort the fields); None when the student's process sent what no file can hold."""
    try:
        return printable(json.dumps(example, ensure_ascii=False, allow_nan=False))
    except ValueError:
        return None
