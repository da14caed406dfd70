"""The first failing case as a scene: where the answer should be, as a ghost, and where the student's is."""

import re

import numpy as np

from .. import tft
from ..validation import FARTHEST
from ..viewing.drawing import round_number
from ..viewing.viewer import Viewer
from . import codec
from .answers import parts_of
from .kinds import KINDS


def scene(verdict):
    """The Viewer that shows a Verdict's failing case; None when there is nothing to draw.

    The frames are found by the names of the answer and of the function's parameters: base_T_camera, p_in_camera,
    pose_in_b, object_pose (described in the frame that the answer is described in).
    """
    case, kind = verdict.failing, KINDS.get(verdict.returns)  # none when no call came to its end
    if case is None or kind is None or kind.draw is None or not verdict.wanted or verdict.answer is None:
        return None
    parent, name = frames_of(verdict.wanted)
    given = [codec.decode(plain) for plain in case["args"]]
    answers = [(f"{name} (yours)", verdict.answer, False)]
    if given:  # the expected answer of a function without arguments is the solution
        answers.insert(0, (f"{name} (expected)", codec.decode(case["expected"]), True))
    viewer = Viewer(parent)
    try:
        _add_given(viewer, verdict.parameters, given, name)
        drawn = [(label, parts_of(verdict.returns, answer), ghost) for label, answer, ghost in answers]
        length = _length(kind, [parts for _, parts, _ in drawn])
        for label, parts, ghost in drawn:
            kind.draw(viewer, label, parts, ghost, length)
    except ValueError:  # nothing that could be drawn; the panel says what is wrong with it
        return None
    if given:
        viewer.text = "pale: expected"
    return viewer.look(at=_close_together(viewer))


def _close_together(viewer):
    """The names of all but the fixed frame, where this is so far from them that they would be small; else None."""
    places = {name: viewer.in_root(name)[:3, 3] for name in viewer.frames if name != viewer.root}
    if len(places) < 2 or viewer.points or viewer.arrows:
        return None
    spread, distance = np.ptp(list(places.values()), axis=0).max(), np.linalg.norm(list(places.values()), axis=1).min()
    return list(places) if 0 < 3 * spread < distance else None


def _length(kind, answers):
    """How long to draw the axes of a matrix that is one of these answers (given by their parts), in metres."""
    places = [name for name, part in kind.parts.items() if part.unit == "m"]
    size = max((np.abs(parts[name]).max() for parts in answers for name in places), default=0)
    return round_number(0.5 * size) if 0 < size < FARTHEST else 1.0


def frames_of(answer):
    """("a", "b") of "a_T_b" or "a_R_b"; ("a", "p") of "p_in_a"; None for another name, which tells no frame."""
    if found := re.fullmatch(r"(\w+)_in_(\w+)", answer):
        return found[2], found[1]
    found = re.fullmatch(r"(\w+?)_[TR]_(\w+)", answer)
    return found and found.groups()


def _add_given(viewer, parameters, given, answer):
    """Add the frames that the arguments describe, as far as they hang together with the viewer's; not the answer's."""
    root = viewer.fixed_frame
    edges = []
    if parameters[-1:] and parameters[-1].startswith("*"):  # a chain: each transform leads from one link to the next
        edges = [(f"link {i}" if i else root, f"link {i + 1}", T) for i, T in enumerate(given[:-1])]
    for parameter, value in zip(parameters, given):
        if found := re.fullmatch(r"(\w+?)_T_(\w+)", parameter):
            edges.append((*found.groups(), value))
        elif found := re.fullmatch(r"(\w+)_pose", parameter):
            edges.append((root, found[1], value))
    known = {root}
    for _ in edges:  # each round reaches one step further
        for parent, child, transform in edges:
            if answer in (parent, child) or (parent in known) == (child in known):
                continue
            if child in known:
                parent, child, transform = child, parent, tft.inverse_matrix(transform)
            viewer.add_frame(child, transform, parent=parent)
            known.add(child)
