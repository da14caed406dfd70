"""What an autograded notebook records of its grading: reports and feedback are made from it, and it tells what is unchanged."""

import json
from datetime import datetime

from .judge import Row

RECORD = "transform_lab"  # the entry of an autograded notebook's metadata that holds its verdicts


def recorded(course, student):
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


def missing(released):
    """The Rows of a notebook that was not handed in."""
    return [Row(released.name, name, 0.0, points, "missing") for name, points in released.points.items()]
