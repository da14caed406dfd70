"""nbgrader's feedback pages: one HTML file for each graded notebook, made for many students at once."""

from concurrent.futures import ProcessPoolExecutor

from . import api
from .course import ASSIGNMENT, CourseError


def generate(course, students, jobs):
    """Write feedback/STUDENT/…; yields (student, None or what went wrong) as they are done."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from zip(students, pool.map(_one, [course] * len(students), students))


def _one(course, student):
    try:
        api.call(course, "generate_feedback", ASSIGNMENT, student)
    except CourseError as error:
        return str(error)
    return None
