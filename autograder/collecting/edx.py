"""Open edX: the submission files of open response assessments, a report of the instructor dashboard.

`[i]SECTION, [j]SUBSECTION, [k]UNIT/[n] - WHO - NAME`, with submissions.csv (course_id, block_id, student_id, key, name, type,
description, size, file_path, file_found); what was typed is prompt_0.txt, …. The rule is that of openedx/edx-ora2:
openassessment/data.py (OraDownloadData). All assignments of the course are in one archive; those of ours are known by their
notebooks. WHO is the user name, or an id of another system, or 32 digits that name nobody. Long names are cut; the table has
them whole. There is no time.
"""

import csv
import re
from collections import defaultdict
from pathlib import PurePosixPath

from ..intake.archive import Refused
from ..intake.naming import by_cells, is_notebook
from .piece import Form, Found, Left, Piece, Who, own, share, stem_of

UNIT = re.compile(r"\[\d+\].*")
FILE = re.compile(r"\[(?P<number>\d+)\] - (?P<who>.+?) - (?P<name>.+)", re.DOTALL)
NOBODY = re.compile("[0-9a-f]{32}")
TABLE = PurePosixPath("submissions.csv")
PROMPT = re.compile(r"prompt_\d+\.txt")


def fits(download):
    return share(download, lambda path: _part(path) or path == TABLE)


def _part(path):
    return FILE.fullmatch(path.name) if len(path.parts) == 2 and UNIT.fullmatch(path.parts[0]) else None


def sort(download, notebooks, people):
    pieces, left, units, table = [], [], defaultdict(list), _table(download)
    for path in download.files:
        if part := _part(path):
            name = PurePosixPath(table.get(str(path), {}).get("name") or part["name"]).name or part["name"]
            units[path.parts[0]].append((path, part["who"], int(part["number"]), name))
        elif path != TABLE:
            left.append(Left("it is not named as Open edX names files", (str(path),)))
    ours = [unit for unit, files in units.items() if any(_is_ours(name, notebooks) for *_, name in files)]
    if len(units) > 1 and not ours:
        ours = [
            unit for unit, files in units.items() if any(_by_cells(download, path, notebooks) for path, *_ in files)
        ]
    for unit, files in units.items():
        if len(units) > 1 and unit not in ours:
            left.append(Left("of another assignment", tuple(str(path) for path, *_ in files), look=False))
            continue
        for path, who, number, name in files:
            person = Who(number=who) if NOBODY.fullmatch(who) else Who(login=who)
            if PROMPT.fullmatch(name) or table.get(str(path), {}).get("type") == "text":
                left.append(Left("a text, typed into Open edX", (str(path),), str(person)))
            else:
                pieces.append(Piece((person,), path, PurePosixPath(name)))
    return Found(pieces, left + own((path for path in download.files if path == TABLE), "Open edX's own"))


def _is_ours(name, notebooks):
    return is_notebook(name) and stem_of(name, notebooks)


def _by_cells(download, path, notebooks):
    try:
        return by_cells(download.read(path), notebooks)
    except Refused:
        return None


def _table(download):
    """{file_path: row} of submissions.csv"""
    try:
        text = download.read(TABLE).decode("utf-8-sig", "replace")
    except (KeyError, Refused):
        return {}
    return {row["file_path"]: row for row in csv.DictReader(text.splitlines()) if row.get("file_path")}


FORM = Form("edx", "Open edX: submission files of open response assessments", fits, sort)
