"""What a class costs after it is graded: feedback, the report, and `grade` with nothing new.

    .venv/bin/python tests/benchmark_pages.py --students 300 --nbgrader-students 6

The class is the demo's, with its mistakes, as often as it takes. Feedback is compared with what grading took, and with stock
nbgrader's `generate_feedback` of some of the same graded notebooks; a tenth of the class is measured, too, for growth. All are
processor seconds of the processes themselves, which hardly depend on what else a machine does.
"""

import argparse
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmark_grading import make_class
from support import without_plugin

from autograder.course import ASSIGNMENT, Course
from autograder.demo import enroll

SMALLEST = (2, 1)  # students, and those for nbgrader


def processor(course, *command):
    """Run a Python module in a course; (processor seconds of it and its children, what it printed)."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [sys.executable, "-m", *command], cwd=course.root, stdin=subprocess.DEVNULL, capture_output=True, text=True
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{(done.stdout + done.stderr)[-3000:]}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout


def enrolled(folder, students):
    """A released course in which so many have handed in what the demo's students do."""
    course = make_class(folder, 0)
    made = enroll(course)
    for number in range(students):
        shutil.copytree(
            course.root / "submitted" / made[number % len(made)], course.root / "submitted" / f"s{number:04}"
        )
    for student in made:
        shutil.rmtree(course.root / "submitted" / student)
    return course


def tell(name, seconds, students):
    print(f"{name:42} {seconds:8.2f} CPU s  {1000 * seconds / students:8.1f} ms a student", flush=True)


def ours(folder, students):
    """Measure a class of ours; (its Course, processor seconds that feedback takes)."""
    course = enrolled(folder, students)
    graded, _ = processor(course, "autograder", "grade", "--no-feedback")
    tell(f"{students} students: grade --no-feedback", graded, students)
    feedback, said = processor(course, "autograder", "grade")
    assert f"0 graded, {students} unchanged" in said, said
    tell("grade, which makes the feedback alone", feedback, students)
    nothing, said = processor(course, "autograder", "grade")
    assert f"0 graded, {students} unchanged" in said, said
    tell("grade, with nothing new", nothing, students)
    tell("report", processor(course, "autograder", "report")[0], students)
    tell("grade, with nothing new since a report", processor(course, "autograder", "grade")[0], students)
    print(f"feedback takes {feedback / graded:.2f} times what grading takes")
    return course, feedback


def stock(course, folder, students):
    """Processor seconds of nbgrader's generate_feedback for some students of a graded class."""
    copied = Course(shutil.copytree(course.root, folder))
    shutil.rmtree(copied.root / "feedback")
    for path in sorted((copied.root / "autograded").iterdir())[students:]:
        shutil.rmtree(path)
    without_plugin(copied)
    return processor(copied, "nbgrader", "generate_feedback", ASSIGNMENT)[0]


def main():
    parser = argparse.ArgumentParser(description="What a class costs after it is graded.")
    parser.add_argument("--students", type=int, default=300)
    parser.add_argument("--nbgrader-students", type=int, default=6, help="for stock nbgrader (0: leave it out)")
    parser.add_argument("--smallest", action="store_true", help="do all of it with two students, to see that it works")
    options = parser.parse_args()
    students, others = SMALLEST if options.smallest else (options.students, options.nbgrader_students)
    with tempfile.TemporaryDirectory(prefix="benchmark-") as folder:
        if students >= 10:
            ours(Path(folder, "tenth"), students // 10)
        course, feedback = ours(Path(folder, "class"), students)
        if others:
            seconds = stock(course, Path(folder, "stock"), others)
            tell(f"nbgrader generate_feedback, {others} students", seconds, others)
            print(f"feedback ratio {(seconds / others) / (feedback / students):.1f}x")


if __name__ == "__main__":
    main()
