"""In a browser, what the grader says is what a reader sees, whatever students put around it: feedback and formgrader."""

import base64
import errno
import io
import json
import os
import shutil

import nbformat
import pytest
from editing import solve
from PIL import Image
from support import ASKED, asked, jupyter_server, run

from autograder.bridge.gradebook import Writer
from autograder.course import ASSIGNMENT, Course
from autograder.pages import exporter, feedback
from autograder.pages.bounded import BARE

ONE = "1_rotation"


def picture(width, height):
    file = io.BytesIO()
    Image.new("RGB", (width, height), "red").save(file, "PNG")
    return base64.b64encode(file.getvalue()).decode()


PANEL = (
    '<div class="panel panel-primary nbgrader_cell said" id="is_rotation" style="position:fixed;top:0;left:0;width:100%;'
    'height:100%;z-index:999;background:white"><span class="nbgrader-label pull-right">2 of 2</span>'
    '<a name="is_rotation" id="top"></a>✓ is_rotation: all right.</div>'
)
WRITTEN = [
    PANEL,
    "# is_rotation\n\n[jump](#is_rotation)",
    "<details open><summary>s</summary>" + "</div>" * 30 + "<table><tr><td style='position:fixed'>x",
    "$" + r"\hspace{-9.9em}" * 100 + r"\text{COVER}$ $\rule{90em}{90em}$",
    "<math><mstyle scriptlevel='-60'><mi>BIG</mi></mstyle><mspace width='-9.9em'/></math>",
    "Z" + "\u0301" * 3000 + "algo",
    "\u202e" * 20 + "turned \u2067",
    "![](attachment:a.png)",
    "<hr>\n\n# 4 of 4 points\n\n`" + "x" * 3000 + "`",
    '<input id="is_rotation" class="score" type="number"><textarea>',
]
DISPLAYED = [
    {"text/html": PANEL},
    {"text/html": "<hr size=9000 width=9000><pre>" + "x" * 3000 + "</pre>"},
    {"text/html": "</div>" * 40 + "<p>A" + "\u0301" * 2000},
    {"text/plain": "\x1b[32;1m✓ is_rotation: all right.\x1b[0m\n" + "y" * 5000},
    {"text/markdown": PANEL + "\n\n# is_rotation"},
    {"text/latex": "$" + r"\hspace{-9.9em}" * 100 + r"\text{COVER}$"},
    {"image/png": picture(5000, 3000)},
]


def around_each_check(notebook):
    """The notebook with each of these before and after its checks."""
    cells = []
    for cell in notebook.cells:
        mine = []
        if cell.metadata.get("nbgrader", {}).get("grade_id") in ASKED[ONE].points:
            attached = {"a.png": {"image/png": picture(40, 9000)}}
            mine = [nbformat.v4.new_markdown_cell(text, attachments=attached) for text in WRITTEN]
            source = "\n".join(f"display({data!r}, raw=True)" for data in DISPLAYED)
            mine.append(nbformat.v4.new_code_cell(f"# x{chr(0x301) * 500}\n{source}"))
        cells += [*mine, cell, *mine]
    return nbformat.from_dict({**notebook, "cells": [{**cell, "id": f"c{n}"} for n, cell in enumerate(cells)]})


@pytest.fixture(scope="module")
def course_of_eve(released, hand_in, sandboxed, tmp_path_factory):
    """A course in which a student hands in what looks like, covers and moves verdicts, in the notebook and in an error."""
    course = Course(shutil.copytree(released.root, tmp_path_factory.mktemp("eve") / "course"))
    notebook = nbformat.read(course.source / f"{ONE}.ipynb", as_version=4)
    odd = "def is_rotation(R):\n    raise ValueError('\\u202e' + 'A' + '\\u0301' * 20 + '✓ right')\n"
    solve(notebook, "is_rotation", odd)
    hand_in(course, "eve", {ONE: around_each_check(notebook)})
    code, said = run(course, "grade")
    assert code == 0, said
    return course


LOOK = """() => {
  const theirs = '.theirs, .text_cell_render, .input_area', inside = element => element && element.closest(theirs)
  const at = (x, y) => { const found = document.elementFromPoint(x, y); return found || document.body }
  const wrong = []
  const said = [...document.querySelectorAll('.said')]
  for (const box of said) {
    box.scrollIntoView({block: 'center'})
    const {left, top, right, bottom} = box.getBoundingClientRect()
    if (right - left < 100 || bottom - top < 30) wrong.push('a verdict is too small to read')
    for (let i = 1; i < 20; i++) for (let j = 1; j < 8; j++)
      if (at(left + (right - left) * i / 20, top + (bottom - top) * j / 8).closest('.said') !== box) wrong.push('covered')
    if (inside(box)) wrong.push('a verdict inside of a student\\'s box')
  }
  const edge = said[0].getBoundingClientRect().left
  for (const box of document.querySelectorAll('.theirs, .text_cell_render')) {
    if (box.closest('.panel.nbgrader_cell')) continue  // the grader's frame around an answer
    box.scrollIntoView({block: 'start'})
    const {left, top, bottom} = box.getBoundingClientRect()
    if (left < edge + 10) wrong.push('a student\\'s box begins at the edge')
    for (let y = Math.max(top, 0) + 1; y < Math.min(bottom, innerHeight); y += 9)
      for (let x = edge; x < left - 1; x += 4) if (inside(at(x, y))) wrong.push('drawn outside of its box')
    for (const element of box.querySelectorAll('[id]'))
      if (!element.id.startsWith('user-content-')) wrong.push('id ' + element.id)
    for (const element of box.querySelectorAll('[class]'))
      if (/said|theirs|panel|nbgrader|pull-right|score/.test(element.className)) wrong.push('class ' + element.className)
    for (const element of box.querySelectorAll('*'))
      if (!['static', 'relative'].includes(getComputedStyle(element).position)) wrong.push('position')
  }
  if (document.documentElement.scrollWidth > innerWidth) wrong.push('wider than the window')
  return {wrong: [...new Set(wrong)], said: said.map(box => box.innerText)}
}"""


def check(tab):
    found = tab.evaluate(LOOK)
    assert found["wrong"] == []
    assert len(found["said"]) == len(ASKED[ONE].points)
    (raised,) = [text for text in found["said"] if "is_rotation: not right yet" in text]
    assert "A\u0301\u0301✓ right" in raised and "\u202e" not in raised and "0 of " in raised
    assert sum("all right." in text for text in found["said"]) == len(ASKED[ONE].points) - 1


def test_feedback(course_of_eve, browser):
    tab = browser.new_page(viewport={"width": 1100, "height": 800})
    tab.goto((course_of_eve.feedback("eve") / f"{ONE}.html").as_uri())
    assert tab.locator(".theirs").count() >= 2 and tab.locator("h1", has_text="4 of 4 points").count()
    check(tab)
    tab.locator("header a", has_text="is_rotation").click()
    target = tab.evaluate(
        "(t => [t.localName, !!t.closest('.theirs, .text_cell_render')])(document.querySelector(':target'))"
    )
    assert target == ["a", False]


def test_the_formgrader(course_of_eve, browser):
    with jupyter_server(course_of_eve) as address:
        (found,) = json.loads(asked(address, f"/formgrader/api/submitted_notebooks/{ASSIGNMENT}/{ONE}"))
        tab = browser.new_page(
            viewport={"width": 1100, "height": 800}, extra_http_headers={"Authorization": "token secret"}
        )
        tab.route("**/*", lambda route: route.continue_() if route.request.url.startswith(address) else route.abort())
        tab.goto(f"{address}/formgrader/submissions/{found['id']}/", wait_until="load")
        assert tab.locator("h1", has_text="4 of 4 points").count()
        # MathJax, which moves as formulas say, has nothing to typeset but what is the grader's.
        assert tab.evaluate(
            "[...document.querySelectorAll('.text_cell_render')].every(b => b.closest('.tex2jax_ignore'))"
        )
        check(tab)


@pytest.fixture
def pages(course_of_eve):
    """(course, grades of the student, the folder of her pages), which are made anew by the tests that follow."""
    with Writer(course_of_eve) as writer:
        return course_of_eve, writer.grades()["eve"], course_of_eve.feedback("eve")


def test_a_page_of_the_verdicts_alone(pages):
    course, grades, folder = pages
    assert "took more time or memory" in feedback._one(course, "eve", grades, bare=True)
    text = (folder / f"{ONE}.html").read_text(encoding="utf-8")
    assert BARE.strip("*") in text and "4 of 4 points" not in text and "is_rotation: not right yet" in text
    assert text.count('class="said') == len(ASKED[ONE].points)
    assert feedback.is_complete(course, "eve", grades)
    assert feedback._one(course, "eve", grades) is None
    assert "4 of 4 points" in (folder / f"{ONE}.html").read_text(encoding="utf-8")


def test_what_no_page_can_be_made_of_costs_no_verdict(pages, monkeypatch):
    course, grades, folder = pages
    monkeypatch.setattr(exporter.Feedback, "_whole", lambda *_, **__: 1 / 0)
    said = feedback._one(course, "eve", grades)
    assert said.startswith(f"{ONE}: no page could be made of the notebook") and "division by zero" in said
    text = (folder / f"{ONE}.html").read_text(encoding="utf-8")
    assert BARE.strip("*") in text and "is_rotation: not right yet" in text


@pytest.mark.parametrize("bare", [False, True])
def test_where_nothing_works_a_page_has_the_points(pages, monkeypatch, bare):
    course, grades, folder = pages
    monkeypatch.setattr(exporter.Feedback, "from_notebook_node", lambda *_, **__: 1 / 0)
    assert feedback._one(course, "eve", grades, bare).startswith("the pages hold the points alone: division by zero")
    for name in (ONE, "index"):
        text = (folder / f"{name}.html").read_text(encoding="utf-8")
        assert "<code>is_rotation</code>: 0 of 2" in text and "<code>rotation_about_z</code>: 2 of 2" in text
    assert not feedback.is_complete(course, "eve", grades)  # the next run tries again


def test_pages_that_the_machine_has_no_room_for_are_left_to_the_next_run(pages, monkeypatch):
    """Pages with less in them might fit, and would stay."""
    course, grades, folder = pages

    def full(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patched:
        patched.setattr(exporter.Feedback, "from_notebook_node", full)
        assert feedback._one(course, "eve", grades) == "no feedback: [Errno 28] No space left on device"
    assert not (folder / feedback.SUMMARY).exists() and not feedback.is_complete(course, "eve", grades)
    assert feedback._one(course, "eve", grades) is None
