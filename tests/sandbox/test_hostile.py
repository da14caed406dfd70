"""Hostile notebooks, in the real sandbox: each earns what its honest part earns, and does no harm to anything else.

Attacks are graded in classes, beside an honest student and a plainly wrong one, by the same pool that grades a course.
Most are one cell, put below the imports of a solved notebook (`harm`: all points stay) or of one whose functions are
all wrong (`cheat`: 0 points stay). Words in capitals between @ stand for what is only known when the class is graded.
"""

import copy
import html
import html.parser
import itertools
import json
import os
import re
import shutil
import socket
import stat
import sys
import tempfile
import textwrap
import time
from dataclasses import dataclass, field, replace
from pathlib import Path

import nbformat
import pytest
from support import ASKED, PATIENCE
from support import points as points_of

from autograder.bridge.gradebook import Writer
from autograder.course import Course
from autograder.grading.classroom import grade_class
from autograder.grading.grade import grading_run
from autograder.intake.restore import restore
from autograder.pages.export import totals
from autograder.sandbox import Limits
from autograder.untrusted import PICTURES, TEXT

ONE = "1_rotation"
EXERCISES = tuple(ASKED[ONE].points)
POINTS = points_of(ONE)
MARK = "hostile-mark"  # in the names of all that attacks leave lying about
SHM_KEY = 0x686F7374
SECRET = "a-secret-of-the-grader"
NOBODY = 100_000  # processes of sandboxes have this user or a higher one, when root grades
# Short, for attacks to end soon. Time in which others had the processor is not counted, so honest work still passes.
LIMITS = Limits(cell=3, call=2, grace=1, notebook=40, submission=120, cpu=6, memory=1_000_000_000, processes=48)


@dataclass(frozen=True)
class Attack:
    """One hostile submission, and what becomes of it."""

    name: str
    cell: str = ""  # code, put below the imports
    wrong: bool = False  # all functions are wrong: they return what answer() returns
    solutions: dict = field(default_factory=dict)  # {exercise: code in place of its solution}
    prepare: object = None  # function(folder, notebook as JSON, course) that hands in; the default writes the notebook
    points: float = POINTS
    status: object = "graded"  # of all exercises, or {exercise: status} of those that are not graded; "a|b": either
    says: str = ""  # stands in the problems or in an output


def plain(code):
    """Code as it would stand in a cell."""
    return textwrap.dedent(code).strip("\n")


def harm(name, cell, says="", **more):
    return Attack(name, cell, says=says, **more)


def cheat(name, cell, says="", **more):
    return Attack(name, cell, wrong=True, points=0.0, says=says, **more)


def in_call(name, body, status, says="", exercise="is_rotation"):
    points = POINTS - ASKED[ONE].points[exercise]
    code = f"def {exercise}(*arguments, **named):\n" + "".join(f"    {line}\n" for line in plain(body).splitlines())
    return Attack(name, solutions={exercise: code}, points=points, status={exercise: status}, says=says)


def files(name, prepare, says="", **more):
    return Attack(name, prepare=prepare, says=says, **more)


def unreadable(name, content, says):
    """content: bytes, or a function that hands something in that is no notebook."""
    prepare = content if callable(content) else lambda folder, notebook, course: put(folder, content)
    return Attack(name, prepare=prepare, points=0.0, status="unreadable", says=says)


STOPPED = "the grader stopped this cell"
SLOW = f"{STOPPED}: it took too long"
ENDED = f"{STOPPED}: its process ended all of a sudden"
SENT = f"{STOPPED}: its process sent what the grader's own code never sends"
USED = f"{STOPPED}: it used more than"

# --- Marks without work: the judge's own code, data and answers -------------------------------------------------------

FORGE = """
import json, os, socket, stat, struct
def sockets():
    for fd in range(3, 256):
        try:
            if stat.S_ISSOCK(os.fstat(fd).st_mode):
                yield fd
        except OSError:
            continue
def frame(message):
    data = json.dumps(message).encode()
    return struct.pack('>I', len(data)) + data
"""
ACTIONS = """
import gc, signal
executor = signal.getsignal(signal.SIGINT).__self__
actions = next(found for method in gc.get_referrers(executor) for found in gc.get_referrers(method)
               if isinstance(found, dict) and 'run_cell' in found and 'prepare' in found)
"""
RIGHT = "{'outcome': 'returned', 'value': True, 'changed': False, 'score': 7, 'credit': 1.0, 'right': True}"

CHECKS = [
    cheat(
        "input transformer",
        "get_ipython().input_transformers_post.append(lambda lines: ['7.0'] if any('check(' in l for l in lines) else lines)",
    ),
    cheat(
        "syntax tree transformer",
        """
        import ast
        class Drop(ast.NodeTransformer):
            def visit_Call(self, node):
                return ast.Constant(7.0) if getattr(node.func, 'id', '') == 'check' else node
        get_ipython().ast_transformers.append(Drop())
        """,
    ),
    cheat(
        "check replaced",
        """
        import transform_lab
        check = transform_lab.check = lambda *a: 7.0
        import sys; sys.modules['transform_lab.check'].check = check
        """,
    ),
    cheat(
        "the judge's modules patched",
        """
        import sys
        from transform_lab.judging import answers, diagnosis, verdict
        answers.agree = verdict.agree = lambda *a: True
        answers.TOLERANCE = 1e9
        diagnosis.constant = verdict.constant = lambda *a: False
        verdict.credit = lambda *a: 1.0
        verdict.Verdict.right = property(lambda self: True)
        """,
    ),
    cheat(
        "comparisons of NumPy patched",
        """
        for name in ('allclose', 'isclose', 'array_equal', 'all', 'any'):
            setattr(np, name, lambda *a, **k: True)
        np.testing.assert_allclose = lambda *a, **k: None
        np.abs = np.maximum = lambda *a: 0.0
        """,
    ),
    cheat(
        "built-in functions patched",
        """
        import builtins
        builtins.all = builtins.any = lambda *a: True
        builtins.abs = lambda x: 0
        builtins.round = lambda *a: 7.0
        """,
    ),
    cheat(
        "json patched",
        """
        import json
        honest = json.dumps
        def dumps(value, **more):
            if isinstance(value, dict) and 'nonce' in value:
                value = {**value, 'score': 7, 'credit': 1.0, 'right': True, 'status': 'graded'}
            return honest(value, **more)
        json.dumps = dumps
        """,
    ),
    cheat(
        "IPython patched",
        """
        shell = type(get_ipython())
        honest = shell.run_cell
        shell.run_cell = lambda self, code, *a, **k: honest(self, '7.0' if 'check' in code else code, *a, **k)
        shell.do_execute = lambda *a, **k: {'status': 'ok'}
        shell.showtraceback = shell._showtraceback = lambda *a, **k: None
        """,
    ),
    cheat(
        "the executor replaced",
        ACTIONS + f"executor._call = lambda *a: {RIGHT}\nprint('executor found')",
        "executor found",
    ),
    cheat(
        "forged replies with guessed nonces",
        FORGE
        + f"for fd in sockets():\n    for n in ('', '0', None, 'guess'):\n        os.write(fd, frame({{'nonce': n, **{RIGHT}}}))",
    ),
    cheat(
        "a thread that answers the grader",
        FORGE
        + "import threading\n"
        + "def answer_all(fd):\n"
        + "    while True:\n"
        + "        peeked = os.read(fd, 1 << 16)\n"
        + "        if not peeked:\n"
        + "            return\n"
        + "        try:\n"
        + "            request = json.loads(peeked[4:])\n"
        + f"            reply = {RIGHT}\n"
        + "            if request['action'] == 'run_cell':\n"
        + "                reply = {'outputs': [], 'execution_count': 1, 'ended': False}\n"
        + "            os.write(fd, frame({'nonce': request['nonce'], **reply}))\n"
        + "        except ValueError:\n"
        + "            continue\n"
        + "for fd in sockets():\n    threading.Thread(target=answer_all, args=(fd,), daemon=True).start()",
        status="graded|timeout|killed|error",
    ),
    harm("a flood of forged frames", FORGE + "for fd in sockets():\n    os.write(fd, frame({}) * 500)", SENT),
    harm(
        "writes to every descriptor",
        """
        import os
        for fd in range(256):
            try:
                os.write(fd, b'\\xff' * 5000)
            except OSError:
                continue
        """,
        SENT,
    ),
    cheat(
        "the cases remembered from run to run",
        """
        import os, pickle
        known = [os.path.join(d, f) for d in ('/tmp', '/dev/shm', '/course', '.') for f in os.listdir(d) if '@MARK@' in f]
        print('left from before:', known)
        def answer(*arguments):
            for folder in ('/tmp', '/dev/shm', '/course'):
                pickle.dump(arguments, open(folder + '/@MARK@-cases', 'ab'))
            os._exit(0)
        """,
        "left from before: []",
        status="killed",
    ),
]

# --- Marks without work: values that lie ------------------------------------------------------------------------------


def answers(name, setup, value, **more):
    return cheat(name, f"{plain(setup)}\ndef answer(*arguments):\n    return {value}", **more)


LIES = [
    answers(
        "equal to everything",
        """
        class Lie:
            __hash__ = None
            __eq__ = __le__ = __ge__ = __contains__ = __bool__ = lambda *a: True
            __ne__ = __lt__ = __gt__ = lambda *a: False
            __float__ = lambda self: 1.0
            __array__ = lambda self, *a, **k: np.eye(3)
            __sub__ = __rsub__ = __abs__ = lambda *a: 0.0
        """,
        "Lie()",
    ),
    answers(
        "another class than its own",
        """
        class Lie:
            shape, size, ndim, dtype = (3, 3), 9, 2, np.dtype(float)
            __class__ = property(lambda self: np.ndarray)
            __len__ = lambda self: 3
        """,
        "Lie()",
        status="error",
    ),
    answers(
        "an array that lies",
        """
        class Lie(np.ndarray):
            __eq__ = lambda *a: True
            __sub__ = __rsub__ = __abs__ = __array_ufunc__ = lambda self, *a, **k: np.zeros(self.shape)
            shape = property(lambda self: (3, 3))
            tolist = lambda self: [[1, 0, 0]] * 3
        """,
        "np.arange(9.0).view(Lie)",
    ),
    answers(
        "numbers that lie",
        """
        class Lie(float):
            __eq__ = __le__ = lambda *a: True
            __sub__ = __rsub__ = __abs__ = lambda *a: 0.0
            __float__ = lambda self: float('nan')
        """,
        "[[Lie(5)] * 3] * 3",
    ),
    in_call(
        "a list without end",
        """
        class Lie(list):
            __len__ = lambda self: 3
            def __iter__(self):
                while True:
                    yield 1.0
        return Lie()
        """,
        "timeout|error|killed",
    ),
    answers(
        "fields that change with each look",
        """
        import itertools
        class Lie:
            count = itertools.count()
            position = orientation = x = y = z = w = property(lambda self: next(self.count))
        """,
        "Lie()",
    ),
    answers("fields without end", "class Lie:\n    __getattr__ = lambda self, name: self", "Lie()"),
    answers(
        "nested 10,000 deep",
        """
        deep = []
        for _ in range(10_000):
            deep = [deep]
        """,
        "deep",
    ),
    answers("a list that contains itself", "ring = []\nring.append(ring)", "ring"),
    in_call(
        "lists of lists that share everything",
        """
        a = [0.0] * 100
        for _ in range(4):
            a = [a] * 100
        return a
        """,
        "graded",
    ),
    answers("a huge array", "huge = np.ones(10**7)", "huge"),
    answers("a huge text", "huge = 'x' * 10**8", "huge"),
    answers("a huge integer", "huge = 10**5000", "huge"),
    answers("not a number", "", "np.full((3, 3), np.nan)"),
    answers("infinity", "", "np.full((3, 3), np.inf)"),
    answers("a dictionary", "", "{'array': [1, 0, 0], 'shape': [3]}"),
    answers("a generator", "", "(x for x in arguments)"),
    answers("half a character", "", "'\\ud800'"),
    answers("a type with half a character in its name", "odd = type('\\ud800', (), {})", "odd()"),
    answers(
        "a type with script in its name",
        "odd = type('<script>alert(1)</script><img src=x onerror=alert(1)>', (), {})",
        "odd()",
    ),
    answers("an answer of script", "", "'<script>alert(1)</script><img src=x onerror=alert(1)>'"),
    answers(
        "an error of script",
        "",
        "1 / 0 if arguments is None else [][Exception('<script>alert(1)</script>')]",
        status="error",
    ),
    cheat(
        "replies that the executor never makes",
        ACTIONS
        + """\
deep = []
for _ in range(800):
    deep = [deep]
executor._call = lambda *a: {'outcome': 'returned', 'value': deep, 'changed': False}""",
        status="killed",
    ),
    harm(
        "outputs that the executor never makes",
        ACTIONS
        + """\
def odd(source, honest=actions['run_cell']):
    honest(source)
    outputs = [{'output_type': t, 'name': {}, 'text': [1], 'data': d, 'traceback': [{}], 'evalue': '\\ud800'}
               for t in ('stream', 'error', 'display_data', 'execute_result', [], None, 7)
               for d in ({}, [], {'text/html': ['<script>', 'alert(1)</script>'], 'text/plain': '\\udfff'}, {'x': 1})]
    changed = [[0, 0, output] for output in outputs]
    return {'outputs': outputs, 'changed': changed, 'execution_count': 10**4000, 'ended': 'no'}
actions['run_cell'] = odd""",
    ),
]

# --- Out of the sandbox -----------------------------------------------------------------------------------------------

ESCAPES = [
    harm(
        "the course read",
        """
        import os
        read = []
        for path in ('gradebook.db', 'source/transforms/1_rotation.ipynb', 'source/transforms/transform_lab/key.json',
                     'submitted/honest/transforms/1_rotation.ipynb', 'autograder/exercises/__init__.py', '.', 'README.md'):
            try:
                path = os.path.join('@COURSE@', path)
                read.append(os.listdir(path) if os.path.isdir(path) else open(path).read())
            except OSError:
                continue
        print('read', read)
        """,
        "read []",
    ),
    harm(
        "all folders searched",
        """
        import os
        found = []
        for folder, folders, names in os.walk('/'):
            folders[:] = [name for name in folders if name not in ('proc', 'sys', 'usr', 'site-packages')]
            found += [os.path.join(folder, name) for name in names
                      if name in ('key.json', 'gradebook.db', 'judge.py', 'shadow') or name.startswith('1_rotation')]
        print('found', found)
        """,
        "found []",
    ),
    harm(
        "secrets of other processes",
        """
        import glob
        read = []
        for path in [p for name in ('environ', 'cmdline', 'maps') for p in glob.glob(f'/proc/[0-9]*/{name}')]:
            try:
                read.append(open(path, 'rb').read())
            except OSError:
                continue
        text = b' '.join(read)
        print('secrets', [word for word in (b'a-secret-of-the-gra' + b'der', b'@COURSE@') if word in text])
        """,
        "secrets []",
    ),
    harm(
        "the root of process 1",
        """
        import glob, os
        seen = []
        for path in [*glob.glob('/proc/[0-9]*/root'), *glob.glob('/proc/[0-9]*/cwd'), *glob.glob('/proc/[0-9]*/fd/*')]:
            for inside in ('@COURSE@', '/etc/shadow', '/root/.bashrc', '/root/.ssh', '/home'):
                if os.path.exists(path + inside):
                    seen.append(path + inside)
        print('seen', seen)
        """,
        "seen []",
    ),
    harm(
        "the processes that hold the sandbox open",
        """
        import os
        reached = []
        for process in os.listdir('/proc'):
            if process.isdigit() and int(process) != os.getpid():
                for name in ('mem', 'maps', 'environ', 'auxv', 'syscall', 'personality', 'stack', 'io'):
                    try:
                        file = os.open(f'/proc/{process}/{name}', os.O_RDWR if name == 'mem' else os.O_RDONLY)
                        reached.append((process, name, name == 'mem' or os.read(file, 100)))
                    except OSError:
                        continue
                links = ['root', 'cwd', 'exe', 'ns/user', 'ns/mnt', *(f'fd/{number}' for number in range(64))]
                for name in links:
                    try:
                        reached.append((process, name, os.readlink(f'/proc/{process}/{name}')))
                    except OSError:
                        continue
        print('reached', reached)
        """,
        "reached []",
    ),
    harm(
        "the loopback of the machine",
        """
        import os, socket, subprocess
        reached = []
        for host in ('127.0.0.1', '::1', '10.0.2.2', '8.8.8.8'):
            try:
                socket.create_connection((host, @PORT@), timeout=0.3)
                reached.append(host)
            except OSError:
                continue
        if subprocess.run(['bash', '-c', 'exec 3<>/dev/tcp/127.0.0.1/@PORT@'], stderr=-3).returncode == 0:
            reached.append('bash')
        print('reached', reached)
        """,
        "reached []",
    ),
    harm(
        "sockets of the machine",
        """
        import socket
        reached = []
        for address in ('\\0@MARK@-@PORT@', '@COURSE@/socket', '/run/docker.sock', '/run/dbus/system_bus_socket'):
            for kind in (socket.SOCK_STREAM, socket.SOCK_DGRAM):
                try:
                    socket.socket(socket.AF_UNIX, kind).connect(address)
                    reached.append(address)
                except OSError:
                    continue
        print('reached', reached)
        """,
        "reached []",
    ),
    harm(
        "other families of sockets",
        """
        import socket
        made = []
        for family in range(2, 46):
            for kind in (1, 2, 3, 5):
                try:
                    socket.socket(family, kind)
                    made.append(family)
                except OSError:
                    continue
        print('made', made)
        """,
        "made []",
    ),
    harm(
        "privileges by the C library",
        """
        import ctypes, os
        libc, allowed = ctypes.CDLL(None, use_errno=True), []
        for name, *arguments in [('unshare', 0x10000000), ('unshare', 0x20000), ('umount2', b'/tmp', 2),
                ('mount', b'x', b'/tmp', b'tmpfs', 0, None),
                ('ptrace', 16, 1, 0, 0), ('ptrace', 0, 0, 0, 0), ('setuid', 0), ('setgid', 0),
                ('setresuid', 0, 0, 0), ('chroot', b'/tmp'), ('setns', 0, 0), ('sethostname', b'x', 1),
                ('setgroups', 0, None), ('swapon', b'/tmp/x', 0), ('acct', b'/tmp/x'),
                ('mknod', b'/tmp/null', 0o20666, 0x103), ('memfd_create', b'x', 0)]:
            if getattr(libc, name)(*arguments) != -1:
                allowed.append(name)
        print('allowed', allowed)
        """,
        "allowed []",
    ),
    harm(
        "privileges by system calls",
        """
        import ctypes, errno, os, platform
        libc, allowed = ctypes.CDLL(None, use_errno=True), []
        numbers = dict(memfd_create=319, userfaultfd=323, io_uring_setup=425, bpf=321, perf_event_open=298, keyctl=250,
            add_key=248, process_vm_readv=310, process_vm_writev=311, pidfd_getfd=438, open_by_handle_at=304, move_mount=429,
            fsopen=430, open_tree=428, mount_setattr=442, clone3=435, shmget=29, msgget=68, semget=64, setns=308, kcmp=312,
            personality=135, vmsplice=278, memfd_secret=447, pivot_root=155, init_module=175, syslog=103, fanotify_init=300)
        for name, number in numbers.items() if platform.machine() == 'x86_64' else ():
            if libc.syscall(number, 0, 0, 0, 0, 0, 0) != -1 or ctypes.get_errno() not in (errno.EPERM, errno.ENOSYS):
                allowed.append(name)
        print('allowed', allowed)
        """,
        "allowed []",
    ),
    harm(
        "system calls of another architecture",
        """
        import ctypes, mmap, os, platform
        if platform.machine() != 'x86_64':
            os._exit(1)
        code = mmap.mmap(-1, 4096, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS, prot=7)
        code.write(b'\\xb8\\x14\\x00\\x00\\x00\\xcd\\x80\\xc3')  # getpid, as a 32-bit program asks for it
        print('answered', ctypes.CFUNCTYPE(ctypes.c_int)(ctypes.addressof(ctypes.c_char.from_buffer(code)))())
        """,
        ENDED,
    ),
    harm(
        "programs that make root",
        """
        import glob, os, resource, subprocess
        gained = []
        for command in (['su', '-c', 'id'], ['sudo', '-n', 'id'], ['newgrp', 'root'], ['mount', '-t', 'tmpfs', 'x', '/tmp'],
                        ['unshare', '-Ur', 'id'], ['bwrap', '--ro-bind', '/', '/', 'id'], ['nsenter', '-t', '1', '-a', 'id']):
            try:
                if subprocess.run(command, capture_output=True, stdin=-3, timeout=2).returncode == 0:
                    gained.append(command)
            except (OSError, subprocess.TimeoutExpired):
                continue
        for limit in (resource.RLIMIT_AS, resource.RLIMIT_NPROC, resource.RLIMIT_NOFILE, resource.RLIMIT_FSIZE):
            try:
                resource.setrlimit(limit, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
                gained.append(limit)
            except (OSError, ValueError):
                continue
        print('gained', gained)
        """,
        "gained []",
    ),
    harm(
        "written where nothing may be written",
        """
        import os
        written = []
        for folder in ('/', '/dev', '/etc', '/usr', '/usr/bin', '/course/transforms/transform_lab',
                       '/proc/sys/kernel', '/sys', '/home'):
            try:
                open(os.path.join(folder, '@MARK@'), 'w').write('x')
                written.append(folder)
            except OSError:
                continue
        print('written', written)
        """,
        "written []",
    ),
]

# --- Time -------------------------------------------------------------------------------------------------------------

DEAF = """\
import signal, time
signal.signal(signal.SIGINT, signal.SIG_IGN)
"""
TOO_LONG = "The grader stopped this cell: it took too long."
LOST = dict.fromkeys(EXERCISES, "timeout")

TIME = [
    harm("an endless cell", "while True:\n    pass", TOO_LONG),
    harm("a long sleep", "import time\ntime.sleep(10_000)", TOO_LONG),
    harm("deaf to the interrupt", DEAF + "while True:\n    time.sleep(0.01)", SLOW),
    harm(
        "every exception swallowed",
        """
        while True:
            try:
                while True:
                    pass
            except BaseException:
                pass
        """,
        SLOW,
    ),
    harm("waiting in C", DEAF + "import ctypes\nctypes.CDLL(None).pause()", SLOW),
    harm("computing in C", "sum(range(10**13))", SLOW),
    harm("stopped itself", "import os\nos.kill(os.getpid(), 19)", SLOW),
    harm(
        "an alarm",
        """
        import signal, time
        signal.setitimer(signal.ITIMER_REAL, 0.2)
        time.sleep(2)
        """,
        ENDED,
    ),
    in_call("an endless call", "while True:\n    pass", "timeout", "Your function did not finish in time"),
    in_call("a deaf call", DEAF + "while True:\n    time.sleep(0.01)", "timeout", "did not finish in time"),
    in_call(
        "a call that waits in C", DEAF + "import ctypes\nctypes.CDLL(None).pause()", "timeout", "did not finish in time"
    ),
    in_call("recursion without end", "return is_rotation(*arguments)", "error", "RecursionError"),
    Attack(
        "one endless cell after another",
        prepare=lambda folder, notebook, course: put(
            folder, with_cells(notebook, ["import time\ntime.sleep(99)"] * 12)
        ),
        points=0.0,
        status="timeout",
        says="The notebook did not get as far as this cell",
    ),
    harm(
        "threads left over",
        """
        import threading, time
        for _ in range(8):
            threading.Thread(target=time.sleep, args=(9999,)).start()
        """,
    ),
]

# --- Processes --------------------------------------------------------------------------------------------------------

DAEMON = """\
import os, time
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        os.closerange(0, 256)
        while True:
            for folder in ('/tmp', '/dev/shm', '/course', '@COURSE@'):
                try:
                    open(folder + '/@MARK@-daemon', 'w').write('x')
                except OSError:
                    continue
            time.sleep(0.05)
    os._exit(0)
os.wait()"""
PROCESSES = [
    harm(
        "a fork bomb",
        DEAF
        + """\
import os
while True:
    try:
        os.fork()
    except BaseException:
        continue""",
        STOPPED,
    ),
    harm(
        "a shell's fork bomb",
        """
        import os
        os.system("bash -c 'bomb() { bomb | bomb & }; bomb; sleep 1'")
        os._exit(1)
        """,
        STOPPED,
    ),
    harm("a daemon", DAEMON),
    harm(
        "a program in the background",
        """
        import os
        os.system('setsid nohup sleep 86399 >/dev/null 2>&1 &')
        _ = os.system('sleep 86399 &')
        """,
    ),
    harm(
        "a hook at the exit",
        "import atexit, os\natexit.register(os.system, 'touch /tmp/@MARK@-exit @COURSE@/@MARK@-exit; sleep 86399')",
    ),
    harm("its process ended", "import os\nos._exit(0)", ENDED),
    harm("aborted", "import os\nos.abort()", ENDED),
    harm("a wild pointer", "import ctypes\nctypes.string_at(0)", ENDED),
    harm(
        "everybody killed",
        """
        import os, time
        os.kill(-1, 9)
        time.sleep(0.3)
        """,
    ),
    harm(
        "process 1 and the parent killed",
        """
        import os, time
        for pid in (os.getppid(), 1, 2, *range(3, 3000)):
            if pid not in (0, os.getpid()):
                try:
                    os.kill(pid, 9)
                except OSError:
                    continue
        time.sleep(0.5)
        os._exit(0)
        """,
        STOPPED,
    ),
    in_call("its process ended in a call", "import os\nos._exit(0)", "killed", "had to be stopped"),
    in_call("a wild pointer in a call", "import ctypes\nctypes.string_at(0)", "killed", "had to be stopped"),
    in_call("SystemExit in a call", "raise SystemExit", "error", "SystemExit"),
    harm("exit() at the top", "exit()", "calls exit() or quit()", points=0.0, status="error"),
    harm("all descriptors closed", "import os\nos.closerange(0, 256)", ENDED),
    harm(
        "48 busy processes",
        DEAF
        + """\
import os
for _ in range(40):
    if os.fork() == 0:
        os.setsid()
        while True:
            pass
while True:
    pass""",
        STOPPED,
    ),
]

# --- Memory, files and output -----------------------------------------------------------------------------------------

FILL = """\
import os, socket
kept, total = [], 0
"""
MEMORY = [
    harm("one large piece", "x = bytearray(10**11)", "MemoryError"),
    harm(
        "a list that grows",
        """
        x = [0]
        while True:
            x += x
        """,
        "MemoryError",
    ),
    harm(
        "many processes, each with much",
        """
        import os, time
        for _ in range(12):
            if os.fork() == 0:
                x = b'x' * 300_000_000
                time.sleep(60)
                os._exit(0)
        time.sleep(60)
        """,
        USED + " 1 GB of memory",
    ),
    harm(
        "shared memory that nobody maps",
        """
        import mmap, os
        got = []
        for number in (-1, os.open('/dev/zero', os.O_RDWR)):
            try:
                got.append(mmap.mmap(number, 4096))
            except OSError:
                continue
        print('got', got)
        """,
        "got []",
    ),
    harm(
        "small folders filled",
        """
        written = 0
        for folder in ('/tmp', '/dev/shm', '/course'):
            for number in range(100):
                try:
                    written += open(f'{folder}/@MARK@-{number}', 'wb').write(b'x' * 10_000_000)
                except OSError:
                    break
        print('bounded' if written < 200_000_000 else written)
        """,
        "bounded",
    ),
    harm(
        "memory without an owner",
        """
        import ctypes, os
        libc = ctypes.CDLL(None, use_errno=True)
        print('got', [libc.shmget(0x686f7374, 100_000_000, 0o1666), libc.memfd_create(b'x', 0)])
        """,
        "got [-1, -1]",
    ),
    harm(
        "buffers of sockets and pipes",
        FILL
        + """\
try:
    while True:
        pair = socket.socketpair()
        kept.append(pair)
        for end in pair:
            end.setblocking(False)
            try:
                while True:
                    total += end.send(b'x' * 65536)
            except BlockingIOError:
                continue
except OSError:
    del pair
    kept.pop()
try:
    while True:
        read, write = os.pipe()
        kept.append(read)
        os.set_blocking(write, False)
        total += os.write(write, b'x' * 10**6)
except OSError:
    pass
print('bounded' if total < 150_000_000 else total)
del kept[:]""",
        "bounded",
    ),
    harm(
        "a million empty files",
        "for number in range(10**6):\n    open(f'/tmp/@MARK@-{number}', 'w').close()",
        USED + " 20000 files",
    ),
    harm("a file of 10 GB", "open('/course/@MARK@-large', 'wb').truncate(10**10)", "File too large"),
    in_call("much in a call", "return [0] * 10**10", "error", "MemoryError"),
    in_call(
        "many processes in a call",
        """
        import os, time
        for _ in range(12):
            if os.fork() == 0:
                x = b'x' * 300_000_000
                time.sleep(60)
                os._exit(0)
        time.sleep(60)
        """,
        "killed|timeout",
    ),
]

TOO_MUCH = "[more output than the grader keeps]"
FLOODS = [
    harm("300 MB of output", "for _ in range(3000):\n    print('x' * 100_000)", TOO_MUCH),
    harm(
        "300 MB past Python",
        """
        import os
        for _ in range(300):
            os.write(1, b'x' * 10**6)
        """,
        TOO_MUCH,
    ),
    harm("a command without end", "!yes hostile | head -c 300000000", "hostile"),
    harm(
        "300 MB of errors",
        """
        import sys
        for _ in range(3000):
            sys.stderr.write('x' * 100_000)
        """,
        TOO_MUCH,
    ),
    harm("one enormous line", "print('x' * 10**8)", TOO_MUCH),
    harm("enormous HTML", "from IPython.display import HTML\ndisplay(HTML('<b>x</b>' * 10**7))", TOO_MUCH),
    harm("an enormous error", "raise ValueError('x' * 10**7)", TOO_MUCH),
    harm("countless outputs", "for number in range(10**6):\n    display(number)", ""),
    harm(
        "an output that grows by updates",
        """
        from IPython.display import HTML
        h = display(1, display_id=True)
        h.update(HTML('x' * 10**7))
        """,
        "",
    ),
    in_call("output in a call", "for _ in range(10):\n    print('x' * 10**6)", "graded", "is_rotation: not right yet"),
]

# --- Python itself ----------------------------------------------------------------------------------------------------

DESTROYED = {"points": 0.0, "status": "error"}  # no cell after it can be run, so no function is ever defined

PYTHON = [
    harm(
        "no finders of modules",
        """
        import sys
        sys.meta_path.clear()
        sys.path_hooks.clear()
        sys.path.clear()
        """,
    ),
    harm(
        "imports that fail",
        """
        import builtins
        def refuse(*a, **k):
            raise ImportError('no')
        builtins.__import__ = refuse
        """,
        **DESTROYED,
    ),
    harm(
        "a trace function",
        """
        import sys
        def trace(*a):
            raise RuntimeError('traced')
        sys.settrace(trace)
        """,
    ),
    harm(
        "a profile function",
        """
        import sys
        def profile(*a):
            raise RuntimeError('profiled')
        sys.setprofile(profile)
        """,
        "",
    ),
    harm("no modules", "import sys\nsys.modules.clear()", **DESTROYED),
    harm("no recursion", "import sys\nsys.setrecursionlimit(10)"),
    harm(
        "no garbage collection",
        """
        import gc
        gc.disable()
        gc.freeze()
        gc.collect = None
        """,
    ),
    harm(
        "no built-in functions",
        """
        import builtins
        for name in dir(builtins):
            if name[0] != '_':
                delattr(builtins, name)
        """,
        "",
    ),
    harm("no environment", "import os\nos.environ.clear()"),
    harm("another folder", "import os\nos.chdir('/')"),
    harm(
        "no folder",
        """
        import os, shutil
        shutil.rmtree(os.getcwd(), ignore_errors=True)
        shutil.rmtree('/course', ignore_errors=True)
        """,
    ),
    harm("no output", "import sys\nsys.stdout = sys.stderr = None"),
    harm(
        "closed output",
        """
        import os
        os.close(1)
        os.close(2)
        """,
        "",
    ),
    harm("NumPy replaced", "import sys, types\nsys.modules['numpy'] = types.ModuleType('numpy')"),
    harm("IPython broken", "get_ipython().run_cell_async = get_ipython().run_cell = None", **DESTROYED),
]

# --- What notebooks show ----------------------------------------------------------------------------------------------

SCRIPT = "<script>alert(1)</script>"
HTML = [
    harm("script in HTML", f"from IPython.display import HTML\ndisplay(HTML('kept{SCRIPT}'))", "kept"),
    harm(
        "script in attributes",
        """
        from IPython.display import HTML
        for text in ('<img src=x onerror=alert(1)>', '<b onclick=alert(1)>kept</b>',
            '<a href="javascript:alert(1)">x</a>', '<a href="java&#x73;cript:alert(1)">x</a>',
            '<div style="background:url(//evil)">x</div>',
            '<svg><script>alert(1)</script></svg>', '<math><mtext><table><mglyph><style><img src=x onerror=alert(1)>'):
            display(HTML(text))
        """,
        "kept",
    ),
    harm(
        "frames and resources",
        """
        from IPython.display import HTML, IFrame
        display(IFrame('https://evil.example', 9, 9))
        for tag in ('iframe src', 'object data', 'embed src', 'img src', 'link rel=stylesheet href', 'video src',
                    'audio src', 'base href', 'input type=image src', 'form action', 'body background',
                    'table background', 'source srcset', 'meta http-equiv=refresh content'):
            display(HTML(f'<b>kept</b><{tag}="https://evil.example/x"></{tag.split()[0]}>'))
        """,
        "kept",
    ),
    harm(
        "script in a picture",
        """
        from IPython.display import SVG
        display(SVG('<svg xmlns="http://www.w3.org/2000/svg" onload="alert(1)"><script>alert(1)</script></svg>'))
        display({'image/png': 'AAAA\\"><script>alert(1)</script>', 'text/plain': 'kept'}, raw=True)
        display({'image/svg+xml': '<svg onload=alert(1)>', 'image/jpeg': 'javascript:alert(1)===='}, raw=True)
        """,
        "kept",
    ),
    harm(
        "script by its name",
        """
        from IPython.display import Javascript
        display(Javascript('alert(1)'))
        display({'application/javascript': 'alert(1)', 'text/plain': 'kept',
            'application/vnd.jupyter.widget-view+json': {'model_id': 'x'},
            'application/vnd.plotly.v1+json': {}, 'text/x-script': '<script>', 'application/x-html': '<script>'}, raw=True)
        """,
        "kept",
    ),
    harm(
        "Markdown",
        """
        from IPython.display import Markdown
        display(Markdown('kept [x](javascript:alert(1)) ![x](https://evil.example/x.png) <script>alert(1)</script>'))
        display(Markdown('<img src=x onerror=alert(1)> <iframe src=//evil.example></iframe> [y]: javascript:alert(1)'))
        """,
        "kept",
    ),
    harm(
        "LaTeX",
        """
        from IPython.display import HTML, Latex, Markdown
        tricks = r'kept $\\href{javascript:alert(1)}{x} \\require{html} \\style{background:url(//evil.example)}{x}$'
        display(Latex(tricks), HTML(tricks), Markdown(tricks), Latex('<script>alert(1)</script>'))
        """,
        "kept",
    ),
    harm(
        "metadata of an output",
        """
        display({'text/plain': 'kept', 'image/png': 'AAAA'}, metadata={'image/png': {'width': '1" onload="alert(1)'},
            'filenames': {'image/png': 'javascript:alert(1)'}}, raw=True)
        """,
        "kept",
    ),
    harm(
        "script in errors",
        f"""
        class Odd(Exception):
            _render_traceback_ = lambda self: ['{SCRIPT}', '\\x1b]8;;javascript:alert(1)\\x1b\\\\x']
        raise type('<script>', (Odd,), {{}})('kept{SCRIPT}')
        """,
        "kept",
    ),
]


# --- What is handed in ------------------------------------------------------------------------------------------------


def put(folder, content, name=f"{ONE}.ipynb"):
    """content: bytes, or JSON"""
    (folder / name).write_bytes(content if isinstance(content, bytes) else json.dumps(content).encode())


def with_cells(notebook, sources):
    """A notebook with more code cells below its imports."""
    cells = [nbformat.v4.new_code_cell(source, id=f"hostile-{number}") for number, source in enumerate(sources)]
    notebook["cells"][2:2] = cells
    return notebook


def changed(change):
    """Hand in the notebook that `change(cells)` was made to."""

    def prepare(folder, notebook, course):
        result = change(notebook["cells"])
        if result is not None:
            notebook["cells"] = result
        put(folder, notebook)

    return prepare


def nbgrader(cell):
    return cell["metadata"].get("nbgrader", {})


def every(change, what=lambda data: data.get("grade")):
    """Hand in the notebook in which `change(cell, nbgrader's data)` was made to all test cells."""

    def prepare(cells):
        for cell in [cell for cell in cells if what(nbgrader(cell))]:
            change(cell, cell["metadata"]["nbgrader"])

    return changed(prepare)


def with_tests_first(cells):
    return [
        *(cell for cell in cells if nbgrader(cell).get("grade")),
        *(c for c in cells if not nbgrader(c).get("grade")),
    ]


def claims_another(cells):
    """The test cell of is_rotation says that it is the one of rotation_about_z."""
    for cell in cells:
        if nbgrader(cell).get("grade_id") == "is_rotation":
            nbgrader(cell)["grade_id"] = "rotation_about_z"


def nested(depth):
    """A notebook whose metadata are nested so deeply."""

    def prepare(folder, notebook, course):
        put(
            folder,
            json.dumps(notebook)
            .replace('"metadata": {', '"metadata": {"x": ' + "[" * depth + "]" * depth + ", ", 1)
            .encode(),
        )

    return prepare


def other_format(number):
    def prepare(folder, notebook, course):
        put(folder, notebook | {"nbformat": number})

    return prepare


def format_3(folder, notebook, course):
    put(folder, nbformat.writes(nbformat.reads(json.dumps(notebook), as_version=4), version=3).encode())


def not_a_number(folder, notebook, course):
    notebook["metadata"]["x"] = float("nan")
    put(folder, notebook)


def many_cells(folder, notebook, course):
    notebook["cells"] += [{"cell_type": "markdown", "metadata": {}, "source": "x"}] * 100_000
    put(folder, notebook)


MARKDOWN = {
    "cell_type": "markdown",
    "id": "shown",
    "source": f"{SCRIPT}<iframe src=//evil></iframe>[x](javascript:alert(1))<img src=x onerror=alert(1)>![x](attachment:x.svg)",
    "metadata": {"tags": ["remove-cell"]},
    "attachments": {"x.svg": {"image/svg+xml": "<svg onload=alert(1)>", "text/html": SCRIPT}},
}

NOTEBOOKS = [
    files(
        "test cells tagged to be skipped",
        every(lambda cell, data: cell["metadata"].update(tags=["skip-execution", "remove-cell"])),
    ),
    files("more points", every(lambda cell, data: data.update(points=1000)), "said points 1000; it was set back"),
    files(
        "flags flipped",
        every(lambda cell, data: data.update(grade=False, solution=True, locked=False)),
        "said grade False",
    ),
    files(
        "the name of another exercise",
        changed(claims_another),  # it is known by its call
    ),
    files(
        "test cells twice",
        changed(lambda cells: cells + [c for c in copy.deepcopy(cells) if nbgrader(c).get("grade")]),
    ),
    files("all cells twice", changed(lambda cells: cells + copy.deepcopy(cells)), "is there 2 times"),
    files(
        "test cells changed",
        every(lambda cell, data: cell.update(source="7.0")),
        "had been changed; what stands there was run, and the test cell put back behind it",
    ),
    files(
        "test cells of another type",
        every(lambda cell, data: (cell.update(cell_type="raw"), cell.pop("outputs"), cell.pop("execution_count"))),
        "had another type",
    ),
    files("test cells first", changed(with_tests_first), "stood before its solution; it was moved behind it"),
    files(
        "no test cells",
        changed(lambda cells: [c for c in cells if not nbgrader(c).get("grade")]),
        "is missing; it was put back behind its solution",
    ),
    files("no cell ids", changed(lambda cells: [{k: v for k, v in c.items() if k != "id"} for c in cells])),
    files("one id for all cells", changed(lambda cells: [c | {"id": "same"} for c in cells])),
    files(
        "odd ids",
        changed(
            lambda cells: [
                c | {"id": odd} for c, odd in zip(cells, itertools.cycle(["", "a b", "x" * 99, None, 7, [], {}]))
            ]
        ),
    ),
    files("script in text and attachments", changed(lambda cells: cells + [MARKDOWN])),
    files(
        "a cell of 10 MB",
        changed(
            lambda cells: (
                cells[:2]
                + [
                    {
                        "cell_type": "code",
                        "metadata": {},
                        "outputs": [],
                        "execution_count": None,
                        "source": "x = 1  # " + "x" * 10**7,
                    }
                ]
                + cells[2:]
            )
        ),
    ),
    files("format 3", format_3),
    files("no number in the metadata", not_a_number),
    unreadable("nested 500 deep", nested(500), "it is damaged"),
    unreadable("nested 100,000 deep", nested(100_000), "it is damaged"),
    unreadable("100,000 brackets", b"[" * 100_000, "it is damaged"),
    files("format 99", other_format(99)),
    files("format as text", other_format("4")),
    files("no format", other_format(None)),
    unreadable("empty", b"", "it is empty"),
    unreadable("null", b"null", "it is a text, and no notebook"),
    unreadable("invalid UTF-8", b'{"cells": ["\xff\xfe"]}', "it is a notebook without any cell"),
    unreadable("an enormous number", b'{"nbformat": ' + b"9" * 10_000 + b"}", "JSON that holds something else"),
    unreadable(
        "100 MB",
        lambda folder, notebook, course: put(folder, json.dumps(notebook).encode() + b" " * 10**8),
        "it has more than 100 MB",
    ),
    unreadable("100,000 cells", many_cells, "at most 2000 are accepted"),
]


def link(target):
    return lambda folder, notebook, course: (folder / f"{ONE}.ipynb").symlink_to(
        str(target).replace("@COURSE@", str(course.root))
    )


def hard_link(folder, notebook, course):
    os.link(course.submitted("honest") / f"{ONE}.ipynb", folder / f"{ONE}.ipynb")


def listening(folder, notebook, course):
    """A socket in place of the notebook; bound by a short name, since long ones are not possible."""
    here = os.getcwd()
    os.chdir(folder)
    try:
        with socket.socket(socket.AF_UNIX) as server:
            server.bind(f"{ONE}.ipynb")
    finally:
        os.chdir(here)


def beside(*names, content=b"x"):
    """Hand in the notebook, and files of these names (bytes)."""

    def prepare(folder, notebook, course):
        put(folder, notebook)
        for name in names:
            path = Path(os.fsdecode(os.fsencode(folder) + b"/" + name))
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    return prepare


def deep(name):
    """Hand in the notebook, and a file 300 folders down."""

    def prepare(folder, notebook, course):
        put(folder, notebook)
        here = os.getcwd()
        os.chdir(folder)
        try:
            for _ in range(300):
                os.mkdir(name)
                os.chdir(name)
            Path("x.txt").write_text("x")
        finally:
            os.chdir(here)

    return prepare


MODULES = (
    "numpy",
    "IPython",
    "json",
    "os",
    "transform_lab",
    "sitecustomize",
    "usercustomize",
    "channel",
    "executor",
    "codec",
    "struct",
    "encodings",
)

FILES = [
    unreadable(
        "a link to another's notebook", link(f"@COURSE@/submitted/honest/transforms/{ONE}.ipynb"), "it is a link"
    ),
    unreadable("a link to the solution", link(f"@COURSE@/source/transforms/{ONE}.ipynb"), "it is a link"),
    unreadable("a link to a device", link("/dev/zero"), "it is a link"),
    unreadable("a link to itself", link(f"{ONE}.ipynb"), "it is a link"),
    files("a hard link to another's notebook", hard_link),
    unreadable("a pipe", lambda folder, notebook, course: os.mkfifo(folder / f"{ONE}.ipynb"), "no regular file"),
    unreadable("a folder", lambda folder, notebook, course: (folder / f"{ONE}.ipynb").mkdir(), "no regular file"),
    unreadable("a socket", listening, "it cannot be opened"),
    files(
        "no notebook",
        lambda folder, notebook, course: put(folder, b"x", "notes.txt"),
        "not handed in",
        points=0.0,
        status="missing",
    ),
    files(
        "names that point elsewhere",
        beside(b"..mark", b"... ", b"-rf", b"~", b"$(touch @MARK@)", b"a\\..\\b", b"con", b"nul.txt", b"%2e%2e%2fx"),
    ),
    files("names with line ends", beside(b"a\nb.txt", b"\x1b[31mred", b"\x07\r\t")),
    files("names that are no text", beside(b"x\xff.txt", b"d\xff/\xfe\xfd")),
    files("names that become the same", beside(b"d\xff", b"d\xfe/x.txt", b"e\xff", b"e\xfe")),
    files("long names", beside(b"x" * 255, b"\xff" * 255)),
    files("300 folders deep", deep("d")),
    files("300 folders deep, of long names", deep("d" * 40)),
    files(
        "modules of the grader's names",
        beside(*(f"{name}.py".encode() for name in MODULES), content=b"raise SystemExit\n"),
    ),
    files("4 MB beside the notebook", beside(b"large.bin", content=bytes(3_900_000))),
    files(
        "many links",
        lambda folder, notebook, course: (
            put(folder, notebook),
            [(folder / f"l{n}").symlink_to("/") for n in range(30)],
        ),
        "it is a link",
    ),
]

GROUPS = {
    "checks": CHECKS,
    "lies": LIES,
    "escapes": ESCAPES,
    "time": TIME,
    "processes": PROCESSES,
    "memory": MEMORY,
    "floods": FLOODS,
    "python": PYTHON,
    "html": HTML,
    "notebooks": NOTEBOOKS,
    "files": FILES,
}
ATTACKS = {(group, attack.name): attack for group, attacks in GROUPS.items() for attack in attacks}
HONEST, WRONG = "honest", "plainly wrong"
CELLS = 100_000


# --- Grading a class of them ------------------------------------------------------------------------------------------


@dataclass
class Graded:
    """What became of a class: {student: grade_class's result}, {student: points in the gradebook}, what is left over."""

    course: Course
    found: dict
    points: dict
    left: list

    def outputs(self, student):
        """All outputs of a student's first notebook."""
        path = self.course.autograded(student) / f"{ONE}.ipynb"
        if not path.exists():
            return []
        return [output for cell in nbformat.read(path, as_version=4).cells for output in cell.get("outputs", [])]


@pytest.fixture(scope="module")
def classes():
    """{group of attacks: Graded}, of those that were graded so far."""
    return {}


@pytest.fixture
def graded(request, classes, released, tmp_path_factory, sandboxed):
    """The class of a group of attacks, graded once."""
    group = request.param
    if group not in classes:
        limits = replace(LIMITS, notebook=12) if group == "time" else LIMITS
        classes[group] = grade(GROUPS[group], released, tmp_path_factory.mktemp(group), limits)
    return classes[group]


def grade(attacks, released, root, limits):
    """Grade a class of these attacks, an honest student and a plainly wrong one in a course of their own: a Graded."""
    course = Course(shutil.copytree(released.root, root / "course"))
    attacks = {attack.name: attack for attack in attacks}
    with Listeners(course) as listeners, Leftovers(course, root / "temporary") as leftovers:
        notebooks = {path.stem: path.read_bytes() for path in course.source.glob("*.ipynb")}
        hand_in(course, HONEST, lambda folder, *_: [put(folder, text, f"{n}.ipynb") for n, text in notebooks.items()])
        hand_in(course, WRONG, Attack(WRONG, wrong=True))
        for name, attack in attacks.items():
            hand_in(course, name, attack, {"COURSE": str(course.root), "PORT": str(listeners.port), "MARK": MARK})
        students = [*attacks, WRONG]
        students.insert(len(students) // 2, HONEST)
        leftovers.look()
        with Writer(course) as writer:
            against = grading_run(course, seed=7, limits=limits)
            found = {student: rest for student, *rest in grade_class(course, students, against, writer, jobs=2)}
            points = {found.student.id: found.score for found in totals(writer.gradebook)}
        left = [*leftovers.found(), *listeners.reached()]
    return Graded(course, found, points, left)


def hand_in(course, student, attack, places=None):
    folder = course.submitted(student)
    folder.mkdir(parents=True)
    notebook = json.loads((course.source / f"{ONE}.ipynb").read_text())
    if callable(attack):
        attack(folder, notebook, course)
    elif attack.prepare:
        attack.prepare(folder, notebook, course)
    else:
        put(folder, hostile(notebook, attack, places or {}))


def hostile(notebook, attack, places):
    """The solved notebook with the attack's cell below its imports, and its functions in place of the solutions."""
    cell, solutions = plain(attack.cell), dict(attack.solutions)
    if attack.wrong:
        cell = f"def answer(*arguments):\n    return 42\n\n{cell}"
        solutions = {name: f"def {name}(*arguments, **named):\n    return answer(*arguments)" for name in EXERCISES}
    for place, text in places.items():
        cell = cell.replace(f"@{place}@", text)
    for name, source in solutions.items():
        next(c for c in notebook["cells"] if nbgrader(c).get("grade_id") == f"{name}-solution")["source"] = source
    return with_cells(notebook, [cell] if cell else [])


class Listeners:
    """Sockets of this machine that no notebook may reach: on the loopback, by an abstract name, and in the course."""

    def __init__(self, course):
        self.path = str(course.root / "socket")

    def __enter__(self):
        self.sockets = [socket.create_server(("127.0.0.1", 0))]
        self.port = self.sockets[0].getsockname()[1]
        here = os.getcwd()
        os.chdir(os.path.dirname(self.path))  # the whole path is too long for a socket
        try:
            for address in (f"\0{MARK}-{self.port}", "socket"):
                self.sockets.append(socket.socket(socket.AF_UNIX))
                self.sockets[-1].bind(address)
                self.sockets[-1].listen()
        finally:
            os.chdir(here)
        return self

    def __exit__(self, *_):
        for listener in self.sockets:
            listener.close()

    def reached(self):
        """The addresses to which somebody has connected."""
        found = []
        for listener in self.sockets:
            listener.setblocking(False)
            try:
                listener.accept()
                found.append(f"connected to {listener.getsockname()}")
            except BlockingIOError:
                continue
        return found


class Leftovers:
    """Finds what a class has left behind on this machine. Other tests may be at work beside, so only what is a class's
    own counts: its temporary files lie in a folder of their own, whose name the command lines of its processes carry."""

    def __init__(self, course, temporary):
        self.course, self.temporary = course, temporary

    def __enter__(self):
        self.temporary.mkdir()
        self.before, tempfile.tempdir = tempfile.tempdir, str(self.temporary)  # the grader's processes inherit it
        os.environ["HOSTILE_SECRET"] = SECRET
        return self

    def __exit__(self, *_):
        tempfile.tempdir = self.before
        del os.environ["HOSTILE_SECRET"]

    def look(self):
        """Remember what is there before the class is graded."""
        self.files, self.machine = self._course(), set(self._machine())

    def found(self):
        """What there is now and was not before, in words; what is just ending gets some time for it."""
        processes = set(self._processes())
        for _ in range(10 * PATIENCE):
            if not processes and not list(self.temporary.iterdir()):
                break
            time.sleep(0.1)
            processes &= set(self._processes())
        found = [f"process {process}" for process in processes]
        found += [f"file {path}" for path in self.temporary.iterdir()]
        found += [f"file {path}" for path in set(self._machine()) - self.machine]
        after = self._course()
        for path in sorted(set(self.files) | set(after)):
            if self.files.get(path) != after.get(path) and path.split(os.sep)[0] not in ("autograded", "gradebook.db"):
                found.append(f"changed: {path}")
        handed_in = {path.name for path in (self.course.root / "submitted").iterdir()}
        strange = {path.name for path in (self.course.root / "autograded").iterdir()} - handed_in
        found += [f"autograded {name}" for name in strange]
        for line in Path("/proc/sysvipc/shm").read_text().splitlines()[1:]:
            if int(line.split()[0]) & 0xFFFFFFFF == SHM_KEY:
                found.append("shared memory")
        return found

    def _course(self):
        """{path: its kind, owner and size} of all files of the course."""
        found = {}
        for folder, folders, names, descriptor in os.fwalk(self.course.root):  # some paths are too long to be opened
            for name in folders + names:
                status = os.lstat(name, dir_fd=descriptor)
                if not stat.S_ISDIR(status.st_mode):
                    found[os.path.relpath(os.path.join(folder, name), self.course.root)] = (
                        status.st_mode,
                        status.st_uid,
                        status.st_size,
                    )
        return found

    def _machine(self):
        """Files of notebooks in the machine's folders for temporary ones."""
        for folder in (Path("/tmp"), Path("/dev/shm"), Path("/var/tmp"), Path.home(), Path("/")):
            for entry in os.scandir(folder):
                try:
                    owner = entry.stat(follow_symlinks=False).st_uid
                except FileNotFoundError:
                    continue  # of another test, and gone by now
                if MARK in entry.name or owner >= NOBODY:
                    yield entry.path

    def _processes(self):
        """Processes of this class (their number and start): by their user, command line or environment."""
        for path in Path("/proc").iterdir():
            if not path.name.isdigit() or int(path.name) == os.getpid():
                continue
            try:
                words = path.joinpath("cmdline").read_bytes()
                mine = str(self.temporary).encode() in words or b"86399" in words
                if mine or path.stat().st_uid >= NOBODY:
                    started = path.joinpath("stat").read_text().rpartition(")")[2].split()[19]
                    yield path.name, started, words
            except OSError:
                continue  # it has just ended, or is none of ours


# --- The tests --------------------------------------------------------------------------------------------------------


def test_countless_cells_are_refused_at_once(released):
    """Reading a notebook is the one part of the work that no sandbox and no limit of time surrounds."""
    cell = b'{"cell_type": "markdown", "metadata": {}, "source": "x"}'
    content = b'{"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": [%b]}' % b",".join([cell] * CELLS)
    original, calls = released.notebooks[ONE], 0

    def count(frame, event, argument):
        nonlocal calls
        calls += event == "call"

    sys.setprofile(count)
    try:
        intake = restore(content, original)
    finally:
        sys.setprofile(None)
    assert "cells, at most" in intake.problems[0]
    assert calls < CELLS  # no function of Python is called for each


def test_there_are_enough_attacks():
    assert len(ATTACKS) >= 60
    assert len(ATTACKS) == sum(map(len, GROUPS.values()))


@pytest.mark.parametrize("graded, name", ATTACKS, indirect=["graded"])
def test_attack(graded, name, request):
    attack = ATTACKS[request.node.callspec.params["graded"], name]
    result, problem = graded.found[name]
    assert problem is None
    rows = {row.exercise: row for row in result.rows if row.notebook == ONE}
    wanted = attack.status if isinstance(attack.status, dict) else dict.fromkeys(EXERCISES, attack.status)
    statuses = {name: row.status for name, row in rows.items()}
    assert all(status in wanted.get(name, "graded").split("|") for name, status in statuses.items()), statuses
    outputs = graded.outputs(name)
    assert sum(row.score for row in rows.values()) == attack.points, words(outputs)
    assert graded.points[name] == attack.points
    assert attack.says in "\n".join(result.problems) + words(outputs)
    assert sum(len(json.dumps(output)) for output in outputs) < 4_000_000
    assert harmful(outputs) == []


@pytest.mark.parametrize("graded", GROUPS, indirect=True)
def test_neighbours_get_their_points(graded):
    for student, points, status in ((HONEST, points_of(), {"graded"}), (WRONG, 0.0, {"graded", "missing"})):
        result, problem = graded.found[student]
        assert problem is None and result.problems == [p for p in result.problems if "not handed in" in p]
        assert sum(row.score for row in result.rows) == points
        assert {row.status for row in result.rows} == status
        assert graded.points[student] == points


@pytest.mark.parametrize("graded", GROUPS, indirect=True)
def test_nothing_is_left_behind(graded):
    assert graded.left == []


def words(outputs):
    """All text of outputs."""
    parts = []
    for output in outputs:
        parts += [output.get("text", ""), output.get("evalue", ""), *output.get("traceback", [])]
        parts += [str(value) for value in output.get("data", {}).values()]
    return "\n".join(parts)


def harmful(outputs):
    """What could act, or be loaded from elsewhere, when outputs are shown, in words."""
    found = []
    for mime, text in [item for output in outputs for item in output.get("data", {}).items()]:
        if mime in PICTURES:
            if not re.fullmatch(r"[A-Za-z0-9+/=\s]*", text):
                found.append(f"{mime} that is no base64")
        elif mime not in (*TEXT, "text/html"):
            found.append(mime)
        elif mime in ("text/html", "text/markdown"):
            found += Acting.of(text)
        if mime in ("text/html", "text/markdown", "text/latex") and "javascript:" in html.unescape(text).lower():
            found.append(f"javascript: in {mime}")
        if mime == "text/markdown" and re.search(r"!\[[^]]*\]\(\s*(https?:)?//", text):
            found.append("a picture from elsewhere in Markdown")
    for output in outputs:
        found += [f"metadata {data}" for data in [output.get("metadata")] if data]
    return found


class Acting(html.parser.HTMLParser):
    """Collects tags and attributes that act."""

    TAGS = "script iframe frame object embed svg math style link meta base form input button img video audio source".split()

    @classmethod
    def of(cls, text):
        parser = cls()
        parser.found = []
        parser.feed(text)
        parser.close()
        return parser.found

    def handle_starttag(self, tag, attributes):
        if tag in self.TAGS:
            self.found.append(f"<{tag}>")
        for name, value in attributes:
            if (
                name.startswith("on")
                or name in ("src", "srcset", "data", "background", "action")
                or "url(" in (value or "")
            ):
                self.found.append(f"<{tag} {name}={value}>")
