"""Runs a student's notebook where it can do no harm: a small IPython in bubblewrap, spoken to over a socket.

probe -> host -> bubblewrap or account, watch -> bounds; inside: forkserver -> executor -> shell, outputs; seccomp, channel
"""

from .bounds import Limits, NotStarted
from .host import Ended, ForkServer, Sandbox
from .probe import exposes, problem, refusal, refusal_as_user

__all__ = ["Ended", "ForkServer", "Limits", "NotStarted", "Sandbox", "exposes", "problem", "refusal", "refusal_as_user"]
