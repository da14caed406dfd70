"""A place to answer a prediction, in a browser: what is typed or clicked, and what is said of it."""

import numpy as np
import pytest
from transform_lab import predict
from transform_lab.predictions import ON_PAPER, place

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
        (NUMBER, ("0.7",), "✗ Not yet"),
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


def test_two_on_one_page_do_not_disturb_each_other(page):
    page.set_content(place(*VECTOR) + place(*TEXT) + place(*NUMBER))
    assert page.locator("form").count() == 3 and page.locator("input").count() == 4
    page.get_by_text("the index finger").click()
    assert page.locator("output").all_inner_texts() == ["", "✓ Yes. Unfold the answer: is it your reason, too?", ""]


def test_without_scripts_an_answer_on_paper_is_asked_for(browser):
    context = browser.new_context(java_script_enabled=False)
    page = context.new_page()
    page.set_content(place(*VECTOR))
    assert page.inner_text("body").strip() == ON_PAPER
    context.close()


@pytest.mark.parametrize(
    "answer, wrong, message",
    [
        ("left", {}, "chosen among others"),
        ("left", {(1, 2): "no"}, "another kind"),
        ([1, 2, 3], {(1, 2): "no"}, "another kind"),
        (np.eye(3)[0], {"left": "no"}, "another kind"),
    ],
)
def test_what_cannot_be_asked_is_refused(answer, wrong, message):
    with pytest.raises(ValueError, match=message):
        predict(answer, wrong)


def test_nothing_is_said_in_a_script(capsys):
    predict([2, -0.5, 0], {(2, 0.5, 0): "y counts to the left."})
    assert capsys.readouterr().out == ""
