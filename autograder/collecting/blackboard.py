"""Blackboard (Original course view): "Assignment File Download" of the Grade Centre.

ASSIGNMENT_USER_attempt_YYYY-MM-DD-hh-mm-ss_NAME, and for each attempt a receipt ASSIGNMENT_USER_attempt_DATE.txt that begins
with `Name: FULL NAME (USER)` and lists pairs of `Original filename:` and `Filename:`. The sources are tools that read them:
kwurst/bb-file-cleanup, vangef/BBGradebookOrganiser; nbgrader's documentation of zip_collect has this form, too. ASSIGNMENT
and USER may hold `_`, so USER is what the receipt says, or what stands behind that which all names begin with.

The time is the server's local time. There may be several attempts. Of Blackboard Ultra no source was found.
"""

import os
import re
from datetime import datetime
from pathlib import PurePosixPath

from ..intake.archive import Refused
from .piece import Form, Found, Left, Piece, Who, own, share

FILE = re.compile(
    r"(?P<before>.+?)_attempt_(?P<time>\d{4}-\d\d-\d\d-\d\d-\d\d-\d\d)(?:_(?P<name>.+)|(?P<receipt>\.txt))", re.DOTALL
)
NAME = re.compile(r"\s*[^:\n]{1,40}:\s*(?P<name>.*?)\s*\((?P<user>[^()\n]+)\)\s*")  # the first line
FIELDS = re.compile(r"^Submission Field:\s*(?P<text>.*?)\s*^Comments:", re.MULTILINE | re.DOTALL)
NO_TEXT = "There is no student submission text data for this assignment."
LARGEST_RECEIPT = 200_000  # bytes of it that are looked at; students write texts and comments into it


def fits(download):
    return share(download, lambda path: len(path.parts) == 1 and FILE.fullmatch(path.name))


def sort(download, notebooks, people):
    parts = {path: FILE.fullmatch(path.name) if len(path.parts) == 1 else None for path in download.files}
    pieces, left, receipts, texts = [], [], {}, {}
    for path, part in parts.items():
        if part and part["receipt"]:
            try:
                receipts[part["before"], part["time"]] = download.read(path)[:LARGEST_RECEIPT].decode(
                    "utf-8-sig", "replace"
                )
            except Refused as refused:
                left.append(Left(str(refused), (str(path),)))
    whose = _whose({part["before"] for part in parts.values() if part}, receipts)
    for path, part in parts.items():
        if not part:
            left.append(Left("it is not named as Blackboard names files", (str(path),)))
            continue
        try:
            time = datetime.strptime(part["time"], "%Y-%m-%d-%H-%M-%S")
        except ValueError:
            time = None
        receipt, who = receipts.get((part["before"], part["time"]), ""), whose[part["before"]]
        if part["receipt"]:
            text = FIELDS.search(receipt)
            if text and text["text"] and not text["text"].startswith(NO_TEXT[:40]):
                left.append(Left("a text, typed into Blackboard", (str(path),), str(who)))
            else:
                texts[path] = receipt
            continue
        pair = re.search(
            rf"^[^:\n]+:[ \t]*(.+?)[ \t]*\r?\n[^:\n]+:[ \t]*{re.escape(path.name)}[ \t]*\r?$", receipt, re.MULTILINE
        )
        original = pair[1].replace("\\", "/").rpartition("/")[2] if pair else ""
        name = PurePosixPath(original or part["name"])
        pieces.append(Piece((who,), path, name, time=time, order=(part["time"],)))
    return Found(pieces, left + own(texts, "a receipt of Blackboard's"))


def _whose(beginnings, receipts):
    """{ASSIGNMENT_USER: Who}"""
    found, assignments = {}, set()
    for (before, _), text in receipts.items():
        first = NAME.match(text)
        if first and before.endswith(f"_{first['user']}"):
            found[before] = Who(first["name"], login=first["user"])
            assignments.add(before.removesuffix(first["user"]))
    if not assignments and len(beginnings) > 1:
        assignments.add("".join(os.path.commonprefix(sorted(beginnings)).rpartition("_")[:2]))
    for before in beginnings - found.keys():
        begins = max((each for each in assignments if before.startswith(each)), key=len, default="")
        found[before] = Who(login=before.removeprefix(begins) if begins else before.rpartition("_")[2])
    return found


FORM = Form("blackboard", "Blackboard (Original): Assignment File Download", fits, sort)
