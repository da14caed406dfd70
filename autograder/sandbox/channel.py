"""Frames of JSON over a socket: the length in 4 bytes, then the text. Both ends of the sandbox use it.

The receiving end treats every byte as a lie: there is a bound to all frames together, reading has a deadline, and an
answer counts only with the nonce of the request it answers.
"""

import json
import select
import struct
import time

# What a fork server is asked: to get ready for cells; to start a notebook's process; one that has SciPy and Matplotlib
EXPECT, FORK, FORK_LARGER = b"E", b"F", b"L"
LENGTH = struct.Struct(">I")
MOST_RECEIVED = 4_000_000  # bytes in the life of a channel; twice what a notebook may output
CHUNK = 1 << 16  # bytes that are read at once
MOST_FORGED = 100  # frames that nobody asked for, in the life of a channel


class Closed(Exception):
    """The other end is gone."""


class Late(Exception):
    """Nothing whole has come before the deadline."""


class Garbled(Exception):
    """What came is no frame, or too much."""


class Channel:
    """One end of a socket that carries frames.

    most: bytes that are taken in all; None for the notebook's end, which has the grader at its other end
    """

    def __init__(self, connection, most=MOST_RECEIVED):
        self.connection, self.most = connection, most
        self.buffer, self.forged = bytearray(), 0

    def send(self, message):
        """Write one frame; raises Closed when nobody is there to read it."""
        data = json.dumps(message, separators=(",", ":")).encode()
        try:
            self.connection.sendall(LENGTH.pack(len(data)) + data)
        except OSError as error:
            raise Closed from error

    def receive(self, deadline=None):
        """Read one frame, until `deadline` (time.monotonic) at most. What came before a Late is not lost."""
        self._fill(LENGTH.size, deadline)
        size = LENGTH.size + LENGTH.unpack_from(self.buffer)[0]
        if self.most is not None and size > self.most:
            raise Garbled("more than the grader takes")
        self._fill(size, deadline)
        frame = self.buffer[LENGTH.size : size]
        del self.buffer[:size]
        if self.most is not None:
            self.most -= size
        try:
            return json.loads(frame.decode())
        except (ValueError, RecursionError) as error:
            raise Garbled("not JSON") from error

    def answer_to(self, nonce, number, deadline):
        """The first frame that carries `nonce` and `number` (None: none); forged ones are passed over, a flood is Garbled."""
        while self.forged < MOST_FORGED:
            message = self.receive(deadline)
            if isinstance(message, dict) and (message.get("nonce"), message.get("number")) == (nonce, number):
                return message
            self.forged += 1
        raise Garbled("a flood of frames that nobody asked for")

    def _fill(self, size, deadline):
        while len(self.buffer) < size:
            if deadline is not None:
                left = max(0.0, deadline - time.monotonic())  # what has come in time counts, even if it is read late
                if not select.select([self.connection], [], [], left)[0]:
                    raise Late
            # At the notebook's end no more than there has to be: a descriptor may follow.
            most = CHUNK if self.most is not None else min(size - len(self.buffer), CHUNK)
            try:
                chunk = self.connection.recv(most)
            except OSError as error:
                raise Closed from error
            if not chunk:
                raise Closed
            self.buffer += chunk
