"""RViz itself, on a screen that is a file: it draws markers, and says what it thinks of them."""

import dataclasses
import json
import os
import shutil
import socket
import struct
import subprocess
import tempfile
from contextlib import ExitStack, contextmanager
from pathlib import Path

import numpy as np
from support import wait_for
from transform_lab.messages import ColorRGBA, Header, Marker, Point, Vector3

PYTHON = "/usr/bin/python3"  # the system's, for which Debian has ROS
PROGRAMS = ("rviz", "rosmaster", "Xvfb")
BEACONS = [(0, 255, 255), (255, 0, 255), (255, 255, 0)]  # told apart from what the cases are coloured with
CONFIGURATION = """
Visualization Manager:
  Displays:
    - {{Class: rviz/Marker, Name: Marker, Enabled: true, Marker Topic: visualization_marker, Queue Size: 1000}}
    - {{Class: rviz/InteractiveMarkers, Name: Remarks, Enabled: true, Update Topic: /remarks/update}}
  Global Options: {{Background Color: 255; 255; 255, Fixed Frame: frame_a, Frame Rate: 60}}
  Views:
    Current:
      Class: rviz/Orbit
      Distance: {distance}
      Yaw: {yaw}
      Pitch: {pitch}
      Field of View: {view}
      Focal Point: {{X: {target[0]}, Y: {target[1]}, Z: {target[2]}}}
      Near Clip Distance: 0.01
Window Geometry: {{X: 0, Y: 0, Width: {width}, Height: {height}}}
"""


def problem():
    """What this machine lacks, or None."""
    missing = [name for name in PROGRAMS if not shutil.which(name)]
    if (
        not missing
        and subprocess.run([PYTHON, "-c", "import rospy, visualization_msgs"], capture_output=True).returncode
    ):
        missing = [f"rospy in {PYTHON}"]
    return f"needs RViz to compare with: {', '.join(missing)} missing" if missing else None


class RViz:
    """RViz, its fixed frame frame_a, seen by a camera of ours."""

    def __init__(self, screen, program, node, corner):
        self._screen, self._program, self._node, self._corner, self._drawn = screen, program, node, corner, 0

    def _ask(self, task, values):
        self._node.stdin.write(json.dumps([task, values], default=lambda moment: moment.to_sec()) + "\n")
        self._node.stdin.flush()
        return json.loads(self._node.stdout.readline())

    def frame(self, name, position):
        """Have a frame of frame_a without a turn, or move it."""
        translation = dict(zip("xyz", position))
        self._ask("frame", {"name": name, "transform": {"translation": translation, "rotation": {"w": 1}}})

    def draw(self, markers):
        """The picture (height x width x 3, from 0 to 255) of these markers, published one after the other."""
        return self.more([Marker(header=Header(0, 0, "frame_a"), action=Marker.DELETEALL), *markers])

    def more(self, markers=()):
        """The picture after these markers have been published, too."""
        color = BEACONS[self._drawn % len(BEACONS)]
        self._drawn += 1
        # RViz draws what it has got in one go: when this point is seen, so is what was published before it.
        beacon = Marker(header=Header(0, 0, "frame_a"), ns="beacon", type=Marker.POINTS, points=[Point(*self._corner)])
        beacon.scale, beacon.color = Vector3(0.05, 0.05, 0), ColorRGBA(*(value / 255 for value in color), 1)
        self._ask("draw", [dataclasses.asdict(marker) for marker in (*markers, beacon)])
        wait_for(lambda: np.abs(self.picture()[-3, -3].astype(int) - color).max() < 3)
        return self.settled()

    def settled(self):
        """The picture when it does not change any more, without the beacon."""
        found = [self.picture()]

        def same():
            found.append(self.picture())
            return np.array_equal(*found[-2:])

        wait_for(same)
        picture = found[-1].copy()
        picture[-20:, -20:] = 255
        return picture

    def picture(self):
        """What is on the screen: an X window dump."""
        assert self._program.poll() is None, "RViz has ended"
        data = self._screen.read_bytes()
        head = struct.unpack(">25I", data[:100])
        size, width, height, line, colors = (head[i] for i in (0, 4, 5, 12, 19))
        rows = np.frombuffer(data, np.uint8, height * line, size + 12 * colors).reshape(height, line)
        return rows[:, : 4 * width].reshape(height, width, 4)[..., 2::-1]

    def library(self, name):
        """The bytes of a library that RViz has loaded."""
        lines = Path(f"/proc/{self._program.pid}/maps").read_text().splitlines()
        return next(Path(line.split()[-1]).read_bytes() for line in lines if name in line)

    def remarks(self, markers):
        """What RViz says of each marker: its level (2 info, 4 warning, 8 error: not drawn) and its words, or None."""
        return self._ask("remarks", [dataclasses.asdict(marker) for marker in markers])


@contextmanager
def running(camera, width, height):
    """An RViz that looks at frame_a as `camera` does, a picture of `width` times `height`."""
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="rviz-")))
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        environment = {
            **os.environ, "HOME": str(folder), "ROS_HOME": str(folder), "XDG_RUNTIME_DIR": str(folder),
            "ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1", "LIBGL_ALWAYS_SOFTWARE": "1",
        }  # fmt: skip
        environment.pop("PYTHONPATH", None)

        def start(*command, **options):
            log = stack.enter_context(open(folder / f"{len(list(folder.iterdir()))}.log", "w"))
            options = {"stdin": subprocess.DEVNULL, "stdout": log, "stderr": log, **options}
            process = subprocess.Popen(command, env=environment, cwd=folder, **options)
            stack.callback(process.wait)
            stack.callback(process.kill)
            return process

        start(PYTHON, shutil.which("rosmaster"), "--core", "-p", str(port))
        read, write = os.pipe()
        screen = ["-screen", "0", f"{width}x{height}x24", "-fbdir", str(folder), "-nocursor", "-nolisten", "tcp"]
        start("Xvfb", "-displayfd", str(write), *screen, pass_fds=[write])
        os.close(write)
        with open(read) as told:
            environment["DISPLAY"] = f":{told.readline().strip()}"
        (folder / "scene.rviz").write_text(configuration(camera, width, height))
        wait_for(lambda: answers(port))
        program = start("rviz", "-d", "scene.rviz", "--fullscreen")
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        node = start(PYTHON, Path(__file__).with_name("marker_node.py"), **pipes)
        if node.stdout.readline() != "ready\n":
            raise RuntimeError("\n".join(log.read_text() for log in folder.glob("*.log")))
        yield RViz(folder / "Xvfb_screen0", program, node, corner(camera))


def answers(port):
    """Whether somebody listens there."""
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def configuration(camera, width, height):
    """The .rviz file whose view is that of `camera`, in a window of `width` times `height`."""
    return CONFIGURATION.format(
        width=width, height=height,
        distance=camera.distance, target=camera.target.tolist(), view=2 * np.arctan(camera.tangent),
        yaw=np.arctan2(camera.back[1], camera.back[0]) % (2 * np.pi), pitch=np.arcsin(camera.back[2]),
    )  # fmt: skip


def corner(camera):
    """The point that is seen near the lower right corner, halfway to the eye, in front of everything."""
    half = 0.98 * camera.tangent * camera.distance / 2
    return camera.eye - camera.back * camera.distance / 2 + half * (camera.aspect * camera.right - camera.up)
