"""nbgrader's exchange, where students write into a folder that the instructor's commands read.

nbgrader_config.py names the classes here. They do what nbgrader's own do, but who owns a folder is who handed it in, and
nothing in a student's folder can bring files of the instructor's into a submission, or end the command for the students
who come after.
"""

import glob
import os
import pwd
import stat
from datetime import UTC, datetime, timedelta
from pathlib import Path
from tempfile import TemporaryDirectory

from nbgrader.exchange.default import ExchangeCollect, ExchangeReleaseAssignment, ExchangeReleaseFeedback
from nbgrader.utils import notebook_hash, parse_utc

from ..files import replace
from ..names import odd
from .submission import AHEAD, SECRET, TIMESTAMP, read, receipts

SUMMARY = "index"  # the page about all notebooks, as pages/feedback.py calls it
SUBMITTING = timedelta(hours=1)  # the longest that `nbgrader submit` may take to copy, and more


class ReleaseAssignment(ExchangeReleaseAssignment):
    """`nbgrader release_assignment`, after which students can neither remove nor rename each other's submissions."""

    def init_dest(self):
        super().init_dest()
        for folder in not_sticky(self.root, self.coursedir.course_id):
            try:
                os.chmod(folder, stat.S_IMODE(os.stat(folder).st_mode) | stat.S_ISVTX)
            except PermissionError:
                self.log.warning("%s: who owns it has to run `chmod +t %s`.", folder, folder)


def not_sticky(root: str, course_id: str) -> list[Path]:
    """The folders of an exchange in which anybody may remove and rename what others have put there."""
    folders = [Path(root), Path(root, course_id, "inbound")]
    modes = [(folder, folder.stat().st_mode) for folder in folders if folder.is_dir()]
    return [folder for folder, mode in modes if mode & stat.S_IWOTH and not mode & stat.S_ISVTX]


class Collect(ExchangeCollect):
    """`nbgrader collect`, which takes regular files only, of the account whose submission it is.

    nbgrader's own follows links as the instructor, and so hands a student what a link points to: the solutions, say. It
    takes folders that others have put there in a student's name, too, with a warning.
    """

    def init_src(self):
        super().init_src()
        self.src_records = [record for record in self.src_records if record["username"]]

    def _path_to_record(self, path):
        """What nbgrader knows of a folder, before it takes a student's newest; nobody's is what is passed over."""
        try:
            record = super()._path_to_record(path)
            problem = odd(record["username"]) or self._problem(os.lstat(path), record)
        except (ValueError, OverflowError):
            problem = "its name is not one that `nbgrader submit` gives"
        except OSError as error:
            problem = error.strerror
        if not problem:
            return record
        self.log.warning("%s: passed over; %s.", repr(path), problem)
        return {"username": "", "filename": os.path.basename(path), "timestamp": datetime.min}

    def _problem(self, status, record):
        if not stat.S_ISDIR(status.st_mode):
            return "it is no folder"
        if record["timestamp"] > datetime.now(UTC).replace(tzinfo=None) + AHEAD:
            return f"its date, {record['timestamp']:%Y-%m-%d %H:%M} UTC, is still to come: it has to be handed in again"
        owner = _account(status.st_uid)
        if self.check_owner and owner != record["username"]:
            return (
                f"it belongs to the account {owner}, and who owns a folder is who handed it in (where students have no "
                "accounts of their own: c.ExchangeCollect.check_owner = False in nbgrader_config.py)"
            )
        return None

    def copy_files(self):
        self.dated_back = []  # (student, what the submission says, when it was written)
        super().copy_files()
        if self.dated_back:
            told = [
                f"{who} (says {said:%Y-%m-%d %H:%M}, written {when:%Y-%m-%d %H:%M})"
                for who, said, when in self.dated_back
            ]
            self.log.warning(
                "Written later than they say, times in UTC: %s. When the exchange was copied or its permissions were changed "
                "since, that is why. Otherwise somebody has changed the work, or its date, afterwards. What counts stands in "
                "submitted/STUDENT/%s/%s: to have another time count, change it there, then grade.",
                ", ".join(told), self.coursedir.assignment_id, TIMESTAMP,
            )  # fmt: skip

    def do_copy(self, src, dest, log=None):
        try:
            with TemporaryDirectory() as taken:
                written = self._take(Path(src), Path(taken))
                who, _, said, *_ = os.path.basename(src).rsplit("+", 3)
                # As `nbgrader submit` does; a student may have written another one into the file, or none.
                Path(taken, TIMESTAMP).write_text(said)
                super().do_copy(taken, dest, log)
            if written - parse_utc(said) > SUBMITTING:
                self.dated_back.append((who, parse_utc(said), written))
        except (OSError, RuntimeError) as error:
            self.log.error("%s: not collected: %s", src, error)

    def _take(self, src, taken):
        """Copy what is in a submission; when the last of it was written, which its student cannot change, in UTC."""
        room = most = 1000 * self.coursedir.max_dir_size  # bytes; more than that nbgrader refuses
        owner, latest = os.lstat(src).st_uid, 0.0
        for here, _, names, descriptor in os.fwalk(src, follow_symlinks=False):
            folder = taken / Path(here).relative_to(src)
            folder.mkdir(exist_ok=True)
            for name in names:
                status = os.stat(name, dir_fd=descriptor, follow_symlinks=False)
                content, problem = read(name, descriptor)
                room -= len(content or b"")
                if room < 0:
                    problem = f"left out; at most {most / 1e6:g} MB of a submission are taken"
                elif self.check_owner and status.st_uid != owner:
                    problem = f"left out; it belongs to the account {_account(status.st_uid)}"
                if problem:
                    self.log.warning("%s: %s.", Path(here, name), problem)
                else:
                    (folder / name).write_bytes(content)
                    latest = max(latest, status.st_ctime)
        return datetime.fromtimestamp(latest, UTC).replace(tzinfo=None)


def _account(uid):
    """What an account is called; its number where it has no name."""
    try:
        return pwd.getpwuid(uid).pw_name
    except KeyError:
        return str(uid)


class ReleaseFeedback(ExchangeReleaseFeedback):
    """`nbgrader release_feedback`: it passes over whose work did not come through the exchange, and names who has no pages.

    Whoever is to fetch a page can read it, whatever the instructor's umask. nbgrader shows a student no feedback at all while
    one of the notebooks that were handed in has none: for those that are not the assignment's, that is the summary.
    """

    def copy_files(self):
        folders = [Path(folder) for folder in sorted(glob.glob(self.src_path))]
        of = self.coursedir
        graded = glob.glob(of.format_path(of.autograded_directory, of.student_id, of.assignment_id))
        for student in sorted({Path(path).parent.name for path in graded} - {folder.parent.name for folder in folders}):
            self.log.warning("%s: not released; there are no pages. `python3 -m autograder grade` says why.", student)
        for folder in folders:
            known_by, _ = receipts(folder)
            if {SECRET, TIMESTAMP} <= known_by.keys():
                self.src_path = glob.escape(str(folder))
                super().copy_files()
                self._finish(folder, (folder / SECRET).read_text())
            else:
                self.log.warning("%s: not released; the submission did not come through the exchange.", folder)

    def _finish(self, folder, secret):
        """Let everybody read the pages, whose names nobody else can guess, and add those of other notebooks."""
        pages, whose = {page.stem: page for page in folder.glob("*.html")}, folder.parent.name
        handed_in = self.coursedir.format_path(self.coursedir.submitted_directory, whose, self.coursedir.assignment_id)
        others = [path.stem for path in Path(handed_in).glob("*.ipynb") if path.stem not in pages]
        for name in others if SUMMARY in pages else ():
            replace(self._page(secret, name), pages[SUMMARY].read_bytes())
            pages[name] = pages[SUMMARY]
        for name in pages:
            self._page(secret, name).chmod(0o644)

    def _page(self, secret, name):
        return Path(self.dest_path, notebook_hash(secret=secret, notebook_id=name) + ".html")
