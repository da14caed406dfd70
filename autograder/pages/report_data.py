"""What the records of a graded class tell: each function is one section of the class report, as plain data.

Throughout, `works` is {student: Work}, in the order in which they are to be shown.
"""

import itertools
import os
from collections import Counter, defaultdict
from dataclasses import asdict, dataclass, field, replace
from datetime import UTC, datetime
from math import ceil
from statistics import correlation, median
from typing import NamedTuple

from transform_lab.judging import panel
from transform_lab.judging.status import STATUSES

from ..grading.records import missing, recorded, recorded_alone, verdicts
from ..intake.submission import NOT_HANDED_IN

MOST_BARS = 10  # of the distribution of points, besides the one for all points
FEWEST = 10  # students of whom a correlation tells anything
MOST_PAIRS = 10  # of misconceptions that go together
BOTH, TOGETHER = 3, 0.4  # from so many students, and this correlation, on they do
SLOW, TIMES_SLOWER = 10.0, 5  # seconds, and times the median, from which on a student's grading stands out


@dataclass
class Work:
    """What is recorded of one student's work.

    rows: a Row for each exercise; said: {exercise: [(what the answer shows, the hint) for each mistake]}, as the student reads
    undone: exercises that nobody has filled in; absent: notebooks that were not handed in
    by_hand: {exercise: the grader's own points}, where a person has given others in their place
    problems: what was odd about the files, in words; runs: {seed of the hidden cases: when it was used last}
    seconds: of waiting for its processes, with which grading took its time
    """

    rows: list = field(default_factory=list)
    said: dict = field(default_factory=dict)
    undone: set = field(default_factory=set)
    by_hand: dict = field(default_factory=dict)
    absent: list = field(default_factory=list)
    problems: list = field(default_factory=list)
    seconds: float = 0.0
    runs: dict = field(default_factory=dict)

    @property
    def points(self):
        return sum(row.score for row in self.rows)

    @property
    def most(self):
        return sum(row.max_score for row in self.rows)

    def take(self, grades):
        """Have the points be those of the gradebook, {notebook: NotebookGrades}, where a person has given some by hand."""
        for i, row in enumerate(self.rows):
            if row.notebook in grades and grades[row.notebook].by_hand(row.exercise):
                self.by_hand[row.exercise] = row.score
                self.rows[i] = replace(row, score=grades[row.notebook].cells[row.exercise].earned)

    def remark(self, row):
        """What a table says of a row in a word or two; "" where there is nothing to say."""
        return "; ".join(filter(None, [row.remark, "points by hand" if row.exercise in self.by_hand else ""]))

    def is_undone(self, row):
        return STATUSES[row.status].counts == "undone" or row.exercise in self.undone


def work(course, student):
    """The Work of a student, from the autograded notebooks; records of an older grader may lack the words."""
    found, records, problems = Work(), recorded(course, student), {}
    for name, released in course.notebooks.items():
        if name not in records:
            found.rows += missing(released)
            if os.path.lexists(course.submitted(student) / f"{name}.ipynb"):
                problems[f"{name}.ipynb: not graded yet; run `python3 -m autograder grade`."] = None
            else:
                found.absent.append(name)
            continue
        record = records[name]
        found.rows += record["rows"]
        for exercise, verdict in verdicts(record).items():
            found.said[exercise] = panel.mistakes(verdict)
            if not verdict.done:
                found.undone.add(exercise)
        problems |= dict.fromkeys(record["problems"])
        graded = datetime.fromisoformat(record["graded"]).astimezone()
        found.seconds += float(record.get("seconds", 0.0))  # not in records of an older grader
        found.runs[record["seed"]] = max(graded, found.runs.get(record["seed"], graded))
    if not records and (alone := recorded_alone(course, student)):
        problems |= dict.fromkeys(alone["problems"])
    said_elsewhere = {NOT_HANDED_IN.format(f"{name}.ipynb") for name in found.absent}
    found.problems = [problem for problem in problems if problem not in said_elsewhere]
    return found


# --- which runs -----------------------------------------------------------------------------------------------------


class Run(NamedTuple):
    """A grading run: its last notebook's time, the seed of its hidden cases, how many students it graded."""

    graded: datetime
    seed: int
    students: int


def runs(works):
    """The Runs whose verdicts these are, the last one first."""
    last, students = {}, Counter()
    for found in works.values():
        for seed, graded in found.runs.items():
            last[seed] = max(graded, last.get(seed, datetime.min.replace(tzinfo=UTC)))
            students[seed] += 1
    return sorted((Run(graded, seed, students[seed]) for seed, graded in last.items()), reverse=True)


# --- what the class misunderstands ----------------------------------------------------------------------------------


class Misunderstood(NamedTuple):
    """A misconception in this class.

    exercises: [(name, how many students have it there)], the most frequent first
    says, hint: the words that most students read about it; "" where the records hold none
    """

    id: str
    students: int
    exercises: list
    says: str
    hint: str


def misunderstood(works):
    """The class's misconceptions, the most frequent first."""
    who, where, said = defaultdict(set), defaultdict(Counter), defaultdict(Counter)
    order = [row.exercise for found in works.values() for row in found.rows]
    for student, found in works.items():
        for row in found.rows:
            identifiers = row.misconception.split(";") if row.misconception else []
            mistakes = found.said.get(row.exercise, [])
            for i, identifier in enumerate(identifiers):
                who[identifier].add(student)
                where[identifier][row.exercise] += 1
                words = tuple(mistakes[i]) if len(mistakes) == len(identifiers) else ("", "")
                said[identifier][row.exercise, words] += 1
    result = []
    for identifier, students in who.items():
        exercises = sorted(where[identifier].items(), key=lambda item: (-item[1], order.index(item[0])))

        def fitting(key, times=said[identifier], where=where[identifier]):
            exercise, words = key
            return any(words), where[exercise], times[key]

        _, (says, hint) = max(said[identifier], key=fitting)
        result.append(Misunderstood(identifier, len(students), exercises, says, hint))
    return sorted(result, key=lambda found: (-found.students, -sum(n for _, n in found.exercises), found.id))


class Pair(NamedTuple):
    """Two misconceptions that go together: how many students have either, and both."""

    one: str
    other: str
    of_one: int
    of_other: int
    both: int


def together(works):
    """The Pairs of misconceptions that students have together much more often than chance would have it, the closest first.

    The measure is the phi coefficient, which is the correlation of the two as numbers 0 and 1. Left out is what one function
    has in several parts at once, such as two mistakes in one exercise.
    """
    if len(works) < FEWEST:
        return []
    who: dict = defaultdict(lambda: defaultdict(set))  # {misconception: {student: {exercises}}}
    for student, found in works.items():
        for row in found.rows:
            for identifier in filter(None, row.misconception.split(";")):
                who[identifier][student].add(row.exercise)
    pairs = []
    for one, other in itertools.combinations(sorted(who), 2):
        both = {s for s in who[one].keys() & who[other].keys() if len(who[one][s] | who[other][s]) > 1}
        if len(both) >= max(BOTH, len(works) / 50):
            have = [[student in who[of] for student in works] for of in (one, other)]
            if not any(all(each) for each in have) and (phi := correlation(*have)) >= TOGETHER:
                pairs.append((phi, Pair(one, other, len(who[one]), len(who[other]), len(both))))
    return [pair for _, pair in sorted(pairs, key=lambda found: (-found[0], found[1]))[:MOST_PAIRS]]


# --- scores ---------------------------------------------------------------------------------------------------------


def distribution(works):
    """[(label, how many students have that many points)]: equal steps, and all points by themselves."""
    most = max((found.most for found in works.values()), default=0.0)
    step = next((step for step in (1, 2, 5, 10, 20, 50) if ceil(most / step) <= MOST_BARS), most or 1)
    bars = [0] * ceil(most / step) + [0]
    for found in works.values():
        bars[-1 if found.points >= most else int(found.points // step)] += 1
    labels = [f"{start * step} to under {min((start + 1) * step, most):g}" for start in range(len(bars) - 1)]
    return list(zip([*labels, f"all {most:g}"], bars))


class Result(NamedTuple):
    """What a class made of an exercise: numbers of students that add up to the class, and the average share of points."""

    exercise: str
    right: int
    named: int  # wrong, and the misconception is known
    unnamed: int  # wrong in a way that has no name
    failed: int  # raised an error, was stopped, or cannot be read
    undone: int  # left as it was, or not handed in
    average: float
    tells: float | None  # how well it tells strong from weak, see `_tells`


def results(works):
    """{notebook: [Result for each of its exercises]}"""
    found = {}
    for column in zip(*(work.rows for work in works.values())):
        counts = Counter(_outcome(work, row) for work, row in zip(works.values(), column))
        shares = [row.score / row.max_score if row.max_score else 1.0 for row in column]
        kinds = (counts[kind] for kind in ("right", "named", "unnamed", "failed", "undone"))
        first = column[0]
        rest = [work.points - row.score for work, row in zip(works.values(), column)]
        average = sum(shares) / len(shares)
        found.setdefault(first.notebook, []).append(Result(first.exercise, *kinds, average, _tells(shares, rest)))
    return found


def _tells(shares, rest):
    """The correlation between what each student earned here and in all other exercises (the corrected item-total correlation
    of test theory); None where too few handed in, or all earned the same.
    """
    if len(shares) < FEWEST or min(shares) == max(shares) or min(rest) == max(rest):
        return None
    return correlation(shares, rest)


def _outcome(work, row):
    if work.is_undone(row):
        return "undone"
    if row.score == row.max_score:
        return "right"
    return "named" if row.misconception else STATUSES[row.status].counts


# --- who needs a look -----------------------------------------------------------------------------------------------


class Look(NamedTuple):
    """Students with the reasons to look at their work.

    reasons: {title: {student: {what was said: [exercises]}}}, the titles as in STATUSES; files: {student: [what was odd]}
    absent: {notebook: [students]}
    """

    reasons: dict
    files: dict
    absent: dict


def look(works):
    """The Look at a class. What is explained by a misconception, and what is just not done, is no reason."""
    reasons = {status.look: {} for status in STATUSES.values() if status.look}
    absent = defaultdict(list)
    for student, found in works.items():
        for row in found.rows:
            title = STATUSES[row.status].look
            if title and not row.misconception and row.exercise not in found.undone:
                says = " ".join(says for says, _ in found.said.get(row.exercise, ()))
                told = reasons[title].setdefault(student, {})
                told.setdefault(says or f"status {row.status}: {STATUSES[row.status].means}", []).append(row.exercise)
        for notebook in found.absent:
            absent[notebook].append(student)
    files = {student: found.problems for student, found in works.items() if found.problems}
    return Look({title: who for title, who in reasons.items() if who}, files, dict(sorted(absent.items())))


def slow(works):
    """{student: (seconds, how many times the median)} of those whose grading took much longer than the others'."""
    usual = median([found.seconds for found in works.values() if found.seconds] or [0.0])
    return {
        student: (found.seconds, found.seconds / usual)
        for student, found in works.items()
        if found.seconds > SLOW and found.seconds > TIMES_SLOWER * usual
    }


# --- what changed ---------------------------------------------------------------------------------------------------


class Changes(NamedTuple):
    """Between two runs. scores: {student: [(exercise, points before, points now)]}, who lost most first."""

    scores: dict
    new: list
    gone: list

    @property
    def better(self):
        return sum(_gain(changed) > 0 for changed in self.scores.values())

    @property
    def worse(self):
        return sum(_gain(changed) < 0 for changed in self.scores.values())


def changes(before, works):
    """The Changes since `before`, {student: {exercise: points}}."""
    now = {student: {row.exercise: row.score for row in found.rows} for student, found in works.items()}
    scores = {}
    for student in now.keys() & before.keys():
        old = before[student]
        moved = [(name, old[name], new) for name, new in now[student].items() if name in old and old[name] != new]
        if moved:
            scores[student] = moved
    ordered = dict(sorted(scores.items(), key=lambda item: (_gain(item[1]), item[0])))
    return Changes(ordered, sorted(now.keys() - before.keys()), sorted(before.keys() - now.keys()))


class Then(NamedTuple):
    """A share of students then and now, from 0 to 1; `then` is None for what there was not."""

    name: str
    then: float | None
    now: float


def compared(before, works):
    """([Then of each exercise's average share of points], [Then of each misconception's share of students]), those that moved
    most first.

    before: [row of another class's verdicts.csv, as a dictionary]; raises ValueError or LookupError where it is none
    """
    (earned, had), (earns, have) = _shares(before), _shares(_as_read(works))
    exercises = [Then(name, earned.get(name), now) for name, now in earns.items()]
    misconceptions = [Then(name, had.get(name, 0.0), have.get(name, 0.0)) for name in {**have, **had}]
    return tuple(
        sorted(found, key=lambda of: (-abs(of.now - (of.now if of.then is None else of.then)), of.name))
        for found in (exercises, misconceptions)
    )


def _as_read(works):
    for student, found in works.items():
        for row in found.rows:
            yield {"student": student, **asdict(row)}


def _shares(rows):
    """({exercise: average share of points}, {misconception: share of students who have it}) of a class's rows."""
    rows = list(rows)
    students = {row["student"] for row in rows}
    earned, who = defaultdict(list), defaultdict(set)
    for row in rows:
        most = float(row["max_score"])
        earned[row["exercise"]].append(float(row["score"]) / most if most else 1.0)
        for identifier in filter(None, row["misconception"].split(";")):
            who[identifier].add(row["student"])
    return (
        {name: sum(shares) / len(shares) for name, shares in earned.items()},
        {identifier: len(found) / len(students) for identifier, found in who.items()},
    )


def _gain(changed):
    return round(sum(new - old for _, old, new in changed), 6)
