"""Moodle: "Download all submissions" of an assignment, in all its forms.

The rule is that of moodle/moodle: mod/assign/classes/downloader.php (before 4.1 mod/assign/locallib.php), and PARAM_FILE of
lib/moodlelib.php. Folders are called FULLNAME_NUMBER_assignsubmission_file (before 4.1 with one `_` more at the end), with
the student's own folders in them; with "download in folders" off, and before 3.1, FULLNAME_NUMBER_assignsubmission_file_NAME.
What is typed into Moodle is …_assignsubmission_onlinetext. A site decides what FULLNAME is; known are "First Last",
`LAST,FIRST-ID` and `First Last__userATdomain_`.

NUMBER is that of a participant in this one assignment, and not the user's; the grading worksheet has it as "Participant
NUMBER". In blind marking FULLNAME is "Participant" in the site's language. For teams it is the group's name and NUMBER the
group's (before 4.0: "GROUP-Fullname", once for each member); "Default group", without a number, is who is in none.

Moodle gives no time, and of each student the last attempt alone.
"""

import re
from collections import defaultdict
from pathlib import PurePosixPath

from ..intake.archive import Refused
from .piece import Form, Found, Left, Piece, Who, own, plainly, share

PART = re.compile(
    r"(?P<name>.+?)(?:_(?P<number>\d+))?_assignsubmission_(?P<plugin>[a-z]+)(?:_(?P<file>.*))?", re.DOTALL
)
REMOVED = re.compile(r"[\x00-\x1f\x7f&<>\"`|':\\/]")  # PARAM_FILE
ADDRESS = re.compile(r"(?P<name>.+?)__(?P<user>[^\s@]+)AT(?P<domain>[^\s@]+?)_?")
PARTICIPANT = set(
    "participant participante partecipante participant(e) teilnehmer/in teilnehmer teilnehmer*in teilnehmerin deelnemer "
    "deltagare deltager deltaker osallistuja uczestnik účastník účastníčka résztvevő участник учасник συμμετέχων "
    "katılımcı 参加者 参与者 "
    "成员 參與者 참가자 참여자 مشارك משתתף peserta".split()
)

WORDS = "groups?|teams?|gruppe|groupe|grupo|gruppo|groep|grupa|équipe|equipe|equipo|squadra|tým|zespół|グループ|チーム|小组|组"
GROUP = re.compile(rf"(?:{WORDS}) .+|(?:.* )?(?:standard)?(?:{WORDS})(?: ?\w{{1,3}})?", re.IGNORECASE)
NO_GROUP = re.compile(
    "default group|standardgruppe|groupe par défaut|grupo (?:por defecto|predeterminado|padrão)|standaardgroep|"
    "gruppo (?:predefinito|di default)",
    re.IGNORECASE,
)

MANY = 3  # of one name: it is no name, but the word for participant


def folded(name: str) -> str:
    """A full name as it stands in a file's (downloader.php, then PARAM_FILE)."""
    return plainly(REMOVED.sub("", name.replace("_", " ")))


def fits(download):
    return share(download, lambda path: PART.fullmatch(path.parts[0]))


def sort(download, notebooks, people):
    pieces, left, others = [], [], []
    parts = {path: PART.fullmatch(path.parts[0]) for path in download.files}
    found = {part[0]: part for part in parts.values() if part}.values()
    names, numbers = {folded(part["name"]) for part in found}, {part["number"] for part in found}
    blind = names <= PARTICIPANT or len(names) == 1 and len(numbers) >= MANY
    blind = blind and not any(people.named(name, FORM) for name in names)
    teams = any(part["number"] is None for part in found)
    groups = _groups(download, parts)
    for path, part in parts.items():
        if not part:
            left.append(Left("it is not named as Moodle names files", (str(path),)))
            continue
        who = Who(number=part["number"] or "") if blind else _who(part, teams, groups, people)
        inside = PurePosixPath(part["file"] or "", *path.parts[1:])
        if part["plugin"] == "onlinetext":
            left.append(Left("a text, typed into Moodle", (str(path),), str(who)))
        elif part["plugin"] != "file":
            others.append(path)
        elif part["number"] is None:
            left.append(Left("a group's work, and Moodle does not say whose: it is of those in no group", (str(path),)))
        else:
            pieces.append(Piece((who,), path, inside))
    return Found(pieces, left + own(others, "Moodle's own, or of another kind of submission"))


def _groups(download, parts):
    """What stands before `-` in "GROUP-Fullname": who is in no group has the words for that there; in a group, each member's
    row has the same files. "Jean-Paul" and "Jean-Luc" are no group for having handed in the same.
    """
    rows, files = defaultdict(set), defaultdict(dict)
    for path, part in parts.items():
        for place in re.finditer("-", part["name"] if part else ""):
            before = part["name"][: place.start()]
            if NO_GROUP.fullmatch(before) or GROUP.fullmatch(before) or re.search(r"[\s\d]", before):
                rows[before].add(part[0])
                files[part[0]][part["file"], path.parts[1:]] = path
    found = {before for before in rows if NO_GROUP.fullmatch(before)}
    for before in rows.keys() - found:
        contents = {_contents(download, files[row]) for row in rows[before]} if len(rows[before]) > 1 else ()
        if len(contents) == 1:
            found.add(before)
    return found


def _contents(download, files):
    try:
        return frozenset((name, hash(download.read(path))) for name, path in files.items())
    except Refused:
        return None


def _who(part, teams, groups, people):
    """Who a folder's name tells of; a user name, number or address in it counts where it fits a known person's name."""
    name, number = part["name"], part["number"] or ""
    if address := ADDRESS.fullmatch(name):
        return Who(address["name"], email=f"{address['user']}@{address['domain']}", number=number)
    for word in filter(None, re.split(r"[\s,_()-]+", name)):
        rest = re.sub(r"\s*,\s*", ", ", re.sub(rf"[\s(_-]*{re.escape(word)}[\s)_-]*", " ", name, count=1).strip())
        for kind in ("login", "sid"):
            if rest and people.fits(kind, word, rest, FORM):
                return Who(rest, number=number, **{kind: word})
    for place in (place.start() for place in re.finditer("-", name)):
        rest = name[place + 1 :].strip()
        if " " in rest and people.named(rest, FORM) and not people.named(name, FORM):
            return Who(rest, number=number)  # "GROUP-Fullname"
    if before := max((each for each in groups if name.startswith(f"{each}-")), key=len, default=""):
        return Who(name.removeprefix(f"{before}-").strip(), number=number)
    return Who(name, number=number, group=teams or bool(GROUP.fullmatch(name)) and not people.named(name, FORM))


FORM = Form("moodle", "Moodle: Download all submissions", fits, sort, folded)
