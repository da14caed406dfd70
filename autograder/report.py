"""The class report: verdicts.csv, and a page that says what the class understands and what it does not.

Everything is read back from the autograded notebooks, so it is the same however they were graded.
"""

import csv
import io
from collections import Counter
from dataclasses import astuple, fields
from datetime import UTC, datetime

import jinja2
from transform_lab.diagnosis import GENERAL

from .course import ASSIGNMENT, replace
from .exercises import EXERCISES
from .grading import missing, recorded
from .judge import Row

COLUMNS = ("student", *(field.name for field in fields(Row)))


def verdicts(course, students):
    """{student: [Row for each exercise]}, and {student: [what was odd, in words]}."""
    found, problems = {}, {}
    for student in students:
        records = recorded(course, student)
        found[student] = [
            row
            for name, released in course.notebooks.items()
            for row in (records[name]["rows"] if name in records else missing(released))
        ]
        problems[student] = list(
            dict.fromkeys(problem for record in records.values() for problem in record["problems"])
        )
    return found, problems


def write(course, students):
    """Write reports/transforms/verdicts.csv and index.html; returns {student: [Row]} they were made from."""
    found, problems = verdicts(course, students)
    course.reports.mkdir(parents=True, exist_ok=True)
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows((student, *astuple(row)) for student, rows in found.items() for row in rows)
    replace(course.reports / "verdicts.csv", table.getvalue())
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("autograder"), autoescape=True, trim_blocks=True, lstrip_blocks=True
    )
    page = environment.get_template("report.html").render(
        assignment=ASSIGNMENT,
        made=datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        students={student: _total(rows) for student, rows in found.items()},
        exercises=summary(found),
        misunderstood=misunderstood(found),
        look=look(found, problems),
    )
    replace(course.reports / "index.html", page)
    return found


def summary(found):
    """For each exercise: (notebook, name, how many have all points, how many students, average share of the points)."""
    lines = []
    for column in zip(*found.values()):
        shares = [row.score / row.max_score if row.max_score else 1.0 for row in column]
        full = sum(share == 1 for share in shares)
        lines.append((column[0].notebook, column[0].exercise, full, len(column), sum(shares) / len(shares)))
    return lines


def misunderstood(found):
    """Misconceptions, the most frequent first: (id, exercise, how many students, what the answer shows, the hint)."""
    rows = [row for rows in found.values() for row in rows if row.misconception]
    times = Counter((identifier, row.exercise) for row in rows for identifier in row.misconception.split(";"))
    lines = []
    for (identifier, exercise), count in times.most_common():
        sentences = {m.id: (m.says, m.hint) for m in EXERCISES[exercise].misconceptions}
        lines.append((identifier, exercise, count, *(GENERAL | sentences).get(identifier, ("", ""))))
    return lines


def look(found, problems):
    """Who needs a look: {student: [reasons in words]}."""
    words = {
        "timeout": "did not finish in time",
        "killed": "had to be stopped: it used too much",
        "unreadable": "is in a file that could not be read",
        "missing": "is missing from what was handed in",
    }
    reasons = {}
    for student, rows in found.items():
        said = [f"{row.exercise} {words[row.status]}" for row in rows if row.status in words]
        if said or problems.get(student):
            reasons[student] = [*problems.get(student, ()), *said]
    return reasons


def _total(rows):
    return sum(row.score for row in rows), sum(row.max_score for row in rows)
