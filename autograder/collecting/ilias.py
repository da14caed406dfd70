"""ILIAS: "Download All Submissions" of an exercise.

…/SUBMISSIONS/LAST_FIRST_LOGIN_USERID/NAME and a table beside it; for teams …/Team N/LAST_FIRST_LOGIN_USERID/NAME. The rule is
that of ILIAS-eLearning/ILIAS: Modules/Exercise/classes/class.ilExSubmission.php (downloadAllAssignmentFiles,
getDirectoryNameFromUserData), and ilUtil::getASCIIFilename, which makes ASCII of names: ä ö ü ß become ae oe ue ss, letters
that HTML 4 has a name for their base letter, and each other byte from 0x7f an `_`.

So a folder is never split from the left: the number is the last field, and a login before it may hold `_`. SUBMISSIONS, "Team"
and "Late Submission - " before a file's name are in the site's language. A second upload of a name gets ` (2)`, and is newer.
The time is taken off.
"""

import html.entities
import re
import unicodedata
from collections import Counter
from pathlib import PurePosixPath

from .piece import Form, Found, Left, Piece, Who, own, plainly, share, stem_of

FOLDER = re.compile(r"(?P<before>.*_.*)_(?P<login>[^_]+)_(?P<user>\d+)")
TABLE = re.compile(r".+\.(xlsx?|csv)", re.IGNORECASE)
COPY = re.compile(r"(?P<stem>.*?) ?\((?P<number>\d+)\)(?P<ending>(?:\.\w+)?)")
LATE = re.compile(r"(?P<prefix>[^-]{3,40}) - (?P<name>.+)")
DEEPEST = 4  # folders above those of the students
UMLAUTS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss"})


def ascii_name(name: str) -> str:
    """A name as ILIAS writes it (ilUtil::getASCIIFilename)."""
    found = ""
    for character in unicodedata.normalize("NFC", name).translate(UMLAUTS):
        entity = html.entities.codepoint2name.get(ord(character), "")
        if ord(character) < 0x7F:
            found += character
        elif match := re.fullmatch(
            r"([A-Za-z]{1,2})(?:grave|acute|circ|tilde|uml|ring|cedil|caron|slash|lig|th)", entity
        ):
            found += match[1]
        else:
            found += "_" * len(character.encode())
    return re.sub(r'[:\\/*?"<>|]', "_", found.replace("&", "a"))


def folded(name: str) -> str:
    return plainly(ascii_name(name))


def fits(download):
    depth = _depth(download)
    return share(download, lambda path: _folder(path, depth) or _own(path, depth))


def _depth(download):
    """How many folders the students' ones lie in."""
    counts = Counter(
        depth for path in download.files for depth in range(min(DEEPEST, len(path.parts) - 1)) if _folder(path, depth)
    )
    return counts.most_common(1)[0][0] if counts else 0


def _folder(path, depth):
    return len(path.parts) > depth + 1 and FOLDER.fullmatch(path.parts[depth])


def _own(path, depth):
    return len(path.parts) <= depth + 1 and TABLE.fullmatch(path.name)


def sort(download, notebooks, people):
    depth, pieces, left = _depth(download), [], []
    parts = {path: _folder(path, depth) for path in download.files}
    prefixes = {
        found["prefix"]
        for path in parts
        if (found := LATE.fullmatch(path.name))
        and stem_of(found["name"], notebooks)
        and not stem_of(path.name, notebooks)
    }
    for path, part in parts.items():
        if _own(path, depth):
            continue
        if not part:
            left.append(Left("it is not named as ILIAS names files", (str(path),)))
            continue
        found = LATE.fullmatch(path.name)
        late = bool(found and found["prefix"] in prefixes)
        name = found["name"] if found and late else path.name
        copy = COPY.fullmatch(name)
        order = (int(copy["number"]) if copy else 1,)
        inside = PurePosixPath(*path.parts[depth + 1 : -1], f"{copy['stem']}{copy['ending']}" if copy else name)
        pieces.append(Piece((_who(part, people),), path, inside, late=late, order=order))
    return Found(pieces, left + own((path for path in parts if _own(path, depth)), "a table of ILIAS's"))


def _who(part, people):
    """Who a folder is of. Where its name can be split in several ways, that of a known login or name counts."""
    whole, user = part[0], part["user"]
    fields = whole.split("_")
    if len(fields) == 4 and all(fields):
        return Who(f"{fields[0]}, {fields[1]}", login=fields[2], lms_id=user)
    before = whole.removesuffix(f"_{user}")
    logins = {
        login for login in people.values("login") if before.casefold().endswith(f"_{ascii_name(login)}".casefold())
    }
    if len(logins) == 1:
        (login,) = logins
        return Who(before[: -len(login) - 1], login=login, lms_id=user)
    names = {}
    for name in people.sortable():
        begins = ascii_name(name.replace(", ", "_")) + "_"
        if before.casefold().startswith(begins.casefold()):
            names[begins.casefold()] = Who(name, login=before[len(begins) :], lms_id=user)
    if len(names) == 1:
        return names.popitem()[1]
    return Who(before, lms_id=user, folder=whole)


FORM = Form("ilias", "ILIAS: Download All Submissions", fits, sort, folded)
