"""The first failing case as a scene: where the answer should be, as a ghost, and where the student's is."""

import re

import numpy as np

from .. import tft
from ..validation import FARTHEST
from ..viewing.drawing import round_number
from ..viewing.shapes import X_RED, Y_GREEN, Z_BLUE
from ..viewing.viewer import Viewer
from . import codec
from .answers import matrix_of, parts_of


def scene(verdict):
    """The Viewer that shows a Verdict's failing case; None when there is nothing to draw.

    The frames are found by the names of the answer and of the function's parameters: base_T_camera, p_in_camera,
    pose_in_b, object_pose (described in the frame that the answer is described in).
    """
    case = verdict.failing
    if case is None or not verdict.wanted or verdict.answer is None:
        return None
    parent, name = _frames(verdict.wanted)
    given = [codec.decode(plain) for plain in case["args"]]
    answers = {"yours": verdict.answer}
    if given:  # the expected answer of a function without arguments is the solution
        answers = {"expected": codec.decode(case["expected"]), **answers}
    viewer = Viewer(parent)
    try:
        _add_given(viewer, verdict.parameters, given, name)
        all_parts = {whose: parts_of(verdict.returns, answer) for whose, answer in answers.items()}
        for whose, parts in all_parts.items():
            label, ghost, answer = f"{name} ({whose})", whose == "expected", answers[whose]
            if verdict.returns == "coordinates":
                viewer.add_point(label, parts["coordinates"], ghost=ghost)
            elif verdict.returns == "pose":
                viewer.add_frame(label, answer, ghost=ghost)
            else:
                add_matrix(viewer, label, matrix_of(parts), ghost, _length(all_parts.values()))
    except ValueError:  # nothing that could be drawn; the panel says what is wrong with it
        return None
    if "expected" in answers:
        viewer.text = "pale: expected"
    return viewer.look(at=_close_together(viewer))


def _close_together(viewer):
    """The names of all but the fixed frame, where this is so far from them that they would be small; else None."""
    places = {name: viewer.in_root(name)[:3, 3] for name in viewer.frames if name != viewer.root}
    if len(places) < 2 or viewer.points or viewer.arrows:
        return None
    spread, distance = np.ptp(list(places.values()), axis=0).max(), np.linalg.norm(list(places.values()), axis=1).min()
    return list(places) if 0 < 3 * spread < distance else None


def _frames(answer):
    """("a", "b") of "a_T_b"; ("a", "p") of "p_in_a"."""
    if found := re.fullmatch(r"(\w+)_in_(\w+)", answer):
        return found[2], found[1]
    return re.fullmatch(r"(\w+?)_[TR]_(\w+)", answer).groups()


def _length(answers):
    """How long to draw the axes of matrices (given by their parts), in metres."""
    sizes = [np.abs(parts["translation"]).max() for parts in answers if "translation" in parts]
    return round_number(0.5 * max(sizes)) if sizes and 0 < max(sizes) < FARTHEST else 1.0


def add_matrix(viewer, label, matrix, ghost=False, length=None):
    """Add the frame of a 3x3 or 4x4 matrix to `viewer`; of one that is no rotation, its three columns as arrows."""
    if matrix.shape == (3, 3):
        matrix = np.block([[matrix, np.zeros((3, 1))], [np.zeros((1, 3)), 1]])
    try:
        viewer.add_frame(label, matrix, length=length, ghost=ghost)
    except ValueError:
        if matrix.shape != (4, 4) or not np.array_equal(matrix[3], [0, 0, 0, 1]):
            raise
        for letter, column, color in zip("xyz", matrix[:3, :3].T, (X_RED, Y_GREEN, Z_BLUE)):
            viewer.add_arrow(
                f"{letter} of {label}", matrix[:3, 3] + (length or 1) * column, tail=matrix[:3, 3], color=color
            )


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
