"""`python3 -m autograder check`: one student's files, without submitted/ or a gradebook."""

import re
from pathlib import Path

from transform_lab.judging import panel
from transform_lab.judging.verdict import Verdict

from ..intake.sorting import sort
from ..intake.submission import Submission, read, submission_of
from .grade import grading_run, judged, new_seed
from .judge import rows
from .records import missing

LONGEST = 300  # characters in a cell of the table


def check_files(course, paths, seed=None, isolated=True):
    """Grade notebook files, or all that is in one folder.

    Returns ([(Row, Verdict), …], [files that cannot be graded, in words], [what else there is to say]).
    In a folder, notebooks that are not there count as missing. Links are not followed: a student's repository could
    hold one to the solutions. The students' package is the course's own.
    """
    refused = []
    if len(paths) == 1 and paths[0].is_dir():
        submission, wanted = submission_of(course, "", paths[0]), list(course.notebooks)
    else:
        submission, wanted, refused = _submission(course, paths)
    found, said = [], list(submission.problems)
    if not wanted:
        return found, refused, said
    against = grading_run(course, new_seed() if seed is None else seed, isolated=isolated, notebooks=wanted)
    with against.sandbox(submission) as sandbox:
        for name in wanted:
            released, content = course.notebooks[name], submission.files.get(f"{name}.ipynb")
            if content is None:
                says = f"There is no {name}.ipynb to grade."
                found += [(row, Verdict(row.exercise, row.status, says=says)) for row in missing(released)]
                continue
            intake, verdicts, _ = judged(content, released, against, sandbox, submission)
            said += intake.problems
            found += [(row, verdicts[row.exercise]) for row in rows(released, verdicts)]
    return found, refused, said


def _submission(course, paths):
    """(Submission of these files and the Python files beside the first, names of its notebooks, [what is refused])"""
    refused, files = [], {}
    for path in paths:
        if path.is_dir():
            refused.append(f"{path}: a folder is checked by itself; give it alone, or name the notebooks in it.")
            continue
        content, problem = read(path)
        if problem:
            refused.append(f"{path}: {problem}." if path.is_file() else f"{path}: there is no such file.")
        else:
            files[str(path)] = content
    taken = sort(files, course.notebooks)
    for path in files.keys() - set(taken.sources.values()):
        lines = [line for line in taken.problems if line.startswith(f"{path}: ")]
        refused += lines or [f"{path}: it is no notebook of this assignment; there are {', '.join(course.notebooks)}."]
    of_folder = f"{Path(next(iter(taken.sources.values()), '')).parent}/: "  # which was given with the files
    problems = [line for line in taken.problems if line not in refused and not line.startswith(of_folder)]
    beside = {}
    for path in sorted(Path(next(iter(taken.sources.values()))).parent.glob("*.py")) if taken.sources else ():
        content, problem = read(path)
        if problem:
            problems.append(f"{path.name}: {problem}.")
        else:
            beside[path.name] = content
    notebooks = {f"{name}.ipynb": content for name, content in taken.notebooks.items()}
    return Submission("", beside | taken.helpers | notebooks, tuple(problems)), list(taken.notebooks), refused


def points(found):
    """(earned, most) of what `check_files` found."""
    return tuple(sum(getattr(row, name) for row, _ in found) for name in ("score", "max_score"))


def markdown(found, lines):
    """What `check_files` found as GitHub shows it (text): the points, a table, and the lines that there are to say."""
    earned, most = points(found)
    text = [f"**{earned:g} of {most:g} points**", "", "| notebook | exercise | points | |", "|---|---|---|---|"]
    for row, verdict in found:
        cells = row.notebook, row.exercise, f"{row.score:g} of {row.max_score:g}", panel.summary(verdict)
        text.append(f"| {' | '.join(map(_plain, cells))} |")
    text += ["", *(f"- {_plain(line)}" for line in lines)]
    return "\n".join(text) + "\n"


def _plain(text):
    """Text of anybody's as one line of Markdown that shows just it: no character left that means something there."""
    text = " ".join(text.split())
    text = text if len(text) <= LONGEST else f"{text[:LONGEST]}…"
    return re.sub(r"[^\w ,()…]|_", lambda found: f"&#{ord(found[0])};", text)
