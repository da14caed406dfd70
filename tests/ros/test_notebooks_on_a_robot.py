"""The notebooks' code runs on a robot when only its import lines change, and tells the same there."""

import json
import re

import nbformat
import pytest
import transform_lab
from ros.alike import differences
from ros.robot import PROGRAMS
from support import ASKED, NAMES, ROOT, key_of
from transform_lab.judging.verdict import Reply, examine

SOURCE = ROOT / "source/transforms"
ON_A_ROBOT = {
    **dict.fromkeys(["Point", "Pose", "PoseStamped", "Quaternion"], "from geometry_msgs.msg import {}"),
    **dict.fromkeys(["axis_marker", "arrow_marker"], "from transformation_demo import {}"),
    "tft": "import tf.transformations as {}",
}
IMPORT = re.compile(r"from transform_lab import (.+)")


def cells(notebook):
    return [cell for cell in nbformat.read(SOURCE / f"{notebook}.ipynb", 4).cells if cell.cell_type == "code"]


def for_a_robot(source):
    """A cell with the import lines that it has on a robot; what only draws or judges comes from programs/tf_and_rviz.py."""

    def lines(found):
        return "\n".join(
            ON_A_ROBOT.get(name, "from tf_and_rviz import {}").format(name) for name in found[1].split(", ")
        )

    return IMPORT.sub(lines, source)


@pytest.fixture
def here(monkeypatch):
    """Runs cells here as programs/cells.py does on the robot; what only draws or judges does nothing."""
    monkeypatch.syspath_prepend(PROGRAMS)
    import cells as program

    class Viewer(program.Watched, transform_lab.Viewer):
        pass

    def nothing(*arguments, **options):
        return Viewer()

    for name in transform_lab.__all__:
        if name.startswith(("animate", "plot")) or name in ("check", "show_mistake", "sum_up"):
            monkeypatch.setattr(transform_lab, name, nothing)
    monkeypatch.setattr(transform_lab, "once_done", program.nullcontext)
    monkeypatch.setattr(transform_lab, "Viewer", Viewer)
    return program.run


@pytest.mark.parametrize("notebook", ASKED)
def test_cells(ros, here, notebook):
    sources = [cell.source for cell in cells(notebook)]
    there = ros.ask("cells.py", {"cells": [for_a_robot(source) for source in sources]})
    found = here(sources, {})
    wrong = [(sources[i], list(differences(*pair))) for i, pair in enumerate(zip(there, found, strict=True))]
    assert not [cell for cell in wrong if cell[1]]
    assert sum(len(told) for told in found) > len(sources)  # more than empty texts


@pytest.fixture(scope="module")
def answers(ros):
    """What the notebooks' solutions answer on the robot: {exercise: [(answer, arguments afterwards)]}."""
    asked = {}
    for notebook in ASKED:
        first, *others = cells(notebook)
        for cell in others:
            name, _, kind = cell.metadata.get("nbgrader", {}).get("grade_id", "").partition("-")
            if kind == "solution":
                cases = [[case["args"], case["kwargs"]] for case in key_of(name)["cases"]]
                asked[name] = {"cells": [for_a_robot(first.source), for_a_robot(cell.source)], "cases": cases}
    return ros.ask("solutions.py", asked, SOURCE / "transform_lab")


@pytest.mark.parametrize("name", NAMES)
def test_solutions(answers, name):
    """Our judge reads what came of ROS's messages, in the place of ours, and gives full points."""
    key = key_of(name)
    replies = {
        json.dumps([case["args"], case["kwargs"]]): Reply("returned", answer, after)
        for case, (answer, after) in zip(key["cases"], answers[name], strict=True)
    }
    verdict = examine(name, key, lambda args, kwargs: replies[json.dumps([args, kwargs])])
    assert (verdict.status, verdict.credit, verdict.says) == ("graded", 1, "")
