"""Brightspace (D2L): "Download" of an assignment's submissions.

A folder for each submission, `N-N - NAME - Mon D, YYYY HMM AM`, the time without a colon and not padded (`926 PM`, `1226 AM`),
and an index.html beside them; in another version the files of all lie side by side, with ` - NAME.ext` behind that. NAME may
hold ` - `. The sources are public scripts that read them (such as jdmau72/Grading-Tools-). They agree that the first number
differs from student to student, or from attempt to attempt, and not on what the second one is. The time is the
server's local time.
"""

import re
from collections import defaultdict
from datetime import datetime
from pathlib import PurePosixPath

from .piece import Form, Found, Left, Piece, Who, own, share

MONTHS = "Jan Feb Mar Apr May Jun Jul Aug Sep Oct Nov Dec".split()
PART = re.compile(
    r"(?P<number>\d+)-(?P<second>\d+) - (?P<name>.+) - "
    r"(?P<month>[A-Z][a-z]{2})[a-z]* (?P<day>\d{1,2}), (?P<year>\d{4}) (?P<hour>\d{1,2}?):?(?P<minute>\d\d) (?P<half>[AP]M)"
    r"(?: - (?P<file>.+))?"
)


def fits(download):
    return share(download, lambda path: _part(path) or _own(path))


def sort(download, notebooks, people):
    pieces, left = [], []
    numbers = _numbers([part for path in download.files if (part := _part(path))], people)
    for path in download.files:
        if part := _part(path):
            name = part["name"].strip()
            who = Who(name, number=numbers.get(name, part["number"]))
            inside = PurePosixPath(part["file"] or "", *path.parts[1:])
            pieces.append(Piece((who,), path, inside, time=_time(part), order=(int(part["second"]),)))
        elif not _own(path):
            left.append(Left("it is not named as Brightspace names files", (str(path),)))
    return Found(pieces, left + own(filter(_own, download.files), "Brightspace's own"))


def _part(path):
    part = PART.fullmatch(path.parts[0])
    return part if part and part["month"] in MONTHS and bool(part["file"]) == (len(path.parts) == 1) else None


def _numbers(parts, people):
    """{name: the number to know somebody by} of those who came under several, and are one person all the same: the class list
    has the name once, or their second number is one and nobody else's.
    """
    seconds, firsts, found = defaultdict(set), defaultdict(set), {}
    for part in parts:
        seconds[part["name"].strip()].add(part["second"])
        firsts[part["name"].strip()].add(part["number"])
    for name, several in firsts.items():
        others = set().union(*(theirs for other, theirs in seconds.items() if other != name))
        listed = [person for person in people.named(name, FORM) if person.listed]
        one = len(listed) == 1 or not listed and len(seconds[name]) == 1 and not seconds[name] & others
        if len(several) > 1 and one and not any(people.knows("number", number) for number in several):
            found[name] = min(several, key=int)
    return found


def _own(path):
    return path == PurePosixPath("index.html")


def _time(part):
    """The time, to the minute, in local time of the server; None for none of the clock or the calendar."""
    hour = int(part["hour"]) % 12 + 12 * (part["half"] == "PM")
    try:
        return datetime(int(part["year"]), MONTHS.index(part["month"]) + 1, int(part["day"]), hour, int(part["minute"]))
    except ValueError:
        return None


FORM = Form("brightspace", "Brightspace: Download of submissions", fits, sort)
