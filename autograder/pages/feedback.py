"""What is given back to students: nbgrader's page for each notebook, and index.html, which sums them up.

`nbgrader generate_feedback` alone makes the notebooks' pages, and no summary.
"""

import hashlib
import json
import os
from dataclasses import asdict
from functools import cache, partial
from urllib.parse import quote

from sqlalchemy.exc import SQLAlchemyError
from traitlets.config import Config
from transform_lab.judging import panel
from transform_lab.judging.status import STATUSES

from ..bridge.nbgrader_api import FeedbackPages
from ..course import ASSIGNMENT, CourseError
from ..files import replace
from ..grading import digests
from ..grading.failure import Failure
from ..grading.marks import CellGrade, NotebookGrades
from ..grading.records import recorded, recorded_alone, verdicts
from ..grading.workers import Processes
from ..intake.submission import NOT_HANDED_IN
from ..released import without_points
from .markdown import heading
from .rendering import environment

SUMMARY = "index.html"
WITHOUT = "feedback without what the student wrote and displayed"


def is_complete(course, student, grades):
    """Whether there is a whole page for each of the student's graded notebooks, and a summary of these grades.

    grades: {notebook: NotebookGrades}; one that was given or changed by hand asks for new pages
    """
    pages = [course.feedback(student) / f"{path.stem}.html" for path in course.autograded(student).glob("*.ipynb")]
    summary = course.feedback(student) / SUMMARY
    if not pages and not recorded_alone(course, student):
        return True
    told = _digest(course, student, grades, recorded(course, student)).encode()
    return all(map(_is_whole, [*pages, summary])) and told in summary.read_bytes()


def _is_whole(page):
    """A page that was being written when the grader was killed has no end."""
    try:
        with open(page, "rb") as file:
            file.seek(max(0, os.path.getsize(page) - 100))
            return file.read().rstrip().endswith(b"</html>")
    except OSError:
        return False


def _digest(course, student, grades, records):
    """Stands in the summary for the grades and the grading that it was made from, and for what made it."""
    graded = [(name, record["seed"], record["graded"]) for name, record in records.items()]
    told = (
        digests.of_pages(course),
        graded,
        _problems(course, student, records),
        {name: asdict(of) for name, of in grades.items()},
    )
    return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()


def generate(course, grades, jobs):
    """Write feedback/STUDENT/… for {student: {notebook: NotebookGrades}}.

    Yields (student, None or what went wrong) as they are done.
    """
    too_much = {}
    for (student, told), found in Processes(partial(_pages, course), jobs).each(grades.items()):
        if isinstance(found, Failure):
            too_much[student] = told
        else:
            yield student, found
    for (student, _), found in Processes(partial(_pages, course, bare=True), jobs).each(too_much.items()):
        yield student, f"no feedback: {found.words}" if isinstance(found, Failure) else found


def _pages(course, of_student, bare=False):
    return _one(course, *of_student, bare)


def _one(course, student, grades, bare=False):
    """Write a student's pages whatever is in the notebooks; None, or what they lack and why.

    bare: leave out from the start what the student wrote and displayed, because a page with it took too much
    """
    told = f"{WITHOUT}: with it they took more time or memory than is allowed" if bare else None
    for write in (_verdicts,) if bare else (_whole, _verdicts):
        try:
            return write(course, student, grades) or told
        except Exception as error:  # whatever it is, the others' pages and the class report are not to be lost
            if not Failure.of(error, OSError, SQLAlchemyError).of_content:
                return f"no feedback: {_words(error)}"  # less of it would come to the same, or stay for good
            told = told or f"{WITHOUT}: {_words(error)}"
            last = error
    try:
        _least(course, student, grades)
        return f"the pages hold the points alone: {_words(last)}"
    except Exception as error:
        return f"no feedback: {_words(error)}"


def _words(error):
    kind = "" if isinstance(error, CourseError) else f"{type(error).__name__}: "
    return kind + " ".join(str(error).split())[:300]


def _whole(course, student, grades, bare=False):
    problem = None
    if any(course.autograded(student).glob("*.ipynb")):
        problem = _converter(course, bare).make(student, grades)
    course.feedback(student).mkdir(parents=True, exist_ok=True)
    replace(course.feedback(student) / SUMMARY, summary(course, student, grades))
    return problem


def _verdicts(course, student, grades):
    """Pages without what the student wrote and displayed."""
    return _whole(course, student, grades, bare=True)


@cache
def _converter(course, bare):
    """nbgrader's, which a worker makes once."""
    if not bare:
        return FeedbackPages(course)
    return FeedbackPages(course, Config(GenerateFeedback={"exporter_class": "autograder.pages.exporter.BareFeedback"}))


def _least(course, student, grades):
    """Pages with the points of the gradebook, which need nothing else; they are made anew by the next run."""
    course.feedback(student).mkdir(parents=True, exist_ok=True)
    template = environment().get_template("least.html")
    for path in course.autograded(student).glob("*.ipynb"):
        page = template.render(assignment=ASSIGNMENT, notebooks={path.stem: grades.get(path.stem, NotebookGrades())})
        replace(course.feedback(student) / f"{path.stem}.html", page)
    replace(course.feedback(student) / SUMMARY, template.render(assignment=ASSIGNMENT, notebooks=grades))


def _problems(course, student, records):
    """What was odd about a student's files, but for what is not among them; records: those of the notebooks"""
    found = records.values() or filter(None, [recorded_alone(course, student)])
    absent = {NOT_HANDED_IN.format(f"{name}.ipynb") for name in course.notebooks}
    lines = dict.fromkeys(line for record in found for line in record["problems"])
    return [line for line in lines if line not in absent]


def summary(course, student, grades):
    """The text of index.html: points, and for what is not right what was found, what helps, and what to read again."""
    records = recorded(course, student)
    notebooks = [
        _notebook(released, grades.get(name, NotebookGrades()), records.get(name))
        for name, released in course.notebooks.items()
    ]
    wrong = (
        cell
        for notebook in notebooks
        for cell in notebook["exercises"]
        if cell["link"] and not cell["right"] and not notebook["unreadable"]
    )
    template = environment().get_template("summary.html")
    return template.render(
        assignment=ASSIGNMENT,
        notebooks=notebooks,
        earned=sum(notebook["earned"] for notebook in notebooks),
        most=sum(notebook["most"] for notebook in notebooks),
        waiting=sum(cell["waiting"] for notebook in notebooks for cell in notebook["questions"]),
        begin=next(wrong, None),
        all_right=all(cell["right"] for notebook in notebooks for cell in notebook["exercises"]),
        problems=_problems(course, student, records),
        digest=_digest(course, student, grades, records),
    )


def _notebook(released, grades, record):
    """One notebook as the template takes it; `record` is None for one that was not handed in."""
    page = f"{quote(released.name)}.html" if record else ""
    asked, found = released.points | released.questions, verdicts(record) if record else {}
    cells = {name: _cell(name, most, released, grades, found.get(name), page) for name, most in asked.items()}
    return {
        "title": released.title,
        "file": f"{released.name}.ipynb",
        "unreadable": _unreadable(record),
        "page": page,
        "earned": max(0.0, sum(cell["earned"] for cell in cells.values()) - grades.penalty),
        "most": sum(cell["most"] for cell in cells.values()),
        "penalty": grades.penalty,
        "exercises": [cells[name] for name in released.points],
        "questions": [cells[name] for name in released.questions],
    }


def _unreadable(record):
    """What a notebook's status means when its file could not be read; "" for any other."""
    status = record["rows"][0].status if record else ""
    return STATUSES[status].means if status == "unreadable" else ""


def _cell(name, most, released, grades, verdict, page):
    """One exercise or question, worth `most` points, as the template takes it.

    verdict: on an exercise; None where a damaged record has lost it, which costs only what is said of it
    """
    told = grades.cells.get(name, CellGrade(0.0, most, False))
    section = released.section(name)
    return {
        "name": name,
        "earned": told.earned,
        "most": most,
        "right": told.earned >= most,
        "waiting": told.waiting,
        "by_hand": told.by_hand,
        "comment": grades.comments.get(name, ""),
        "mistakes": panel.mistakes(verdict) if verdict else [],
        "link": page and f"{page}#{quote(name)}",
        "section": without_points(section),
        "again": page and f"{page}#{quote(heading(section)[0])}",
    }
