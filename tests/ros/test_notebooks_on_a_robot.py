"""The notebooks' code runs on a robot when only its import lines change, and tells the same there."""

import re

import pytest
import transform_lab
from ros.alike import differences
from ros.robot import PROGRAMS
from ros.solved import cells, judged_there, solutions
from support import ASKED, NAMES, ROOT

SOURCE = ROOT / "source/transforms"
ON_A_ROBOT = {
    **dict.fromkeys(["Point", "Pose", "PoseStamped", "Quaternion"], "from geometry_msgs.msg import {}"),
    **dict.fromkeys(["axis_marker", "arrow_marker"], "from transformation_demo import {}"),
    "tft": "import tf.transformations as {}",
}
IMPORT = re.compile(r"from transform_lab import (.+)")


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
        if name.startswith(("animate", "plot")) or name in ("check", "predict", "show_mistake", "sum_up"):
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
    return ros.ask("solutions.py", solutions(for_a_robot), SOURCE / "transform_lab")


@pytest.mark.parametrize("name", NAMES)
def test_solutions(answers, name):
    """Our judge reads what came of ROS's messages, in the place of ours, and gives full points."""
    verdict = judged_there(name, answers[name])
    assert (verdict.status, verdict.credit, verdict.says) == ("graded", 1, "")
