"""One student's folder in submitted/: of all that came of them, the newest of each notebook, unless something better is there."""

import os
from collections import defaultdict
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import PurePosixPath

from ..files import replace
from ..intake.archive import Refused, contents
from ..intake.naming import by_name, has_work, is_notebook, meant
from ..intake.reading import Unreadable, cells
from ..intake.sorting import PACKAGE
from ..intake.submission import SECRET, TIMESTAMP
from .kept import Origin, digest
from .piece import Form, Left, Piece, Who

TIME = "%Y-%m-%d %H:%M:%S.%f UTC"  # as `nbgrader submit` writes it, and reads it back
LONGEST_NAME = 240  # bytes of a file's name; it is written under a longer one first


@dataclass
class Came:
    """What came of one student's work in one download.

    notebooks: those that the download has; written: the files that are new or newer; time: of the newest of them
    """

    student: str
    who: Who
    form: Form
    notebooks: list[str] = field(default_factory=list)
    written: list[str] = field(default_factory=list)
    time: datetime | None = None
    late: bool = False
    found: bool = False  # whether any of the files could be read and taken
    remarks: list[str] = field(default_factory=list)
    look: bool = False  # whether a remark asks for something to be done

    def say(self, remark: str, look: bool = False) -> None:
        self.remarks.append(remark)
        self.look |= look


@dataclass
class _Candidate:
    """A file that may be put at a place, and what speaks for it: the later, the order, work in it, the notebook's own name."""

    piece: Piece
    who: Who
    digest: str
    time: datetime | None
    worked: bool
    exact: bool
    inside: str = ""  # its path in the zip file that the piece is

    @property
    def when(self):
        return self.time or datetime.min.replace(tzinfo=UTC), self.piece.order


class Folder:
    """Puts what came of one student into their folder, and says what it did."""

    def __init__(self, course, download, form, known, person, zone, dry_run, left):
        self.course, self.download, self.form, self.left = course, download, form, left
        self.zone, self.dry_run = zone, dry_run
        self.folder = course.submitted(person.id)
        self.known = known  # {path: Origin} of what was collected before
        self.came = Came(person.id, Who(), form)
        self.taken: set[PurePosixPath] = set()
        # {(when the download was made, and the one before): places} of what is replaced on no other ground
        self.replaced: dict[tuple[str, str], list[str]] = defaultdict(list)

    def take(self, pieces) -> Came:
        """Write what is new; pieces: [(Who, Piece)]"""
        self.came.who = pieces[0][0]
        chosen = self.chosen(pieces)
        self.came.found = bool(chosen)
        for place, candidate in sorted(chosen.items()):
            self._put(place, candidate)
        for (made, before), places in self.replaced.items():
            how = "would be replaced" if self.dry_run else "replaced"
            self.came.say(
                f"{', '.join(places)} {how}: the download of {_day(made)} counts as newer than that of {_day(before)}; "
                "`--dry-run` shows this before it is done"
            )
        times = [candidate.time for candidate in chosen.values() if candidate.time]
        self.came.late = any(candidate.piece.late for candidate in chosen.values())
        if times:
            self.came.time = max(times)
            self._stamp(self.came.time)
        return self.came

    def chosen(self, pieces):
        """{place in the student's folder: the _Candidate for it}"""
        offered = defaultdict(list)
        for who, piece in pieces:
            for place, candidate in self._look_at(who, piece):
                offered[place.casefold()].append((place, candidate))
        chosen = {}
        for some in offered.values():
            some.sort(key=lambda each: (each[1].when, each[1].worked, each[1].exact))
            place, best = some[-1]
            if any(place.startswith(f"{other}/") or other.startswith(f"{place}/") for other in chosen):
                self._leave(best, f"another file's folder is called {place}")
                continue
            chosen[place] = best
            self._compare(place, best, [candidate for _, candidate in some[:-1]])
        return chosen

    def _look_at(self, who, piece):
        """[(place, _Candidate) of what a piece holds]; none when it is not taken, which is said."""
        path = piece.path
        if path.parts[0].startswith(".") or any(part.startswith(".") for part in path.parts):
            self._pass(piece, "its name begins with a dot: a tool's own file")
            return []
        if str(path) in (TIMESTAMP, SECRET):
            self._pass(piece, "its name is one that nbgrader gives; what a student writes into it does not count")
            return []
        if any(len(part.encode()) > LONGEST_NAME for part in path.parts):
            self._pass(piece, "its name is too long for a file")
            return []
        try:
            content = self.download.read(piece.file)
        except Refused as refused:
            self._pass(piece, str(refused))
            return []
        files = unpacked(content) if path.suffix.lower() == ".zip" else {}
        found = [self._candidate(who, piece, inside, entry) for inside, entry in files.items()]
        if any(place.removesuffix(".ipynb") in self.course.notebooks for place, _ in found):
            return found
        return [self._candidate(who, piece, "", content)]  # any other zip is the intake's to speak of

    def _candidate(self, who, piece, inside, content):
        place, worked = inside or str(piece.path), True
        filename = PurePosixPath(place).name
        if is_notebook(filename) and (name := self._notebook(content, filename)):
            place, worked = f"{name[0]}.ipynb", name[1]
        exact = filename == place
        return place, _Candidate(piece, who, digest(content), self._utc(piece.time), worked, exact, inside)

    def _content(self, candidate):
        content = self.download.read(candidate.piece.file)
        return unpacked(content)[candidate.inside] if candidate.inside else content

    def _utc(self, time):
        """A time of a download in UTC; None for one that no calendar has."""
        if time is None:
            return None
        try:
            return (time.replace(tzinfo=self.zone) if self.zone and not time.tzinfo else time).astimezone(UTC)
        except (OverflowError, ValueError, OSError):
            return None

    def _notebook(self, content, filename):
        """(the released notebook that a file is, whether anything was done in it); None for another one."""
        notebooks = self.course.notebooks
        try:
            found = cells(content)
        except Unreadable:
            found = []
        name = meant(found, notebooks) if found else None
        if name is None:
            called = by_name(filename, notebooks)
            name = called[0] if called else None
        return (name, has_work(found, notebooks[name])) if name else None

    def _compare(self, place, best, others):
        """Say what the other candidates for a place were."""
        seen, several = {best.digest}, []
        for other in reversed(others):
            self.taken.add(other.piece.file) if other.digest in seen else None
            if other.digest in seen:
                continue
            seen.add(other.digest)
            if other.when < best.when:
                self._leave(other, f"{place} was handed in again, and the newer one counts", look=False)
            else:
                why = "nothing says which is newer"
                taken = _told_apart([best, other])[0]
                self._leave(other, f"there are several files of {place} and {why}; {taken} was taken")
                several.append(other)
        if several:
            paths = _told_apart([best, *several])
            why = "nothing says which is newer"
            self.came.say(f"several files of {place} ({', '.join(paths)}), and {why}: {paths[0]} was taken", look=True)

    def _leave(self, candidate, why, look=True):
        self.left.append(Left(why, (str(candidate.piece.file),), str(candidate.who), look))

    def _pass(self, piece, why):
        self.left.append(Left(why, (str(piece.file),), str(self.came.who), look=not piece.path.name.startswith(".")))

    def _put(self, place, candidate):
        """Write a file, unless what is there is newer, or somebody's own."""
        new = Origin(
            candidate.digest,
            self.form.name,
            candidate.time.isoformat() if candidate.time else "",
            candidate.piece.order,
            self.download.made.isoformat() if self.download.made else "",
        )
        if self._may_write(place, new, candidate):
            if not self.dry_run:
                self._write(place, self._content(candidate))
            self.came.written.append(place)
        if place.removesuffix(".ipynb") in self.course.notebooks:
            self.came.notebooks.append(place.removesuffix(".ipynb"))

    def _may_write(self, place, new, candidate):
        old, there = self.known.get(place), self._there(place)
        if there is None:
            self.known[place] = new
            self.taken.add(candidate.piece.file)
            return True
        if there == new.digest:
            if old is None or old.digest != new.digest or old.is_older(new):
                self.known[place] = new
            self.taken.add(candidate.piece.file)
            return False
        if there == "":
            self._leave(candidate, f"{self._name(place)} is no file, or lies behind a link")
            self.came.say(f"{place} was not taken", look=True)
        elif old is None or there != old.digest:
            if old and old.digest == new.digest:  # nothing new has come
                self._leave(candidate, f"{self._name(place)} was changed since it was collected, and stays", look=False)
                self.came.say(f"{place} was changed here, and stays")
            else:
                how = "was changed since it was collected" if old else "did not come by `collect`"
                self._leave(
                    candidate, f"{self._name(place)} {how}, and stays; to take this one, move that away and run again"
                )
                self.came.say(f"{place} {how}, and stays", look=True)
        elif new.is_older(old):
            self._leave(candidate, f"{self._name(place)} is newer, and stays", look=False)
            self.came.say(f"an older {place} was not taken")
        else:
            if new.only_by_download(old):
                self.replaced[new.made, old.made].append(place)
            self.known[place] = new
            self.taken.add(candidate.piece.file)
            return True
        return False

    def _stamp(self, time):
        """Write when the newest work was handed in, as nbgrader does."""
        content = f"{time.strftime(TIME)}\n".encode()
        new = Origin(digest(content), self.form.name, time.isoformat())
        old, there = self.known.get(TIMESTAMP), self._there(TIMESTAMP)
        if there is not None and (old is None or there != old.digest or not old.is_older(new)):
            return
        self.known[TIMESTAMP] = new
        if not self.dry_run:
            self._write(TIMESTAMP, content)
        self.came.written.append(TIMESTAMP)

    def _there(self, place):
        """The digest of what is at a place: None for nothing, "" for what is no file below submitted/."""
        path = self.folder / place
        submitted = (self.course.root / "submitted").resolve()
        above = next(each for each in path.parents if os.path.lexists(each) or each == self.course.root)
        if not (above.resolve().is_relative_to(submitted) or above == self.course.root) or not above.is_dir():
            return ""
        if not os.path.lexists(path):
            return None
        return digest(path.read_bytes()) if path.is_file() and not path.is_symlink() else ""

    def _name(self, place):
        return (self.folder / place).relative_to(self.course.root)

    def _write(self, place, content):
        path = self.folder / place
        path.parent.mkdir(parents=True, exist_ok=True)
        replace(path, content)


def unpacked(content: bytes) -> dict[str, bytes]:
    """{path: bytes} of what a student has packed, without the folder that all of it lies in; {} when it cannot be read.

    The students' package is nobody's work.
    """
    try:
        files, _ = contents(content)
    except Refused:
        return {}
    files = {path: entry for path, entry in files.items() if PACKAGE not in PurePosixPath(path).parts}
    while files and len({path.partition("/")[0] for path in files}) == 1 and all("/" in path for path in files):
        files = {path.partition("/")[2]: entry for path, entry in files.items()}
    return files


def _day(made):
    return made[:16].replace("T", " ") or "an unknown day"


def _told_apart(candidates):
    """The paths of files in the submission; in the download, where those are the same."""
    paths = [str(one.piece.path / one.inside) for one in candidates]
    if len(set(paths)) == len(paths):
        return paths
    files = [(one.piece.file / one.inside).parts for one in candidates]
    same = next((i for i, parts in enumerate(zip(*files)) if len(set(parts)) > 1), 0)
    return ["/".join(parts[same:]) for parts in files]
