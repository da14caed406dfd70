"""The tests of the sandbox and the hostile notebooks once more, by an ordinary user, where root runs the tests.

For root a notebook becomes another user than all else on the machine. For an ordinary user it stays the same one, and
only namespaces and the filter keep it from the grader's processes.
"""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import pytest
from support import MADE_AT_RUN_TIME, ROOT

ORDINARY = 12_345  # a user whom nobody is


@pytest.fixture(scope="module")
def checkout():
    """A folder of that user's, with the project."""
    with tempfile.TemporaryDirectory(prefix="ordinary-") as folder:
        ignored = shutil.ignore_patterns(*MADE_AT_RUN_TIME, ".pytest_cache")
        shutil.copytree(ROOT, folder, ignore=ignored, dirs_exist_ok=True)
        subprocess.run(["chown", "-R", f"{ORDINARY}:{ORDINARY}", folder], check=True)
        os.chmod(folder, 0o755)
        yield folder


@pytest.mark.parametrize("file", ["test_sandbox.py", "test_hostile.py"])
def test_as_an_ordinary_user(sandboxed, open_python, checkout, file):
    tools = Path(shutil.which("bwrap")).parent
    environment = {"HOME": checkout, "PATH": f"{tools}:/usr/local/bin:/usr/bin:/bin", "CI": os.environ.get("CI", "")}
    ran = subprocess.run(
        [open_python, "-B", "-m", "pytest", "-q", "-p", "no:cacheprovider", f"tests/sandbox/{file}"],
        cwd=checkout, env=environment, user=ORDINARY, group=ORDINARY, extra_groups=[],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    assert ran.returncode == 0, ran.stdout[-20_000:]
