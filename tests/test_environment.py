"""The first use makes `.venv`; what was interrupted, changed or broken is made anew. Real environments, no network."""

import shutil
import subprocess
import sys
import zipfile

import pytest
from support import ROOT

from autograder import environment

NOTHING = "# no package\n"


@pytest.fixture
def root(tmp_path):
    (tmp_path / "environment.txt").write_text(NOTHING)
    return tmp_path


def version(python):
    return subprocess.run(
        [python, "-c", "import sys; print(sys.prefix)"], capture_output=True, text=True
    ).stdout.strip()


def test_it_is_made_once(root):
    python = environment.make(root)
    assert version(python) == str(root / ".venv")
    (root / ".venv" / "mark").touch()
    assert environment.make(root) == python
    assert (root / ".venv" / "mark").exists()


@pytest.mark.parametrize("spoil", ["interrupted", "changed", "broken", "moved"])
def test_it_is_made_anew_when_it_is_not_whole(root, tmp_path_factory, spoil):
    environment.make(root)
    (root / ".venv" / "mark").touch()
    if spoil == "interrupted":
        (root / ".venv" / "stamp").unlink()
    elif spoil == "changed":
        (root / "environment.txt").write_text(NOTHING + "# one more line\n")
    elif spoil == "broken":
        (root / ".venv" / "bin" / "python").unlink()
    else:
        root = root.rename(tmp_path_factory.mktemp("elsewhere") / "course")
    assert version(environment.make(root)) == str(root / ".venv")
    assert not (root / ".venv" / "mark").exists()


def test_a_failed_set_up_says_what_to_do_and_is_repaired(root):
    (root / "environment.txt").write_text("./no-such-package\n")
    with pytest.raises(environment.SetupFailed, match="run the same command again"):
        environment.make(root)
    (root / "environment.txt").write_text(NOTHING)
    assert version(environment.make(root)) == str(root / ".venv")


def test_what_an_interpreter_lacks(root):
    assert environment.lacking(ROOT / "environment.txt") == []
    (root / "environment.txt").write_text("pytest==0.1  # old\nno-such-package-anywhere==1.0\n")
    assert environment.lacking(root / "environment.txt") == ["pytest", "no-such-package-anywhere"]


def test_each_dependency_is_pinned_and_explained():
    lines = (ROOT / "environment.txt").read_text().splitlines()
    packages = [line for line in lines if line and not line.startswith("#")]
    assert len(packages) > 10
    for line in packages:
        name, _, comment = line.partition("#")
        assert "==" in name and comment.strip(), line


def test_an_old_python_is_told_so(root, monkeypatch):
    monkeypatch.setattr(environment, "OLDEST", (99, 0))
    with pytest.raises(environment.SetupFailed, match="Python 99.0 or newer is needed"):
        environment.ensure(root, [])


def wheel(folder, name):
    """A package that pip can install without a network."""
    path = folder / f"{name}-1.0-py3-none-any.whl"
    info = f"{name}-1.0.dist-info"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(f"{name}.py", "")
        archive.writestr(f"{info}/METADATA", f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
        archive.writestr(f"{info}/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
        archive.writestr(f"{info}/RECORD", "")


def test_a_command_goes_on_in_the_new_environment(root):
    """An interpreter that lacks a package installs it into `.venv` and goes on there with the command's arguments."""
    wheel(root, "lacking_here")
    (root / "environment.txt").write_text(f"--no-index\n--find-links {root}\nlacking_here==1.0\n")
    package = root / "autograder"
    package.mkdir()
    for name in ("__init__.py", "__main__.py", "environment.py"):
        shutil.copy(ROOT / "autograder" / name, package)
    (package / "commands.py").write_text(
        "import sys\ndef run(arguments):\n    print(sys.prefix, arguments)\n    return 3\n"
    )
    command = [sys.executable, "-m", "autograder", "demo", "--remove"]
    for _ in range(2):  # the second time, the environment is there
        result = subprocess.run(command, cwd=root, capture_output=True, text=True)
        assert result.stdout == f"{root / '.venv'} ['demo', '--remove']\n", result.stderr
        assert result.returncode == 3
    assert "Setting up" not in result.stderr
