"""The lab's script on a robot and here: subscribers hear the same messages, and people read the same text."""

import os
import re
import runpy
import signal
import subprocess
import sys

import numpy as np
import pytest
from ros.alike import differences
from ros.programs.plain import plain
from ros.robot import answers
from support import PATIENCE, ROOT, wait_for
from test_lab_script import ON_A_ROBOT, solved
from transform_lab import rospy


@pytest.fixture
def published(monkeypatch, tmp_path):
    """What this process publishes by our rospy, in a node of its own; nothing is written when the tests end."""
    heard, publish = [], rospy.Publisher.publish

    def told(publisher, marker):
        publish(publisher, marker)
        heard.append(plain(marker))

    node = rospy._Node()
    monkeypatch.setattr(rospy, "_node", node)
    monkeypatch.setattr(rospy.Publisher, "publish", told)
    monkeypatch.chdir(tmp_path)
    yield heard
    node.shown = True


def run_both(robot, published, capsys, folder, there, here):
    """Run two scripts: what was heard and printed on the robot and here, times left out."""
    (folder / "there.py").write_text(there)
    (folder / "here.py").write_text(here)
    heard, ran = robot.publish(folder / "there.py")
    capsys.readouterr()
    runpy.run_path(str(folder / "here.py"), run_name="__main__")
    printed = capsys.readouterr()
    return (heard, timeless(ran.stdout), timeless(ran.stderr)), (
        published,
        timeless(printed.out),
        timeless(printed.err),
    )


def timeless(text):
    assert not re.search(r"\[(?!\d{10}\.\d{6}\])[\d.]{12,}\]", text)  # a time of another form
    return re.sub(r"\[\d{10}\.\d{6}\]", "[TIME]", text)


def test_the_labs_script(robot, published, capsys, tmp_path):
    there, here = run_both(robot, published, capsys, tmp_path, solved(ON_A_ROBOT), solved())
    assert not list(differences(there, here))
    assert [marker["ns"] for marker in published] == ["axes", "arrow"] and "[INFO] [TIME]: [1 0 0 1]" in here[1]


SNIPPET = """
rospy.init_node("blink")
publisher = rospy.Publisher("visualization_marker", Marker, queue_size=10)
rate = rospy.Rate(50)
marker = Marker(type=Marker.SPHERE, id=7, ns='b"', lifetime=rospy.Duration(2.5))
marker.header.frame_id = "map"
marker.pose.orientation.w = 1.0
marker.scale = Vector3(0.1, 0.2, 0.3)
marker.color = ColorRGBA(0.5, 0.25, 0.0, 1.0)
start = rospy.Time.now()
for step in range(3):
    marker.header.stamp = rospy.Time.from_sec(1.5) + rospy.Duration(step)
    marker.pose.position.x = 0.5 * step
    publisher.publish(marker)
    rospy.loginfo("%s of %d: %s", step, 3, marker.header)
    rate.sleep()
assert rospy.Time.now() - start >= rospy.Duration.from_sec(0.05)
assert publisher.get_num_connections() == 1
rospy.logwarn("a warning of 100%")
rospy.logerr(marker.lifetime)
marker.action = Marker.DELETE
publisher.publish(marker)
"""
THERE = """import rospy
from geometry_msgs.msg import Vector3
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker
"""
HERE_ = "from transform_lab import ColorRGBA, Marker, Vector3, rospy\n"


def test_a_loop_that_publishes(robot, published, capsys, tmp_path):
    there, here = run_both(robot, published, capsys, tmp_path, THERE + SNIPPET, HERE_ + SNIPPET)
    assert not list(differences(there, here))
    assert [marker["header"]["seq"] for marker in published] == [1, 2, 3, 4]


WITHOUT_NODE = [
    "rospy.Time.now()",
    "rospy.Rate(10)",
    "rospy.sleep(0.001)",
    "rospy.sleep(rospy.Duration(0, 1000))",
    "rospy.sleep(-1)",
    "rospy.Publisher('topic', Marker, queue_size=1).publish(Marker())",
    "rospy.Publisher('topic', Marker, queue_size=1) and None",
    "rospy.Time(3)",
    "rospy.init_node('a/b')",
    "rospy.init_node('')",
]
TRY = """
for line in {lines}:
    try:
        print(line, eval(line) and None)
    except Exception as error:
        print(line, [kind.__name__ for kind in type(error).__mro__], error if "init_node()" in str(error) else "")
"""


def test_without_a_node(ros, published, capsys, tmp_path):
    body = TRY.format(lines=WITHOUT_NODE)
    (tmp_path / "there.py").write_text(THERE + body)
    exec(HERE_ + body)
    here = capsys.readouterr().out
    assert ros.run(tmp_path / "there.py").stdout.splitlines() == here.splitlines()


RATE = """
import time
clock = [1000.0]
time.time = lambda: clock[0]
time.sleep = lambda seconds: clock.__setitem__(0, clock[0] + seconds)
rate = rospy.Rate(8)
for takes in {takes}:
    clock[0] += takes
    print(rate.remaining().to_sec())
    rate.sleep()
    print(clock[0])
"""


def test_a_rate(ros, published, monkeypatch, capsys, tmp_path):
    """The clock goes on while something sleeps, and by what each round takes; at times it is put back."""
    rng = np.random.default_rng(24)
    body = RATE.format(takes=rng.choice([0.0, 0.0625, 0.125, 0.25, 0.5, -0.25], size=200).tolist())
    (tmp_path / "there.py").write_text(f"import rospy\nrospy.rostime.set_rostime_initialized(True)\n{body}")
    for name in ("time", "sleep"):
        monkeypatch.setattr(rospy.time, name, getattr(rospy.time, name))  # to be put back
    rospy.init_node("rounds")
    exec(body, {"rospy": rospy})
    here = capsys.readouterr().out
    assert ros.run(tmp_path / "there.py").stdout.splitlines() == here.splitlines()
    assert len(set(here.splitlines())) > 100


KILLED = """
import os, pathlib, signal, sys
from ros.robot import master
with master(pathlib.Path(sys.argv[1])) as computer:
    print(computer.uri, flush=True)
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_master_ends_even_where_its_tests_are_killed(ros, tmp_path):
    paths = os.pathsep.join(str(ROOT / folder) for folder in ("", "tests", "source/transforms"))
    command = [sys.executable, "-c", KILLED, tmp_path]
    killed = subprocess.run(
        command, env={**os.environ, "PYTHONPATH": paths}, capture_output=True, text=True, timeout=PATIENCE
    )
    assert killed.returncode == -signal.SIGKILL, killed.stderr
    wait_for(lambda: not answers(killed.stdout.strip()))
