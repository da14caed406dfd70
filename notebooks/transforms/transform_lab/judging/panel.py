"""A Verdict as a student reads it: in plain text, and as the same text laid out in HTML.

With `numbers=False` (feedback on the grader's hidden cases) the kind of case is named, never its numbers.
"""

import re
from html import escape
from itertools import zip_longest

import numpy as np

from . import codec
from .answers import Unfit, agree, kind_of, matrix_of, parts_of

COLOURS = {"right": "#1b7837", "wrong": "#d9690f", "waiting": "#888888"}  # of bar and mark, on white and on black


def title(verdict):
    """One line: what is right, and what is not."""
    if verdict.right:
        return f"{verdict.exercise}: all right."
    if not verdict.done:
        return f"{verdict.exercise}: not done yet."
    if 0 < sum(verdict.parts.values()) < len(verdict.parts) * verdict.cases:
        several = len(verdict.parts) > 1
        found = [f"{part if several else ''} {_how_often(verdict, part)}".strip() for part in verdict.parts]
        return f"{verdict.exercise}: not right yet ({', '.join(found)})."
    return f"{verdict.exercise}: not right yet."


def summary(verdict):
    """What there is to say about an answer that is not right, in one line; nothing about one that is."""
    found = [f"[{', '.join(verdict.misconceptions)}]"] if verdict.misconceptions else []
    return " ".join([*found, *(says for says, _ in mistakes(verdict))])


def mistakes(verdict):
    """What is not right and what helps, [(says, hint), …], a pair for each mistake; of a right answer, []."""
    if verdict.right:
        return []
    pairs = zip_longest(verdict.says.split("\n"), verdict.hint.split("\n"), fillvalue="")
    return [(says or title(verdict).partition(": ")[2], hint) for says, hint in pairs]


def text(verdict, points=None, numbers=True):
    """The whole verdict in plain text, for terminals, screen readers and nbgrader."""
    return "\n".join([title(verdict), *_sentences(verdict, points), *_example(verdict, numbers)])


def html(verdict, points=None, numbers=True):
    """The whole verdict in HTML; every text of the student's is escaped."""
    state = "right" if verdict.right else "wrong" if verdict.done else "waiting"
    mark = {"right": "✓", "wrong": "✗", "waiting": "…"}[state]
    headline = f'<strong><span style="color:{COLOURS[state]}">{mark}</span> {escape(title(verdict))}</strong>'
    sentences = [f"<div>{with_code(sentence)}</div>" for sentence in _sentences(verdict, points)]
    return beside_a_bar([headline, *sentences, example(verdict, numbers)], state)


def beside_a_bar(pieces, state="wrong"):
    """Pieces of HTML beside a bar in the colour of what is "right", "wrong" or "waiting"."""
    style = f"border-left:4px solid {COLOURS[state]};padding:2px 12px;margin:4px 0"
    return "\n".join([f'<div style="{style}">', *pieces, "</div>"])


def example(verdict, numbers=True):
    """The first case that is not right in HTML: what the function was given, what was expected, what came."""
    lines = escape("\n".join(_example(verdict, numbers)))
    return f'<pre style="margin:6px 0;white-space:pre-wrap;font-family:monospace">{lines}</pre>' if lines else ""


def with_code(sentence):
    """A sentence (text) as HTML, with its `code` set as code."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", escape(sentence))


def _how_often(verdict, part):
    times = verdict.parts[part]
    if times == verdict.cases:
        return "right"
    return "wrong" if times == 0 else f"right in {times} of {verdict.cases} cases"


def _sentences(verdict, points):
    sentences = []
    if verdict.done and verdict.says:
        found = mistakes(verdict)
        sentences = [sentence for sentence in found[0] if sentence]
        if len(found) > 1:  # each hint beside the mistake that it belongs to
            sentences = [f"{number}. {' '.join(pair)}".rstrip() for number, pair in enumerate(found, 1)]
    if points is not None:
        earned, most = points
        sentences.append(f"{earned:g} of {most:g} points")
    return sentences


# --- one case in numbers --------------------------------------------------------------------------------------------


def _example(verdict, numbers):
    """The first case that is not right: what the function was given, what was expected, what came."""
    case = verdict.failing
    if case is None:
        return []
    if not numbers:
        return [f"Kind of case: {case['family']}."]
    names = verdict.parameters
    if names and names[-1].startswith("*"):
        names = [f"{names[-1][1:]}[{index}]" for index in range(len(case["args"]))]
    given = {name: codec.decode(plain) for name, plain in (*zip(names, case["args"]), *case["kwargs"].items())}
    yours = _labelled("yours", verdict.answer) if verdict.answer is not None else []
    if verdict.error and verdict.error not in verdict.says:
        yours = [f"  yours  {verdict.error}"]
    if not given:  # the expected answer of a function without arguments is the solution
        return yours
    lines = [f"For example, {case['family']}:"]
    for name, value in given.items():
        lines += _labelled(name, value)
    expected = codec.decode(case["expected"])
    try:
        parts = parts_of(verdict.returns, verdict.answer), parts_of(verdict.returns, expected)
    except Unfit:
        return lines + _labelled("expected", expected) + yours
    return lines + _compared(verdict.returns, *parts)


def _compared(returns, got, expected):
    """The expected answer against the student's, part by part, with how far each is off."""
    off = {part: _off(part, got[part], right) for part, right in expected.items()}
    if returns == "truth":
        return [f"  {who:10}{bool(value['answer'])}" for who, value in (("expected", expected), ("yours", got))]
    if "rotation" in expected:
        left, right = _in_columns(matrix_of(expected), matrix_of(got))
        indent = len(left[0]) + 4
        lines = [f"  {'expected':{indent}}yours", *(f"  {one:{indent}}{other}" for one, other in zip(left, right))]
        return [*lines, *(f"  {part}: {what}" for part, what in off.items())]
    width = max(len(part) for part in expected) + 2 if len(expected) > 1 else 0
    lines = []
    for part, right in expected.items():
        lines.append(f"  {part if width else '':{width}}expected  {_row(right)}")
        lines.append(f"  {'':{width}}yours     {_row(got[part])}   {off[part]}")
    return lines


def _off(part, got, expected):
    """How far one part is off, in words: metres for a place, degrees for a turn."""
    if agree(part, got, expected):
        return "right"
    if part in ("position", "translation", "coordinates"):
        return f"off by {np.linalg.norm(got - expected):.3g} m"
    if part == "rotation":
        if np.abs(got.T @ got - np.eye(3)).max() > 1e-3:
            return "not a rotation: its columns are not all of length 1 and at right angles"
        if np.linalg.det(got) < 0:
            return "a mirror image, not a rotation: the axes are left-handed"
        return f"off by {_degrees('from_matrix', got, expected)}"
    if part == "orientation":
        largest = np.abs(got).max()
        if largest < 1e-9:
            return "no orientation: all four numbers are 0"
        length, turn = np.linalg.norm(got), _degrees("from_quat", got / largest, expected)
        return f"off by {turn}" if abs(length - 1) < 1e-3 else f"off by {turn}, and of length {length:.3g}"
    return "wrong"


def _degrees(form, got, expected):
    from scipy.spatial.transform import Rotation  # only now: it takes long to import

    one, other = (getattr(Rotation, form)(value) for value in (got, expected))
    return f"{np.degrees((one.inv() * other).magnitude()):.3g} degrees"


def _labelled(label, value):
    """Lines that show a value of any kind under its name."""
    if hasattr(value, "position") and hasattr(value, "orientation"):
        fields = {name: getattr(value, name) for name in ("position", "orientation")}
        return [f"  {label}", *(f"    {name:13}{_field(field)}" for name, field in fields.items())]
    if isinstance(value, (list, np.ndarray)):
        try:
            array = np.array(value, dtype=float)
        except (TypeError, ValueError):
            return [f"  {label}  {str(value)[:200]}"]
        if not 0 < array.size <= 16:
            return [f"  {label}  {kind_of(array)}"]
        if array.ndim == 2:
            return [f"  {label}", *(f"    {row}" for row in _in_columns(array)[0])]
        return [f"  {label}  {_row(array)}" if array.ndim == 1 else f"  {label}  {kind_of(array)}"]
    if isinstance(value, codec.Other):
        return [f"  {label}  an object of type {value.type_name}"]
    return [f"  {label}  {_short(value)}"]


def _field(value):
    """A field of a Pose; what is no message is said to be what it is."""
    return _row(value) if hasattr(value, "x") else f"{kind_of(value)}: {_row(value)}"


def _in_columns(*matrices):
    """For each matrix the lines that show its rows, all columns of the same width."""
    cells = [[[_short(number) for number in row] for row in matrix] for matrix in matrices]
    width = max(len(cell) for rows in cells for row in rows for cell in row)
    return [["  ".join(f"{cell:>{width}}" for cell in row) for row in rows] for rows in cells]


def _row(value):
    """A vector, a quaternion or a message's fields in one line, each number with its letter where it has one."""
    if isinstance(value, np.ndarray):
        value = value.reshape(-1).tolist()
    elif hasattr(value, "x"):
        value = [getattr(value, letter) for letter in "xyzw" if hasattr(value, letter)]
    if not isinstance(value, list):
        return str(value)
    letters = "xyzw" if len(value) in (3, 4) else [""] * len(value)
    return "   ".join(f"{letter} {_short(number)}".strip() for letter, number in zip(letters, value))


def _short(number):
    if isinstance(number, (float, np.floating)):
        return f"{round(float(number), 4) + 0.0:g}"
    return repr(number) if isinstance(number, str) else str(number)
