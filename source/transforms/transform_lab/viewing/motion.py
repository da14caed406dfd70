"""What makes a scene move: a function of time for an animation, or of what a student drags and chooses."""

import contextlib
import inspect
import io
import itertools
import math
import numbers
from dataclasses import dataclass, field

import numpy as np

STATES = 25  # of an animation; between them the page interpolates
MOST_STATES = 48  # computed beforehand for controls, for notebooks without a kernel
MOST_VALUES = 1001  # of a slider


@dataclass
class Control:
    """A slider or a drop-down list: the values it can have, and which of them it has (`index`).

    `sampled` are the indices for which the scene is computed beforehand.
    """

    name: str
    kind: str
    values: list
    index: int
    sampled: list = field(default_factory=list)

    def as_json(self):
        """Return what the page needs to know, in words and numbers."""
        values = [f"{value:.6g}" if isinstance(value, float) else str(value) for value in self.values]
        return {"name": self.name, "kind": self.kind, "values": values, "index": self.index, "sampled": self.sampled}


class Motion:
    """A function that adds to a scene what there is to see at a moment (0 to 1), or at a setting of controls."""

    def __init__(self, function, controls=(), seconds=None):
        self.function, self.controls, self.seconds = function, list(controls), seconds

    @property
    def arguments(self):
        """What belongs to the present state: the moment of an animation's end, or a dict of the controls' values."""
        if self.seconds is not None:
            return 1.0
        return {control.name: control.values[control.index] for control in self.controls}

    def settings(self):
        """Return the arguments of the states that are computed beforehand; none if they would be too many."""
        if self.seconds is not None:
            return np.linspace(0, 1, STATES).tolist()
        _sample(self.controls)
        if math.prod(len(control.sampled) for control in self.controls) > MOST_STATES:
            return []
        values = ([control.values[index] for index in control.sampled] for control in self.controls)
        names = [control.name for control in self.controls]
        return [dict(zip(names, setting)) for setting in itertools.product(*values)]

    @property
    def start(self):
        """Which of the settings is the present state."""
        state = 0 if self.controls else STATES - 1
        for control in self.controls:
            state = state * len(control.sampled) + control.sampled.index(control.index)
        return state

    def check(self):
        """Raise TypeError for what is no function, or one of other arguments."""
        if not callable(self.function):
            raise TypeError(f"the first argument must be a function; got {type(self.function).__name__}")
        moments = () if self.seconds is None else ("moment",)
        names = [control.name for control in self.controls]
        try:
            inspect.signature(self.function).bind("scene", *moments, **dict.fromkeys(names))
        except TypeError as error:
            raise TypeError(f"the function must take ({', '.join(['scene', *moments, *names])}): {error}") from None

    def scene(self, base, arguments, strict=False):
        """Return a copy of the scene `base` with what the function adds to it; what it returns is the text.

        An error of the function becomes the text, too, or is raised if `strict`.
        """
        scene, before = base.copy(), vars(base.copy())
        args, kwargs = ((), arguments) if isinstance(arguments, dict) else ((arguments,), {})
        try:
            if (result := self.function(scene, *args, **kwargs)) is not None:
                scene.text = as_text(result)
            if vars(base.copy()) != before:
                raise ValueError("the function must add to the scene it is given, and not to the viewer")
        except Exception as error:  # the student's own, raised while they drag
            if strict:
                raise
            scene.text = f"{type(error).__name__}: {error}"
        return scene

    def scenes(self, base, now):
        """Return the scenes of all `settings`, of which `now` is the present one. What the function prints is shown once."""
        settings = self.settings()
        with contextlib.redirect_stdout(io.StringIO()):
            return [now if i == self.start else self.scene(base, of) for i, of in enumerate(settings)]


def as_text(result):
    """Return what a function returned as the text to show beside the scene."""
    if isinstance(result, np.ndarray):
        rounded = np.round(result, 3) + 0.0 if np.issubdtype(result.dtype, np.floating) else result  # -0 becomes 0
        return np.array2string(rounded, suppress_small=True)
    return str(result)


def control(name, choices, default=inspect.Parameter.empty):
    """Return the Control for what ipywidgets.interact also takes: (min, max), (min, max, step), a list, True or False.

    It starts at `default`, or else in the middle of a slider and at the first entry of a list. Raises ValueError for
    anything else.
    """
    given = default is not inspect.Parameter.empty
    if isinstance(choices, bool):
        return Control(name, "choice", [True, False], 0 if (default if given else choices) else 1)
    if isinstance(choices, list) and choices:
        found = [i for i, choice in enumerate(choices) if choice is default or np.array_equal(choice, default)]
        if given and not found:
            raise ValueError(f"{name}={choices!r}: the default {default!r} is not one of these")
        return Control(name, "choice", choices, found[0] if given else 0)
    numeric = isinstance(choices, tuple) and all(isinstance(n, numbers.Real) and math.isfinite(n) for n in choices)
    if not numeric or len(choices) not in (2, 3) or not choices[0] < choices[1]:
        raise ValueError(
            f"{name}={choices!r}: use (min, max) or (min, max, step) for a slider, a list for a choice (or make a list of it)"
        )
    low, high, *step = (n.item() if isinstance(n, np.generic) else n for n in choices)
    step = step[0] if step else 1 if isinstance(low, int) and isinstance(high, int) else (high - low) / 100
    if not 0 < step <= high - low or (high - low) / step >= MOST_VALUES:
        raise ValueError(f"{name}={choices!r}: the step must lead from min to max in at most {MOST_VALUES - 1} steps")
    whole = isinstance(low, int) and isinstance(step, int)
    values = [
        low + i * step if whole else float(f"{low + i * step:.12g}") for i in range(int((high - low) / step + 1e-9) + 1)
    ]
    if given and not (isinstance(default, numbers.Real) and low <= default <= high):
        raise ValueError(f"{name}={choices!r}: the default {default!r} is not between min and max")
    start = default if given else values[len(values) // 2]
    return Control(name, "slider", values, int(np.argmin([abs(value - start) for value in values])))


def _sample(controls):
    """Choose what is computed beforehand of each control: everything, or evenly spaced values of a lone slider."""
    for one in controls:
        one.sampled = list(range(len(one.values)))
    others = math.prod(len(one.values) for one in controls if one.kind != "slider")
    sliders = [one for one in controls if one.kind == "slider"]
    if len(sliders) == 1 and others * len(sliders[0].values) > MOST_STATES:
        count = max(MOST_STATES // others - 1, 2)
        spread = np.linspace(0, len(sliders[0].values) - 1, count).round().astype(int).tolist()
        sliders[0].sampled = sorted({*spread, sliders[0].index})
