"""Grading on a Dask cluster: a real one, with workers in processes of their own."""

import json
import os
import shutil
import signal
import subprocess
import sys
import threading

import pytest
from support import marks, run, wait_for

from autograder.course import Course

pytestmark = pytest.mark.usefixtures("sandboxed")


@pytest.fixture
def cluster(course):
    """A scheduler and two workers in the course's folder, as `dask scheduler` and `dask worker` start them."""
    from distributed import LocalCluster

    here = os.getcwd()
    os.chdir(course.root)
    try:
        with LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1"
        ) as cluster:
            yield cluster
    finally:
        os.chdir(here)


def test_a_class_is_graded_on_a_cluster_and_a_worker_that_is_killed_costs_nothing(
    course, hand_in, solved, tmp_path, cluster
):
    for number in range(8):
        hand_in(course, f"student_{number}", solved)
    hand_in(course, "student_9", {name: course.release / f"{name}.ipynb" for name in course.notebooks})
    alone = Course(shutil.copytree(course.root, tmp_path / "alone"))
    assert run(alone, "grade", "--no-feedback")[0] == 0

    victim = next(iter(cluster.workers.values())).pid
    killed = threading.Event()

    def kill():
        wait_for(lambda: list(course.root.glob("autograded/*/transforms/5_pre_grasp.ipynb")))
        os.kill(victim, signal.SIGKILL)
        killed.set()

    threading.Thread(target=kill, daemon=True).start()
    code, said = run(course, "grade", "--no-feedback", "--scheduler", cluster.scheduler_address)
    assert killed.is_set()
    assert code == 0, said
    assert "9 graded" in said
    assert marks(course) == marks(alone)
    assert len({mark for mark in marks(course).values() if isinstance(mark, tuple)}) > 3


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "no address"])
def test_a_scheduler_that_does_not_answer_is_said(course, hand_in, solved, address):
    hand_in(course, "ann", solved)
    code, said = run(course, "grade", "--scheduler", address)
    assert code == 2 and f"No Dask scheduler answers at {address}" in said and "dask worker" in said


def test_a_scheduler_without_workers_is_said(course, hand_in, solved):
    hand_in(course, "ann", solved)
    command = [sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard", "--no-show"]
    scheduler = subprocess.Popen(
        [*command, "--scheduler-file", course.root / "scheduler.json"], cwd=course.root, stderr=subprocess.DEVNULL
    )
    try:
        wait_for((course.root / "scheduler.json").exists)
        address = json.loads((course.root / "scheduler.json").read_text())["address"]
        code, said = run(course, "grade", "--scheduler", address)
        assert code == 2 and "has no workers" in said
    finally:
        scheduler.terminate()
        scheduler.wait(30)
