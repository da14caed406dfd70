"""A robot's computer for tests: Debian's ROS 1, run by the system's Python, with a master of its own."""

import json
import os
import shutil
import socket
import subprocess
import xmlrpc.client
from contextlib import contextmanager
from pathlib import Path

from support import PATIENCE, wait_for

PROGRAMS = Path(__file__).with_name("programs")  # what the robot's Python runs for tests
LAB = Path(__file__).with_name("lab")  # a robot has the lab's script
PYTHON = shutil.which("python3", path=os.defpath)  # the system's, which has Debian's packages
NEEDS = "import genpy, rosmaster, rospy, tf.transformations, tf2_ros, visualization_msgs.msg"
TOPIC = "visualization_marker"


class Ros:
    """Runs programs as on a robot: the system's Python, and nothing of the environment that the tests run in."""

    def __init__(self, folder, uri="http://127.0.0.1:1"):
        self.folder, self.uri = folder, uri
        self.environment = {
            "PATH": os.defpath, "HOME": str(folder), "LANG": "C.UTF-8", "PYTHONPATH": str(LAB), "PYTHONDONTWRITEBYTECODE": "1",
            "ROS_MASTER_URI": uri, "ROS_IP": "127.0.0.1", "ROS_HOME": str(folder), "ROS_LOG_DIR": str(folder / "log"),
        }  # fmt: skip

    def start(self, *command, **options):
        """A process of its own, with text to and from it."""
        return subprocess.Popen(command, cwd=self.folder, env=self.environment, text=True, encoding="utf-8", **options)

    def run(self, program, *arguments, **options):
        """What came of a program, when it has ended."""
        return subprocess.run(
            [PYTHON, "-W", "ignore", program, *arguments],
            cwd=self.folder, env=self.environment, capture_output=True, text=True, encoding="utf-8", timeout=PATIENCE, **options,
        )  # fmt: skip

    def ask(self, program, questions, *arguments):
        """The answers of one of our PROGRAMS, which reads and writes JSON."""
        found = self.run(PROGRAMS / program, *map(str, arguments), input=json.dumps(questions))
        assert found.returncode == 0, found.stderr
        return json.loads(found.stdout)

    def messages(self, folder):
        """A folder with ROS's message packages alone, which any Python can import."""
        names = ("genpy", "genmsg", "std_msgs", "geometry_msgs", "visualization_msgs")
        told = self.run(
            "-c", f"import {', '.join(names)}; print(*(m.__path__[0] for m in ({', '.join(names)})), sep='\\n')"
        )
        for path in map(Path, told.stdout.split()):
            (folder / path.name).symlink_to(path)
        return folder

    @contextmanager
    def conversation(self, program, *arguments):
        """ask(question), answered by one of our PROGRAMS that runs as long as this lasts: a line of JSON for each."""
        command = [PYTHON, "-W", "ignore", PROGRAMS / program, *map(str, arguments)]
        process = self.start(*command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)

        def ask(question):
            process.stdin.write(json.dumps(question) + "\n")
            process.stdin.flush()
            return json.loads(process.stdout.readline())

        with process:
            yield ask

    def publish(self, script):
        """Run a script that publishes markers: what a subscriber heard, each message as a dictionary, and what it printed."""
        listener = self.start(PYTHON, PROGRAMS / "listen.py", TOPIC, stdout=subprocess.PIPE)
        try:
            ran = self.run(PROGRAMS / "publish.py", script)
            assert ran.returncode == 0, ran.stderr
            heard, _ = listener.communicate(timeout=PATIENCE)
        finally:
            listener.kill()
            listener.wait()
        return [json.loads(line) for line in heard.splitlines()], ran


def problem():
    """Why nothing can be run as on a robot here, or None."""
    if PYTHON is None or subprocess.run([PYTHON, "-c", NEEDS], env={}, capture_output=True).returncode != 0:
        return "needs Debian's ROS 1 (python3-rospy, python3-tf and others, see .ci/run)"
    return None


def answers(uri):
    """Whether there is a master."""
    try:
        return xmlrpc.client.ServerProxy(uri).getPid("/test")[0] == 1
    except ConnectionError:
        return False


@contextmanager
def master(folder):
    """A Ros whose programs find each other by a master of their own, on a free port; it ends with the test, or with us."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    ros = Ros(folder, f"http://127.0.0.1:{port}")
    # It is what `roscore` starts, and one process. The kernel ends it where we are killed.
    command = ["setpriv", "--pdeathsig", "KILL", "rosmaster", "--core", "-p", str(port)]
    with open(folder / "master.log", "w") as log:
        process = ros.start(*command, stdout=log, stderr=log, stdin=subprocess.DEVNULL)

    def started():
        assert process.poll() is None, (folder / "master.log").read_text()
        return answers(ros.uri)

    try:
        wait_for(started)
        yield ros
    finally:
        process.kill()
        process.wait()
