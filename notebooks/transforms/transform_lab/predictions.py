"""A place to answer a prediction before its answer is unfolded: it says yes, or why not.

It works wherever a notebook's scripts run, in a saved one without a kernel, too. Where they do not, it asks for an answer on
paper. Nothing is kept and nothing is sent.
"""

import json
from functools import cache
from html import escape
from pathlib import Path

import numpy as np

from .jupyter import being_graded, shell

__all__ = ["predict"]

# VS Code has each output in a shadow root, in which a script does not find it: from there the output has to call the script.
REACHED = "window.transformLabPredict?.(this.parentNode)"
ON_PAPER = "Answer on paper, then unfold the answer below."


def predict(answer, wrong=()):
    """Show a place to type or click an answer; it is compared in the page itself.

    answer: a number; several, as a list or an array, each of which has a field of its own, to half a hundredth (of large ones,
        half a percent); or a text, which is chosen among the `wrong` ones
    wrong: {wrong answer: why it is wrong, in a sentence}; several numbers as a tuple

    Raises ValueError for a text without wrong ones to choose among, and for a wrong answer of another kind than `answer`.
    """
    right, reasons = _plain(answer), [[_plain(given), reason] for given, reason in dict(wrong).items()]
    if isinstance(right, str) and not reasons:
        raise ValueError("predict: a text is chosen among others; give the wrong ones, too")
    for given, _ in reasons:
        if isinstance(given, str) != isinstance(right, str) or len(given) != len(right) and not isinstance(right, str):
            raise ValueError(f"predict: the wrong answer {given!r} is of another kind than {right!r}")
    if shell() is None or being_graded():
        return
    from IPython.display import display

    display({"text/plain": ON_PAPER, "text/html": place(right, reasons)}, raw=True)


def place(right, wrong):
    """The place to answer, in HTML: `right` a text or a list of numbers, `wrong` [[such an answer, why it is wrong], …]."""
    told = escape(json.dumps({"right": right, "wrong": wrong}))
    here = f'<img alt="" hidden src="data:," onerror="{REACHED}">'
    return f'<form data-predict="{told}"><em>{ON_PAPER}</em>{here}</form><script>{_script()}</script>'


def _plain(answer):
    """A text as it is, numbers as a list of them."""
    return answer if isinstance(answer, str) else (np.ravel(np.asarray(answer, float)).round(6) + 0.0).tolist()


@cache
def _script():
    return Path(__file__).with_name("predict.js").read_text(encoding="utf-8")
