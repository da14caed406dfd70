"""What tests of several rooms use: commands run as an instructor runs them, and what came of them."""

import atexit
import csv
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from contextlib import contextmanager
from functools import cache
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from nbgrader.api import Gradebook
from nbgrader.coursedir import CourseDirectory
from transform_lab.judging.calling import call
from transform_lab.judging.verdict import examine

from autograder.bridge.settings import settings
from autograder.course import ASSIGNMENT, Course
from autograder.exercises import EXERCISES, PUBLIC_SEED, key
from autograder.pages.markdown import markdown2html
from autograder.released import Released

ROOT = Path(__file__).resolve().parent.parent
PATH = f"{Path(sys.prefix, 'bin')}{os.pathsep}{os.environ['PATH']}"  # nbgrader runs alembic by name
MADE_AT_RUN_TIME = (".git", ".venv", "submitted", "autograded", "feedback", "reports", "gradebook.db", "__pycache__")
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
TOOLS = {"sandbox": ["bwrap"], "browser": BROWSERS}  # programs that tests of no other tier find
SOFTWARE_WEBGL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
CHROMIUM_FLAGS = (
    "--no-sandbox --disable-gpu --disable-background-networking --disable-component-update --disable-sync --no-first-run"
).split()
SEEDS = (PUBLIC_SEED, 1, 7, 20_170_424, 987_654_321)
PATIENCE = 300  # seconds after which a test gives up waiting; long, for none is about how fast a machine is

# What the course asks for, read from its notebooks: {notebook: Released}
ASKED = {
    path.stem: Released(path.stem, path.read_text(encoding="utf-8"))
    for path in sorted((ROOT / "source" / ASSIGNMENT).glob("*.ipynb"))
}
NAMES = [name for notebook in ASKED.values() for name in notebook.points]  # of the exercises that are asked, in order


def points(*notebooks):
    """The points of the exercises in these notebooks, or in all of them."""
    return sum(sum(ASKED[notebook].points.values()) for notebook in notebooks or ASKED)


def points_by_hand(*notebooks):
    """The points of the questions that a person grades in these notebooks, or in all of them."""
    return sum(sum(ASKED[notebook].questions.values()) for notebook in notebooks or ASKED)


def lacking(what):
    """Skip a test for want of something this machine does not have; in CI that is a failure."""
    if os.environ.get("CI") == "true":
        pytest.fail(what)
    pytest.skip(what)


def chromium_here():
    """The path of a Chromium browser, or None."""
    return next(filter(None, map(shutil.which, BROWSERS)), None)


@cache
def path_without(*tools):
    """The PATH without these programs: a folder that holds one is replaced by links to all else that is in it."""
    folders = []
    for folder in map(Path, PATH.split(os.pathsep)):
        if any((folder / tool).exists() for tool in tools):
            links = Path(tempfile.mkdtemp(prefix="path-"))
            links.chmod(0o755)
            atexit.register(shutil.rmtree, links)
            for program in folder.iterdir():
                if program.name not in tools:
                    (links / program.name).symlink_to(program)
            folder = links
        folders.append(str(folder))
    return os.pathsep.join(folders)


def run(course, *arguments, path=None):
    """Run `python3 -m autograder …` in a course; (exit code, all that was printed)."""
    environment = {**os.environ, "COLUMNS": "200"}
    if path is not None:
        environment["PATH"] = path
    root = course.root if isinstance(course, Course) else course
    result = subprocess.run(
        [sys.executable, "-m", "autograder", *arguments],
        cwd=root, env=environment, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=600,
    )  # fmt: skip
    said = result.stdout + result.stderr
    assert "Traceback (most recent call last)" not in said, said
    return result.returncode, said


def processes_in(folder):
    """The numbers of this machine's processes that work in a folder: a grader's own, and its pool's."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            if Path(os.readlink(path / "cwd")).is_relative_to(folder):
                found.append(int(path.name))
        except OSError:
            continue  # it has just ended
    return found


def wait_for(condition):
    """Return when `condition()` is true."""
    for _ in range(20 * PATIENCE):
        if condition():
            return
        time.sleep(0.05)
    raise TimeoutError("what a test waits for did not happen")


@contextmanager
def jupyter_server(course):
    """The address of a real Jupyter server in a course, with nbgrader's formgrader; its token is "secret"."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    command = [
        sys.executable,
        "-m",
        "jupyter_server",
        "--no-browser",
        f"--port={port}",
        "--port-retries=0",
        "--allow-root",
    ]
    command += ["--IdentityProvider.token=secret", "--ServerApp.disable_check_xsrf=True"]
    with open(course.root / "server.log", "w") as log:
        server = subprocess.Popen(command, cwd=course.root, stdout=log, stderr=log, stdin=subprocess.DEVNULL)
    address = f"http://127.0.0.1:{port}"

    def answers():
        try:
            return asked(address, "/api/status")
        except (urllib.error.URLError, ConnectionError):
            return False

    try:
        wait_for(answers)
        yield address
    finally:
        server.terminate()
        server.wait(30)


def asked(address, path, method="GET"):
    """What a `jupyter_server` answers."""
    request = urllib.request.Request(address + path, method=method, headers={"Authorization": "token secret"})
    with urllib.request.urlopen(request, timeout=PATIENCE) as response:
        return response.read().decode()


def verdicts(course):
    with open(course.reports / "verdicts.csv", newline="") as file:
        return list(csv.DictReader(file))


def scores(course, student):
    return {row["exercise"]: float(row["score"]) for row in verdicts(course) if row["student"] == student}


def statuses(course, student):
    return {row["exercise"]: row["status"] for row in verdicts(course) if row["student"] == student}


def marks(course):
    """{(student, notebook, cell): all that the gradebook holds of it}, comments included."""
    found = {}
    with Gradebook(CourseDirectory(config=settings(course)).db_url) as gradebook:
        for submission in gradebook.assignment_submissions(ASSIGNMENT):
            for notebook in submission.notebooks:
                for grade in notebook.grades:
                    cell = submission.student_id, notebook.name, grade.name
                    found[cell] = grade.auto_score, grade.score, grade.max_score, grade.needs_manual_grade
                for comment in notebook.comments:
                    found[submission.student_id, notebook.name, f"{comment.name} comment"] = comment.auto_comment
    return found


def without_plugin(course):
    """The same course for an instructor who does not use our grader."""
    path = course.root / "nbgrader_config.py"
    text, _, _ = path.read_text().partition("# Submitted notebooks are mended")
    path.write_text(text)


def markdown(text, **cell):
    return markdown2html({"cell": cell}, text)


class Parsed(HTMLParser):
    """The tags of a page, each with its attributes."""

    def __init__(self, text):
        super().__init__()
        self.tags = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))


@cache
def key_of(name, seed=PUBLIC_SEED):
    """The key of an exercise, worked out once."""
    return key(EXERCISES[name], seed, when_asked=True)


def judged(name, function, seed=PUBLIC_SEED):
    """The Verdict on `function` as a student's solution of the exercise `name`."""
    with np.errstate(all="ignore"):  # wrong solutions divide by zero
        return examine(name, key_of(name, seed), lambda args, kwargs: call(function, args, kwargs))
