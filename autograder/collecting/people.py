"""Who is who: the people of a course, whatever a class list, nbgrader's table and earlier downloads know of them.

Somebody is found by what belongs to one person alone (a login, an address, a number); else by a name, written as the system
at hand writes names, when one person has it and nothing else speaks against it. Nobody is guessed at.
"""

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field

from ..names import LONGEST, odd
from .piece import Form, Found, Who, plainly

KINDS = ("login", "email", "lms_id", "sid", "number")


LISTS = Form("list", "a class list", lambda _: 0.0, lambda *_: Found([], []), plainly)


class Unsure(ValueError):
    """It cannot be said who somebody is; the message says why, and what to do."""


@dataclass(eq=False)
class Person:
    """Somebody of the course.

    id: what nbgrader knows them by, and their folder in submitted/; keys: {kind: what they are known by}; names: as "Last,
    First" or in full; written: {form: names as its downloads write them}; groups: what they are members of; listed: whether
    a class list has them
    """

    id: str
    first: str = ""
    last: str = ""
    names: set[str] = field(default_factory=set)
    keys: dict[str, set[str]] = field(default_factory=lambda: {kind: set() for kind in KINDS})
    written: dict[str, set[str]] = field(default_factory=dict)
    groups: set[str] = field(default_factory=set)
    listed: bool = False

    def known(self, kind: str) -> str:
        """What they are known by, or ""."""
        return min(self.keys[kind], default="")

    def variants(self) -> set[str]:
        """Their names in the orders in which names are written."""
        found = self.names.union(*self.written.values())
        if self.first or self.last:
            found.add(f"{self.last}, {self.first}" if self.first and self.last else self.last or self.first)
        for name in list(found):
            last, comma, first = name.partition(", ")
            if comma:
                found |= {f"{first} {last}", f"{last} {first}"}
            else:
                words = name.split()
                found |= {f"{' '.join(words[i:])}, {' '.join(words[:i])}" for i in range(1, len(words))}
        return found

    def learn(self, who: Who, form: str = "") -> None:
        """Remember what a class list says, or the download of a form: its numbers may mean something there alone."""
        for kind in KINDS:
            if value := getattr(who, kind):
                self.keys[kind].add(f"{form} {value}" if form and kind == "number" else value)
        if who.name and not who.group:
            (self.written.setdefault(form, set()) if form else self.names).add(who.name)


class People:
    """All Persons, {id: Person}, and ways to find them; `forms` are the systems whose downloads write names in their ways."""

    def __init__(self, forms: Iterable[Form] = ()):
        self.all: dict[str, Person] = {}
        self._forms = {form.name: form for form in (*forms, LISTS)}
        self._by_name: dict[str, dict[str, set[str]]] = {}  # of each form: {name as it writes it: ids}
        self._by_key: dict[str, dict[str, set[str]]] = {kind: defaultdict(set) for kind in KINDS}

    def add(self, identifier: str) -> Person:
        """A new Person; raises Unsure when there is one whose id differs in capitals at most: a folder's name has to be one."""
        if same := next((known for known in self.all if known.casefold() == identifier.casefold()), None):
            raise Unsure(
                f"there is already another student {same}; give a class list with --students that tells them apart"
            )
        self.all[identifier] = Person(identifier)
        self.learned(self.all[identifier])
        return self.all[identifier]

    def learned(self, person: Person) -> None:
        """To be called after a Person has learned something."""
        for kind, index in self._by_key.items():
            for known in _of(person, kind):
                index[known.casefold()].add(person.id)
        for name in self._by_name:
            self._index_names(person, self._forms[name])

    def values(self, kind: str) -> set[str]:
        """All that somebody is known by, of one kind; a student's id may be a login."""
        return {value for person in self.all.values() for value in _of(person, kind)}

    def knows(self, kind: str, value: str) -> bool:
        return bool(self._known_by(kind, value))

    def fits(self, kind: str, value: str, name: str, form: Form) -> bool:
        """Whether somebody is known by that, and has that name."""
        return any(self.called(person, name, form) for person in self._known_by(kind, value))

    def sortable(self) -> set[str]:
        """All names of all people in the form "Last, First"."""
        return {name for person in self.all.values() for name in person.variants() if ", " in name}

    def members(self, name: str, form: Form) -> list[Person]:
        """The members of a group of this name."""
        grouped = [person for person in self.all.values() if person.groups]
        return [person for person in grouped if form.folded(name) in map(form.folded, person.groups)]

    def find(self, who: Who, form: Form, by_name: bool = True) -> Person | None:
        """The Person that a download or a list means, or None; raises Unsure. by_name: whether a name alone is enough"""
        sure = {}
        for kind in KINDS:
            if not (value := getattr(who, kind)):
                continue
            for person in self._known_by(kind, value, form):
                # such a number may be a group's, or one of another download: the name has to be the same
                if kind != "number" or not who.name or not person.variants() or self.called(person, who.name, form):
                    sure[person.id] = person
        if len(sure) > 1:
            raise Unsure(f"it fits several people: {_listed(sure)}; one of them has a wrong entry in the class list")
        if sure:
            return sure.popitem()[1]
        if not who.name or not by_name:
            return None
        same = {person.id: person for person in self.named(who.name, form) if not _contradicts(person, who, form)}
        if len(same) > 1:
            raise Unsure(f"several people have this name: {_listed(same)}; {_what_to_write(who)}")
        return same.popitem()[1] if same else None

    def _known_by(self, kind, value, form=None):
        wanted = [value.casefold()] + ([f"{form.name} {value}".casefold()] if form else [])
        return [self.all[known] for key in wanted for known in sorted(self._by_key[kind].get(key, ()))]

    def named(self, name: str, form: Form) -> list[Person]:
        """Those who have a name, as a system writes it."""
        if form.name not in self._by_name:
            self._by_name[form.name] = defaultdict(set)
            for person in self.all.values():
                self._index_names(person, form)
        return [self.all[known] for known in sorted(self._by_name[form.name].get(form.folded(name), ()))]

    def _index_names(self, person, form):
        for variant in person.variants():
            self._by_name[form.name][form.folded(variant)].add(person.id)

    def listed_as(self, listed: Person) -> Person | None:
        """Who is known by nothing but a download's way of writing that name, of which a class list now tells all."""
        found = {
            person.id: person
            for person in self.all.values()
            for name, written in person.written.items()
            if name in self._forms and not _contradict(person, listed)
            if set(map(self._forms[name].folded, written)) & set(map(self._forms[name].folded, listed.variants()))
        }
        if len(found) > 1:
            raise Unsure(
                f"several students have this name: {_listed(found)}; give the list a column id with one of these"
            )
        return found.popitem()[1] if found else None

    def called(self, person: Person, name: str, form: Form) -> bool:
        """Whether a name, as a system writes it, is this person's."""
        return form.folded(name) in map(form.folded, person.variants())


def identifier(who: Who) -> str:
    """The student id of somebody whom nothing is known of but `who`, or "" for nobody; raises Unsure as `folder_name`."""
    return folder_name(who.folder or who.login or who.email or who.lms_id or who.sid or who.name)


def folder_name(text: str) -> str:
    """A text as the name of a student's folder, and as a student's id; raises Unsure when that is none (`names.odd`)."""
    text = unicodedata.normalize("NFC", text).strip()
    text = re.sub(r"^[.-]+\s+", "", text)  # in place of a first name that nobody has
    if text and (problem := odd(re.sub(r"[/\\]", "_", text)[:LONGEST].strip())):
        raise Unsure(f"no folder can be called {text!r}: {problem}; give a list with --students that tells who this is")
    return re.sub(r"[^\w.@+'-]", "_", re.sub(r",\s+", "_", text)).lstrip("_")[:LONGEST].rstrip(".")


def _contradicts(person, who, form):
    """Whether something is known of both that should be the same and is not."""
    for kind in KINDS:
        known, value = {each.casefold() for each in person.keys[kind]}, getattr(who, kind).casefold()
        if kind == "number":
            of_lists = form is LISTS
            known = {each for each in known if each.startswith(f"{form.name} ") or of_lists and " " not in each}
            value = value if of_lists or not value else f"{form.name} {value}"
        if known and value and value not in known:
            return True
    return False


def _contradict(one, other):
    """Whether both are known by something of a kind, and by nothing that is the same."""
    return any(
        one.keys[kind] and other.keys[kind] and not one.keys[kind] & other.keys[kind]
        for kind in KINDS
        if kind != "number"
    )


def _of(person, kind):
    """What a person is known by; the id may be a login or an address."""
    return person.keys[kind] | ({person.id} if kind in ("login", "email") else set())


def _listed(people):
    return ", ".join(sorted(people))


def _what_to_write(who):
    kind = next((kind for kind in ("login", "email", "lms_id", "sid", "number") if getattr(who, kind)), None)
    if not kind:
        return "nothing in this download tells them apart"
    column = "lms_user_id" if kind == "lms_id" else kind
    return f"write into a CSV for --students who this is: columns id,{column}, and a row STUDENT,{getattr(who, kind)}"


def same_names(whose: set[Who], form: Form) -> dict[Who, list[Who]]:
    """{Who: others of the same name in this download, who may be other people}, of those known by name and number alone."""
    by_name = defaultdict(list)
    for who in whose:
        if who.name and not (who.login or who.email or who.lms_id or who.sid or who.folder):
            by_name[plainly(form.folded(who.name))].append(who)
    return {
        who: [other for other in some if other != who]
        for some in by_name.values()
        if len({who.number for who in some}) > 1
        for who in some
    }
