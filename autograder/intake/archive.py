"""Zip files that others have made, read within bounds: nothing of them is written to disk, or read before it is asked for.

Names come out as they were meant: with `/` between folders, in one Unicode form (NFC, as macOS packs accents in two parts),
in UTF-8 where a tool has packed that without saying so. Two entries of one name are one file, and the last one counts, as
it does for who unpacks them one after the other; names that differ in capitals are two. What is left out is said in words.
The format: PKWARE's APPNOTE.TXT, sections 4.3 to 4.6; what a system's own tools add: `is_noise`.
"""

import io
import re
import stat
import struct
import unicodedata
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from ..names import UNPRINTABLE
from .reading import LARGEST

IN_LINES = "its name has a line end in it"
IS_UTF8, IS_ENCRYPTED = 1 << 11, 1  # general purpose flags
UNICODE_PATH = 0x7075  # the extra field with an entry's name in UTF-8
OF_A_NAME = 400  # bytes in the list of entries; without accents and time stamps it takes a third of that
SMALL = 1_000_000  # bytes; what is below that may be as compressible as it likes
NOISE = {"__MACOSX", ".DS_Store", "Thumbs.db", "desktop.ini", ".ipynb_checkpoints", "__pycache__", ".git"}


@dataclass(frozen=True)
class Bounds:
    """The most that is taken of an archive: entries, bytes of one and of all, folders in folders, bytes of a name, and how
    many bytes may come out of one; and what is asked of names. As they stand they fit what one student hands in.
    """

    entries: int = 1_000
    one: int = LARGEST
    all: int = 2 * LARGEST
    depth: int = 20
    name: int = 255  # what file systems take
    ratio: int = 200
    lines: bool = True  # whether a name may go on behind a line end; those of a class's download tell students apart


class Refused(ValueError):
    """An archive, or one entry of it, that is not read; the message says why, to be put behind its name."""


class Archive:
    """A zip file, open for reading; a context manager. Raises Refused when it is none, or is out of bounds.

    source: its path or its bytes; entries: {path: ZipInfo}, in order; problems: a sentence for each entry left out
    """

    def __init__(self, source: Path | bytes, bounds: Bounds = Bounds()):
        self.bounds, self.room = bounds, bounds.all
        self.entries: dict[PurePosixPath, zipfile.ZipInfo] = {}
        self.problems: list[str] = []
        file = _Guarded(io.BytesIO(source) if isinstance(source, bytes) else io.FileIO(source))
        try:
            file.most = bounds.entries * OF_A_NAME
            self._zip = zipfile.ZipFile(file)
            file.most = None
        except Refused:
            file.close()
            raise Refused(f"it lists too many files; at most {bounds.entries} are taken") from None
        except (zipfile.BadZipFile, struct.error, ValueError, OverflowError, NotImplementedError, EOFError):
            file.close()
            raise Refused("it is no zip file, or a damaged one; it has to be packed or downloaded again") from None
        self._file = file
        if len(self._zip.infolist()) > bounds.entries:
            self.close()
            raise Refused(f"it lists {len(self._zip.infolist())} files; at most {bounds.entries} are taken")
        for info in self._zip.infolist():
            self._list(info)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self) -> None:
        self._zip.close()
        self._file.close()

    def _list(self, info):
        if info.filename.endswith(("/", "\\")):  # a folder
            return
        name = _name(info)
        said = UNPRINTABLE.sub("_", name)
        parts = PurePosixPath(said.replace("\\", "/")).parts
        path = PurePosixPath(*(unicodedata.normalize("NFC", part) for part in parts))
        if is_noise(path):
            return
        if problem := IN_LINES if not self.bounds.lines and in_lines(name) else self._problem(path, info):
            self.problems.append(f"{said[:200]}: left out; {problem}.")
            return
        if path in self.entries:
            self.problems.append(f"{path}: it is in there more than once; the last one was taken.")
            del self.entries[path]  # its place in the order is that of the last one
        self.entries[path] = info

    def _problem(self, path, info):
        mode = info.external_attr >> 16
        if not path.name or path.is_absolute() or ".." in path.parts or re.match("[A-Za-z]:", path.parts[0]):
            return "its path leads out of the archive"
        if len(path.parts) - 1 > self.bounds.depth:
            return f"it lies in more than {self.bounds.depth} folders"
        if max(len(part.encode()) for part in path.parts) > self.bounds.name:
            return "its name is too long"
        if stat.S_ISLNK(mode):
            return "it is a link"
        if stat.S_IFMT(mode) and not stat.S_ISREG(mode):
            return "it is no regular file"
        return None

    def read(self, path: PurePosixPath) -> bytes:
        """The content of an entry; raises Refused."""
        info, bounds = self.entries[path], self.bounds
        if info.flag_bits & IS_ENCRYPTED:
            raise Refused("it is encrypted; it has to be packed without a password")
        if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):  # others unpack without a bound
            raise Refused("it is compressed in a way that is not read; it has to be packed as an ordinary zip file")
        if info.file_size > SMALL and info.file_size > bounds.ratio * info.compress_size:
            raise Refused(f"it is {info.file_size / 1e6:.0f} MB packed into {info.compress_size / 1e3:.0f} kB")
        try:
            with self._zip.open(info) as file:
                content = file.read(min(bounds.one, self.room) + 1)
        except (zipfile.BadZipFile, zlib.error, struct.error, ValueError, NotImplementedError, EOFError):
            raise Refused("it is damaged") from None
        if len(content) > bounds.one:
            raise Refused(f"it is larger than {bounds.one / 1e6:g} MB")
        if len(content) > self.room:
            raise Refused(f"at most {bounds.all / 1e6:g} MB of an archive are taken")
        self.room -= len(content)
        return content


def contents(source: Path | bytes, bounds: Bounds = Bounds()) -> tuple[dict[str, bytes], list[str]]:
    """({path: bytes} of an archive, what is wrong with it in sentences); raises Refused when it cannot be read at all."""
    files = {}
    with Archive(source, bounds) as archive:
        for path in archive.entries:
            try:
                files[str(path)] = archive.read(path)
            except Refused as refused:
                archive.problems.append(f"{path}: left out; {refused}.")
        return files, archive.problems


def in_lines(name: str) -> bool:
    """Whether a name goes on behind a line end, as nobody's does; one at the end is of a file that macOS's Finder makes."""
    return bool(re.search("[\r\n]", name.rstrip("\r")))


def is_noise(path: PurePosixPath) -> bool:
    """Whether a file is nobody's work, but what a system, Jupyter, Python or Git puts beside it."""
    return not NOISE.isdisjoint(path.parts) or path.name.startswith("._")


def _name(info):
    """The name of an entry as it was meant; zipfile takes for cp437 what does not say that it is UTF-8."""
    if info.flag_bits & IS_UTF8:
        return info.orig_filename
    raw = info.orig_filename.encode("cp437", "replace")
    try:
        return (_unicode_path(info.extra, zlib.crc32(raw)) or raw).decode()
    except UnicodeDecodeError:
        return info.orig_filename


def _unicode_path(extra, checksum):
    """The UTF-8 name in an entry's extra fields; b"" when there is none, or it is that of another name (APPNOTE, 4.6.9)."""
    while len(extra) >= 4:
        kind, size = struct.unpack_from("<HH", extra)
        field, extra = extra[4 : 4 + size], extra[4 + size :]
        if kind == UNICODE_PATH and len(field) > 5 and struct.unpack_from("<BL", field) == (1, checksum):
            return field[5:]
    return b""


class _Guarded(io.BufferedReader):
    """A file of which at most so many bytes are read at a time (None: any number).

    zipfile reads the list of entries in one piece, and makes an object of each before it can be asked how many there are.
    """

    most: int | None = None

    def read(self, size=-1, /):
        if self.most is not None and size is not None and size > max(self.most, 1 << 16):
            raise Refused
        return super().read(size)
