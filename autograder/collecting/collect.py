"""The path of a download, top to bottom: open it, see which system it is of, sort its files by people, take the newest of each
notebook, and put them into submitted/STUDENT/transforms/ unless something newer, or somebody's own, is there.
"""

import os
from collections import defaultdict
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from dataclasses import dataclass, field
from datetime import UTC, datetime, tzinfo
from pathlib import Path, PurePosixPath

from nbgrader.api import Student
from sqlalchemy import make_url

from ..bridge.gradebook import opened
from ..bridge.nbgrader_api import db_url
from ..course import Course, CourseError
from ..files import replace
from ..intake.archive import Refused
from ..intake.naming import by_name, has_work, is_notebook, meant
from ..intake.reading import Unreadable, cells
from ..intake.submission import SECRET, TIMESTAMP
from . import roster
from .download import Download
from .kept import Kept, Origin, digest
from .people import People, Unsure, identifier, same_names
from .piece import Form, Left, Piece, Who
from .systems import FORMS, recognised

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
    remarks: list[str] = field(default_factory=list)
    look: bool = False  # whether a remark asks for something to be done

    def say(self, remark: str, look: bool = False) -> None:
        self.remarks.append(remark)
        self.look |= look


@dataclass
class Outcome:
    """All that came of a run. left: {download: [Left]}; missing: who of the class has nothing in submitted/ yet"""

    came: list[Came] = field(default_factory=list)
    left: dict[str, list[Left]] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)
    taken: set[tuple[str, str]] = field(default_factory=set)  # (download, file) that lies in submitted/ now
    zoneless: bool = False  # whether there were times in a server's local time


def collect(
    course: Course,
    paths: Iterable[Path],
    lists: Iterable[Path] = (),
    system: str | None = None,
    zone: tzinfo | None = None,
    dry_run: bool = False,
    busy: Callable[[], None] = lambda: None,
) -> Outcome:
    """Sort downloads into submitted/; raises CourseError when one cannot be read, before anything is written.

    lists: class lists; system: the name of a form, where it cannot be seen; zone: that of the LMS's server (default: this
    machine's); dry_run: write nothing; busy: called when it has to wait for another run, which may be grading
    """
    if (course.root / "submitted").is_dir():
        with course.one_grader_at_a_time(busy):
            return _collect(course, paths, lists, system, zone, dry_run)
    return _collect(course, paths, lists, system, zone, dry_run)


def _collect(course, paths, lists, system, zone, dry_run):
    kept, people, outcome = Kept(course), People(FORMS.values()), Outcome()
    introduce(course, people)
    kept.introduce(people)
    for path in lists:
        roster.read(path, people)
    with ExitStack() as stack:
        downloads = [stack.enter_context(Download(path)) for path in _separate(paths)]
        for download, form, view, by_person, left in by_download(downloads, people, list(course.notebooks), system):
            for person, whose in by_person.items():
                folder = Folder(course, view, form, kept.files.setdefault(person.id, {}), person, zone, dry_run, left)
                outcome.came.append(folder.take(whose))
                if _is_perhaps_a_group(person, whose[0][0], form, people):
                    outcome.came[-1].say(
                        f"perhaps a group's: it came under the name {whose[0][0].name}; all members get it with a class list "
                        "that has a column group",
                        look=True,
                    )
                outcome.taken |= {(download.name, str(file)) for file in folder.taken}
                outcome.zoneless |= any(piece.time and not piece.time.tzinfo for _, piece in whose)
            outcome.left.setdefault(download.name, []).extend(left)
    there = {came.student for came in outcome.came}
    if not dry_run:
        _remember(course, people, kept, there)
    with_list = any(person.listed for person in people.all.values())
    in_class = [person.id for person in people.all.values() if person.listed or not with_list]
    outcome.missing = sorted(each for each in in_class if each not in there and not course.submitted(each).is_dir())
    return outcome


def by_download(downloads, people, notebooks, system=None):
    """(download, form, view, {Person: [(Who, Piece)]}, [Left]) of each, the one made last at the end: of two, it counts.

    All are recognised before the first is sorted; raises CourseError when one is not.
    """
    known = [(download, *recognised(download, system)) for download in downloads]
    for download, form, view in sorted(known, key=lambda each: each[0].made or datetime.min):
        found = form.sort(view, notebooks, people)
        left = [Left(problem.rstrip(".").replace(": left out; ", ": ")) for problem in download.problems] + found.left
        yield download, form, view, _by_person(found.pieces, form, people, left), left


# --- what is there --------------------------------------------------------------------------------------------------


def _separate(paths):
    """The downloads that are meant: a folder with nothing but zip files of systems' forms in it holds several."""
    for path in paths:
        if not path.exists():
            raise CourseError(f"{path}: there is no such file or folder.")
        inside = [each for each in sorted(path.iterdir()) if not each.name.startswith(".")] if path.is_dir() else []
        if len(inside) > 1 and all(each.suffix.lower() == ".zip" and each.is_file() for each in inside):
            if all(map(_is_of_a_system, inside)):
                yield from inside
                continue
        yield path


def _is_of_a_system(path):
    try:
        with Download(path) as download:
            return recognised(download)[0].name != "plain"
    except CourseError:
        return False


def introduce(course, people):
    """Tell `people` who is in nbgrader's table, if there is one."""
    if not _has_gradebook(course):
        return
    with opened(course) as gradebook:
        for student in gradebook.students:
            person = people.all.get(student.id) or people.add(student.id)
            person.first, person.last = student.first_name or "", student.last_name or ""
            person.learn(Who(email=student.email or "", lms_id=student.lms_user_id or ""))
            people.learned(person)


def _has_gradebook(course):
    """A gradebook in SQLite would be made by looking for it."""
    url = make_url(db_url(course))
    return url.get_backend_name() != "sqlite" or bool(url.database and Path(url.database).exists())


def _by_person(pieces, form, people, left):
    """{Person: [(Who, Piece)]}; what is nobody's for sure is put into `left`."""
    found, unknown, persons = defaultdict(list), defaultdict(list), {}
    everybody = {who for piece in pieces for who in piece.whose}
    twins, with_list = same_names(everybody, form), any(person.listed for person in people.all.values())
    for who in sorted(everybody, key=lambda who: (str(who), who.number)):
        try:
            persons[who] = _persons(who, form, people, with_list, twins.get(who, ()))
        except Unsure as unsure:
            persons[who] = str(unsure)
    for piece in pieces:
        for who in piece.whose:
            if isinstance(persons[who], str):
                unknown[who, persons[who]].append(str(piece.file))
            else:
                for person in persons[who]:
                    found[person].append((who, piece))
    left += [Left(why, tuple(files), str(who)) for (who, why), files in unknown.items()]
    return dict(sorted(found.items(), key=lambda each: each[0].id))


def _persons(who, form, people, with_list, twins):
    """The Persons whose work this is: one, or all members of a group; raises Unsure.

    twins: others of that name in the same download
    """
    if members := people.members(who.name, form) if who.name else []:
        return members
    if who.group:
        raise Unsure(
            "a group's work, and the download does not say who is in it; give a class list with a column group"
        )
    person = people.find(who, form, by_name=not twins)
    tells = (
        f"give a list with --students that does ({_helps(form)}columns id,number, and a row STUDENT,NUMBER for each)"
    )
    if person is None and twins:
        raise Unsure(
            "several people in this download have one name, or one has come under two numbers; the download does not say who "
            f"is who: {tells}"
        )
    if person is None and who.number and not (who.name or who.login):
        raise Unsure(f"the download does not say who this is: {tells}")
    if person is None and with_list:
        raise Unsure("the class list has nobody who is known by this; add a row for them, or what is missing in theirs")
    if person is None:
        person = people.add(_called(who))
    if not _is_perhaps_a_group(person, who, form, people):
        person.learn(who, form.name)
        people.learned(person)
    return [person]


def _is_perhaps_a_group(person, who, form, people):
    """Whether a file has another name than the person whose number it has: Canvas names one member of a group so."""
    return form.name == "canvas" and bool(who.name and person.variants()) and not people.called(person, who.name, form)


def _helps(form):
    return "Moodle's grading worksheet, or " if form.name == "moodle" else ""


def _called(who):
    if called := identifier(who):
        return called
    raise Unsure("no folder can be called so; give a list with --students that tells who this is")


# --- one student ----------------------------------------------------------------------------------------------------


@dataclass
class _Candidate:
    """A file that may be put at a place, and what speaks for it: the later, the order, work in it, the notebook's own name."""

    piece: Piece
    who: Who
    digest: str
    time: datetime | None
    worked: bool
    exact: bool

    @property
    def when(self):
        return self.time or datetime.min.replace(tzinfo=UTC), self.piece.order


class Folder:
    """Puts what came of one student into their folder, and says what it did."""

    def __init__(self, course, download, form, known, person, zone, dry_run, left):
        self.course, self.download, self.form, self.zone, self.dry_run, self.left = (
            course,
            download,
            form,
            zone,
            dry_run,
            left,
        )
        self.folder = course.submitted(person.id)
        self.known = known  # {path: Origin} of what was collected before
        self.came = Came(person.id, Who(), form)
        self.taken: set[PurePosixPath] = set()

    def take(self, pieces) -> Came:
        """Write what is new; pieces: [(Who, Piece)]"""
        self.came.who = pieces[0][0]
        chosen = self.chosen(pieces)
        for place, candidate in sorted(chosen.items()):
            self._put(place, candidate)
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
            place, candidate = self._look_at(who, piece)
            if candidate:
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
        """(place, _Candidate) of a piece; (place, None) when it is not taken, which is said."""
        path = piece.path
        place, worked = str(path), True
        if path.parts[0].startswith(".") or any(part.startswith(".") for part in path.parts):
            self._pass(piece, "its name begins with a dot: a tool's own file")
            return place, None
        if place in (TIMESTAMP, SECRET):
            self._pass(piece, "its name is one that nbgrader gives; what a student writes into it does not count")
            return place, None
        if any(len(part.encode()) > LONGEST_NAME for part in path.parts):
            self._pass(piece, "its name is too long for a file")
            return place, None
        try:
            content = self.download.read(piece.file)
        except Refused as refused:
            self._pass(piece, str(refused))
            return place, None
        if is_notebook(path.name) and (name := self._notebook(content, path.name)):
            place, worked = f"{name[0]}.ipynb", name[1]
        return place, _Candidate(piece, who, digest(content), self._utc(piece.time), worked, path.name == place)

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
        seen = {best.digest}
        for other in reversed(others):
            self.taken.add(other.piece.file) if other.digest in seen else None
            if other.digest in seen:
                continue
            seen.add(other.digest)
            if other.when < best.when:
                self._leave(other, f"{place} was handed in again, and the newer one counts", look=False)
            else:
                why = "nothing says which is newer"
                self._leave(other, f"there are several files of {place} and {why}; {best.piece.path} was taken")
                self.came.say(f"several files of {place}, and {why}: {best.piece.path} was taken", look=True)

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
                self._write(place, self.download.read(candidate.piece.file))
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


# --- what is remembered ---------------------------------------------------------------------------------------------


def _remember(course, people, kept, came):
    """Write who is who into nbgrader's table, which never loses what it has, and into the memory of `collect`."""
    persons = [person for person in people.all.values() if person.listed or person.id in came]
    if came:
        for person in persons:
            if person.id in came:
                kept.remember(person)
        kept.write()
    news = []
    for person in persons:
        told = {"first_name": person.first, "last_name": person.last, "email": person.known("email")}
        news.append((person.id, told | {"lms_user_id": person.known("lms_id")}))
    if not news:
        return
    with opened(course) as gradebook:  # in one step: a step for each student would take half the time of a run
        there = {student.id: student for student in gradebook.students}
        for identifier, told in news:
            student = there.get(identifier) or Student(id=identifier)
            for name, value in told.items():
                if value and not getattr(student, name):
                    setattr(student, name, value)
            gradebook.db.add(student)
        gradebook.db.commit()
