"""The class report: a page for the instructor, and the tables behind it.

Everything is read back from the autograded notebooks and the gradebook, so it is the same however they were graded.
"""

import csv
import os
from collections import Counter, defaultdict
from dataclasses import fields
from datetime import datetime
from operator import attrgetter
from urllib.parse import quote

from markupsafe import Markup

from ..bridge.gradebook import BY_HAND
from ..course import ASSIGNMENT, CourseError
from ..files import replace
from ..grading.judge import Row
from ..grading.records import missing
from ..names import table
from ..untrusted import printable
from . import examples
from . import report_data as findings
from .bounded import TURNING
from .rendering import environment

COLUMNS = ("student", *(field.name for field in fields(Row)))
MOST_PICTURES = 10
SHARED = 2  # students that make a misconception one of the class's, with a picture
FORMGRADER = f"http://localhost:8888/formgrader/gradebook/{ASSIGNMENT}/"


def write(course, writer, compare=None):
    """Write index.html, verdicts.csv and grades.csv into reports/transforms/; {student: Work} they were made from.

    compare: the path of another class's verdicts.csv, or of a folder that has one; raises CourseError when it cannot be read
    Shown are the students whose work is there and in the gradebook, which the gradebook.Writer knows.
    """
    handed_in, known = course.students(), writer.students()
    works = {student: _work(course, student) for student in handed_in if student in known}
    grades = writer.grades()
    for student, work in works.items():
        work.take(grades[student])
    runs = findings.runs(works)
    course.reports.mkdir(parents=True, exist_ok=True)
    _write_verdicts(course, works, runs[0].graded.timestamp() if runs else None)
    writer.export(course.reports / "grades.csv", grades)
    since, before = _before(course)
    shared, rare = _misunderstood(course, works)
    waiting = [
        (student, notebook, cell)
        for student in works
        for notebook, found in grades[student].items()
        for cell, points in found.cells.items()
        if points.waiting
    ]
    other = _verdicts_of(compare) if compare else None
    page = _template(course).render(
        assignment=ASSIGNMENT,
        works=works,
        runs=runs,
        shared=shared,
        rare=rare,
        distribution=findings.distribution(works),
        results=findings.results(works),
        look=findings.look(works),
        ungraded=sorted(set(handed_in) - known),
        absent=sorted({student.id for student in writer.gradebook.students} - known - set(handed_in)),
        questions=_questions(course, waiting),
        waiting=Counter(student for student, _, _ in waiting),
        formgrader=FORMGRADER,
        since=since,
        changes=findings.changes(before, works) if before else None,
        together=findings.together(works),
        fewest=findings.FEWEST,
        slow=findings.slow(works),
        compare=compare,
        compared=_compared(compare, other, works) if compare else None,
        by_hand={student: _by_hand(course, grades[student]) for student in works},
    )
    replace(course.reports / "index.html", TURNING.sub("", printable(page)))
    return works


def _work(course, student):
    """The Work of a student; of one whose record somebody has damaged, that it is so: the others' report is not to be lost."""
    try:
        work = findings.work(course, student)
        float(work.points), float(work.most)
        return work
    except Exception as error:
        rows = [row for released in course.notebooks.values() for row in missing(released)]
        damaged = f"What is recorded of the grading cannot be read ({type(error).__name__}); grade again with --force."
        return findings.Work(rows=rows, problems=[damaged])


# --- the tables -----------------------------------------------------------------------------------------------------


def _write_verdicts(course, works, graded):
    """Write verdicts.csv, where a last column tells of points by hand; the one of an earlier grading is kept as before.csv.

    graded: when the last of these notebooks was graded, in seconds; the file gets this as its date. So a report that is
    made again from the same grading is compared with the same file as the first time.
    """
    path = course.reports / "verdicts.csv"
    if graded and path.exists() and path.stat().st_mtime < graded:
        path.replace(course.reports / "before.csv")
    values, some = attrgetter(*COLUMNS[1:]), any(work.by_hand for work in works.values())
    rows = [
        (student, *values(row), *(["yes" if row.exercise in work.by_hand else ""] if some else []))
        for student, work in works.items()
        for row in work.rows
    ]
    replace(path, table([[*COLUMNS, *([BY_HAND] if some else [])], *rows]))
    if graded:
        os.utime(path, (graded, graded))


def _before(course):
    """(when the grading behind before.csv was, {student: {exercise: points}}); (None, {}) when there was none.

    A file that somebody has damaged has nothing to compare with, either: (its date, {}).
    """
    path, scores = course.reports / "before.csv", defaultdict(dict)
    if not path.exists():
        return None, {}
    since = datetime.fromtimestamp(path.stat().st_mtime).astimezone()
    try:
        with open(path, newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                scores[row["student"]][row["exercise"]] = float(row["score"])
    except (ValueError, KeyError, TypeError, csv.Error):
        return since, {}
    return (since, dict(scores)) if scores else (None, {})


def _verdicts_of(path):
    """The rows of a verdicts.csv as dictionaries: the file itself, or that of a course, of a term's archive, or of reports/."""
    places = [path, *(path / below / "verdicts.csv" for below in ("", ASSIGNMENT, f"reports/{ASSIGNMENT}"))]
    for place in places:
        if place.is_file():
            try:
                with open(place, newline="", encoding="utf-8") as file:
                    return list(csv.DictReader(file))
            except (UnicodeDecodeError, csv.Error) as error:
                raise CourseError(f"{place}: this is no verdicts.csv ({error}).") from None
    raise CourseError(
        f"{path}: there is no verdicts.csv to compare with. Name the file, or a term's folder in archive/."
    )


def _compared(path, rows, works):
    try:
        return findings.compared(rows, works)
    except (LookupError, ValueError, TypeError, AttributeError):
        raise CourseError(
            f"{path}: this is no verdicts.csv: a row lacks a student, an exercise, or its points."
        ) from None


# --- the page -------------------------------------------------------------------------------------------------------


def _template(course):
    notebooks = {name: notebook for notebook, released in course.notebooks.items() for name in released.points}
    pages = {"feedback": lambda student, exercise: _feedback(course, student, notebooks[exercise])}
    return environment().get_template("report.html", globals=pages)


def _feedback(course, student, notebook):
    """The address of a student's feedback page as seen from the report; "" when there is none."""
    page = course.feedback(student) / f"{notebook}.html"
    return quote(f"../../{page.relative_to(course.root).as_posix()}") if page.exists() else ""


def _misunderstood(course, works):
    """The class's misconceptions in two lists: those that several students share, and the rest.

    Each as (findings.Misunderstood, picture or words of an example in HTML, section to revisit, its address).
    """
    everything = findings.misunderstood(works)
    shared = [found for found in everything if found.students >= SHARED][:MOST_PICTURES]
    rare = everything[len(shared) :]
    # An example in the exercise where it is most frequent; none of those that any exercise can have.
    where = [(found.exercises[0][0], found.id) for found in shared]
    pictures = examples.of_misconceptions(course, [of for of in where if examples.knows(*of)])
    return (
        [(found, Markup(pictures.get(of, "")), *_section(course, of[0])) for found, of in zip(shared, where)],
        [(found, "", *_section(course, found.exercises[0][0])) for found in rare],
    )


def _section(course, exercise):
    """(the part of the notebooks that leads to an exercise, its address for JupyterLab)"""
    notebook = next(name for name, released in course.notebooks.items() if exercise in released.points)
    section = course.notebooks[notebook].section(exercise)
    address = f"../../notebooks/{ASSIGNMENT}/{notebook}.ipynb"
    return f"{notebook}: {section}", f"{quote(address)}#{quote(section.replace(' ', '-'))}"


def _by_hand(course, grades):
    """(points given by hand, most of these, points in all, most in all) of a student's {notebook: NotebookGrades}."""
    questions = {(notebook, name) for notebook, released in course.notebooks.items() for name in released.questions}
    everything = {(notebook, name): p for notebook, found in grades.items() for name, p in found.cells.items()}
    by_hand = [points for cell, points in everything.items() if cell in questions]
    in_all = list(everything.values())
    return tuple(sum(getattr(p, field) for p in cells) for cells in (by_hand, in_all) for field in ("earned", "most"))


def _questions(course, waiting):
    """[(notebook, question, how many answers wait for a human)], in order."""
    counts = Counter(sorted((notebook, cell) for _, notebook, cell in waiting if notebook in course.notebooks))
    return [(notebook, course.notebooks[notebook].section(cell), n) for (notebook, cell), n in counts.items()]
