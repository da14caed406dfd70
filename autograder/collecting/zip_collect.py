"""`nbgrader zip_collect`, which takes what `collect` would take; nbgrader_config.py names the class here.

nbgrader asks of one file at a time whose it is, and its own pattern takes the minutes and seconds of Blackboard's names for a
time zone. This looks at all that was unpacked, once, as `collect` does, and answers from that.
"""

from contextlib import ExitStack
from functools import cached_property
from pathlib import Path

from nbgrader.plugins import FileNameCollectorPlugin

from ..course import Course, CourseError
from .collect import by_download, introduce
from .download import Download
from .folder import Folder
from .people import People
from .systems import FORMS


class Collector(FileNameCollectorPlugin):
    """Tells nbgrader a file's student, name and time, or that it is to be left."""

    def collect(self, submitted_file):
        return self._known.get(Path(submitted_file).resolve())

    @cached_property
    def _known(self):
        """{path: what nbgrader asks for}"""
        course, found = Course(Path(self.parent.coursedir.root)), {}
        people = People(FORMS.values())
        introduce(course, people)
        unpacked = Path(self.parent._format_collect_path(self.parent.extracted_directory))
        inside = sorted(path for path in unpacked.iterdir() if not path.name.startswith("."))
        try:
            with ExitStack() as stack:
                folders = inside if all(path.is_dir() for path in inside) else [unpacked]
                downloads = [stack.enter_context(Download(path)) for path in folders]
                for download in downloads:
                    download.files = _as_it_came(download.files)
                for _, form, view, by_person, left in by_download(downloads, people, course.notebooks):
                    for person, whose in by_person.items():
                        chosen = Folder(course, view, form, {}, person, None, True, left).chosen(whose)
                        for place, candidate in chosen.items():
                            if candidate.inside:  # nbgrader copies whole files: the intake unpacks this one
                                place = str(candidate.piece.path)
                            told = {"student_id": person.id, "file_id": place}
                            time = {"timestamp": candidate.time.isoformat()} if candidate.time else {}
                            found[view.place(candidate.piece.file).resolve()] = told | time
                    for one in left:
                        self.log.warning("%s: %s %s", one.whose or "left", one.why, ", ".join(one.files))
        except CourseError as error:
            self.log.error("%s", error)
        return found


def _as_it_came(files):
    """The files of a download without those that nbgrader has unpacked from a student's zip, into a folder beside it."""
    zips = {path.with_suffix("") for path in files if path.suffix.lower() == ".zip"}
    return {path: where for path, where in files.items() if zips.isdisjoint(path.parents)}
