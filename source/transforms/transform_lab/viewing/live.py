"""The link between a scene in the kernel and the pages that show it, over the channel that Jupyter has anyway.

The page (page.js) asks, live.js in the notebook's window passes it on, and the kernel answers with what has changed.
"""

import threading
import time
import uuid
from functools import cache
from pathlib import Path

import anywidget
from IPython import get_ipython

from .drawing import draw
from .meshcat_commands import block, changes, delete, properties
from .page import labels

PERIOD = 1 / 40  # seconds; more often than a screen shows it, nothing needs to be sent
EVERYTHING = ("frames", "links", "points", "arrows", "boxes", "grippers", "hands", "markers")
_links: dict = {}  # by their names


def has_kernel():
    """Whether this runs in a notebook's kernel, and not in a terminal or a script."""
    return hasattr(get_ipython(), "kernel")


class LiveWidget(anywidget.AnyWidget):
    """Runs live.js in the notebook's window, once for all scenes. It is not displayed and keeps nothing."""

    _esm = Path(__file__).with_name("live.js").read_text(encoding="utf-8")


@cache
def channel():
    """Return the kernel's only LiveWidget."""
    made = LiveWidget()
    made.on_msg(lambda _, message, __: message.get("scene") in _links and _links[message["scene"]].receive(message))
    return made


class Link:
    """Keeps the pages that show a viewer up to date: sends what differs from what was sent last.

    `length` is that of the axes in the pages, in metres. Jupyter may call `receive` in another thread than the cells'.
    """

    def __init__(self, viewer, motion):
        self.name, self.length = uuid.uuid4().hex, 1.0
        self._viewer, self._motion = viewer, motion
        self._sent, self._last, self._later = {}, 0.0, None
        self._lock = threading.RLock()
        _links[self.name] = self
        channel()

    def refresh(self):
        """Send the viewer's changes: at once, or together with those that follow within a 40th of a second."""
        with self._lock:
            wait = self._last + PERIOD - time.monotonic()
            if wait <= 0:
                self._send()
            elif self._later is None:
                self._later = threading.Timer(wait, self._send)
                self._later.start()

    def receive(self, message):
        """Answer a page whose controls have been moved, or one that wants everything, because it has just been opened."""
        with self._lock:
            for control, index in zip(self._motion.controls if self._motion else (), message["values"]):
                control.index = index
            self._send(message["number"], everything=message["everything"])

    def _send(self, number=None, everything=False):
        """Send what has changed, or everything, as the answer to the question `number`."""
        with self._lock:
            if self._later is not None:
                self._later.cancel()
                self._later = None
            drawing = draw(self._viewer.state_of(self._motion), self.length)
            now = properties(drawing.nodes)
            commands = changes({} if everything else self._sent, now)
            if everything:
                commands = [delete(f"meshcat/{kind}") for kind in EVERYTHING] + commands
            words = {"scene": self.name, "text": drawing.text, "labels": labels(drawing.nodes), "number": number}
            channel().send(words, [block(commands)])
            self._sent, self._last = now, time.monotonic()
