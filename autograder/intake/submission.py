"""What one student handed in, read into memory: nothing of it is followed, waited for or run.

What is wrong with it (files that are missing, left out or misnamed) is said in words, each with what to do.
"""

import errno
import hashlib
import os
import re
import stat
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path, PurePosixPath

import dateutil.parser

from ..course import Course
from ..names import UNPRINTABLE
from ..untrusted import printable
from .naming import is_notebook
from .reading import LARGEST
from .sorting import (
    LARGEST_FILES,
    LARGEST_NOTEBOOKS,
    MOST_FILES,
    MOST_NOTEBOOKS,
    PACKAGE,
    SECRET,
    TIMESTAMP,
    Room,
    sort,
)

AHEAD = timedelta(days=1)  # zones differ by up to 14 hours, and a time may lack its own; so do clocks set by hand
NOT_HANDED_IN = "{}: not handed in; 0 points."


@dataclass(frozen=True)
class Submission:
    """One student's files, {path relative to the assignment's folder: bytes}, and what is wrong with them."""

    student: str
    files: dict[str, bytes]
    problems: tuple[str, ...] = ()
    receipts: dict[str, str] = field(default_factory=dict)  # see `receipts`

    @property
    def helpers(self) -> dict[str, bytes]:
        """The files that notebooks may import or read."""
        helpers = {path: content for path, content in self.files.items() if not path.endswith(".ipynb")}
        runs_others = any(b"%run" in content and b".ipynb" in content for content in self.files.values())
        return self.files if runs_others else helpers

    @property
    def digest(self) -> str:
        """Changes when anything of the submission changes, the files' names included."""
        total = hashlib.sha256("\n".join(self.problems).encode())
        for path, content in sorted(self.files.items()):
            total.update(f"{path}\0{len(content)}\0".encode() + content)
        return total.hexdigest()


def submission_of(course: Course, student: str, folder: Path | None = None) -> Submission:
    """The Submission in a folder (a path; None for submitted/STUDENT)."""
    folder = folder or course.submitted(student)
    problems: list[str] = []
    sorted_files = sort(_files(folder, course, problems), course.notebooks)
    files = {f"{name}.ipynb": content for name, content in sorted_files.notebooks.items()}
    absent = [NOT_HANDED_IN.format(f"{name}.ipynb") for name in course.notebooks if name not in sorted_files.notebooks]
    known_by, odd = receipts(folder)
    problems += [*sorted_files.problems, *absent, *([odd] if odd else [])]
    return Submission(student, sorted_files.helpers | files, tuple(problems), known_by)


def _files(folder, course, problems):
    """{path: bytes} of what is in a folder, within bounds; what is left out is said."""
    files: dict[str, bytes] = {}
    folders: set[str] = set()
    rooms = {True: Room(MOST_NOTEBOOKS, LARGEST_NOTEBOOKS), False: Room(MOST_FILES, LARGEST_FILES)}
    for path in _paths(folder, course, problems):
        relative = PurePosixPath(UNPRINTABLE.sub("_", printable(path.relative_to(folder).as_posix())))
        name, above = str(relative), {str(parent) for parent in relative.parents}
        large = is_notebook(name) or name.lower().endswith(".zip")
        room = rooms[large]
        content, problem = read(path, most=LARGEST if large else LARGEST_FILES)
        if problem and relative.name == f"{relative.stem}.ipynb" and relative.stem in course.notebooks:
            problems.append(f"{name}: {problem}.")
            files[name] = b""  # the intake calls the notebook unreadable
            continue
        if not problem and not room.takes(content):
            problem = f"left out; besides notebooks, {MOST_FILES} files of {LARGEST_FILES / 1e6:g} MB in all are taken"
            if large:
                problem = f"left out; {MOST_NOTEBOOKS} notebooks of {LARGEST_NOTEBOOKS / 1e6:g} MB in all are taken"
        elif name in files or name in folders or above & set(files):
            problem = "left out; another file has the same name once what cannot be printed is replaced"
        if problem:
            problems.append(f"{name}: {problem}.")
        else:
            files[name] = content
            folders |= above
    return files


def receipts(folder: Path) -> tuple[dict[str, str], str | None]:
    """({file name: text} of what nbgrader knows a submission in `folder` by, what is wrong with it or None)

    timestamp.txt tells when it was handed in, submission_secret.txt is what its feedback is found by in the exchange;
    there is neither when the files were put there by hand. A time to come is none: students may have written it.
    """
    texts = {
        name: (read(folder / name, most=1_000)[0] or b"").decode("utf-8", "replace").strip()
        for name in (TIMESTAMP, SECRET)
    }
    problem = None
    if not re.fullmatch("[0-9a-f]{128}", texts[SECRET]):
        del texts[SECRET]
    try:
        if len(texts[TIMESTAMP]) > 100:
            raise ValueError("too long to be read in reasonable time")
        if not texts[TIMESTAMP]:
            del texts[TIMESTAMP]
        elif _is_to_come(dateutil.parser.parse(texts[TIMESTAMP])):
            problem = f"{TIMESTAMP}: {texts.pop(TIMESTAMP)} is still to come; graded as if there were none."
    except (ValueError, OverflowError):
        problem = f"{TIMESTAMP}: {texts.pop(TIMESTAMP)[:60]!r} is no date; graded as if there were none."
    return texts, problem


def _is_to_come(time):
    """Whether a time, which without a zone is UTC, is later than now, however clocks and zones may differ."""
    return (time if time.tzinfo else time.replace(tzinfo=UTC)) - AHEAD > datetime.now(UTC)


def _paths(folder, course, problems):
    """What is in a folder and those below it, links included; hidden files, caches and the students' package are not.

    The notebooks that are called as released come first: nothing else takes their room.
    """

    def said(error):
        name = printable(os.path.relpath(error.filename, folder))
        problems.append(f"{name if len(name) < 200 else name[:200] + '…'}: left out; {error.strerror}.")

    first = {f"{name}.ipynb" for name in course.notebooks}
    yield from (folder / name for name in sorted(first) if os.path.lexists(folder / name))
    for here, folders, names in os.walk(folder, onerror=said):
        ignored = {name for name in folders + names if name.startswith(".") or name in ("__pycache__", PACKAGE)}
        if Path(here) == folder:
            ignored |= first
        links = [name for name in folders if os.path.islink(os.path.join(here, name))]
        folders[:] = sorted(set(folders) - ignored)
        for name in sorted({*names, *links} - ignored):
            yield Path(here, name)


def read(path: Path | str, folder: int | None = None, most: int = LARGEST) -> tuple[bytes | None, str | None]:
    """(the bytes of a regular file or None, what is wrong with it or None); follows no link, waits for nobody.

    folder: the descriptor of the open folder that `path` is relative to; most: bytes, of a larger file one more is read
    """
    try:
        descriptor = os.open(path, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK, dir_fd=folder)
    except OSError as error:
        if error.errno == errno.ELOOP:
            return None, "left out; it is a link"
        return None, f"left out; it cannot be opened ({error.strerror})"
    try:
        if not stat.S_ISREG(os.fstat(descriptor).st_mode):
            return None, "left out; it is no regular file"
        with open(descriptor, "rb", closefd=False) as file:
            return file.read(most + 1), None
    finally:
        os.close(descriptor)
