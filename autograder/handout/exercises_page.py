"""The page of all exercises, autograder/exercises/README.md, made from the specifications; `release` writes it.

`.venv/bin/python -m autograder.handout.exercises_page` draws the picture of the project's README anew.
"""

from inspect import signature
from pathlib import Path

import jinja2
import numpy as np
from transform_lab.judging.calling import call
from transform_lab.judging.kinds import KINDS
from transform_lab.judging.naming import GENERAL
from transform_lab.judging.plain import open_parts_of
from transform_lab.judging.verdict import Outcome, compare, credit
from transform_lab.messages import Point, Pose, Quaternion
from transform_lab.viewing.viewer import Viewer

from ..exercises import EXERCISES

PAGE = Path("autograder", "exercises", "README.md")  # in the course
PICTURE = Path(__file__).parents[1] / "exercises" / "pre_grasp.png"  # shown in the README of the project
TEMPLATE = Path(__file__).with_suffix(".md")


def page(public):
    """The text of README.md.

    public: {exercise: its public cases as plain data, from autograder.exercises.key}
    """
    template = jinja2.Template(TEMPLATE.read_text(encoding="utf-8"), keep_trailing_newline=True)
    described = [_described(exercise, public[name]) for name, exercise in EXERCISES.items()]
    return template.render(general=GENERAL, exercises=described)


def picture():
    """The PNG (bytes) of the lab's pre-grasp scene: the gripper 10 cm behind the object, along the object's x axis."""
    viewer = Viewer("base_link")
    object_pose = Pose(Point(0.6, -0.1, 0.7), Quaternion(0, 0, 0.38268343, 0.92387953))
    viewer.add_frame("object", object_pose, length=0.05)
    viewer.add_box("object", (0.04, 0.04, 0.1), frame="object")
    viewer.add_frame("pre-grasp", EXERCISES["pre_grasp"].reference(object_pose), length=0.05)
    viewer.add_gripper("pre-grasp")
    viewer.add_arrow("10 cm", tail=(0, 0, 0.065), tip=(0.1, 0, 0.065), frame="pre-grasp")
    return viewer.look(at=["object", "pre-grasp"]).picture()


def _described(exercise, public):
    rows: dict = {}
    for index, misconception in enumerate(exercise.misconceptions):
        row = (misconception.id, *(text.replace("\n", "<br>") for text in (misconception.says, misconception.hint)))
        rows.setdefault(row, []).append(earned(exercise, public, index))
    return {
        "signature": f"{exercise.name}{signature(exercise.reference)}",
        "families": [f"{family}{' (counts double)' if w == 2 else ''}" for family, w in public["weights"].items()],
        "parts": [f"{part} {round(100 * share)} %" for part, share in exercise.credit.items()],
        "rows": [
            {"id": "` + `".join(i.split(";")), "says": says, "hint": hint, "earns": sorted(set(earned))}
            for (i, says, hint), earned in rows.items()
        ],
    }


def earned(exercise, public, index):
    """The points out of 100 for a misconception's own answers, of which the key tells what is right in them."""
    outcomes = [_outcome(exercise, case, index) for case in public["cases"]]
    return int(round(100 * credit(public, public["cases"], outcomes), 9))  # 55 is a sum that may come out as 54.99…


def _outcome(exercise, case, index):
    told = case["wrong"][index]
    if open_parts_of(told):
        with np.errstate(all="ignore"):  # wrong implementations divide by zero; that is their point
            return compare(
                exercise.returns, case, call(exercise.misconceptions[index].wrong, case["args"], case["kwargs"])
            )
    parts = KINDS[exercise.returns].parts
    told = [None] * len(parts) if told is None else told
    right = [part for part, wrong in zip(parts, told) if wrong is None] if isinstance(told, list) else []
    return Outcome(frozenset(right), len(right) == len(parts))


if __name__ == "__main__":
    PICTURE.write_bytes(picture())
    print(f"{PICTURE.name} is written.")
