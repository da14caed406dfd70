"""What `collect` remembers from one run to the next: who is who, and which file it has put where.

It is kept in submitted/.collected.json, a name that neither the grader nor nbgrader takes for a student's. A file that is still
as it was written may be replaced by a newer one; another is somebody's own work, and stays.
"""

import hashlib
import json
from dataclasses import dataclass
from datetime import datetime

from ..course import Course, CourseError
from ..files import replace
from .people import KINDS, People, Person

NAME = ".collected.json"


@dataclass(frozen=True)
class Origin:
    """Where a file came from: its digest, the form of the download, when it was handed in, the order that the system gives
    its files, and when the download was made; times as ISO 8601, "" where nothing is known.
    """

    digest: str
    form: str
    time: str = ""
    order: tuple = ()
    made: str = ""

    def only_by_download(self, other: "Origin") -> bool:
        """Whether nothing but when the downloads were made tells which of two is older."""
        return not (self.time and other.time or self.form == other.form and self.order and other.order)

    def is_older(self, other: "Origin") -> bool:
        """Whether this is known to be older work than the other."""
        if self.time and other.time:
            return datetime.fromisoformat(self.time) < datetime.fromisoformat(other.time)
        if self.form == other.form and self.order and other.order:
            return self.order < other.order
        return bool(self.made and other.made) and self.made < other.made


def digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


class Kept:
    """The memory of a course; raises CourseError where it cannot be read. files: {student: {path: Origin}}"""

    def __init__(self, course: Course):
        self.path = course.root / "submitted" / NAME
        self.files: dict[str, dict[str, Origin]] = {}
        self._people: dict[str, dict] = {}
        self._text = self.path.read_text(encoding="utf-8") if self.path.exists() else ""
        try:
            raw = json.loads(self._text or "{}")
            for student, files in raw.get("files", {}).items():
                self.files[student] = {
                    path: Origin(**{**one, "order": _tuple(one["order"])}) for path, one in files.items()
                }
            self._people = {student: dict(told) for student, told in raw.get("people", {}).items()}
        except (ValueError, TypeError, KeyError, AttributeError):
            raise CourseError(
                f"submitted/{NAME} is damaged; it tells which files `collect` has put into submitted/. Move it away and run the "
                "command again: what is there then counts as yours, and stays."
            ) from None

    def introduce(self, people: People) -> None:
        """Tell `people` who came in earlier downloads."""
        for student, told in self._people.items():
            person = people.all.get(student) or people.add(student)
            for kind in KINDS:
                person.keys[kind] |= set(told.get(kind, ()))
            for form, names in told.get("written", {}).items():
                person.written.setdefault(form, set()).update(names)
            people.learned(person)

    def remember(self, person: Person) -> None:
        known = {kind: sorted(person.keys[kind] - {person.id}) for kind in KINDS}
        told = {kind: values for kind, values in known.items() if values}
        written = {form: sorted(names) for form, names in sorted(person.written.items())}
        self._people[person.id] = told | ({"written": written} if written else {})

    def write(self) -> None:
        """Write it, if anything is new."""
        files = {
            student: {path: vars(origin) for path, origin in sorted(files.items())}
            for student, files in sorted(self.files.items())
        }
        text = json.dumps({"people": dict(sorted(self._people.items())), "files": files}, ensure_ascii=False, indent=1)
        if text != self._text:
            self.path.parent.mkdir(exist_ok=True)
            replace(self.path, text)


def _tuple(raw):
    return tuple(_tuple(each) if isinstance(each, list) else each for each in raw)
