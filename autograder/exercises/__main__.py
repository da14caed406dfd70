"""`.venv/bin/python -m autograder.exercises`: write README.md beside this file from the specifications."""

from inspect import signature
from pathlib import Path

import jinja2
import numpy as np
from transform_lab.check import call
from transform_lab.diagnosis import GENERAL
from transform_lab.verdict import examine

from . import EXERCISES, PUBLIC_SEED, key

PAGE = Path(__file__).with_name("README.md")
TEMPLATES = Path(__file__).parent.parent / "templates"


def page():
    """The text of README.md."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(TEMPLATES), keep_trailing_newline=True)
    template = environment.get_template("exercises.md")
    return template.render(general=GENERAL, exercises=[_described(exercise) for exercise in EXERCISES.values()])


def _described(exercise):
    public = key(exercise, PUBLIC_SEED)
    rows = {}
    for misconception in exercise.misconceptions:
        row = (misconception.id, misconception.says, misconception.hint)
        rows.setdefault(row, []).append(_earned(exercise, public, misconception))
    return {
        "signature": f"{exercise.name}{signature(exercise.reference)}",
        "families": [f"{family}{' (counts double)' if w == 2 else ''}" for family, w in public["weights"].items()],
        "parts": [f"{part} {round(100 * share)} %" for part, share in exercise.credit.items()],
        "rows": [
            {"id": "` + `".join(i.split(";")), "says": says, "hint": hint, "earns": sorted(set(earned))}
            for (i, says, hint), earned in rows.items()
        ],
    }


def _earned(exercise, public, misconception):
    with np.errstate(all="ignore"):  # wrong implementations divide by zero; that is their point
        verdict = examine(exercise.name, public, lambda args, kwargs: call(misconception.wrong, args, kwargs))
    return int(100 * verdict.credit)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
    print(f"{PAGE.name} is written.")
