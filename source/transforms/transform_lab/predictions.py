"""A place to answer a prediction before its answer is unfolded: it says yes, or why not.

It works wherever a notebook's scripts run, in a saved one without a kernel, too. Where they do not, it asks for an answer on
paper. Nothing is kept and nothing is sent.
"""

import json
import re
from functools import cache
from html import escape
from pathlib import Path

import numpy as np

from .jupyter import being_graded, shell
from .viewing.carriers import carries as has_to_carry

__all__ = ["predict"]

# A place hands itself to the script, which may come later, with another place; in VS Code no script finds what is in outputs.
REACHED = "(window.transformLabPredictions ??= []).push(this.parentNode)"
ON_PAPER = "answer on paper, then read on."


def predict(answer, wrong=(), ask="Your answer", names="xyzw"):
    """Show a place to type or click an answer; it is compared in the page itself.

    answer: a number; several, as a list or an array, each of which has a field of its own, to a hundredth (of large ones, a
        percent); or a text, which is chosen among the `wrong` ones
    wrong: {wrong answer: why it is wrong, in a sentence}; several numbers as a tuple
    ask: what the place is for, a few words before it
    names: those of several numbers

    Raises ValueError for a text without wrong ones to choose among, for a wrong answer of another kind than `answer`, and for
    numbers without names.
    """
    right, reasons = _plain(answer), [[_plain(given), reason] for given, reason in dict(wrong).items()]
    if isinstance(right, str) and not reasons:
        raise ValueError("predict: a text is chosen among others; give the wrong ones, too")
    for given, _ in reasons:
        if isinstance(given, str) != isinstance(right, str) or len(given) != len(right) and not isinstance(right, str):
            raise ValueError(f"predict: the wrong answer {given!r} is of another kind than {right!r}")
    if not isinstance(right, str) and len(right) > len(names):
        raise ValueError(f"predict: {len(right)} numbers need as many names; got {', '.join(names)}")
    if shell() is None or being_graded():
        return
    from IPython.display import display

    shown = place(right, reasons, ask, names, has_to_carry("prediction"))
    display({"text/plain": f"{ask}: {ON_PAPER}", "text/html": shown}, raw=True)


def place(right, wrong, ask="Your answer", names="xyzw", carries=True):
    """The place to answer, in HTML: `right` a text or a list of numbers, `wrong` [[such an answer, why it is wrong], …].

    What `carries` the script has it for all places of the page.
    """
    told = escape(json.dumps({"right": right, "wrong": wrong, "ask": ask, "names": [*names]}, ensure_ascii=False))
    here = f'<style onload="{REACHED}"></style>'
    script = f"<script>{_script()}</script>" if carries else ""
    return f'<form data-predict="{told}"><em>{escape(ask)}: {ON_PAPER}</em>{here}</form>{script}'


def _plain(answer):
    """A text as it is, numbers as a list of them."""
    return answer if isinstance(answer, str) else (np.ravel(np.asarray(answer, float)).round(6) + 0.0).tolist()


@cache
def _script():
    return re.sub(r"(?m)^(//.*\n)? *", "", Path(__file__).with_name("predict.js").read_text(encoding="utf-8"))
