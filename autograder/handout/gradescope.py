"""Grades one submission on Gradescope: `python3 -m autograder.handout.gradescope SUBMISSION RESULTS`, called by run_autograder.

SUBMISSION is the folder with the student's files, RESULTS the file that Gradescope reads. Its format is that of
https://gradescope-autograders.readthedocs.io/en/latest/specs/: whatever happens, a valid one is written.
"""

import json
import os
import sys
import traceback
from pathlib import Path

from transform_lab.judging import panel

from .. import sandbox
from ..course import Course
from ..files import replace
from ..grading.one_student import check_files
from ..grading.records import missing
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
    paths, notes = notebooks(folder, course.notebooks)
    found, refused, mended = check_files(course, paths, isolated=isolated)
    entries = {row.exercise: _entry(row, panel.text(verdict, numbers=False)) for row, verdict in found}
    for name, released in course.notebooks.items():
        for row in missing(released):
            entries.setdefault(row.exercise, _entry(row, f"There is no {name}.ipynb to grade."))
    notes += [line.replace(f"{folder}{os.sep}", "") for line in refused] + mended + by_hand(course)
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


def notebooks(folder, names):
    """([the notebooks of these names in a submission], [what to say of its files]).

    They lie in the folder itself or, when a folder was zipped, in one below it: the first that has any.
    """
    for here, folders, files in os.walk(folder):  # follows no link
        folders[:] = sorted(name for name in folders if not name.startswith((".", "__MACOSX")))
        found = [f"{name}.ipynb" for name in names if f"{name}.ipynb" in files]
        if found:
            others = sorted(name for name in files if name.endswith(".ipynb") and name not in found)
            return [Path(here, name) for name in found], [_unknown(name, names) for name in others]
    wanted = ", ".join(f"{name}.ipynb" for name in names)
    return [], [f"No notebook of this assignment was found. Hand them in under their own names: {wanted}."]


def by_hand(course):
    """What to say of the questions that have points and no test."""
    points = [most for released in course.notebooks.values() for most in released.questions.values()]
    if not points:
        return []
    which, are = ("written question", "is") if len(points) == 1 else (f"{len(points)} written questions", "are")
    return [f"The {which} ({sum(points):g} points) {are} graded by hand and not counted here."]


def _unknown(name, names):
    wanted = ", ".join(f"{released}.ipynb" for released in names)
    return f"{name}: no notebook of this assignment has that name, so it was not graded; there are {wanted}."


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
