"""Class lists: CSV files as LMSs and nbgrader export them, each known by the names of its columns.

Canvas's gradebook (Student, ID, SIS User ID, SIS Login ID) and its export of a group set, Moodle's participants and grading
worksheet, Blackboard's, Brightspace's and Sakai's grades, Gradescope's and GitHub Classroom's roster, nbgrader's own
(id,first_name,last_name,email,lms_user_id); or one of your own with some of these columns. Where a person is found in several,
what they say is put together.
"""

import csv
import re
from pathlib import Path

from ..course import CourseError
from .people import KINDS, LISTS, People, Person, Unsure, folder_name
from .piece import Who

# What a column is called, in small letters: {what it says: names}. A column `id` is looked at in `_heads`.
COLUMNS = {
    "id": "student_id",
    "login": "sis login id; login id; login_id; login; username; user name; user_name; display id; eid; benutzername; "
    "anmeldename; nom d'utilisateur; nombre de usuario; github_username",
    "email": "email; email address; e-mail; e-mail address; email_address; mail; e-mail-adresse; adresse de courriel; "
    "dirección de correo; indirizzo email",
    "first": "first name; first_name; firstname; given name; vorname; prénom; nombre; nome",
    "last": "last name; last_name; lastname; surname; family name; nachname; nom; nom de famille; apellido(s); cognome",
    "name": "name; full name; fullname; student; student name; vollständiger name; nom complet; nombre completo",
    "lms_id": "lms_user_id; canvas_user_id; canvas user id",
    "sid": "sis user id; sis_user_id; id number; idnumber; id-nummer; orgdefinedid; org defined id; sid; student id; "
    "matrikelnummer; numéro d'identification; número de id",
    "number": "number; participant; identifier; id.; kennung; identifikator; identifiant; identificador",
    "group": "group; groups; group_name; group name; team; gruppe; gruppen; groupe; grupo",
    "role": "role",
}
KIND_OF = {name: kind for kind, names in COLUMNS.items() for name in names.split("; ")}
PEOPLE = ("id", "login", "email", "lms_id", "sid", "number", "name", "first", "last")
NOBODY = re.compile(r"(points possible|student, test|test student|.*manual posting.*)", re.IGNORECASE)
STUDENT = re.compile("student|learner|participant|étudiant|estudiante|teilnehm|studierend|studente", re.IGNORECASE)
PARTICIPANT = re.compile(r"[^\d]+? ?(\d+)")  # Moodle's "Participant 12"
LARGEST = 20_000_000  # bytes
ROWS = 12  # among which the row with the columns' names is looked for


def read(path: Path, people: People) -> None:
    """Add who is in a class list to `people`; raises CourseError when it is none, or is unsure who somebody is."""
    unsure: list[str] = []
    here: dict[Person, Who] = {}
    for row in _rows(path):
        who = Who(**{kind: row.get(kind, "") for kind in ("name", "login", "email", "lms_id", "sid", "number")})
        first, last = row.get("first", ""), row.get("last", "")
        if not who.name and (first or last):
            who = Who(**{**vars(who), "name": f"{last}, {first}" if first and last else first or last})
        try:
            person = _person(row, who, people)
        except Unsure as problem:
            unsure.append(f"{path}: {who}: {problem}.")
            continue
        if person:
            if person in here and not any(row.get(kind) for kind in ("id", *KINDS)):
                unsure.append(f"{path}: {who}: the list has this name twice; give it a column that tells them apart.")
            if person in here and _is_another(who, here[person]):
                unsure.append(
                    f"{path}: {here[person]} and {who}: two people of one id, {person.id}; give one another id."
                )
                continue
            here.setdefault(person, who)
            _learn(person, row, who)
            people.learned(person)
    if unsure:
        raise CourseError("\n".join(unsure))


def _person(row, who, people):
    """Whom a row is about: somebody who is known already, or a new Person; None for nobody."""
    if row.get("id") in people.all:
        return people.all[row["id"]]
    listed = Person("")
    _learn(listed, row, who)
    person = people.find(who, LISTS) or people.listed_as(listed)
    chosen = folder_name(row.get("id") or who.login or who.email or who.sid or who.lms_id or who.name)
    return person or (people.add(chosen) if chosen else None)


def _is_another(who, before):
    """Whether two rows of a list are about two people: another name, and another number or address."""
    one = Person("")
    one.learn(before)
    other_name = bool(who.name and before.name) and LISTS.folded(who.name) not in map(LISTS.folded, one.variants())
    pairs = [(getattr(who, kind).casefold(), getattr(before, kind).casefold()) for kind in KINDS if kind != "login"]
    return other_name and any(one and other and one != other for one, other in pairs)


def _learn(person, row, who):
    person.first, person.last = row.get("first") or person.first, row.get("last") or person.last
    last, comma, first = who.name.partition(", ")
    if comma and not (person.first or person.last):  # Canvas's sortable name
        person.first, person.last = first, last
    elif " " in who.name and not comma and not (person.first or person.last):
        person.first, _, person.last = who.name.rpartition(" ")
    person.learn(who)
    person.groups |= {group.strip() for group in re.split("[;,]", row.get("group", "")) if group.strip()}
    person.listed = True


def _rows(path):
    """The rows of a class list that name somebody, as {what it says: value}."""
    text = _text(path)
    table, understood = [], set()
    for delimiter in ",;\t":
        rows = list(csv.reader(text.splitlines(), delimiter=delimiter))
        for position, row in enumerate(rows[:ROWS]):
            understood |= {name for name in _names(row) if name in KIND_OF}
            heads = _heads(row)
            if len(set(heads) & set(PEOPLE)) > len(set(table[0]) if table else ()):
                table = [heads, *rows[position + 1 :]]
    if not table:
        raise CourseError(
            f"{path}: this is no class list: its first row has to name columns such as id, login, email, first_name, last_name, "
            "lms_user_id, or as Canvas, Moodle, Blackboard, Brightspace, Sakai and Gradescope call them. "
            "A table of Excel has to be saved as CSV first. "
            + (f"Understood was {', '.join(sorted(understood))} alone." if understood else "No column was understood.")
        )
    heads = table[0]
    for row in table[1:]:
        found = {}
        for head, cell in zip(heads, row):
            value = cell.strip().removeprefix("#").strip()  # Brightspace's, so that Excel takes no number out of it
            if head and value and head not in found:
                found[head] = value
        if " " in found.get("id", "") and PARTICIPANT.fullmatch(found["id"]):
            found.setdefault("number", found.pop("id"))
        if participant := PARTICIPANT.fullmatch(found.get("number", "")):
            found["number"] = participant[1]
        if found.get("role") and not STUDENT.search(found["role"]):
            continue
        if any(found.get(kind) for kind in PEOPLE) and not NOBODY.fullmatch(found.get("name", "")):
            yield found


def _text(path):
    try:
        with open(path, "rb") as file:
            content = file.read(LARGEST)
    except OSError as error:
        raise CourseError(f"{path}: {error.strerror}.") from None
    for encoding in ("utf-16",) if content[:2] in (b"\xff\xfe", b"\xfe\xff") else ("utf-8-sig", "cp1252"):
        try:
            return content.decode(encoding)
        except UnicodeDecodeError:
            continue
    return content.decode("latin-1")


def _names(row):
    return [" ".join(cell.strip().strip('"').casefold().split()) for cell in row]


def _heads(row):
    """What each column of a table says, "" for one that says nothing of people."""
    names = _names(row)
    heads = [KIND_OF.get(name, "") for name in names]
    for place, name in enumerate(names):
        if name == "id":  # Canvas's number; Sakai's, which nothing else uses; nbgrader's
            heads[place] = "lms_id" if "student" in names else "" if "display id" in names else "id"
        elif name == "identifier" and "github_username" in names:
            heads[place] = "id"
        elif name == "user_id" and "canvas_user_id" in names:
            heads[place] = "sid"
    return heads if len([head for head in heads if head in PEOPLE]) else []
