"""What tests share: their tiers, the tools of this machine, and courses to work in."""

import compileall
import fcntl
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections import Counter
from pathlib import Path

import pytest
from support import (
    CHROMIUM_FLAGS,
    MADE_AT_RUN_TIME,
    PATIENCE,
    ROOT,
    SOFTWARE_WEBGL,
    TOOLS,
    chromium_here,
    lacking,
    path_without,
)

# Tests that use one of these fixtures, by themselves or through another, are left to `test --all`; all others are quick.
TIERS = {"sandboxed": "sandbox", "open_python": "sandbox", "chromium": "browser", "slow": "slow"}


def pytest_addoption(parser):
    parser.addoption("--all", action="store_true", help="all tests, and not the quick ones alone")


def pytest_configure(config):
    """What is asked for by name is run, quick or not."""
    if hasattr(config, "workerinput"):  # of a process that pytest-xdist has started
        config.option.all = config.workerinput["all"]
    else:
        named = config.args_source is config.ArgsSource.ARGS
        config.option.all |= named or any(map(config.getoption, ("keyword", "markexpr", "lf")))


def pytest_configure_node(node):
    node.workerinput["all"] = node.config.option.all


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    """Mark each test with its tiers; leave the quick ones alone, or begin with files that take longest: those with tests
    that look at a great many cases then, and those of many other tiers.
    """
    for item in items:
        for fixture in TIERS.keys() & set(item.fixturenames):
            item.add_marker(TIERS[fixture])
    quick = [item for item in items if not tiers(item)]
    others = [item for item in items if tiers(item)]
    if not config.option.all:
        config.hook.pytest_deselected(items=others)
        others = []
    many = Counter(item.path for item in others)
    others.sort(key=lambda item: -many[item.path])
    items[:] = sorted(others + quick, key=lambda item: "thorough" not in item.fixturenames) if others else quick


def tiers(item):
    """The tiers of a test, by its fixtures or, for one of several parameters, by a mark; of a quick one, none."""
    return {mark.name for mark in item.iter_markers()} & set(TIERS.values())


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """A test finds the tools of its own tiers on its PATH and no others, on any machine: one that lacks the fixture fails."""
    hidden = [tool for tier, tools in TOOLS.items() if tier not in tiers(item) for tool in tools]
    os.environ["PATH"] = path_without(*hidden)


@pytest.fixture(scope="session")
def slow():
    """For tests that need no tool of the machine's, and still take long."""


@pytest.fixture(scope="session")
def thorough(pytestconfig):
    """Whether all tests are run: where a quick one looks at a few cases, it looks at a great many then."""
    return pytestconfig.option.all


@pytest.fixture(scope="session")
def made_once(tmp_path_factory):
    """made_once(name, make): the folder of this name which make(folder) fills, once for all processes of a run."""
    own = tmp_path_factory.getbasetemp()
    run = own.parent if "PYTEST_XDIST_WORKER" in os.environ else own

    def made(name, make):
        folder, done = run / name, run / f"{name}.done"
        with open(run / f"{name}.lock", "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            if not done.exists():
                shutil.rmtree(folder, ignore_errors=True)  # what another process has left unfinished
                folder.mkdir()
                make(folder)
                done.touch()
        return folder

    return made


@pytest.fixture(scope="session")
def released(made_once):
    """A course in which the assignment was released, as it is committed; not to be changed by tests."""
    from autograder.bridge.gradebook import Writer
    from autograder.course import Course

    def make(folder):
        ignored = shutil.ignore_patterns(*MADE_AT_RUN_TIME, ".pytest_cache")
        shutil.copytree(ROOT, folder, ignore=ignored, dirs_exist_ok=True)
        with Writer(Course(folder)):
            pass  # it makes the gradebook, and registers the assignment
        for code in (folder / "autograder", folder / "source"):  # once, and not by the first command in every copy
            compileall.compile_dir(code, quiet=1)

    return Course(made_once("released", make))


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

    sandbox.problem.cache_clear()  # a test without this fixture may have asked
    if problem := sandbox.problem():
        lacking(problem)


@pytest.fixture(scope="session")
def open_python():
    """A Python with our packages that every user may read, as one in a container is; tests that need it need root.

    Where ours lies in a closed folder, that is an environment of the system's Python with the same packages.
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
            # In it, where sandboxes see them: the same files under another name, or copies of them.
            subprocess.run(["sh", "-c", 'cp -rl "$0/." "$1" || cp -rf "$0/." "$1"', packages, own], check=True)
            alembic = python.with_name("alembic")  # nbgrader runs it by name
            alembic.write_text(f"#!{python}\nfrom alembic.config import main\nmain()\n")
            alembic.chmod(0o755)
            if serves(python):
                yield str(python)
                return
    lacking("needs a Python that other users may read")


@pytest.fixture(scope="session")
def container(open_python):
    """The command that enters a container (see container.py), as far as its ROOT; tests that need it need root."""
    command = [sys.executable, str(ROOT / "tests/container.py")]
    entered = subprocess.run([*command, "/", "true"], capture_output=True, text=True)
    if entered.returncode != 0:
        lacking(f"needs namespaces, for a container: {entered.stderr}")
    return command


@pytest.fixture(scope="session")
def ros(slow, tmp_path_factory):
    """Runs programs in the ROS 1 of this machine; without a master, for what needs no other program."""
    from ros import robot

    if problem := robot.problem():
        lacking(problem)
    return robot.Ros(tmp_path_factory.mktemp("ros"))


@pytest.fixture(scope="module")
def robot(ros, tmp_path_factory):
    """As `ros`, with a master: what is published there, others hear."""
    from ros.robot import master

    with master(tmp_path_factory.mktemp("robot")) as computer:
        yield computer


@pytest.fixture(scope="session")
def chromium():
    """The path of a Chromium browser."""
    return chromium_here() or lacking("needs Chromium, to open pages as a student's browser does")


@pytest.fixture(scope="module")
def browser(chromium):
    """A running Chromium, driven by playwright."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        launched = playwright.chromium.launch(executable_path=chromium, args=[*CHROMIUM_FLAGS, *SOFTWARE_WEBGL])
        yield launched
        launched.close()


@pytest.fixture(scope="session")
def nbgrader(slow):
    """nbgrader(course, …): run an nbgrader command in the course's root, as an instructor does."""

    def command(course, *arguments):
        return subprocess.run(
            [os.sys.executable, "-m", "nbgrader", *arguments],
            cwd=course.root, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=4 * PATIENCE,
        )  # fmt: skip

    return command


@pytest.fixture(scope="session")
def run_all(slow):
    """run_all(notebook, folder): run a notebook as Jupyter's Run All does, in a kernel: it stops at the first error."""
    from nbclient import NotebookClient

    def execute(notebook, folder):
        NotebookClient(notebook, timeout=PATIENCE, resources={"metadata": {"path": str(folder)}}).execute()
        return notebook

    return execute


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
