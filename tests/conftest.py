"""What tests share: courses to work in, and the rule that nothing is skipped where CI has to run it."""

import os
import shutil
import subprocess
import sysconfig
import tempfile
from pathlib import Path

import pytest
from support import CHROMIUM_FLAGS, MADE_AT_RUN_TIME, ROOT, SOFTWARE_WEBGL, lacking

os.environ["PATH"] = f"{Path(os.sys.prefix, 'bin')}{os.pathsep}{os.environ['PATH']}"  # nbgrader runs alembic by name


@pytest.fixture(scope="session")
def released(tmp_path_factory):
    """A course in which the assignment was released; not to be changed by tests."""
    from autograder.course import Course
    from autograder.handout.release import release

    root = tmp_path_factory.mktemp("course") / "released"
    shutil.copytree(ROOT, root, ignore=shutil.ignore_patterns(*MADE_AT_RUN_TIME, ".pytest_cache"))
    course = Course(root)
    release(course)
    return course


@pytest.fixture
def draft(tmp_path):
    """A course of the test's own, as it is committed; nbgrader has not made a gradebook yet."""
    from autograder.course import Course

    ignored = shutil.ignore_patterns(*MADE_AT_RUN_TIME, ".*", "tests", "findings")
    shutil.copytree(ROOT, tmp_path / "draft", ignore=ignored)
    return Course(tmp_path / "draft")


@pytest.fixture
def course(released, tmp_path):
    """A released course of the test's own."""
    from autograder.course import Course

    shutil.copytree(released.root, tmp_path / "course")
    return Course(tmp_path / "course")


@pytest.fixture(scope="session")
def sandboxed():
    """For tests that need bubblewrap."""
    from autograder import sandbox

    if problem := sandbox.problem():
        lacking(problem)


@pytest.fixture(scope="session")
def open_python():
    """A Python with our packages that every user may read, as one in a container is; tests that need it need root.

    Where ours lies in a closed folder, that is an environment of the system's Python which takes the packages from ours.
    """
    if os.getuid() != 0:
        pytest.skip("needs root, as a grader in a container is")

    def serves(python):
        nobody = {"user": 65534, "group": 65534, "extra_groups": [], "cwd": "/"}
        try:
            found = subprocess.run([python, "-c", "import decimal, numpy, IPython"], capture_output=True, **nobody)
        except PermissionError:
            return False
        return found.returncode == 0

    if serves(os.sys.executable):
        yield os.sys.executable
        return
    system = shutil.which(f"python3.{os.sys.version_info.minor}", path="/usr/bin:/usr/local/bin")
    with tempfile.TemporaryDirectory(prefix="open-python-") as folder:
        os.chmod(folder, 0o755)
        python, packages = Path(folder, "bin/python"), sysconfig.get_path("purelib")
        if system and subprocess.run([system, "-m", "venv", "--without-pip", folder]).returncode == 0:
            (own,) = Path(folder, "lib").glob("python3.*/site-packages")
            (own / "ours.pth").write_text(f"import site; site.addsitedir({packages!r})\n")
            if serves(python):
                yield str(python)
                return
    pytest.skip("needs a Python that other users may read")


@pytest.fixture(scope="session")
def chromium():
    """The path of a Chromium browser."""
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    return found or lacking("needs Chromium, to open pages as a student's browser does")


@pytest.fixture(scope="module")
def browser(chromium):
    """A running Chromium, driven by playwright."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=chromium, args=[*CHROMIUM_FLAGS, *SOFTWARE_WEBGL])
        yield launched
        launched.close()


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
