"""What an autograded notebook records of its grading: reports and feedback are made from it, and it tells what is unchanged.

Of each verdict it keeps what may be told: no number of a hidden case. Pages word it anew, so that a panel's words, and what
a misconception says and hints, reach those who were graded before; of each mistake the record knows which misconception
it is, and what was said of it then.
"""

import json
from datetime import datetime
from itertools import zip_longest

from transform_lab.judging.verdict import Verdict

from ..course import Course
from ..exercises import EXERCISES
from ..released import Released
from .judge import Row

RECORD = "transform_lab"  # the entry of an autograded notebook's metadata that holds its verdicts
ALONE = "submission.json"  # beside where the notebooks would be: the record of a submission that has none


def recorded(course: Course, student: str) -> dict[str, dict]:
    """{notebook: record} of what is already graded; a damaged or outdated record counts as not graded."""
    found = {}
    for name, released in course.notebooks.items():
        try:
            text = (course.autograded(student) / f"{name}.ipynb").read_text(encoding="utf-8")
            record = json.loads(text)["metadata"][RECORD]
            record["rows"] = [Row(**row) for row in record["rows"]]
            datetime.fromisoformat(record["graded"])
            if [row.exercise for row in record["rows"]] == list(released.points) and {
                "seed",
                "problems",
            } <= record.keys():
                found[name] = record
        except (OSError, ValueError, KeyError, TypeError):
            continue
    return found


def recorded_alone(course: Course, student: str) -> dict | None:
    """The record of a submission without any notebook: its "problems", and as in those of notebooks when it was graded."""
    try:
        record = json.loads((course.autograded(student) / ALONE).read_text(encoding="utf-8"))
        datetime.fromisoformat(record["graded"])
        record["problems"] = [str(problem) for problem in record["problems"]]
        return record
    except (OSError, ValueError, KeyError, TypeError):
        return None


def told(verdict):
    """A Verdict as its record keeps it."""
    return {
        "credit": verdict.credit,
        "done": verdict.done,
        "misconceptions": list(verdict.misconceptions),
        "mistakes": [[*pair, _source(verdict, pair)] for pair in _lines(verdict)],
        "parts": list(verdict.parts.items()),  # as a list, in this order: nbformat sorts the fields
        "cases": verdict.cases,
        "family": verdict.failing and verdict.failing["family"],
    }


def verdicts(record):
    """{exercise: Verdict} of a record, in today's words; without what is damaged, or older than such records."""
    found, everything = {}, record.get("verdicts")
    for name, kept in everything.items() if isinstance(everything, dict) else ():
        try:
            says, hints = zip(*(_words(name, *mistake) for mistake in kept["mistakes"]))
            found[name] = Verdict(
                name,
                credit=float(kept["credit"]),
                done=bool(kept["done"]),
                misconceptions=tuple(map(str, kept["misconceptions"])),
                says="\n".join(says),
                hint="\n".join(hints),
                parts={str(part): int(times) for part, times in kept["parts"]},
                cases=int(kept["cases"]),
                failing=kept["family"] and {"family": str(kept["family"])},
            )
        except (LookupError, TypeError, ValueError):
            continue
    return found


def _lines(found):
    """[(says, hint) of each mistake] of a Verdict, or of a misconception that consists of several"""
    return list(zip_longest(found.says.split("\n"), found.hint.split("\n"), fillvalue=""))


def _source(verdict, pair):
    """[id of the exercise's misconception whose words these are, its position, the line of its words], or None."""
    found = [
        (len(misconception.id), [misconception.id, position, _lines(misconception).index(pair)])
        for position, misconception in enumerate(EXERCISES[verdict.exercise].misconceptions)
        if set(misconception.id.split(";")) <= set(verdict.misconceptions) and pair in _lines(misconception)
    ]
    return max(found)[1] if found else None  # one of two mistakes at once rather than one of a single one


def _words(name, says, hint, source):
    """(says, hint) of a mistake as they are today; those that were recorded where there are no others."""
    if source and name in EXERCISES:
        identifier, position, line = source
        known = EXERCISES[name].misconceptions[position : position + 1]
        if known and known[0].id == identifier and line < len(_lines(known[0])):
            return _lines(known[0])[line]
    return str(says), str(hint)


def missing(released: Released) -> list[Row]:
    """The Rows of a notebook that was not handed in."""
    return [Row(released.name, name, 0.0, points, "missing") for name, points in released.points.items()]
