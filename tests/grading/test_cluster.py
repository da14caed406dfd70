"""Grading on a Dask cluster: a real one, with workers in processes of their own."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import threading

import pytest
from distributed.utils import get_ip
from support import ROOT, lacking, marks, run, wait_for

from autograder.course import Course
from autograder.grading.network import is_open

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
    assert "NOT PROTECTED" not in said  # it listens to this machine alone
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


@pytest.fixture
def started(course):
    """started(program, …): `dask scheduler …` or `dask worker …` in the course's folder, until the end of the test."""
    running = []

    def start(program, *options):
        command = [sys.executable, "-m", f"distributed.cli.dask_{program}", "--no-dashboard", *options]
        running.append(subprocess.Popen(command, cwd=course.root, stderr=subprocess.DEVNULL))

    yield start
    for process in reversed(running):
        process.terminate()
        process.wait(60)


def test_a_class_is_graded_over_tls_as_the_page_sets_it_up(course, hand_in, solved, tmp_path, monkeypatch, started):
    """With certificates made by the documentation's own commands; who has none gets no answer."""
    shutil.which("openssl") or lacking("needs openssl, to make certificates")
    (commands,) = re.findall(
        r"```\n(mkdir -p ~/.config/dask.*?)```",
        (ROOT / "autograder" / "docs" / "larger_classes.md").read_text(),
        re.DOTALL,
    )
    monkeypatch.setenv("HOME", str(tmp_path))
    subprocess.run(["bash", "-euc", commands], check=True, capture_output=True)
    key = tmp_path / ".config/dask/key.pem"
    assert key.stat().st_mode & 0o777 == 0o600
    hand_in(course, "ann", solved)

    told = course.root / "scheduler.json"
    started("scheduler", "--port", "0", "--no-show", "--scheduler-file", told)
    wait_for(told.exists)
    address = json.loads(told.read_text())["address"]
    assert address.startswith("tls://")
    started("worker", address, "--nthreads", "1")
    wait_for(lambda: "has no workers" not in run(course, "grade", "--no-feedback", "--scheduler", address)[1])
    code, said = run(course, "grade", "--no-feedback", "--force", "--scheduler", address)
    assert code == 0 and "1 graded" in said and "NOT PROTECTED" not in said, said

    monkeypatch.setenv("HOME", str(tmp_path / "elsewhere"))
    for other in (address, address.replace("tls:", "tcp:")):
        code, said = run(course, "grade", "--force", "--scheduler", other)
        assert code == 2 and "No Dask scheduler answers" in said


def test_a_cluster_that_others_can_reach_is_said(course, hand_in, solved, started):
    address = f"tcp://{get_ip()}:8786"
    if not is_open(address):
        lacking("needs a network, in which this machine has an address")
    hand_in(course, "ann", {})
    told = course.root / "scheduler.json"
    started("scheduler", "--port", "0", "--no-show", "--scheduler-file", told)
    wait_for(told.exists)
    address = json.loads(told.read_text())["address"]
    started("worker", address, "--nthreads", "1", "--host", "127.0.0.1")
    wait_for(lambda: "has no workers" not in run(course, "grade", "--no-feedback", "--scheduler", address)[1])
    code, said = run(course, "grade", "--no-feedback", "--scheduler", address)
    assert code == 0 and f"NOT PROTECTED: whoever in the network reaches {address} can run any code there" in said


ADDRESSES = {
    "tcp://127.0.0.1:8786": False, "tcp://[::1]:8786": False, "localhost:8786": False, "tls://192.0.2.1:8786": False,
    "inproc://192.0.2.1/1/1": False, "tcp://192.0.2.1:8786": True, "192.0.2.1:8786": True, "tcp://[2001:db8::1]:8786": True,
    "tcp://0.0.0.0:8786": True, "ws://192.0.2.1:8786": True, "tcp://no-such-host.invalid:8786": True,
}  # fmt: skip


@pytest.mark.parametrize("address", ADDRESSES)
def test_which_addresses_others_can_use(address):
    assert is_open(address) is ADDRESSES[address]
