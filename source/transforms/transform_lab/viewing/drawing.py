"""Turns a scene into what is drawn: nodes with solids and labels, the points to have in view, the grid."""

import math
import textwrap
from dataclasses import dataclass, replace

import numpy as np

from .. import tft
from .markers import draw_marker, marker_name, marker_pose
from .shapes import (
    CORNERS,
    GREY,
    Label,
    Node,
    arrow,
    frame_node,
    gripper_node,
    hand_node,
    moved,
    path,
    placed,
    rod,
    translucent,
)

LINE, MOST_LINES = 90, 8  # letters in a line of what is said of markers, and how many of these there are
SMALLEST = 1e-6  # metres; what is closer together is at the same place but for rounding


@dataclass
class Drawing:
    """A scene as it is drawn, in its root frame, the one that its viewer was made with.

    `frames` has the 4x4 transform of each frame by its name, `seen` the points (Nx3) that are to be in view.
    """

    nodes: list
    frames: dict
    seen: np.ndarray
    text: str

    def seen_from(self, name):
        """Return the points to be in view, in the coordinates of the frame `name`."""
        return (self.seen - self.frames[name][:3, 3]) @ self.frames[name][:3, :3]

    def leave_room(self, length):
        """Have in view, too, where axes of `length` metres come to when the frames turn."""
        around = 1.25 * length * np.concatenate([np.eye(3), -np.eye(3)])
        self.seen = np.concatenate([self.seen, *(T[:3, 3] + around for T in self.frames.values())])


def draw(scene, length):
    """Return the Drawing of a scene with axes of `length` metres, where no other was asked for."""
    drawing = _draw(scene, None)
    _add_sized(scene, drawing, length, None)
    return drawing


def draw_all(scenes, at=None):
    """Return a Drawing for each of `scenes` (states of one scene), with axes of one length, and that length in metres.

    The length is the largest that was asked for, or a round number that fits the scenes. `at` names the frames and
    things that have to be in view; None is everything.
    """
    drawings = [_draw(scene, at) for scene in scenes]
    if not any(len(drawing.seen) for drawing in drawings):
        raise ValueError(f"none of what is to be looked at is there: {', '.join(at)}")
    given = [frame.length for scene in scenes for frame in scene.frames.values() if frame.length]
    size = np.ptp(np.concatenate([drawing.seen for drawing in drawings]), axis=0).max()
    length = max(given) if given else round_number(0.5 * size) if size > SMALLEST else 1.0
    for scene, drawing in zip(scenes, drawings):
        _add_sized(scene, drawing, length, at)
    return drawings, length


def _draw(scene, at):
    """Return a Drawing with what has a size of its own: markers, boxes and grippers."""
    where = {name: scene.in_root(name) for name in scene.frames}
    nodes = []
    for published in scene.markers.values():
        marker = published.marker
        place = where.get(marker.header.frame_id) if published.place is None else published.place
        if place is not None:
            nodes.append(Node(path("markers", marker_name(marker)), place @ marker_pose(marker)))
            draw_marker(marker, nodes[-1])
    ends = [np.empty((0, 3))] + (_corners(nodes) if at is None else [])
    for name, box in scene.boxes.items():
        color = translucent(box.color) if box.ghost else box.color
        node = Node(path("boxes", name), where[box.frame] @ box.transform, [placed("box", (0, 0, 0), box.size, color)])
        if name not in scene.frames:
            node.labels.append(Label(name, np.zeros(3), _readable(color), near="thing"))
        nodes.append(node)
        ends += _corners([node]) if at is None or name in at else []
    for gripper in scene.grippers.values():
        nodes.append(gripper_node(gripper, where[gripper.frame]))
        ends += _corners(nodes[-1:]) if at is None or gripper.frame in at else []
    for hand in scene.hands.values():
        nodes.append(hand_node(hand, where[hand.frame]))
        ends += _corners(nodes[-1:]) if at is None or hand.frame in at else []
    for name, thing in (*scene.points.items(), *scene.arrows.items()):
        if at is None or name in at:
            ends += [moved(where[thing.frame], p)[None] for p in vars(thing).values() if isinstance(p, np.ndarray)]
    ends += [T[None, :3, 3] for name, T in where.items() if at is None or name in at]
    return Drawing(nodes, where, np.concatenate(ends), _words(scene))


def _words(scene):
    """Return what stands in the corner: the scene's text, and what RViz says of markers, in lines that fit."""
    said = [line for text in scene.said() for line in textwrap.wrap(text, LINE)]
    more = [f"… and {len(said) - MOST_LINES} lines more"] if len(said) > MOST_LINES else []
    return "\n".join([*scene.text.splitlines(), *said[:MOST_LINES], *more])


def _add_sized(scene, drawing, length, at):
    """Add to `drawing` all that is drawn the larger the longer the axes are."""
    where, thickness = drawing.frames, 0.05 * length
    for name, frame in scene.frames.items():
        alone = len(scene.frames) == 1
        drawing.nodes.append(frame_node(name, where[name], frame.length or length, frame.ghost, alone))
        if at is None or name in at:
            tips = [label.position for label in drawing.nodes[-1].labels]
            drawing.seen = np.concatenate([drawing.seen, moved(where[name], np.array(tips))])
        in_view = at is None or {name, frame.parent} <= {*at}  # else the line leads out of the picture
        if frame.parent is not None and in_view:
            line = rod(where[frame.parent][:3, 3], where[name][:3, 3], 0.25 * thickness, GREY)
            drawing.nodes.append(Node(path("links", name), np.eye(4), line))
    for name, p in scene.points.items():
        size, color = (5 * thickness, translucent(p.color)) if p.ghost else (3 * thickness, p.color)
        ball = placed("sphere", p.position, size, color)
        label = Label(name, p.position, _readable(p.color), near="thing")
        drawing.nodes.append(Node(path("points", name), where[p.frame], [ball], labels=[label]))
    for name, a in scene.arrows.items():
        color = translucent(a.color) if a.ghost else a.color
        solids = arrow(a.tail, a.tip, color, thickness, 2.6 * thickness, 4.8 * thickness)
        label = Label(name, (a.tail + a.tip) / 2, _readable(a.color), near="thing")
        drawing.nodes.append(Node(path("arrows", name), where[a.frame], solids, labels=[label]))


def in_frame(nodes, root_T_frame):
    """Return the nodes with their transforms described in another frame."""
    frame_T_root = tft.inverse_matrix(root_T_frame)
    return [replace(node, transform=frame_T_root @ node.transform) for node in nodes]


def grid(seen):
    """Return the lines (Nx2x3) of a grid at z = 0 below the points `seen`, and its step, a round number of metres."""
    low, high = seen.min(axis=0)[:2], seen.max(axis=0)[:2]
    extent = max((high - low).max(), 0.1 * np.ptp(seen, axis=0).max(), 1e-9)
    step = round_number(extent / 6)
    low, high = np.floor(low / step), np.ceil(high / step)
    lines = [[[x, low[1], 0], [x, high[1], 0]] for x in np.arange(low[0], high[0] + 1)]
    lines += [[[low[0], y, 0], [high[0], y, 0]] for y in np.arange(low[1], high[1] + 1)]
    return np.array(lines) * step, step


def round_number(value):
    """Return the number 1, 2 or 5 times a power of ten that is nearest below `value` (above 0)."""
    power = 10.0 ** math.floor(math.log10(value) + 1e-9)
    return next(m * power for m in (5, 2, 1) if m * power <= value * (1 + 1e-9))


def _corners(nodes):
    """Return arrays of points (Nx3) of the root frame that enclose all that hangs on `nodes`."""
    corners = []
    for node in nodes:
        corners += [moved(node.transform @ solid.matrix, CORNERS) for solid in node.solids]
        corners += [moved(node.transform, cloud.points) for cloud in node.clouds]
        corners += [moved(node.transform, mesh.corners.reshape(-1, 3)) for mesh in node.meshes]
        corners += [moved(node.transform, label.position)[None] for label in node.labels]
    return corners


def _readable(color):
    """Return a colour dark enough to be read on white."""
    brightness = 0.3 * color[0] + 0.59 * color[1] + 0.11 * color[2]
    return (*(value * min(1, 0.45 / max(brightness, 0.45)) for value in color[:3]), 1)
