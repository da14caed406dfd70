"""Many submissions at once: a pool of processes grades, one writer records, what is unchanged is left alone."""

import itertools
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait

from .grading import collect, grade_submission, recorded

AHEAD = 4  # submissions for each worker that are read in advance; keeps the grader's memory small


def grade_class(course, students, assignment, writer, jobs, force=False):
    """Grade and record; yields (student, Graded or None when unchanged, what went wrong or None) as they are done."""
    known = writer.students()
    with ProcessPoolExecutor(jobs, initializer=_start, initargs=(assignment,)) as pool:
        waiting, running = iter(students), {}
        while True:
            for student in itertools.islice(waiting, AHEAD * jobs - len(running)):
                submission = collect(course, student)
                if not force and student in known and _unchanged(course, submission, assignment):
                    yield student, None, None
                else:
                    running[pool.submit(_grade, submission)] = student
            if not running:
                if (student := next(waiting, None)) is None:
                    return
                waiting = itertools.chain([student], waiting)
                continue
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                student = running.pop(future)
                error = future.exception()
                if error is not None:
                    yield student, None, " ".join(str(error).split()) or type(error).__name__
                    continue
                writer.record(future.result())
                yield student, future.result(), None


def _unchanged(course, submission, assignment):
    """Whether the same files were graded under the same specification before."""
    records = recorded(course, submission.student)
    handed_in = {name for name in assignment.released if f"{name}.ipynb" in submission.files}
    return set(records) == handed_in and all(
        record.get("submission") == submission.digest and record.get("specification") == assignment.digest
        for record in records.values()
    )


_assignment = None  # in a worker process: what it grades against, sent once


def _start(assignment):
    global _assignment
    _assignment = assignment


def _grade(submission):
    return grade_submission(submission, _assignment)
