"""The command line as an instructor uses it: what it says, what it writes, and what it does with bad input."""

import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import nbformat
import pytest
from support import ASKED, ROOT, path_without, points, points_by_hand, run, scores, statuses, verdicts

from autograder import doctor
from autograder.bridge.gradebook import Writer
from autograder.bridge.nbgrader_api import exchange
from autograder.course import Course
from autograder.exercises import EXERCISES


@pytest.fixture
def without_bubblewrap():
    """A PATH on which there is no bwrap."""
    return path_without("bwrap")


# --- what is asked for ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("asked", ["--help", "grade --help", "check --help", "no-such-command", "grade --jobs none"])
def test_nothing_is_loaded_to_read_a_command_line(asked):
    (said, loaded), (_, always) = loaded_by("-m", "autograder", *asked.split()), loaded_by("-c", "pass")
    assert "usage:" in said
    assert "autograder.command_line" in loaded and "autograder.commands" not in loaded
    assert not {"subprocess", "hashlib", "importlib.metadata", "dataclasses"} & (loaded - always)
    packages = {name.partition(".")[0] for name in loaded - always} - {"autograder"} - sys.stdlib_module_names
    assert not {name for name in packages if not name.startswith(("_", "imported"))}


def loaded_by(*arguments):
    """(what a Python of these arguments says, the names of the modules that it loads, those of this machine's own among them)"""
    command = [sys.executable, "-X", "importtime", *arguments]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    lines = [line for line in done.stderr.splitlines() if line.startswith("import time:")]
    return done.stdout + done.stderr, {line.rpartition("|")[2].strip() for line in lines}


# --- grade ----------------------------------------------------------------------------------------------------------


def test_grading_a_small_class(course, hand_in, solved, sandboxed):
    hand_in(course, "alice", solved)
    hand_in(course, "bob", {name: course.release / f"{name}.ipynb" for name in list(course.notebooks)[:2]})
    hand_in(course, "carol", {**solved, "3_chaining": b"{ this is no notebook"})
    code, said = run(course, "grade", "--no-feedback")
    assert code == 0, said
    assert "bob: 5_pre_grasp.ipynb: not handed in" in said
    assert "carol: 3_chaining.ipynb: it cannot be read" in said

    rows = verdicts(course)
    assert list(rows[0]) == ["student", "notebook", "exercise", "score", "max_score", "status", "misconception"]
    assert [row["exercise"] for row in rows if row["student"] == "alice"] == list(EXERCISES)
    assert all(row["score"] == row["max_score"] for row in rows if row["student"] == "alice")
    assert set(scores(course, "bob").values()) == {0.0}
    assert statuses(course, "bob")["rotation_about_z"] == "error"
    assert statuses(course, "bob")["pre_grasp"] == "missing"
    assert statuses(course, "carol")["chain"] == "unreadable"
    assert sum(scores(course, "carol").values()) == points() - points("3_chaining")
    page = (course.reports / "index.html").read_text()
    assert "carol" in page and "3_chaining.ipynb: it cannot be read" in page

    code, said = run(course, "grade", "--no-feedback")
    assert code == 0 and "0 graded" in said and "3 unchanged" in said
    (course.submitted("bob") / "1_rotation.ipynb").write_bytes(solved["1_rotation"].read_bytes())
    code, said = run(course, "grade", "--no-feedback")
    assert "1 graded" in said and "2 unchanged" in said
    assert sum(scores(course, "bob").values()) == points("1_rotation")
    assert sum(scores(course, "alice").values()) == points()

    code, said = run(course, "export")
    most = points() + points_by_hand()
    assert f"alice,{points()},{most},yes" in said and f"bob,{points('1_rotation')},{most}," in said


def test_feedback_is_written_for_each_student(course, hand_in, solved, sandboxed):
    hand_in(course, "alice", {"5_pre_grasp": solved["5_pre_grasp"]})
    code, said = run(course, "grade")
    assert code == 0, said
    pages = [path.name for path in course.feedback("alice").glob("[0-9]*.html")]
    assert pages == ["5_pre_grasp.html"]
    text = (course.feedback("alice") / "5_pre_grasp.html").read_text()
    assert "pre_grasp: all right." in text and "3 of 3 points" in text


def test_an_unknown_student_is_said_and_the_others_are_graded(course, hand_in, solved, sandboxed):
    hand_in(course, "alice", {"1_rotation": solved["1_rotation"]})
    code, said = run(course, "grade", "alise", "alice", "--no-feedback")
    assert code == 1
    assert "alise: no submission in submitted/alise/transforms. Did you mean alice?" in said
    assert scores(course, "alice")["is_rotation"] == 2


def test_a_notebook_of_another_name_is_said(course, hand_in, solved, sandboxed):
    hand_in(course, "alice", {"1_rotation-Copy1": solved["1_rotation"]})
    code, said = run(course, "grade", "--no-feedback")
    assert code == 0
    assert "alice: 1_rotation-Copy1.ipynb: it was taken for 1_rotation.ipynb; that is what it should be called." in said
    assert sum(scores(course, "alice").values()) == points("1_rotation")


ENDINGS = [
    ("loop", "while True: pass", ("timeout", "")),
    ("exits", "import os; os._exit(0)", ("killed", "")),
    ("raises", "return undefined", ("error", "")),
    ("prints", "print(degrees)", ("graded", "returned-none")),
]


@pytest.fixture(scope="module")
def ended(released, hand_in, sandboxed, tmp_path_factory):
    """A graded class of those whose answers end so; not to be changed by tests."""
    course = Course(shutil.copytree(released.root, tmp_path_factory.mktemp("ended") / "course"))
    for student, body, _ in ENDINGS:
        notebook = nbformat.read(course.source / "1_rotation.ipynb", as_version=4)
        (cell,) = (
            c for c in notebook.cells if c.metadata.get("nbgrader", {}).get("grade_id") == "rotation_about_z-solution"
        )
        cell.source = f"def rotation_about_z(degrees):\n    {body}"
        hand_in(course, student, {"1_rotation": notebook})
    code, said = run(course, "grade", "--no-feedback")
    assert code == 0, said
    return course


@pytest.mark.parametrize("student, body, verdict", ENDINGS)
def test_an_answer_that_does_not_end_well_costs_itself_alone(ended, student, body, verdict):
    course = ended
    row = next(row for row in verdicts(course) if (row["student"], row["exercise"]) == (student, "rotation_about_z"))
    assert (row["status"], row["misconception"]) == verdict
    assert scores(course, student)["rotation_about_z"] == 0
    assert (
        sum(scores(course, student).values()) == points("1_rotation") - ASKED["1_rotation"].points["rotation_about_z"]
    )
    graded = nbformat.read(course.autograded(student) / "1_rotation.ipynb", as_version=4)
    for cell in graded.cells:
        stopped = "Stopped" in [output.get("ename") for output in cell.get("outputs", ())]
        assert not stopped or "rotation_about_z(" in cell.source, "an innocent cell was left out"


def test_no_submitted_folder(course):
    code, said = run(course, "grade")
    assert code == 2
    assert "There is no submitted/ folder" in said and "submitted/STUDENT/transforms/" in said


@pytest.mark.parametrize("gradebook", [True, False])
def test_an_assignment_that_was_never_released(course, hand_in, solved, sandboxed, gradebook):
    hand_in(course, "alice", solved)
    shutil.rmtree(course.release)
    if not gradebook:
        course.gradebook.unlink()
    code, said = run(course, "grade")
    assert code == 2
    assert "never released" in said and "python3 -m autograder release" in said
    assert course.gradebook.exists() is gradebook


def test_a_gradebook_that_is_gone_is_made_from_the_released_notebooks(course, hand_in, solved, sandboxed):
    hand_in(course, "alice", {"1_rotation": solved["1_rotation"]})
    made_by_nbgrader = assignment_in(course)
    assert len(made_by_nbgrader) > 35
    course.gradebook.unlink()
    code, said = run(course, "grade", "--no-feedback")
    assert code == 0, said
    assert assignment_in(course) == made_by_nbgrader
    assert f"alice,{points('1_rotation')},{points() + points_by_hand()}" in run(course, "export")[1]


def assignment_in(course):
    """All that the gradebook knows of the assignment's cells, but for its own keys."""
    with Writer(course) as writer:
        notebooks = writer.gradebook.find_assignment("transforms").notebooks
        cells = [cell.to_dict() for notebook in notebooks for cell in (*notebook._base_cells, *notebook.source_cells)]
    return sorted((sorted((k, str(v)) for k, v in cell.items() if k != "id") for cell in cells), key=str)


def test_outside_a_course(course, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    shutil.copytree(course.root / "autograder", elsewhere / "autograder")
    shutil.copy(course.root / "environment.txt", elsewhere)
    environment = {**os.environ, "PYTHONPATH": str(course.package.parent)}
    result = subprocess.run(
        [sys.executable, "-m", "autograder", "grade"], cwd=elsewhere, env=environment, capture_output=True, text=True
    )
    assert result.returncode == 2
    assert "is no course folder" in result.stderr and "nbgrader_config.py" in result.stderr


def test_without_bubblewrap_nothing_is_graded_unless_asked_for(course, hand_in, solved, without_bubblewrap, slow):
    hand_in(course, "alice", {"1_rotation": solved["1_rotation"]})
    code, said = run(course, "grade", "--no-feedback", path=without_bubblewrap)
    assert code == 2
    assert "apt-get install bubblewrap" in said and "--unsafe-no-sandbox" in said
    assert not course.autograded("alice").exists()
    code, said = run(course, "grade", "--no-feedback", "--unsafe-no-sandbox", path=without_bubblewrap)
    assert code == 0, said
    assert "NOT PROTECTED" in said and "gradebook" in said
    assert scores(course, "alice")["is_rotation"] == 2


# --- check, demo, and the rest --------------------------------------------------------------------------------------


def test_check_needs_no_gradebook(course, solved, sandboxed):
    course.gradebook.unlink()
    code, said = run(course, "check", *map(str, solved.values()))
    assert code == 0 and f"{points():g} of {points():g} points" in said
    code, said = run(course, "check", str(course.release / "1_rotation.ipynb"))
    assert code == 1 and f"0 of {points('1_rotation'):g} points" in said and "Not done yet." in said


def test_check_says_what_is_wrong_with_files(course, sandboxed):
    odd = course.root / "homework.ipynb"
    odd.write_text("{}")
    code, said = run(course, "check", str(odd), "nowhere/1_rotation.ipynb")
    assert code == 1
    assert "homework.ipynb: not graded; no notebook of this assignment has that name" in said
    assert "nowhere/1_rotation.ipynb: there is no such file" in said
    broken = course.root / "1_rotation.ipynb"
    broken.write_text("{")
    code, said = run(course, "check", str(broken))
    assert code == 1 and "cannot be read" in said and f"0 of {points('1_rotation'):g} points" in said


def test_the_demo(course, sandboxed):
    code, said = run(course, "demo")
    assert code == 0, said
    rows = verdicts(course)
    students = {row["student"] for row in rows}
    assert len(students) >= 12
    assert {row["exercise"] for row in rows} == set(EXERCISES)
    assert len(rows) == len(students) * len(EXERCISES)
    assert {"graded", "missing", "error", "timeout", "unreadable"} <= {row["status"] for row in rows}
    assert "base-frame-offset" in {row["misconception"] for row in rows}
    for student in students:
        assert list(course.feedback(student).glob("*.html")), student
        assert student in said
    for place in ("reports/transforms/index.html", "reports/transforms/verdicts.csv", "feedback", "gradebook.db"):
        assert place in said
    code, said = run(course, "report")
    assert code == 0 and verdicts(course) == rows
    code, said = run(course, "demo", "--remove")
    assert code == 0
    assert list((course.root / "submitted").iterdir()) == []
    assert "demo_" not in run(course, "export")[1]


def test_the_demo_runs_without_bubblewrap_and_says_so(course, without_bubblewrap, slow):
    code, said = run(course, "demo", path=without_bubblewrap)
    assert code == 0, said
    assert "runs its own submissions without a sandbox" in said
    assert len({row["student"] for row in verdicts(course)}) >= 12


def test_the_demo_leaves_a_real_class_alone(course, hand_in, solved):
    hand_in(course, "alice", solved)
    code, said = run(course, "demo")
    assert code == 2 and "real submissions (alice" in said
    assert [path.name for path in (course.root / "submitted").iterdir()] == ["alice"]


def test_doctor(course, sandboxed, without_bubblewrap):
    code, said = run(course, "doctor")
    assert "ok    bubblewrap works" in said
    code, said = run(course, "doctor", path=without_bubblewrap)
    assert code == 1 and "LOOK  No sandbox" in said


def test_a_folder_that_is_called_as_no_student_is_refused_and_the_others_are_graded(course, hand_in, sandboxed):
    for name in ("=cmd", "-rf", "a\nb", "ann"):
        hand_in(course, name, {})
    code, said = run(course, "grade", "--no-feedback")
    assert code == 1 and "1 graded" in said
    for name, why in (("=cmd", "begins with no -"), ("-rf", "begins with no -"), (r"'a\nb'", "has no line ends")):
        (line,) = [
            line for line in said.splitlines() if line.startswith(f"{name}: not graded: its folder in submitted/")
        ]
        assert why in line
    assert {row["student"] for row in verdicts(course)} == {"ann"}


@pytest.fixture
def small(monkeypatch):
    """A course with a gradebook and a submission, in a folder that others may pass through; there is no exchange."""
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o711)
        root = Path(folder, "course")
        for inside in ("source/transforms", "submitted", "exchange/transforms/inbound"):
            (root / inside).mkdir(parents=True)
        (root / "gradebook.db").write_text("")
        monkeypatch.setattr(doctor.sandbox, "problem", lambda: "none here")
        monkeypatch.setattr(doctor, "exchange", lambda _: (root / "nowhere", "transforms"))
        yield Course(root)


def of_files(course):
    """The lines of `doctor` about files, {line: whether that is as it should be}."""
    return {line: good for good, line in doctor.examine(course) if "sandbox" not in line and "Python" not in line}


@pytest.mark.parametrize(
    "folder, gradebook, others",
    [
        (0o755, 0o644, "source, submitted, gradebook.db"),
        (0o711, 0o644, "source, submitted, gradebook.db"),
        (0o755, 0o640, "source, submitted"),
        (0o755, 0o602, "source, submitted, gradebook.db"),
        (0o750, 0o644, ""),
        (0o700, 0o666, ""),
    ],
)
def test_doctor_says_what_others_can_read_and_how_to_mend_it(small, folder, gradebook, others):
    small.root.chmod(folder)
    small.gradebook.chmod(gradebook)
    if os.getuid() == 0:  # others can, indeed
        reads = subprocess.run(["cat", small.gradebook], user=65534, group=65534, extra_groups=[], capture_output=True)
        assert (reads.returncode == 0) is (bool(others) and bool(gradebook & 0o004))
    ((line, good),) = of_files(small).items()
    assert good is not bool(others)
    if others:
        assert f"can read or change {others}: `chmod o-rwx {small.root}` keeps them out." in line
        subprocess.run(shlex.split(line.split("`")[1]), check=True)
        assert all(of_files(small).values())


def test_doctor_looks_at_what_lies_elsewhere(small):
    """A course that is closed, of which a folder lies in another one."""
    elsewhere = small.root.parent / "elsewhere"
    elsewhere.mkdir()
    (small.root / "submitted").rmdir()
    (small.root / "submitted").symlink_to(elsewhere)
    small.root.chmod(0o700)
    ((line, _),) = of_files(small).items()
    assert f"can read or change submitted: `chmod o-rwx {elsewhere}` keeps them out." in line


def test_doctor_looks_at_the_exchange(small, monkeypatch):
    small.root.chmod(0o700)
    folders = [small.root / "exchange", small.root / "exchange" / "transforms" / "inbound"]
    for folder in folders:
        folder.chmod(0o733)
    monkeypatch.setattr(doctor, "exchange", lambda _: (folders[0], "transforms"))
    loose = [line for line, good in of_files(small).items() if not good]
    assert all("students can remove each other's work" in line for line in loose)
    for line in loose:
        subprocess.run(shlex.split(line.split("`")[1]), check=True)
    assert [folder.stat().st_mode & 0o7777 for folder in folders] == [0o1733] * 2
    assert all(of_files(small).values())


def test_the_exchange_is_that_of_nbgraders_configuration(course, tmp_path, monkeypatch):
    (tmp_path / "nbgrader_config.py").write_text(f'c = get_config()\nc.Exchange.root = "{tmp_path}/shared"\n')
    monkeypatch.setenv("JUPYTER_CONFIG_PATH", str(tmp_path))
    assert exchange(course) == (tmp_path / "shared", "transforms")


def test_release_says_what_changed(course, slow):
    path = course.source / "3_chaining.ipynb"
    raw = json.loads(path.read_text())
    raw["cells"][0]["source"] = ["# Another title"]
    path.write_text(json.dumps(raw))
    code, said = run(course, "release")
    assert code == 0 and "changed: 3_chaining.ipynb" in said
    code, said = run(course, "release")
    assert code == 0 and "notebooks/transforms is up to date." in said


def test_help_names_every_command_of_the_readme(course):
    code, said = run(course, "--help")
    assert code == 0
    for command in (
        "demo",
        "lab",
        "release",
        "grade",
        "report",
        "check",
        "collect",
        "doctor",
        "hub",
        "package",
        "export",
        "test",
    ):
        assert f"    {command} " in said
    assert Path(course.root, "README.md").exists()
