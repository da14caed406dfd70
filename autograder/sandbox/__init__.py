"""Runs a student's notebook where it can do no harm: a small IPython in bubblewrap, spoken to over a socket."""

from .account import refusal as refusal_as_user
from .bubblewrap import NotStarted, exposes, problem, refusal
from .host import Ended, ForkServer, Limits, Sandbox

__all__ = ["Ended", "ForkServer", "Limits", "NotStarted", "Sandbox", "exposes", "problem", "refusal", "refusal_as_user"]
