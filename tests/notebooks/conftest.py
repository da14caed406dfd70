"""A page of a browser, for the notebooks in whatever application they are opened."""

import re

import pytest
from support import PATIENCE


@pytest.fixture
def page(browser):
    """A page in which nothing of ours may complain: an error on the console is an error of the test."""
    context = browser.new_context(viewport={"width": 1100, "height": 900})
    context.set_default_timeout(1000 * PATIENCE)
    found, opened = [], context.new_page()
    opened.on("pageerror", lambda error: found.append((str(error), re.search(r"at .*|$", error.stack or "")[0])))
    opened.on("console", lambda said: said.type == "error" and found.append((said.text, said.location["url"])))
    yield opened
    context.close()
    # Jupyter's own scripts and addresses, and what a page from disk fetches for its formulas
    others = re.compile(r"/user/x/(static|api|lab|files)/|favicon|net::ERR_|ResizeObserver loop")
    assert [(text, where) for text, where in found if not others.search(text + where)] == []
