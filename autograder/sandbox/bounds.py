"""What a sandbox may use, and where in it a notebook lies."""

from dataclasses import dataclass
from pathlib import Path

COURSE = Path("/course")  # where notebooks run inside; the students' package lies in it
WRITABLE = (Path("/tmp"), Path("/dev/shm"), COURSE)
FOLDER = 50_000_000  # bytes in each of them
SIGNALS = 1_000  # that wait, and timers, each of which has one: the kernel's memory
PATIENCE = 60.0  # seconds for a sandbox to open or close, on a machine under load


WALL = 10  # times a limit that may pass in all, however busy the machine


class NotStarted(RuntimeError):
    """The sandbox did not come up; the message has the reason that bubblewrap gave."""


@dataclass(frozen=True)
class Limits:
    """What a notebook may use. Seconds are of time in which it could run: waiting for a busy processor is not counted.

    A call or a cell that reaches its limit costs itself, and halves the limit of those that follow (see Allowance); a
    notebook or submission that does costs its exercises from there on. A notebook has its limit for its cells, and once
    more for the calls.
    """

    cell: float = 6.0
    call: float = 3.0
    notebook: float = 15.0
    submission: float = 30.0
    grace: float = 1.0  # between the interrupt and the end of the process
    cpu: float = 60.0  # of processor time, all processes of a notebook together
    memory: int = 2_000_000_000  # bytes of address space for each process, and of memory for all of them together
    processes: int = 40  # threads count, too
    file: int = 20_000_000  # bytes of one file
    files: int = 20_000
    descriptors: int = 64  # open files, pipes and sockets of a process; what is in them counts nowhere else

    def resources(self):
        """For resource.setrlimit, inside the sandbox."""
        return {
            "RLIMIT_AS": self.memory,
            "RLIMIT_CPU": int(self.cpu) + 1,
            "RLIMIT_FSIZE": self.file,
            "RLIMIT_CORE": 0,
            "RLIMIT_NPROC": self.processes,
            "RLIMIT_NOFILE": self.descriptors,
            "RLIMIT_SIGPENDING": SIGNALS,
        }


class Allowance:
    """The time of a notebook or submission, in which its processes are waited for.

    seconds: how much there is; whole: the Allowance that it is a part of
    """

    LEAST_PATIENCE = 0.25

    def __init__(self, seconds, whole=None):
        self.seconds, self.whole, self._patience = seconds, whole, 1.0

    @property
    def left(self):
        """Seconds that are left of it and of the whole."""
        return min(self.seconds, self.whole.left) if self.whole else self.seconds

    def use(self, seconds):
        """Take these; less than 0 gives back what was spent waiting for a processor."""
        self.seconds -= seconds
        if self.whole:
            self.whole.use(seconds)

    @property
    def patience(self):
        """The share of a limit that the next cell or call has."""
        return self.whole.patience if self.whole else self._patience

    def limit_reached(self):
        """Whoever does so again and again is waited for half as long each time: others wait for their grades."""
        if self.whole:
            self.whole.limit_reached()
        self._patience = max(self._patience / 2, self.LEAST_PATIENCE)
