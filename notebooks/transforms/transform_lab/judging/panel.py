"""A Verdict as a student reads it: in plain text, and as the same text laid out in HTML.

With `numbers=False` (feedback on the grader's hidden cases) the kind of case is named, never its numbers.
"""

import re
from html import escape
from itertools import zip_longest

from . import codec
from .answers import parts_of
from .kinds import KINDS
from .lines import labelled
from .reading import Unfit
from .verdict import Verdict

COLOURS = {"right": "#1b7837", "wrong": "#d9690f", "waiting": "#888888"}  # of bar and mark, on white and on black


def title(verdict: Verdict) -> str:
    """One line: what is right, and what is not."""
    if verdict.right:
        return f"{verdict.exercise}: all right."
    if verdict.status in ("missing", "unreadable"):
        return f"{verdict.exercise}: not graded."
    if not verdict.done:
        return f"{verdict.exercise}: not done yet."
    if 0 < sum(verdict.parts.values()) < len(verdict.parts) * verdict.cases:
        several = len(verdict.parts) > 1
        found = [f"{part if several else ''} {_how_often(verdict, part)}".strip() for part in verdict.parts]
        return f"{verdict.exercise}: not right yet ({', '.join(found)})."
    return f"{verdict.exercise}: not right yet."


def summary(verdict: Verdict) -> str:
    """What there is to say about an answer that is not right, in one line; nothing about one that is."""
    found = [f"[{', '.join(verdict.misconceptions)}]"] if verdict.misconceptions else []
    return " ".join([*found, *(says for says, _ in mistakes(verdict))])


def mistakes(verdict: Verdict) -> list[tuple[str, str]]:
    """What is not right and what helps, [(says, hint), …], a pair for each mistake; of a right answer, []."""
    if verdict.right:
        return []
    pairs = zip_longest(verdict.says.split("\n"), verdict.hint.split("\n"), fillvalue="")
    return [(says or title(verdict).partition(": ")[2], hint) for says, hint in pairs]


def text(verdict: Verdict, points: tuple[float, float] | None = None, numbers: bool = True) -> str:
    """The whole verdict in plain text, for terminals, screen readers and nbgrader."""
    return "\n".join([title(verdict), *_sentences(verdict, points), *_example(verdict, numbers)])


def html(verdict: Verdict, points: tuple[float, float] | None = None, numbers: bool = True) -> str:
    """The whole verdict in HTML; every text of the student's is escaped."""
    state = "right" if verdict.right else "wrong" if verdict.done else "waiting"
    return headed(title(verdict), _sentences(verdict, points), state, example(verdict, numbers))


def headed(headline, sentences, state, below=""):
    """A headline with the mark of its state and sentences below it (text), then a piece of HTML; beside a bar."""
    mark = {"right": "✓", "wrong": "✗", "waiting": "…"}[state]
    first = f'<strong><span style="color:{COLOURS[state]}">{mark}</span> {escape(headline)}</strong>'
    return beside_a_bar([first, *(f"<div>{with_code(sentence)}</div>" for sentence in sentences), below], state)


def beside_a_bar(pieces, state="wrong"):
    """Pieces of HTML beside a bar in the colour of what is "right", "wrong" or "waiting"."""
    style = f"border-left:4px solid {COLOURS[state]};padding:2px 12px;margin:4px 0"
    return "\n".join([f'<div style="{style}">', *pieces, "</div>"])


def example(verdict, numbers=True):
    """The first case that is not right in HTML: what the function was given, what was expected, what came."""
    lines = escape("\n".join(_example(verdict, numbers)))
    return (
        f'<pre style="margin:6px 0;overflow-x:auto;white-space:pre;font-family:monospace">{lines}</pre>'
        if lines
        else ""
    )


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
    yours = labelled("yours", verdict.answer) if verdict.answer is not None else []
    if verdict.error and verdict.error not in verdict.says:
        yours = [f"  yours  {verdict.error}"]
    if not given:  # the expected answer of a function without arguments is the solution
        return yours
    lines = [f"For example, {case['family']}:"]
    for name, value in given.items():
        lines += labelled(name, value)
    expected = codec.decode(case["expected"])
    try:
        parts = parts_of(verdict.returns, verdict.answer), parts_of(verdict.returns, expected)
    except Unfit:
        return lines + labelled("expected", expected) + yours
    return lines + _compared(verdict.returns, *parts)


def _compared(returns, got, expected):
    """The expected answer against the student's, part by part, with how far each is off."""
    kind = KINDS[returns]
    return kind.show(got, expected, {name: part.off(got[name], expected[name]) for name, part in kind.parts.items()})
