"""Grades one submission on Gradescope: `python3 -m autograder.handout.gradescope SUBMISSION RESULTS`, called by run_autograder.

SUBMISSION is the folder with the student's files, RESULTS the file that Gradescope reads. Its format is that of
https://gradescope-autograders.readthedocs.io/en/latest/specs/: whatever happens, a valid one is written.
"""

import json
import sys
import traceback
from pathlib import Path

from transform_lab.judging import panel

from .. import sandbox
from ..course import Course
from ..files import replace
from ..grading.one_student import check_files
from ..untrusted import printable

ROOT = Path(__file__).resolve().parents[2]
NOT_GRADED = (
    "This submission was not graded, and that is not because of your files. Please tell your instructor: "
    "the reason stands in the autograder's output."
)


def main(submission, results):
    """Grade, and write the results; what is printed is for the instructor."""
    try:
        outcome = grade(Course(ROOT), submission)
    except Exception:  # whatever it is: the student has to read something
        traceback.print_exc()
        outcome = {"score": 0.0, "output": NOT_GRADED}
    replace(results, json.dumps({**outcome, "stdout_visibility": "hidden"}) + "\n")


def grade(course, folder):
    """The results of the files in `folder`, as the dictionary that Gradescope's format describes."""
    isolated, problem = protection(course.root)
    if problem:
        print(problem, file=sys.stderr)
        return {"score": 0.0, "output": NOT_GRADED}
    found, _, notes = check_files(course, [folder], isolated=isolated)
    entries = {row.exercise: _entry(row, panel.text(verdict, numbers=False)) for row, verdict in found}
    notes += by_hand(course)
    tests = [entries[exercise] for released in course.notebooks.values() for exercise in released.points]
    return {
        "score": round(sum(test["score"] for test in tests), 2),
        "output": printable("\n".join(notes)),
        "output_format": "text",
        "visibility": "visible",
        "tests": tests,
    }


def protection(root):
    """(how students' code is kept apart here, for Sandbox; why it must not be run at all or None)."""
    refused = sandbox.refusal(root)
    if refused is None:
        return True, None
    also = sandbox.refusal_as_user(root)
    return "user", also and f"{refused}\n{also}"


def by_hand(course):
    """What to say of the questions that have points and no test."""
    points = [most for released in course.notebooks.values() for most in released.questions.values()]
    if not points:
        return []
    which, are = ("written question", "is") if len(points) == 1 else (f"{len(points)} written questions", "are")
    return [f"The {which} ({sum(points):g} points) {are} graded by hand and not counted here."]


def _entry(row, text):
    """A Row as one of Gradescope's tests."""
    return {
        "name": f"{row.notebook}: {row.exercise}",
        "score": row.score,
        "max_score": row.max_score,
        "status": "passed" if row.score == row.max_score else "failed",
        "output": printable(text),
        "output_format": "text",
        "visibility": "visible",
    }


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
