"""Graded notebooks are written as nbformat writes them, letter by letter."""

import nbformat
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support import ROOT

from autograder.grading import writing
from autograder.grading.writing import text_of

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inside: st.lists(inside, max_size=3) | st.dictionaries(st.text(), inside, max_size=3),
    max_leaves=6,
)
METADATA = st.dictionaries(
    st.sampled_from(["nbgrader", "trusted", "signature", "cells", "ü"]) | st.text(), PLAIN, max_size=3
)
TEXT = st.text() | st.sampled_from(["", "\n", "a\nb", "a\r\nb\x0b\x85\u2028c", '"cells": []', "é\\u00e9\ud800"])
DATA = st.dictionaries(
    st.sampled_from(["text/plain", "text/html", "image/png", "image/svg+xml", "application/javascript"]),
    TEXT,
    max_size=3,
)
OUTPUT = st.one_of(
    st.builds(nbformat.v4.new_output, st.just("stream"), text=TEXT, name=st.just("stdout")),
    st.builds(nbformat.v4.new_output, st.just("display_data"), DATA, metadata=METADATA),
    st.builds(nbformat.v4.new_output, st.just("execute_result"), DATA, execution_count=st.none() | st.integers(0, 99)),
    st.builds(nbformat.v4.new_output, st.just("error"), ename=TEXT, evalue=TEXT, traceback=st.lists(TEXT, max_size=2)),
)
CELL = st.one_of(
    st.builds(nbformat.v4.new_markdown_cell, TEXT, metadata=METADATA),
    st.builds(nbformat.v4.new_markdown_cell, TEXT, attachments=st.dictionaries(st.text(), DATA, max_size=2)),
    st.builds(
        nbformat.v4.new_code_cell, TEXT, metadata=METADATA, outputs=st.lists(OUTPUT, max_size=3),
        execution_count=st.none() | st.integers(0, 99),
    ),
)  # fmt: skip


@given(cells=st.lists(CELL, max_size=4), metadata=METADATA)
def test_any_notebook(cells, metadata):
    notebook = nbformat.from_dict({"cells": cells, "metadata": metadata, "nbformat": 4, "nbformat_minor": 5})
    wanted = nbformat.v4.writes(notebook)
    assert text_of(notebook) == wanted
    assert text_of(notebook) == wanted  # nor is anything changed by writing it, or by what was kept
    assert nbformat.v4.writes(notebook) == wanted


@pytest.mark.parametrize(
    "path", sorted(ROOT.glob("*/transforms/*.ipynb")), ids=lambda path: f"{path.parts[-3]} {path.stem[0]}"
)
def test_the_courses_notebooks(path):
    notebook = nbformat.read(path, as_version=4)
    assert text_of(notebook) == nbformat.v4.writes(notebook)


def test_a_long_cell_is_not_kept():
    """A class's pictures would fill the memory."""
    before = writing._kept.cache_info().currsize
    text_of(nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("x" * writing.MOST_KEPT)]))
    assert writing._kept.cache_info().currsize == before
