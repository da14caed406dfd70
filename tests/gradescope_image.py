"""Gradescope's image, built and used as Gradescope does: `python tests/gradescope_image.py [SUITE] [--root FOLDER]`, as root.

Some ten minutes, so no test calls it; run it after a change of what setup.sh installs or of what the sandbox asks of a system.
A root file system of Ubuntu 24.04 (noble), or of the Debian that is nearest (trixie), whichever this machine's apt has a mirror
of, is made by debootstrap; in a container (container.py) setup.sh and run_autograder of the zip then run in it, from PyPI and
the mirror, with Docker's defaults and with namespaces allowed. It asserts what the solutions and the released notebooks earn.
"""

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "source/transforms"), str(ROOT / "tests")]

from container import HOST  # noqa: E402
from support import points  # noqa: E402

from autograder.course import Course  # noqa: E402
from autograder.handout import package  # noqa: E402

SUITES = {"ubuntu": "noble", "debian": "trixie"}
WAYS = {
    "Docker's defaults": [],
    "user namespaces": ["--seccomp=unconfined"],
    "user namespaces and a /proc of their own": ["--seccomp=unconfined", "--systempaths=unconfined"],
}


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("suite", nargs="?", default=SUITES[distribution()], help="of this machine's distribution")
    parser.add_argument("--root", type=Path, help="where the root file system is made, or was made")
    options = parser.parse_args(arguments)
    root = options.root or Path(tempfile.mkdtemp(prefix="gradescope-")) / options.suite
    if not (root / "opt/transforms").exists():
        build(options.suite, root)
    course = Course(ROOT)
    for folder, earned in {course.source: points(), course.release: 0}.items():
        for name, allowed in WAYS.items():
            score = grade(root, folder, allowed)
            print(f"{name}: {score:g} points, {earned:g} expected", flush=True)
            assert score == earned
    if not options.root:
        shutil.rmtree(root.parent)


def distribution():
    with open("/etc/os-release", encoding="utf-8") as file:
        return dict(line.rstrip().replace('"', "").split("=", 1) for line in file if "=" in line)["ID"]


def build(suite, root):
    """Make the root file system, and in it what Gradescope makes of the zip."""
    said = subprocess.run(
        ["apt-get", "indextargets", "--format", "$(REPO_URI) $(COMPONENT)", "Created-By: Packages"],
        check=True, capture_output=True, text=True,
    ).stdout  # fmt: skip
    mirror = next(line.split()[0] for line in said.splitlines() if line.endswith(" main") and "security" not in line)
    subprocess.run(["debootstrap", "--variant=minbase", suite, root, mirror], check=True)
    autograder = root / "autograder"
    (autograder / "source").mkdir(parents=True)
    package.write(autograder / "autograder.zip", package.for_gradescope(Course(ROOT)))
    with zipfile.ZipFile(autograder / "autograder.zip") as archive:
        archive.extractall(autograder / "source")
    (autograder / "autograder.zip").unlink()
    for name in ("setup.sh", "run_autograder"):
        (autograder / "source" / name).chmod(0o755)
    shutil.copy(autograder / "source" / "run_autograder", autograder)
    run(root, ["--host"], pips_settings(), "/autograder/source/setup.sh")


def pips_settings():
    """What pip is told on this machine, with its files as they are seen from inside."""
    said = subprocess.run([sys.executable, "-m", "pip", "config", "list"], check=True, capture_output=True, text=True)
    settings = {}
    for line in said.stdout.splitlines():
        name, _, value = line.partition("=")
        words = value.strip("'").split()
        seen = [re.sub(r"^(file://)?(?=/)", rf"\1/{HOST}", word) for word in words]
        settings[f"PIP_{name.rpartition('.')[2].upper().replace('-', '_')}"] = " ".join(seen)
    return settings


def grade(root, folder, allowed):
    """The points of the notebooks in a folder."""
    autograder = root / "autograder"
    for name in ("submission", "results"):
        shutil.rmtree(autograder / name, ignore_errors=True)
        (autograder / name).mkdir()
    for path in folder.glob("*.ipynb"):
        shutil.copy(path, autograder / "submission")
    run(root, allowed, {}, "cd /autograder && ./run_autograder >results/stdout 2>&1")
    print((autograder / "results/stdout").read_text(), end="")
    return json.loads((autograder / "results/results.json").read_text())["score"]


def run(root, allowed, settings, command):
    environment = {"HOME": "/root", "PATH": "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin", **settings}
    given = [f"{name}={value}" for name, value in environment.items()]
    entered = [sys.executable, ROOT / "tests/container.py", *allowed, root, "env", "--ignore-environment", *given]
    subprocess.run([*entered, "bash", "-c", command], check=True)


if __name__ == "__main__":
    main(sys.argv[1:])
