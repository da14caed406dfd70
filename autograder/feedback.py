"""nbgrader's feedback pages: one HTML file for each graded notebook, made for many students at once."""

import logging
from concurrent.futures import ProcessPoolExecutor

from .course import ASSIGNMENT


def generate(course, students, jobs):
    """Write feedback/STUDENT/…; yields (student, None or what went wrong) as they are done."""
    with ProcessPoolExecutor(jobs) as pool:
        yield from zip(students, pool.map(_one, [course] * len(students), students))


def _one(course, student):
    from nbgrader.apps import NbGraderAPI
    from nbgrader.coursedir import CourseDirectory

    from .gradebook import settings

    config = settings(course)
    logging.getLogger("traitlets").setLevel(logging.CRITICAL)
    result = NbGraderAPI(CourseDirectory(config=config), config=config).generate_feedback(
        ASSIGNMENT, student, force=True
    )
    return None if result["success"] else (result.get("error") or result.get("log") or "no reason given").strip()[-200:]
