"""A `grade` with nothing to do says so by the looks of files; whatever looks otherwise is for the usual way to judge."""

import json
import os
import shutil
import sqlite3
import subprocess
import sys

import nbformat
import pytest
from support import run

from autograder.bridge.nbgrader_api import db_url
from autograder.bridge.settings import settings
from autograder.course import ASSIGNMENT, Course
from autograder.grading import settled

ONE = "1_rotation"
TABLE = [["ada", "2 of 2", ""]]


# --- each change by itself --------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def template(released, tmp_path_factory):
    """A course with the files of two students, as if they had been graded; not to be changed by tests."""
    ignored = shutil.ignore_patterns("tests", "findings", "solution", "demo", "__pycache__", "*.png", ".*")
    course = Course(shutil.copytree(released.root, tmp_path_factory.mktemp("settled") / "course", ignore=ignored))
    for student in ("ada", "ben"):
        for folder in (course.submitted(student), course.autograded(student), course.feedback(student)):
            folder.mkdir(parents=True)
            shutil.copy(course.release / f"{ONE}.ipynb", folder)
    course.reports.mkdir(parents=True)
    for name in ("index.html", "verdicts.csv"):
        (course.reports / name).write_text(name)
    return course


@pytest.fixture(params=[0, settled.FRESH], ids=["old", "fresh"])
def course(request, monkeypatch, template, tmp_path):
    """A course of the test's own, with files of which the time tells each change, or that were written a moment ago."""
    course = Course(shutil.copytree(template.root, tmp_path / "course"))
    monkeypatch.setattr(settled, "FRESH", request.param)
    monkeypatch.setattr(settled, "AUTOGRADER", course.root / "autograder")
    return course


def settle(course, meanwhile=lambda: None, later=lambda: None, graded=(), url=None):
    """Keep the looks of a run during which something is done, before and after all was recorded."""
    (course.reports / settled.KEPT).unlink(missing_ok=True)
    looks = settled.Looks(course, url or db_url(course))
    looks.take()
    meanwhile()
    looks.take()
    later()
    looks.take()
    looks.keep(course.students(), settings(course), graded, TABLE)
    return table(course)


def table(course):
    return settled.table(course, course.students(), settings(course))


def edit(path):
    """Change a file to another one of the same size, and give it its old time back."""

    def change(course):
        place, before = course.root / path, (course.root / path).stat()
        content = place.read_bytes()
        place.write_bytes(content[:-3] + bytes([content[-3] ^ 1]) + content[-2:])
        os.utime(place, ns=(before.st_atime_ns, before.st_mtime_ns))

    return change


def write(path):
    def change(course):
        (course.root / path).parent.mkdir(parents=True, exist_ok=True)
        (course.root / path).write_text("new")

    return change


def remove(path):
    return lambda course: (course.root / path).unlink()


def in_gradebook(course):
    gradebook = sqlite3.connect(course.gradebook)
    (version,) = gradebook.execute("PRAGMA user_version").fetchone()
    gradebook.execute(f"PRAGMA user_version = {version + 1}")
    gradebook.close()


CHANGES = {
    "a submitted file is another": edit(f"submitted/ada/{ASSIGNMENT}/{ONE}.ipynb"),
    "a file is handed in": write(f"submitted/ada/{ASSIGNMENT}/helper.py"),
    "one in a folder is": write(f"submitted/ada/{ASSIGNMENT}/a/b/c.txt"),
    "a student hands in": write(f"submitted/cleo/{ASSIGNMENT}/{ONE}.ipynb"),
    "a file lies astray": write("submitted/zip.zip"),
    "a student has an empty folder": lambda course: course.submitted("dan").mkdir(parents=True),
    "a submitted file is gone": remove(f"submitted/ben/{ASSIGNMENT}/{ONE}.ipynb"),
    "a graded notebook is another": edit(f"autograded/ada/{ASSIGNMENT}/{ONE}.ipynb"),
    "a graded notebook is gone": remove(f"autograded/ben/{ASSIGNMENT}/{ONE}.ipynb"),
    "a page is another": edit(f"feedback/ada/{ASSIGNMENT}/{ONE}.ipynb"),
    "a page is gone": remove(f"feedback/ben/{ASSIGNMENT}/{ONE}.ipynb"),
    "the report is gone": remove(f"reports/{ASSIGNMENT}/index.html"),
    "a table is another": edit(f"reports/{ASSIGNMENT}/verdicts.csv"),
    "points are others": in_gradebook,
    "the gradebook has what is not in its file yet": write("gradebook.db-wal"),
    "nbgrader is set up otherwise": edit("nbgrader_config.py"),
    "a package is another": edit("environment.txt"),
    "a released notebook is another": edit(f"notebooks/{ASSIGNMENT}/{ONE}.ipynb"),
    "the public cases are others": edit(f"notebooks/{ASSIGNMENT}/transform_lab/key.json"),
    "the students' package is another": edit(f"source/{ASSIGNMENT}/transform_lab/tft.py"),
    "the grader is another": edit("autograder/grading/judge.py"),
    "a template is another": edit("autograder/pages/templates/summary.html"),
    "the grader has one file more": write("autograder/exercises/more.py"),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_what_looks_otherwise_is_not_settled(course, change):
    students, config = course.students(), settings(course)
    assert settle(course) == TABLE
    change(course)
    assert settled.table(course, students, config) is None


@pytest.mark.parametrize("change", [write("autograder/grading/__pycache__/x.pyc"), write("source/new.txt")])
def test_what_a_run_does_not_read_changes_nothing(course, change):
    assert settle(course) == TABLE
    change(course)
    assert table(course) == TABLE


def test_settings_that_depend_on_more_than_their_file(course, monkeypatch):
    path = course.root / "nbgrader_config.py"
    path.write_text(path.read_text() + "import os\nc.CourseDirectory.db_url = os.environ.get('THEIR_DATABASE', '')\n")
    assert settle(course, url=f"sqlite:///{course.gradebook}") == TABLE
    monkeypatch.setenv("THEIR_DATABASE", "sqlite:///another.db")
    assert table(course) is None


def test_other_students_are_another_run(course):
    assert settle(course) == TABLE
    assert settled.table(course, course.students()[1:], settings(course)) is None


@pytest.mark.parametrize("damaged", ["", "{", "[]", "7", '{"about": 1}', '{"looks": {}}'])
def test_looks_that_somebody_has_damaged_settle_nothing(course, damaged):
    assert settle(course) == TABLE
    (course.reports / settled.KEPT).write_text(damaged)
    assert table(course) is None


# --- what is not kept -------------------------------------------------------------------------------------------------

MEANWHILE = {
    "handed in": write(f"submitted/ada/{ASSIGNMENT}/late.py"),
    "edited by hand": edit(f"autograded/ada/{ASSIGNMENT}/{ONE}.ipynb"),
    "points given": in_gradebook,
    "released": edit(f"notebooks/{ASSIGNMENT}/{ONE}.ipynb"),
}


@pytest.mark.parametrize("change", MEANWHILE.values(), ids=MEANWHILE)
@pytest.mark.parametrize("when", ["meanwhile", "later"])
def test_what_somebody_else_changes_during_a_run_is_not_settled_by_it(course, change, when):
    assert settle(course, **{when: lambda: change(course)}) is None


def test_what_a_run_writes_is_settled_by_it(course):
    def records():
        edit(f"autograded/ada/{ASSIGNMENT}/{ONE}.ipynb")(course)
        in_gradebook(course)

    def pages():
        write(f"feedback/ada/{ASSIGNMENT}/index.html")(course)
        edit(f"reports/{ASSIGNMENT}/verdicts.csv")(course)

    assert settle(course, records, pages, graded=["ada"]) == TABLE
    assert settle(course, records, pages, graded=["ben"]) is None
    assert settle(course, pages, records, graded=["ada"]) is None  # points that no page has


def test_a_time_that_is_still_to_come_is_one_of_the_past_some_day(course):
    path = course.submitted("ada") / "timestamp.txt"
    path.write_text("2020-01-01 00:00:00 UTC")
    assert settle(course) == TABLE
    path.write_text("2999-01-01 00:00:00 UTC")
    assert settle(course) is None


def test_a_database_that_is_no_file_has_no_looks(course):
    assert settle(course, url="postgresql://localhost/gradebook") is None


@pytest.mark.parametrize("put", [os.mkfifo, lambda path: path.symlink_to("/dev/zero")], ids=["pipe", "link"])
def test_nothing_is_waited_for_or_followed(course, put):
    put(course.submitted("ada") / "odd")
    found = settle(course)
    assert found is None if settled.FRESH else found == TABLE


def test_a_link_looks_like_what_it_leads_to(course):
    (course.package / "linked.py").symlink_to(course.root / "LICENSE")
    before = settled.look(course, str(course.gradebook))
    edit("LICENSE")(course)
    assert settled.look(course, str(course.gradebook)) != before


# --- the real command -------------------------------------------------------------------------------------------------


def loaded(course):
    """(what `grade` prints, the modules that it loads)"""
    done = subprocess.run(
        [sys.executable, "-X", "importtime", "-m", "autograder", "grade"],
        cwd=course.root, env={**os.environ, "COLUMNS": "200"}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout, {line.rpartition("|")[2].strip().partition(".")[0] for line in done.stderr.splitlines()}


def test_the_next_run_says_the_same_and_loads_nothing_that_grades(released, hand_in, sandboxed, tmp_path):
    course = Course(shutil.copytree(released.root, tmp_path / "course"))
    hand_in(course, "ada", {ONE: course.source / f"{ONE}.ipynb"})
    hand_in(course, "eve", {ONE: b"{"})
    code, said = run(course, "grade")
    assert code == 0 and "2 graded" in said, said
    before = json.dumps(settled.look(course, str(course.gradebook)))
    said, modules = loaded(course)
    assert "0 graded, 2 unchanged." in said and "unreadable (rotation_about_z" in said
    assert not modules & {"nbgrader", "nbformat", "nbconvert", "numpy", "scipy", "IPython", "psutil"}
    assert json.dumps(settled.look(course, str(course.gradebook))) == before
    assert "ada" in said and "0 graded, 1 unchanged" in run(course, "grade", "ada")[1]
    assert "2 graded" in run(course, "grade", "--seed", "1")[1]
    assert "0 graded, 2 unchanged." in loaded(course)[0]
    notebook = nbformat.read(course.source / f"{ONE}.ipynb", as_version=4)
    (course.submitted("eve") / f"{ONE}.ipynb").write_text(nbformat.writes(notebook))
    said, modules = loaded(course)
    assert "1 graded" in said and "1 unchanged." in said and "nbgrader" in modules
