"""Gradescope: "Export Submissions" of a programming assignment.

assignment_ID_export/submission_ID/FILES with the student's own folders, and submission_metadata.yml, whose keys are Ruby's
symbols: `submission_ID` → `:submitters:` (a list of `:name:`, `:sid:`, `:email:`; several of a group; perhaps none) and
`:created_at:`. For assignments of PDF files the key is a file's name. The source is a tool that reads it:
ucbds-infra/otter-grader, local_grader/metadata.py. The export has the active submission alone; the time is in UTC.
"""

import re
from datetime import UTC
from pathlib import PurePosixPath

import dateutil.parser
import yaml

from ..intake.archive import Refused
from .piece import Form, Found, Left, Piece, Who, own, share

METADATA = PurePosixPath("submission_metadata.yml")
FOLDER = re.compile(r"submission_\d+")
# Of each submission's entry, as Ruby writes it, what tells whose it is and when it came; most of the rest is outputs.
WANTED = re.compile(r"^(?:(?! ).*| {2}:(?:submitters|created_at):.*(?:\n {2}(?!:[a-z]).*)*)$", re.MULTILINE)
Loader = getattr(yaml, "CBaseLoader", yaml.BaseLoader)  # all values as the texts they are


def fits(download):
    return share(download, lambda path: FOLDER.fullmatch(path.parts[0]) or path == METADATA)


def sort(download, notebooks, people):
    left = []
    try:
        known = _metadata(download.read(METADATA).decode("utf-8", "replace"))
    except (KeyError, Refused, yaml.YAMLError):
        known = {}
        why = f"{METADATA} is missing or cannot be read, and without it nobody knows whose this is; export once more"
        return Found([], [Left(why, tuple(map(str, download.files)))])
    pieces = []
    for path in download.files:
        entry = known.get(path.parts[0])
        if path == METADATA:
            continue
        if not isinstance(entry, dict):
            left.append(Left(f"{METADATA} says nothing of it", (str(path),)))
            continue
        submitters = entry.get(":submitters")
        whose = tuple(map(_who, filter(_told, submitters if isinstance(submitters, list) else ())))
        if not whose:
            left.append(Left("Gradescope does not say who handed it in", (str(path),)))
        else:
            inside = PurePosixPath(*path.parts[1:]) if len(path.parts) > 1 else path
            pieces.append(Piece(whose, path, inside, time=_time(entry.get(":created_at"))))
    return Found(pieces, left + own([METADATA], "Gradescope's own"))


def _metadata(text):
    try:
        found = yaml.load("\n".join(WANTED.findall(text)), Loader)
    except yaml.YAMLError:  # it is laid out in another way
        found = yaml.load(text, Loader)
    return found if isinstance(found, dict) else {}


def _told(submitter):
    return isinstance(submitter, dict) and any(_text(submitter, key) for key in ("name", "email", "sid"))


def _who(submitter):
    return Who(*(_text(submitter, "name"), "", _text(submitter, "email")), sid=_text(submitter, "sid"))


def _text(submitter, key):
    value = submitter.get(f":{key}")
    value = value.strip() if isinstance(value, str) else ""
    return "" if value in ("null", "~") else value


def _time(said):
    """The time with its zone; None where there is none."""
    try:
        time = dateutil.parser.parse(said[:40])
    except (ValueError, OverflowError, TypeError):
        return None
    return time if time.tzinfo else time.replace(tzinfo=UTC)


FORM = Form("gradescope", "Gradescope: Export Submissions", fits, sort)
