"""Where work on many submissions is done: in processes of this machine, or on a Dask cluster.

Both have `each(items)`, which yields (item, what came of it, or a Failure) as they are done.
"""

import gc
import itertools
import multiprocessing
import multiprocessing.connection
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, wait
from typing import Any

import psutil

from ..course import CourseError
from ..intake.submission import Submission
from .failure import Failure
from .grade import GradingRun, grade_submission

PROCESSOR = 30.0  # seconds that the grader's own work on a submission may take; the sandbox has its Limits
MEMORY = 1_000_000_000  # bytes that it may take
GLANCE = 0.2  # seconds between two looks at what workers use
SLOW = 5.0  # seconds after which others no longer wait for whoever is worked on
MOMENT = 2.0  # seconds for a worker to end by itself
EXTRA = 4  # workers that are started in the stead of slow ones
EACH_AHEAD = 2  # submissions for each worker of a cluster that are on their way
PATIENCE = 10  # seconds for a scheduler to answer


DIED = Failure("its grading process ended all of a sudden, twice; is there enough memory?", of_content=True)


class Processes:
    """Processes of this machine, each of which works on one thing at a time.

    What they may use for it is watched from here, where nothing that is handed in can change it: a process that is over a
    limit is ended, and its work is a Failure.

    function: from an item to what comes of it; jobs: how many work at a time, slow ones not counted
    """

    def __init__(self, function: Callable[[Any], Any], jobs: int):
        self.function, self.jobs = function, jobs

    def each(self, items: Iterable) -> Iterator[tuple[Any, Any]]:
        """Yields (item, what came of it, or a Failure) as they are done; items are taken when there is a worker for them."""
        items = iter(items)
        again: list = []  # of whom a worker has died
        tried_again: list = []
        idle: list[_Worker] = []
        busy: list[_Worker] = []
        done: list = []  # handed on when the workers have their next
        try:
            while True:
                while sum(not worker.slow for worker in busy) < self.jobs and len(busy) < self.jobs + EXTRA:
                    if not (taken := again or list(itertools.islice(items, 1))):
                        break
                    busy.append(idle.pop() if idle else _Worker(self.function))
                    busy[-1].begin(taken.pop())
                yield from done
                done.clear()
                if not busy:
                    return
                ready = multiprocessing.connection.wait([worker.connection for worker in busy], GLANCE)
                for worker in list(busy):
                    found = worker.outcome() if worker.connection in ready else worker.excess()
                    if not found:
                        continue
                    busy.remove(worker)
                    if worker.alive:
                        idle.append(worker)
                    if found[0] is DIED and worker.item not in tried_again:
                        again.append(worker.item)
                        tried_again.append(worker.item)
                    else:
                        done.append((worker.item, found[0]))
        finally:
            for worker in (*idle, *busy):
                worker.end()


class _Worker:
    """One process of a pool, and what it works on."""

    def __init__(self, function):
        self.connection, theirs = multiprocessing.Pipe()
        self.process = multiprocessing.Process(target=_work, args=(function, theirs))
        self.process.start()
        theirs.close()
        self.alive, self.item = True, None
        self.used = psutil.Process(self.process.pid)

    def begin(self, item):
        self.item, self.since, self.before = item, time.monotonic(), self._usage()
        self.connection.send(item)

    @property
    def slow(self):
        return time.monotonic() - self.since > SLOW

    def outcome(self):
        """(what it sends,), or (DIED,)"""
        try:
            return self.connection.recv()
        except (EOFError, OSError):
            self.end()
            return (DIED,)

    def excess(self):
        """(a Failure,) when it is over a limit, and has been ended for it; else None."""
        processor, memory = (now - then for now, then in zip(self._usage(), self.before))
        if processor > PROCESSOR:
            words = f"more than {PROCESSOR:g} s of processor time"
        elif memory > MEMORY:
            words = f"more than {MEMORY / 1e9:g} GB of memory"
        else:
            return None
        self.end()
        return (Failure(f"the grader's own work on it took {words}", True),)

    def _usage(self):
        """(seconds of processor time, bytes of memory) of the process itself; what is in a sandbox is counted there."""
        try:
            times = self.used.cpu_times()
            return times.user + times.system, self.used.memory_info().rss
        except psutil.Error:
            return 0.0, 0  # it has ended; its connection tells

    def end(self):
        """End it: it has a moment to close what it has opened."""
        self.alive = False
        self.process.terminate()
        self.process.join(MOMENT)
        self.process.kill()
        self.process.join()
        self.connection.close()


def _work(function, connection):
    """The life of a worker: what it is sent is worked on, until nobody is there any more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the grader, which ends this process
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    gc.freeze()  # what the grader has loaded is not searched for garbage again and again
    threading.Thread(target=_end_with, args=(multiprocessing.parent_process(),), daemon=True).start()
    while True:
        try:
            item = connection.recv()
        except EOFError:
            os._exit(0)
        try:
            outcome = function(item)
        except Exception as error:
            outcome = Failure.of(error)
        connection.send((outcome,))


def _end_with(parent):
    """Even when the grader is killed, nothing of it goes on."""
    parent.join()
    os._exit(1)


class Cluster:
    """The workers of a Dask scheduler, each in a clone of the course at the same path; a context manager.

    Their memory is watched by Dask, which ends a worker that takes too much.
    """

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

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.executor.shutdown(wait=False)
        self.client.close()

    def each(self, submissions: Iterable[Submission], run: GradingRun) -> Iterator[tuple[Submission, Any]]:
        """Yields (submission, Graded or Failure) as they are done."""
        sent = self.client.submit(_itself, run, pure=False)  # as a task, to be sent again when its worker is lost
        running: dict = {}
        for submission in itertools.chain(submissions, [None]):  # None: all are on their way
            if submission is not None:
                running[self.executor.submit(grade_submission, submission, sent)] = submission
            while running and (submission is None or len(running) >= self.ahead):
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    yield running.pop(future), _outcome(future)

    def unprotected(self):
        """The addresses of the scheduler and the workers that others in the network can use."""
        from .network import unprotected  # not before: distributed sets up logs of its own

        return unprotected(self.client)

    def ask(self, function, *arguments):
        """What a function answers on one of the workers."""
        return self.client.submit(function, *arguments, pure=False).result()


def _itself(value):
    return value


def _outcome(future):
    error = future.exception()
    if error is None:
        return future.result()
    return DIED if type(error).__name__ == "KilledWorker" else Failure.of(error)
