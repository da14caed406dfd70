"""The notebooks in `source/`, as instructors write them, looked through before nbgrader makes the students' notebooks.

What is asked, and for how many points, is said by nbgrader's cells. Headings and the opening line say it again, for students to
read; all that does not agree is told at once, in words that name the notebook and the cell.
"""

import copy
import difflib
import re
from collections import Counter
from dataclasses import dataclass

from nbgrader.nbgraderformat import MetadataValidator, SchemaTooNewError, SchemaTooOldError, ValidationError
from nbgrader.preprocessors import ClearSolutions

from ..bridge.settings import settings
from ..course import ASSIGNMENT, CourseError
from ..exercises import EXERCISES
from ..released import POINTS, NotANotebook, read

# A heading that announces a graded cell, or says points.
HEADING = re.compile(rf"^#+ (?P<title>(?:Exercise: `(?P<exercise>\w+)`)?.*?)(?:{POINTS[:-1]})?$", re.MULTILINE)
OPENING = re.compile(r"\b(\d+(?:\.\d+)?)\s+points?\.")


def notebooks(course):
    """{name: Released} of the notebooks in source/, in order; raises CourseError that says all there is to put right."""
    found, problems = {}, []
    for path in sorted(course.source.glob("*.ipynb")):
        try:
            notebook = read(path)
        except NotANotebook as error:
            problems.append(str(error))
            continue
        found[notebook.name] = notebook
        wrong = list(_cells(course, notebook)) or [line for look in LOOKS for line in look(notebook)]
        problems += [f"{path.name}{says}" for says in wrong]
    if not (found or problems):
        problems.append("there is no notebook in it")
    if not problems:
        asked = Counter(name for notebook in found.values() for name in notebook.points)
        for name in (name for name, times in asked.items() if times > 1):
            where = [notebook.name for notebook in found.values() if name in notebook.points]
            problems.append(f"{name} is tested in {' and '.join(where)}: an exercise belongs to one notebook")
    if problems:
        lines = "\n".join(f"  {problem}." for problem in problems)
        raise CourseError(f"source/{ASSIGNMENT} has to be put right, and notebooks/ is as before:\n{lines}")
    return found


def _cells(course, notebook):
    """What nbgrader itself would stop at, cell by cell: its metadata, and marked solutions."""
    validator, clear = MetadataValidator(), ClearSolutions(config=settings(course))
    language = notebook.notebook.metadata.get("kernelspec", {}).get("language", "python")
    for number, cell in enumerate(notebook.notebook.cells, 1):
        try:
            validator.validate_cell(cell)
            clear.preprocess_cell(copy.deepcopy(cell), {"language": language}, number)
        except ValidationError as error:
            place = "".join(f"{name}: " for name in error.relative_path)
            yield f", cell {number}: nbgrader's metadata: {place}{error.message.splitlines()[0]}"
        except SchemaTooOldError:
            yield f", cell {number}: nbgrader's metadata are of an older nbgrader: run `nbgrader update source/{ASSIGNMENT}`"
        except SchemaTooNewError as error:
            yield f", cell {number}: nbgrader's metadata are of a newer nbgrader: {error}"
        except RuntimeError as error:
            yield f", cell {number}: {str(error).split(';')[0].rstrip('.')}"


def _names(notebook):
    """Whether each cell that nbgrader grades is what its name says."""
    given = [cell.metadata.nbgrader for cell in notebook.notebook.cells if cell.metadata.get("nbgrader")]
    for name, times in Counter(nbgrader.grade_id for nbgrader in given).items():
        if times > 1:
            yield f": {times} cells have the grade_id {name}: each needs one of its own"
    for name, cell in notebook.cells.items():
        nbgrader = cell.metadata.nbgrader
        exercise = name.removesuffix("-solution")
        if nbgrader.get("task"):
            yield f": {name} is one of nbgrader's tasks; make it a manually graded answer, which is graded by hand as well"
        elif nbgrader.grade and nbgrader.solution and name in EXERCISES:
            yield f": {name} is graded by hand, and called as an exercise of autograder/exercises: give it another grade_id"
        elif nbgrader.grade and not nbgrader.solution and name not in EXERCISES:
            near = difflib.get_close_matches(name, EXERCISES, 1)
            meant = f"; did you mean {near[0]}?" if near else ""
            yield (
                f": the test cell {name} has no exercise of this name in autograder/exercises{meant} "
                "(What a person grades is made a manually graded answer.)"
            )
        elif nbgrader.grade and not nbgrader.solution and cell.source.strip() != f'check("{name}", {name})':
            yield f': the test cell {name} has to be the one line check("{name}", {name}), which is what is graded'
        elif exercise != name and exercise in EXERCISES and exercise not in notebook.points:
            yield f": {name} is there without a test cell {exercise}: take both out (and the heading), or neither"


@dataclass
class _Heading:
    """One that announces a graded cell: its text, the exercise it names or None, and the points it says or None."""

    title: str
    exercise: str | None
    points: float | None


def _uses(notebook):
    """Whether the other code cells use the notebook's own exercises, and sum up this notebook."""
    code = [(number, cell.source) for number, cell in enumerate(notebook.notebook.cells, 1) if cell.cell_type == "code"]
    defined = set(re.findall(r"^\s*def (\w+)|^(\w+) *=", "\n".join(text for _, text in code), re.MULTILINE))
    known = {*notebook.points, *(name for names in defined for name in names)}
    for number, text in code:
        for name in dict.fromkeys(re.findall(r"(?<![\w.])\w+\b", text)):
            if name in EXERCISES and name not in known:
                yield f", cell {number}: it uses {name}, which is no exercise of this notebook: change the cell, or take it out"
        for name in re.findall(r"""sum_up\(["'](.*?)["']\)""", text):
            if name != notebook.name:
                yield f', cell {number}: it has to be sum_up("{notebook.name}"), the name of the notebook'


def _headings(notebook):
    """Whether each graded cell has a heading above it that says its points, and each such heading a graded cell."""
    announced = None
    for cell in notebook.notebook.cells:
        if cell.cell_type == "markdown":
            for heading in _announcing(cell):
                if announced:
                    yield _without_cell(announced)
                announced = heading
        nbgrader = cell.metadata.get("nbgrader")
        if nbgrader and nbgrader.grade:
            yield from _compared(nbgrader.grade_id, float(nbgrader.points), announced, notebook)
            announced = None
    if announced:
        yield _without_cell(announced)


def _announcing(cell):
    for match in HEADING.finditer(cell.source):
        if match[3] or match["title"].startswith(("Exercise: ", "Question: ")):
            yield _Heading(match["title"], match["exercise"], match[3] and float(match[3]))


def _without_cell(heading):
    return f": the heading “{heading.title}” has no graded cell below it: take it out, too, or its points"


def _compared(name, points, heading, notebook):
    wanted = f"### Exercise: `{name}`" if name in notebook.points else "## Question: …"
    if heading is None:
        yield f": {name} has no heading: write `{wanted} ({_said(points)})` above it"
    elif name in notebook.points and heading.exercise != name:
        yield f": the heading above {name} is “{heading.title}”; it should be “{wanted[4:]}”"
    elif heading.points != points:
        says = "no points" if heading.points is None else _said(heading.points)
        yield f": the heading “{heading.title}” says {says}, the cell {name} {_said(points)}"


def _opening(notebook):
    """Whether the points that the first cell says, as in "About 40 minutes, 7 points.", are all that can be earned."""
    first = next((cell.source for cell in notebook.notebook.cells if cell.cell_type == "markdown"), "")
    most = sum(notebook.points.values()) + sum(notebook.questions.values())
    for said in map(float, OPENING.findall(first)):
        if said != most:
            yield f": its opening says {_said(said)}, its cells {_said(most)} in all"


LOOKS = (_names, _uses, _headings, _opening)


def _said(points):
    return f"{points:g} point{'' if points == 1 else 's'}"
