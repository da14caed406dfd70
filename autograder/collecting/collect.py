"""The path of a download, top to bottom: open it, see which system it is of, sort its files by people, take the newest of each
notebook, and put them into submitted/STUDENT/transforms/ unless something newer, or somebody's own, is there.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable
from contextlib import ExitStack
from dataclasses import dataclass, field
from datetime import datetime, tzinfo
from pathlib import Path

from nbgrader.api import Student
from sqlalchemy import make_url

from ..bridge.gradebook import opened
from ..bridge.nbgrader_api import db_url
from ..course import Course, CourseError
from ..intake.archive import Refused
from ..intake.naming import by_cells, by_name, is_notebook
from . import roster
from .download import Download
from .folder import Came, Folder
from .kept import Kept
from .people import People, Unsure, identifier, same_names
from .piece import Left, Who
from .systems import FORMS, recognised


@dataclass
class Outcome:
    """All that came of a run. left: {download: [Left]}; missing: who of the class has nothing in submitted/ yet;
    unsettled: of whom something was left, so that they have nothing there either; zone: that in which times are shown
    """

    came: list[Came] = field(default_factory=list)
    left: dict[str, list[Left]] = field(default_factory=dict)
    missing: list[str] = field(default_factory=list)
    unsettled: list[str] = field(default_factory=list)
    taken: set[tuple[str, str]] = field(default_factory=set)  # (download, file) that lies in submitted/ now
    zone: tzinfo | None = None
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
    kept, people, outcome = Kept(course), People(FORMS.values()), Outcome(zone=zone)
    introduce(course, people)
    kept.introduce(people)
    for path in lists:
        roster.read(path, people)
    whose_left: set[str] = set()
    with ExitStack() as stack:
        downloads = [stack.enter_context(Download(path)) for path in _separate(paths)]
        found = list(by_download(downloads, people, course.notebooks, system))
        if not system:
            _of_this_assignment(course, found)
        for download, form, view, by_person, left in found:
            for person, whose in by_person.items():
                folder = Folder(course, view, form, kept.files.setdefault(person.id, {}), person, zone, dry_run, left)
                outcome.came.append(folder.take(whose))
                if outcome.came[-1].found and not outcome.came[-1].notebooks and not any(map(_is_zip, whose)):
                    files = "1 file" if len(whose) == 1 else f"{len(whose)} files"
                    outcome.came[-1].say(f"no notebook of this assignment among {files}", look=True)
                who = whose[0][0]
                if _is_perhaps_a_group(person, who, form, people) and not people.members(who.name, form):
                    outcome.came[-1].say(
                        f"perhaps a group's: it came under the name {who.name}; all members get it with a class list "
                        "that has a column group",
                        look=True,
                    )
                outcome.taken |= {(download.name, str(file)) for file in folder.taken}
                outcome.zoneless |= any(piece.time and not piece.time.tzinfo for _, piece in whose)
            outcome.left.setdefault(download.name, []).extend(left)
            whose_left |= {person.id for one in left if one.look for person in _meant(one.whose, form, people)}
    there = {came.student for came in outcome.came}
    if not dry_run:
        _remember(course, people, kept, there)
    with_list = any(person.listed for person in people.all.values())
    in_class = [person.id for person in people.all.values() if person.listed or not with_list]
    missing = sorted(each for each in in_class if each not in there and not course.submitted(each).is_dir())
    outcome.missing = [each for each in missing if each not in whose_left]
    outcome.unsettled = [each for each in missing if each in whose_left]
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


def _of_this_assignment(course, found):
    """Raise CourseError when there is a download with work in it, and none of it is of this assignment."""
    for download, form, view, by_person, _ in found:
        whose = [each for some in by_person.values() for each in some]
        if whose and not any(_is_zip(each) or _is_ours(course, view, each) for each in whose):
            raise CourseError(
                f"{download.name}: this looks like the download of another assignment: no notebook of this one is among its "
                f"files. Nothing was written; --from {form.name} takes it all the same."
            )


def _is_zip(each):
    """Whether a (Who, Piece) may hold notebooks."""
    return each[1].path.suffix.lower() == ".zip"


def _is_ours(course, view, each):
    """Whether a (Who, Piece) is a notebook of this assignment, by its name or else by its cells."""
    _, piece = each
    if not is_notebook(piece.path.name):
        return False
    try:
        return bool(by_name(piece.path.name, course.notebooks) or by_cells(view.read(piece.file), course.notebooks))
    except Refused:
        return False


# --- what is there --------------------------------------------------------------------------------------------------


def _separate(paths):
    """The downloads that are meant: a folder with nothing but zip files of systems' forms in it holds one or several. What one
    has been unpacked into, and called as it is, is not taken a second time.
    """
    for path in paths:
        if not path.exists():
            raise CourseError(f"{path}: there is no such file or folder.")
        inside = [each for each in sorted(path.iterdir()) if not each.name.startswith(".")] if path.is_dir() else []
        zips = [each for each in inside if each.suffix.lower() == ".zip" and each.is_file()]
        unpacked = [each for each in inside if each.is_dir() and each.name in {zipped.stem for zipped in zips}]
        if zips and len(zips) + len(unpacked) == len(inside) and all(map(_is_of_a_system, zips)):
            yield from zips
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


def _meant(whose, form, people):
    """All who may be meant by the words of a Left, by their name or by what they are known by."""
    name, _, rest = whose.removesuffix(")").partition(" (")
    values = {value.removeprefix("no. ").casefold() for value in (name, *rest.split(", ")) if value}
    for person in people.all.values():
        known = {value.casefold() for some in person.keys.values() for value in some} | {person.id.casefold()}
        if name and people.called(person, name, form) or known & values:
            yield person


def _is_perhaps_a_group(person, who, form, people):
    """Whether a file has another name than the person whose number it has: Canvas names one member of a group so."""
    return form.name == "canvas" and bool(who.name and person.variants()) and not people.called(person, who.name, form)


def _helps(form):
    return "Moodle's grading worksheet, or " if form.name == "moodle" else ""


def _called(who):
    if called := identifier(who):
        return called
    raise Unsure("it says nobody's name; give a list with --students that tells who this is")


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
