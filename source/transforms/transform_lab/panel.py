"""A Verdict as a student reads it: in plain text, and as the same text laid out in HTML.

With `numbers=False` (feedback on the grader's hidden cases) the kind of case is named, never its numbers.
"""

import re
from html import escape

import numpy as np

from . import codec
from .answers import Unfit, parts_of

COLOURS = {"right": "#1b7837", "wrong": "#d9690f", "waiting": "#888888"}  # of bar and mark, on white and on black


def title(verdict):
    """One line: what is right, and what is not."""
    if verdict.right:
        return f"{verdict.exercise}: all right."
    if not verdict.done:
        return f"{verdict.exercise}: not done yet."
    if len(verdict.parts) > 1 and 0 < sum(verdict.parts.values()) < len(verdict.parts) * verdict.cases:
        found = [f"{part} {_how_often(verdict, part)}" for part in verdict.parts]
        return f"{verdict.exercise}: not right yet ({', '.join(found)})."
    return f"{verdict.exercise}: not right yet."


def summary(verdict):
    """What there is to say about an answer that is not right, in one line; nothing about one that is."""
    if verdict.right:
        return ""
    found = f"[{', '.join(verdict.misconceptions)}] " if verdict.misconceptions else ""
    return found + (verdict.says or title(verdict).partition(": ")[2])


def text(verdict, points=None, numbers=True):
    """The whole verdict in plain text, for terminals, screen readers and nbgrader."""
    return "\n".join([title(verdict), *_sentences(verdict, points), *_example(verdict, numbers)])


def html(verdict, points=None, numbers=True):
    """The whole verdict in HTML; every text of the student's is escaped."""
    colour = COLOURS["right" if verdict.right else "wrong" if verdict.done else "waiting"]
    mark = "✓" if verdict.right else "✗" if verdict.done else "…"
    lines = [f'<div style="border-left:4px solid {colour};padding:2px 12px;margin:4px 0">']
    lines.append(f'<strong><span style="color:{colour}">{mark}</span> {escape(title(verdict))}</strong>')
    lines += [f"<div>{_code(escape(sentence))}</div>" for sentence in _sentences(verdict, points)]
    example = "\n".join(_example(verdict, numbers))
    if example:
        lines.append(f'<pre style="margin:6px 0;white-space:pre-wrap;font-family:monospace">{escape(example)}</pre>')
    return "\n".join([*lines, "</div>"])


def _code(text):
    """`code` in a sentence, as HTML."""
    return re.sub(r"`([^`]+)`", r"<code>\1</code>", text)


def _how_often(verdict, part):
    times = verdict.parts[part]
    if times == verdict.cases:
        return "right"
    return "wrong" if times == 0 else f"right in {times} of {verdict.cases} cases"


def _sentences(verdict, points):
    sentences = [] if not verdict.done else [sentence for sentence in (verdict.says, verdict.hint) if sentence]
    if points is not None:
        earned, most = points
        sentences.append(f"{earned:g} of {most:g} points")
    return sentences


def _example(verdict, numbers):
    case = verdict.failing
    if case is None:
        return []
    if not numbers:
        return [f"Kind of case: {case['family']}."]
    lines = [f"For example, {case['family']}:"]
    for position, plain in enumerate(case["args"]):
        named = position < len(verdict.parameters)
        label = verdict.parameters[position] if named else f"argument {position + 1}"
        lines += _labelled(f"  {label}", codec.decode(plain))
    for keyword, plain in case["kwargs"].items():
        lines += _labelled(f"  {keyword}", codec.decode(plain))
    if case["args"] or case["kwargs"]:  # without arguments, the expected answer is the solution
        lines += _labelled("  expected", codec.decode(case["expected"]))
    if verdict.answer is not None:
        lines += _labelled("  yours", verdict.answer)
        lines += _difference(verdict.answer, codec.decode(case["expected"]))
    return lines


def _difference(got, expected):
    """A pose's errors as a distance and an angle, which say more than digits; an array's as its largest one."""
    if isinstance(got, np.ndarray) and isinstance(expected, np.ndarray) and got.shape == expected.shape:
        return [f"  largest difference between two numbers: {np.abs(got - expected).max():.1g}"]
    try:
        one, other = parts_of("pose", got), parts_of("pose", expected)
    except Unfit:
        return []
    distance = np.linalg.norm(one["position"] - other["position"])
    lines = [f"  distance between the positions: {round(distance, 9):.4g} m"]
    lengths = np.linalg.norm(one["orientation"]) * np.linalg.norm(other["orientation"])
    if lengths > 0:
        cosine = min(1.0, abs(float(one["orientation"] @ other["orientation"])) / lengths)
        lines.append(f"  angle between the orientations: {np.degrees(2 * np.arccos(cosine)):.4g} degrees")
    return lines


def _labelled(label, value):
    if hasattr(value, "position") and hasattr(value, "orientation"):
        return [
            f"{label}:",
            f"    position     {_fields(value.position, 'xyz')}",
            f"    orientation  {_fields(value.orientation, 'xyzw')}",
        ]
    if isinstance(value, (list, np.ndarray)):
        try:
            array = np.array(value, dtype=float)
        except (TypeError, ValueError):
            return [f"{label}: {value}"]
        if array.ndim > 1:
            rows = np.array2string(array.round(4) + 0.0, suppress_small=True, floatmode="maxprec").splitlines()
            return [f"{label}:", *(f"    {row}" for row in rows)]
        return [f"{label}: {_vector(array)}"]
    if isinstance(value, codec.Other):
        return [f"{label}: an object of type {value.type_name}"]
    return [f"{label}: {round(value, 4) if isinstance(value, float) else value}"]


def _fields(message, letters):
    if not all(hasattr(message, letter) for letter in letters):
        return str(message)
    return "  ".join(f"{letter} {_short(getattr(message, letter))}" for letter in letters)


def _vector(array):
    return "[" + ", ".join(_short(number) for number in array) + "]"


def _short(number):
    if isinstance(number, (bool, int, float, np.number)):
        return f"{round(float(number), 4) + 0.0:g}"
    return str(number)
