"""The demo's class: every student's file is what it says, and enrolling puts real submissions into a course."""

import ast
import shutil
import warnings
from collections import Counter

import nbformat
import numpy as np
import pytest
from support import key_of
from transform_lab.judging.calling import call
from transform_lab.judging.verdict import examine

from autograder.course import Course
from autograder.demo import STUDENTS, Student, enroll, is_demo
from autograder.exercises import EXERCISES

PATHS = sorted(STUDENTS.glob("*.py"))
SEED = 7
ENDLESS = ("lena", "chain")  # a loop that never ends: for the sandbox only

each_student = pytest.mark.parametrize("path", PATHS, ids=lambda path: path.stem)


@pytest.fixture(scope="session")
def course(released, tmp_path_factory):
    """A course of its own, released, with the class enrolled."""
    course = Course(shutil.copytree(released.root, tmp_path_factory.mktemp("demo") / "course"))
    (course.package / "__pycache__").mkdir(exist_ok=True)
    (course.package / "__pycache__" / "check.pyc").write_bytes(b"made at run time")
    enroll(course)
    return course


def cells(path):
    """{grade_id: cell} of a notebook file."""
    notebook = nbformat.read(path, as_version=4)
    return {cell.metadata.nbgrader.grade_id: cell for cell in notebook.cells if "nbgrader" in cell.metadata}


def verdicts(path):
    """{exercise: Verdict} on a student's functions; the file is executed here, which the demo itself never does."""
    namespace = {}
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        exec(compile(path.read_text(encoding="utf-8"), path.name, "exec"), namespace)
        return {
            name: examine(name, key_of(name, SEED), lambda args, kwargs, name=name: call(namespace[name], args, kwargs))
            for name in EXERCISES
            if name in namespace and (path.stem, name) != ENDLESS
        }


def test_class_is_large_enough():
    assert len(PATHS) >= 14


@each_student
def test_file_tells_who_the_student_is(path):
    assert Student(path).about.startswith(f"{path.stem.capitalize()}:")


@each_student
def test_every_function_is_an_exercise_or_is_used_by_one(path):
    student, reached = Student(path), set(EXERCISES)
    waiting = [name for name in EXERCISES if name in student.definitions]
    while waiting:
        used = {node.id for node in ast.walk(student.definitions[waiting.pop()]) if isinstance(node, ast.Name)}
        waiting += (used & set(student.definitions)) - reached
        reached |= used
    assert set(student.definitions) <= reached


@each_student
def test_literals_name_what_exists(path, course):
    student = Student(path)
    graded = {grade_id for released in course.notebooks.values() for grade_id in released.cells}
    assert {*student.missing, *student.broken} <= set(course.notebooks)
    assert set(student.extra_cells) <= set(EXERCISES)
    assert set(student.answers) <= {grade_id for grade_id in graded if grade_id.startswith("question-")}


@each_student
def test_submission_is_valid_and_holds_the_answers(path, course):
    student = Student(path)
    folder = course.submitted(student.name)
    assert is_demo(student.name)
    for name, released in course.notebooks.items():
        file = folder / f"{name}.ipynb"
        if name in student.missing:
            assert not file.exists()
        elif name in student.broken:
            with pytest.raises(nbformat.reader.NotJSONError):
                nbformat.read(file, as_version=4)
        else:
            nbformat.validate(nbformat.read(file, as_version=4))
            handed_in = cells(file)
            for exercise in released.points:
                source = handed_in[f"{exercise}-solution"].source
                assert ("raise NotImplementedError" in source) == (exercise not in student.definitions)
                functions = {node.name for node in ast.parse(source).body if isinstance(node, ast.FunctionDef)}
                assert functions & set(EXERCISES) == {exercise}
                assert handed_in[exercise] == released.cells[exercise]
            for question in set(student.answers) & set(handed_in):
                assert handed_in[question].source == student.answers[question].strip()


@each_student
def test_every_cell_compiles_and_defines_what_it_needs(path, course):
    """Whatever a solution cell uses of the student's own is there by then, in the same notebook."""
    student = Student(path)
    for name in set(course.notebooks) - {*student.missing, *student.broken}:
        bound = set()
        for cell in nbformat.read(course.submitted(student.name) / f"{name}.ipynb", as_version=4).cells:
            if cell.cell_type != "code":
                continue
            tree = ast.parse(cell.source)
            for node in tree.body:
                bound |= {alias.asname or alias.name for alias in getattr(node, "names", [])}
                bound |= {node.name} if isinstance(node, ast.FunctionDef) else set()
                bound |= {target.id for target in getattr(node, "targets", []) if isinstance(target, ast.Name)}
            if cell.metadata.get("nbgrader", {}).get("solution"):
                used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
                assert (used & set(student.definitions)) - set(EXERCISES) <= bound


def test_extra_cells_stand_after_their_test_cell(course):
    notebook = nbformat.read(course.submitted("demo_noor") / "1_rotation.ipynb", as_version=4)
    sources = [cell.source for cell in notebook.cells]
    position = sources.index('check("rotation_from_axes", rotation_from_axes)')
    assert "plt.plot" in sources[position + 1]


def test_package_comes_along_without_caches(course):
    folder = course.submitted("demo_ada") / "transform_lab"
    assert (folder / "__init__.py").read_bytes() == (course.package / "__init__.py").read_bytes()
    assert not list(folder.rglob("__pycache__"))


def test_enrolling_again_replaces_the_class_and_nobody_else(course):
    real = course.submitted("robin") / "notes.txt"
    real.parent.mkdir(parents=True)
    real.write_text("mine")
    stray = course.submitted("demo_ada") / "stray.txt"
    stray.write_text("left over")
    file = course.submitted("demo_ada") / "1_rotation.ipynb"
    before = file.read_bytes()
    students = enroll(course)
    assert students == [f"demo_{path.stem}" for path in PATHS]
    assert file.read_bytes() == before and not stray.exists() and real.read_text() == "mine"
    assert not is_demo("robin")


def test_class_covers_right_answers_and_shared_mistakes():
    """Each exercise is right at least once, or new to all; some students are right throughout; there is something to rank."""
    found = {path.stem: verdicts(path) for path in PATHS}
    answered = set.union(*map(set, found.values()))
    assert len(answered) > 0.8 * len(EXERCISES)
    right = {student: {name for name in found[student] if found[student][name].right} for student in found}
    assert set.union(*right.values()) == answered
    assert all(right[student] == answered for student in ("ada", "chloe", "devika", "oskar"))
    named = Counter((name, mistake) for of in found.values() for name in of for mistake in of[name].misconceptions)
    assert {exercise for (exercise, mistake), _ in named.most_common(2) if mistake == "base-frame-offset"} == {
        "waypoint",
        "pre_grasp",
    }
    assert named["pre_grasp", "base-frame-offset"] >= 3
    assert len({name for name, mistake in named}) > len(EXERCISES) / 2
