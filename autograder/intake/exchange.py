"""nbgrader's exchange, where students write into a folder that the instructor's commands read.

nbgrader_config.py names the two classes here. They do what nbgrader's own do, but nothing in a student's folder can
bring files of the instructor's into a submission, or end the command for the students who come after.
"""

import glob
import os
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory

from nbgrader.exchange.default import ExchangeCollect, ExchangeReleaseFeedback

from .submission import SECRET, TIMESTAMP, read, receipts

EARLIEST = datetime.min.replace(tzinfo=UTC)


class Collect(ExchangeCollect):
    """`nbgrader collect`, which takes regular files only.

    nbgrader's own follows links as the instructor, and so hands a student what a link points to: the solutions, say.
    """

    def _path_to_record(self, path):
        """A folder whose name says no time, which anybody may make there, is older than any submission."""
        try:
            return super()._path_to_record(path)
        except (ValueError, OverflowError):
            self.log.warning("%s: its name is not one that `nbgrader submit` gives.", path)
            name = os.path.basename(path)
            return {"username": name.rsplit("+", 3)[0], "filename": name, "timestamp": EARLIEST}

    def do_copy(self, src, dest, log=None):
        try:
            with TemporaryDirectory() as taken:
                self._take(Path(src), Path(taken))
                super().do_copy(taken, dest, log)
        except (OSError, RuntimeError) as error:
            self.log.error("%s: not collected: %s", src, error)

    def _take(self, src, taken):
        room = most = 1000 * self.coursedir.max_dir_size  # bytes; more than that nbgrader refuses
        for here, _, names, descriptor in os.fwalk(src, follow_symlinks=False):
            folder = taken / Path(here).relative_to(src)
            folder.mkdir(exist_ok=True)
            for name in names:
                content, problem = read(name, descriptor)
                room -= len(content or b"")
                if room < 0:
                    problem = f"left out; at most {most / 1e6:g} MB of a submission are taken"
                if problem:
                    self.log.warning("%s: %s.", Path(here, name), problem)
                else:
                    (folder / name).write_bytes(content)


class ReleaseFeedback(ExchangeReleaseFeedback):
    """`nbgrader release_feedback`, which passes over those whose work did not come through the exchange."""

    def copy_files(self):
        for folder in sorted(glob.glob(self.src_path)):
            known_by, _ = receipts(Path(folder))
            if {SECRET, TIMESTAMP} <= known_by.keys():
                self.src_path = glob.escape(folder)
                super().copy_files()
            else:
                self.log.warning("%s: not released; the submission did not come through the exchange.", folder)
