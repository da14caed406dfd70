"""nbgrader's exchange, as on a JupyterHub: one folder for all, with real commands of an instructor and of two students.

The system's configuration (on a hub, /etc/jupyter/nbgrader_config.py) names the exchange for everybody; the rest is
the course's own nbgrader_config.py. On a hub nbgrader knows students by their login; here `--student` says who it is.
"""

import multiprocessing
import os
import stat
import subprocess
import sys

import nbformat
import pytest
from nbgrader.api import Gradebook
from nbgrader.apps import NbGraderApp
from support import points, run, scores

from autograder.course import ASSIGNMENT
from autograder.demo import STUDENTS, Student
from autograder.released import Released

ONE, TWO = "1_rotation", "2_homogeneous_transforms"


def command(here, environment, log, arguments):
    """Become `nbgrader …` in the folder `here`."""
    os.chdir(here)
    os.environ.clear()
    os.environ.update(environment)
    with open(log, "w") as file:
        for stream in (1, 2):
            os.dup2(file.fileno(), stream)
    sys.stdout, sys.stderr = open(1, "w", closefd=False), open(2, "w", closefd=False, buffering=1)
    NbGraderApp.launch_instance(list(arguments))


class Hub:
    """A machine with an exchange, a course, and students' homes."""

    def __init__(self, folder, course):
        self.folder, self.course, self.exchange = folder, course, folder / "exchange"
        self.exchange.mkdir()
        self.exchange.chmod(0o777)
        system = folder / "etc"
        system.mkdir()
        (system / "nbgrader_config.py").write_text(
            f'c = get_config()\nc.Exchange.root = "{self.exchange}"\nc.CourseDirectory.course_id = "transforms"\n'
        )
        self.environment = {**os.environ, "JUPYTER_CONFIG_PATH": str(system)}

    def instructor(self, *arguments):
        """Run an nbgrader command in the course; what it said."""
        return self._nbgrader(self.course.root, self.folder / "instructor", *arguments)

    def student(self, name, *arguments):
        """Run an nbgrader command in a student's home folder; what it said."""
        return self._nbgrader(self.home(name), self.home(name), *arguments, f"--student={name}")

    def home(self, name):
        return self.folder / "home" / name

    def _nbgrader(self, here, home, *arguments):
        """In a copy of this process, which has loaded nbgrader already: that takes longer than most commands."""
        for folder in (here, home):
            folder.mkdir(parents=True, exist_ok=True)
        log = self.folder / "log.txt"
        process = multiprocessing.get_context("fork").Process(
            target=command, args=(here, {**self.environment, "HOME": str(home)}, log, arguments)
        )
        process.start()
        process.join(300)
        assert process.exitcode == 0, log.read_text()
        return log.read_text()

    def solve(self, name, person, *notebooks):
        """The student fills in notebooks in their own folder, as a person of the demo's class would."""
        for notebook in notebooks:
            path = self.home(name) / ASSIGNMENT / f"{notebook}.ipynb"
            path.write_text(Student(STUDENTS / f"{person}.py").hand_in(Released(notebook, path.read_text())))

    def pages(self, name):
        """{path relative to the feedback folder: text} of the feedback that a student fetched."""
        folder = self.home(name) / ASSIGNMENT / "feedback"
        return {path.relative_to(folder).as_posix(): path.read_text() for path in folder.rglob("*") if path.is_file()}


@pytest.fixture
def hub(course, tmp_path, slow):
    hub = Hub(tmp_path, course)
    hub.instructor("release_assignment", ASSIGNMENT)
    return hub


def timestamps(course):
    with Gradebook(f"sqlite:///{course.gradebook}") as gradebook:
        return {found.student_id: found.timestamp for found in gradebook.assignment_submissions(ASSIGNMENT)}


def test_from_release_to_feedback_and_once_more(hub, sandboxed):
    course = hub.course
    out = hub.exchange / "transforms" / "outbound" / ASSIGNMENT
    handed_out = {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*") if path.is_file()}
    assert handed_out == course.release_contents()
    assert all(path.stat().st_mode & stat.S_IROTH for path in out.rglob("*"))
    assert stat.S_IMODE((hub.exchange / "transforms" / "inbound").stat().st_mode) & 0o777 == 0o733  # nobody looks in

    assert f"transforms {ASSIGNMENT}" in hub.student("alice", "list")
    for name in ("alice", "bob"):
        hub.student(name, "fetch_assignment", ASSIGNMENT)
    fetched = hub.home("alice") / ASSIGNMENT
    assert (fetched / "transform_lab" / "key.json").is_file()
    assert sorted(path.stem for path in fetched.glob("*.ipynb")) == list(course.notebooks)

    # Notebooks that were fetched run, and `check` answers in them.
    hub.solve("alice", "ada", *course.notebooks)
    executed = subprocess.run(
        [sys.executable, "-m", "nbconvert", "--execute", "--to", "notebook", "--stdout", f"{ONE}.ipynb"],
        cwd=fetched, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=300,
    )  # fmt: skip
    assert "rotation_about_z: all right." in executed.stdout, executed.stderr

    hub.solve("bob", "ada", ONE)
    for name in ("alice", "bob"):
        hub.student(name, "submit", ASSIGNMENT)
    assert "no feedback available" in hub.student("alice", "list", "--cached")

    hub.instructor("collect", ASSIGNMENT)
    assert course.students() == ["alice", "bob"]
    code, said = run(course, "grade")
    assert code == 0 and "2 graded" in said, said
    assert sum(scores(course, "alice").values()) == points() and sum(scores(course, "bob").values()) == points(
        "1_rotation"
    )
    handed_in = timestamps(course)
    assert all(handed_in.values())

    hub.instructor("release_feedback", ASSIGNMENT)
    assert "feedback ready to be fetched" in hub.student("alice", "list", "--inbound")
    hub.student("alice", "fetch_feedback", ASSIGNMENT)
    hub.student("bob", "fetch_feedback", ASSIGNMENT)
    assert sorted(path.split("/")[1] for path in hub.pages("alice")) == [f"{name}.html" for name in course.notebooks]
    mine, theirs = (
        next(page for path, page in hub.pages(name).items() if path.endswith(f"{TWO}.html"))
        for name in ("alice", "bob")
    )
    assert "transform_to_pose: all right." in mine and "4 of 4 points" in mine
    assert "transform_to_pose: not done yet." in theirs and "0 of 4 points" in theirs

    # Bob goes on, and only he is graded again.
    hub.solve("bob", "ada", TWO)
    hub.student("bob", "submit", ASSIGNMENT)
    hub.instructor("collect", ASSIGNMENT, "--update")
    code, said = run(course, "grade")
    assert code == 0 and "1 graded" in said and "1 unchanged" in said, said
    assert sum(scores(course, "alice").values()) == points() and sum(scores(course, "bob").values()) > points(
        "1_rotation"
    )
    later = timestamps(course)
    assert later["alice"] == handed_in["alice"] and later["bob"] > handed_in["bob"]
    hub.instructor("release_feedback", ASSIGNMENT)
    hub.student("bob", "fetch_feedback", ASSIGNMENT)
    first, second = sorted({path.split("/")[0] for path in hub.pages("bob")})
    assert "transform_to_pose: not done yet." in hub.pages("bob")[f"{first}/{TWO}.html"]
    assert "transform_to_pose: all right." in hub.pages("bob")[f"{second}/{TWO}.html"]

    solutions = {
        cell.source
        for path in course.source.glob("*.ipynb")
        for cell in nbformat.read(path, as_version=4).cells
        if cell.metadata.get("nbgrader", {}).get("solution")
    }
    for path in out.rglob("*.ipynb"):
        given = {cell.source for cell in nbformat.read(path, as_version=4).cells}
        assert not given & solutions, path


def test_links_in_the_exchange_bring_nothing_of_the_instructors_and_stop_nobody(hub, solved):
    course, sent = hub.course, "2026-11-20 10:00:00.000000 UTC"
    inbound = hub.exchange / "transforms" / "inbound"
    for name in ("alice", "mallory", "zoe"):
        folder = inbound / f"{name}+{ASSIGNMENT}+{sent}+random"
        folder.mkdir()
        (folder / f"{ONE}.ipynb").write_bytes(solved[ONE].read_bytes())
        (folder / "timestamp.txt").write_text(sent)
    mine = inbound / f"mallory+{ASSIGNMENT}+{sent}+random"
    (mine / "helpers").mkdir()
    (mine / "helpers" / "notes.txt").write_text("mine")
    (mine / "helpers" / "solutions.ipynb").symlink_to(solved[TWO])
    (mine / "gradebook.db").symlink_to(course.gradebook)
    (mine / "course").symlink_to(course.root)
    os.mkfifo(mine / "pipe")
    said = hub.instructor("collect", ASSIGNMENT)
    assert "solutions.ipynb: left out; it is a link." in said and "pipe: left out; it is no regular file." in said
    assert course.students() == ["alice", "mallory", "zoe"]
    taken = course.submitted("mallory")
    assert {path.relative_to(taken).as_posix() for path in taken.rglob("*") if path.is_file()} == {
        f"{ONE}.ipynb", "timestamp.txt", "helpers/notes.txt",
    }  # fmt: skip
    assert not [path for path in taken.rglob("*") if path.is_symlink()]


def test_who_did_not_submit_through_the_exchange_does_not_keep_others_from_their_feedback(hub):
    sent, files = (
        "2026-11-20 10:00:00.000000 UTC",
        {"alice": b"a" * 128, "by [hand]": None, "mallory": b"", "zoe": b"\xff"},
    )
    for name, secret in files.items():
        folder = hub.course.feedback(name)
        folder.mkdir(parents=True)
        (folder / f"{ONE}.html").write_text(name)
        if secret is not None:
            (folder / "timestamp.txt").write_text(sent)
            (folder / "submission_secret.txt").write_bytes(secret)
    said = hub.instructor("release_feedback", ASSIGNMENT)
    assert said.count("not released; the submission did not come through the exchange.") == 3
    pages = list((hub.exchange / "transforms" / "feedback").iterdir())
    assert [page.read_text() for page in pages] == ["alice"]
