"""What makes a scene move: a function of time for an animation, or of what a student drags and chooses."""

import contextlib
import inspect
import io
import itertools
from dataclasses import dataclass, field

import numpy as np

STATES = 25  # of an animation; between them the page interpolates
MOST_STATES = 48  # computed beforehand for controls, for notebooks without a kernel
MOST_PLACES = 1001  # of a slider


@dataclass
class Control:
    """A slider or a drop-down list: the values it can have, and the place of the present one in that list."""

    name: str
    kind: str
    values: list
    place: int
    places: list = field(default_factory=list)  # those that are computed beforehand

    def told(self):
        """Return what the page needs to know."""
        values = [f"{value:g}" if self.kind == "slider" else str(value) for value in self.values]
        return {"name": self.name, "kind": self.kind, "values": values, "value": self.place, "places": self.places}

@dataclass
class Motion:
    """A function that adds to a scene what there is to see at a moment (0 to 1), or at a setting of the controls.

    `arguments` are those of the present state.
    """

    function: object
    arguments: dict
    controls: list = field(default_factory=list)
    seconds: float | None = None

    def settings(self):
        """Return the arguments (dicts) of the states that are computed beforehand."""
        if self.seconds is not None:
            return [{"moment": moment} for moment in np.linspace(0, 1, STATES).tolist()]
        _thin_out(self.controls)
        if np.prod([len(control.places) for control in self.controls]) > MOST_STATES:
            return []
        return [self.at(places) for places in itertools.product(*(control.places for control in self.controls))]

    def start(self):
        """Return which of the states computed beforehand is shown first: the end, or that of the controls as made."""
        state = 0 if self.controls else STATES - 1
        for one in self.controls:
            state = state * len(one.places) + one.places.index(one.place)
        return state

    def at(self, places):
        """Return the arguments for these places of the controls."""
        return {control.name: control.values[place] for control, place in zip(self.controls, places)}

    def scene(self, base, arguments, strict=False):
        """Return a copy of the scene `base` with what the function adds to it; what it returns is the text.

        An error of the function becomes the text, too, or is raised if `strict`. What it prints is not shown.
        """
        scene = base.copy()
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                scene.text = as_text(self.function(scene, **arguments))
        except Exception as error:  # the student's own, raised while they drag
            if strict:
                raise
            scene.text = f"{type(error).__name__}: {error}"
        return scene


def as_text(result):
    """Return what a function returned as the text to show beside the scene; None is no text."""
    if result is None:
        return ""
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
        return Control(name, "choice", choices, choices.index(default) if given and default in choices else 0)
    numeric = isinstance(choices, tuple) and all(isinstance(n, (int, float)) for n in choices)
    if not numeric or len(choices) not in (2, 3) or not choices[0] < choices[1]:
        raise ValueError(f"{name}={choices!r}: use (min, max) or (min, max, step) for a slider, a list for a choice")
    low, high, *step = choices
    step = step[0] if step else 1 if isinstance(low, int) and isinstance(high, int) else (high - low) / 100
    if not 0 < step <= high - low or (high - low) / step >= MOST_PLACES:
        raise ValueError(f"{name}={choices!r}: the step must lead from min to max in at most {MOST_PLACES - 1} steps")
    whole = isinstance(low, int) and isinstance(step, int)
    values = [low + i * step if whole else round(low + i * step, 10) for i in range(int((high - low) / step + 1e-9) + 1)]
    start = default if given else values[len(values) // 2]
    return Control(name, "slider", values, int(np.argmin([abs(value - start) for value in values])))


def _thin_out(controls):
    """Choose the places of each control that are computed beforehand: all, or evenly spaced ones of a lone slider."""
    for one in controls:
        one.places = list(range(len(one.values)))
    others = int(np.prod([len(one.values) for one in controls if one.kind != "slider"]))
    sliders = [one for one in controls if one.kind == "slider"]
    if len(sliders) == 1 and others * len(sliders[0].values) > MOST_STATES:
        count = max(MOST_STATES // others - 1, 2)
        spread = np.linspace(0, len(sliders[0].values) - 1, count).round().astype(int).tolist()
        sliders[0].places = sorted({*spread, sliders[0].place})
