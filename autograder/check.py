"""`python3 -m autograder check`: one student's files, without a course's folders or a gradebook."""

from transform_lab import panel

from .grading import Submission, assignment, new_seed
from .intake import restore
from .judge import judge, rows


def check_files(course, paths, seed=None, isolated=True):
    """Grade notebook files: ([(Row, what was found in words), …], [what is wrong with the files]).

    Python files beside the first notebook, which it may import, come along; the students' package is the course's own.
    """
    against = assignment(course, new_seed() if seed is None else seed, isolated=isolated)
    found, problems = [], []
    fine = [path for path in paths if path.is_file() and path.stem in course.notebooks]
    for path in (path for path in paths if path not in fine):
        names = ", ".join(f"{name}.ipynb" for name in course.notebooks)
        wrong = (
            f"no notebook of this assignment has that name; there are {names}"
            if path.is_file()
            else "there is no such file"
        )
        problems.append(f"{path}: {wrong}.")
    if not fine:
        return found, problems
    beside = {path.name: path.read_bytes() for path in sorted(fine[0].parent.glob("*.py"))}
    with against.sandbox(Submission("", beside)) as sandbox:
        for path in fine:
            released = course.notebooks[path.stem]
            intake = restore(path.read_bytes(), released)
            verdicts = judge(intake, released, against.keys, sandbox)
            problems += intake.problems
            found += [(row, panel.summary(verdicts[row.exercise])) for row in rows(released, verdicts)]
    return found, problems
