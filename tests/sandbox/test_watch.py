"""What is read of processes from outside, tried on folders like those in /proc."""

import math
import mmap
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autograder.sandbox import Limits, watch

PAGE = mmap.PAGESIZE


def process(folder, tasks):
    """A process with these threads, {file: text}; descriptors are {number: what it is}."""
    for number, files in tasks.items():
        (folder / "task" / str(number) / "fd").mkdir(parents=True)
        for name, text in files.items():
            path = folder / "task" / str(number) / name
            if isinstance(text, dict):
                for descriptor, target in text.items():
                    (path / str(descriptor)).symlink_to(target)
            else:
                path.write_text(text)
    return folder


LIBRARY = "7f0000000000-7f0000001000 r--p 00000000 08:01 1 /usr/lib/libm.so\n"
DEVICE = "7f0000000000-7f0000001000 rw-s 00000000 00:01 9 /dev/zero (deleted)\n"
ROLLUP = "5000-7fff ---p 00000000 00:00 0 [rollup]\nRss:  900 kB\nPss:  300 kB\nPss_Anon:  200 kB\nSwap:  90 kB\n"
SEEN = {"maps": 3 * LIBRARY, "smaps_rollup": f"{ROLLUP}SwapPss:  40 kB\n", "status": "Name:\tx\nVmPTE:\t      8 kB\n"}
MEMORY = {
    "pages, swapped pages, page tables and mappings": ({7: SEEN}, (300 + 40 + 8) * 1024 + 3 * watch.MAPPING),
    "a first thread that has ended": ({7: {"maps": ""}, 12: SEEN}, (300 + 40 + 8) * 1024 + 3 * watch.MAPPING),
    "shared memory of a device": ({7: {**SEEN, "maps": LIBRARY + DEVICE}}, math.inf),
    "hidden": ({7: {"statm": "900 50 20 1 0 1 0"}}, 30 * PAGE),
    "hidden, behind a first thread that has ended": (
        {7: {"statm": "0 0 0 0 0 0 0"}, 9: {"statm": "9 5 1 0 0 0 0"}},
        4 * PAGE,
    ),
    "ended": ({}, 0),
}


@pytest.mark.parametrize("tasks, held", MEMORY.values(), ids=MEMORY)
def test_memory(tmp_path, tasks, held):
    assert watch._memory(process(tmp_path, tasks)) == held


def test_pipes_and_sockets_are_told_apart(tmp_path):
    """One that several descriptors or processes have is one; files and terminals are none."""
    open_files = {
        0: "/dev/null",
        1: "pipe:[5]",
        2: "pipe:[5]",
        3: "socket:[6]",
        4: "/tmp/pipe:[7]",
        5: "anon_inode:[eventfd]",
    }
    first = process(tmp_path / "1", {1: {}, 2: {"fd": open_files}})
    second = process(tmp_path / "2", {2: {"fd": {9: "socket:[6]", 10: "socket:[8]"}}})
    assert watch._buffers(first) | watch._buffers(second) == {"pipe:[5]", "socket:[6]", "socket:[8]"}


ENDING = """
import os, signal, time
from pathlib import Path
from autograder.sandbox import watch

signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # who ends is gone at once
for look in (watch.waited, watch._memory, watch._memory_at_most, watch._buffers):
    for _ in range(200):
        number = os.fork()
        if number == 0:
            time.sleep(0.001)
            os._exit(0)
        folder = Path("/proc", str(number))
        while folder.exists():
            look(number if look is watch.waited else folder)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="what processes use is read from /proc, which is Linux's")
def test_a_process_may_end_while_it_is_looked_at():
    subprocess.run([sys.executable, "-c", ENDING], check=True)


def stat(own, children, started):
    return f"5 (a) b) R {' '.join(map(str, range(10)))} {own} 0 {children} 0 {' '.join('0' * 4)} {started} 0"


LOOKS = st.lists(
    st.dictionaries(st.integers(1, 9), st.tuples(st.integers(0, 50), st.integers(0, 50)), max_size=5), max_size=6
)


@given(looks=LOOKS)
def test_what_a_processor_has_done_is_not_forgotten(tmp_path_factory, looks):
    """However processes come and go, it never becomes less, nor less than what was seen of them at once."""
    looker = watch.Watch(1, Limits())
    most, before = {}, 0
    for number, look in enumerate(looks):
        found = []
        for name, (own, children) in look.items():
            folder = tmp_path_factory.mktemp("look") / str(name)
            folder.mkdir()
            (folder / "stat").write_text(stat(own, children, started=number))  # another one with the same number
            found.append(folder)
            most[name, number] = own
        looker._count(found)
        together = sum(own + children for own, children in look.values())
        assert looker.ticks >= max(before, together, sum(most.values()))
        assert looker.ticks >= max((name for name, _ in most), default=0)
        before = looker.ticks
