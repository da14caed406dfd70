"""A place to answer a prediction, in a browser: what is typed or clicked, and what is said of it."""

import json
import shutil

import nbformat
import numpy as np
import pytest
from jupyter_lab import Opened, Server
from support import ROOT, wait_for
from transform_lab import predict
from transform_lab.predictions import ON_PAPER, place

NAME = "1_rotation"
VECTOR = [2.0, -0.5, 0.0], [[[2.0, 0.5, 0.0], "y counts to the left."]]
NUMBER = [0.70711], [[[0.5], "Half of it <b>squared</b>."]]
TEXT = "the index finger", [["the thumb", "It points to the left now."], ["a finger", "Which?"]]


def answer(page, *typed):
    """Type into the fields, one after the other, and press Enter in the last; return what is said then."""
    for field, text in zip(page.locator("input").all(), typed, strict=True):
        field.fill(text)
    page.locator("input").last.press("Enter")
    return page.locator("output").inner_text()


@pytest.mark.parametrize(
    "asked, typed, says",
    [
        (VECTOR, ("2", "-0.5", "0"), "✓ Yes"),
        (VECTOR, ("2", "−1/2", "0.004"), "✓ Yes"),
        (VECTOR, ("2,0", " - ,5 ", "-0"), "✓ Yes"),
        (VECTOR, ("2", "0.5", "0"), "✗ y counts to the left."),
        (VECTOR, ("2", "1", "0"), "✗ x and z are right, the rest is not yet."),
        (VECTOR, ("2", "1", "1"), "✗ x is right, the rest is not yet."),
        (VECTOR, ("1", "1", "1"), "✗ Not yet"),
        (VECTOR, ("2", "", "0"), "✗ Write a number for y"),
        (VECTOR, ("2", "left", "0"), "✗ Write a number for y"),
        (NUMBER, ("0.71",), "✓ Yes"),
        (NUMBER, ("0.7071°",), "✓ Yes"),
        (NUMBER, ("0.7",), "✓ Yes"),
        (NUMBER, ("0.69",), "✗ Not yet"),
        (NUMBER, ("1/2",), "✗ Half of it <b>squared</b>."),
        (NUMBER, ("1/0",), "✗ Not yet"),
        (NUMBER, ("half",), "✗ Write a number, such as"),
    ],
)
def test_numbers_are_typed(page, asked, typed, says):
    page.set_content(place(*asked))
    assert answer(page, *typed).startswith(says)


def test_a_text_is_chosen_with_the_keyboard_alone(page):
    page.set_content(place(*TEXT))
    assert page.locator("button").all_inner_texts() == ["a finger", "the index finger", "the thumb"]
    said = []
    for _ in range(3):
        page.keyboard.press("Tab")
        page.keyboard.press("Space")
        said.append(page.locator("output").inner_text())
        assert page.locator("button[aria-pressed=true]").count() == 1
    assert [words[:3] for words in said] == ["✗ W", "✓ Y", "✗ I"]


def test_each_field_has_a_name_and_what_is_said_is_read_out(page):
    page.set_content(place(*VECTOR))
    assert [page.get_by_label(name, exact=True).count() for name in "xyz"] == [1, 1, 1]
    assert page.locator("output").get_attribute("aria-live") == "polite"


def test_numbers_are_called_what_they_are(page):
    page.set_content(place([1.0, 0.5, 90.0], [], "The settings", ["forward", "left", "degrees"]))
    assert page.locator("form").inner_text().startswith("The settings:")
    for name, number in (("forward", "1"), ("left", "0"), ("degrees", "90")):
        page.get_by_label(name, exact=True).fill(number)
    page.get_by_role("button").click()
    assert page.locator("output").inner_text() == "✗ forward and degrees are right, the rest is not yet."


def test_two_on_one_page_do_not_disturb_each_other(page):
    page.set_content(place(*VECTOR) + place(*TEXT) + place(*NUMBER))
    assert page.locator("form").count() == 3 and page.locator("input").count() == 4
    page.get_by_text("the index finger").click()
    assert page.locator("output").all_inner_texts() == ["", "✓ Yes. Read on: is it your reason, too?", ""]


def test_without_scripts_an_answer_on_paper_is_asked_for(browser):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.set_content(place(*VECTOR))
    assert page.inner_text("body").strip() == f"Your answer: {ON_PAPER}"
    context.close()


@pytest.mark.parametrize(
    "answer, wrong, message",
    [
        ("left", {}, "chosen among others"),
        ("left", {(1, 2): "no"}, "another kind"),
        ([1, 2, 3], {(1, 2): "no"}, "another kind"),
        (np.eye(3)[0], {"left": "no"}, "another kind"),
        (range(5), {}, "5 numbers need as many names"),
    ],
)
def test_what_cannot_be_asked_is_refused(answer, wrong, message):
    with pytest.raises(ValueError, match=message):
        predict(answer, wrong)


def test_nothing_is_said_in_a_script(capsys):
    predict([2, -0.5, 0], {(2, 0.5, 0): "y counts to the left."})
    assert capsys.readouterr().out == ""


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    running = Server(tmp_path_factory.mktemp("jupyter") / "work")
    yield running
    running.stop()


@pytest.fixture(scope="module")
def solved(run_all, tmp_path_factory):
    """The file of a solved notebook with its outputs, and the cells (their numbers) that ask for a prediction."""
    notebook = run_all(
        nbformat.read(ROOT / f"source/transforms/{NAME}.ipynb", as_version=4), ROOT / "source/transforms"
    )
    path = tmp_path_factory.mktemp("solved") / f"{NAME}.ipynb"
    nbformat.write(notebook, path)
    return path, [i for i, cell in enumerate(notebook.cells) if "data-predict" in json.dumps(cell.get("outputs", []))]


def test_the_first_two_of_a_notebook_carry_the_script(solved):
    path, cells = solved
    every = nbformat.read(path, as_version=4).cells
    shown = [output.data["text/html"] for i in cells for output in every[i].outputs]
    assert len(shown) == 10 and ["<script>" in html for html in shown] == [True, True] + [False] * (len(shown) - 2)


def scrolled_to(page, cell):
    page.evaluate("i => window.jupyterapp.shell.currentWidget.content.scrollToItem(i, 'center')", cell)
    return page.locator(f'.jp-Cell[data-windowed-list-index="{cell}"]')


def trust(page):
    page.evaluate(
        "() => { for (const cell of window.jupyterapp.shell.currentWidget.content.model.cells) cell.trusted = true; }"
    )


def test_a_saved_notebook_without_a_kernel_answers(page, server, solved):
    path, cells = solved
    shutil.copy(path, server.folder / "saved.ipynb")
    notebook = Opened(page, server, "saved")
    server.stop_kernels()
    trust(page)
    for number in cells:
        cell = scrolled_to(page, number)
        cell.locator("form :is(input, button)").first.wait_for()
    notebook.activate(cells[0])
    notebook.command("notebook:delete-cell")
    last = scrolled_to(page, cells[-1] - 1)
    for field, number in zip(last.locator("input").all(), ("0", "0", "0", "-1"), strict=True):
        field.fill(number)
    last.get_by_role("button").click()
    wait_for(lambda: last.locator("output").inner_text().startswith("✓ Yes"))


def test_an_untrusted_copy_asks_for_an_answer_on_paper(page, server, solved):
    path, cells = solved
    shutil.copy(path, server.folder / "untrusted.ipynb")
    Opened(page, server, "untrusted")
    for number in cells:
        cell = scrolled_to(page, number)
        cell.get_by_text(ON_PAPER).first.wait_for()
        assert cell.locator(":is(input, form button, output)").count() == 0
