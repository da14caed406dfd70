"""What a class costs on a hub besides the hub itself: `nbgrader collect`, `grade`, `nbgrader release_feedback`.

    .venv/bin/python tests/benchmark_exchange.py --students 300

All have handed in all notebooks, solved, through nbgrader's exchange. Prints seconds, and processor seconds of all processes but
the notebooks' own. Each command is run once more, when there is nothing left to do. `--smallest`: two students.
"""

import argparse
import os
import secrets
import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "source" / "transforms")]

from benchmark_commands import measured  # noqa: E402
from support import MADE_AT_RUN_TIME, PATH  # noqa: E402

from autograder.course import ASSIGNMENT, Course  # noqa: E402

NBGRADER = [sys.executable, "-m", "nbgrader"]
COMMANDS = {
    "collect": [*NBGRADER, "collect", ASSIGNMENT, "--update"],
    "grade": [sys.executable, "-m", "autograder", "grade"],
    "release_feedback": [*NBGRADER, "release_feedback", ASSIGNMENT],
}
SENT = "2026-01-01 10:00:00.000000 UTC"


def hand_in(inbound, course, student):
    """A submission as `nbgrader submit` leaves it."""
    folder = inbound / f"{student}+{ASSIGNMENT}+{SENT}+random"
    shutil.copytree(course.release, folder)
    for path in course.source.glob("*.ipynb"):
        shutil.copy(path, folder)
    (folder / "timestamp.txt").write_text(SENT)
    (folder / "submission_secret.txt").write_text(secrets.token_hex(64))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--students", type=int, default=300)
    parser.add_argument("--smallest", action="store_true")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        shutil.copytree(ROOT, folder / "course", ignore=shutil.ignore_patterns(*MADE_AT_RUN_TIME, ".pytest_cache"))
        course, exchange = Course(folder / "course"), folder / "exchange"
        exchange.mkdir()
        exchange.chmod(0o1777)
        (folder / "nbgrader_config.py").write_text(
            f'c = get_config()\nc.Exchange.root = "{exchange}"\n'
            "c.ExchangeCollect.check_owner = False\n"  # all of it belongs to who runs this
        )
        environment = {**os.environ, "PATH": PATH, "JUPYTER_CONFIG_PATH": str(folder)}
        measured([*NBGRADER, "release_assignment", ASSIGNMENT], course.root, environment)
        for number in range(2 if options.smallest else options.students):
            hand_in(exchange / "transforms/inbound", course, f"student_{number:04}")
        for what, command in COMMANDS.items():
            for when in ("", ", again"):
                seconds, processor = measured(command, course.root, environment)
                print(f"{what + when:25} {seconds:7.1f} s {processor:7.1f} s of processors", flush=True)


if __name__ == "__main__":
    main()
