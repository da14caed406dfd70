"""What a mistake does to a frame or a point: where it should be, and where the mistake puts it."""

import os

import numpy as np

from .check import shell
from .comparison import add_matrix
from .viewer import Viewer

__all__ = ["show_mistake"]


def show_mistake(right, wrong, name="frame_b", fixed_frame="frame_a", seen_from="overview"):
    """Show a still picture of `right`, drawn pale, and of `wrong`, both given in `fixed_frame`.

    Each is a 4x4 transform, a 3x3 rotation matrix, a Pose, or the three coordinates of a point (metres). A matrix that is
    no rotation is drawn as the arrows that its columns are. Raises ValueError for anything else, naming what is wrong.
    """
    viewer = Viewer(fixed_frame)
    for label, value, ghost in ((name, right, True), (f"{name}, by mistake", wrong, False)):
        if hasattr(value, "orientation"):
            viewer.add_frame(label, value, ghost=ghost)
        elif np.ndim(value) == 1:
            viewer.add_point(label, value, ghost=ghost)
        else:
            add_matrix(viewer, label, np.asarray(value, float), ghost)
    viewer.text = "pale: as it should be"
    viewer.look(seen_from)
    words = f"Where it should be, and where the mistake puts it.\n{viewer.description()}"
    if shell() is None or os.environ.get("TRANSFORM_LAB_GRADING"):  # nobody looks while a notebook is graded
        print(words)
        return
    from IPython.display import display

    display({"text/plain": words, "text/html": viewer.still()}, raw=True)
