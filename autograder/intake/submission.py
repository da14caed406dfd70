"""What one student handed in, read into memory: nothing of it is followed, waited for or run.

What is wrong with it (files that are missing, left out or misnamed) is said in words, each with what to do.
"""

import errno
import hashlib
import os
import re
import stat
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

import dateutil.parser

from ..course import Course
from ..untrusted import printable
from .reading import LARGEST

TIMESTAMP, SECRET = "timestamp.txt", "submission_secret.txt"  # written by `nbgrader submit`
MOST_FILES = 200  # handed in besides the notebooks
NOT_HANDED_IN = "{}: not handed in; 0 points."
LARGEST_FILES = 4_000_000  # bytes, all of them together


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
        return {path: content for path, content in self.files.items() if not path.endswith(".ipynb")}

    @property
    def digest(self) -> str:
        """Changes when anything of the submission changes."""
        total = hashlib.sha256()
        for path, content in sorted(self.files.items()):
            total.update(f"{path}\0{len(content)}\0".encode() + content)
        return total.hexdigest()


def submission_of(course: Course, student: str, folder: Path | None = None) -> Submission:
    """The Submission in a folder (a path; None for submitted/STUDENT)."""
    folder = folder or course.submitted(student)
    files: dict[str, bytes] = {}
    problems: list[str] = []
    for name in (f"{name}.ipynb" for name in course.notebooks):
        if not os.path.lexists(folder / name):
            problems.append(NOT_HANDED_IN.format(name))
            continue
        content, problem = read(folder / name)
        files[name] = content or b""  # where nothing can be read, the intake calls the notebook unreadable
        if problem:
            problems.append(f"{name}: {problem}.")
    notebooks, room = len(files), LARGEST_FILES
    folders: set[str] = set()
    for path in _paths(folder, problems):
        relative = PurePosixPath(printable(path.relative_to(folder).as_posix()))
        name, above = str(relative), {str(parent) for parent in relative.parents}
        if name.removesuffix(".ipynb") in course.notebooks:
            continue
        content, problem = read(path)
        room -= len(content or b"")
        if len(files) - notebooks == MOST_FILES or room < 0:
            problem = f"left out; besides notebooks, {MOST_FILES} files of {LARGEST_FILES / 1e6:g} MB in all are taken"
        elif name.endswith(".ipynb"):
            wanted = ", ".join(f"{released}.ipynb" for released in course.notebooks)
            problem = f"no notebook of this assignment has that name; rename it to one of {wanted} and grade again"
        elif name in files or name in folders or above & set(files):
            problem = "left out; another file has the same name once what cannot be printed is replaced"
        if problem:
            problems.append(f"{name}: {problem}.")
        else:
            files[name] = content or b""
            folders |= above
    known_by, problem = receipts(folder)
    return Submission(student, files, tuple(problems + [problem] if problem else problems), known_by)


def receipts(folder: Path) -> tuple[dict[str, str], str | None]:
    """({file name: text} of what nbgrader knows a submission in `folder` by, what is wrong with it or None)

    timestamp.txt tells when it was handed in, submission_secret.txt is what its feedback is found by in the exchange;
    there is neither when the files were put there by hand.
    """
    texts = {name: (read(folder / name)[0] or b"").decode("utf-8", "replace").strip() for name in (TIMESTAMP, SECRET)}
    problem = None
    if not re.fullmatch("[0-9a-f]{128}", texts[SECRET]):
        del texts[SECRET]
    try:
        if len(texts[TIMESTAMP]) > 100:
            raise ValueError("too long to be read in reasonable time")
        if not (texts[TIMESTAMP] and dateutil.parser.parse(texts[TIMESTAMP])):
            del texts[TIMESTAMP]
    except (ValueError, OverflowError):
        problem = f"{TIMESTAMP}: {texts.pop(TIMESTAMP)[:60]!r} is no date; graded as if there were none."
    return texts, problem


def _paths(folder, problems):
    """What is in a folder and those below it, links included; hidden files, caches and the students' package are not.

    (They are nobody's work; the grader uses the course's own package.)
    """

    def said(error):
        name = printable(os.path.relpath(error.filename, folder))
        problems.append(f"{name if len(name) < 200 else name[:200] + '…'}: left out; {error.strerror}.")

    for here, folders, names in os.walk(folder, onerror=said):
        ignored = {name for name in folders + names if name.startswith(".") or name == "__pycache__"}
        if Path(here) == folder:
            ignored.add("transform_lab")
        links = [name for name in folders if os.path.islink(os.path.join(here, name))]
        folders[:] = sorted(set(folders) - ignored)
        for name in sorted({*names, *links} - ignored):
            yield Path(here, name)


def read(path: Path | str, folder: int | None = None) -> tuple[bytes | None, str | None]:
    """(the bytes of a regular file or None, what is wrong with it or None); follows no link, waits for nobody.

    folder: the descriptor of the open folder that `path` is relative to
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
            return file.read(LARGEST + 1), None
    finally:
        os.close(descriptor)
