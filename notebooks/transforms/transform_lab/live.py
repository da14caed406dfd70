"""The link between a scene in the kernel and the pages that show it, over the channel that Jupyter has anyway.

The page (page.js) asks, live.js in the notebook's window passes it on, and the kernel answers with what has changed.
"""

import asyncio
import time
import uuid
from pathlib import Path

import anywidget
import traitlets
from IPython import get_ipython

from .drawing import draw
from .page import block, changes, labels, properties

PERIOD = 1 / 40  # seconds; more often than a screen shows it, nothing needs to be sent


def has_kernel():
    """Whether this runs in a notebook's kernel, and not in a terminal or a script."""
    return hasattr(get_ipython(), "kernel")


class Channel(anywidget.AnyWidget):
    """Runs live.js in the notebook's window. It is not displayed itself and keeps nothing but its name."""

    _esm = Path(__file__).with_name("live.js").read_text(encoding="utf-8")
    scene = traitlets.Unicode().tag(sync=True)


class Link:
    """Keeps the pages that show a viewer up to date: sends what differs from what was sent last."""

    def __init__(self, viewer, drawing, length):
        self.name = uuid.uuid4().hex
        self._viewer, self._length = viewer, length
        self._base = self._sent = properties(drawing.nodes)
        self._labels = labels(drawing.nodes)
        self._last, self._later = 0.0, None
        self._channel = Channel(scene=self.name)
        self._channel.on_msg(self._receive)

    def refresh(self):
        """Send the viewer's changes: at once, or together with those that follow within a 40th of a second."""
        wait = self._last + PERIOD - time.monotonic()
        if wait <= 0:
            self._send(self._sent)
        elif self._later is None:
            self._later = asyncio.get_running_loop().call_later(wait, self._send, self._sent)

    def _receive(self, _, message, __):
        """Answer a page: one that has just been opened, or one whose controls have moved."""
        if message.get("ready"):
            self._send(self._base)
        elif self._viewer._motion:
            self._viewer._motion.arguments = self._viewer._motion.at(message["values"])
            self._send(self._sent, message["number"])

    def _send(self, old, number=None):
        """Send what differs from the properties `old`, as the answer to the question `number`."""
        if self._later is not None:
            self._later.cancel()
            self._later = None
        drawing = draw(self._viewer.state(), self._length)
        self._sent, found = properties(drawing.nodes), labels(drawing.nodes)
        words = {"text": drawing.text, "number": number}
        if found != self._labels or old is self._base:
            words["labels"] = self._labels = found
        self._channel.send(words, [block(changes(old, self._sent))])
        self._last = time.monotonic()
