"""The lab's transformation_demo.py: it runs here when only its import lines change, as a program and in a notebook."""

import os
import re
import subprocess
import sys

import nbformat
import pytest
from support import PATIENCE, ROOT
from transform_lab import Marker, Pose, Viewer, rospy

ON_A_ROBOT = ROOT / "tests/ros/lab/transformation_demo.py"  # as the lab has it
HERE = ROOT / "source/transforms/transformation_demo.py"
FILLED_IN = """pose.position = Point(*matrix[:3, 3])
    pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w = tft.quaternion_from_matrix(matrix)"""


def without_imports(path):
    return [line for line in path.read_text().splitlines() if not re.match(r"(from|import) ", line)]


def solved(path=HERE):
    """The script as a student leaves it: the TODO done and the last part uncommented."""
    text = path.read_text().replace("# TODO: fill this out", FILLED_IN)
    return re.sub(r"^    #(?=point|rospy|viz_pub)", "    ", text, flags=re.MULTILINE)


def run_script(text, folder, *packages):
    """What came of a script that is run here, with other packages than ours in further folders."""
    (folder / "transformation_demo.py").write_text(text)
    paths = os.pathsep.join(map(str, [ROOT / "source/transforms", *packages]))
    environment = {"PYTHONPATH": paths, "PATH": "", "MPLCONFIGDIR": str(folder)}
    return subprocess.run(
        [sys.executable, "-W", "ignore", "transformation_demo.py"],
        cwd=folder, env=environment, capture_output=True, text=True, timeout=PATIENCE,
    )  # fmt: skip


def test_only_import_lines_differ_from_the_labs_script():
    assert without_imports(HERE) == without_imports(ON_A_ROBOT)
    assert "rospy.Publisher" in ON_A_ROBOT.read_text() and "transform_lab" not in ON_A_ROBOT.read_text()


def test_as_a_program_it_writes_one_page(tmp_path):
    result = run_script(solved(), tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    assert re.search(r"\[INFO\] \[[\d.]+\]: \[0\.7071\d* 0\.7071\d* 0\.5 +1\. *\]", result.stdout)
    assert "transformation_demo.html: open it in a browser" in result.stdout
    assert [path.name for path in tmp_path.glob("*.html")] == ["transformation_demo.html"]
    page = (tmp_path / "transformation_demo.html").read_text()
    assert "marker axes/0 in frame_a: LINE_LIST at (0, 0, 0.5), x axis (0.7071, 0.7071, 0)" in page
    assert "marker arrow/0 in frame_a: ARROW" in page and "points (0, 0, 0) (0.7071, 0.7071, 0.5)" in page


def test_untouched_it_shows_axes_that_are_not_moved(tmp_path):
    result = run_script(HERE.read_text(), tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    assert "LINE_LIST at (0, 0, 0), x axis (1, 0, 0)" in (tmp_path / "transformation_demo.html").read_text()


def test_what_an_earlier_node_published_is_not_lost(tmp_path):
    text = """
from transform_lab import Header, Marker, Vector3, ColorRGBA, rospy
publisher = rospy.Publisher("t", Marker, queue_size=1)
rospy.init_node("one")
try:
    publisher.publish(Marker(header=Header(0, 0, "typo"), type=Marker.MESH_RESOURCE))
except ValueError:
    print("refused")
publisher.publish(Marker(header=Header(0, 0, "a"), type=1, scale=Vector3(1, 1, 1), color=ColorRGBA(1, 0, 0, 1)))
rospy.init_node("two")
"""
    result = run_script(text, tmp_path)
    assert (result.returncode, result.stderr) == (0, "")
    assert "refused" in result.stdout
    assert [path.name for path in tmp_path.glob("*.html")] == ["one.html"]
    assert "marker /0 in a: CUBE" in (tmp_path / "one.html").read_text()


def test_in_a_notebook_the_scene_appears_below_the_cell(tmp_path, run_all):
    import shutil

    (tmp_path / "transformation_demo.py").write_text(solved())
    shutil.copytree(ROOT / "source/transforms/transform_lab", tmp_path / "transform_lab")
    sources = ["%run transformation_demo.py", solved(), "1 + 1"]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(source) for source in sources])
    run_all(notebook, tmp_path)
    shown = [[o.data for o in cell.outputs if "text/html" in o.get("data", {})] for cell in notebook.cells]
    assert [len(scenes) for scenes in shown] == [1, 1, 0]
    for (scene,) in shown[:2]:
        assert "marker arrow/0 in frame_a: ARROW" in scene["text/plain"]
        assert "frame_a" in scene["text/html"]


def test_what_a_node_cannot_do_here_is_said():
    with pytest.raises(ValueError, match="a node's name is made of letters, digits and _; got 'a/b'"):
        rospy.init_node("a/b")
    with pytest.raises(TypeError, match="only Marker messages can be seen here; got Viewer"):
        rospy.Publisher("topic", Viewer, queue_size=1)
    for no_marker in (Pose, Marker(), "Marker", None):
        with pytest.raises(TypeError, match="only Marker messages can be seen here; got "):
            rospy.Publisher("topic", no_marker, queue_size=1)
    with pytest.raises(
        AttributeError, match="rospy.get_param is not here. There is what publishing needs: Duration, Pub"
    ):
        rospy.get_param("~rate")
    rospy.init_node("empty")
    with pytest.raises(ValueError, match="header.frame_id is empty: set it"):
        rospy.Publisher("topic", Marker).publish(Marker(type=Marker.CUBE))


def test_a_loop_that_would_not_end_here_says_so():
    with pytest.raises(AttributeError, match=r"is_shutdown is not here. A loop .* never end.*: for i in range\(20\)"):
        while not rospy.is_shutdown():
            pass
    with pytest.raises(
        AttributeError, match="spin is not here. Nothing arrives here that could be waited for; leave it out"
    ):
        rospy.spin()


def test_sleep_takes_what_has_seconds(monkeypatch):
    slept = []
    monkeypatch.setattr(rospy.time, "sleep", slept.append)
    for duration in (0.5, 2, rospy.Duration(1.5), -1, rospy.Duration(-1), rospy.Duration.from_sec(0.25)):
        rospy.sleep(duration)
    assert slept == [0.5, 2, 1.5, 0, 0, 0.25]


def test_a_rate_gives_each_round_its_time(monkeypatch):
    """The clock goes on while something sleeps, and by what the rounds take."""
    clock = [1000.0]
    monkeypatch.setattr(rospy.time, "time", lambda: clock[0])
    monkeypatch.setattr(rospy.time, "sleep", lambda seconds: clock.__setitem__(0, clock[0] + seconds))
    rospy.init_node("rounds")
    rate, ends = rospy.Rate(4), []
    for takes in (0.125, 0, 0.375, 0, 1.0, 0.125):  # late by a half round, which is made up for; then by three
        clock[0] += takes
        rate.sleep()
        ends.append(round(clock[0] - 1000, 6))
    assert ends == [0.25, 0.5, 0.875, 1.0, 2.0, 2.25]
