"""Canvas: "Download Submissions" of an assignment.

The rule is that of instructure/canvas-lms: lib/content_zipper.rb (add_submission, get_filename, sanitize_*) names a file
WHO[_LATE]_USERID_ATTACHMENTID_NAME, or [LATE_]anon_CODE_ATTACHMENTID_NAME where grading is anonymous; text and links are
WHO[_LATE]_USERID_text.html and …_link.html. WHO is the sortable name ("Last, First") in small letters, with only the
characters of words left; where a group is graded as one, the group's name, and USERID is one of its members
(assignment.rb, representatives).

Canvas itself finds the numbers again as the first two pieces of digits alone (assignment.rb,
infer_comment_context_from_filename), and so misses who is called "Kim_3". A file that is uploaded once more gets `-1` … `-7`,
then a UUID, behind its name (attachment.rb, make_unique_filename); numbers of attachments grow, and tell the order, too.
"""

import re
import unicodedata
from pathlib import PurePosixPath

from .piece import Form, Found, Left, Piece, Who, share, stem_of

ANONYMOUS = re.compile(
    r"(?P<late>LATE_)?anon_(?P<code>[A-Za-z0-9]+)_(?:(?P<attachment>\d+)_(?P<name>.+)|(text|link)\.html)"
)
NO_FILE = re.compile(r"(?P<who>.+?)(?P<late>_LATE)?_(?P<user>\d+)_(?P<what>text|link)\.html")
ANOTHER = re.compile(r"(?=_\d+_\d+_)")  # where the numbers may begin, besides the first place


def folded(name: str) -> str:
    """A sortable name as it stands in a file's (content_zipper.rb, sanitize_user_name)."""
    name = re.sub(r"_(\d+)_", r"\1", unicodedata.normalize("NFC", name))
    return unicodedata.normalize("NFC", "".join(filter(_of_words, name.lower())))


def _of_words(character):
    """Whether Ruby counts a character among those of words: letters, accents, digits, and the like of `_`."""
    kind = unicodedata.category(character)
    return kind[0] in "LM" or kind in ("Nd", "Pc")


def readings(filename):
    """The ways in which a file's name may be read, the one of Canvas first."""
    for start in (place.start() for place in ANOTHER.finditer(filename)):
        found = re.fullmatch(r"_(?P<user>\d+)_(?P<attachment>\d+)_(?P<name>.+)", filename[start:], re.DOTALL)
        who, late = filename[:start].removesuffix("_LATE"), filename[:start].endswith("_LATE")
        if found and who and folded(who) == who:
            yield who, late, found["user"], found["attachment"], found["name"]


def _no_file(filename):
    found = NO_FILE.fullmatch(filename)
    return found if found and folded(found["who"]) == found["who"] else None


def fits(download):
    return share(
        download,
        lambda path: len(path.parts) == 1 and (ANONYMOUS.fullmatch(path.name) or _no_file(path.name) or any(readings(path.name))),
    )  # fmt: skip


def sort(download, notebooks, people):
    anonymous = [ANONYMOUS.fullmatch(path.name) for path in download.files]
    blind = all(anonymous) and any(not found["code"].isdigit() for found in anonymous)
    pieces, left, whose = [], [], _whose(download, notebooks, people)
    for path in download.files:
        if blind:
            found = ANONYMOUS.fullmatch(path.name)
            who = Who(number=found["code"])
            if found["attachment"]:
                order = (int(found["attachment"]),)
                pieces.append(Piece((who,), path, PurePosixPath(found["name"]), late=bool(found["late"]), order=order))
            else:
                left.append(Left("a text or a link instead of a file", (str(path),), str(who)))
        elif found := _no_file(path.name):
            who = Who(found["who"], lms_id=found["user"])
            what = "a text" if found["what"] == "text" else "a link"
            left.append(Left(f"{what} instead of a file", (str(path),), str(who)))
        elif path in whose:
            who, late, user, attachment, name = whose[path]
            order = (int(attachment),)
            pieces.append(Piece((Who(who, lms_id=user),), path, PurePosixPath(name), late=late, order=order))
        else:
            left.append(Left("it is not named as Canvas names files", (str(path),)))
    return Found(pieces, left)


def _whose(download, notebooks, people):
    """{path: its reading}. Where there are several: the one whose number is known; else the one whose file is called as a
    notebook is; other files of that student are read as that one is; else as Canvas reads them.
    """
    all_ways = {path: list(readings(path.name)) for path in download.files if len(path.parts) == 1}
    sure = {}
    for path, ways in all_ways.items():
        known = [way for way in ways if people.knows("lms_id", way[2])]
        called = [way for way in ways if stem_of(way[4], notebooks)]
        for some in ([way for way in ways if len(ways) == 1], known, called):
            if len(some) == 1 and path not in sure:
                sure[path] = some[0]
    prefixes = {(way[0], way[2]) for way in sure.values()}
    for path, ways in all_ways.items():
        if path not in sure and ways:
            sure[path] = next((way for way in ways if (way[0], way[2]) in prefixes), ways[0])
    return sure


FORM = Form("canvas", "Canvas: Download Submissions", fits, sort, folded)
