"""Every exercise solved with another library, in its own types, and graded in the real sandbox: full points.

Each file of solutions/ is what a student writes who knows that library. Its first lines are imports and helpers of its own.
"""

import ast
import subprocess
from collections import defaultdict
from pathlib import Path

import nbformat
import pytest
from editing import solve
from support import ASKED, PATIENCE, verdicts

HERE = Path(__file__).parent / "solutions"
LIBRARIES = [path.stem for path in sorted(HERE.glob("*.py"))]
# {(library, exercise): the misconception that the library's own way of solving it has}; its file says what is wrong there
MISTAKES = {
    ("with_pytransform3d", "is_rotation"): "default-tolerance",
    ("with_trimesh", "is_rotation"): "reflection-accepted",
    ("with_sympy", "transform_to_pose"): "trace-formula-only",
    ("with_sympy", "transform_pose"): "trace-formula-only",
}


def with_solutions(path, names):
    """{exercise: code} for the exercises of a notebook: the first has all that the file has, the others their function."""
    text = path.read_text(encoding="utf-8")
    functions = {
        node.name: ast.get_source_segment(text, node)
        for node in ast.parse(text).body
        if isinstance(node, ast.FunctionDef)
    }
    first, *others = names
    return {first: text, **{name: functions[name] for name in others}}


@pytest.fixture(scope="module")
def graded(libraries, sandboxed, released, hand_in, made_once):
    """{library: {exercise: row of verdicts.csv}}, as `grade` has it when the libraries are in its environment."""
    import shutil

    from autograder.course import Course

    def make(folder):
        shutil.copytree(released.root, folder, dirs_exist_ok=True)
        course = Course(folder)
        for library in LIBRARIES:
            notebooks = {}
            for name, asked in ASKED.items():
                notebook = nbformat.read(course.release / f"{name}.ipynb", 4)
                for exercise, code in with_solutions(HERE / f"{library}.py", list(asked.points)).items():
                    solve(notebook, exercise, code)
                notebooks[name] = notebook
            hand_in(course, library, notebooks)
        command = [libraries.python, "-m", "autograder", "grade", "--no-feedback"]
        ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, timeout=4 * PATIENCE)
        assert ran.returncode == 0, ran.stdout + ran.stderr

    rows = defaultdict(dict)
    for row in verdicts(Course(made_once("solved-with-libraries", make))):
        rows[row["student"]][row["exercise"]] = row
    return rows


def test_every_exercise_is_solved_with_every_library():
    for library in LIBRARIES:
        tree = ast.parse((HERE / f"{library}.py").read_text(encoding="utf-8"))
        written = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
        assert written >= {name for asked in ASKED.values() for name in asked.points}, library


@pytest.mark.parametrize("library", LIBRARIES)
def test_full_points(graded, library):
    rows = graded[library]
    assert len(rows) == sum(len(asked.points) for asked in ASKED.values())
    for exercise, row in rows.items():
        mistake = MISTAKES.get((library, exercise), "")
        full = float(row["score"]) == float(row["max_score"])
        assert (row["status"], row["misconception"], full) == ("graded", mistake, not mistake), row
