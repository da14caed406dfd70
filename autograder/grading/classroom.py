"""Many submissions at once: workers grade, one writer records, what is unchanged is left alone.

Nothing that one student hands in may stop the others: whatever goes wrong with a submission is said, and the rest goes on.
"""

from concurrent.futures import FIRST_COMPLETED, wait
from concurrent.futures.process import BrokenProcessPool

from ..intake.submission import submission_of
from .records import recorded, recorded_alone
from .workers import Processes


def grade_class(course, students, run, writer, jobs, force=False, cluster=None):
    """Grade and record; yields (student, Graded or None when unchanged, what went wrong or None) as they are done.

    cluster: the workers.Cluster to use instead of processes of this machine, as many as `jobs`
    """
    known = writer.students()
    if cluster:
        cluster.load(run)
    pool, running = cluster or Processes(run, jobs), {}
    try:
        for student in [*students, None]:  # None: all are on their way
            if student is not None:
                try:
                    submission = submission_of(course, student)
                    unchanged = not force and student in known and _unchanged(course, submission, run)
                except OSError as error:
                    yield student, None, _words(error)
                    continue
                if unchanged:
                    yield student, None, None
                    continue
                running[pool.submit(submission)] = submission
            while running and (student is None or len(running) >= pool.ahead):
                done = wait(running, return_when=FIRST_COMPLETED).done
                if any(isinstance(future.exception(), BrokenProcessPool) for future in done):
                    # One of these brought a worker down: graded one by one, only that one fails.
                    pool.close()
                    suspects, running = list(running.values()), {}
                    for submission in suspects:
                        alone = Processes(run, 1)
                        future = alone.submit(submission)
                        wait([future])
                        alone.close()
                        yield _record(writer, submission.student, future)
                    pool = Processes(run, jobs)
                    continue
                for future in done:
                    yield _record(writer, running.pop(future).student, future)
    finally:
        if pool is not cluster:  # which belongs to the caller
            pool.close()


def _record(writer, student, future):
    error = future.exception()
    if type(error).__name__ in ("BrokenProcessPool", "KilledWorker"):  # of the pool, of Dask
        return student, None, "its grading process ended all of a sudden; is there enough memory?"
    if error is not None:
        return student, None, _words(error)
    try:
        writer.record(future.result())
    except Exception as error:  # a full disk, a locked database, …: said for this student, and tried again next time
        return student, None, _words(error)
    return student, future.result(), None


def _words(error):
    return f"{type(error).__name__}: {' '.join(str(error).split())}"[:300]


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
