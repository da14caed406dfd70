"""The notebooks' code runs on a robot with ROS 2, too, when only its import lines change: fields by name, and floats."""

import re

import pytest
from ros.solved import cells, judged_there, solutions
from support import ASKED, NAMES, key_of

MESSAGES = {"Point", "Pose", "PoseStamped", "Quaternion"}
IMPORT = re.compile(r"from transform_lab import (.+)")
# What the page says of ROS 2, as code and what it gives
SAYS = {
    "Quaternion()": "geometry_msgs.msg.Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)",
    "Point(1.0, 2.0, 3.0)": "TypeError",
    "Point(x=1.0).x": "1.0",
    "Point(x=1)": "AssertionError",
    "Point(x=1, check_fields=False).x": "1",
    "sorted(Header.get_fields_and_field_types())": "['frame_id', 'stamp']",
    "sorted(Header().stamp.get_fields_and_field_types())": "['nanosec', 'sec']",
}


def for_ros2(source):
    """A cell with the import lines that it has on a robot with ROS 2; tft and what draws or judges is ours."""

    def lines(found):
        names = found[1].split(", ")
        theirs = [name for name in names if name in MESSAGES]
        ours = [name for name in names if name not in MESSAGES]
        imports = [f"from geometry_msgs.msg import {', '.join(theirs)}"] * bool(theirs)
        return "\n".join([*imports, *[f"from transform_lab import {', '.join(ours)}"] * bool(ours)])

    return IMPORT.sub(lines, source)


@pytest.fixture(scope="module")
def found(libraries):
    # Not `check`, which hands over messages of integers, too: there are none in ROS 2.
    notebooks = {
        name: [for_ros2(cell.source) for cell in cells(name) if not cell.source.startswith("check(")] for name in ASKED
    }
    asked = {"code": list(SAYS), "notebooks": notebooks, "solutions": solutions(for_ros2)}
    return libraries.ask("on_ros2.py", asked, ROS_PYTHON_CHECK_FIELDS="1")


def test_ros2_is_as_the_page_says(found):
    assert dict(zip(SAYS, found["code"], strict=True)) == SAYS


@pytest.mark.parametrize("notebook", ASKED)
def test_cells(found, notebook):
    assert found["notebooks"][notebook] is None, found["notebooks"][notebook]


@pytest.mark.parametrize("name", NAMES)
def test_solutions(found, name):
    """Our judge reads what came of ROS 2's messages, and gives full points."""
    cases, answered = key_of(name)["cases"], found["solutions"][name]
    answers = [
        (answer, [case["args"], case["kwargs"]] if kept else None)
        for case, (answer, kept) in zip(cases, answered, strict=True)
    ]
    verdict = judged_there(name, answers)
    assert (verdict.status, verdict.credit, verdict.says) == ("graded", 1, "")
