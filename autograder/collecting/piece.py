"""What every system's download comes down to: files, each with what is known of whose it is and when it came."""

import re
import unicodedata
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import PurePosixPath
from typing import NamedTuple

from .download import Download


@dataclass(frozen=True)
class Who:
    """What a download says of whose a file is; "" where it says nothing.

    name: as the system writes it into file names; lms_id: the number by which the LMS knows a user everywhere; sid: the
    university's number; number: one that means something in this download only; folder: what to call a student of whom
    nothing else is sure; group: whether the name is that of a group
    """

    name: str = ""
    login: str = ""
    email: str = ""
    lms_id: str = ""
    sid: str = ""
    number: str = ""
    folder: str = ""
    group: bool = False

    def __str__(self):
        told = [self.name] if self.name else []
        told += [value for value in (self.login, self.email) if value]
        told += [f"no. {value}" for value in (self.lms_id or self.number, self.sid) if value]
        return f"{told[0]} ({', '.join(told[1:])})" if told[1:] else "".join(told) or self.folder or "nobody"


@dataclass(frozen=True)
class Piece:
    """A file that somebody handed in.

    whose: all of a group; file: its path in the download; path: its path in the submission; time: with its zone, or in
    local time of the server; order: greater is newer, where the system says so within one submission
    """

    whose: tuple[Who, ...]
    file: PurePosixPath
    path: PurePosixPath
    time: datetime | None = None
    late: bool = False
    order: tuple = ()


@dataclass(frozen=True)
class Left:
    """Files of a download that were not taken, why in words, and whose they are where that is known.

    look: whether that is something to look at
    """

    why: str
    files: tuple[str, ...] = ()
    whose: str = ""
    look: bool = True


class Found(NamedTuple):
    """What a system's module makes of a download."""

    pieces: list[Piece]
    left: list[Left]


@dataclass(frozen=True)
class Form:
    """A form of download.

    title: the system and what to press there; fits: the share of the files that are named by its rule, 0 to 1; sort: the
    files with whose they are, given the released notebooks by name and what is known of people; folded: a name as the
    system changes it, to be compared; blind: whether the download names nobody
    """

    name: str
    title: str
    fits: Callable[[Download], float]
    sort: Callable[..., Found]
    folded: Callable[[str], str] = field(default=lambda name: plainly(name))


def plainly(name: str) -> str:
    """A name in one Unicode form, without capitals, with single spaces."""
    return " ".join(unicodedata.normalize("NFC", name).casefold().split())


def share(download: Download, known: Callable[[PurePosixPath], object]) -> float:
    """The share of a download's files for which `known` is true."""
    return sum(bool(known(path)) for path in download.files) / max(1, len(download.files))


def own(files: Iterable[PurePosixPath], what: str) -> list[Left]:
    """The Left for files which the system itself has put there."""
    names = tuple(map(str, files))
    return [Left(what, names, look=False)] if names else []


def stem_of(filename: str, notebooks: Iterable[str]) -> str | None:
    """The released notebook whose name a file's begins with."""
    return next((name for name in notebooks if re.match(rf"{re.escape(name)}(?![^\W_])", filename, re.I)), None)
