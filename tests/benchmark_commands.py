"""What the commands cost besides grading: `--help`, `check` of one notebook, `release`, `demo`, beside another revision.

    .venv/bin/python tests/benchmark_commands.py --against HEAD~20
    .venv/bin/python tests/benchmark_commands.py --against HEAD~20 --fresh      # `demo` from a clone, set-up included

Prints the medians of some rounds, in which each command is run by either revision in turn: seconds, and processor seconds of
all its processes but the notebooks' own, for which nobody waits. A first round is not counted: then Python compiles the
modules, and what is remembered for the same code is worked out. `--smallest` runs all once, to see that it works.
"""

import argparse
import ctypes
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "source" / "transforms")]

from support import MADE_AT_RUN_TIME, PATH  # noqa: E402

COMMANDS = {
    "help": ["--help"],
    "check": ["check", "--unsafe-no-sandbox", "source/transforms/3_chaining.ipynb"],
    "check, sandboxed": ["check", "source/transforms/3_chaining.ipynb"],
    "release": ["release"],
    "demo": ["demo"],
}
PR_SET_CHILD_SUBREAPER = 36


def measured(command, root, environment):
    """Run a command in a course: (seconds, processor seconds)."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(command, cwd=root, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    seconds = time.monotonic() - start
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed in {root}:\n{done.stdout[-1000:]}{done.stderr[-2000:]}")
    while True:  # the fork server ends after the grader
        try:
            os.wait()
        except ChildProcessError:
            break
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return seconds, sum(getattr(after, name) - getattr(before, name) for name in ("ru_utime", "ru_stime"))


def course(folder, revision):
    """A copy of a revision, or of the files as they are now (None)."""
    if revision is None:
        shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(*MADE_AT_RUN_TIME, ".pytest_cache"))
        return folder
    folder.mkdir()
    files = subprocess.run(["git", "archive", revision], cwd=ROOT, check=True, capture_output=True).stdout
    subprocess.run(["tar", "-x", "-C", folder], input=files, check=True)
    return folder


def in_turn(folder, revisions, rounds):
    """Print what each command costs in each of the revisions."""
    courses = {name: course(folder / name, revision) for name, revision in revisions.items()}
    written = {
        name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "PYTHONDONTWRITEBYTECODE")
    }
    environment = {**written, "PATH": PATH}
    for what, arguments in COMMANDS.items():
        if "sandboxed" in what and not shutil.which("bwrap"):
            continue
        found = {name: [] for name in courses}
        for _ in range(rounds):
            for name, root in courses.items():
                made = [root / "gradebook.db", *(root / folder for folder in ("submitted", "autograded", "feedback"))]
                for path in made if what == "demo" else ():
                    shutil.rmtree(path, ignore_errors=True) if path.is_dir() else path.unlink(missing_ok=True)
                found[name].append(measured([sys.executable, "-m", "autograder", *arguments], root, environment))
        tell(what, {name: times[1:] or times for name, times in found.items()})


def from_a_clone(folder, revisions):
    """Print how long `demo` takes where there is nothing but Python: no environment, an empty home."""
    found = {}
    for name, revision in revisions.items():
        home = folder / f"home of {name}"
        home.mkdir()
        kept = {
            variable: value
            for variable, value in os.environ.items()
            if not variable.startswith(("PYTHON", "VIRTUAL_ENV"))
        }
        base = sys._base_executable
        environment = {**kept, "HOME": str(home), "PATH": f"{Path(base).parent}:/usr/local/bin:/usr/bin:/bin"}
        root = course(folder / f"clone of {name}", revision)
        found[name] = [measured([base, "-m", "autograder", "demo"], root, environment)]
    tell("first demo", found)


def tell(what, found):
    medians = {name: [statistics.median(times) for times in zip(*measures)] for name, measures in found.items()}
    line = "  ".join(
        f"{name} {seconds:6.2f} s {processor:6.2f} CPU s" for name, (seconds, processor) in medians.items()
    )
    if len(medians) == 2:
        (_, ours), (_, theirs) = medians.values()
        line += f"  {theirs / ours:.1f} times less"
    print(f"{what:16}  {line}", flush=True)


def main():
    parser = argparse.ArgumentParser(description="What the commands cost besides grading.")
    parser.add_argument("--against", metavar="REVISION", help="of git, such as HEAD~20, to be measured beside")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--fresh", action="store_true", help="only the first demo: from a clone, with its set-up")
    parser.add_argument("--smallest", action="store_true", help="run all once, to see that it works")
    options = parser.parse_args()
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0)
    revisions = {"now": None} | ({options.against: options.against} if options.against else {})
    with tempfile.TemporaryDirectory(prefix="benchmark-") as folder:
        if options.fresh:
            from_a_clone(Path(folder), revisions)
        else:
            in_turn(Path(folder), revisions, 1 if options.smallest else options.rounds + 1)


if __name__ == "__main__":
    main()
