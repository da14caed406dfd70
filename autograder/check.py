"""`python3 -m autograder check`: one student's files, without submitted/ or a gradebook."""

import os

from .grading import assignment, grade_notebook, new_seed
from .intake import restore
from .judge import rows
from .submission import Submission, read


def check_files(course, paths, seed=None, isolated=True):
    """Grade notebook files: ([(Row, Verdict), …], [files that cannot be graded, in words], [what was mended, in words]).

    Python files beside the first notebook, which it may import, come along; the students' package is the course's own.
    Links are not followed: a student's would lead to the solutions, where these lie on the same machine.
    """
    found, refused, mended, fine = [], [], [], {}
    for path in paths:
        if not os.path.lexists(path):
            refused.append(f"{path}: there is no such file.")
        elif path.stem not in course.notebooks:
            names = ", ".join(f"{name}.ipynb" for name in course.notebooks)
            refused.append(f"{path}: no notebook of this assignment has that name; there are {names}.")
        elif path.stem in fine:
            refused.append(f"{path}: left out; {fine[path.stem]} is the same notebook.")
        else:
            fine[path.stem] = path
    contents = _read(fine.values(), refused)
    fine = {path.stem: content for path, content in contents.items()}
    if not fine:
        return found, refused, mended
    seed = new_seed() if seed is None else seed
    against = assignment(course, seed, isolated=isolated, notebooks=fine)
    folder = next(iter(contents)).parent
    submission = Submission("", {path.name: code for path, code in _read(sorted(folder.glob("*.py")), refused).items()})
    with against.sandbox(submission) as sandbox:
        for name, content in fine.items():
            released = course.notebooks[name]
            intake = restore(content, released)
            verdicts = grade_notebook(intake, released, against, sandbox, submission)
            mended += intake.problems
            found += [(row, verdicts[row.exercise]) for row in rows(released, verdicts)]
    return found, refused, mended


def _read(paths, refused):
    """{path: bytes} of the files that can be read; of the others it is said in `refused` why not."""
    contents = {}
    for path in paths:
        content, problem = read(path)
        if problem:
            refused.append(f"{path}: {problem}.")
        else:
            contents[path] = content
    return contents
