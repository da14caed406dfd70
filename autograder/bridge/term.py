"""A new term: what was handed in and made goes into archive/, and the course gets another name in nbgrader's exchange.

Nothing is deleted, and a term that was begun and stopped halfway is gone on with by the same command.
"""

import re
from contextlib import nullcontext

from nbgrader.api import SubmittedAssignment
from sqlalchemy import func, select

from ..course import CourseError
from ..files import replace
from .gradebook import opened
from .nbgrader_api import db_url
from .settings import settings

ARCHIVED = ("submitted", "autograded", "feedback", "reports", "downloaded", "gradebook.db")
BESIDE_GRADEBOOK = ("gradebook.db-wal", "gradebook.db-shm", "gradebook.db-journal")
CONFIGURED = re.compile(r"""(?m)^(c\.CourseDirectory\.course_id\s*=\s*)(["'])([^"'\n]*)\2""")
NAME = re.compile(r"[A-Za-z0-9][\w.-]{0,63}", re.ASCII)  # a folder in the exchange, and a part of addresses


def begin(course, name, busy):
    """Begin the term `name`; returns (the folder of the old one or None where there was nothing, what is in it).

    busy: as in Course.one_grader_at_a_time
    """
    config = course.root / "nbgrader_config.py"
    text, old = _configured(config)
    if not NAME.fullmatch(name):
        raise CourseError(
            f"{name!r} can be no course's name: letters, digits, and - _ . between them, such as transforms-2027."
        )
    if name == old:
        raise CourseError(f"This is {name} already: the course is called so in nbgrader_config.py.")
    archive, moved = course.root / "archive" / old, []
    there = [name for name in (*ARCHIVED, *BESIDE_GRADEBOOK) if (course.root / name).exists()]
    if archive.exists() and there:
        raise CourseError(
            f"There is an archive/{old} already. Rename that folder, or the course (c.CourseDirectory.course_id in "
            "nbgrader_config.py), then run the command again. Nothing was changed."
        )
    _refuse_a_gradebook_elsewhere(course)
    with course.one_grader_at_a_time(busy) if (course.root / "submitted").is_dir() else nullcontext():
        partly = course.root / "archive" / f".{old}"
        for part in there:
            partly.mkdir(parents=True, exist_ok=True)
            (course.root / part).rename(partly / part)
        if partly.exists():
            moved = sorted(path.name for path in partly.iterdir())
            partly.rename(archive)
        replace(config, CONFIGURED.sub(rf"\g<1>\g<2>{name}\g<2>", text))
    return (archive if moved else None), moved


def _configured(config):
    """(text of nbgrader_config.py, the name that it gives to the course)"""
    text = config.read_text(encoding="utf-8")
    found = CONFIGURED.findall(text)
    if len(found) != 1:
        raise CourseError(
            "nbgrader_config.py has to say once, in a line of its own, what the course is called: "
            'c.CourseDirectory.course_id = "…". Nothing was changed.'
        )
    return text, found[0][2]


def _refuse_a_gradebook_elsewhere(course):
    """Raise CourseError when work of the old term is in a database that is no file of the course's."""
    if "db_url" not in settings(course).get("CourseDirectory", {}):
        return  # it is gradebook.db
    gradebook = opened(course)
    try:
        number = gradebook.db.scalar(select(func.count()).select_from(SubmittedAssignment))
    finally:
        gradebook.close()
    if number:
        raise CourseError(
            f"The gradebook ({_without_password(db_url(course))}) is no file of this course, and holds {number} submissions. "
            "Name another database for the new term as c.CourseDirectory.db_url in nbgrader_config.py, then run the command "
            "again. Nothing was changed."
        )


def _without_password(url):
    return re.sub(r"://([^/@:]*):[^/@]*@", r"://\1:…@", url)
