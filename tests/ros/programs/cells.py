"""Runs a notebook's cells, on the robot or here, and notes what they print and what they ask of their viewer.

As a program it reads {"cells": [source]} and writes a list for each cell: what was told while it ran, in order.
"""

import io
import json
import sys
from contextlib import nullcontext, redirect_stdout

import numpy as np
from plain import plain

__all__ = ["Watched", "nullcontext", "run"]


class Watched:
    """What a notebook's viewer is here and there, before each of the two classes that do the work."""

    told = []

    def tell(self, what, value):
        Watched.told.append([what, value.tolist() if isinstance(value, np.ndarray) else plain(value)])

    def interact(self, function, **controls):
        """Call the function with its defaults, then with the ends of each control; what it returns is shown as text."""
        states = [{}]
        for name, choices in controls.items():
            states += [{name: choice} for choice in (choices[:2] if isinstance(choices, tuple) else choices)]
        for state in states:
            self.tell(f"state {state}", str(function(self, **state)))
        return self

    def animate(self, function, **options):
        for moment in (0.0, 0.5, 1.0):
            self.tell(f"moment {moment}", str(function(self, moment)))
        return self

    def show(self):
        """Nobody looks."""

    def lookup(self, target, source):
        matrix = super().lookup(target, source)
        self.tell(f"{target}_T_{source}", matrix)
        return matrix

    def publish(self, marker):
        super().publish(marker)
        self.tell("marker", marker)


def run(cells, names):
    """What the cells tell, a list for each; `names` is what they find besides their own."""
    notes = []
    for cell in cells:
        Watched.told, printed = [], io.StringIO()
        with redirect_stdout(printed), np.printoptions(suppress=True):  # rounding leaves other numbers near zero
            exec(compile(cell, "<cell>", "exec"), names)
        notes.append([*Watched.told, ["printed", printed.getvalue()]])
    return notes


if __name__ == "__main__":
    from cells import run  # as tf_and_rviz.py has it, whose viewers tell that one

    print(json.dumps(run(json.load(sys.stdin)["cells"], {})))
