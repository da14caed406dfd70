"""What a scene is made of: solid shapes, points, lines and labels, each in the coordinates of a node.

A node is a place in the scene: its transform is given in the scene's root frame, and what hangs on it moves with it.
Both the interactive page and the still picture are drawn from the same nodes.
"""

import functools
import math
from dataclasses import dataclass, field
from urllib.parse import quote

import numpy as np

from ..validation import numbers, within_reach

X_RED, Y_GREEN, Z_BLUE = (0.84, 0.12, 0.12, 1), (0.05, 0.58, 0.15, 1), (0.12, 0.30, 0.92, 1)
DARK = (0.15, 0.15, 0.2, 1)
CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])  # of the unit box
GREY = (0.55, 0.55, 0.6, 1)
ORANGE, PURPLE = (0.93, 0.49, 0.0, 1), (0.52, 0.18, 0.66, 1)  # points and arrows
SKIN = (0.90, 0.72, 0.58, 1)  # a hand
BROWN, STEEL = (0.76, 0.62, 0.42, 1), (0.38, 0.42, 0.48, 1)  # boxes and grippers


@dataclass
class Solid:
    """A unit solid ("box", "sphere", "cylinder", "cone") placed by `matrix`; colour r, g, b, opacity from 0 to 1.

    The unit solids have diameter or edge 1 and height 1, are centred on the origin, and point along z. `matrix` is 4x4
    and may scale along the solid's own axes.
    """

    kind: str
    matrix: np.ndarray
    color: tuple


@dataclass
class Cloud:
    """Square points facing the viewer: `points` Nx3, `colors` Nx4, `size` of the edge in metres."""

    points: np.ndarray
    colors: np.ndarray
    size: float


@dataclass
class Mesh:
    """Triangles seen from both sides: `corners` Nx3x3, `colors` Nx3x4, one for each corner."""

    corners: np.ndarray
    colors: np.ndarray


@dataclass
class Label:
    """Text at a position (3 numbers), with a subscript; or near it, wherever no other label stands.

    near: one of the keys of NEAR; by default it stands at its position
    height: that of a capital letter, in metres, and the text a marker's; by default it is as large as text on a page
    """

    text: str
    position: np.ndarray
    color: tuple = DARK
    near: str | None = None
    height: float | None = None
    subscript: str = ""


# Where a label stands near its position, best first: a thing's name to the right (in half widths of the text) and up (in lines);
# a letter at the tip of its axis on along the axis and to its left, in lines. It takes the first place at which it covers least:
# a mark of the drawing counts 1, another label or the edge of the picture 20. Letters choose before names. Where all of these are
# taken, there is AROUND: to the right and up, in lines.
NEAR = {
    "tip": [
        *((0, 0), (0.8, 0), (0, 0.9), (0, -0.9), (0.8, 0.9), (0.8, -0.9), (1.7, 0), (0, 1.8), (0, -1.8), (-0.8, 1), (-0.8, -1)),
    ],
    "thing": [
        *((0, -1.2), (-1.2, -0.8), (1.2, -0.8), (0, -2.2), (-1.3, 0), (1.3, 0), (-1.2, 0.8), (1.2, 0.8), (0, 1.2)),
        *((-1.2, -1.8), (1.2, -1.8), (-1.2, 1.8), (1.2, 1.8), (0, 2.2), (0, -3.2), (0, 3.2), (0, -4.2)),
    ],
}  # fmt: skip
AROUND = [
    (round(far * math.sin(math.radians(turn)), 2), round(far * math.cos(math.radians(turn)), 2))
    for far in (2.5, 3.5, 4.5, 5.5)
    for turn in range(0, 360, 30)
]
LONGEST_SUBSCRIPT = 10  # letters


@dataclass
class Node:
    """A place in the scene: `transform` is 4x4 in the root frame; `path` names it, as in "frames/gripper"."""

    path: str
    transform: np.ndarray
    solids: list = field(default_factory=list)
    clouds: list = field(default_factory=list)
    meshes: list = field(default_factory=list)
    labels: list = field(default_factory=list)


def path(kind, name):
    """Return the path of the node for `name`, which may contain slashes, as "base/camera" does."""
    return f"{kind}/{quote(name, safe='')}"


def moved(transform, points):
    """Return points (...x3) moved by a 4x4 matrix."""
    return points @ transform[:3, :3].T + transform[:3, 3]


def placed(kind, position, size, color):
    """Return a Solid at `position`, its axes along those of the node, of `size` (3 numbers or one)."""
    matrix = np.eye(4)
    matrix[:3, :3] *= size
    matrix[:3, 3] = position
    return Solid(kind, matrix, color)


def rod(start, end, diameter, color, kind="cylinder"):
    """Return a Solid from `start` to `end` (a cone has its tip at `end`), or none if the two coincide."""
    start, end = np.asarray(start, float), np.asarray(end, float)
    length = math.dist(start, end)
    if length == 0:
        return []
    x, y, z = ((end - start) / length).tolist()
    # Any direction at right angles to the rod: the product of the axis that is farthest from it, and the rod.
    across = [(0, -z, y), (z, 0, -x), (-y, x, 0)][min(range(3), key=lambda i: abs((x, y, z)[i]))]
    width = diameter / math.hypot(*across)
    u, v, w = (width * number for number in across)
    matrix = np.array([
        [u, y * w - z * v, length * x, 0],
        [v, z * u - x * w, length * y, 0],
        [w, x * v - y * u, length * z, 0],
        [0, 0, 0, 1],
    ])  # fmt: skip
    matrix[:3, 3] = (start + end) / 2
    return [Solid(kind, matrix, color)]


def arrow(tail, tip, color, shaft, head, head_length):
    """Return the solids of an arrow; `shaft` and `head` are diameters. The head is at most as long as the arrow."""
    tail, tip = np.asarray(tail, float), np.asarray(tip, float)
    length = np.linalg.norm(tip - tail)
    if length == 0:
        return []
    neck = tip - (tip - tail) * min(head_length / length, 1)
    return rod(tail, neck, shaft, color) + rod(neck, tip, head, color, "cone")


def frame_node(name, transform, length, ghost=False, alone=True):
    """Return a Node with a frame's three axes, the letters at their tips, and its name.

    A ghost is translucent and thicker, so that a solid frame at the same place is seen inside it. Where a frame is not `alone`,
    its letters have its name as a subscript.
    """
    solids, letters = _axes(length, ghost, "" if alone else subscript(name))
    labels = [*letters, Label(name, np.zeros(3), near="thing")]
    return Node(path("frames", name), transform, list(solids), labels=labels)


def subscript(name):
    """Return the name of a frame as a subscript: "A" for "frame_a", "base" for "base_link"."""
    short = name.removeprefix("frame_").removesuffix("_link")
    short = short.upper() if len(short) == 1 else short
    return short if len(short) <= LONGEST_SUBSCRIPT else f"{short[: LONGEST_SUBSCRIPT - 1]}…"


@functools.lru_cache(50)
def _axes(length, ghost, subscript):
    """Return the solids and the letters of a frame's axes."""
    solids, letters = [], []
    thick = length * (2.2 if ghost else 1)
    for letter, axis, color in zip("xyz", np.eye(3), (X_RED, Y_GREEN, Z_BLUE)):
        shown = translucent(color) if ghost else color
        solids += arrow((0, 0, 0), length * axis, shown, 0.05 * thick, 0.13 * thick, 0.24 * length)
        letters.append(Label(letter, (1.25 if ghost else 1.12) * length * axis, color, "tip", subscript=subscript))
    solids.append(placed("sphere", (0, 0, 0), 0.08 * thick, translucent(DARK) if ghost else DARK))
    return solids, letters


def gripper_node(gripper, transform):
    """Return a Node with a parallel-jaw gripper at `transform`: fingers along x, moving along y, tips around the origin.

    Its proportions are those of a common 8 cm gripper.
    """
    node = Node(path("grippers", gripper.frame), transform)
    color = translucent(gripper.color) if gripper.ghost else gripper.color
    unit = gripper.opening / 0.08  # so that what follows is in metres for an opening of 8 cm
    dark = (*(0.7 * value for value in color[:3]), color[3])
    parts = [((-0.028, 0.045, 0), (0.09, 0.01, 0.02), dark), ((-0.028, -0.045, 0), (0.09, 0.01, 0.02), dark)]
    parts += [((-0.088, 0, 0), (0.03, 0.12, 0.04), color), ((-0.123, 0, 0), (0.04, 0.05, 0.04), color)]
    for middle, size, shade in parts:
        node.solids.append(placed("box", unit * np.array(middle), unit * np.array(size), shade))
    return node


def hand_node(hand, transform):
    """Return a Node with a right hand at `transform`: index finger along x, middle finger along y, thumb along z.

    The other two fingers are closed. Its proportions are those of a hand whose index finger is 9 cm long.
    """
    node = Node(path("hands", hand.frame), transform)
    unit = hand.length / 0.09  # so that what follows is in metres for such a hand
    bones = [((0, 0, 0), (0.078, 0, 0)), ((0, 0, 0), (0, 0.08, 0)), ((0, 0, 0), (0, 0, 0.075))]
    for low in (-0.022, -0.044):
        joints = [(-0.005, 0, low), (0.028, 0.012, low), (0.012, 0.036, low), (-0.02, 0.026, low)]
        bones += list(zip(joints, joints[1:]))
    for start, end in bones:
        start, end = unit * np.array(start), unit * np.array(end)
        node.solids += rod(start, end, 0.019 * unit, SKIN)
        node.solids += [placed("sphere", joint, 0.019 * unit, SKIN) for joint in (start, end)]
    node.solids.append(placed("box", unit * np.array([-0.045, 0, -0.022]), unit * np.array([0.08, 0.024, 0.066]), SKIN))
    node.solids += rod(unit * np.array([-0.08, 0, -0.022]), unit * np.array([-0.17, 0, -0.022]), 0.045 * unit, SKIN)
    return node


def xyz(message, what):
    """Return the x, y, z of a Point or Vector3 as an array; `what` starts the error messages."""
    if hasattr(message, "w") or not all(hasattr(message, name) for name in "xyz"):
        raise TypeError(f"{what} must be a Point, such as Point(x=1.0, y=2.0, z=3.0); got {type(message).__name__}")
    return within_reach(numbers([message.x, message.y, message.z], what, lengths=(3,)), what)


def translucent(color):
    """Return a colour as ghosts have it."""
    return (*color[:3], 0.3 * color[3])


def rgba(color, what):
    """Return a colour (ColorRGBA, or 3 or 4 numbers from 0 to 1) as a tuple r, g, b, opacity."""
    if isinstance(color, str):
        raise TypeError(f"{what} must be numbers from 0 to 1, such as (1, 0, 0) for red; got {color!r}")
    if hasattr(color, "r"):
        color = [color.r, color.g, color.b, color.a]
    values = numbers(color, what, lengths=(3, 4))
    if values.min() < 0 or values.max() > 1:
        raise ValueError(f"{what} must be made of numbers from 0 to 1 (not to 255); got {values.tolist()}")
    return (*values.tolist(), 1.0)[:4]
