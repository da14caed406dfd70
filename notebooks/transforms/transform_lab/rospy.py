"""The part of rospy that the lab's script uses, without ROS: what a node publishes is drawn, as RViz draws it.

In a notebook the markers appear below the cell that published them. A plain Python script writes one page when it ends,
named after its node, to be opened in a browser.
"""

import atexit
import time
from pathlib import Path

from .jupyter import shell
from .messages import Marker
from .viewing.viewer import Viewer

__all__ = ["Publisher", "Time", "init_node", "loginfo", "sleep"]


class _Node:
    """What is published, in one viewer whose fixed frame is that of the first marker; and where it is to appear."""

    def __init__(self):
        self.name, self.viewer, self.shown, self.watching = "rviz", None, True, False

    def publish(self, marker):
        if self.viewer is None and getattr(marker, "action", Marker.ADD) != Marker.ADD:
            return  # there is nothing to delete
        viewer = self.viewer or Viewer(_frame_of(marker))
        viewer.publish(marker)
        self.viewer, self.shown = viewer, False
        self.watch()

    def watch(self):
        """See to it that what was published is shown at the end of the cell, or of the script."""
        if self.watching:
            return
        if ipython := shell():
            ipython.events.register("post_run_cell", lambda *_: self.show())
        else:
            import meshcat  # noqa: F401  (what it brings along cannot be imported any more while Python ends)

            atexit.register(self.write)
        self.watching = True

    def show(self):
        if not self.shown:
            self.shown = True
            self.viewer.show()

    def write(self):
        if self.shown:
            return
        self.shown = True
        path = Path(f"{self.name}.html")
        path.write_text(self.viewer.html(), encoding="utf-8")
        print(f"{path}: open it in a browser to see what was published.")


_node = _Node()


def _frame_of(marker):
    """Return the frame that a marker, the first one, is given in: it becomes the fixed frame."""
    if not hasattr(marker, "header"):
        raise TypeError(f"publish takes one Marker; got {type(marker).__name__}")
    if not marker.header.frame_id:
        raise ValueError("header.frame_id is empty: set it to the name of the frame that the marker is given in")
    return marker.header.frame_id


def __getattr__(name):
    raise AttributeError(f"rospy.{name} is not here. There is what the lab's script uses: {', '.join(__all__)}")


def init_node(name, **options):
    """Start the node `name` (a text without slashes or spaces) with an empty view; `options` have no effect here."""
    if not isinstance(name, str) or not name.replace("_", "").isalnum():
        raise ValueError(f"init_node: a node's name is made of letters, digits and _; got {name!r}")
    if not shell():
        _node.write()  # what an earlier node published
    _node.name, _node.viewer, _node.shown = name, None, True


class Publisher:
    """Publishes markers to the view below the cell. The topic's name has no effect here."""

    def __init__(self, name, data_class, **options):
        if data_class is not Marker:
            raise TypeError(
                f"Publisher: only Marker messages can be seen here; got {getattr(data_class, '__name__', data_class)}"
            )

    def publish(self, marker):
        """Draw a Marker as RViz does. The first one's header.frame_id becomes the fixed frame.

        Raises ValueError for a frame that is not known and for what cannot be drawn, as Viewer.publish does.
        """
        _node.publish(marker)


class Time:
    """A moment, in seconds since 1970; there is no simulated time here."""

    def __init__(self, seconds=0.0):
        self._seconds = float(seconds)

    @staticmethod
    def now():
        """Return the present Time."""
        return Time(time.time())

    def to_sec(self):
        """Return the moment in seconds."""
        return self._seconds


def sleep(duration):
    """Wait for `duration` seconds."""
    time.sleep(duration)


def loginfo(message, *args):
    """Print a message as rospy does; with `args`, it is a template as for the % operator."""
    print(f"[INFO] [{time.time():.6f}]: {str(message) % args if args else message}")
