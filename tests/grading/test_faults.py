"""Whatever happens while a class is graded: after the next `grade`, the gradebook is as if it had not happened."""

import os
import shutil
import signal
import sqlite3
import subprocess
import sys
import threading
from pathlib import Path

import nbformat
import pytest
from editing import solve
from support import lacking, marks, processes_in, run, scores, statuses, wait_for

from autograder.course import Course

ONE, TWO = "1_rotation", "2_homogeneous_transforms"
STUDENTS = [f"student_{number}" for number in range(6)]
pytestmark = pytest.mark.usefixtures("sandboxed")


def six_students(course, hand_in):
    """Two notebooks each, of the first two students not done."""
    for number, student in enumerate(STUDENTS):
        folder = course.release if number < 2 else course.source
        hand_in(course, student, {name: folder / f"{name}.ipynb" for name in (ONE, TWO)})
    return course


@pytest.fixture
def classroom(course, hand_in):
    return six_students(course, hand_in)


@pytest.fixture(scope="module")
def undisturbed(released, hand_in, tmp_path_factory):
    """What the gradebook of that class holds when nothing happens while it is graded."""
    other = Course(shutil.copytree(released.root, tmp_path_factory.mktemp("undisturbed") / "course"))
    assert run(six_students(other, hand_in), "grade", "--no-feedback")[0] == 0
    found = marks(other)
    assert {mark[0] for mark in found.values() if isinstance(mark, tuple)} > {0.0, 2.0}
    return found


def start(course, *arguments, **environment):
    command = [sys.executable, "-m", "autograder", "grade", *arguments]
    return subprocess.Popen(
        command,
        cwd=course.root,
        env={**os.environ, **environment},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
    )


@pytest.mark.parametrize("recorded", [0, 1, 3, 5])
def test_a_grader_that_is_killed_leaves_nothing_and_the_next_one_goes_on(classroom, undisturbed, recorded, tmp_path):
    """Killed before the first student is recorded, or in the middle of the class."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    grader = start(classroom, TMPDIR=str(temporary))

    def far_enough():
        graded = list(classroom.root.glob(f"autograded/*/transforms/{TWO}.ipynb"))
        return len(graded) >= recorded and len(processes_in(classroom.root)) > 1  # its pool has begun

    wait_for(far_enough)
    assert list(temporary.glob("grader-*"))
    grader.send_signal(signal.SIGKILL)
    grader.wait()
    wait_for(lambda: not processes_in(classroom.root))
    wait_for(lambda: not list(temporary.iterdir()))

    code, said = run(classroom, "grade", "--no-feedback")
    assert code == 0, said
    assert marks(classroom) == undisturbed


def test_a_page_of_feedback_that_was_cut_off_is_made_again(classroom):
    assert run(classroom, "grade", STUDENTS[0])[0] == 0
    page = classroom.feedback(STUDENTS[0]) / f"{ONE}.html"
    whole = page.read_bytes()
    os.chmod(page, 0o644)
    page.write_bytes(whole[: len(whole) // 2])
    assert run(classroom, "grade", STUDENTS[0])[0] == 0
    assert page.read_bytes().rstrip().endswith(b"</html>")


def test_a_database_that_is_locked_for_20_seconds(classroom, undisturbed):
    assert run(classroom, "grade", "--no-feedback", STUDENTS[0])[0] == 0
    locked = sqlite3.connect(classroom.gradebook, isolation_level=None, check_same_thread=False)
    locked.execute("BEGIN EXCLUSIVE")
    timer = threading.Timer(20, locked.execute, ["COMMIT"])
    timer.start()
    code, said = run(classroom, "grade", "--no-feedback")
    assert timer.finished.is_set()
    assert code == 0 and "5 graded, 1 unchanged" in said.replace("\n", " ")
    assert marks(classroom) == undisturbed


def test_a_full_disk_is_said_and_costs_nobody_anything(classroom, undisturbed, tmp_path):
    """On a file system of its own, too small for the graded notebooks; then there is room again."""
    script = tmp_path / "on_a_small_disk.sh"
    script.write_text(
        f"cp -r {classroom.root}/. /mnt/ && cd /mnt\n"
        f"{sys.executable} -m autograder grade --no-feedback {STUDENTS[0]} || exit 3\n"
        "dd if=/dev/zero of=/mnt/filling bs=1k 2>/dev/null\n"
        "echo FULL\n"
        f"{sys.executable} -m autograder grade --no-feedback\n"
        "echo CODE $?\n"
        f"rm /mnt/filling; cp -r /mnt/. {classroom.root}/\n"
    )
    size = sum(path.stat().st_size for path in classroom.root.rglob("*") if path.is_file())
    command = ["bwrap", "--dev-bind", "/", "/", "--size", str(2 * size + 4_000_000), "--tmpfs", "/mnt", "sh", script]
    result = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=600)
    said = result.stdout + result.stderr
    assert "Traceback" not in said, said
    assert "FULL" in said and "CODE 0" not in said, said
    assert "No space left" in said or "full" in said.partition("FULL")[2], said

    code, said = run(classroom, "grade", "--no-feedback")
    assert code == 0, said
    assert marks(classroom) == undisturbed
    assert not list(classroom.root.glob("autograded/*/transforms/.*"))


def test_a_submission_that_is_removed_while_it_is_graded(classroom, undisturbed):
    grader = start(classroom, "--no-feedback", "--jobs", "1")
    wait_for(lambda: list(classroom.root.glob(f"autograded/*/transforms/{TWO}.ipynb")))
    shutil.rmtree(classroom.root / "submitted" / STUDENTS[-1])
    assert grader.wait(120) in (0, 1)  # 1: it was gone before it was read
    code, said = run(classroom, "grade", "--no-feedback")
    assert code == 0, said
    others = {cell: mark for cell, mark in undisturbed.items() if cell[0] != STUDENTS[-1]}
    assert {cell: mark for cell, mark in marks(classroom).items() if cell[0] != STUDENTS[-1]} == others


def test_two_graders_at_once_take_turns(classroom, undisturbed):
    command = [sys.executable, "-m", "autograder", "grade", "--no-feedback"]
    graders = [
        subprocess.Popen(command, cwd=classroom.root, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True)
        for _ in range(2)
    ]
    said = [grader.communicate(timeout=300)[0].replace("\n", " ") for grader in graders]
    assert [grader.returncode for grader in graders] == [0, 0]
    first, second = sorted(said, key=lambda text: "0 graded" in text)
    assert "6 graded" in first and "0 graded, 6 unchanged" in second
    assert "Another run of this course, grading or collecting, is going on" in second
    assert marks(classroom) == undisturbed


def test_only_what_changed_is_graded_again(classroom):
    def graded(*arguments):
        code, said = run(classroom, "grade", "--no-feedback", *arguments)
        assert code == 0, said
        return int(said.partition(" graded (")[0].split()[-1]) if " graded (" in said else 0

    assert graded() == 6
    assert graded() == 0
    path = classroom.submitted(STUDENTS[2]) / f"{ONE}.ipynb"
    notebook = nbformat.read(path, as_version=4)
    notebook.cells.append(nbformat.v4.new_code_cell("1 + 1"))
    nbformat.write(notebook, path)
    assert graded() == 1
    (classroom.submitted(STUDENTS[3]) / "helper.py").write_text("x = 1")
    assert graded() == 1
    assert graded("--force") == 6
    exercise = classroom.root / "autograder/exercises/rotation.py"
    exercise.write_text(exercise.read_text().replace('"degrees-as-radians",', '"angle-not-converted",'))
    assert graded() == 6
    assert graded() == 0


def test_a_cell_that_brings_its_process_down_costs_its_own_exercise(classroom, hand_in, solved):
    """Each is skipped, and the rest of the notebook is run again without it."""
    endings = ("import os; os._exit(3)", "import ctypes; ctypes.string_at(0)", "import os; os.kill(os.getpid(), 9)")
    notebook = nbformat.read(solved[ONE], as_version=4)
    for ending in endings:
        notebook.cells.insert(2, nbformat.v4.new_code_cell(ending))
    solve(notebook, "is_rotation", "import os\ndef is_rotation(R):\n    os._exit(1)")
    hand_in(classroom, "down", {ONE: notebook})
    assert run(classroom, "grade", "--no-feedback", "down")[0] == 0
    assert statuses(classroom, "down")["is_rotation"] == "killed"
    assert {name: score for name, score in scores(classroom, "down").items() if score} == {
        "rotation_about_z": 2.0,
        "rotation_from_axes": 2.0,
        "same_rotation": 1.0,
    }
    text = (classroom.autograded("down") / f"{ONE}.ipynb").read_text()
    assert (
        text.count("the grader stopped this cell: its process ended all of a sudden") == len(endings) + 1
    )  # a call, too


def test_a_gradebook_in_postgresql(classroom, undisturbed, postgresql):
    """nbgrader's own setting, with a server that this test starts."""
    classroom.gradebook.unlink()  # made by the release
    path = classroom.root / "nbgrader_config.py"
    path.write_text(path.read_text() + f"\nc.CourseDirectory.db_url = {postgresql!r}\n")
    code, said = run(classroom, "grade", "--no-feedback")
    assert code == 0, said
    assert not classroom.gradebook.exists()
    assert marks(classroom) == undisturbed
    assert "0 graded, 6 unchanged" in run(classroom, "grade", "--no-feedback")[1].replace("\n", " ")
    assert run(classroom, "export")[1].count("\nstudent_") == len(STUDENTS)


@pytest.fixture
def postgresql(tmp_path):
    """The address of a database in a PostgreSQL server of the test's own, reached by a socket in a folder."""
    found = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb")) or lacking("needs PostgreSQL, to grade into it")
    programs, data = found[-1].parent, tmp_path / "data"
    sockets = tmp_path / "sockets"
    sockets.mkdir()
    as_user = []
    if os.getuid() == 0:  # which the server refuses to be
        for folder in (tmp_path, *tmp_path.parents):
            os.chmod(folder, os.stat(folder).st_mode | 0o011)
        shutil.chown(sockets, "postgres")
        data.mkdir()
        shutil.chown(data, "postgres")
        as_user = ["setpriv", "--reuid", "postgres", "--regid", "postgres", "--init-groups"]
    subprocess.run(
        [*as_user, programs / "initdb", "-D", data, "-U", "grader", "-A", "trust", "-N"],
        check=True,
        capture_output=True,
    )
    server = subprocess.Popen(
        [*as_user, programs / "postgres", "-D", data, "-k", sockets, "-c", "listen_addresses="],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        wait_for(lambda: list(sockets.glob(".s.PGSQL.5432")))
        subprocess.run(["createdb", "-h", sockets, "-U", "grader", "gradebook"], check=True)
        yield f"postgresql+psycopg2://grader@/gradebook?host={sockets}"
    finally:
        server.terminate()
        server.wait(60)
