"""How fast a class is graded: `python3 -m autograder grade` beside stock `nbgrader autograde`, in one run.

    .venv/bin/python tests/benchmark_grading.py --students 100 --nbgrader-students 6
    .venv/bin/python tests/benchmark_grading.py --students 1000 --growth      # and a tenth of them before
    .venv/bin/python tests/benchmark_grading.py --students 60 --against HEAD~9  # as that revision grades a class, in turn
    .venv/bin/python tests/benchmark_grading.py --profile                     # where the time of one submission goes

Each student hands in all five notebooks, solved. Both sides run the notebooks as they do in grading, without drawing
scenes (TRANSFORM_LAB_GRADING=1; with them, stock nbgrader takes almost twice as long). Ours ends with the gradebook,
the graded notebooks and the class report written. `benchmark_grading.md` says where the time goes, and what the floor is.
"""

import argparse
import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import psutil

ROOT = Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT), str(ROOT / "source" / "transforms")]

from support import MADE_AT_RUN_TIME, marks, without_plugin  # noqa: E402

from autograder.bridge.gradebook import Writer  # noqa: E402
from autograder.course import ASSIGNMENT, Course  # noqa: E402

os.environ["TRANSFORM_LAB_GRADING"] = "1"
os.environ["PATH"] = f"{Path(sys.prefix, 'bin')}{os.pathsep}{os.environ['PATH']}"  # nbgrader runs alembic by name
OURS = [sys.executable, "-m", "autograder", "grade", "--no-feedback"]
STOCK = [sys.executable, "-m", "nbgrader", "autograde", ASSIGNMENT]


def make_class(folder, students, root=ROOT):
    """A released course in `folder`, as the checkout `root` has it, in which so many students have handed in all notebooks."""
    shutil.copytree(root, folder, ignore=shutil.ignore_patterns(*MADE_AT_RUN_TIME, ".pytest_cache"))
    course = Course(folder)
    subprocess.run([sys.executable, "-m", "autograder", "release"], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    for number in range(students):
        target = course.submitted(f"student_{number:04}")
        target.mkdir(parents=True)
        for path in course.source.glob("*.ipynb"):
            shutil.copy(path, target)
    return course


def measure(command, course):
    """Run a command in a course: (seconds, processor seconds of the whole machine, peak bytes of its own processes)."""
    busy, start = _busy(), time.monotonic()
    process = subprocess.Popen(
        command, cwd=course.root, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    peak = _Peak(process.pid)
    said, _ = process.communicate()
    seconds = time.monotonic() - start
    if process.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{said[-3000:]}")
    return seconds, _busy() - busy, peak.stop()


def _busy():
    times = psutil.cpu_times()
    return sum(times) - times.idle - times.iowait


class _Peak(threading.Thread):
    """Watches what a process and its children hold in memory; those in a sandbox are not the host's."""

    def __init__(self, pid):
        super().__init__(daemon=True)
        self.pid, self.most, self.going = pid, 0, True
        self.namespace = os.readlink("/proc/self/ns/pid")
        self.start()

    def run(self):
        while self.going:
            with contextlib.suppress(psutil.Error, OSError):
                process = psutil.Process(self.pid)
                self.most = max(self.most, sum(map(self._bytes, [process, *process.children(recursive=True)])))
            time.sleep(0.3)

    def _bytes(self, process):
        try:
            inside = os.readlink(f"/proc/{process.pid}/ns/pid") != self.namespace
            return 0 if inside else process.memory_full_info().pss
        except (psutil.Error, OSError):
            return 0  # it has just ended

    def stop(self):
        self.going = False
        self.join()
        return self.most


def points(course, student):
    """{(notebook, cell): points} of what is graded automatically."""
    found = marks(course).items()
    return {cell[1:]: mark[0] for cell, mark in found if cell[0] == student and isinstance(mark, tuple)}


def tell(name, notebooks, seconds, processor, peak):
    rate = notebooks / seconds * 60
    print(
        f"{name:10} {notebooks:5} notebooks  {seconds:7.1f} s  {rate:6.0f} nb/min  "
        f"{processor / notebooks:5.2f} CPU s each  {peak / 1e6:4.0f} MB of memory",
        flush=True,
    )
    return rate


def compare(folder, students, stock_students, growth):
    ours = make_class(folder / "ours", students)
    each = len(ours.notebooks)
    if growth:
        small = make_class(folder / "small", students // 10)
        seconds_small, *rest = measure(OURS, small)
        tell("a tenth", students // 10 * each, seconds_small, *rest)
    seconds, *rest = measure(OURS, ours)
    rate = tell("ours", students * each, seconds, *rest)
    if growth:
        print(f"growth: {students} students took {seconds / seconds_small:.1f} times as long as {students // 10}")
    if stock_students:
        stock = make_class(folder / "stock", stock_students)
        with Writer(stock):
            pass  # registers the assignment, which stock nbgrader does not do
        without_plugin(stock)
        stock_seconds, *rest = measure(STOCK, stock)
        stock_rate = tell("nbgrader", stock_students * each, stock_seconds, *rest)
        wanted = points(stock, "student_0000")
        equal = all(points(ours, f"student_{number:04}") == wanted for number in (0, students // 2, students - 1))
        print(
            f"throughput ratio {rate / stock_rate:.1f}x (ours {rate:.0f} nb/min, nbgrader {stock_rate:.0f} nb/min), "
            f"scores equal: {'yes' if equal and wanted else 'no'}"
        )


def compare_with(revision, folder, students, rounds):
    """Grade a class from nothing as the code here does and as that of a revision does, in turn."""
    git = ["git", "-C", str(ROOT), "worktree"]
    subprocess.run([*git, "add", "--detach", "--quiet", str(folder / "revision"), revision], check=True)
    try:
        classes = {"now": make_class(folder / "now", students)}
        classes[revision] = make_class(folder / "then", students, folder / "revision")
        spent = dict.fromkeys(classes, 0.0)
        for _ in range(rounds):
            for name, course in classes.items():
                for made in (course.root / "gradebook.db", course.root / "autograded", course.reports):
                    shutil.rmtree(made, ignore_errors=True) if made.is_dir() else made.unlink(missing_ok=True)
                seconds, processor, peak = measure(OURS, course)
                tell(name[:10], students * len(course.notebooks), seconds, processor, peak)
                spent[name] += processor
        print(f"processor time: {spent[revision] / spent['now']:.2f} times less than {revision}")
    finally:
        subprocess.run([*git, "remove", "--force", str(folder / "revision")], check=True)


def profile(folder, times=10):
    """Where the time of one submission goes, by wall clock, one at a time."""
    from autograder.grading import grade as grading
    from autograder.grading import judge
    from autograder.intake.submission import submission_of
    from autograder.sandbox import host

    spent = {}

    def timed(name, place, attribute):
        function = getattr(place, attribute)

        def wrapper(*args, **kwargs):
            start = time.perf_counter()
            try:
                return function(*args, **kwargs)
            finally:
                spent[name] = spent.get(name, 0.0) + time.perf_counter() - start

        setattr(place, attribute, wrapper)

    course = make_class(folder / "profiled", 1)
    against = grading.grading_run(course, 1)
    with Writer(course) as writer:
        grading.grade_submission(submission_of(course, "student_0000"), against)  # the fork server loads
        timed("intake of notebooks", grading, "restore")
        timed("start of sandboxes", host.NotebookProcess, "__init__")
        timed("end of sandboxes", host.NotebookProcess, "__exit__")
        timed("students' cells", host.NotebookProcess, "run_cell")
        timed("snapshots", host.NotebookProcess, "snapshot")
        timed("snapshots", host.Snapshot, "meets")
        timed("students' functions, called", host.Snapshot, "_answer")
        timed("calls and comparison", judge.public_example, "answers")
        timed("calls and comparison", judge, "examine")
        start = time.perf_counter()
        for _ in range(times):
            submission = submission_of(course, "student_0000")
            graded = grading.grade_submission(submission, against)
            before = time.perf_counter()
            writer.record(graded)
            spent["gradebook and files"] = spent.get("gradebook and files", 0.0) + time.perf_counter() - before
        total = time.perf_counter() - start
    spent["comparison"] = spent.pop("calls and comparison") - spent["students' functions, called"]
    spent["the rest"] = total - sum(spent.values())
    print(f"one submission of {len(course.notebooks)} notebooks: {total / times * 1e3:.0f} ms")
    for name, seconds in sorted(spent.items(), key=lambda item: -item[1]):
        print(f"  {seconds / times * 1e3:6.1f} ms  {seconds / total:5.1%}  {name}")


def main():
    parser = argparse.ArgumentParser(description="How fast a class is graded, beside stock nbgrader.")
    parser.add_argument("--students", type=int, default=100)
    parser.add_argument("--nbgrader-students", type=int, default=6, help="for stock nbgrader (0: leave it out)")
    parser.add_argument("--growth", action="store_true", help="grade a tenth of the students first")
    parser.add_argument("--against", metavar="REV", help="grade as this revision does, too, in place of nbgrader")
    parser.add_argument("--rounds", type=int, default=3, help="with --against")
    parser.add_argument("--profile", action="store_true", help="only tell where the time of one submission goes")
    parser.add_argument("--smallest", action="store_true", help="do all of it with one student, to see that it works")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="benchmark-") as folder:
        if options.smallest:
            compare(Path(folder), 1, 1, growth=False)
            profile(Path(folder), times=1)
        elif options.against:
            compare_with(options.against, Path(folder), options.students, options.rounds)
        elif options.profile:
            profile(Path(folder))
        else:
            compare(Path(folder), options.students, options.nbgrader_students, options.growth)


if __name__ == "__main__":
    main()
