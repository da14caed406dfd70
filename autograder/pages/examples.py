"""What a mistake looks like, as a piece of a page: one that is known by name, and one that a student made."""

import contextlib
import json
from functools import cache
from pathlib import Path

import numpy as np
from transform_lab.judging import comparison, panel
from transform_lab.judging.calling import call
from transform_lab.judging.verdict import Reply, examine

from ..exercises import EXERCISES, PUBLIC_SEED, key
from ..files import replace
from ..grading import digests

REMEMBERED = Path(__file__).parent / "__pycache__" / "examples.json"

YOURS_TO_TRY = (
    "The same mistake, with numbers you can try yourself (this case is one of your notebook's <code>check</code>):"
)
YOUR_ANSWER = "What your function answers:"


def of_misconceptions(course, wanted):
    """{(exercise, id): what of_misconception makes of it} of all that are `wanted`.

    A picture takes as long as ten students' rows of the report, so it is kept for as long as nothing changes that makes pages.
    """
    digest, known = digests.of_pages(course), {}
    with contextlib.suppress(OSError, ValueError, LookupError, TypeError):
        kept = json.loads(REMEMBERED.read_text(encoding="utf-8"))
        known = {(name, identifier): str(made) for name, identifier, made in kept[digest]}
    found = {(name, identifier): known.get((name, identifier)) for name, identifier in wanted}
    if not (new := [example for example, made in found.items() if made is None]):
        return found
    for example in new:
        known[example] = found[example] = of_misconception(*example)
    with contextlib.suppress(OSError):  # where nothing can be written, they are made each time
        REMEMBERED.parent.mkdir(exist_ok=True)
        replace(REMEMBERED, json.dumps({digest: [[*example, made] for example, made in known.items()]}))
    return found


def of_misconception(name, identifier):
    """What the misconception `identifier` makes of a public case of the exercise `name`, as a piece of a page.

    A still picture of where the frame should be (pale) and where it goes; in numbers what cannot be drawn, such as a truth value;
    "" when the public cases do not show it.
    """
    verdict = _committed(name, identifier)
    scene = comparison.scene(verdict)
    return scene.still() if scene else panel.example(verdict)


def of_answer(name, text):
    """What public_example.find found, a public case and a student's answer to it, as a piece of a page.

    Raises AttributeError, LookupError, TypeError or ValueError for a damaged one.
    """
    example = json.loads(text)
    exercise = example["exercise"]
    (case,) = exercise["cases"]
    reply = Reply(example["outcome"], example["value"], [case["args"], case["kwargs"]], str(example["error"]))
    verdict = examine(name, exercise, lambda args, kwargs: reply)
    verdict.says = ""  # said already; what is to be seen here is the case
    scene = comparison.scene(verdict)
    given = case["args"] or case["kwargs"]
    sentence = f"<div>{YOURS_TO_TRY if given else YOUR_ANSWER}</div>"
    return panel.beside_a_bar([sentence, panel.example(verdict), scene.still() if scene else ""])


def knows(name, identifier):
    """Whether the exercise `name` has the misconception `identifier` (others, such as "hard-coded", any can have)."""
    return identifier in {misconception.id for misconception in EXERCISES[name].misconceptions}


def _committed(name, identifier):
    """The Verdict on the public cases of who has the misconception; its first wrong answer is the one to show."""
    exercise = _public(name)
    index = [misconception["id"] for misconception in exercise["misconceptions"]].index(identifier)
    wrong = EXERCISES[name].misconceptions[index].wrong
    with np.errstate(all="ignore"):
        return examine(name, exercise, lambda args, kwargs: call(wrong, args, kwargs))


@cache
def _public(name):
    """The exercise `name` with its public cases, as plain data."""
    return key(EXERCISES[name], PUBLIC_SEED, when_asked=True)
