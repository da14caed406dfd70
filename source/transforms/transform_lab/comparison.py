"""The first failing case as a scene: where the answer should be, as a ghost, and where the student's is."""

import re

import numpy as np

from . import codec, tft
from .answers import matrix_of, parts_of
from .shapes import X_RED, Y_GREEN, Z_BLUE
from .viewer import Viewer


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
        for whose, answer in answers.items():
            parts = parts_of(verdict.returns, answer)
            label, ghost = f"{name} ({whose})", whose == "expected"
            if verdict.returns == "coordinates":
                viewer.add_point(label, parts["coordinates"], ghost=ghost)
            elif verdict.returns == "pose":
                viewer.add_frame(label, answer, ghost=ghost)
            else:
                _add_matrix(viewer, label, parts, ghost)
    except ValueError:  # nothing that could be drawn; the panel says what is wrong with it
        return None
    return viewer


def _frames(answer):
    """("a", "b") of "a_T_b"; ("a", "p") of "p_in_a"."""
    if found := re.fullmatch(r"(\w+)_in_(\w+)", answer):
        return found[2], found[1]
    return re.fullmatch(r"(\w+?)_[TR]_(\w+)", answer).groups()


def _add_matrix(viewer, label, parts, ghost):
    """Add a frame; of a matrix that is no rotation, its three columns as arrows."""
    length, matrix = None, matrix_of(parts)
    if matrix.shape == (3, 3):
        length, matrix = 1.0, tft.identity_matrix()  # as long as unit axes are, to compare other columns with
        matrix[:3, :3] = parts["rotation"]
    try:
        viewer.add_frame(label, matrix, length=length, ghost=ghost)
    except ValueError:
        if not np.array_equal(matrix[3], [0, 0, 0, 1]):
            raise
        for letter, column, color in zip("xyz", matrix[:3, :3].T, (X_RED, Y_GREEN, Z_BLUE)):
            viewer.add_arrow(f"your {letter}", matrix[:3, 3] + column, tail=matrix[:3, 3], color=color)


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
