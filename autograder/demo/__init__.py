"""A class of made-up students, to see the grading at work before anybody has handed anything in.

Each student is one file in `students/`, written to be read: the docstring says who they are and what they got wrong,
and every function is their answer to the exercise of that name (an exercise without a function is left undone). Other
functions, constants and imports are theirs, too; they go into the cell that first uses them. Besides, a file may hold

    ANSWERS = {"question-which-frame": "…"}     # hand-graded questions; one that is not here is left empty
    EXTRA_CELLS = {"chain": "print(…)"}         # a cell of their own, after the test cell of that exercise
    MISSING = ["5_pre_grasp"]                   # notebooks that were not handed in
    BROKEN = ["3_chaining"]                     # notebooks whose file is cut off in the middle

The files are data: they are parsed, never run. What they say ends up in submitted/, and is graded like any other work.
"""

import ast
import copy
import re
import shutil
from pathlib import Path

import nbformat

from ..exercises import EXERCISES

STUDENTS = Path(__file__).parent / "students"
PREFIX = "demo_"
LITERALS: dict = {"ANSWERS": {}, "EXTRA_CELLS": {}, "MISSING": [], "BROKEN": []}


def is_demo(student):
    """Whether a folder's name in submitted/ is that of a made-up student."""
    return student.startswith(PREFIX)


def enroll(course):
    """Put the class into submitted/, as if all had handed in their work; the students' names.

    Needs a released assignment (CourseError if there is none). Whatever a made-up student had handed in before is
    replaced; the same release gives the same files.
    """
    asked = {name for released in course.notebooks.values() for name in released.points}
    students = [Student(path) for path in sorted(STUDENTS.glob("*.py"))]
    for student in students:
        folder = course.submitted(student.name)
        if folder.exists():
            shutil.rmtree(folder)
        shutil.copytree(course.package, folder / course.package.name, ignore=shutil.ignore_patterns("__pycache__"))
        for name, released in course.notebooks.items():
            if name not in student.missing:
                (folder / f"{name}.ipynb").write_text(student.hand_in(released, asked), encoding="utf-8")
    return [student.name for student in students]


class Student:
    """One made-up student, read from a file in students/.

    name: of the folder in submitted/
    about: who they are and what they got wrong
    definitions: {name: statement} of all that the file imports, defines or assigns, but for the literals
    answers, extra_cells, missing, broken: see the package's docstring
    """

    def __init__(self, path):
        self.name = PREFIX + path.stem
        self._text = path.read_text(encoding="utf-8")
        tree = ast.parse(self._text)
        self.about = ast.get_docstring(tree)
        self.definitions = {name: statement for statement in tree.body[1:] for name in _bound(statement)}
        given = {name: self.definitions.pop(name).value for name in LITERALS if name in self.definitions}
        literals = {**LITERALS, **{name: ast.literal_eval(value) for name, value in given.items()}}
        self.answers, self.extra_cells = literals["ANSWERS"], literals["EXTRA_CELLS"]
        self.missing, self.broken = literals["MISSING"], literals["BROKEN"]

    def hand_in(self, released, asked=frozenset(EXERCISES)):
        """The text of the student's file, made from the Released notebook.

        asked: the exercises of all notebooks; who uses the function of one relies on the cell that defines it
        """
        notebook = copy.deepcopy(released.notebook)
        known = {*_imported(notebook), *asked}
        for position, cell in reversed(list(enumerate(notebook.cells))):
            code = self.extra_cells.get(cell.metadata.get("nbgrader", {}).get("grade_id"))
            if code:
                identifier = f"{cell.id}-own"
                notebook.cells.insert(position + 1, nbformat.v4.new_code_cell(code.strip(), id=identifier))
        for cell in notebook.cells:
            grade_id = cell.metadata.get("nbgrader", {}).get("grade_id", "")
            exercise = grade_id.removesuffix("-solution")
            if grade_id in self.answers:
                cell.source = self.answers[grade_id].strip()
            elif exercise != grade_id and exercise in self.definitions:
                known.discard(exercise)
                cell.source = "\n\n".join(self.code(exercise, known))
        text = nbformat.writes(notebook) + "\n"
        return text[: len(text) // 2] if released.name in self.broken else text

    def code(self, name, known):
        """The sources of what `name` uses and of itself, in this order, but for what is `known`; adds to `known`."""
        if name in known or name not in self.definitions:
            return []
        statement = self.definitions[name]
        known.update(_bound(statement))
        used = [node.id for node in ast.walk(statement) if isinstance(node, ast.Name)]
        before = [source for other in used for source in self.code(other, known)]
        return [*before, ast.get_source_segment(self._text, statement)]


def _bound(statement):
    """The names that a top-level statement of a student's file gives a meaning to."""
    if isinstance(statement, ast.FunctionDef):
        return [statement.name]
    if isinstance(statement, (ast.Import, ast.ImportFrom)):
        return [alias.asname or alias.name.partition(".")[0] for alias in statement.names]
    if isinstance(statement, ast.Assign):
        return [target.id for target in statement.targets]
    raise ValueError(f"line {statement.lineno}: only imports, functions and assignments belong into a student's file")


def _imported(notebook):
    """The names that the released notebook itself imports."""
    code = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code")
    lists = re.findall(r"^(?:from \S+ )?import (.+)$", code, re.MULTILINE)
    return {item.split()[-1] for names in lists for item in names.split(",")}
