"""What students may be called, and what a cell of a table may hold."""

import csv
import io
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from autograder.names import UNPRINTABLE, odd, runs, table

ODD = ["", " ann", "ann ", "a\nb", "a\rb", "a\x1b[2Jb", "a\u2028b", "a\u202eb", "a\x00", "a/b", "..", ".", ".ann", "a\\b", "-rf",
       "--force", "=cmd", "+cmd", "@cmd", "＝cmd", "＋1", "a;=1+1", "a\t@b", "a" * 129, "é" * 128, "a\udcff"]  # fmt: skip
NAMES = ["ann", "ann+lab@example.org", "O'Neil", "Müller-Lüdenscheidt", "jörg_1815", "4711", "李雷", "نیک‌آهنگ", "a.b", "Ann Lee",
         "a" * 128, "x=1", "ann-"]  # fmt: skip
FORMULAS = ['=HYPERLINK("http://example.org")', "+1+cmd|' /C calc'!A0", "-2+3", "@SUM(1)", " =1+1", "＝1+1", "\t=1", "\r=1",
            "a;=1", "a; -x"]  # fmt: skip
NO_FORMULAS = [
    "",
    "-",
    "+49 170 1234567",
    "O'Neil",
    "Müller-Lüdenscheidt",
    "-5",
    "a=1",
    "Lovelace, Ada",
    "1.5",
    "chain 0 of 2; a",
]
TEXT = st.text(st.sampled_from("=+-@＝ab1 ,;|\t\r\n\"'\\") | st.characters(codec="utf-8"), max_size=12)


@pytest.mark.parametrize("name", ODD, ids=ascii)
def test_nobody_is_called_so(name):
    assert odd(name).startswith("a student's name ")


@pytest.mark.parametrize("name", NAMES)
def test_somebody_may_be_called_so(name):
    assert odd(name) is None


def test_what_a_spreadsheet_runs():
    assert all(map(runs, FORMULAS)) and not any(map(runs, [*NO_FORMULAS, *NAMES, -2.5, None]))


@given(st.lists(st.lists(TEXT, min_size=1, max_size=4), max_size=4))
def test_nothing_in_a_table_is_run_and_what_would_not_be_is_unchanged(rows):
    text = table(rows)
    read = list(csv.reader(io.StringIO(text, newline="")))
    assert list(map(len, read)) == list(map(len, rows))
    for before, after in ((before, after) for row, now in zip(rows, read) for before, after in zip(row, now)):
        printable = UNPRINTABLE.sub(" ", before)
        assert not runs(after) and (runs(before) or runs(printable) or after == printable)
    # Nor where tables have semicolons or tabs, in which a comma and a quote inside a cell mean nothing.
    assert not [cell for cell in re.split("[;\t\r\n]", text) if re.match(r"\s*[=@＝]", cell)]


@given(TEXT)
def test_a_name_that_is_not_odd_is_no_formula_no_option_and_no_path(name):
    if odd(name) is None:
        assert not runs(name) and not re.search(r"^[-.]|[/\\\n\r]", name)
