"""The real sandbox: what a notebook's process can do, and what it cannot reach."""

import json
import os
import shutil
import signal
import time
from pathlib import Path

import pytest
from solutions.right import NAMES, RIGHT
from support import PATIENCE, ROOT, key_of, processes_in, wait_for
from transform_lab.judging.verdict import examine

from autograder.sandbox import Ended, Limits, Sandbox
from autograder.sandbox.bubblewrap import Namespaces, compiled_filter, copy_code
from autograder.sandbox.channel import MOST_RECEIVED
from autograder.sandbox.host import MOST_OUTPUTS, MOST_REPLIED

PACKAGE = ROOT / "source/transforms/transform_lab"
QUICK = Limits(cell=4.0, call=2.0, grace=1.0)  # for loops to end soon; ample for the rest on a busy machine
HANDED_IN = {"helper.py": b"answer = 42\n", "data/points.csv": b"1,2,3\n"}


@pytest.fixture
def sandbox(sandboxed):
    with Sandbox(PACKAGE, HANDED_IN, QUICK) as box:
        yield box


@pytest.fixture(scope="module")
def unprotected():
    with Sandbox(PACKAGE, HANDED_IN, isolated=False) as box:
        yield box


def run(sandbox, *cells):
    """The outputs of the last of these cells."""
    with sandbox.notebook() as notebook:
        for cell in cells:
            result = notebook.run_cell(cell)
    return result.outputs


def value(sandbox, *cells):
    (output,) = run(sandbox, *cells)
    return output["data"]["text/plain"]


def error(sandbox, *cells):
    (output,) = run(sandbox, *cells)
    return output["ename"]


OUTPUTS = [
    ("1 + 1", [("execute_result", "2")]),
    ("1 + 1;", []),
    ("print('a'); print('b')", [("stdout", "a\nb\n")]),
    ("import sys; print('oh', file=sys.stderr)", [("stderr", "oh\n")]),
    ("import os; _ = os.system('echo from a command')", [("stdout", "from a command\n")]),
    ("display(3); 4", [("display_data", "3"), ("execute_result", "4")]),
    ("h = display(1, display_id=True); h.update(2)", [("display_data", "2")]),
    ("from IPython.display import clear_output\nprint(1); clear_output(); print(2)", [("stdout", "2\n")]),
    ("import asyncio\nawait asyncio.sleep(0)\n5", [("execute_result", "5")]),
    ("%%bash\necho shell", [("stdout", "shell\n")]),
    ("import helper; helper.answer", [("execute_result", "42")]),
    ("open('data/points.csv').read()", [("execute_result", "'1,2,3\\n'")]),
    ("input('name?')", [("error", "StdinNotImplementedError")]),
    ("1 / 0", [("error", "ZeroDivisionError")]),
    ("def f(:", [("error", "SyntaxError")]),
]


def shown(outputs):
    """What there is to see of outputs: (kind or stream, text)."""
    found = []
    for output in outputs:
        if output["output_type"] == "stream":
            found.append((output["name"], output["text"]))
        elif output["output_type"] == "error":
            found.append(("error", output["ename"]))
        else:
            found.append((output["output_type"], output["data"]["text/plain"]))
    return found


@pytest.mark.parametrize("cell, outputs", OUTPUTS)
def test_cells_give_the_outputs_of_jupyter(sandbox, cell, outputs):
    assert shown(run(sandbox, cell)) == outputs


@pytest.mark.parametrize("cell, outputs", OUTPUTS)
def test_cells_give_the_same_outputs_unprotected(unprotected, cell, outputs):
    assert shown(run(unprotected, cell)) == outputs


def test_helpers_may_have_the_names_of_the_graders_modules(sandboxed):
    names = ("channel", "executor", "worker", "host")
    with Sandbox(PACKAGE, {f"{name}.py": f"answer = {name!r}".encode() for name in names}, QUICK) as box:
        for name in names:
            assert value(box, f"import {name}; {name}.answer") == repr(name)


def test_figures_are_shown_at_the_end_of_the_cell(sandbox):
    with Sandbox(PACKAGE, limits=Limits()) as patient:
        outputs = run(patient, "import matplotlib.pyplot as plt\nplt.plot([1, 2]);")
    assert "image/png" in outputs[0]["data"]


LOADED = "import sys; sorted({'matplotlib', 'scipy'} & set(sys.modules))"


@pytest.mark.parametrize("files, cells, loaded", [
    ({}, [LOADED], "['matplotlib', 'scipy']"),
    ({"helper.py": b"from scipy.spatial import transform"}, ["1"], "['matplotlib', 'scipy']"),
    ({"helper.py": b"import numpy", "data.bin": bytes(range(256))}, ["import numpy"], "[]"),
])  # fmt: skip
def test_scipy_and_matplotlib_are_loaded_for_those_who_use_them(sandboxed, files, cells, loaded):
    with Sandbox(PACKAGE, files) as box:
        for given in (cells, cells, [], cells):  # both kinds go on side by side
            with box.notebook(cells=given, expected=frozenset({"n = 1\nn"})) as notebook:
                shown = [notebook.run_cell(source).outputs[0]["data"]["text/plain"] for source in (LOADED, "n = 1\nn")]
                assert shown == [loaded if given or files else "[]", "1"]


@pytest.mark.parametrize("count", [-5, 10**10])
def test_a_number_of_runs_that_no_notebook_may_have_is_left_out(sandbox, count):
    with sandbox.notebook() as notebook:
        notebook.run_cell(f"get_ipython().execution_count = {count}")
        assert notebook.run_cell("1").execution_count is None


def test_a_function_is_called_with_plain_data(sandbox):
    with sandbox.notebook() as notebook:
        notebook.run_cell("def double(x, times=2):\n    print('noise')\n    return x * times")
        reply = notebook.call("double", [{"array": [1.0, 2.0], "shape": [2]}], {"times": 3})
        assert reply.outcome == "returned"
        assert reply.value == {"array": [3.0, 6.0], "shape": [2]}
        assert reply.arguments == [[{"array": [1.0, 2.0], "shape": [2]}], {"times": 3}]
        assert notebook.call("absent", [], {}).outcome == "undefined"
        assert notebook.run_cell("pass").outputs == []  # what a called function prints is shown to nobody


def test_a_call_that_changes_its_argument_shows_it(sandbox):
    with sandbox.notebook() as notebook:
        notebook.run_cell("def spoil(x):\n    x += 1\n    return x")
        reply = notebook.call("spoil", [{"array": [1.0], "shape": [1]}], {})
        assert reply.arguments is None  # and no more is kept of them


@pytest.mark.parametrize(
    "body", ["raise ValueError('no')", "raise SystemExit", "raise BaseException('hm')", "exit(1 / 0)"]
)
def test_a_call_that_raises_says_so(sandbox, body):
    with sandbox.notebook() as notebook:
        notebook.run_cell(f"def f():\n    {body}")
        assert notebook.call("f", [], {}).outcome == "raised"


def test_an_endless_call_is_interrupted_and_the_notebook_goes_on(sandbox):
    with sandbox.notebook() as notebook:
        notebook.run_cell("def loop():\n    while True:\n        pass\ndef fine():\n    return 1")
        assert notebook.call("loop", [], {}).outcome == "timeout"
        assert not notebook.gone
        assert notebook.call("fine", [], {}).value == 1


def test_an_endless_cell_is_interrupted(sandbox):
    with sandbox.notebook() as notebook:
        result = notebook.run_cell("import time\nwhile True:\n    time.sleep(0.01)")
        assert result.outputs[-1]["ename"] == "Interrupted"
        assert "took too long" in result.outputs[-1]["evalue"]
        assert notebook.run_cell("7").outputs[0]["data"]["text/plain"] == "7"


def test_a_cell_that_heeds_no_interrupt_is_stopped(sandbox):
    deaf = "import signal, time\nsignal.signal(signal.SIGINT, signal.SIG_IGN)\nwhile True:\n    time.sleep(0.01)"
    with sandbox.notebook() as notebook:
        with pytest.raises(Ended) as ended:
            notebook.run_cell(deaf)
    assert ended.value.status == "timeout"
    assert value(sandbox, "'next'") == "'next'"


@pytest.mark.parametrize(
    "cell", ["import os; os._exit(0)", "import os; os.abort()", "import os; os.kill(os.getpid(), 9)"]
)
def test_a_process_that_ends_itself_costs_nobody_else(sandbox, cell):
    with sandbox.notebook() as notebook:
        with pytest.raises(Ended) as ended:
            notebook.run_cell(cell)
    assert ended.value.status == "killed"
    assert value(sandbox, "'next'") == "'next'"


def test_a_sandbox_that_was_brought_down_is_started_again(sandbox):
    with sandbox.notebook() as notebook:
        with pytest.raises(Ended):
            notebook.run_cell("import os, time; os.kill(os.getppid(), 9); os.kill(-1, 9); time.sleep(5)")
    assert value(sandbox, "'next'") == "'next'"


def test_exit_ends_the_notebook(sandbox):
    with sandbox.notebook() as notebook:
        assert notebook.run_cell("exit()").ended


def test_memory_is_limited(sandbox):
    with Sandbox(PACKAGE, limits=Limits(memory=1_000_000_000)) as small:
        assert error(small, "x = bytearray(3_000_000_000)") == "MemoryError"


def test_forks_are_limited(sandbox):
    bomb = "import os, time\nn = 0\nwhile True:\n    if os.fork() == 0:\n        time.sleep(60)\n        os._exit(0)\n"
    with Sandbox(PACKAGE, limits=Limits(cell=5.0, processes=20)) as small:
        assert error(small, bomb) == "BlockingIOError"
        assert value(small, "'next'") == "'next'"


FORKED = (
    "import os, time\nfor _ in range({count}):\n    if os.fork() == 0:\n        {work}\n        os._exit(0)\n{after}"
)


def killed(limits, cell):
    """Why a cell's sandbox was ended, in words."""
    with Sandbox(PACKAGE, limits=limits) as box, box.notebook() as notebook:
        with pytest.raises(Ended) as ended:
            notebook.run_cell(cell)
            for _ in range(100):  # what it left running is seen while the next cells run
                notebook.run_cell("import time; time.sleep(0.1)")
    assert ended.value.status == "killed"
    return ended.value.reason


def test_memory_of_many_processes_is_limited(sandboxed):
    """Each stays below its own limit, all together do not."""
    cell = FORKED.format(count=8, work="x = bytearray(100_000_000); time.sleep(60)", after="time.sleep(60)")
    assert killed(Limits(memory=600_000_000), cell) == "it used more than 0.6 GB of memory"


def test_processor_time_is_limited(sandboxed):
    """Of all processes together, also of those that a cell leaves behind."""
    cell = FORKED.format(count=4, work="os.setsid()\n        while True: pass", after="")
    assert killed(Limits(cpu=3.0), cell) == "it used more than 3 s of processor time"


def test_processor_time_of_children_whom_nobody_waits_for_is_limited(sandboxed):
    """The kernel does not add it to their parent's, and each ends before it has used much."""
    cell = """\
import os, signal, time
signal.signal(signal.SIGCHLD, signal.SIG_IGN)
while True:
    if os.fork() == 0:
        while time.process_time() < 0.4: pass
        os._exit(0)
    try:
        os.wait()
    except ChildProcessError:  # it has ended
        continue"""
    assert killed(Limits(cell=60, cpu=2.0), cell) == "it used more than 2 s of processor time"


def test_sockets_of_many_processes_are_limited(sandboxed):
    """What lies in them is in no process's memory; so each of them counts as if it were full."""
    pairs = "x = [socket.socketpair() for _ in range(24)]; time.sleep(60)"
    cell = "import socket\n" + FORKED.format(count=38, work=pairs, after="time.sleep(60)")
    assert killed(Limits(cell=30, memory=600_000_000), cell) == "it used more than 0.6 GB of memory"


def test_timers_are_limited(sandbox):
    cell = "import ctypes; make, timer, made = ctypes.CDLL(None).timer_create, ctypes.c_void_p(), 0\n"
    cell += "while made < 3_000 and make(1, None, ctypes.byref(timer)) == 0: made += 1\n"
    assert value(sandbox, cell + "0 < made <= 1_000") == "True"


def test_terminals_of_many_processes_are_limited(sandboxed):
    cell = FORKED.format(count=30, work="x = [os.openpty() for _ in range(24)]; time.sleep(60)", after="time.sleep(60)")
    assert killed(Limits(cell=60, memory=700_000_000), cell) == "it used more than 0.7 GB of memory"


def test_memory_of_a_process_whose_first_thread_has_ended_is_limited(sandboxed):
    """The kernel shows nothing of it where it shows other processes' memory."""
    work = "threading.Thread(target=hold).start(); ctypes.CDLL(None).syscall(EXIT, 0)"
    cell = (
        "import ctypes, platform, threading, time\nEXIT = 60 if platform.machine() == 'x86_64' else 93\n"
        "def hold():\n    x = bytearray(100_000_000)\n    time.sleep(60)\n"
    ) + FORKED.format(count=8, work=work, after="time.sleep(60)")
    assert killed(Limits(cell=60, memory=600_000_000), cell) == "it used more than 0.6 GB of memory"


def test_the_number_of_files_is_limited(sandboxed):
    cell = "for n in range(10**9):\n    open(f'/tmp/{n}', 'w').close()"
    assert killed(Limits(files=2_000), cell) == "it used more than 2000 files"


@pytest.mark.parametrize("called", ["f", "in_a_thread"])
def test_time_without_a_processor_does_not_count(sandboxed, called):
    """Beside a notebook that keeps its processor busy, an honest function gets its whole time."""
    processor = {min(os.sched_getaffinity(0))}
    hog = FORKED.format(count=8, work="os.setsid()\n        while True: pass", after="")
    honest = "import time\ndef f():\n    while time.process_time() < start + 0.7:\n        pass\n    return 'done'\n"
    honest += "from multiprocessing.pool import ThreadPool\ndef in_a_thread():\n    return ThreadPool(1).apply(f)\n"
    with Sandbox(PACKAGE, limits=Limits(cpu=1000.0)) as busy, busy.notebook() as hogs:
        os.sched_setaffinity(hogs.pid, processor)
        hogs.run_cell(hog)
        with Sandbox(PACKAGE, limits=Limits(call=1.2)) as box, box.notebook() as notebook:
            os.sched_setaffinity(notebook.pid, processor)
            notebook.run_cell(f"{honest}start = time.process_time()")
            assert notebook.call(called, [], {}).value == "done"


@pytest.mark.parametrize(
    "attempt",
    [
        "socket.socket(40, socket.SOCK_STREAM)",  # AF_VSOCK, which knows no network namespace
        "socket.socket(socket.AF_INET)",
        "socket.socket(socket.AF_NETLINK, socket.SOCK_RAW)",
        "socket.socketpair()[0].setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 100_000_000)",
        "os.memfd_create('x')",
        "fcntl.fcntl(os.pipe()[1], 1031, 1_000_000)",
        "call('shmget', 0, 1000, 0o1600)",
        "call('unshare', 0x10000000)",
        "call('mount', b'none', b'/tmp', b'tmpfs', 0, None)",
        "call('ptrace', 0, 0, None, None)",
        "call('chroot', b'/tmp')",
        "call('setuid', 0)",
        "call('syscall', 425, 1, None)",  # io_uring_setup
        "call('syscall', 321, 0, None, 0)",  # bpf
        "call('syscall', 323, 0)",  # userfaultfd
        "call('syscall', 248, b'user', b'x', b'y', 1, -2)",  # add_key
    ],
)
def test_the_kernel_refuses_what_no_notebook_needs(sandbox, attempt):
    define = (
        "import ctypes, fcntl, os, socket\n"
        "def call(name, *arguments):\n"
        "    if getattr(ctypes.CDLL(None, use_errno=True), name)(*arguments) == -1:\n"
        "        raise OSError(ctypes.get_errno(), name)\n"
    )
    assert error(sandbox, define + attempt) in ("OSError", "PermissionError")


# {what would hold memory, or use a processor, that is counted for nobody: (how, what the filter says)}
UNCOUNTED = {
    "shared memory": ("mmap.mmap(-1, 4096)", "EPERM"),
    "shared memory, flags checked": ("mmap.mmap(-1, 4096, flags=mmap.MAP_ANONYMOUS | 3)", "EPERM"),
    "shared memory of a device": ("mmap.mmap(os.open('/dev/zero', os.O_RDWR), 4096)", "ENODEV"),
    "huge pages": ("mmap.mmap(-1, 1 << 21, flags=mmap.MAP_ANONYMOUS | mmap.MAP_PRIVATE | 0x40000)", "EPERM"),
    "transparent huge pages": ("call('prctl', 41, 0, 0, 0, 0)", "EPERM"),
    "pages in sockets": ("os.sendfile(socket.socketpair()[0].fileno(), os.open(PYTHON, 0), 0, 1)", "ENOSYS"),
    "pages in pipes": ("call('splice', os.open(PYTHON, 0), None, os.pipe()[1], None, 1, 0)", "ENOSYS"),
    "pages of pipes": ("call('tee', os.pipe()[0], os.pipe()[1], 1, 2)", "ENOSYS"),
    "datagrams": ("socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)", "EPERM"),
    "datagrams between two": ("socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_CLOEXEC)", "EPERM"),
    "datagrams by another name": ("socket.socket(socket.AF_UNIX, socket.SOCK_RAW)", "EPERM"),
    "packets": ("socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)", "EPERM"),
    "connections that wait": ("call('listen', socket.socket(socket.AF_UNIX).fileno(), 1)", "EPERM"),
    "filters of sockets": (
        "socket.socketpair()[0].setsockopt(socket.SOL_SOCKET, 26, struct.pack('HxxxxxxP', 1, ctypes.addressof(RETURN)))",
        "EPERM",
    ),
    "watched files": ("call('inotify_init1', 0)", "EPERM"),
    "message queues": ("call('mq_open', b'/x', os.O_RDWR | os.O_CREAT, 0o600, None)", "EPERM"),
    "contexts of asynchronous files": ("call('syscall', 206, 1, ctypes.byref(ctypes.c_long()))", "EPERM"),
    "rule sets": ("call('syscall', 444, ctypes.byref(ctypes.c_uint64(1)), 8, 0)", "EPERM"),
    "locks": ("fcntl.lockf(open('/tmp/lock', 'w'), fcntl.LOCK_EX)", "EPERM"),
    "locks, with bits that the kernel passes over": (
        "call('syscall', 72, ctypes.c_long(os.open('/tmp/lock', 66)), ctypes.c_long(1 << 32 | fcntl.F_SETLK), FLOCK)",
        "EPERM",
    ),
    "large pipes, with such bits": (
        "call('syscall', 72, ctypes.c_long(os.pipe()[1]), ctypes.c_long(1 << 32 | 1031), ctypes.c_long(4096))",
        "EPERM",
    ),
    "transparent huge pages, with such bits": (
        "call('syscall', 157, ctypes.c_long(1 << 32 | 41), *[ctypes.c_long(0)] * 4)",
        "EPERM",
    ),
    "locks of open files": (
        "fcntl.fcntl(open('/tmp/lock', 'w'), 37, FLOCK)",
        "EPERM",
    ),
    "a child of the grader's": ("call('syscall', 56, 0x8000 | signal.SIGCHLD, 0, 0, 0, 0) or os._exit(0)", "EPERM"),
    "a child with the same descriptors": (
        "call('syscall', 56, 0x400 | signal.SIGCHLD, 0, 0, 0, 0) or os._exit(0)",
        "EPERM",
    ),
    "descriptors of one thread": ("call('close_range', 100, 101, 2)", "EPERM"),
}


@pytest.mark.parametrize("attempt, refused", UNCOUNTED.values(), ids=UNCOUNTED)
def test_the_kernel_refuses_what_would_count_for_nobody(sandbox, attempt, refused):
    cell = f"""
import ctypes, errno, fcntl, mmap, os, signal, socket, struct, sys
PYTHON, RETURN = os.path.realpath(sys.executable), (ctypes.c_uint64 * 1)(6)
FLOCK = struct.pack('hhqqi4x', fcntl.F_WRLCK, 0, 0, 1, 0)
def call(name, *arguments):
    found = getattr(ctypes.CDLL(None, use_errno=True), name)(*arguments)
    if found == -1:
        raise OSError(ctypes.get_errno(), name)
    return found
try:
    {attempt}
except OSError as error:
    print(errno.errorcode[error.errno])"""
    assert shown(run(sandbox, cell)) == [("stdout", f"{refused}\n")]


# What honest notebooks do with what is left of it, and what they see then.
SHARING = {
    "memory of one's own": (
        "import mmap; len(mmap.mmap(-1, 4096, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS))",
        "4096",
    ),
    "a file in memory": (
        "import mmap, os; open('x', 'wb').write(b'abc'); x = mmap.mmap(os.open('x', os.O_RDWR), 0); x[:]",
        "b'abc'",
    ),
    "processes": ("import multiprocessing as m\nwith m.Pool(2) as pool: x = pool.map(abs, [-1, 2])\nx", "[1, 2]"),
    "shared values": ("import multiprocessing as m; x = m.Value('i', 7); x.value", "7"),
    "shared arrays": ("from multiprocessing.shared_memory import *; SharedMemory('x', True, 99).size >= 99", "True"),
    "an executor": (
        "from concurrent.futures import *\nwith ProcessPoolExecutor(2) as e: x = list(e.map(abs, [-3]))\nx",
        "[3]",
    ),
    "threads": ("from multiprocessing.pool import ThreadPool; ThreadPool(3).map(abs, [-1])", "[1]"),
    "a command": ("!echo seen", "seen\r\n"),
    "commands in a pipe": (
        "import subprocess as s; s.check_output('head -c 9 /dev/urandom | wc -c', shell=True)",
        "b'9\\n'",
    ),
    "a copy": ("import shutil; open('x', 'w').write('y'); open(shutil.copyfile('x', 'z')).read()", "'y'"),
    "a coroutine that waits for a process": (
        "import asyncio as a\nx = await a.create_subprocess_exec('true')\nawait x.wait()",
        "0",
    ),
    "zeros": ("len(bytes(5))", "5"),
}


@pytest.mark.parametrize("cell, seen", SHARING.values(), ids=SHARING)
def test_what_honest_notebooks_share_goes_on_to_work(sandboxed, cell, seen):
    with Sandbox(PACKAGE) as patient:
        assert [text for _, text in shown(run(patient, cell))] == [seen]


def test_everything_in_a_sandbox_is_filtered(sandbox):
    """bubblewrap's own processes, too: the first in it, and the one that holds it open."""
    cell = "import glob; sorted({l for p in glob.glob('/proc/[0-9]*/status') for l in open(p) if 'Seccomp:' in l})"
    assert value(sandbox, cell) == r"['Seccomp:\t2\n']"


def test_huge_pages_are_off(sandbox):
    """Of one that is unmapped but for 4 kB, all 2 MB stay for a while, and count for nobody."""
    assert value(sandbox, "import ctypes; ctypes.CDLL(None).prctl(42, 0, 0, 0, 0)") == "1"


def test_what_bubblewrap_says_goes_into_a_pipe(sandbox):
    """Not into a file of the grader's, which could be filled or cut by who reaches it."""
    with sandbox.notebook() as notebook:
        assert os.readlink(f"/proc/{notebook.namespaces.pid}/fd/2").startswith("pipe:")


def test_output_is_limited(sandbox):
    with Sandbox(PACKAGE, limits=Limits()) as box:
        outputs = run(box, "for _ in range(100):\n    print('x' * 100_000)")
    assert sum(len(output["text"]) for output in outputs) < 2_500_000
    assert outputs[-1]["text"] == "[more output than the grader keeps]\n"


@pytest.mark.parametrize("file", ["passwd", "group"])
def test_the_only_user_there_is_the_notebooks(sandbox, file):
    assert value(sandbox, f"[line.split(':')[0] for line in open('/etc/{file}')]") == "['student']"


def test_a_handle_changes_what_a_cell_above_shows(sandbox):
    with sandbox.notebook() as notebook:
        above = notebook.run_cell("display(0); handle = display(1, display_id=True); 3")
        for number in (4, 5):
            assert notebook.run_cell(f"handle.update({number})").changed == [above]
            assert [text for _, text in shown(above.outputs)] == ["0", str(number), "3"]
        assert notebook.run_cell("1").changed == []


@pytest.mark.parametrize("changed", ["7", "[7]", "[[7, 0, {}]]", "[[0, 0, 7]]", "[[0, '0', {}]]", "[[0, -2, {}]]"])
def test_a_change_that_cannot_be_is_forged(sandbox, changed):
    with sandbox.notebook() as notebook:
        notebook.run_cell("1")
        with pytest.raises(Ended, match="never gives"):
            notebook.run_cell(f"{EXECUTOR}; executor.outputs.take = lambda: ([], {changed})")


def test_a_progress_that_is_shown_again_and_again_is_not_cut(sandboxed):
    """What counts is what stays; that it does so with bytes is in test_output_is_limited."""
    cell = "handle = display('', display_id=True)\nfor n in range(90):\n    {show}\nprint('done')"
    for show in ("handle.update(f'{n}' * 100_000)", "clear_output(); print('x' * 100_000)"):
        with Sandbox(PACKAGE) as box:
            outputs = run(box, "from IPython.display import clear_output", cell.format(show=show))
        assert outputs[-1]["text"].endswith("done\n") and "more output than" not in json.dumps(outputs)


def test_what_copies_of_a_process_print_is_seen(sandbox):
    cell = "from multiprocessing import Pool\nwith Pool(1) as pool: x = pool.map(print, ['from a copy'])"
    assert shown(run(sandbox, cell)) == [("stdout", "from a copy\n")]


def test_what_a_called_function_prints_is_not_in_a_later_cell(sandbox):
    with sandbox.notebook() as notebook:
        notebook.run_cell("import os\ndef f(): print('seen'); os.system('echo seen')")
        assert notebook.call("f", [], {}).outcome == "returned"
        assert notebook.run_cell("pass").outputs == []


def test_a_notebook_sees_no_other_notebooks_names(sandbox):
    with sandbox.notebook() as notebook:
        notebook.run_cell("secret = 1")
    assert error(sandbox, "secret") == "NameError"


def test_what_a_notebook_leaves_running_ends_with_it(sandbox):
    daemon = "import os, time\nif os.fork() == 0:\n    os.setsid()\n    time.sleep(60)\n    os._exit(0)"
    count = "len([p for p in __import__('os').listdir('/proc') if p.isdigit()])"
    alone = value(sandbox, count)
    run(sandbox, daemon)
    assert value(sandbox, count) == alone


@pytest.mark.parametrize(
    "path",
    [
        "transform_lab/key.json",
        str(ROOT / "gradebook.db"),
        str(ROOT / "autograder"),
        str(ROOT / "source"),
        str(ROOT / "README.md"),
        "/grader/../autograder",
        "/etc/shadow",
        "/proc/1/environ",
        str(Path.home() / ".bashrc"),
    ],
)
def test_what_must_not_be_seen_is_not_there(sandbox, path):
    cell = f"try:\n    print(bool(open({path!r}).read()))\nexcept OSError as e:\n    print(type(e).__name__)"
    (output,) = run(sandbox, cell)
    assert output["text"].strip() in ("FileNotFoundError", "PermissionError", "False")


def test_nothing_of_the_environment_is_seen(sandbox, monkeypatch):
    monkeypatch.setenv("A_SECRET", "of the grader")
    everybody = (
        "import glob\nfor path in glob.glob('/proc/[0-9]*/environ'):\n    try:\n        print(open(path).read())\n"
    )
    everybody += "    except OSError as error:\n        print(error)\n"
    with Sandbox(PACKAGE, limits=QUICK) as box:
        assert "A_SECRET" not in value(box, "import os; dict(os.environ)")
        assert "A_SECRET" not in run(box, everybody)[0]["text"]


def test_there_is_no_network(sandbox):
    cell = "import socket\nsocket.create_connection(('127.0.0.1', 22), timeout=1)"
    (output,) = run(sandbox, cell)
    assert output["ename"] == "OSError" and "Network is unreachable" in output["evalue"]
    assert value(sandbox, "import os; sorted(os.listdir('/sys/class/net')) if os.path.exists('/sys') else []") == "[]"


def test_nobody_in_particular_runs_the_code(sandbox):
    assert value(sandbox, "import os; os.getuid() != 0 or os.geteuid() != 0") == "True"
    for folder in ("/", "/dev", "/etc", "/usr/bin", "transform_lab"):
        assert error(sandbox, f"open({folder!r} + '/new', 'w')") in ("OSError", "PermissionError")


def test_no_process_and_no_file_is_left_behind(sandbox):
    with Sandbox(PACKAGE, limits=QUICK) as box, box.notebook() as notebook:
        notebook.run_cell("open('mine.txt', 'w').write('x'); open('/tmp/mine.txt', 'w').write('x');")
        notebook.run_cell("import subprocess; subprocess.Popen(['sleep', '1234.5'], start_new_session=True)")
        processes = notebook.pid, notebook.namespaces.pid, notebook.namespaces.process.pid
        assert all(Path(f"/proc/{process}").exists() for process in processes)
        assert _running("1234.5")
    assert not any(Path(f"/proc/{process}").exists() for process in processes)
    assert not _running("1234.5")
    assert not Path("/tmp/mine.txt").exists()


def _running(argument):
    """Whether any process of this machine has that argument."""
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if argument.encode() in path.read_bytes().split(b"\0"):
                return True
        except OSError:
            continue  # it has just ended
    return False


def test_files_of_one_notebook_are_not_seen_by_the_next(sandbox):
    run(sandbox, "open('mine.txt', 'w').write('x'); open('/dev/shm/mine.txt', 'w').write('x')")
    assert value(sandbox, "import os; [os.path.exists(path) for path in ('mine.txt', '/dev/shm/mine.txt')]") == (
        "[False, False]"
    )


def test_forged_answers_are_passed_over(sandbox):
    """A frame written to the grader's socket beforehand lacks the next request's nonce."""
    forge = (
        "import json, os, stat, struct\n"
        "frame = json.dumps({'nonce': 'guess', 'outcome': 'returned', 'value': 'forged', 'arguments': [[], {}]}).encode()\n"
        "for fd in range(3, 40):\n"
        "    try:\n"
        "        if stat.S_ISSOCK(os.fstat(fd).st_mode):\n"
        "            os.write(fd, struct.pack('>I', len(frame)) + frame)\n"
        "    except OSError:\n"
        "        continue\n"
        "def f():\n"
        "    return 'honest'\n"
    )
    with sandbox.notebook() as notebook:
        notebook.run_cell(forge)
        assert notebook.call("f", [], {}).value == "honest"


def test_a_notebook_has_a_budget_of_time(sandbox):
    with Sandbox(PACKAGE, limits=Limits(cell=60.0, notebook=2.0, grace=1.0)) as box:
        with box.notebook() as notebook:
            while not notebook.exhausted:
                assert notebook.run_cell("import time; time.sleep(50)").outputs[-1]["ename"] == "Interrupted"
            with pytest.raises(Ended):
                notebook.run_cell("1")


EXECUTOR = "import signal; executor = signal.getsignal(signal.SIGINT).__self__"


def test_outputs_are_counted_outside_whatever_the_notebook_says(sandbox):
    """Inside, the bound can be taken away; then the process is ended, and its cells' outputs together stay small."""
    kept = 0
    with sandbox.notebook() as notebook:
        notebook.run_cell(f"{EXECUTOR}; executor.outputs.left = 10**12")
        with pytest.raises(Ended, match="what the grader's own code never sends"):
            for _ in range(20):
                kept += len(json.dumps(notebook.run_cell("print('x' * 900_000)").outputs))
        assert 900_000 < kept <= MOST_RECEIVED
        assert notebook.gone
    with sandbox.notebook() as notebook:
        notebook.run_cell(f"{EXECUTOR}; executor.outputs.left = 10**12")
        number = [len(notebook.run_cell("for n in range(900): display(n)").outputs) for _ in range(4)]
    assert sum(number) == MOST_OUTPUTS


@pytest.mark.parametrize("field", ["arguments", "value", "error", "printed", "another"])
def test_replies_are_counted_in_sum_and_no_argument_is_kept(sandbox, field):
    forged = {"outcome": "returned", "value": 1, "changed": False, field: "y" * 150_000}
    cases = [{"args": [number], "kwargs": {}} for number in range(20)]
    with sandbox.notebook() as notebook:
        notebook.run_cell(f"{EXECUTOR}; executor._call = lambda *a: {forged}\ndef f(x): pass")
        snapshot = notebook.snapshot()
        assert snapshot.meets()
        replies = list(snapshot.calls("f", cases))
    assert replies[-1].outcome == "killed" and len(replies) <= 1 + MOST_REPLIED // 150_000
    assert len(str(replies)) < 10_000


def test_a_snapshot_is_as_the_process_was(sandbox):
    with sandbox.notebook() as notebook:
        notebook.run_cell("x = 1\ndef f(): return x")
        before = notebook.snapshot()
        notebook.run_cell("x = 2")
        after = notebook.snapshot()
        assert before.meets() and after.meets()
        assert before.call("f", [], {}).value == 1 and after.call("f", [], {}).value == 2
        assert {notebook.pid, before.pid, after.pid} <= set(map(int, filter(str.isdigit, os.listdir("/proc"))))
        assert len({notebook.pid, before.pid, after.pid}) == 3


@pytest.mark.parametrize("trick", ["import os; os.fork = lambda: 99", "import os; os.fork = os.getpid", "1"])
def test_a_snapshot_that_is_none_is_seen(sandbox, trick):
    """Also when it has been ended since."""
    with sandbox.notebook() as notebook:
        notebook.run_cell(trick)
        snapshot = notebook.snapshot()
        if trick == "1":
            notebook.run_cell(
                "import os; os.kill(max(int(name) for name in os.listdir('/proc') if name.isdigit()), 9); os.wait()"
            )
        assert not snapshot.meets()
        assert notebook.run_cell("1").outputs


def test_a_limit_that_is_reached_again_and_again_gets_shorter(sandbox):
    with Sandbox(PACKAGE, limits=Limits(cell=4.0, grace=1.0)) as box:
        with box.notebook() as notebook:
            assert notebook.allowance.patience == 1.0
            for share in (0.5, 0.25, 0.25):
                assert notebook.run_cell("while True: pass").outputs[-1]["ename"] == "Interrupted"
                assert notebook.allowance.patience == share
        with box.notebook() as notebook:
            assert notebook.allowance.patience == 0.25, "the submission's"


def test_cells_do_not_take_the_time_of_calls(sandbox):
    with Sandbox(PACKAGE, limits=Limits(cell=60.0, notebook=2.0, grace=1.0)) as box:
        with box.notebook() as notebook:
            notebook.run_cell("def f(): return 1")
            snapshot = notebook.snapshot()
            while not notebook.exhausted:
                notebook.run_cell("while True: pass")
            assert not snapshot.exhausted
            assert snapshot.meets() and snapshot.call("f", [], {}).value == 1


def test_of_a_grader_that_is_killed_while_a_sandbox_starts_nothing_is_left(sandboxed, tmp_path):
    code = copy_code(PACKAGE)
    compiled_filter()
    for moment in range(100):
        grader = os.fork()
        if grader == 0:
            try:
                os.chdir(tmp_path)
                Namespaces(code)
                time.sleep(PATIENCE)
            finally:
                os._exit(1)
        time.sleep(moment * 1e-4)
        os.kill(grader, signal.SIGKILL)
        os.waitpid(grader, 0)
    wait_for(lambda: not processes_in(tmp_path))
    shutil.rmtree(code)


def test_without_bubblewrap_the_same_code_runs_unprotected():
    with Sandbox(PACKAGE, isolated=False) as box:
        assert value(box, "import os; os.getuid()") == str(os.getuid())
        folder = value(box, "import os; os.getcwd()").strip("'")
    assert not Path(folder).exists()


def test_right_solutions_are_right_in_the_sandbox_too(sandboxed):
    """Callable objects, caches, helpers of other cells and the rest: called by name, in the notebook's own process."""
    source = (ROOT / "tests/solutions/right.py").read_text(encoding="utf-8")
    all_of_them = Limits(notebook=900.0, submission=900.0)
    for exercise in dict(RIGHT):  # a process for each: what one may reply is counted for all its life
        with Sandbox(PACKAGE, limits=all_of_them) as box, box.notebook() as notebook:
            assert not [output for output in notebook.run_cell(source).outputs if output["output_type"] == "error"]
            for index in (index for index, (name, _) in enumerate(RIGHT) if name == exercise):
                notebook.run_cell(f"{exercise} = RIGHT[{index}][1]")
                verdict = examine(
                    exercise, key_of(exercise, 5), lambda args, kwargs, name=exercise: notebook.call(name, args, kwargs)
                )
                assert verdict.right, (exercise, NAMES[index], verdict.says)
