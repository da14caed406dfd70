"""What grades a class again, what only makes its pages again, and what does neither."""

import shutil
from dataclasses import replace
from html import unescape

import nbformat
import pytest
from editing import solve
from support import ROOT, run

from autograder.course import Course
from autograder.exercises import EXERCISES
from autograder.grading import digests
from autograder.grading.records import recorded, verdicts
from autograder.sandbox import Limits

ONE = "1_rotation"
IN_DEGREES = """def rotation_about_z(degrees):
    c, s = np.cos(degrees), np.sin(degrees)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
"""
SAYS, HINT = next(
    (m.says, m.hint) for m in EXERCISES["rotation_about_z"].misconceptions if m.id == "degrees-as-radians"
)


# --- each change by itself --------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def files():
    return digests.files_of(Course(ROOT).package)


def changed(files, module, old, new):
    """The same files, but for one module."""
    source = files.modules[module].decode()
    assert old in source
    return files._replace(modules={**files.modules, module: source.replace(old, new, 1).encode()})


NEITHER = [
    ("transform_lab.judging.verdict", "@dataclass", "# a comment\n@dataclass"),
    ("transform_lab.judging.verdict", '"""What came of one call', '"""What one call gave'),
    ("transform_lab.judging.kinds", "TOLERANCE = 1e-6", "TOLERANCE = (\n    1e-6\n)"),
    ("autograder.exercises.rotation", "ABOUT_Z = Exercise(", "# of a frame\nABOUT_Z = Exercise("),
    ("autograder.grading.judge", '"""Runs one notebook', '"""It runs one notebook'),
    ("autograder.pages.feedback", '"""The text of index.html', '"""What index.html holds'),
    ("autograder.doctor", "import ", "import antigravity\nimport "),
    ("autograder.commands", "import ", "import antigravity\nimport "),
    ("autograder.environment", "import ", "import antigravity\nimport "),
    ("autograder.demo.__init__", "import ", "import antigravity\nimport "),
    ("autograder.demo.students.ada", "def ", "def another(): pass\n\n\ndef "),
    ("autograder.pages.export", "import ", "import antigravity\nimport "),
    ("autograder.pages.report", "import ", "import antigravity\nimport "),
    ("autograder.handout.release", "import ", "import antigravity\nimport "),
]
PAGES_ALONE = [
    ("autograder.pages.exporter", "LARGEST_PAGE = 280_000", "LARGEST_PAGE = 290_000"),
    ("autograder.pages.markdown", "LONGEST_FORMULA = 2_000", "LONGEST_FORMULA = 1_000"),
    ("transform_lab.judging.panel", "not done yet", "not begun yet"),
    ("transform_lab.judging.comparison", "import re", "import re as another"),
    ("autograder.exercises.rotation", "equivalent={", 'equivalent={"no reason": ("turn: 1 -> 2",), **{}, '),
    ("autograder.exercises.rotation", "from .equivalent import ", "from .equivalent import MAKING_A_POSE, "),
    ("autograder.exercises.equivalent", "LISTS = ", "LISTS = ANOTHER = "),
    ("transform_lab.judging.lines", "an object of type", "something of type"),
    ("transform_lab.viewing.shapes", "import numpy as np", "import numpy as numpy"),
    ("transform_lab.check", "def check(", "def checked(): pass\n\n\ndef check("),
]
GRADES = [
    ("autograder.exercises.rotation", "rotation_about_z(-degrees)", "rotation_about_z(-2 * degrees)"),
    ("autograder.exercises.rotation", '"degrees-as-radians",', '"wrong-units",'),
    ("autograder.exercises.cases", "rng.uniform(6.0, 7.5)", "rng.uniform(6.0, 7.0)"),
    ("autograder.sandbox.bounds", "call: float = 3.0", "call: float = 2.0"),
    ("autograder.sandbox.executor", "random.seed()", "random.seed(1)"),
    ("autograder.sandbox.forkserver", "LAST_CAPABILITY = 63", "LAST_CAPABILITY = 62"),
    ("autograder.intake.reading", "MOST_CELLS = 2_000", "MOST_CELLS = 1_000"),
    ("autograder.intake.sorting", "MOST_FILES, LARGEST_FILES = 200", "MOST_FILES, LARGEST_FILES = 100"),
    ("autograder.grading.judge", "MOST_RESTARTS = 10", "MOST_RESTARTS = 9"),
    ("autograder.grading.marks", "import utils", "import utils as another"),
    ("autograder.released", "import hashlib", "import hashlib as another"),
    ("transform_lab.judging.kinds", "TOLERANCE = 1e-6", "TOLERANCE = 1e-5"),
    ("transform_lab.judging.reading", "value in (0, 1)", "value in (0, 1, 2)"),
    ("transform_lab.judging.answers", "return False", "return True"),
    ("transform_lab.judging.status", "look=STOPPED", 'look=""'),
    ("transform_lab.judging.verdict", "done: bool = True", "done: bool = False"),
    ("transform_lab.judging.calling", "MOST_PRINTED = 200", "MOST_PRINTED = 100"),
    ("transform_lab.judging.diagnosis", "Your function printed something", "It printed something"),
    ("transform_lab.judging.naming", "Your function returned None.", "It returned None."),
    ("transform_lab.judging.two_mistakes", "import combinations", "import permutations as combinations"),
    ("transform_lab.judging.slips", "AT_LEAST, MANY = 2, 4", "AT_LEAST, MANY = 3, 4"),
    ("transform_lab.judging.advice", "Lists are no vectors", "No list is a vector"),
    ("transform_lab.judging.codec", "import math", "import cmath"),
    ("transform_lab.messages", "class Point", "class APoint"),
    ("transform_lab.tft", "import math", "import cmath"),
    ("transform_lab.validation", "import numpy as np", "import numpy as numpy"),
]


def ids(table):
    return [f"{module.rpartition('.')[2]}: {new.strip().splitlines()[0][:30]}" for module, _, new in table]


@pytest.mark.parametrize("change", NEITHER, ids=ids(NEITHER))
def test_what_changes_neither(files, change):
    assert digests.work_out(changed(files, *change)) == digests.work_out(files)


@pytest.mark.parametrize("change", PAGES_ALONE, ids=ids(PAGES_ALONE))
def test_what_makes_pages_again(files, change):
    (grades, pages), (grades_now, pages_now) = map(digests.work_out, (files, changed(files, *change)))
    assert grades_now == grades and pages_now != pages


@pytest.mark.parametrize("change", GRADES, ids=ids(GRADES))
def test_what_grades_again(files, change):
    assert digests.work_out(changed(files, *change))[0] != digests.work_out(files)[0]


@pytest.mark.parametrize("template", ["feedback.css", "feedback.html.j2", "head.html", "summary.html"])
def test_a_template_makes_pages_again(files, template):
    assert template in files.templates
    (grades, pages), (grades_now, pages_now) = map(
        digests.work_out, (files, files._replace(templates={**files.templates, template: "another"}))
    )
    assert grades_now == grades and pages_now != pages


@pytest.mark.parametrize(
    "package, grades, pages",
    [("numpy", True, True), ("ipython", True, True), ("nbconvert", False, True), ("pytest", False, False)],
)
def test_the_version_of_a_package_counts_where_it_is_imported(files, package, grades, pages):
    assert package in files.versions
    now = digests.work_out(files._replace(versions={**files.versions, package: "0.1"}))
    assert [one != other for one, other in zip(now, digests.work_out(files))] == [grades, pages]


def test_words_are_told_from_other_texts_by_the_misconceptions_that_say_them(files, monkeypatch):
    """A text that no misconception has counts, however much it reads like a hint."""
    words = digests._words()
    with_another_hint = changed(files, "autograder.exercises.rotation", HINT, "Look at the unit.")
    before = digests.work_out(files)
    assert digests.work_out(with_another_hint)[0] != before[0]
    monkeypatch.setattr(digests, "_words", lambda: words | {"Look at the unit."})
    grades, pages = digests.work_out(with_another_hint)
    assert grades == before[0] and pages != before[1]


def test_released_notebooks_and_limits_grade_again(course):
    before = digests.of_grades(course, Limits())
    assert digests.of_grades(Course(course.root), Limits()) == before
    assert digests.of_grades(course, replace(Limits(), memory=1_000_000_000)) != before
    path = course.release / f"{ONE}.ipynb"
    notebook = nbformat.read(path, as_version=4)
    next(cell for cell in notebook.cells if "nbgrader" in cell.metadata).source += "\n# more"
    nbformat.write(notebook, path)
    assert digests.of_grades(Course(course.root), Limits()) != before


def test_what_was_worked_out_is_remembered_for_the_same_files_alone(course, monkeypatch):
    monkeypatch.setattr(digests, "REMEMBERED", course.root / "__pycache__" / "digests.json")
    before = digests.of_grades(course, Limits())
    with monkeypatch.context() as patched:
        patched.setattr(digests, "work_out", lambda files: pytest.fail("worked out again"))
        assert digests.of_grades(course, Limits()) == before
    path = course.package / "tft.py"
    path.write_text(path.read_text() + "\nANOTHER = 1\n")
    assert digests.of_grades(course, Limits()) != before
    digests.REMEMBERED.write_text("{")
    assert digests.of_grades(course, Limits()) != before


@pytest.mark.parametrize("changes", ["nothing", "before", "meanwhile"])
def test_what_is_remembered_was_made_of_these_files(course, changes):
    file, path, made = course.root / "__pycache__" / "made.json", course.package / "tft.py", []

    def change():
        path.write_text(path.read_text() + "\nANOTHER = 1\n")

    def make(files):
        if changes == "meanwhile" and not made:
            change()
        made.append(files.modules["transform_lab.tft"].decode())
        return len(made[-1])

    first = digests.remembered(file, course.package, make)
    if changes == "before":
        change()
    assert digests.remembered(file, course.package, make) == first + (
        0 if changes == "nothing" else len("\nANOTHER = 1\n")
    )
    assert len(made) == (1 if changes == "nothing" else 2)
    file.write_text("{")
    assert digests.remembered(file, course.package, make) == len(path.read_text())


# --- with real submissions --------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def graded(released, hand_in, sandboxed, tmp_path_factory):
    """A course with one student, who has one notebook with a mistake; not to be changed by tests."""
    course = Course(shutil.copytree(released.root, tmp_path_factory.mktemp("digests") / "course"))
    notebook = nbformat.read(course.source / f"{ONE}.ipynb", as_version=4)
    solve(notebook, "rotation_about_z", IN_DEGREES)
    hand_in(course, "ada", {ONE: notebook})
    code, said = run(course, "grade")
    assert code == 0 and "1 graded" in said, said
    return course


@pytest.fixture
def course_of_ada(graded, tmp_path):
    return Course(shutil.copytree(graded.root, tmp_path / "course"))


def edit(course, path, old, new):
    path = course.root / path
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")


def pages(course):
    return {path.name: unescape(path.read_text(encoding="utf-8")) for path in course.feedback("ada").iterdir()}


def made(course):
    return {path: path.stat().st_mtime_ns for path in course.feedback("ada").iterdir()}


def test_a_comment_and_what_is_unrelated_change_neither(course_of_ada):
    before = made(course_of_ada), recorded(course_of_ada, "ada")
    edit(course_of_ada, "autograder/grading/judge.py", "import nbformat\n", "import nbformat  # of Jupyter\n")
    edit(course_of_ada, "autograder/pages/exporter.py", '"""nbgrader\'s feedback pages', '"""Feedback pages')
    edit(course_of_ada, "autograder/doctor.py", "import ", "import this\nimport ")
    edit(course_of_ada, "autograder/demo/students/ada.py", "def ", "def another():\n    pass\n\n\ndef ")
    code, said = run(course_of_ada, "grade")
    assert code == 0 and "0 graded, 1 unchanged" in said, said
    assert (made(course_of_ada), recorded(course_of_ada, "ada")) == before


def test_style_templates_and_words_reach_pages_that_exist_without_a_new_grade(course_of_ada):
    record = recorded(course_of_ada, "ada")
    assert HINT in pages(course_of_ada)["index.html"]
    edit(course_of_ada, "autograder/pages/templates/feedback.css", "body {", "body { --new: 1;")
    edit(course_of_ada, "autograder/pages/templates/summary.html", "</main>", "<p>Good luck!</p></main>")
    edit(course_of_ada, "source/transforms/transform_lab/judging/panel.py", ": not right yet", ": not quite right")
    edit(course_of_ada, "autograder/exercises/rotation.py", HINT, "In which unit do they take an angle?")
    edit(course_of_ada, "autograder/exercises/rotation.py", SAYS, "The angle stayed in degrees.")
    code, said = run(course_of_ada, "grade")
    assert code == 0 and "0 graded, 1 unchanged" in said, said
    assert recorded(course_of_ada, "ada") == record
    notebook, summary = pages(course_of_ada)[f"{ONE}.html"], pages(course_of_ada)["index.html"]
    assert "--new: 1;" in notebook and "Good luck!" in summary
    assert "rotation_about_z: not quite right" in notebook and "not right yet" not in notebook
    for page in (notebook, summary):
        assert "In which unit do they take an angle?" in page and HINT not in page
        assert "The angle stayed in degrees." in page and SAYS not in page
    assert "The angle stayed in degrees." in (course_of_ada.reports / "index.html").read_text()
    before = made(course_of_ada)
    assert "0 graded, 1 unchanged" in run(course_of_ada, "grade")[1]
    assert made(course_of_ada) == before


def test_a_misconception_that_is_no_longer_known_grades_again(course_of_ada):
    record = recorded(course_of_ada, "ada")
    edit(course_of_ada, "autograder/exercises/rotation.py", '"degrees-as-radians",', '"angle-not-converted",')
    code, said = run(course_of_ada, "grade")
    assert code == 0 and "1 graded" in said, said
    now = recorded(course_of_ada, "ada")
    assert now[ONE]["seed"] != record[ONE]["seed"]
    assert now[ONE]["rows"][0].misconception == "angle-not-converted"


def test_words_of_a_mistake_that_changed_its_place_stay_those_that_were_said(graded):
    """Until it is graded again: a position in the list of misconceptions means nothing when the list has changed."""
    record = recorded(graded, "ada")[ONE]
    source = record["verdicts"]["rotation_about_z"]["mistakes"][0][2]
    assert source[0] == "degrees-as-radians"
    for odd in (["wrong-sign", *source[1:]], [source[0], 99, 0], [source[0], source[1], 9]):
        record["verdicts"]["rotation_about_z"]["mistakes"] = [["It was said.", "It was hinted.", odd]]
        verdict = verdicts(record)["rotation_about_z"]
        assert (verdict.says, verdict.hint) == ("It was said.", "It was hinted.")
