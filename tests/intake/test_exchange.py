"""nbgrader's exchange, as on a JupyterHub: one folder for all, with real commands of an instructor and of two students.

The system's configuration (on a hub, /etc/jupyter/nbgrader_config.py) names the exchange for everybody; the rest is
the course's own nbgrader_config.py. On a hub nbgrader knows students by their login; here `--student` says who it is.
"""

import multiprocessing
import os
import pwd
import stat
import subprocess
import sys

import nbformat
import pytest
from nbgrader.api import Gradebook
from nbgrader.apps import NbGraderApp
from nbgrader.coursedir import CourseDirectory
from support import points, run, scores

from autograder.course import ASSIGNMENT
from autograder.demo import STUDENTS, Student
from autograder.intake import exchange
from autograder.released import Released

ONE, TWO = "1_rotation", "2_homogeneous_transforms"
EARLY, EARLIER, TO_COME = (f"{year}-11-20 10:00:00.000000 UTC" for year in (2020, 2019, 2222))


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
            "c.ExchangeCollect.check_owner = False\n"  # everybody here is who runs the tests
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
    inbound = (hub.exchange / "transforms" / "inbound").stat().st_mode
    assert stat.S_IMODE(inbound) & 0o1777 == 0o1733  # nobody looks in, or takes out what is another's
    assert stat.S_IMODE(hub.exchange.stat().st_mode) == 0o1777

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


def test_feedback_is_fetched_whatever_else_was_handed_in_and_by_whoever_graded(hub, sandboxed):
    """With a notebook of the student's own beside the assignment's, and an instructor whose files nobody else can read."""
    course, bob = hub.course, hub.home("bob")
    hub.student("bob", "fetch_assignment", ASSIGNMENT)
    nbformat.write(nbformat.v4.new_notebook(), bob / ASSIGNMENT / "Untitled.ipynb")
    hub.student("bob", "submit", ASSIGNMENT)
    hub.instructor("collect", ASSIGNMENT)
    code, said = run(course, "grade")
    assert code == 0, said
    for page in course.feedback("bob").glob("*.html"):
        page.chmod(0o600)
    hub.instructor("release_feedback", ASSIGNMENT)
    released = list((hub.exchange / "transforms" / "feedback").iterdir())
    assert released and all(stat.S_IMODE(page.stat().st_mode) == 0o644 for page in released)
    assert "feedback ready to be fetched" in hub.student("bob", "list", "--inbound")
    hub.student("bob", "fetch_feedback", ASSIGNMENT)
    assert "feedback already fetched" in hub.student("bob", "list", "--cached")
    own = next(page for path, page in hub.pages("bob").items() if path.endswith("/Untitled.html"))
    assert own == (course.feedback("bob") / "index.html").read_text()


def test_links_in_the_exchange_bring_nothing_of_the_instructors_and_stop_nobody(hub, solved):
    course, sent = hub.course, EARLY
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


@pytest.fixture
def put(hub, solved):
    """put(folder's name, notebook, owner's number, timestamp): a submission as `nbgrader submit` leaves it; where it lies."""

    def submission(name, notebook=ONE, owner=None, timestamp=None):
        folder = hub.exchange / "transforms" / "inbound" / name
        folder.mkdir()
        (folder / f"{notebook}.ipynb").write_bytes(solved[notebook].read_bytes())
        if timestamp is not None:
            (folder / "timestamp.txt").write_text(timestamp)
        for path in (*folder.iterdir(), folder) if owner is not None else ():
            os.chown(path, owner, -1)
        return folder

    return submission


@pytest.fixture
def accounts():
    """Two students' accounts of this machine, {name: number}; made for the test, and removed again."""
    if os.getuid() != 0:
        pytest.skip("needs root, to make accounts")
    names = [f"grader-{who}-{os.getpid()}" for who in ("alice", "mallory")]
    for name in names:
        subprocess.run(["useradd", "--no-create-home", "--no-user-group", name], check=True)
    try:
        yield {name: pwd.getpwnam(name).pw_uid for name in names}
    finally:
        for name in names:
            subprocess.run(["userdel", name], check=True)


OWNERS = "--ExchangeCollect.check_owner=True"


def test_who_owns_a_folder_is_who_handed_it_in(hub, put, accounts):
    """With accounts of this machine: nobody hands in as somebody else, not even with a later date, nor adds to it."""
    (alice, hers), (mallory, his) = accounts.items()
    mine = put(f"{alice}+{ASSIGNMENT}+{EARLIER}+random", ONE, hers, EARLIER)
    forged = put(f"{alice}+{ASSIGNMENT}+{EARLY}+random", TWO, his, EARLY)
    (mine / "added.txt").write_text("by another one")
    os.chown(mine / "added.txt", his, -1)
    (forged.parent / f"{alice}+{ASSIGNMENT}+{EARLY}+link").symlink_to(mine)
    put(f"{mallory}+{ASSIGNMENT}+{EARLY}+random", ONE, his, EARLY)
    said = hub.instructor("collect", ASSIGNMENT, OWNERS)
    assert f"{forged.name}': passed over; it belongs to the account {mallory}, and who owns a folder is who" in said
    assert "+link': passed over; it is no folder." in said
    assert f"added.txt: left out; it belongs to the account {mallory}." in said
    assert hub.course.students() == [alice, mallory]
    taken = hub.course.submitted(alice)
    assert sorted(path.name for path in taken.iterdir()) == [f"{ONE}.ipynb", "timestamp.txt"]
    assert (taken / "timestamp.txt").read_text() == EARLIER


def test_without_accounts_of_their_own_students_are_who_the_folder_says(hub, put):
    me = pwd.getpwuid(os.getuid()).pw_name
    for name in (me, "mallory"):
        put(f"{name}+{ASSIGNMENT}+{EARLY}+random")
    said = hub.instructor("collect", ASSIGNMENT, OWNERS)
    assert "check_owner = False in nbgrader_config.py" in said and hub.course.students() == [me]
    hub.instructor("collect", ASSIGNMENT)
    assert hub.course.students() == sorted([me, "mallory"])


ODD_FOLDERS = {
    f"=cmd+{ASSIGNMENT}+{EARLY}+random": "begins with no - + = @ or dot",
    f"-rf+{ASSIGNMENT}+{EARLY}+random": "begins with no - + = @ or dot",
    f"a\nb+{ASSIGNMENT}+{EARLY}+random": "has no line ends",
    f"alice+{ASSIGNMENT}+{TO_COME}+random": "2222-11-20 10:00 UTC, is still to come: it has to be handed in again",
    f"alice+{ASSIGNMENT}+yesterday+random": "its name is not one that `nbgrader submit` gives",
    f"alice+{ASSIGNMENT}+": "its name is not one that `nbgrader submit` gives",
    f"+{ASSIGNMENT}+{EARLY}+random": "a student's name is not empty",
}


def test_what_is_passed_over_is_said_and_stands_in_nobodys_way(hub, put):
    for name in ODD_FOLDERS:
        put(name, TWO)
    put(f"alice+{ASSIGNMENT}+{EARLIER}+random", ONE)
    said = hub.instructor("collect", ASSIGNMENT)
    for name, why in ODD_FOLDERS.items():
        assert any(f"{name!r}"[1:] in line and why in line for line in said.splitlines()), name
    assert hub.course.students() == ["alice"] == sorted(path.name for path in (hub.course.root / "submitted").iterdir())
    assert [path.stem for path in hub.course.submitted("alice").glob("*.ipynb")] == [ONE]


@pytest.mark.parametrize("written", [None, EARLIER, TO_COME, "/etc/passwd", "x" * 5000])
def test_the_time_of_a_submission_is_that_by_which_it_was_collected(hub, put, written):
    """What a student writes into the file, or that there is none, changes nothing; the day it was written here is said."""
    put(f"alice+{ASSIGNMENT}+{EARLY}+random", timestamp=written)
    said = hub.instructor("collect", ASSIGNMENT)
    assert (hub.course.submitted("alice") / "timestamp.txt").read_text() == EARLY
    assert "Written later than they say, times in UTC: alice (says 2020-11-20 10:00, written 2" in said


def test_work_that_was_just_handed_in_is_not_said_to_be_dated_back(hub):
    hub.student("alice", "fetch_assignment", ASSIGNMENT)
    hub.student("alice", "submit", ASSIGNMENT)
    assert "Written later" not in hub.instructor("collect", ASSIGNMENT) and hub.course.students() == ["alice"]


def test_a_sticky_folder_of_somebody_else_is_said(tmp_path, monkeypatch, caplog):
    """`release_assignment` cannot change an exchange that another account has made; it says who has to."""
    tmp_path.chmod(0o777)
    (tmp_path / "transforms" / "inbound").mkdir(parents=True)

    def refuse(*_):
        raise PermissionError

    monkeypatch.setattr(exchange.ExchangeReleaseAssignment, "init_dest", lambda _: None)
    monkeypatch.setattr(exchange.os, "chmod", refuse)
    released = exchange.ReleaseAssignment(coursedir=CourseDirectory(course_id="transforms"))
    released.root = str(tmp_path)
    released.init_dest()
    assert f"{tmp_path}: who owns it has to run `chmod +t {tmp_path}`." in caplog.text


def test_who_did_not_submit_through_the_exchange_does_not_keep_others_from_their_feedback(hub):
    sent, files = (
        EARLY,
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
