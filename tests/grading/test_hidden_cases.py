"""Hidden cases stay hidden: what a function is asked with is on no page, whatever it does, and its order tells nothing."""

import json
import re

import nbformat
import numpy as np
import pytest
from editing import solve
from hypothesis import given
from hypothesis import strategies as st
from support import ASKED, points, run, scores
from transform_lab.judging import codec

from autograder.exercises import EXERCISES, PUBLIC_SEED, key
from autograder.grading.grade import grade_submission, grading_run
from autograder.grading.telling import KNOWN, Telling
from autograder.intake.submission import Submission

ONE, SEED = "1_rotation", 1234
NUMBER = re.compile(r"told(-?\d+\.\d{6})e")  # what each function below makes of an argument's first number

TOLD = "seen = []\ndef told(R):\n    return f'told{R[0, 0] + 0.1 * R[0, 1] + 0.01 * R[1, 2]:.6f}e'\n"
# {way: (what is_rotation does with its argument, what a cell behind all checks does)}
WAYS = {
    "a list": ("seen.append(told(R)); return False", "seen"),
    "a file": ("open('kept', 'a').write(told(R)); return False", "open('kept').read()"),
    "a file elsewhere": (
        "open('/tmp/kept', 'a').write(told(R)); return False",
        "import os; open('/tmp/kept').read() if os.path.exists('/tmp/kept') else ''",
    ),
    "a folder's name": ("import os; os.makedirs('/tmp/' + told(R), exist_ok=True)", "import os; os.listdir('/tmp')"),
    "the environment": ("import os; os.environ[told(R)] = '1'", "import os; sorted(os.environ)"),
    "a module": ("np.kept = getattr(np, 'kept', []) + [told(R)]", "getattr(np, 'kept', [])"),
    "an error": ("raise ValueError(told(R))", ""),
    "an error of another name": ("raise type(told(R).replace('.', '_').replace('-', 'm'), (Exception,), {})", ""),
    "an answer of another type": ("return type(told(R), (), {})()", ""),
    "the shape of an answer": ("return np.zeros((int(abs(R[0, 0]) * 999), 3))", ""),
    "print": ("print(told(R)); return False", ""),
    "standard output": ("import os; os.write(1, told(R).encode()); return False", "import os; os.write(1, b'.')"),
    "display": ("display(told(R)); return False", ""),
    "a warning": ("import warnings; warnings.warn(told(R)); return False", ""),
    "the checks' own answer": ("seen.append(told(R)); return seen[0]", ""),
    "a thread": (
        "import threading; threading.Timer(0.05, lambda: open('/tmp/late', 'a').write(told(R))).start(); return False",
        "import time; time.sleep(0.3); import os; open('/tmp/late').read() if os.path.exists('/tmp/late') else ''",
    ),
    "beside a thread": (
        "seen.append(told(R)); return False",
        "import threading, time\n"
        "def fill():\n"
        "    threading.Thread(target=time.sleep, args=(600,), daemon=True).start()\n"
        "seen",
    ),
    "no process left": (
        "seen.append(told(R)); return False",
        "import os\n"
        "def fill():\n"
        "    while True:\n"
        "        try:\n"
        "            if os.fork() == 0:\n"
        "                import time; time.sleep(600)\n"
        "        except OSError:\n"
        "            break\n"
        "seen",
    ),
    "copies that are ended": ("seen.append(told(R)); return False", "import os; os.kill(-1, 9); seen"),
}


def hand_in_all(course, hand_in):
    for number, (body, after) in enumerate(WAYS.values()):
        notebook = nbformat.read(course.source / f"{ONE}.ipynb", as_version=4)
        for position, cell in enumerate(notebook.cells):
            if cell.metadata.get("nbgrader", {}).get("grade_id") == "is_rotation-solution":
                cell.source = f"{TOLD}def is_rotation(R):\n    {body}\n"
                if "fill" in after:
                    notebook.cells.insert(position + 1, nbformat.v4.new_code_cell(after + "\nfill()"))
                break
        notebook.cells += [nbformat.v4.new_code_cell(after), nbformat.v4.new_code_cell("seen")]
        hand_in(course, f"way_{number}", {ONE: notebook})


def numbers(seed):
    """What the functions above make of the cases of a seed."""
    cases = (codec.decode(case["args"][0]) for case in key(EXERCISES["is_rotation"], seed)["cases"])
    return {f"{R[0, 0] + 0.1 * R[0, 1] + 0.01 * R[1, 2]:.6f}" for R in cases if np.shape(R) == (3, 3)}


def test_what_a_function_is_asked_with_is_on_no_page(course, hand_in, sandboxed):
    hand_in_all(course, hand_in)
    code, said = run(course, "grade", "--seed", str(SEED))
    assert code == 0, said
    hidden, public = numbers(SEED), numbers(PUBLIC_SEED)
    assert len(hidden - public) > 10
    files = [path for part in ("autograded", "feedback", "reports") for path in (course.root / part).rglob("*.*")]
    texts = {path: path.read_text(encoding="utf-8", errors="replace") for path in files if path.is_file()} | {"": said}
    assert len(texts) > 3 * len(WAYS)
    shown = {
        (list(WAYS)[int(found[1])], number)
        for path, text in texts.items()
        for number in NUMBER.findall(text)
        if number in hidden - public and (found := re.search(r"way_(\d+)", str(path)))
    }
    assert not shown
    others = points(ONE) - ASKED[ONE].points["is_rotation"]
    for number, way in enumerate(WAYS):
        found = scores(course, f"way_{number}")
        assert sum(found.values()) - found["is_rotation"] == others, way


def test_what_a_public_case_shows_as_well_is_said(course, hand_in, sandboxed):
    """An error has its own words where they tell no hidden number."""
    notebook = nbformat.read(course.source / f"{ONE}.ipynb", as_version=4)
    bodies = {
        "is_rotation": "def is_rotation(R):\n    raise ValueError('not today')",
        "same_rotation": "def same_rotation(q1, q2):\n    raise ValueError(repr(q1 * np.random.random()))",
        "rotation_about_z": "def rotation_about_z(degrees):\n    return nowhere * degrees",
    }
    for exercise, source in bodies.items():
        solve(notebook, exercise, source)
    hand_in(course, "ann", {ONE: notebook})
    assert run(course, "grade", "--no-feedback")[0] == 0
    text = (course.autograded("ann") / f"{ONE}.ipynb").read_text()
    assert "ValueError: not today, in your line 2: `raise ValueError('not today')`" in text
    assert "raised an error: ValueError, in your line 2: `raise ValueError(repr(q1 * np.random.random()))`" in text
    assert "NameError: name 'nowhere' is not defined" in text


def test_a_function_whose_threads_run_is_judged_beside_them(course, hand_in, sandboxed):
    """A copy of its process would have none, and wait for them for ever. JAX, for one, has threads once it is used."""
    notebook = nbformat.read(course.source / f"{ONE}.ipynb", as_version=4)
    solve(
        notebook,
        "is_rotation",
        "from concurrent.futures import ThreadPoolExecutor\npool = ThreadPoolExecutor(1)\n"
        "def right(R):\n    return np.allclose(R.T @ R, np.eye(3), rtol=0, atol=1e-6) and np.linalg.det(R) > 0\n"
        "def is_rotation(R):\n    return pool.submit(right, R).result()\nis_rotation(np.eye(3))",
    )
    notebook.cells.append(nbformat.v4.new_code_cell("is_rotation = None"))  # what stood at its test cell counts
    hand_in(course, "ann", {ONE: notebook})
    assert run(course, "grade", "--no-feedback")[0] == 0
    assert sum(scores(course, "ann").values()) == points(ONE)


@pytest.mark.parametrize("name", EXERCISES)
def test_hidden_cases_come_in_an_order_of_their_own(name, slow):
    exercise = EXERCISES[name]
    public = [case["family"] for case in key(exercise, PUBLIC_SEED)["cases"]]
    orders = {tuple(case["family"] for case in key(exercise, seed)["cases"]) for seed in range(4)}
    assert list(key(exercise, PUBLIC_SEED)["weights"]) == list(dict.fromkeys(public)), "as the specification has them"
    if len(set(public)) > 1:
        assert len(orders) == 4 and tuple(public) not in orders
        truth = {json.dumps([case["expected"] for case in key(exercise, seed)["cases"]]) for seed in range(4)}
        assert len(truth) == 4
    assert key(exercise, 3) == key(exercise, 3)


def test_answers_by_position_earn_next_to_nothing(course, hand_in, sandboxed):
    """Of all points, those of the one exercise whose answer is no secret, and at most one more."""
    handed_in = {}
    for name in course.notebooks:
        handed_in[name] = notebook = nbformat.read(course.source / f"{name}.ipynb", as_version=4)
        for cell in notebook.cells:
            exercise = cell.metadata.get("nbgrader", {}).get("grade_id", "").removesuffix("-solution")
            if exercise in EXERCISES and "-solution" in cell.metadata["nbgrader"]["grade_id"]:
                answers = [case["expected"] for case in key(EXERCISES[exercise], PUBLIC_SEED)["cases"]]
                cell.source = (
                    f"{cell.source}\nimport json\nfrom transform_lab.judging import codec\n"
                    f"_answers_{exercise} = [codec.decode(a) for a in json.loads({json.dumps(json.dumps(answers))})]\n"
                    f"_{exercise} = iter(_answers_{exercise} * 9)\n"
                    f"def {exercise}(*args, **kwargs):\n    return next(_{exercise})\n"
                )
    hand_in(course, "eve", handed_in)
    assert run(course, "grade", "--no-feedback", "--seed", "7")[0] == 0
    found = scores(course, "eve")
    assert len(found) == len(EXERCISES)
    assert sum(found.values()) <= 3 and found["hand_transform"] == 2, found


@given(st.text() | st.from_regex(r"\A(an array of shape|<\w+> instead of|ValueError: |told_1)[^\n]*\Z"))
def test_whatever_is_wrong_with_a_reply_something_is_said_or_nothing(text):
    """Of words that no public case has: at most an error's usual name, and the student's own line."""
    assert Telling((), "x = 1")(text) in ("", *KNOWN)


def test_what_only_a_hidden_case_shows_costs_no_other_exercise(course, hand_in, sandboxed):
    """A shape that depends on the argument is said without its numbers."""
    notebook = nbformat.read(course.source / f"{ONE}.ipynb", as_version=4)
    shaped = (
        "from scipy.spatial.transform import Rotation\ndef rotation_about_z(degrees):\n"
        "    if round(degrees, 3) != degrees:\n        return np.zeros((4 + int(1e6 * abs(degrees)) % 900, 1))\n"
        "    return Rotation.from_euler('z', degrees, degrees=True).as_matrix()"
    )
    solve(notebook, "rotation_about_z", shaped)
    hand_in(course, "ann", {ONE: notebook})
    assert run(course, "grade", "--no-feedback")[0] == 0
    found = scores(course, "ann")
    assert sum(found.values()) - found["rotation_about_z"] == points(ONE) - ASKED[ONE].points["rotation_about_z"]
    assert "wrong shape" in (course.autograded("ann") / f"{ONE}.ipynb").read_text()


def test_another_run_costs_time_and_the_first_does_not(course, sandboxed, monkeypatch):
    monkeypatch.setattr("autograder.grading.judge.RESTART", 1e6)
    two = "2_homogeneous_transforms"
    files = {f"{name}.ipynb": (course.source / f"{name}.ipynb").read_bytes() for name in (ONE, two)}
    against = grading_run(course, 1, notebooks=[ONE, two])
    rows = grade_submission(Submission("ann", files), against).rows
    assert {row.status for row in rows if row.notebook in (ONE, two)} == {"graded"}
    broken = nbformat.reads(files[f"{ONE}.ipynb"].decode(), as_version=4)
    broken.cells.insert(1, nbformat.v4.new_code_cell("import os\nos._exit(1)"))
    files[f"{ONE}.ipynb"] = nbformat.writes(broken).encode()
    rows = grade_submission(Submission("ann", files), against).rows
    assert "timeout" in {row.status for row in rows if row.notebook == two}
