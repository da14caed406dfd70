"""The proof of an exercise: everything is measured in as many processes as there are cores, then a case is searched for."""

import os
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass, field
from functools import cache

from ..course import Course, CourseError
from ..exercises import EXERCISES
from .adequacy import NAMED_EVERY, Found, measure, misnamed, refused, slips_through
from .bands import empty_bands
from .errors import told
from .search import Search
from .solutions import made_no_longer, to_be_tried

SPAN = 8  # seeds that a process measures at a time


@dataclass
class Proof:
    """What was found about one exercise.

    cases: {label of something wrong that slips through: a case that would catch it, as code, or None}
    """

    exercise: object
    seeds: tuple
    tried: list
    found: list
    made_no_longer: list
    empty: dict  # {(feature, band): seeds without a case in it}
    cases: dict = field(default_factory=dict)

    def of(self, *kinds):
        """[(Tried, Found)] of these kinds."""
        return [(each, what) for each, what in zip(self.tried, self.found) if each.kind in kinds]

    @property
    def solved(self):
        """Whether a notebook has a solution."""
        return any(each.notebook for each, _ in self.of("right"))

    @property
    def slipping(self):
        return [(each, what) for each, what in zip(self.tried, self.found) if slips_through(each, what)]

    @property
    def refused(self):
        return [(each, what) for each, what in zip(self.tried, self.found) if refused(each, what)]

    @property
    def misnamed(self):
        return [(each, what) for each, what in self.of("misconception") if misnamed(each, what) and not what.accepted]

    @property
    def open(self):
        """The number of things that an author has to look at."""
        lists = self.slipping, self.refused, self.misnamed, self.made_no_longer, self.empty
        return sum(map(len, lists)) + (not self.solved)


def prove(course, names, seeds, advance=lambda: None):
    """Yield the Proof of each of these exercises, in order; `advance` is called `steps(names, seeds)` times."""
    named = seeds[::NAMED_EVERY]
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        jobs = {
            name: [pool.submit(_measured, course.root, name, span, named) for span in _spans(seeds)] for name in names
        }
        try:
            for name in names:
                for job in as_completed(jobs[name]):
                    job.result()
                    advance()
                yield _proof(course, name, seeds, [job.result() for job in jobs[name]])
                advance()
        finally:
            pool.shutdown(cancel_futures=True)


def steps(names, seeds):
    return len(names) * (len(_spans(seeds)) + 1)


def _spans(seeds):
    return [seeds[start : start + SPAN] for start in range(0, len(seeds), SPAN)]


def _proof(course, name, seeds, measured):
    tried = _tried(course.root, name)
    found, empty = [Found() for _ in tried], {}
    for part, without in measured:
        for total, what in zip(found, part):
            total += what
        for band, some in without.items():
            empty.setdefault(band, []).extend(some)
    proof = Proof(EXERCISES[name], seeds, tried, found, made_no_longer(EXERCISES[name], tried), empty)
    if proof.slipping:
        search = Search(EXERCISES[name], [each.function for each, what in proof.of("right") if not what.refused])
        proof.cases = {
            each.label: None if each.kind == "cheat" else search.case_for(each.function) for each, _ in proof.slipping
        }
    return proof


def _measured(root, name, seeds, named):
    try:
        return measure(EXERCISES[name], _tried(root, name), seeds, named), empty_bands(EXERCISES[name], seeds)
    except Exception as error:
        raise CourseError(f"{name} cannot be proved: {told(error)}") from None


@cache
def _tried(root, name):
    return to_be_tried(Course(root), EXERCISES[name])
