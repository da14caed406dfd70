"""Names in which students have a say, and the programs that take some of them for more than a name: commands for options,
terminals for orders, file systems for paths, spreadsheets for formulas. What a student may be called is said here alone,
and so is what a cell of a table may hold.
"""

import csv
import io
import re
from collections.abc import Iterable, Sequence

LONGEST = 128  # characters of a student's id in nbgrader's table
# Controls, line ends, what turns the direction of text, and halves of characters.
UNPRINTABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")
# What Excel and its like take for a formula, unless it is a number or a lone dash: at the start of a cell, and behind what
# divides cells in countries whose tables have semicolons. Behind a comma it cannot be: such cells stand in quotes.
FORMULA = re.compile(r"((?:^|;)\s*)(?=[=@＝＠]|[+\-＋－](?![\d\s]*$))")


def odd(student: str) -> str | None:
    """Why nobody may be called so, in words; None for what can be a student's id, which is also a folder's name."""
    if not student or student != student.strip():
        return "a student's name is not empty, and neither begins nor ends with a space"
    if UNPRINTABLE.search(student):
        return "a student's name has no line ends and no other characters that cannot be printed"
    if re.search(r"[/\\]", student):
        return "a student's name has no / and no \\, which lead to other folders"
    if re.match("[-+=@.＝＠＋－]", student) or FORMULA.search(student):
        return (
            "a student's name begins with no - + = @ or dot, which commands and spreadsheets take for more than a name"
        )
    if len(student) > LONGEST or len(student.encode()) > 255:
        return f"a student's name has at most {LONGEST} characters, and 255 bytes"
    return None


def runs(cell: object) -> bool:
    """Whether a spreadsheet would run a cell of a table as a formula."""
    return isinstance(cell, str) and FORMULA.search(cell) is not None


def table(rows: Iterable[Sequence]) -> str:
    """CSV text of rows of cells; an apostrophe before what a spreadsheet would run has it shown as text.

    What cannot be printed becomes a space: behind a tab or a line end, a new cell could begin.
    """
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows([_inert(cell) for cell in row] for row in rows)
    return text.getvalue()


def _inert(cell):
    return FORMULA.sub(r"\1'", UNPRINTABLE.sub(" ", cell)) if isinstance(cell, str) else cell
