"""What a known mistake looks like: the Verdict on who makes it, and the scene that shows it."""

from functools import cache

from transform_lab.judging import comparison, panel
from transform_lab.judging.diagnosis import error_of, open_parts_of
from transform_lab.judging.verdict import Reply, examine

from .exercises import EXERCISES, PUBLIC_SEED, key


def html(name, identifier):
    """What the misconception `identifier` makes of a public case of the exercise `name`, as a piece of a page.

    A still picture of where the frame should be (pale) and where it goes; in numbers what cannot be drawn, such as a truth value;
    "" when the public cases do not show it.
    """
    verdict = _committed(name, identifier)
    scene = comparison.scene(verdict)
    return scene.still() if scene else panel.example(verdict)


def knows(name, identifier):
    """Whether the exercise `name` has the misconception `identifier` (others, such as "hard-coded", any can have)."""
    return identifier in {misconception.id for misconception in EXERCISES[name].misconceptions}


def _committed(name, identifier):
    """The Verdict on the public cases of who has the misconception; its first wrong answer is the one to show."""
    exercise = _public(name)
    index = [misconception["id"] for misconception in exercise["misconceptions"]].index(identifier)
    answers = iter([_reply(case, case["wrong"][index]) for case in exercise["cases"]])
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
