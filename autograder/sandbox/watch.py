"""What a sandbox uses, read from outside through /proc, where nothing that runs inside can change it."""

import math
import os
import re
from functools import cache
from pathlib import Path

from .account import processes
from .bounds import FOLDER, WRITABLE

PUBLIC = (
    "/tmp",
    "/var/tmp",
    "/dev/shm",
    "/run/lock",
)  # where any user may write; a notebook's own folder lies in the first
TICKS = os.sysconf("SC_CLK_TCK")  # in a second; the unit of processor time in /proc
# Bytes of the kernel's, which no process is charged for, of a pipe or socket (as if it were full), terminal, and mapping.
BUFFER, TERMINAL, MAPPING = 320_000, 1_300_000, 500
SHARED_DEVICE = b" /dev/zero (deleted)\n"  # what is mapped of it may be a page of all that lies there


def waited(process):
    """{thread: seconds in which it could have run, but others had the processor}, of the process of that number."""
    found = {}
    for task in _entries(Path(f"/proc/{process}/task")):
        try:
            found[task.name] = int((task / "schedstat").read_text().split()[1]) * 1e-9
        except (OSError, ValueError, IndexError):
            continue  # it has ended, or this kernel does not count
    return found


class Watch:
    """Of one sandbox: all its processes together, and its files; first: the number of its first process"""

    def __init__(self, first, limits):
        self.root, self.limits = Path(f"/proc/{first}/root"), limits
        self.used = {}  # {(number of a process, when it started): ticks of processor time of its own}
        self.ticks = 0  # of all that have been there

    def excess(self):
        """Which limit of the whole sandbox is passed, in words, or None."""
        found = self._processes()
        buffers = set().union(*map(_buffers, found))
        outside = BUFFER * len(buffers) + TERMINAL * self._terminals()
        self._count(found)
        if self._may_exceed(found, outside) and sum(map(_memory, found)) + outside > self.limits.memory:
            return f"more than {self.limits.memory / 1e9:g} GB of memory"
        if self.ticks > TICKS * self.limits.cpu:
            return f"more than {self.limits.cpu:g} s of processor time"
        if self._files() > self.limits.files:
            return f"more than {self.limits.files} files"
        return None

    def _may_exceed(self, processes, outside):
        """Whether it is worth it to look closely, which takes milliseconds a process."""
        return sum(map(_memory_at_most, processes)) + outside > self.limits.memory

    def _count(self, processes):
        """Add up processor time. What ends between two looks is in what its parent has used, or, where nobody waits for
        it, stands with what was seen of it, and a tick."""
        now = 0
        for process in processes:
            try:
                fields = (process / "stat").read_text().rpartition(")")[2].split()
            except OSError:
                continue  # it has ended
            self.used[process.name, fields[19]] = sum(map(int, fields[11:13]))
            now += sum(map(int, fields[11:15]))  # with that of children which it has waited for
        self.ticks = max(self.ticks, now, sum(self.used.values()) + self._started())

    def _started(self):
        """How many processes and threads there have been at least: they are numbered from 1 in a sandbox."""
        return max(int(number) for number, _ in self.used) if self.used else 0

    def _processes(self):
        return [path for path in _entries(self.root / "proc") if path.name.isdigit()]

    def _terminals(self):
        return len(_entries(self.root / "dev/pts"))

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

    def _may_exceed(self, processes, outside):
        return True  # outside of namespaces there is a /dev/zero, which only a close look finds

    def _started(self):
        return len(self.used)  # numbers are those of the whole machine's

    def _terminals(self):
        return sum(_owner(terminal) == self.number for terminal in _entries(Path("/dev/pts")))

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


def _memory_at_most(process):
    """Bytes that a process can hold, what it shares with others included."""
    try:
        sizes = re.findall(
            r"^Vm(?:RSS|Swap|PTE):\s*(\d+) kB", (process / "status").read_text(errors="replace"), re.MULTILINE
        )
    except OSError:
        return 0  # it has ended
    # Without sizes its first thread has ended, and others may go on.
    return sum(map(int, sizes)) * 1024 + MAPPING * _most_mappings() if sizes else _memory(process)


@cache
def _most_mappings():
    """How many a process may have."""
    return int(Path("/proc/sys/vm/max_map_count").read_text())


def _memory(process):
    """Bytes that a process holds; those that it shares with others are shared out between them."""
    for task in _tasks(process):  # its first thread may have ended, and shows nothing then
        try:
            maps = (task / "maps").read_bytes()
            if SHARED_DEVICE in maps:
                return math.inf
            words = f"{(task / 'smaps_rollup').read_text()}\n{(task / 'status').read_text(errors='replace')}"
            held = sum(int(size) for size in re.findall(r"^(?:Pss|SwapPss|VmPTE):\s*(\d+) kB", words, re.MULTILINE))
            return held * 1024 + MAPPING * maps.count(b"\n")
        except OSError:
            try:  # it hides itself; then what it shares is left out
                _, resident, shared, *_ = map(int, (task / "statm").read_text().split())
                if resident:
                    return (resident - shared) * os.sysconf("SC_PAGE_SIZE")
            except OSError:
                continue
    return 0  # it has ended


def _buffers(process):
    """The pipes and sockets that a process has open, each by its own name."""
    for task in _tasks(process):
        found = [_link(path) for path in _entries(task / "fd")]
        if found:
            return {name for name in found if name.startswith(("socket:", "pipe:"))}
    return set()


def _tasks(process):
    return sorted(_entries(process / "task"), key=lambda task: int(task.name))


def _entries(folder):
    try:
        return list(folder.iterdir())
    except OSError:
        return []  # it has ended


def _link(path):
    try:
        return os.readlink(path)
    except OSError:
        return ""  # it has just been closed


def _owner(path):
    try:
        return path.stat().st_uid
    except OSError:
        return None  # it has just been closed
