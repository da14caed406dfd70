"""The assignment as the gradebook knows it: notebooks, and in them the cells that nbgrader keeps, with their points.

The gradebook follows the notebooks as long as nobody's work is in it. After that, nbgrader takes other points, and neither
takes a cell or a notebook out nor puts one in.
"""

import copy

from nbgrader import utils
from nbgrader.api import Assignment, Comment, Grade, MissingEntry, SubmittedAssignment, SubmittedNotebook
from nbgrader.preprocessors import SaveCells
from sqlalchemy import func, select

from ..course import ASSIGNMENT, CourseError

KINDS = {"grade": utils.is_grade, "solution": utils.is_solution, "task": utils.is_task, "source": None}


def follow(gradebook, notebooks, config, db_url):
    """Have the gradebook know {name: Released}; raises CourseError when nbgrader would not, because of what is in it.

    This is the step of nbgrader's generate_assignment that fills the gradebook; the notebooks stay as they are.
    """
    known = _known(gradebook)
    if known == _asked(notebooks):
        return
    refuse_to_lose(gradebook, notebooks)
    gradebook.update_or_create_assignment(ASSIGNMENT)
    for name in known.keys() - notebooks.keys():
        gradebook.remove_notebook(name, ASSIGNMENT)
    gradebook.db.commit()
    for name, notebook in notebooks.items():
        resources = {"notebook": name, "assignment": ASSIGNMENT, "db_url": db_url}
        SaveCells(config=config).preprocess(copy.deepcopy(notebook.notebook), {"nbgrader": resources})
    gradebook.db.expire_all()  # another session has written


def refuse_to_lose(gradebook, notebooks):
    """Raise CourseError when {name: Released} have other cells than the gradebook holds students' grades of."""
    changes = _changes({name: set(cells) for name, cells in _known(gradebook).items()}, _asked(notebooks))
    students = gradebook.assignment_submissions(ASSIGNMENT) if changes else []
    if not students:
        return
    whose = f"{len(students)} student{'s' if len(students) > 1 else ''}"
    lines = "\n".join(f"  {change}." for change in changes)
    raise CourseError(
        f"The gradebook holds the work of {whose}, and nbgrader then adds and removes no cells:\n{lines}\n"
        "Points may change at any time: an exercise that is not to count any more keeps its cells, and gets 0 points. "
        "The demo's class goes by `python3 -m autograder demo --remove`. Otherwise undo this change; or begin a new gradebook:\n"
        f"  1. Keep a copy of the old one: grades and comments that people gave ({_by_hand(gradebook)}) will be lost.\n"
        f"  2. `nbgrader db assignment remove {ASSIGNMENT} --force`, then `python3 -m autograder release`.\n"
        "  3. `python3 -m autograder grade` grades all that is in submitted/ anew, and you grade the questions again.\n"
        "In what was handed in before, a new question counts as not answered."
    )


def _known(gradebook):
    """{notebook: {(kind, cell): points or None}} as the gradebook has them; {} when it does not know the assignment."""
    try:
        notebooks = gradebook.find_assignment(ASSIGNMENT).notebooks
    except MissingEntry:
        return {}
    return {
        notebook.name: {
            (kind, cell.name): getattr(cell, "max_score", None)
            for kind in KINDS
            for cell in getattr(notebook, f"{kind}_cells")
        }
        for notebook in notebooks
    }


def _asked(notebooks):
    """The same of {name: Released}, as nbgrader's SaveCells would record them."""
    found = {}
    for name, notebook in notebooks.items():
        found[name] = cells = {}
        for grade_id, cell in notebook.cells.items():
            kinds = [kind for kind, holds in KINDS.items() if holds and holds(cell)]
            if kinds or utils.is_locked(cell):
                cells["source", grade_id] = None
            for kind in kinds:
                cells[kind, grade_id] = None if kind == "solution" else float(cell.metadata.nbgrader.points)
    return found


def _changes(known, asked):
    """In words, what is in one and not in the other; points do not count."""
    found = [f"{name}.ipynb is no longer there" for name in known if name not in asked]
    for name, cells in asked.items():
        if name not in known:
            found.append(f"{name}.ipynb is new")
            continue
        gone, new = known[name] - cells.keys(), cells.keys() - known[name]
        names = list(dict.fromkeys(cell for _, cell in sorted(gone | new)))
        for cell in names:
            here, there = (any(cell == other for _, other in of) for of in (cells, known[name]))
            what = "is graded in another way" if here and there else "is new" if here else "is no longer there"
            found.append(f"{name}.ipynb: {cell} {what}")
    return found


def _by_hand(gradebook):
    """How many grades and comments people gave, in words."""
    counts = []
    for table, column in ((Grade, Grade.manual_score), (Comment, Comment.manual_comment)):
        of = select(func.count()).select_from(table).join(SubmittedNotebook, SubmittedNotebook.id == table.notebook_id)
        of = of.join(SubmittedAssignment, SubmittedAssignment.id == SubmittedNotebook.assignment_id)
        of = of.join(Assignment, Assignment.id == SubmittedAssignment.assignment_id)
        counts.append(gradebook.db.execute(of.where(Assignment.name == ASSIGNMENT, column.is_not(None))).scalar())
    return f"{counts[0]} and {counts[1]} now"
