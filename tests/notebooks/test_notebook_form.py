"""The form of the notebooks: each idea is seen, said, predicted, done and checked; links resolve; the end is as in the others."""

import re

import nbformat
import pytest
from support import ROOT

TEXTS = ROOT / "source/transforms"
NOTEBOOKS = sorted(TEXTS.glob("*.ipynb"))
NAMES = [path.stem for path in NOTEBOOKS]
PAGES = sorted(TEXTS.glob("*.md"))
TEACHES_NO_IDEA = ("Question:", "Three mistakes", "Where a robot uses this", "Summary")
MOVES = re.compile(r"\.interact\(|\banimate")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")


def cells(path):
    return nbformat.read(path, as_version=4).cells


def prose(path):
    return [cell for cell in cells(path) if cell.cell_type == "markdown"]


def sections(path):
    """{heading: its cells} of the sections under ## headings; the opening is under ""."""
    found = {"": []}
    for cell in cells(path):
        title = re.search(r"^## (.+)$", cell.source, re.MULTILINE) if cell.cell_type == "markdown" else None
        if title:
            assert title.start() == 0, f"{cell.id}: a section begins with its cell"
            found[title[1]] = []
        found[list(found)[-1]].append(cell)
    return found


IDEAS = [
    pytest.param(path, title, id=f"{path.stem}: {title}")
    for path in NOTEBOOKS
    for title in sections(path)
    if title and not title.startswith(TEACHES_NO_IDEA)
]


@pytest.mark.parametrize("path, title", IDEAS)
def test_an_idea_is_seen_said_predicted_done_and_checked(path, title):
    inside = sections(path)[title]
    text = "\n".join(cell.source for cell in inside if cell.cell_type == "markdown")
    code = [cell for cell in inside if cell.cell_type == "code"]
    lacking = {
        "see: **See it.** and a cell that moves": "**See it.**" in text
        and any(MOVES.search(cell.source) for cell in code),
        "say: **Say it.** and a formula after it": re.search(r"^\*\*Say it\.\*\*.*\$", text, re.MULTILINE | re.DOTALL),
        "predict: **Predict.** and a folded answer after it": re.search(
            r"\*\*Predict\.\*\*.*?<details><summary>Answer</summary>", text, re.DOTALL
        ),
    }
    assert not [what for what, there in lacking.items() if not there]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=NAMES)
def test_a_prediction_can_be_answered_before_it_is_unfolded(path):
    """A question that ends its cell, a cell with a place to answer, and after that what unfolds or runs."""
    every = cells(path)
    for place, cell in enumerate(every):
        assert cell.source.count("**Predict.**") <= 1, cell.id
        if "**Predict.**" in cell.source:
            assert "<details><summary>Answer" not in cell.source, (
                f"{cell.id}: the place to answer comes before the answer"
            )
            following = every[place + 1 :]
            answered = next(
                i for i, after in enumerate(following) if re.search(r"^predict\(", after.source, re.MULTILINE)
            )
            assert following[answered].metadata.jupyter.source_hidden, f"{cell.id}: the answer stands in the open code"
            assert "<details>" not in "".join(after.source for after in following[:answered]), cell.id
            assert "**Predict.**" not in "".join(after.source for after in following[:answered]), cell.id


@pytest.mark.parametrize("path", NOTEBOOKS, ids=NAMES)
def test_an_exercise_is_a_heading_a_cell_to_fill_in_and_its_check(path):
    every = cells(path)
    headings = {}
    for place, cell in enumerate(every):
        for name in re.findall(r"^### Exercise: `(\w+)`", cell.source, re.MULTILINE):
            headings[name] = place
    tests = [cell.metadata.nbgrader.grade_id for cell in every if cell.source.startswith("check(")]
    assert list(headings) == tests
    for name, place in headings.items():
        solution, test = every[place + 1 : place + 3]
        assert f"def {name}(" in solution.source and solution.metadata.nbgrader.solution, name
        assert test.source == f'check("{name}", {name})', name


@pytest.mark.parametrize("path", NOTEBOOKS, ids=NAMES)
def test_folded_answers_have_a_summary_and_are_closed(path):
    for cell in prose(path):
        tags = re.findall(r"</?details>(?:<summary>[^<]+</summary>)?", cell.source)
        opened, closed = tags[0::2], tags[1::2]
        assert all(tag.startswith("<details><summary>") for tag in opened), cell.id
        assert len(opened) == len(closed) and set(closed) <= {"</details>"}, cell.id


@pytest.mark.parametrize("path", NOTEBOOKS, ids=NAMES)
def test_a_notebook_opens_and_ends_as_the_others(path):
    every, parts = cells(path), sections(path)
    assert "**Afterwards you can**" in every[0].source and "](conventions.md)" in every[0].source
    assert list(parts)[-3:] == ["Three mistakes people make here", "Where a robot uses this", "Summary"]
    assert every[-1].source == f'sum_up("{path.stem}")'
    assert set(LINK.findall(every[0].source)) >= {
        *(f"{name}.ipynb" for name in NAMES if name != path.stem),
        "glossary.md",
        "card.md",
    }

    mistakes = parts["Three mistakes people make here"]
    words, pictures = mistakes[0::2], mistakes[1::2]
    assert len(words) == len(pictures) == 3
    for said, shown in zip(words, pictures):
        assert len(re.findall(r"^### ", said.source, re.MULTILINE)) == 1, said.id
        assert shown.cell_type == "code" and "show_mistake(" in shown.source, shown.id


def anchors(text):
    """The anchors that Jupyter gives to headings: their words with - between them."""
    return {title.strip().replace(" ", "-") for title in re.findall(r"^#+ (.+)$", text, re.MULTILINE)}


def text_of(path):
    return path.read_text(encoding="utf-8") if path.suffix == ".md" else "\n\n".join(c.source for c in prose(path))


@pytest.mark.parametrize("path", [*NOTEBOOKS, *PAGES], ids=[*NAMES, *(page.stem for page in PAGES)])
def test_links_resolve_and_stay_in_the_folder(path):
    text = text_of(path)
    assert not re.search(r"https?://|\bwww\.", text)
    assert not re.search(r"<(a|img)\b|!\[", text), "a picture or link of its own: test it here, too"
    links = LINK.findall(text)
    assert links
    for link in links:
        file, _, anchor = link.partition("#")
        target = path.parent / file if file else path
        assert target.is_file() and target.parent == TEXTS, link
        assert not anchor or anchor in anchors(text_of(target)), link
    for label, file in re.findall(r"\[(?:notebook )?(\d)\]\((\d)_", text):
        assert label == file, f"the link [{label}] leads to notebook {file}"
