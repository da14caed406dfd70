"""What is made once for many pages is what would be made for each: of exactly the same content, and of nothing else."""

import json
import shutil
from collections import defaultdict
from functools import partial
from pathlib import Path

import nbformat
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from nbgrader.server_extensions import formgrader
from support import ROOT

from autograder.bridge.nbgrader_api import FeedbackPages
from autograder.course import Course
from autograder.grading import digests
from autograder.grading.marks import CellGrade, NotebookGrades
from autograder.pages import examples, exporter, feedback
from autograder.pages.exporter import Feedback, Pieces

ASKED = {"grade": True, "solution": True, "locked": False, "grade_id": "question", "schema_version": 3}
TEST = {"grade": True, "solution": False, "locked": True, "grade_id": "chain", "schema_version": 3}
SOURCES = st.sampled_from(["x = 1", "x = 2", "# chain", "$x$", "<b>x", "%%html\nx", "![](attachment:a)"])
OUTPUTS = st.lists(
    st.sampled_from(["1", "2", "<b>1</b>"]).flatmap(
        lambda text: st.sampled_from(
            [
                nbformat.v4.new_output("stream", text=text),
                nbformat.v4.new_output("display_data", data={"text/html": text}),
                nbformat.v4.new_output("execute_result", data={"text/plain": text}, execution_count=1),
            ]
        )
    ),
    max_size=2,
)


@st.composite
def cells(draw):
    kind, source = draw(st.sampled_from(["code", "markdown"])), draw(SOURCES)
    metadata = draw(st.sampled_from([{}, {"nbgrader": ASKED}, {"nbgrader": TEST}]))
    cell = {"cell_type": kind, "id": draw(st.sampled_from("ab")), "source": source, "metadata": metadata}
    if kind == "code":
        cell |= {"outputs": draw(OUTPUTS), "execution_count": draw(st.sampled_from([None, 1, 2]))}
    elif draw(st.booleans()):
        cell["attachments"] = {"a": {"image/png": draw(st.sampled_from(["AAAA", "BBBB"]))}}
    return nbformat.from_dict(cell)


def notebook(cells, language="python"):
    """Also one with the same cell twice, which nbformat would change."""
    return nbformat.from_dict({"cells": cells, "metadata": {"language_info": {"name": language}}})


@st.composite
def notebooks(draw):
    """(a notebook, the grades of its cells)"""
    made = notebook(draw(st.lists(cells(), max_size=4)), draw(st.sampled_from(["python", "ipython", "text"])))
    grade = st.builds(CellGrade, st.sampled_from([0.0, 1.0]), st.sampled_from([1.0, 2.0]), st.booleans())
    comments = st.dictionaries(st.just("question"), st.sampled_from(["Good.", "*Why?*"]))
    grades = {"question": draw(grade), "chain": draw(grade)}
    return made, NotebookGrades(grades, draw(comments), draw(st.sampled_from([0.0, 1.0])))


@pytest.fixture(scope="module")
def new_exporter():
    """new_exporter(): as nbgrader makes one."""
    templates = str(Path(formgrader.__file__).parent / "templates")

    def made():
        found = Feedback(template_name="feedback", extra_template_basedirs=[templates], filters=FILTERS)
        found.register_preprocessor(exporter.FetchGrades)
        return found

    return made


FILTERS = {
    "markdown2html": "autograder.pages.markdown.markdown2html",
    "strip_files_prefix": "autograder.pages.markdown.as_it_is",
}


def page(maker, one, grades):
    made, _ = maker.from_notebook_node(one, {"nbgrader": {"notebook": "3_chaining", "grades": grades}})
    return made


@settings(max_examples=15, deadline=None)
@given(st.lists(notebooks(), min_size=2, max_size=4))
def test_a_page_is_the_same_whatever_was_made_before_it(new_exporter, slow, several):
    used = new_exporter()
    for one, grades in several:
        assert page(used, one, grades) == page(new_exporter(), one, grades)


def test_a_cell_that_is_the_same_is_made_once(new_exporter, monkeypatch):
    coloured = []
    make = exporter._pygments_highlight
    monkeypatch.setattr(exporter, "_pygments_highlight", lambda *args: coloured.append(1) or make(*args))
    maker, cell = new_exporter(), nbformat.v4.new_code_cell("x = 1", id="a")
    pages = {page(maker, notebook([cell, cell]), NotebookGrades()) for _ in range(3)}
    assert len(coloured) == len(pages) == 1


@settings(deadline=None)
@given(st.lists(st.text("abc", max_size=3), max_size=40))
def test_what_is_kept_is_bounded_and_right(texts):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(exporter, "MOST_KEPT", 50)
        pieces = Pieces()
        for text in texts:
            assert pieces.of(text, lambda text=text: text * 10) == text * 10
            assert sum(map(len, pieces.known.values())) == pieces.size <= 50


@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(notebooks(), min_size=2, max_size=4))
def test_a_page_is_the_same_whichever_process_made_its_parts(new_exporter, tmp_path, slow, several):
    """Two exporters stand for two processes, which make the notebooks in turn."""
    together = [new_exporter(), new_exporter()]
    for one in together:
        one.pieces.folder = tmp_path
    for turn, (one, grades) in enumerate(several):
        assert page(together[turn % 2], one, grades) == page(new_exporter(), one, grades)


def test_what_one_process_has_made_another_need_not(tmp_path):
    made = []

    def make(text):
        made.append(text)
        return f"<{text}>"

    for pieces in (Pieces(tmp_path), Pieces(tmp_path), Pieces()):
        for text in ("a", "b", "\ud800", "a"):
            assert pieces.of(text.encode("utf-8", "backslashreplace").decode(), partial(make, text)) == f"<{text}>"
    assert made == ["a", "b", "\ud800"] * 2  # the last one shares no folder


def test_what_cannot_be_left_to_others_is_made_by_each(tmp_path, monkeypatch):
    gone = tmp_path / "gone"
    assert [Pieces(gone).of("a", lambda: "made") for _ in range(2)] == ["made"] * 2
    monkeypatch.setattr(exporter, "MOST_KEPT", 5)
    pieces = Pieces(tmp_path)
    for text in "abc":
        pieces.of(text, lambda text=text: text * 3)
    assert len(list(tmp_path.iterdir())) == 1  # no more than that many characters


def test_what_everybody_has_is_made_before_a_class_is(tmp_path, monkeypatch):
    """Of released notebooks, handed in as they are, nothing is coloured or set anew."""
    course, made = Course(ROOT), []
    pages = FeedbackPages(course, shared=tmp_path)
    pages.prepare(course.notebooks.values())
    monkeypatch.setattr(exporter, "_pygments_highlight", lambda *args: made.append(args) or "")
    monkeypatch.setattr(pages.exporter, "_markdown", lambda *args: made.append(args) or "")
    for released in course.notebooks.values():
        told = {"notebook": released.name, "grades": NotebookGrades(defaultdict(lambda: CellGrade(0.0, 1.0, False)))}
        renamed = nbformat.from_dict(released.notebook)
        for number, cell in enumerate(renamed.cells):
            cell.id = f"cell-{number}"  # as the grader numbers them
        pages.exporter.from_notebook_node(renamed, {"nbgrader": told})
    assert not made


def test_pages_are_made_with_what_was_prepared(course, tmp_path, monkeypatch):
    made, make = [], feedback.FeedbackPages
    monkeypatch.setattr(feedback, "FeedbackPages", lambda *args: made.append(args) or make(*args))
    shutil.copytree(course.release, course.autograded("ada"))
    grades = {
        name: NotebookGrades({cell: CellGrade(0.0, 1.0, False) for cell in released.points | released.questions})
        for name, released in course.notebooks.items()
    }
    feedback._prepare(course, tmp_path)
    assert feedback._one(course, "ada", grades, shared=tmp_path) is None
    assert len(made) == 1 and len(list(course.feedback("ada").glob("*.html"))) == len(grades) + 1


# --- examples in the report -------------------------------------------------------------------------------------------


@pytest.fixture
def made(monkeypatch, tmp_path):
    """What was made of misconceptions, in order; kept in a file of the test's own."""
    found = []
    make = examples.of_misconception
    monkeypatch.setattr(examples, "REMEMBERED", tmp_path / "__pycache__" / "examples.json")
    monkeypatch.setattr(examples, "of_misconception", lambda *which: found.append(which) or make(*which))
    return found


SIGN, EXACT = ("same_rotation", "sign-ignored"), ("is_rotation", "exact-comparison")


def test_an_example_is_made_once_for_the_same_code(made, monkeypatch):
    course = Course(ROOT)
    first = examples.of_misconceptions(course, [SIGN])
    assert first == {SIGN: examples.of_misconception(*SIGN)} and first[SIGN]
    made.clear()
    assert examples.of_misconceptions(course, [SIGN, EXACT]).keys() == {SIGN, EXACT}
    assert examples.of_misconceptions(course, [SIGN]) == first
    assert made == [EXACT]
    monkeypatch.setattr(digests, "of_pages", lambda course: "another")
    assert examples.of_misconceptions(course, [SIGN]) == first
    assert made == [EXACT, SIGN]


@pytest.mark.parametrize("damaged", ["", "{", "[]", "7", json.dumps({"DIGEST": 7}), json.dumps({"DIGEST": [[1]]})])
def test_examples_that_somebody_has_damaged_are_made_again(made, damaged):
    course = Course(ROOT)
    first = examples.of_misconceptions(course, [SIGN])
    examples.REMEMBERED.write_text(damaged.replace("DIGEST", digests.of_pages(course)))
    assert examples.of_misconceptions(course, [SIGN]) == first and len(made) == 2
