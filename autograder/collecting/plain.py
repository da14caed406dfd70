"""No system's form: a folder or a zip file for each student, called as the student is."""

import re
from pathlib import PurePosixPath

from ..course import ASSIGNMENT
from ..intake.naming import is_notebook
from .piece import Form, Found, Left, Piece, Who, share

ZIP = re.compile(r"(?P<name>.+)\.zip", re.IGNORECASE)


def fits(download):
    """It is anybody's form, so there has to be a notebook in a folder, or nothing but zip files."""
    if not any(_zip(path) or len(path.parts) > 1 and is_notebook(path.name) for path in download.files):
        return 0.0
    return share(download, lambda path: len(path.parts) > 1 or _zip(path))


def _zip(path):
    return ZIP.fullmatch(path.name) if len(path.parts) == 1 else None


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
