"""What tests share: courses to work in, and the rule that nothing is skipped where CI has to run it."""

import os
import shutil
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
MADE_AT_RUN_TIME = (".git", ".venv", "submitted", "autograded", "feedback", "reports", "gradebook.db", "__pycache__")
os.environ["PATH"] = f"{Path(os.sys.prefix, 'bin')}{os.pathsep}{os.environ['PATH']}"  # nbgrader runs alembic by name


@pytest.fixture(scope="session")
def released(tmp_path_factory):
    """A course in which the assignment was released; not to be changed by tests."""
    from autograder.course import Course
    from autograder.release import release

    root = tmp_path_factory.mktemp("course") / "released"
    shutil.copytree(ROOT, root, ignore=shutil.ignore_patterns(*MADE_AT_RUN_TIME, ".pytest_cache"))
    course = Course(root)
    release(course)
    return course


@pytest.fixture
def course(released, tmp_path):
    """A released course of the test's own."""
    from autograder.course import Course

    shutil.copytree(released.root, tmp_path / "course")
    return Course(tmp_path / "course")


SOFTWARE_WEBGL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
CHROMIUM_FLAGS = (
    "--no-sandbox --disable-gpu --disable-background-networking --disable-component-update --disable-sync --no-first-run"
).split()


def lacking(what):
    """Skip a test for want of something this machine does not have; in CI that is a failure."""
    if os.environ.get("CI") == "true":
        pytest.fail(what)
    pytest.skip(what)


@pytest.fixture(scope="session")
def sandboxed():
    """For tests that need bubblewrap."""
    from autograder import sandbox

    if problem := sandbox.problem():
        lacking(problem)


@pytest.fixture(scope="session")
def chromium():
    """The path of a Chromium browser."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    return found or lacking("needs Chromium, to open pages as a student's browser does")


@pytest.fixture(scope="session")
def hand_in():
    """hand_in(course, student, notebooks): put files into submitted/, {notebook name: path, bytes or notebook}."""
    import nbformat

    def put(course, student, notebooks):
        folder = course.submitted(student)
        folder.mkdir(parents=True)
        for name, content in notebooks.items():
            if isinstance(content, Path):
                content = content.read_bytes()
            elif not isinstance(content, bytes):
                content = nbformat.writes(content).encode()
            (folder / f"{name}.ipynb").write_bytes(content)

    return put


@pytest.fixture
def solved(course):
    """{notebook name: path} of the notebooks with their solutions."""
    return {path.stem: path for path in sorted(course.source.glob("*.ipynb"))}
