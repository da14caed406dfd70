"""A notebook as a user of its own, without namespaces: hostile cells attack a grader as it is set up on Gradescope.

All run in one grader, started as root, beside a course in a closed folder. What each cell saw is compared here.
"""

import json
import shutil
import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from support import MADE_AT_RUN_TIME, ROOT, wait_for

GRADER = """
import json, os, pathlib, sys
sys.path.insert(0, {root!r})
from autograder.sandbox import Ended, Limits, Sandbox

def threads(number):
    for path in pathlib.Path("/proc").glob("[0-9]*/task/[0-9]*/status"):
        try:
            status = path.read_text(errors="replace")
        except OSError:
            continue  # it has ended
        if f"Uid:\\t{{number}}\\t" in status and "State:\\tZ" not in status:
            yield path

limits = Limits(cell=15, call=2, grace=1, cpu=2, memory=700_000_000, processes=30, files=2_000)
package = pathlib.Path({root!r}, "source/transforms/transform_lab")
with Sandbox(package, {{"helper.py": b"answer = 42"}}, limits, "user") as sandbox:
    for cell in json.load(sys.stdin):
        cell = cell.replace("@GRADER@", str(os.getpid())).replace("@COURSE@", {root!r})
        with sandbox.notebook() as notebook:
            number, home = notebook.account.number, notebook.account.home
            try:
                outputs = notebook.run_cell(cell).outputs
            except Ended as ended:
                outputs = [{{"text": str(ended)}}]
        left = len(list(threads(number))) + home.exists()
        texts = [o.get("text") or o.get("ename") or o["data"]["text/plain"] for o in outputs]
        print(json.dumps([" ".join(texts).strip(), left]), flush=True)
"""
DENIED, TRIED = "PermissionError", "import os, signal, socket, subprocess, sys, time\n"
# {what it tries: (the cell, what it may see: text that starts like this)}
ATTACKS = {
    "honest": ("import helper, numpy, transform_lab; helper.answer", "42"),
    "solutions": ("open('@COURSE@/source/transforms/1_rotation.ipynb').read()", DENIED),
    "hidden cases": ("open('@COURSE@/source/transforms/transform_lab/key.json').read()", DENIED),
    "names of files": ("os.listdir('@COURSE@')", DENIED),
    "results": ("open('@COURSE@/../results/results.json', 'w').write('{\"score\": 40}')", DENIED),
    "way in over the grader": ("open('/proc/@GRADER@/cwd/environment.txt').read()", DENIED),
    "the grader's memory": ("open('/proc/@GRADER@/mem', 'rb').read(1)", DENIED),
    "the grader's variables": ("open('/proc/@GRADER@/environ').read()", DENIED),
    "the grader's files": ("os.listdir('/proc/@GRADER@/fd')", DENIED),
    "kill the grader": ("os.kill(@GRADER@, 9)", DENIED),
    "kill the fork server": ("os.kill(os.getppid(), 9)", DENIED),
    "kill the first process": ("os.kill(1, 9)", DENIED),
    "stop the grader": ("os.kill(@GRADER@, signal.SIGSTOP)", DENIED),
    "kill everybody (it may kill nobody)": ("os.kill(-1, 9)", ""),
    "become root": ("os.setuid(0)", DENIED),
    "become another": ("os.setresuid(65534, 65534, 65534)", DENIED),
    "become root by a program": (
        "[line.split()[1].strip('0') for line in open('/proc/self/status') if line.startswith(('Cap', 'NoNewPrivs'))]",
        "['', '', '', '', '', '1']",
    ),
    "new namespaces": ("os.unshare(os.CLONE_NEWUSER) if hasattr(os, 'unshare') else "
                       "__import__('ctypes').CDLL(None, use_errno=True).unshare(0x10000000)", "-1"),
    "network": ("socket.socket(socket.AF_INET, socket.SOCK_DGRAM)", "OSError"),
    "network of another kind": ("socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, 0)", "OSError"),
    "network by a program": (
        "subprocess.run([sys.executable, '-c', 'import socket; socket.socket()'], capture_output=True).returncode", "1",
    ),
    "processes": (
        """
        children = []
        try:
            while len(children) < 200:
                if (child := os.fork()) == 0:
                    time.sleep(60); os._exit(0)
                children.append(child)
        except BlockingIOError:
            print('bounded' if len(children) < 30 else len(children))
        """,
        "bounded",
    ),
    "a fork bomb": ("while True:\n    try: os.fork()\n    except OSError: pass", "it used more than 2 s of processor time"),
    "a daemon": (
        """
        if os.fork() == 0:
            os.setsid()
            if os.fork() == 0:
                signal.signal(signal.SIGTERM, signal.SIG_IGN)
                time.sleep(600)
            os._exit(0)
        os.wait(); 'left behind'
        """,
        "'left behind'",
    ),
    "a daemon whose first thread has ended": (
        """
        import ctypes, platform, threading
        if os.fork() == 0:
            threading.Thread(target=time.sleep, args=(600,)).start()
            os.closerange(3, 64)
            ctypes.CDLL(None).syscall(60 if platform.machine() == 'x86_64' else 93, 0)
        time.sleep(1); os._exit(0)
        """,
        "its process ended all of a sudden",
    ),
    "daemons that stop who comes to end them": (
        """
        for _ in range(5):
            if os.fork() == 0:
                time.sleep(0.3)
                while True: os.kill(-1, signal.SIGSTOP)
        'left behind'
        """,
        "'left behind'",
    ),
    "memory of many processes": (
        """
        for _ in range(8):
            if os.fork() == 0:
                held = b'x' * (200 << 20)
                time.sleep(600)
        time.sleep(600)
        """,
        "it used more than 0.7 GB of memory",
    ),
    "shared memory that may be unmapped": (
        "import mmap\nheld = mmap.mmap(os.open('/dev/zero', os.O_RDWR), 4096)\ntime.sleep(600)",
        "it used more than 0.7 GB of memory",
    ),
    "processor time": (
        "for _ in range(8):\n    if os.fork() == 0:\n        while True: pass\ntime.sleep(600)",
        "it used more than 2 s of processor time",
    ),
    "countless files": (
        "for number in range(100_000): open(f'many-{number}', 'w').close()\ntime.sleep(3)",
        "it used more than 2000 files",
    ),
    "large files": (
        """
        for number in range(20):
            with open(f'large-{number}', 'wb') as file:
                file.write(bytes(15_000_000))
        time.sleep(3)
        """,
        "it used more than 150 MB of files",
    ),
}  # fmt: skip


@pytest.fixture(scope="module")
def closed(tmp_path_factory):
    """The folder of a course that only root may enter, as run_autograder leaves it; results/ lies beside."""
    folder = tmp_path_factory.mktemp("autograder")
    shutil.copytree(ROOT, folder / "source", ignore=shutil.ignore_patterns(*MADE_AT_RUN_TIME, ".pytest_cache", "tests"))
    (folder / "results").mkdir()
    (folder / "results" / "results.json").write_text("{}")
    folder.chmod(0o700)
    return folder / "source"


def start(open_python, course, **options):
    return subprocess.Popen(
        [open_python, "-c", GRADER.format(root=str(course))],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=course, **options,
    )  # fmt: skip


@pytest.fixture(scope="module")
def seen(open_python, closed):
    """{attack: (what its cell saw, how many processes and folders of it were left)}"""
    grader = start(open_python, closed)
    cells = [TRIED + textwrap.dedent(cell).strip() for cell, _ in ATTACKS.values()]
    said, _ = grader.communicate(json.dumps(cells), timeout=300)
    assert grader.returncode == 0
    return dict(zip(ATTACKS, map(json.loads, said.splitlines()), strict=True))


@pytest.mark.parametrize("name", ATTACKS)
def test_attack(seen, name):
    saw, left = seen[name]
    assert saw.startswith(ATTACKS[name][1]), saw
    assert left == 0


def test_the_results_are_as_they_were(seen, closed):
    assert (closed.parent / "results" / "results.json").read_text() == "{}"


def test_a_notebook_ends_with_its_grader(open_python, closed):
    with start(open_python, closed) as grader:
        grader.stdin.write(json.dumps([f"{TRIED}open('pid', 'w').write(str(os.getpid())); time.sleep(600)"]))
        grader.stdin.close()
        found = []

        def sleeping():
            found[:] = [path for path in Path("/proc").glob("[0-9]*") if sleeps_in_a_notebook(path, grader.pid)]
            return found

        wait_for(sleeping)
        grader.send_signal(signal.SIGKILL)
    wait_for(lambda: not found[0].exists())


def sleeps_in_a_notebook(path, grader):
    """Whether the process has written its number where a notebook of this grader's fork server lies."""
    try:
        parent = int((path / "stat").read_text().rpartition(")")[2].split()[1])
        above = int(Path(f"/proc/{parent}/stat").read_text().rpartition(")")[2].split()[1])
        return above == grader and (path / "cwd" / "pid").read_text() == path.name
    except (OSError, ValueError):
        return False


def test_what_refuses_to_go_on(open_python, closed, tmp_path):
    def refusal(python, root, **options):
        code = f"import sys; sys.path.insert(0, {str(ROOT)!r}); from autograder import sandbox; "
        code += f"print(sandbox.refusal_as_user({str(root)!r}))"
        return subprocess.run([python, "-c", code], capture_output=True, text=True, cwd="/", **options).stdout.strip()

    assert refusal(open_python, closed) == "None"
    assert refusal(open_python, "/usr/share").startswith("Anybody on this machine may read the course")
    assert refusal(open_python, closed, user=65534, group=65534).startswith(
        "Each notebook would run as a user of its own"
    )
    if sys.executable != open_python:
        assert refusal(sys.executable, closed).startswith("Other users cannot read the Python in use")
