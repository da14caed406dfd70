"""What `collect` says of a run: a row for each student, what was left and why, and who is missing."""

from collections import defaultdict
from collections.abc import Iterator
from datetime import tzinfo

from .collect import Outcome
from .folder import Came

MOST = 5  # files that are named one by one


def table(outcome: Outcome) -> list[tuple[str, str, str, str, str]]:
    """(student, came from, notebooks, handed in, remarks) of each student in each download."""
    return [
        (
            came.student,
            f"{came.form.name}: {came.who}",
            ", ".join(came.notebooks) if len(came.notebooks) < 3 else f"{len(came.notebooks)} notebooks",
            _handed_in(came, outcome.zone),
            "; ".join((*_nothing(came), *came.remarks)),
        )
        for came in outcome.came
    ]


def _nothing(came: Came) -> list[str]:
    return [] if came.written else ["nothing new"] if came.found else ["nothing could be taken"]


def _handed_in(came: Came, zone: tzinfo | None) -> str:
    time = f"{came.time.astimezone(zone):%Y-%m-%d %H:%M %Z}" if came.time else ""
    return f"{time} LATE".strip() if came.late else time


def lines(outcome: Outcome, zone: str | None, dry_run: bool) -> Iterator[str]:
    """Sentences below the table."""
    for download, left in outcome.left.items():
        reasons = defaultdict(list)
        for one in left:
            reasons[one.why, one.look].append(one)
        for (why, _), some in sorted(reasons.items(), key=lambda each: not each[0][1]):
            files = [name for one in some for name in one.files]
            people = list(dict.fromkeys(one.whose for one in some if one.whose))
            whose = f"{', '.join(people)}: " if people else ""
            yield f"{download}: left: {whose}{why}" + (f" ({_some(files)})." if files else ".")
    if outcome.missing:
        yield f"Nothing handed in: {', '.join(outcome.missing)}."
    if outcome.unsettled:
        yield f"Left, see above: {', '.join(outcome.unsettled)}."
    if outcome.zoneless:
        yield f"Times in files' names are taken as local time {f'of {zone}' if zone else 'of this machine (--timezone)'}."
    written = sum(bool(came.written) for came in outcome.came)
    students = len({came.student for came in outcome.came})
    if not outcome.came:
        yield "Nothing was taken."
    elif not written:
        yield f"Nothing is new: {students} {'student' if students == 1 else 'students'}, all as they were."
    else:
        count = sum(len(came.written) for came in outcome.came)
        would = "would be written" if dry_run else "were written"
        yield f"{students} {'student' if students == 1 else 'students'}; {count} files {would}" + (
            "; nothing was, this was a dry run." if dry_run else " into submitted/. Next: python3 -m autograder grade"
        )


def _some(names):
    more = len(names) - MOST
    return ", ".join(names[:MOST]) + (f" and {more} more" if more > 0 else "")


def needs_a_look(outcome: Outcome) -> bool:
    left = [one for some in outcome.left.values() for one in some]
    nothing = not outcome.came and any(one.files for one in left)
    return nothing or any(one.look for one in left) or any(came.look for came in outcome.came)
