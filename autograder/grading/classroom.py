"""Many submissions at once: workers read and grade, one writer records, what is unchanged is left alone.

Nothing that one student hands in may stop the others. What cannot be judged earns nothing and is said, in a row, on a
page and in a line; only what this machine lacks (a disk, a database) leaves a student ungraded, until the next time.
"""

from functools import partial

from sqlalchemy.exc import SQLAlchemyError

from ..course import CourseError
from ..intake.submission import submission_of
from .failure import Failure
from .grade import grade_submission, not_judged
from .records import recorded, recorded_alone
from .workers import Processes


def grade_class(course, students, run, writer, jobs, force=False, cluster=None):
    """Grade and record; yields (student, Graded or None when unchanged, what went wrong or None) as they are done.

    cluster: the workers.Cluster to use instead of processes of this machine, as many as `jobs`
    """
    known = frozenset() if force else frozenset(writer.students())
    for student, found in _found(course, students, run, jobs, known, cluster):
        if isinstance(found, Failure):
            if not found.of_content:
                yield student, None, found.words
                continue
            found = not_judged(course, student, run, found.words)
        if found is None:
            yield student, None, None
            continue
        problem = _record(writer, found)
        if problem and problem.of_content:
            found = not_judged(course, student, run, problem.words)
            problem = _record(writer, found)
        yield student, None if problem else found, problem and problem.words


def _found(course, students, run, jobs, known, cluster):
    """Yields (student, Graded, None when unchanged, or Failure)."""
    if not cluster:
        yield from Processes(partial(_graded, course, run, known), jobs).each(students)
        return
    aside = []

    def submissions():
        for student, read in Processes(partial(_submission, course, run, known), jobs).each(students):
            if read is None or isinstance(read, Failure):
                aside.append((student, read))
            else:
                yield read

    for submission, found in cluster.each(submissions(), run):
        yield from aside
        aside.clear()
        yield submission.student, found
    yield from aside


def _graded(course, run, known, student):
    submission = _submission(course, run, known, student)
    return submission and grade_submission(submission, run)


def _submission(course, run, known, student):
    """What a student of those `known` handed in, or None when it is unchanged."""
    submission = submission_of(course, student)
    return None if student in known and _unchanged(course, submission, run) else submission


def _record(writer, graded):
    """Record; a Failure, or None."""
    try:
        writer.record(graded)
    except Exception as error:
        return Failure.of(error, SQLAlchemyError, CourseError)  # locked, full, read-only, …
    return None


def _unchanged(course, submission, run):
    """Whether the same files were graded under the same specification before."""
    records = recorded(course, submission.student)
    alone = None if records else recorded_alone(course, submission.student)
    handed_in = {name for name in run.released if f"{name}.ipynb" in submission.files}
    found = [*records.values(), *([alone] if alone else [])]
    return (
        bool(found)
        and set(records) == handed_in
        and all(
            record.get("submission") == submission.digest and record.get("specification") == run.digest
            for record in found
        )
    )
