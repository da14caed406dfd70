"""No system's form: a folder or a zip file for each student, called as the student is."""

import re
from pathlib import PurePosixPath

from ..course import ASSIGNMENT
from ..intake.naming import is_notebook
from .piece import Form, Found, Left, Piece, Who, share

ZIP = re.compile(r"(?P<name>.+)\.zip", re.IGNORECASE)


def fits(download):
    """It is anybody's form, so there has to be a notebook in a folder, or nothing but zip files; a folder around all the
    students' ones is to be taken off first.
    """
    if _lone(download) and all(len(path.parts) > 2 for path in download.files) and not _of_a_student(download):
        return 0.0
    if not any(_zip(path) or len(path.parts) > 1 and is_notebook(path.name) for path in download.files):
        return 0.0
    return share(download, lambda path: len(path.parts) > 1 or _zip(path))


def _zip(path):
    return ZIP.fullmatch(path.name) if len(path.parts) == 1 else None


def _lone(download):
    """The only folder at the top; None where there are several."""
    tops = {path.parts[0] for path in download.files if len(path.parts) > 1}
    return tops.pop() if len(tops) == 1 else None


def _of_a_student(download):
    """Whether all folders hold the assignment's folder alone."""
    return all(path.parts[1] == ASSIGNMENT for path in download.files if len(path.parts) > 1)


def doubt(download, around: str) -> str:
    """Why nothing tells whether the only folder is one student's; "" where it is, or there are several.

    around: what the download is called
    """
    lone = _lone(download)
    if not lone or _of_a_student(download):
        return ""
    inside = [path for path in download.files if len(path.parts) > 1]
    loose = [path.name for path in inside if len(path.parts) == 2]
    notebooks = [re.sub(r" ?\(\d+\)", "", name) for name in loose if is_notebook(name)]
    deep = any(len(path.parts) > 2 and is_notebook(path.name) for path in inside)
    if deep or any(map(ZIP.fullmatch, loose)):
        return f"nothing tells whether {lone} is a student's folder, or the one around the students' folders"
    called = lone.casefold()
    whole = re.compile(rf"{re.escape(called)}(?![^\W_])")
    if len(set(notebooks)) < len(notebooks) or called == ASSIGNMENT or whole.match(around.casefold()):
        return (
            f"all notebooks lie in one folder, {lone}, as Google Classroom gives them, and nothing tells whose they are; "
            "if they are one student's, put them into a folder called as the student is"
        )
    return ""


def sort(download, notebooks, people):
    pieces, left = [], []
    for path in download.files:
        if found := _zip(path):
            pieces.append(Piece((_who(found["name"], people),), path, path))
        elif len(path.parts) == 1:
            left.append(Left("it lies in no student's folder", (str(path),)))
        else:
            inside = path.parts[2:] if path.parts[1] == ASSIGNMENT and len(path.parts) > 2 else path.parts[1:]
            pieces.append(Piece((_who(path.parts[0], people),), path, PurePosixPath(*inside)))
    return Found(pieces, left)


def _who(called, people):
    """A folder is called by what somebody is known by, or by a name."""
    kind = next((kind for kind in ("login", "email", "sid", "lms_id", "number") if people.knows(kind, called)), None)
    return Who(**{kind or "name": called})


FORM = Form("plain", "a folder or a zip file for each student", fits, sort)
