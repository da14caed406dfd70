"""Sakai: "Download All" of an assignment.

TITLE/LAST, FIRST(EID)/ with timestamp.txt, `Submission attachment(s)/NAME`, and what Sakai adds; without folders
`TITLE/LAST, FIRST(EID)_Submission attachment(s)_NAME`; TITLE/grades.csv. Where grading is anonymous, a folder is called
`SUBMISSIONID ANONYMOUS`; where a group hands in, by one of its members, and members.txt lists all of them. The rule is that of
sakaiproject/sakai: assignment/impl/…/AssignmentServiceImpl.java (zipSubmissions, zipGroupSubmissions, zipAttachments). Words in
folders' names are in the site's language; accents are taken off names. `NAME+1.ext` is another file of that name, neither newer
nor older.

timestamp.txt is `2026-11-18T17:34:00.861Z`, or in older versions `20140805211624959`, in UTC as well. Who is late stands in
grades.csv alone.
"""

import csv
import re
import unicodedata
from collections import defaultdict
from datetime import UTC, datetime
from pathlib import PurePosixPath

import dateutil.parser

from ..intake.archive import Refused
from .piece import Form, Found, Left, Piece, Who, own, plainly, share

PERSON = re.compile(r"(?P<name>[^()]*[^()\s])\((?P<eid>[^()\s]+)\)")
FLAT = re.compile(rf"(?P<person>{PERSON.pattern})_(?P<word>[^_]+)(?:_(?P<file>.+))?")
ANONYMOUS = re.compile(r"(?P<id>[0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12})( .*)?", re.IGNORECASE)
GRADES = re.compile(r"grades\.(csv|xlsx?)")
TEXT = re.compile(r"(.*_)?submissionText\.html?")
ADDED = {"timestamp.txt", "members.txt", "comments.txt", "feedbackText.html"}
FEEDBACK = re.compile(
    "feedback|retroaliment|rétroaction|commentaire|comentari|realiment|riscontr|フィードバック", re.IGNORECASE
)
MEMBER = re.compile(r"\s*(?P<name>[^;()\n]*)\((?P<eid>[^;()\s]+)\)[^\S\n]*(?:;|\n|$)")
BLANK = re.compile(r"<[^>]*>|&nbsp;|\s")


def folded(name: str) -> str:
    """A name without accents, as Sakai writes it (NFD, then without what is not ASCII, or without marks alone)."""
    plain = unicodedata.normalize("NFD", plainly(name))
    return "".join(character for character in plain if not unicodedata.combining(character))


def fits(download):
    folders = _folders(download)
    return share(download, lambda path: path.parts[0] in folders or _flat(path) or GRADES.fullmatch(str(path)))


def _folders(download):
    """The students' folders: those that Sakai puts a file of its own into."""
    held = defaultdict(set)
    for path in download.files:
        if len(path.parts) > 1:
            held[path.parts[0]].add(path.parts[1] + "/" * (len(path.parts) > 2))
    return {
        name
        for name, inside in held.items()
        if "members.txt" in inside
        or (PERSON.fullmatch(name) or ANONYMOUS.fullmatch(name))
        and any(each in ADDED or each.startswith(f"{name}_") or each.endswith("(s)/") for each in inside)
    }


def _flat(path):
    return FLAT.fullmatch(path.name) if len(path.parts) == 1 else None


def sort(download, notebooks, people):
    folders, pieces, left, texts, extra = _folders(download), [], [], [], []
    late = _late(download)
    whose, times = {}, {}
    for path in download.files:
        if path.parts[0] in folders and path.parts[0] not in whose:
            whose[path.parts[0]] = _whose(download, path.parts[0])
            times[path.parts[0]] = _time(_text(download, PurePosixPath(path.parts[0], "timestamp.txt")))
    for path in download.files:
        top, flat = path.parts[0], _flat(path)
        if top in folders:
            people_of, time, inside = whose[top], times[top], PurePosixPath(*path.parts[1:])
            word, inside = (
                (inside.parts[0], PurePosixPath(*inside.parts[1:])) if len(inside.parts) > 1 else ("", inside)
            )
        elif flat:
            people_of, time = (
                (_person(flat["person"]),),
                _time(_text(download, PurePosixPath(f"{flat['person']}_timestamp.txt"))),
            )
            word, inside = (
                (flat["word"], PurePosixPath(flat["file"])) if flat["file"] else ("", PurePosixPath(flat["word"]))
            )
        else:
            extra.append(path)
            continue
        if not word and TEXT.fullmatch(inside.name):
            if BLANK.sub("", _text(download, path)):
                left.append(Left("a text, typed into Sakai", (str(path),), ", ".join(map(str, people_of))))
            else:
                texts.append(path)
        elif not word and inside.name in ADDED or FEEDBACK.search(word):
            texts.append(path)
        elif not word and flat:
            left.append(Left("it is not named as Sakai names files", (str(path),)))
        else:
            is_late = any(who.login in late for who in people_of if who.login)
            pieces.append(Piece(people_of, path, inside, time=time, late=is_late))
    grades = [path for path in extra if GRADES.fullmatch(str(path))]
    left += [Left("it is not named as Sakai names files", (str(path),)) for path in extra if path not in grades]
    return Found(pieces, left + own(texts + grades, "Sakai's own"))


def _whose(download, folder):
    """All whose work lies in a folder."""
    listed = _text(download, PurePosixPath(folder, "members.txt"))
    members = tuple(Who(found["name"].strip(), login=found["eid"]) for found in MEMBER.finditer(listed))
    return members or (_person(folder),)


def _person(said):
    if anonymous := ANONYMOUS.fullmatch(said):
        return Who(number=anonymous["id"])
    found = PERSON.fullmatch(said)
    return Who(found["name"], login=found["eid"]) if found else Who(said)


def _text(download, path):
    try:
        return download.read(path).decode("utf-8-sig", "replace") if path in download.files else ""
    except Refused:
        return ""


def _time(said):
    """The time in UTC; None where there is none."""
    said = said.strip()[:40]
    try:
        if re.fullmatch(r"\d{17}", said):
            return datetime.strptime(f"{said}000", "%Y%m%d%H%M%S%f").replace(tzinfo=UTC)
        time = dateutil.parser.isoparse(said) if said else None
    except ValueError:
        return None
    return time.replace(tzinfo=time.tzinfo or UTC) if time else None


def _late(download):
    """The EIDs of those whom grades.csv calls late."""
    rows = list(csv.reader(_text(download, PurePosixPath("grades.csv")).splitlines()))
    for position, row in enumerate(rows):
        head = [cell.strip().casefold() for cell in row]
        lateness = [place for place, cell in enumerate(head) if cell.startswith("late")]
        if lateness and "display id" in head:
            place = head.index("display id")
            width = max(place, lateness[0])
            return {
                each[place].strip()
                for each in rows[position + 1 :]
                if len(each) > width and each[lateness[0]].strip().casefold() in ("late", "yes", "true")
            }
    return set()


FORM = Form("sakai", "Sakai: Download All", fits, sort, folded)
