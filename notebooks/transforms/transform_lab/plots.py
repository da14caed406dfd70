"""What is better seen flat: a rotation's columns, a quaternion against its angle, a scene from above.

Made with Matplotlib, in the colours of the viewer. Each function draws into `ax` and returns it, or into a new figure,
which it shows. While a notebook is graded nothing is drawn, and None is returned.
"""

import functools
import inspect
import io
import math

import numpy as np

from .jupyter import being_graded, shell
from .validation import numbers
from .viewing.shapes import CORNERS, DARK, X_RED, Y_GREEN, Z_BLUE, moved

__all__ = ["plot_columns", "plot_from_above", "plot_quaternion"]


def _picture(plot):
    """Make `plot` show the figure that it makes itself, with words for who cannot see it, which a PNG in Jupyter has not.

    While a notebook is graded it does nothing: nobody looks, and importing Matplotlib takes long.
    """

    @functools.wraps(plot)
    def drawn(*args, **kwargs):
        if being_graded():
            return None
        axes = plot(*args, **kwargs)
        if shell() and inspect.signature(plot).bind(*args, **kwargs).arguments.get("ax") is None:
            _show(axes)
        return axes

    return drawn


def _show(axes):
    from IPython.display import display
    from PIL import Image

    from .viewing.page import still

    names = dict.fromkeys([text.get_text() for text in axes.texts] + [line.get_label() for line in axes.lines])
    words = f"{axes.get_title()}. Across: {axes.get_xlabel()}. Up: {axes.get_ylabel() or 'from -1 to 1'}."
    words += f" Shown: {', '.join(name for name in names if name and not name.startswith('_'))}."
    file = io.BytesIO()
    axes.figure.savefig(file, dpi=90, facecolor="white")
    display({"text/plain": words, "text/html": still(Image.open(file).convert("RGB"), words, "")}, raw=True)


@_picture
def plot_columns(a_R_b, ax=None):
    """Draw the x and y axes of frame B, the first two columns of `a_R_b` (3x3), seen from above on frame A.

    Frame A is drawn pale. Raises ValueError if it is no 3x3 matrix of numbers.
    """
    R = numbers(a_R_b, "plot_columns: a_R_b")
    if R.shape != (3, 3):
        raise ValueError(f"plot_columns: a_R_b must be a 3x3 matrix; got shape {R.shape}")
    ax = ax or _new_axes(4, 4)
    for axes, opacity, of in ((np.eye(3), 0.3, "A"), (R, 1, "B")):
        for i, (letter, color) in enumerate((("x", X_RED), ("y", Y_GREEN))):
            _arrow(ax, (0, 0), axes[:2, i], color, opacity, f"{letter} of {of}")
    reach = max(1, np.abs(R[:2, :2]).max()) * 1.4
    ax.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    ax.set(xlabel="x of A", ylabel="y of A", title="Frame B on frame A, from above")
    return ax


@_picture
def plot_quaternion(axis=(0, 0, 1), ax=None):
    """Draw the four numbers x, y, z, w of a turn about `axis` (3 numbers) against its angle, from 0 to 720 degrees.

    Source: q = (u sin(angle / 2), cos(angle / 2)) for the unit vector u along the axis.
    """
    direction = numbers(axis, "plot_quaternion: the axis", lengths=(3,))
    if not direction.any():
        raise ValueError("plot_quaternion: the axis must not be 0, 0, 0")
    direction /= np.linalg.norm(direction)
    ax = ax or _new_axes(7, 3.5)
    degrees = np.arange(0, 721, 5)
    half = np.radians(degrees) / 2
    styles = zip("xyz", direction, (X_RED, Y_GREEN, Z_BLUE), ("--", "-.", "-"), (3, 2, 1.5))
    for letter, part, color, style, width in styles:
        ax.plot(degrees, part * np.sin(half), style, color=color, linewidth=width, label=letter)
    ax.plot(degrees, np.cos(half), ":", color=DARK, linewidth=2.5, label="w")
    ax.set(xticks=range(0, 721, 90), xlabel="angle in degrees", ylim=(-1.1, 1.1))
    ax.set(title=f"Quaternion of a turn about ({', '.join(f'{n:.3g}' for n in direction)})")
    ax.legend(loc="center left", bbox_to_anchor=(1, 0.5), frameon=False)
    return ax


@_picture
def plot_from_above(viewer, ax=None):
    """Draw a Viewer's scene flat: x of the fixed frame to the right, y up, in metres.

    Of each frame the x and y axes are drawn, as far as they lie in the plane; points, arrows, and the outlines of boxes and
    grippers; no markers. What `viewer.look(at=...)` names is in the picture, or else everything.
    """
    from .viewing.drawing import draw_all, in_frame

    scene = viewer.state()
    (drawing,), length = draw_all([scene], viewer.at)
    seen = drawing.seen_from(scene.fixed_frame)[:, :2]
    margin = 0.12 * max(np.ptp(seen, axis=0).max(), 1e-6)
    (left, bottom), (right, top) = seen.min(axis=0) - margin, seen.max(axis=0) + margin
    ax = ax or _new_axes(6, 4.5)
    ax.set(xlim=(left, right), ylim=(bottom, top), aspect="equal")
    ax.set(xlabel=f"x of {scene.fixed_frame}", ylabel=f"y of {scene.fixed_frame}", title="From above")
    for node in in_frame(drawing.nodes, drawing.frames[scene.fixed_frame]):
        if node.path.startswith(("boxes/", "grippers/")):
            for solid in node.solids:
                _outline(ax, node.transform @ solid.matrix, solid.color)
    for name, frame in scene.frames.items():
        T = scene.lookup(scene.fixed_frame, name)
        for i, (letter, color) in enumerate((("X", X_RED), ("Y", Y_GREEN))):
            _arrow(ax, T[:2, 3], (frame.length or length) * T[:2, i], color, 0.35 if frame.ghost else 1, letter)
        _name(ax, name, T[:2, 3])
    for name, arrow in scene.arrows.items():
        T = scene.lookup(scene.fixed_frame, arrow.frame)
        tail, tip = (moved(T, end)[:2] for end in (arrow.tail, arrow.tip))
        _arrow(ax, tail, tip - tail, arrow.color, 0.35 if arrow.ghost else 1)
        _name(ax, name, (tail + tip) / 2)
    for name, point in scene.points.items():
        T = scene.lookup(scene.fixed_frame, point.frame)
        place = moved(T, point.position)[:2]
        ax.plot(*place, "o", color=point.color[:3])
        _name(ax, name, place)
    return ax


def _new_axes(width, height):
    """Return axes of a new figure. In a notebook pyplot does not know it: nothing that is left over there counts."""
    if shell():
        from matplotlib.figure import Figure

        ax = Figure(figsize=(width, height), layout="constrained").subplots()
    else:
        import matplotlib.pyplot as plt

        ax = plt.subplots(figsize=(width, height), layout="constrained")[1]
    ax.grid(color="#e4e7eb")
    ax.set_axisbelow(True)
    return ax


def _arrow(ax, tail, along, color, opacity=1, name=""):
    """Draw an arrow; one that points at us or away is a dot."""
    tail, along = np.asarray(tail, float), np.asarray(along, float)
    if math.hypot(*along) < 1e-9:
        ax.plot(*tail, ".", color=color[:3], alpha=opacity)
        return
    style = {"arrowstyle": "-|>", "color": color[:3], "alpha": opacity, "linewidth": 2.5, "mutation_scale": 14}
    ax.annotate("", tail + along, tail, arrowprops={**style, "shrinkA": 0, "shrinkB": 0})
    if name:
        style = {"color": color[:3], "alpha": max(opacity, 0.6), "parse_math": False, "clip_on": True}
        ax.text(*(tail + 1.17 * along), name, ha="center", va="center", **style)


def _outline(ax, matrix, color):
    """Draw the outline of a unit box moved by `matrix`."""
    from scipy.spatial import ConvexHull

    flat = moved(matrix, CORNERS)[:, :2]
    ax.fill(*flat[ConvexHull(flat).vertices].T, facecolor=(*color[:3], 0.35 * color[3]), edgecolor=color[:3])


def _name(ax, name, place):
    style = {"color": DARK, "fontweight": "bold", "annotation_clip": True, "parse_math": False}
    ax.annotate(name, place, xytext=(5, -12), textcoords="offset points", **style)
