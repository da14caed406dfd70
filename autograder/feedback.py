"""nbgrader's feedback pages: one HTML file for each graded notebook, made for many students at once."""

import os
from concurrent.futures import ProcessPoolExecutor

from . import api
from .course import ASSIGNMENT, CourseError
from .workers import end_with_parent


def is_complete(course, student):
    """Whether there is a whole page for each of the student's graded notebooks."""
    pages = [course.feedback(student) / f"{path.stem}.html" for path in course.autograded(student).glob("*.ipynb")]
    return all(_is_whole(page) for page in pages)


def _is_whole(page):
    """A page that was being written when the grader was killed has no end."""
    try:
        with open(page, "rb") as file:
            file.seek(max(0, os.path.getsize(page) - 100))
            return file.read().rstrip().endswith(b"</html>")
    except OSError:
        return False


def generate(course, students, jobs):
    """Write feedback/STUDENT/…; yields (student, None or what went wrong) as they are done."""
    with ProcessPoolExecutor(jobs, initializer=end_with_parent) as pool:
        yield from zip(students, pool.map(_one, [course] * len(students), students))


def _one(course, student):
    try:
        api.call(course, "generate_feedback", ASSIGNMENT, student)
    except CourseError as error:
        return str(error)
    return None
