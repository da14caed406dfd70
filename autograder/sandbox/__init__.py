"""Runs a student's notebook where it can do no harm: bubblewrap around a small IPython, spoken to over sockets."""

from .bubblewrap import exposes, problem, refusal
from .host import Ended, Limits, Sandbox

__all__ = ["Ended", "Limits", "Sandbox", "exposes", "problem", "refusal"]
