"""The part of rospy that publishing needs, without ROS: what a node publishes is drawn, as RViz draws it.

In a notebook the markers appear below the cell that published them. A plain Python script writes one page when it ends,
named after its node, to be opened in a browser.
"""

import atexit
import sys
import time
from pathlib import Path

from . import rostime
from .jupyter import shell
from .messages import Marker
from .rostime import Duration
from .viewing.viewer import Viewer

__all__ = [
    "Duration",
    "Publisher",
    "ROSException",
    "ROSInitException",
    "ROSInterruptException",
    "Rate",
    "Time",
    "init_node",
    "logerr",
    "loginfo",
    "logwarn",
    "sleep",
]

NO_END = "a loop that waits for the node's end would never end here; publish a number of times: for i in range(20): …"
NOT_HERE = {
    "is_shutdown": NO_END,
    "spin": "nothing arrives here that could be waited for; leave it out: what was published stays to be seen",
}


class ROSException(Exception):
    """What rospy raises."""


class ROSInitException(ROSException):
    """Something was asked for that only a node has."""


class ROSInterruptException(ROSException, KeyboardInterrupt):
    """A node was told to end. It is never raised here."""


class _Node:
    """What is published, in one viewer whose fixed frame is that of the first marker; and where it is to appear."""

    def __init__(self):
        self.started = False
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
    why = NOT_HERE.get(name) or f"There is what publishing needs: {', '.join(__all__)}"
    raise AttributeError(f"rospy.{name} is not here. {why[0].upper()}{why[1:]}")


def init_node(name, **options):
    """Start the node `name` (a text without slashes or spaces) with an empty view; `options` have no effect here."""
    if not isinstance(name, str) or not name.replace("_", "").isalnum():
        raise ValueError(f"init_node: a node's name is made of letters, digits and _; got {name!r}")
    if not shell():
        _node.write()  # what an earlier node published
    _node.started, _node.name, _node.viewer, _node.shown = True, name, None, True


class Publisher:
    """Publishes markers to the view below the cell. The topic's name has no effect here."""

    def __init__(self, name, data_class, **options):
        # Of all messages, only a Marker has this constant, be the class ours, that of ROS 1 or that of ROS 2.
        if not isinstance(data_class, type) or not hasattr(data_class, "MESH_RESOURCE"):
            raise TypeError(
                f"Publisher: only Marker messages can be seen here; got {getattr(data_class, '__name__', data_class)}"
            )
        self._published = 0

    def publish(self, marker):
        """Draw a Marker as RViz does, and number its header. The first one's header.frame_id becomes the fixed frame.

        Raises ROSException where there is no node yet; ValueError for a frame that is not known and for what cannot be
        drawn, as Viewer.publish does.
        """
        if not _node.started:
            raise ROSException("ROS node has not been initialized yet. Please call init_node() first")
        _node.publish(marker)
        self._published += 1
        if hasattr(marker.header, "seq"):  # as ROS 2's has not
            marker.header.seq = self._published

    def get_num_connections(self):
        """Return how many receive what is published: one, the view."""
        return 1


class Time(rostime.Time):
    """A moment, in seconds since 1970; there is no simulated time here."""

    __slots__ = ()

    @staticmethod
    def now():
        """Return the present Time. Raises ROSInitException where there is no node yet."""
        if not _node.started:
            raise ROSInitException("time is not initialized. Have you called init_node()?")
        return Time.from_sec(time.time())


class Rate:
    """Keeps a loop to `hz` rounds a second, by sleeping in each for what is left of its time."""

    def __init__(self, hz):
        self._last, self.sleep_dur = Time.now(), Duration(0, int(1e9 / hz))

    def remaining(self):
        """Return the Duration that is left of this round."""
        return self._left(Time.now())

    def sleep(self):
        """Wait for the end of this round; where it is late by more than another, the next begins now."""
        now = Time.now()
        sleep(self._left(now))
        self._last += self.sleep_dur
        if now - self._last > self.sleep_dur * 2:
            self._last = now

    def _left(self, now):
        self._last = min(self._last, now)  # the clock may have been put back
        return self._last + self.sleep_dur - now


def sleep(duration):
    """Wait for `duration`: a Duration, or a number of seconds; not at all where it is negative."""
    seconds = duration.to_sec() if hasattr(duration, "to_sec") else duration
    time.sleep(max(seconds, 0))


def loginfo(message, *args):
    """Print a message as rospy does; with `args`, it is a template as for the % operator."""
    _log("INFO", message, args, sys.stdout)


def logwarn(message, *args):
    """As `loginfo`, to the standard error output, as a warning."""
    _log("WARN", message, args, sys.stderr)


def logerr(message, *args):
    """As `loginfo`, to the standard error output, as an error."""
    _log("ERROR", message, args, sys.stderr)


def _log(level, message, args, stream):
    print(f"[{level}] [{time.time():.6f}]: {str(message) % args if args else message}", file=stream)
