"""A mistake with numbers: where the hidden cases show that a function is wrong, a public case that shows it, too.

Feedback may not tell a hidden case's numbers, or the next student has them. The public cases are in every student's notebook, so
one of them, with the student's own answer to it, may be shown as `check` shows it: in numbers and as a scene. They are asked
first, since a function that has seen the hidden ones could answer with their numbers.
"""

import json
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from transform_lab.judging.plain import PlainCase, PlainExercise
from transform_lab.judging.status import STATUSES, STOPPED
from transform_lab.judging.verdict import Reply, Verdict, compare

from ..sandbox.host import Asked
from ..untrusted import printable

MOST_CALLS = 8


@dataclass(frozen=True)
class Answer:
    """A function's answer to one public case.

    returns: the kind of answer, a key of transform_lab.judging.kinds.KINDS; reply: untrusted
    """

    returns: str
    case: PlainCase
    reply: Reply

    @cached_property
    def outcome(self):
        return compare(self.returns, self.case, self.reply)

    @property
    def problem(self):
        """Why it could not be compared, in words; "" if it could."""
        return self.outcome.problem[1] if self.reply.finished and self.outcome.problem else ""


def public_cases(key):
    """What `find` takes, {exercise: plain data}, of a key.json (text): its cases without the answers of misconceptions."""
    return {
        name: {
            **exercise,
            "misconceptions": [],
            "cases": [
                {field: value for field, value in case.items() if field != "wrong"} for case in exercise["cases"]
            ],
        }
        for name, exercise in json.loads(key)["exercises"].items()
    }


def answers(name: str, exercise: PlainExercise | None, process: Asked) -> list[Answer]:
    """The Answers of the function `name` of a notebook's process to a few public cases, one of each family first.

    exercise: plain data, of public_cases
    """
    if exercise is None:
        return []
    asked = _asked(exercise["cases"])
    return [Answer(exercise["returns"], case, reply) for case, reply in zip(asked, process.calls(name, asked))]


def _asked(cases):
    """MOST_CALLS of the cases: the first of each family, then the second of each, and so on."""
    place, seen = [], Counter()
    for case in cases:
        seen[case["family"]] += 1
        place.append(seen[case["family"]])
    return [case for _, case in sorted(zip(place, cases), key=lambda pair: pair[0])][:MOST_CALLS]


def find(verdict: Verdict, exercise: PlainExercise | None, answers: Sequence[Answer]) -> str | None:
    """A public case that the function answers wrongly, as JSON text for the notebook's record; None without any.

    verdict: on the hidden cases; one of the failing family comes first
    exercise: plain data, of public_cases
    """
    if exercise is None or verdict.failing is None or STATUSES[verdict.status].look == STOPPED:
        return None
    family = verdict.failing["family"]
    for answer in sorted(answers, key=lambda answer: answer.case["family"] != family):
        if answer.reply.finished and not answer.outcome.answered:
            alone = {**exercise, "cases": [answer.case], "weights": {answer.case["family"]: 1}}
            reply = answer.reply
            return _kept({"exercise": alone, "outcome": reply.outcome, "value": reply.value, "error": reply.error})
    return None


def _kept(example):
    """The example as text (nbformat would sort the fields); None when the student's process sent what no file can hold."""
    try:
        return printable(json.dumps(example, ensure_ascii=False, allow_nan=False))
    except ValueError:
        return None
