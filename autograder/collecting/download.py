"""A download as it lies on the disk: a zip file, or the folder that somebody or a browser has unpacked it into."""

import copy
import os
import re
import unicodedata
from collections.abc import Iterator
from datetime import datetime
from pathlib import Path, PurePosixPath

from ..course import CourseError
from ..intake.archive import IN_LINES, Archive, Bounds, Refused, in_lines, is_noise
from ..intake.reading import LARGEST
from ..intake.submission import read
from ..names import UNPRINTABLE

# A class of thousands; names as long as a server can make them, of people, numbers and files in one.
BOUNDS = Bounds(entries=200_000, all=200_000 * LARGEST, depth=40, name=2_000, lines=False)
COPY = re.compile(r"( ?\(\d+\)| copy( \d+)?)$")  # what browsers and the Finder add to a second download


class Download:
    """The files of a download; a context manager. Raises CourseError when it cannot be read.

    name: what it is called, without its ending; files: {path: where it lies}, paths as Archive gives them; made: when it was
    packed or unpacked, as far as its files tell; problems: sentences about what cannot be taken
    """

    def __init__(self, path: Path):
        self.name = COPY.sub("", re.sub(r"\.zip$", "", path.name, flags=re.IGNORECASE))
        self.problems: list[str] = []
        self.files: dict[PurePosixPath, PurePosixPath] = {}
        self._folder = path if path.is_dir() else None
        self._archive = None
        if self._folder:
            self.made = self._list(self._folder)
            return
        try:
            self._archive = Archive(path, BOUNDS)
        except Refused as refused:
            raise CourseError(f"{path}: {refused}.") from None
        self.files = {path: path for path in self._archive.entries}
        self.problems += self._archive.problems
        self.made = max(filter(None, map(_packed, self._archive.entries.values())), default=None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self._archive:
            self._archive.close()

    def _list(self, folder):
        """List the files below a folder, following no link; when the last of them was changed."""
        newest = 0.0
        for here, folders, names in os.walk(folder):
            above = PurePosixPath(Path(here).relative_to(folder).as_posix())
            for name in folders:
                if os.path.islink(os.path.join(here, name)):
                    self.problems.append(f"{_clean(above / name)}: left out; it is a link.")
            folders[:] = sorted(name for name in folders if not is_noise(PurePosixPath(name)))
            for name in sorted(names):
                if in_lines(str(above / name)):
                    self.problems.append(f"{_clean(above / name)}: left out; {IN_LINES}.")
                elif not is_noise(PurePosixPath(name)):
                    self.files[_clean(above / name)] = above / name
                    newest = max(newest, os.lstat(os.path.join(here, name)).st_mtime)
        return datetime.fromtimestamp(newest) if newest else None

    def read(self, path: PurePosixPath) -> bytes:
        """The content of one of the files; raises Refused."""
        where = self.files[path]
        if self._archive:
            return self._archive.read(where)
        content, problem = read(self.place(path))
        if content is None:
            raise Refused((problem or "").removeprefix("left out; "))
        if len(content) > LARGEST:
            raise Refused(f"it is larger than {LARGEST / 1e6:g} MB")
        return content

    def on_disk(self, path: PurePosixPath, depth: int) -> Path | None:
        """Where the first `depth` folders of a file's path lie on the disk; None for what lies in a zip file."""
        below = len(path.parts) - depth
        return self._folder.joinpath(*self.files[path].parts[:-below]) if self._folder else None

    def place(self, path: PurePosixPath) -> Path:
        """Where one of the files of a folder lies on the disk."""
        return Path(self._folder or "", self.files[path])

    def views(self) -> Iterator["Download"]:
        """The download as it is, and without one or more of the folders in which all of it lies."""
        view = self
        while True:
            yield view
            tops = {path.parts[0] for path in view.files}
            if len(tops) != 1 or any(len(path.parts) == 1 for path in view.files):
                return
            view = copy.copy(view)
            view.name = COPY.sub("", tops.pop())
            view.files = {PurePosixPath(*path.parts[1:]): where for path, where in view.files.items()}


def _clean(path):
    """A path as Archive gives them."""
    return PurePosixPath(unicodedata.normalize("NFC", UNPRINTABLE.sub("_", str(path))))


def _packed(entry):
    """When an entry of an archive was changed or packed; None when it does not say."""
    try:
        return datetime(*entry.date_time) if entry.date_time[0] > 1980 else None
    except ValueError:
        return None
