"""What a known mistake looks like: the Verdict on who makes it, and the scene that shows it."""

from dataclasses import replace
from functools import cache

from transform_lab import comparison, panel
from transform_lab.diagnosis import error_of, open_parts_of
from transform_lab.verdict import Reply, examine

from .exercises import EXERCISES, PUBLIC_SEED, key


def picture(name, identifier):
    """Where the frame should be (pale) and where the misconception `identifier` of the exercise `name` puts it.

    A still picture in HTML, of a public case; "" where there is nothing to draw, as for a truth value.
    """
    scene = comparison.scene(committed(name, _public(name), identifier))
    return scene.still() if scene else ""


def in_words(name, identifier):
    """The same in plain text: what the function was given, what was expected, and what the misconception answers."""
    verdict = replace(committed(name, _public(name), identifier), says="", hint="")
    return panel.text(verdict).partition("\n")[2]


def knows(name, identifier):
    """Whether the exercise `name` has the misconception `identifier` (others, such as "hard-coded", any can have)."""
    return identifier in {misconception.id for misconception in EXERCISES[name].misconceptions}


def committed(name, exercise, identifier):
    """The Verdict on the exercise `name` (plain data, see transform_lab.verdict) of who has the misconception.

    The first case of the exercise in which the misconception leads to a wrong answer is the one to show. Raises ValueError
    for a misconception that the exercise does not know.
    """
    known = [misconception["id"] for misconception in exercise["misconceptions"]]
    if identifier not in known:
        raise ValueError(f"{name} knows no misconception {identifier!r}; it knows {', '.join(dict.fromkeys(known))}")
    answers = iter([_reply(case, case["wrong"][known.index(identifier)]) for case in exercise["cases"]])
    return examine(name, exercise, lambda args, kwargs: next(answers))


@cache
def _public(name):
    """The exercise `name` with its public cases, as plain data."""
    return key(EXERCISES[name], PUBLIC_SEED)


def _reply(case, wrong):
    arguments = [case["args"], case["kwargs"]]
    if raised := error_of(wrong):
        return Reply("raised", None, arguments, error=raised)
    right = wrong is None or open_parts_of(wrong)  # right in this case, or anything: nothing to show
    return Reply("returned", case["expected"] if right else wrong, arguments)
