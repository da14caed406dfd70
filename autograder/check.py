"""`python3 -m autograder check`: one student's files, without submitted/ or a gradebook."""

from transform_lab import panel

from .grading import assignment, grade_notebook, new_seed
from .intake import restore
from .judge import rows
from .submission import Submission


def check_files(course, paths, seed=None, isolated=True):
    """Grade notebook files: ([(Row, what was found in words), …], [files that cannot be graded], [what was mended]).

    Python files beside the first notebook, which it may import, come along; the students' package is the course's own.
    """
    found, refused, mended, fine = [], [], [], {}
    for path in paths:
        if not path.is_file():
            refused.append(f"{path}: there is no such file.")
        elif path.stem not in course.notebooks:
            names = ", ".join(f"{name}.ipynb" for name in course.notebooks)
            refused.append(f"{path}: no notebook of this assignment has that name; there are {names}.")
        elif path.stem in fine:
            refused.append(f"{path}: left out; {fine[path.stem]} is the same notebook.")
        else:
            fine[path.stem] = path
    if not fine:
        return found, refused, mended
    seed = new_seed() if seed is None else seed
    against = assignment(course, seed, isolated=isolated, notebooks=fine)
    folder = next(iter(fine.values())).parent
    submission = Submission("", {path.name: path.read_bytes() for path in sorted(folder.glob("*.py"))})
    with against.sandbox(submission) as sandbox:
        for name, path in fine.items():
            released = course.notebooks[name]
            intake = restore(path.read_bytes(), released)
            verdicts = grade_notebook(intake, released, against, sandbox, submission)
            mended += intake.problems
            found += [(row, panel.summary(verdicts[row.exercise])) for row in rows(released, verdicts)]
    return found, refused, mended
