"""A term on a real JupyterHub, set up as docs/hub.md says: accounts of this machine, real servers, real browsers, a base URL."""

import os
import tempfile
from contextlib import ExitStack
from pathlib import Path
from urllib.parse import quote

import nbformat
import pytest
from hub.machine import Machine, accounts, as_account, make_environment
from hub.people import Person
from support import ASKED, lacking, points, points_by_hand, scores, wait_for

from autograder.course import ASSIGNMENT
from autograder.demo import STUDENTS, Student
from autograder.released import Released

ONE, TWO = "1_rotation", "2_homogeneous_transforms"
QUESTION, OVERRIDDEN = "question-pose-or-transform", "hand_transform"


@pytest.fixture(scope="module")
def machine(released, slow):
    """A machine with accounts of an instructor and two students, on which the hub has not been set up yet."""
    if os.getuid() != 0:
        lacking("needs root, to make accounts")
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="hub-", ignore_cleanup_errors=True)))
        folder.chmod(0o755)
        (folder / "home").mkdir()
        names = stack.enter_context(accounts(folder / "home", "instructor", "ada", "ben"))
        make_environment(folder)
        yield Machine(folder, names, released)


def test_a_term(machine, browser, sandboxed, tmp_path):
    code, told = machine.command("hub")
    assert code == 0 and told.count("\ndone  ") + told.startswith("done") == 9, told
    assert "Nothing had to be changed." in machine.command("hub")[1]
    code, said = machine.command("doctor", "--hub")
    assert code == 0 and "LOOK" not in said, said
    with machine.serving(told):
        term(machine, browser, tmp_path)


def term(machine, browser, pictures):
    course = machine.course
    instructor, ada, ben = (Person(machine, browser, who) for who in ("instructor", "ada", "ben"))
    assert instructor.menu() == ["Assignment List", "Course List", "Formgrader", "Create assignment"]
    assert ada.menu() == ben.menu() == ["Assignment List"]
    for path in ("formgrader", "formgrader/api/assignments", "formgrader/api/gradebook/1"):
        assert ada.status(f"user/{ada.name}/{path}") == 404
    assert instructor.status(f"user/{instructor.name}/formgrader/api/assignments") == 200

    said = instructor.types(f"cd course && python3 -m autograder release && nbgrader release_assignment {ASSIGNMENT}")
    assert "Released as" in said and "exit 0" in said, said
    for student in (ada, ben):
        student.assignments("Fetch")
        assert (student.home / ASSIGNMENT / "transform_lab/key.json").is_file()

    work_in_the_browser(ada, pictures)
    solve(ada, "ada", *[name for name in course.notebooks if name != ONE])
    solve(ben, "ben", ONE)
    nbformat.write(nbformat.v4.new_notebook(), ben.home / ASSIGNMENT / "Untitled.ipynb")
    for student in (ada, ben):
        student.assignments("Submit")
    assert "2 graded" in collect_and_grade(instructor)
    solve(ben, "ben", *course.notebooks)
    ben.assignments("Submit")
    ben.page.screenshot(path=pictures / "assignment_list.png")
    said = collect_and_grade(instructor)
    assert "1 graded" in said and "1 unchanged" in said, said
    assert total(course, ada) == points() > total(course, ben) > points(ONE)

    grade_by_clicks(instructor, ada.name, {QUESTION: 1.5, OVERRIDDEN: 0.5}, pictures)
    said = instructor.types("cd course && python3 -m autograder grade && nbgrader release_feedback " + ASSIGNMENT)
    assert "exit 0" in said, said
    for student in (ada, ben):
        student.assignments("Fetch Feedback")
        student.page.get_by_text("(view feedback)").wait_for()
        (fetched,) = (student.home / ASSIGNMENT / "feedback").iterdir()
        assert {*course.notebooks, "index"} <= {page.stem for page in fetched.iterdir()}
    (summary,) = (ada.home / ASSIGNMENT / "feedback").glob("*/index.html")
    earned = points() - ASKED[TWO].points[OVERRIDDEN] + 0.5 + 1.5
    assert f"{earned:g} of {points() + points_by_hand():g} points" in summary.read_text()
    read_the_summary(ada, pictures)
    look_for_others_work(machine, ada, ben, instructor)


def work_in_the_browser(student, pictures):
    """Fill in the first notebook in Lab, run it, and save it: every figure is drawn, and check answers."""
    notebook = student.notebook(f"{ASSIGNMENT}/{ONE}")
    solved = Student(STUDENTS / "ada.py").hand_in(
        Released(ONE, (student.home / ASSIGNMENT / f"{ONE}.ipynb").read_text())
    )
    cells = {cell.id: cell.source for cell in nbformat.reads(solved, as_version=4).cells}
    notebook.page.evaluate(
        """cells => {
          for (const cell of window.jupyterapp.shell.currentWidget.content.model.cells)
            if (cell.id in cells && cell.sharedModel.getSource() !== cells[cell.id]) cell.sharedModel.setSource(cells[cell.id]);
        }""",
        cells,
    )
    notebook.run_all()
    figures = notebook.figures()
    assert len(figures) >= 2
    for figure in figures:
        assert notebook.scene(figure).evaluate("() => Object.keys(viewer.scene_tree.children).length")
    scene = notebook.scene_with("input[name=degrees]")
    before = scene.locator("#text").inner_text()
    scene.locator("input[name=degrees]").press("End")  # the kernel answers
    wait_for(lambda: scene.locator("#text").inner_text() != before)
    notebook.page.screenshot(path=pictures / "scene.png")
    notebook.page.evaluate("() => window.jupyterapp.commands.execute('docmanager:save')")
    saved = (student.home / ASSIGNMENT / f"{ONE}.ipynb").read_text()
    assert "rotation_about_z: all right." in saved


def solve(student, person, *notebooks):
    """The student fills in notebooks as a person of the demo's class would."""
    for name in notebooks:
        path = student.home / ASSIGNMENT / f"{name}.ipynb"
        text = Student(STUDENTS / f"{person}.py").hand_in(Released(name, path.read_text()))
        path.write_text(text)


def collect_and_grade(instructor):
    said = instructor.types(f"cd course && nbgrader collect {ASSIGNMENT} --update && python3 -m autograder grade")
    assert "exit 0" in said, said
    return said


def total(course, student):
    return sum(scores(course, student.name).values())


def grade_by_clicks(instructor, student, given, pictures):
    """Open the formgrader inside Lab, go to the student's second notebook, and type {cell: points}."""
    page = instructor.lab()
    instructor.open("Formgrader")
    grader = page.frame_locator("iframe")
    grader.locator("td a", has_text=ASSIGNMENT).first.wait_for()
    page.screenshot(path=pictures / "formgrader.png")
    grader.get_by_role("link", name="Manual Grading").click()
    for name in (ASSIGNMENT, TWO):
        grader.locator("td a", has_text=name).first.click()
    grader.locator("tr", has=grader.locator(".name-shown", has_text=student)).locator("a").first.click()
    for cell, score in given.items():
        with page.expect_response(lambda answer: "/api/grade/" in answer.url and answer.request.method == "PUT"):
            grader.locator(f"input#{cell}").fill(f"{score:g}")
            grader.locator(f"input#{cell}").blur()
    grader.locator(f"input#{QUESTION}").scroll_into_view_if_needed()
    page.screenshot(path=pictures / "grading.png")


def read_the_summary(student, pictures):
    """In Lab, where a click on the file leads, and as a page of its own, where its links work."""
    (page,) = (student.home / ASSIGNMENT / "feedback").glob("*/index.html")
    path = page.relative_to(student.home).as_posix()
    student.lab().evaluate("path => window.jupyterapp.commands.execute('docmanager:open', { path })", path)
    student.page.frame_locator("iframe").get_by_role("heading", name="your feedback").wait_for()
    student.page.screenshot(path=pictures / "summary.png")
    student.page.goto(f"{student.url}/files/{quote(path)}")
    student.page.get_by_text("Your notebook with all verdicts").first.click()
    student.page.get_by_text("rotation_about_z: all right.").first.wait_for()


def look_for_others_work(machine, ada, ben, instructor):
    """Ben looks for ada's work, and for the instructor's, in all places where it lies, and finds none."""
    room = machine.exchange / machine.course_id
    own = next(path for path in (ben.home / ".local/share/jupyter/nbgrader_cache").glob("*/*+*+*"))
    forged = room / "inbound" / f"{ada.name}+{ASSIGNMENT}+2026-01-01 00:00:00.000000 UTC+random"
    for command in (
        ["ls", room / "inbound"],
        ["ls", room / "feedback"],
        ["ls", ada.home],
        ["cat", ada.home / ASSIGNMENT / f"{ONE}.ipynb"],
        ["ls", machine.course.root],
        ["cat", machine.course.gradebook],
        ["mv", room, machine.exchange / "mine"],
        ["mkdir", room / "mine"],
        ["rm", "-r", room / "outbound"],
    ):
        found = as_account(ben.name, command)
        assert found.returncode != 0 and not found.stdout, command
    for path in (f"user/{ada.name}/api/contents/{ASSIGNMENT}", f"user/{instructor.name}/formgrader/api/submissions/1",
                 f"user/{instructor.name}/api/contents/course", "hub/api/users"):  # fmt: skip
        assert ben.status(path) in (403, 404)
    assert as_account(ben.name, ["cp", "-r", own, forged]).returncode == 0
    said = instructor.types(f"cd course && nbgrader collect {ASSIGNMENT} --update")
    assert f"passed over; it belongs to the account {ben.name}" in said
    assert said.count("Updating submission") + said.count("Collecting submission") == 0
