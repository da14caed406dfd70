"""A cell that stopped: what depends on it names that cell and its error, not its consequence."""

import json

import pytest
from editing import solution
from support import ROOT

from autograder.course import Course
from autograder.grading.failed_cells import FailedCell, explained
from autograder.grading.grade import grade_submission, grading_run
from autograder.intake.submission import Submission
from autograder.sandbox import Limits

NAME = "3_chaining"
SOLUTION = "def chain(*transforms):\n    return helper(transforms)"


def notebook(imports=None, chain=None, above=None):
    """A solved notebook, in which one cell is another: that with the imports, the solution, or one above it."""
    raw = solution(NAME)
    cells = raw["cells"]
    place = next(
        i for i, c in enumerate(cells) if c["metadata"].get("nbgrader", {}).get("grade_id") == "chain-solution"
    )
    if chain is not None:
        cells[place]["source"] = chain
    if imports is not None:
        cells[1]["source"] = imports + "".join(cells[1]["source"])
    if above is not None:
        cells.insert(place, {"cell_type": "code", "metadata": {}, "source": above})
    return json.dumps(raw).encode()


@pytest.fixture(scope="module")
def grade(sandboxed):
    run = grading_run(Course(ROOT), 7, limits=Limits(cell=5), notebooks=[NAME])

    def graded(content):
        found = grade_submission(Submission("ann", {f"{NAME}.ipynb": content}), run)
        notebook = json.loads(found.notebooks[NAME])
        told = notebook["metadata"]["transform_lab"]["verdicts"]["chain"]["mistakes"]
        return {row.exercise: row for row in found.rows}, " ".join(
            words for says, hint, _ in told for words in (says, hint)
        )

    return graded


@pytest.mark.parametrize(
    "imports",
    [
        "%matplotlib widget\n",
        "from google.colab import drive\ndrive.mount('/content/drive')\n",
        "import a_library_that_is_not_here\n",
        "x =\u00a01\n",
        "import tensorflow.keras as k\n",
    ],
    ids=["widget", "Colab", "library", "no-break space", "another library"],
)
def test_released_imports_are_there_whatever_stands_above_them(grade, imports):
    rows, _ = grade(notebook(imports))
    assert all(row.score == row.max_score for row in rows.values() if row.notebook == NAME)


STOPPED = {  # {kind: (the solution's cell, what is said of it)}
    "indentation": (
        "def chain(*transforms):\n  x = 1\n   return x",
        "`chain` could not be defined, because the cell that begins with `def chain(*transforms):` stopped with "
        "IndentationError: unexpected indent, in its line 3.",
    ),
    "no-break space": (
        "def chain(*transforms):\n    x =\u00a01",
        "SyntaxError: invalid non-printable character U+00A0, in its line 2.",
    ),
    "conflict": (
        "<<<<<<< HEAD\ndef chain(*t):\n    return 1\n=======\n>>>>>>> 5f",
        "SyntaxError: a merge has left its conflict marks in it",
    ),
    "import": (
        "import pandas_is_not_here\n" + SOLUTION,
        "begins with `import pandas_is_not_here` stopped with ModuleNotFoundError: No module named",
    ),
    "magic": ("%matplotlib widget\n" + SOLUTION, "begins with `%matplotlib widget` stopped with"),
    "star import": (
        "from mine_is_not_here import *",
        "begins with `from mine_is_not_here import *` stopped with ModuleNotFoundError",
    ),
    "indented by one": ("x = 1\n " + SOLUTION, "begins with `x = 1` stopped with IndentationError"),
    "in a block": (
        "if True:\n    def chain(*t):\n        return 1\n    print('x'",
        "begins with `if True:` stopped with SyntaxError",
    ),
    "unknown magic": (
        "%%no_such_magic\n" + SOLUTION,
        "begins with `%%no_such_magic` stopped with UsageError: Cell magic",
    ),
    "time limit": (
        "while True:\n    pass\n" + SOLUTION,
        "begins with `while True:` had to be stopped: it took too long",
    ),
    "killed": (
        "import os\nos.kill(os.getpid(), 9)\n" + SOLUTION,
        "begins with `import os` had to be stopped: its process ended",
    ),
}


@pytest.mark.parametrize("kind", STOPPED)
def test_the_cell_of_the_solution_stopped(grade, kind):
    chain, words = STOPPED[kind]
    rows, told = grade(notebook(chain=chain))
    assert rows["chain"].status == "error" and words in told and "There is no function" not in told
    assert rows["transform_pose"].score == rows["transform_pose"].max_score


NOT_KEPT = {  # {kind: (the solution's cell, what helps)}
    "another name": (
        SOLUTION.replace("chain", "chain_all"),
        "Its cell defines `chain_all`: give the function its own name again, `chain`.",
    ),
    "another letter": (SOLUTION.replace("chain", "\u0441hain"), "(its `\u0441` is cyrillic small letter es): give"),
    "timeit": ("%%timeit -n1 -r1\n" + SOLUTION, "begins with `%%timeit`, which keeps what it defines to itself"),
    "another value": (
        SOLUTION + "\nchain = [1, 2]",
        "Its cell defines `chain`, and another cell then removes the name",
    ),
}


@pytest.mark.parametrize("kind", NOT_KEPT)
def test_a_function_that_is_not_there_though_no_cell_failed(grade, kind):
    chain, words = NOT_KEPT[kind]
    rows, told = grade(notebook(chain=chain))
    assert rows["chain"].status == "error" and words in told


def test_what_it_uses_is_not_there(grade):
    above = "import pandas_is_not_here as pd\ndef helper(transforms):\n    return transforms[0]"
    rows, told = grade(notebook(chain=SOLUTION, above=above))
    assert rows["chain"].status == "error"
    assert (
        "`helper` is not there, because the cell that begins with `import pandas_is_not_here as pd` stopped with"
        in told
    )
    assert "from the top" in told


def test_of_errors_that_follow_from_each_other_the_first_is_named():
    from transform_lab.judging.verdict import Verdict

    first = FailedCell("import gone\nbase = gone.base()", "stopped with ModuleNotFoundError: No module named 'gone'")
    second = FailedCell("offset = base + 1", "stopped with NameError: name 'base' is not defined")
    verdict = Verdict("chain", "error", error="NameError: name 'offset' is not defined, in your line 1")
    assert "begins with `import gone` stopped with ModuleNotFoundError" in explained(verdict, [first, second]).says
    assert explained(verdict, []) == verdict
