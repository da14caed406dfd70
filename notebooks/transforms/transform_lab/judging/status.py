"""The one list of statuses, of which every exercise of every student has one: `status` in verdicts.csv.

A new status is one more entry of STATUSES; commands, report and feedback go by it.
"""

from dataclasses import dataclass

STOPPED = "Had to be stopped"


@dataclass(frozen=True)
class Status:
    """A status.

    means: a sentence; students read it where there is nothing more to say
    counts: the column of the report in which exercises without all points count, unless a misconception explains them:
        "unnamed" (wrong, without a name), "failed" (error or stopped) or "undone" (not done)
    look: the title in "Who needs a look" under which the report lists who has it; "" where it is no reason to look, or said
        by what is odd about the files
    """

    means: str
    counts: str = "failed"
    look: str = "Could not be judged"

    def __post_init__(self):
        if self.counts not in ("unnamed", "failed", "undone"):
            raise ValueError(f"{self.counts!r} is no column of the report; there are unnamed, failed and undone")


STATUSES = {  # the report has their titles in this order
    "graded": Status("Every case was called and compared.", counts="unnamed", look=""),
    "timeout": Status("It did not finish in time.", look=STOPPED),
    "killed": Status("It ended its process, or reached a limit.", look=STOPPED),
    "error": Status("It raised an error, or is not done.", look="Could not be judged, because of an error"),
    "missing": Status("The test cell of this exercise is missing from the file.", counts="undone", look=""),
    "unreadable": Status("The file could not be read.", look=""),
}


def refuse_unknown(status):
    """Raise ValueError for what is none of STATUSES: no page would know how to show it."""
    if status not in STATUSES:
        raise ValueError(f"{status!r} is no status; there are {', '.join(STATUSES)}")
