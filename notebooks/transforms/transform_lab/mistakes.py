"""What a mistake does to a frame or a point: where it should be, and where the mistake puts it."""

import numpy as np

from .jupyter import being_graded, shell
from .viewing.viewer import Viewer

__all__ = ["show_mistake"]

MISTAKE = "mistake"  # how the wrong one is called in the picture


def show_mistake(right, wrong, name="frame_b", viewer=None, length=None, gripper=False):
    """Show a still picture of `right`, drawn pale, and of `wrong`, in `viewer` (by default one of frame_a alone).

    Both are given in the frame that the viewer was made with. Each is a 4x4 transform, a 3x3 rotation matrix, a Pose, or the
    three coordinates of a point (metres). A matrix that is no rotation is drawn as the arrows that its columns are. `length`
    is that of the axes, in metres; `gripper` draws one on each of the two frames.

    Raises ValueError for anything else, naming what is wrong.
    """
    viewer = viewer or Viewer("frame_a", length=length)
    for label, value, ghost in ((name, right, True), (MISTAKE, wrong, False)):
        if hasattr(value, "orientation"):
            viewer.add_frame(label, value, length=length, ghost=ghost)
        elif hasattr(value, "x") or np.ndim(value) == 1:
            viewer.add_point(label, value, ghost=ghost)
        else:
            viewer.add_matrix(label, np.asarray(value, float), length=length, ghost=ghost)
        if gripper:
            viewer.add_gripper(label, ghost=ghost)
    viewer.text = "pale: as it should be; strong: by mistake"
    if viewer.at:
        viewer.look(at={*viewer.at, name, MISTAKE})
    words = f"Where it should be, and where the mistake puts it.\n{viewer.description()}"
    if shell() is None or being_graded():  # nobody looks while a notebook is graded
        print(words)
        return
    from IPython.display import display

    display({"text/plain": words, "text/html": viewer.still()}, raw=True)
