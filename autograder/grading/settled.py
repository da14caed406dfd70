"""Whether `grade` has anything to do at all, by the looks of files: their sizes and times, and hardly one of them is read.

When a run has left nothing to do, the looks of all that it read or made are kept with the table that it printed. While they
are the same, another run would say the same. Anything that looks otherwise is for the usual way to judge.
"""

import contextlib
import hashlib
import json
import os
import stat
import sys
import time
from pathlib import Path

from ..files import replace
from ..intake.reading import LARGEST
from ..intake.submission import read, receipts

KEPT = ".settled.json"  # in the course's reports/
AUTOGRADER = Path(__file__).parent.parent
SQLITE = "sqlite:///"
# Nanoseconds within which a file that is changed twice may look as if it were changed once: such a one is read.
FRESH = 2_000_000_000


def look(course, gradebook):
    """{path: how it looks, as numbers} of all that `grade` reads or makes.

    gradebook: the path of the file that holds it
    """
    found = {}
    for path in (gradebook, f"{gradebook}-wal", f"{gradebook}-journal"):
        _add(found, path)
    for path in (course.root / "nbgrader_config.py", AUTOGRADER.parent / "environment.txt"):
        _add(found, path)
    for folder in (AUTOGRADER, course.package, course.release, course.reports):
        _add_all(found, folder)
    for entry in sorted(os.scandir(course.root / "submitted"), key=lambda entry: entry.name):
        _add(found, entry.path)
        for folder in (course.submitted(entry.name), course.autograded(entry.name), course.feedback(entry.name)):
            _add_all(found, folder)
    return found


def _add_all(found, folder):
    """Add what is in a folder and those below it."""
    folders = [str(folder)]
    while folders:
        here = folders.pop()
        try:
            names = sorted(os.listdir(here))
        except OSError as error:
            found[f"{here}{os.sep}"] = [error.errno]
            continue
        for name in names:
            if name not in ("__pycache__", KEPT):
                path = f"{here}{os.sep}{name}"
                if _add(found, path):
                    folders.append(path)


def _add(found, path):
    """Add one path; whether it is a folder, of which the time tells nothing that the names in it do not."""
    path = str(path)
    try:
        seen = os.lstat(path)
        folder = stat.S_ISDIR(seen.st_mode)
        found[path] = [seen.st_mode] if folder else _looks(seen)
        if stat.S_ISLNK(seen.st_mode):
            found[f"{path} ->"] = _looks(os.stat(path))
    except OSError as error:
        found[path] = [error.errno]
        return False
    return folder


def _looks(seen):
    return [seen.st_mode, seen.st_size, seen.st_mtime_ns, seen.st_ctime_ns, seen.st_ino]


class Looks:
    """How everything looked in the course of a run."""

    def __init__(self, course, db_url):
        """db_url: where the gradebook is, as SQLAlchemy writes it; one that is no file has no looks, and nothing is kept"""
        self.course, self.seen = course, []
        self.gradebook = db_url.removeprefix(SQLITE) if db_url.startswith(SQLITE) else None

    def take(self):
        """To be called before anything is read, when all is recorded but no page made yet, and at the end."""
        if self.gradebook:
            self.seen.append(look(self.course, self.gradebook))

    def keep(self, students, settings, graded, table):
        """Keep the last looks of a run that has left nothing to do, unless somebody else has changed something meanwhile.

        settings: nbgrader's, of the course
        graded: the students of whom this run has recorded something
        table: what it prints of the class
        """
        if not self.gradebook:
            return
        before, recorded, now = self.seen
        made = [str(self.course.reports), str(self.course.root / "feedback")]
        written = [str(self.course.autograded(student)) for student in graded] + ([self.gradebook] if graded else [])
        if not (_same(before, now, made + written) and _same(recorded, now, made)):
            return
        if any(receipts(self.course.submitted(student))[1] for student in students):
            return  # a time to come is one of the past some day
        moment = time.time_ns()
        fresh = {path: _digest(path) for path, looks in now.items() if max(looks[2:4], default=0) > moment - FRESH}
        if None in fresh.values():
            return
        about = _about(students, settings)
        kept = {"about": about, "gradebook": self.gradebook, "looks": now, "fresh": fresh, "table": table}
        with contextlib.suppress(OSError):
            replace(self.course.reports / KEPT, json.dumps(kept))


def _same(one, other, without):
    """Whether two looks are the same, but for the paths that begin in one of these ways."""
    without = tuple(without)
    return all(one.get(path) == other.get(path) for path in one.keys() | other.keys() if not path.startswith(without))


def table(course, students, settings):
    """What the last run printed of the class, if it has left nothing to do and nothing looks otherwise; else None."""
    with contextlib.suppress(
        OSError, ValueError, LookupError, TypeError
    ):  # there are none, or somebody has damaged them
        kept = json.loads((course.reports / KEPT).read_text(encoding="utf-8"))
        if kept["about"] == _about(students, settings) and kept["looks"] == look(course, kept["gradebook"]):
            if kept["fresh"] == {path: _digest(path) for path in kept["fresh"]}:
                return kept["table"]
    return None


def _about(students, settings):
    """What a run depends on besides files."""
    return [list(students), repr(settings), sys.version, list(time.tzname)]


def _digest(path):
    """Of what is in a file; None of what is no regular one, or too large."""
    content, problem = read(path)
    return None if problem or len(content) > LARGEST else hashlib.sha256(content).hexdigest()
