"""Which of the files that a student handed in is which notebook, whatever it is called and wherever it lies.

A notebook is known by its cells first and by its name second (see naming.py). Zip files are unpacked where they lie. What was
taken for what, and what was not, is said in words, each with what to do.
"""

import difflib
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import PurePosixPath

from ..released import Released
from .archive import Refused, contents
from .naming import by_name, has_work, is_notebook, meant
from .python_text import checks
from .reading import LARGEST, Unreadable, cells

PACKAGE = "transform_lab"  # the students' package: nobody's work, and the grader uses the course's own
TIMESTAMP, SECRET = "timestamp.txt", "submission_secret.txt"  # written by `nbgrader submit`
ZIPPED = (
    ".docx",
    ".xlsx",
    ".pptx",
    ".odt",
    ".ods",
    ".odp",
    ".jar",
    ".whl",
    ".npz",
    ".pages",
    ".numbers",
    ".key",
    ".epub",
)
MOST_LINES = 20  # about files that are no notebooks
PACKED = (".7z", ".rar", ".tar", ".gz", ".tgz", ".bz2", ".xz")
MOST_NOTEBOOKS, LARGEST_NOTEBOOKS = 100, 2 * LARGEST  # that are looked into, under whatever name; bytes of all of them
MOST_FILES, LARGEST_FILES = 200, 4_000_000  # handed in besides the notebooks; bytes of all of them


@dataclass
class Room:
    """How many files more are taken, and how many bytes of them."""

    files: int
    bytes: int

    def takes(self, content):
        """Whether there is room for it, which it then takes."""
        if self.files < 1 or self.bytes < len(content):
            return False
        self.files, self.bytes = self.files - 1, self.bytes - len(content)
        return True


@dataclass
class Sorted:
    """notebooks: {released name: bytes}; helpers: {path: bytes} of what these may import or read

    sources: {released name: the path that it came under, or that of its zip file}; problems: sentences
    """

    notebooks: dict[str, bytes] = field(default_factory=dict)
    helpers: dict[str, bytes] = field(default_factory=dict)
    sources: dict[str, str] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)


@dataclass
class Candidate:
    """A file that may be a notebook of the assignment.

    released: the notebook that it goes by; named: whether its name says so; numbers: of the copy, see naming.by_name
    """

    path: str
    content: bytes
    released: Released
    named: bool
    numbers: tuple[int, ...]
    zip: str = ""

    @property
    def exact(self):
        return PurePosixPath(self.path).name == f"{self.released.name}.ipynb"

    @cached_property
    def work(self):
        """Whether anything was written in it."""
        return has_work(self.cells, self.released)

    @cached_property
    def cells(self):
        try:
            return cells(self.content)
        except Unreadable:
            return []

    def holds(self, released):
        """Whether cells of another notebook stand in it, too, as nbgrader or their own call of `check` says."""
        known = {cell.entry.get("grade_id") for cell in self.cells}
        known.update(name for cell in self.cells for name in checks(cell.source)[0])
        return not known.isdisjoint(released.cells)

    @property
    def rank(self):
        """Work counts before an exact name, and that before other names; of copies the last one does."""
        depth = len(PurePosixPath(self.path.removeprefix(f"{self.zip}/")).parts)
        of_zip = tuple(map(int, re.findall(r"\d{1,4}", PurePosixPath(self.zip).stem)))
        return self.work, self.exact, -depth, self.named, of_zip, self.numbers, self.path


def sort(files: Mapping[str, bytes], notebooks: Mapping[str, Released]) -> Sorted:
    """Files as they were handed in, {path: bytes}, sorted by the released notebooks, {name: Released}."""
    found = Sorted()
    zips: dict[str, str] = {}
    everything = _unpacked(files, zips, found.problems)
    candidates: list[Candidate] = []
    for path, content in everything.items():
        if _may_be_notebook(path, content):
            if len(candidates) == MOST_NOTEBOOKS:
                found.problems.append(f"{path}: left out; at most {MOST_NOTEBOOKS} notebooks are looked into.")
            elif candidate := _candidate(path, content, notebooks, found.problems):
                candidate.zip = zips.get(path, "")
                candidates.append(candidate)
    chosen = _choose(candidates, notebooks, found)
    _look_for_more(candidates, notebooks, chosen, found)
    found.sources = {name: zips.get(path, path) for name, path in chosen.items()}
    root = _root(chosen.values())
    if root and root not in {_folder(path) for path in zips}:
        found.problems.append(f"{root}/: the notebooks were taken from this folder.")
    others = {path: content for path, content in everything.items() if path not in chosen.values()}
    about = [line for path, content in others.items() for line in _about_file(path, content, notebooks, chosen)]
    found.problems += about[:MOST_LINES]
    helpers = {path: content for path, content in others.items() if not is_notebook(path)}
    found.helpers = _helpers(helpers, chosen.values(), root, found.problems)
    return found


def _unpacked(files, zips, problems):
    """The files, and in the place of each zip file what is in it; `zips` is told which file came out of which."""
    everything = {path: content for path, content in files.items() if not _is_zip(path, content)}
    for path, content in files.items():
        if _is_zip(path, content):
            try:
                inside, odd = contents(content)
            except Refused as refused:
                problems.append(f"{path}: {refused}.")
                continue
            problems += [f"{path}: {problem}" for problem in odd]
            taken = {name: entry for name, entry in inside.items() if PACKAGE not in PurePosixPath(name).parts}
            problems.append(f"{path}: it was unpacked{'' if taken else ', and there is nothing in it'}.")
            room = Room(MOST_FILES, LARGEST_FILES)
            for name, entry in taken.items():
                unpacked = str(PurePosixPath(path).parent / name)
                if unpacked in everything:
                    unpacked = f"{path}/{name}"  # so that the one with work in it may be chosen
                if _is_zip(name, entry):
                    problems.append(f"{path}: {name}: a zip in a zip was not unpacked; hand in the files themselves.")
                elif not is_notebook(name) and not room.takes(entry):
                    problems.append(
                        f"{path}: {name}: left out; the files besides notebooks are too many, or too large."
                    )
                else:
                    everything[unpacked], zips[unpacked] = entry, path
    return everything


def _is_zip(path, content):
    """By its first bytes, whatever it is called; what other programs keep as a zip is none."""
    suffix = PurePosixPath(path).suffix.lower()
    return (content.startswith(b"PK") and suffix not in ZIPPED and not is_notebook(path)) or (
        suffix == ".zip" and not _holds_cells(content)
    )


def _holds_cells(content):
    inside = content[:1_000_000].lstrip(b"\xef\xbb\xbf \t\r\n")
    return inside.startswith(b"{") and b'"cells"' in inside


def _may_be_notebook(path, content):
    return is_notebook(path) or _holds_cells(content)


def _about_file(path, content, notebooks, chosen):
    """What is to be said of a file that is not graded as a notebook."""
    if path.lower().endswith(PACKED):
        return [f"{path}: it was not opened; hand in the files themselves, or a zip of them."]
    name = by_name(PurePosixPath(path).stem, notebooks)
    if name and name[0] not in chosen and not _may_be_notebook(path, content):
        return [f"{path}: it is not the notebook; hand in {name[0]}.ipynb itself."]
    if not chosen and path not in (TIMESTAMP, SECRET) and not _may_be_notebook(path, content):
        return [f"{path}: not graded; it is no notebook."]
    return []


def _helpers(others, chosen, root, problems):
    """{path: bytes} of what notebooks may import or read, as they find it: beside them, and by the name that they use."""
    helpers = {path.removeprefix(f"{root}/") if root else path: content for path, content in others.items()}
    for folder in sorted({_folder(path) for path in chosen} - {root, ""}):
        for path, content in others.items():
            if path.startswith(f"{folder}/"):
                helpers.setdefault(path.removeprefix(f"{folder}/"), content)
    for path in [path for path in helpers if path.endswith(".py")]:
        meant = re.sub(r" ?\(\d+\)\.py$|-Copy\d+\.py$", ".py", path)
        if meant != path and meant not in helpers:
            helpers[meant] = helpers[path]
            problems.append(f"{path}: it was taken for {meant}, too; that is what it should be called.")
    return helpers


def _candidate(path, content, notebooks, problems):
    """The Candidate that a file is, or None, and a problem that says why."""
    filename = PurePosixPath(path).name
    called, numbers = by_name(filename if is_notebook(filename) else PurePosixPath(path).stem, notebooks) or ("", ())
    if called and any(f'"{name}"'.encode() in content for name in notebooks[called].cells):  # not read for this
        return Candidate(path, content, notebooks[called], True, numbers)
    try:
        found = cells(content)
    except Unreadable as unreadable:
        found, holds, why = [], None, str(unreadable)
    else:
        holds, why = meant(found, notebooks), "its cells are those of no notebook of this assignment"
    if called and holds and called != holds and not meant(found, {called: notebooks[called]}):
        problems.append(
            f"{path}: not graded; it holds the cells of {holds}. If it is that notebook, call it {holds}.ipynb."
        )
        return None
    name = called or holds
    if name is None:
        near = difflib.get_close_matches(filename, [f"{released}.ipynb" for released in notebooks], 1, 0.7)
        wanted = near[0] if near else f"one of {', '.join(f'{released}.ipynb' for released in notebooks)}"
        problems.append(
            f"{path}: not graded; no notebook of this assignment has that name, and {why}. Call it {wanted}."
        )
        return None
    return Candidate(path, content, notebooks[name], bool(called), numbers)


def _choose(candidates, notebooks, found):
    """{released name: path} of the one file for each notebook; what becomes of the others is said."""
    chosen = {}
    for name in notebooks:
        found_for = [one for one in candidates if one.released.name == name]
        if not found_for:
            continue
        best = found_for[0] if len(found_for) == 1 else max(found_for, key=lambda one: one.rank)
        chosen[name], found.notebooks[name] = best.path, best.content
        if not best.exact:
            found.problems.append(f"{best.path}: it was taken for {name}.ipynb; that is what it should be called.")
        for other in found_for:
            if other.content != best.content:
                found.problems.append(
                    f"{other.path}: not graded; of {name}.ipynb, {best.path} was. Hand in the one that counts alone."
                )
    return chosen


def _look_for_more(candidates, notebooks, chosen, found):
    """A notebook that came in no file of its own, and whose cells stand in another's."""
    for name, released in notebooks.items():
        holds = [one for one in candidates if name not in chosen and one.holds(released)]
        if holds:
            best = max(holds, key=lambda one: one.rank)
            chosen[name], found.notebooks[name] = best.path, best.content
            found.problems.append(
                f"{best.path}: the cells of {name} stand in it, too, and were graded as {name}.ipynb."
            )


def _root(paths):
    """The folder in which all of these files lie, "" where it is not one."""
    folders = {_folder(path) for path in paths}
    return folders.pop() if len(folders) == 1 else ""


def _folder(path):
    folder = str(PurePosixPath(path).parent)
    return "" if folder == "." else folder
