"""Where submissions are graded: in processes of this machine, or on a Dask cluster. The work is the same pure function.

Both have `submit(submission)`, which gives a concurrent.futures.Future of a Graded, and `ahead`, how many submissions
to read in advance.
"""

import gc
import multiprocessing
import os
import threading
from concurrent.futures import ProcessPoolExecutor

from ..course import CourseError
from .grade import grade_submission

EACH_AHEAD = 2  # submissions for each worker that are read in advance
PATIENCE = 10  # seconds for a scheduler to answer


class Processes:
    """A pool of processes on this machine."""

    def __init__(self, run, jobs):
        self.pool = ProcessPoolExecutor(jobs, initializer=_start, initargs=(run,))
        self.ahead = EACH_AHEAD * jobs

    def close(self):
        """Wait for what is being graded; what has not begun is dropped."""
        self.pool.shutdown(cancel_futures=True)

    def submit(self, submission):
        return self.pool.submit(_grade, submission)


class Cluster:
    """The workers of a Dask scheduler, each in a clone of the course at the same path; a context manager."""

    def __init__(self, address):
        from distributed import Client
        from distributed.comm import get_address_host_port

        from .network import expect_tls_of_both

        try:
            get_address_host_port(address)  # of a text that is no address, Client would say so with a traceback
            expect_tls_of_both(address)
            self.client = Client(address, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError) as error:
            raise CourseError(
                f"No Dask scheduler answers at {address} ({' '.join(str(error).split())[:150]}). Start one with "
                f"`dask scheduler`, and workers with `dask worker {address}` in this folder on each machine."
            ) from None
        threads = sum(self.client.nthreads().values())
        if not threads:
            self.client.close()
            raise CourseError(
                f"The Dask scheduler at {address} has no workers. Start some with `dask worker {address}` in this folder."
            )
        self.ahead = EACH_AHEAD * threads
        self.executor = self.client.get_executor(pure=False)

    def load(self, run):
        """Send what submissions are graded against: as a task, so that it is sent again when its worker is lost."""
        self.run = self.client.submit(_itself, run, pure=False)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.executor.shutdown(wait=False)
        self.client.close()

    def submit(self, submission):
        return self.executor.submit(grade_submission, submission, self.run)

    def ask(self, function, *arguments):
        """What a function answers on one of the workers."""
        return self.client.submit(function, *arguments, pure=False).result()


def _itself(value):
    return value


_run = None  # in a process of the pool: what it grades against, sent once; None once it was told to stop


def _start(run):
    global _run
    _run = run
    gc.freeze()  # what the grader has loaded is not searched for garbage again and again
    end_with_parent()


def end_with_parent():
    """Make this process of a pool end when the grader does, even when the grader is killed."""
    parent = multiprocessing.parent_process()
    threading.Thread(target=lambda: (parent.join(), os._exit(1)), daemon=True).start()


def _grade(submission):
    global _run
    if _run is None:
        raise KeyboardInterrupt
    try:
        return grade_submission(submission, _run)
    except KeyboardInterrupt:
        _run = None  # Ctrl-C: this worker's other submissions wait for the next run
        raise
