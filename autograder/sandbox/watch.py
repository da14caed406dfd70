"""What a sandbox uses, read from outside through /proc, where nothing that runs inside can change it."""

import os
from pathlib import Path

from .account import processes
from .bounds import FOLDER, WRITABLE

PUBLIC = (
    "/tmp",
    "/var/tmp",
    "/dev/shm",
    "/run/lock",
)  # where any user may write; a notebook's own folder lies in the first
TICK = 1 / os.sysconf("SC_CLK_TCK")  # seconds; the unit of processor time in /proc


def waited(process):
    """Seconds in which the process of that number could have run, but others had the processor."""
    try:
        return int(Path(f"/proc/{process}/schedstat").read_text().split()[1]) * 1e-9
    except (OSError, ValueError, IndexError):
        return 0.0  # it has ended, or this kernel does not count


class Watch:
    """Of one sandbox: all its processes together, and its files; first: the number of its first process"""

    def __init__(self, first, limits):
        self.root, self.limits = Path(f"/proc/{first}/root"), limits

    def excess(self):
        """Which limit of the whole sandbox is passed, in words, or None."""
        memory = processor = 0
        for process in self._processes():
            memory += _memory(process)
            processor += _processor(process)
        if memory > self.limits.memory:
            return f"more than {self.limits.memory / 1e9:g} GB of memory"
        if processor > self.limits.cpu:
            return f"more than {self.limits.cpu:g} s of processor time"
        if self._files() > self.limits.files:
            return f"more than {self.limits.files} files"
        return None

    def _processes(self):
        try:
            return [path for path in (self.root / "proc").iterdir() if path.name.isdigit()]
        except OSError:
            return []  # it has ended

    def _files(self):
        try:
            counts = [os.statvfs(self.root / folder.relative_to("/")) for folder in WRITABLE]
        except OSError:
            return 0
        return sum(count.f_files - count.f_ffree for count in counts)


class UserWatch(Watch):
    """Of all processes of a user, and of the user's files wherever anybody may write.

    number: the user's; notebook: the number of the notebook's own process
    """

    def __init__(self, number, notebook, limits):
        super().__init__(notebook, limits)
        self.number, self.size = number, 0

    def excess(self):
        found = super().excess()
        if not found and self.size > FOLDER * len(WRITABLE):
            return f"more than {FOLDER * len(WRITABLE) / 1e6:g} MB of files"
        return found

    def _processes(self):
        return processes(self.number)

    def _files(self):
        """How many there are; their size, too, is added up."""
        count, self.size, waiting = 0, 0, [folder for folder in PUBLIC if os.path.isdir(folder)]
        while waiting and count <= self.limits.files:
            try:
                with os.scandir(waiting.pop()) as entries:
                    for entry in entries:
                        known = entry.stat(follow_symlinks=False)
                        if known.st_uid == self.number:
                            count, self.size = count + 1, self.size + 512 * known.st_blocks
                        may_write = known.st_uid == self.number or known.st_mode & 0o002
                        if may_write and entry.is_dir(follow_symlinks=False):
                            waiting.append(entry.path)
            except OSError:
                continue  # it has been removed meanwhile
        return count


def _memory(process):
    """Bytes that a process holds; those that it shares with others are shared out between them."""
    try:
        for line in (process / "smaps_rollup").read_text().splitlines():
            if line.startswith("Pss:"):
                return int(line.split()[1]) * 1024
    except OSError:
        try:  # it hides itself; then what it shares is left out
            _, resident, shared, *_ = map(int, (process / "statm").read_text().split())
            return (resident - shared) * os.sysconf("SC_PAGE_SIZE")
        except OSError:
            pass
    return 0  # it has ended


def _processor(process):
    """Seconds of processor time, those of its ended children included."""
    try:
        fields = (process / "stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return sum(map(int, fields[11:15])) * TICK
