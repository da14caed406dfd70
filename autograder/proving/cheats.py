"""Functions that answer without working anything out: by what they were asked before, or by what is in the public key."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from transform_lab.judging import codec

from ..exercises import PUBLIC_SEED, key
from ..exercises.specification import Arguments, Exercise


def cheats(exercise: Exercise) -> dict[str, Callable[[], Callable]]:
    """{what it does: from nothing to such a function, which has not been called yet}

    There is none for an exercise without arguments: its one answer is public by nature.
    """
    public = key(replace(exercise, misconceptions=()), PUBLIC_SEED)
    if not public["parameters"]:
        return {}
    answers = [codec.decode(case["expected"]) for case in public["cases"]]
    asked = [Arguments(case["args"], case["kwargs"]) for case in public["cases"]]

    def by_position():
        position = iter(answers * 2)
        return lambda *args, **kwargs: next(position)

    def by_table():
        position = iter(answers * 2)

        def answer(*args, **kwargs):
            otherwise = next(position)
            return next((right for one, right in zip(asked, answers) if one.are(args, kwargs)), otherwise)

        return answer

    def first():
        kept = []

        def answer(*args, **kwargs):
            if not kept:
                kept.append(exercise.reference(*args, **kwargs))
            return kept[0]

        return answer

    def before():
        kept = []

        def answer(*args, **kwargs):
            kept.append(exercise.reference(*args, **kwargs))
            return kept[-2:][0]

        return answer

    def by_likeness():
        known = [_numbers(one.fresh()[0]) for one in asked]

        def answer(*args):
            return answers[np.argmin([np.linalg.norm(_numbers(args) - one) for one in known])]

        return answer

    likeness = {"answers as the most similar public case": by_likeness} if exercise.returns == "truth" else {}
    return likeness | {
        "answers by position of the public key": by_position,
        "remembers the public cases, and answers others by position": by_table,
        "remembers earlier calls: gives its first answer ever after": first,
        "remembers earlier calls: gives the answer to the call before": before,
    }


def _numbers(arrays):
    return np.concatenate([np.ravel(array) for array in arrays]).astype(float)
