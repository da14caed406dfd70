"""What there is to see: a tree of named frames, and the points, arrows, boxes, grippers and markers given in them."""

import copy
from dataclasses import dataclass, replace

import numpy as np

from .. import libraries, tft
from ..messages import Marker
from ..validation import FARTHEST, NEAREST, numbers, rigid_transform, row_text, within_reach
from .markers import ERROR, UNINITIALIZED, check_fields, marker_name, marker_pose, marker_type, remarks
from .shapes import BROWN, ORANGE, PURPLE, STEEL, X_RED, Y_GREEN, Z_BLUE, rgba, xyz


@dataclass(frozen=True, eq=False)
class Frame:
    """A frame: `transform` is parent_T_frame (4x4); `length` of the axes in metres, None for one that fits the scene."""

    parent: str | None
    transform: np.ndarray
    length: float | None = None
    ghost: bool = False


@dataclass(frozen=True, eq=False)
class Point:
    """A point at `position` (3 numbers) in `frame`."""

    frame: str
    position: np.ndarray
    color: tuple
    ghost: bool = False


@dataclass(frozen=True, eq=False)
class Arrow:
    """An arrow from `tail` to `tip` (3 numbers each) in `frame`."""

    frame: str
    tail: np.ndarray
    tip: np.ndarray
    color: tuple
    ghost: bool = False


@dataclass(frozen=True, eq=False)
class Box:
    """A box whose middle is at `transform` (frame_T_box, 4x4), of `size` (3 numbers) along its own axes."""

    frame: str
    transform: np.ndarray
    size: np.ndarray
    color: tuple
    ghost: bool = False


@dataclass(frozen=True, eq=False)
class Gripper:
    """A parallel-jaw gripper: fingers along the x axis of `frame`, `opening` metres apart along y."""

    frame: str
    opening: float
    color: tuple
    ghost: bool = False


@dataclass(frozen=True, eq=False)
class Hand:
    """A right hand whose index finger, middle finger and thumb lie along the x, y and z axes of `frame`, `length` metres long."""

    frame: str
    length: float


@dataclass(frozen=True, eq=False)
class Published:
    """A marker, and `place`, the 4x4 root_T_frame of its frame when it was published; None while that is not known, and
    for one that is locked to its frame.
    """

    marker: Marker
    place: np.ndarray | None = None


class Scene:
    """Frames in a tree, as TF keeps them, and what is given in these frames; all lengths are in metres."""

    def __init__(self, fixed_frame="world", ghost=False, length=None):
        self.root = _name(fixed_frame, "fixed_frame")
        length = None if length is None else _size(length, "the length of the fixed frame's axes")
        self.frames = {fixed_frame: Frame(None, np.eye(4), length, ghost)}
        self.points, self.arrows, self.boxes, self.grippers, self.hands, self.markers = {}, {}, {}, {}, {}, {}
        self.remarks = {}  # what RViz says of markers, drawn or not, by their ns and id
        self._text, self._fixed_frame = "", fixed_frame

    def copy(self):
        """Return a Scene of the same things; what is added to the one does not show in the other."""
        other = Scene(self.root)
        for name, value in vars(other).items():
            setattr(other, name, copy.copy(getattr(self, name)) if isinstance(value, dict) else getattr(self, name))
        return other

    def state(self):
        """Return the scene that is shown: this one."""
        return self

    @property
    def fixed_frame(self):
        """The frame in which the scene is drawn and looked at; any known frame can be made the fixed one.

        Where an animation or controls have taken it away, it is the root.
        """
        return self._fixed_frame if self._fixed_frame in self.state().frames else self.root

    @fixed_frame.setter
    def fixed_frame(self, name):
        self._fixed_frame = self.state()._known(name, "fixed_frame: the frame")
        self._changed()

    @property
    def text(self):
        """What is shown in the upper left corner, at most 40 lines."""
        return self._text

    @text.setter
    def text(self, text):
        self._text = "\n".join(line[:120] for line in str(text).expandtabs().splitlines()[:40])
        self._changed()

    # Filling the scene

    def add_frame(self, name, transform, parent=None, length=None, ghost=False):
        """Add the frame `name`, or replace it: `transform` describes it in the frame `parent`.

        `transform` is a 4x4 homogeneous transform parent_T_name (an array, or an object that is one, such as SciPy's
        RigidTransform), a Pose, or a PoseStamped, whose header.frame_id then is the parent. The parent must be known; by default
        it is the root, the frame that the viewer was made with. `length` is how long the axes are drawn, in metres; by default
        the size of the scene decides. A `ghost` is translucent.

        Raises ValueError for a parent that is not known, and for what is no rigid transform, naming the property that
        fails: shape, NaN, bottom row, columns at right angles and of length 1, determinant +1, quaternion of length 1.
        """
        what = _call("add_frame", name)
        if name == self.root:
            raise ValueError(f"{what}: {name!r} is the frame this viewer was made with; the others are described in it")
        parent, matrix = self._placed(parent, transform, what, "parent")
        ancestor = parent
        while ancestor is not None:
            if ancestor == name:
                raise ValueError(f"{what}: {parent!r} is itself described in {name!r}; that is a circle")
            ancestor = self.frames[ancestor].parent
        length = None if length is None else _size(length, f"{what}: length")
        self.frames[name] = Frame(parent, matrix, length, bool(ghost))
        self._place_markers()
        self._changed()

    def add_matrix(self, name, matrix, length=None, ghost=False):
        """Add the frame of a 3x3 or 4x4 matrix; of one that is no rotation, its three columns as arrows.

        Raises ValueError for another matrix, and for a 4x4 one whose bottom row is not 0, 0, 0, 1.
        """
        if matrix.shape == (3, 3):
            matrix = np.block([[matrix, np.zeros((3, 1))], [np.zeros((1, 3)), 1]])
        try:
            self.add_frame(name, matrix, length=length, ghost=ghost)
        except ValueError:
            if matrix.shape != (4, 4) or not np.array_equal(matrix[3], [0, 0, 0, 1]):
                raise
            for letter, column, color in zip("xyz", matrix[:3, :3].T, (X_RED, Y_GREEN, Z_BLUE)):
                tip, tail = matrix[:3, 3] + (length or 1) * column, matrix[:3, 3]
                self.add_arrow(f"{letter} of {name}", tip, tail=tail, color=color)

    def add_point(self, name, position, frame=None, color=ORANGE, ghost=False):
        """Add the point `name`, or replace it: `position` is a Point or 3 numbers in `frame`.

        By default the frame is the root. Four numbers are taken as homogeneous coordinates. `color` is a ColorRGBA, or
        3 or 4 numbers from 0 to 1. A `ghost` is translucent, and larger.
        """
        what = _call("add_point", name)
        frame = self._known(frame, f"{what}: the frame")
        position = _position(position, f"{what}: the position")
        self.points[name] = Point(frame, position, rgba(color, f"{what}: the color"), bool(ghost))
        self._changed()

    def add_arrow(self, name, tip, tail=(0, 0, 0), frame=None, color=PURPLE, ghost=False):
        """Add the arrow `name`, or replace it: from `tail` to `tip`, each a Point or 3 numbers in `frame`.

        By default it starts at the origin of the frame; `frame`, `color` and `ghost` as in `add_point`.
        """
        what = _call("add_arrow", name)
        frame = self._known(frame, f"{what}: the frame")
        tail, tip = (_position(p, f"{what}: the {end}") for p, end in ((tail, "tail"), (tip, "tip")))
        self.arrows[name] = Arrow(frame, tail, tip, rgba(color, f"{what}: the color"), bool(ghost))
        self._changed()

    def add_box(self, name, size, pose=None, frame=None, color=BROWN, ghost=False):
        """Add the box `name`, or replace it: `size` is 3 numbers, in metres along its own x, y and z axes.

        Its middle is at `pose` in `frame`: a Pose, a PoseStamped or a 4x4 transform, by default the frame's origin.
        `frame`, `color` and `ghost` as in `add_point`.
        """
        what = _call("add_box", name)
        frame, matrix = self._placed(frame, np.eye(4) if pose is None else pose, what, "frame")
        size = within_reach(numbers(size, f"{what}: the size", lengths=(3,)), f"{what}: the size")
        if not (size >= NEAREST).all():
            raise ValueError(f"{what}: the size must be three numbers of at least {NEAREST:g} m; got {row_text(size)}")
        self.boxes[name] = Box(frame, matrix, size, rgba(color, f"{what}: the color"), bool(ghost))
        self._changed()

    def add_gripper(self, frame, opening=0.08, color=STEEL, ghost=False):
        """Draw a parallel-jaw gripper on `frame`, which must be known: its fingers lie along the frame's x axis.

        The fingers are `opening` metres apart along y; the origin lies between their tips. The gripper's other sizes
        go with the opening. `color` and `ghost` as in `add_point`.
        """
        frame = self._known(frame, f"add_gripper({frame!r}): the frame")
        opening = _size(opening, f"add_gripper({frame!r}): opening")
        self.grippers[frame] = Gripper(frame, opening, rgba(color, f"add_gripper({frame!r}): the color"), bool(ghost))
        self._changed()

    def add_hand(self, frame=None, length=0.1):
        """Draw a right hand on `frame`, by default the root: index finger along x, middle finger along y, thumb along z.

        `length` is that of these fingers, in metres.
        """
        frame = self._known(frame, f"add_hand({frame!r}): the frame")
        self.hands[frame] = Hand(frame, _size(length, f"add_hand({frame!r}): length"))
        self._changed()

    def publish(self, marker):
        """Draw a visualization_msgs/Marker, as publishing it to RViz does; the same ns and id replace each other.

        `marker.action` may also delete the marker with this ns and id (DELETE) or all markers (DELETEALL). The marker
        is copied, and stays where its frame is now; with `frame_locked` it goes where the frame goes. In a frame that is
        not known it waits for that frame. `lifetime` has no effect: nothing here goes away by itself.

        As in RViz, a marker in error is not drawn (an odd number of points in a LINE_LIST, NaN, an unknown type), others
        are drawn as they are (sizes of 0, negative ones, an orientation that is too long). RViz's words on it are shown
        in the corner of the scene, as RViz has them in the status of its display, and are part of the description.

        Raises TypeError for what ROS could not send, such as a list in the place of a Point, and ValueError for what
        RViz draws and this does not: a MESH_RESOURCE, more than 2000 points (but in POINTS).
        """
        check_fields(marker)
        key = (marker.ns, marker.id)
        if marker.action == Marker.DELETEALL:
            self.markers.clear()
            self.remarks.clear()
        elif marker.action == Marker.DELETE:
            self.markers.pop(key, None)
            self.remarks.pop(key, None)
        elif marker.action == Marker.ADD:
            self.remarks[key] = remarks(marker)
            self.markers.pop(key, None)
            if ERROR not in dict(self.remarks[key]):
                self.markers[key] = Published(copy.deepcopy(marker))
                self._place_markers()
        else:
            self.remarks[key] = [(ERROR, f"Unknown marker action: {marker.action}")]
        self._changed()

    def _place_markers(self):
        """See where markers stay whose frames have become known."""
        for key, published in self.markers.items():
            frame = published.marker.header.frame_id
            if published.place is None and frame in self.frames and not published.marker.frame_locked:
                self.markers[key] = replace(published, place=self.in_root(frame))

    # Asking

    def lookup(self, target_frame, source_frame):
        """Return the 4x4 transform target_T_source: `source_frame` described in `target_frame`.

        Raises ValueError for a frame that is not known, naming those that are.
        """
        scene = self.state()
        target = scene.in_root(scene._known(target_frame, "lookup: the target frame"))
        source = scene.in_root(scene._known(source_frame, "lookup: the source frame"))
        return tft.inverse_matrix(target) @ source

    def path(self, target_frame, source_frame):
        """Return the names of the frames on the way in the tree from `target_frame` to `source_frame`, both among them.

        It leads from the target to their common ancestor, and from there to the source.
        Raises ValueError for a frame that is not known.
        """
        scene = self.state()
        ways = []
        for name, what in ((target_frame, "path: the target frame"), (source_frame, "path: the source frame")):
            way = [scene._known(name, what)]
            while way[-1] != scene.root:
                way.append(scene.frames[way[-1]].parent)
            ways.append(way)
        down, up = ways
        meeting = next(name for name in down if name in up)
        return [*down[: down.index(meeting)], *reversed(up[: up.index(meeting) + 1])]

    def in_root(self, name):
        """Return the 4x4 transform of a known frame in the root frame."""
        root_T_frame = np.eye(4)
        while name != self.root:
            root_T_frame = self.frames[name].transform @ root_T_frame
            name = self.frames[name].parent
        return root_T_frame

    def description(self):
        """Return the scene in words: each frame with its parent, position and axes, then all the rest."""
        lines = [f"Scene in the fixed frame {self.fixed_frame} (metres)"]
        for name, frame in self.frames.items():
            if frame.parent is not None:
                x, y, z = (f"({row_text(frame.transform[:3, i])})" for i in range(3))
                lines.append(
                    f"frame {name} in {frame.parent}: position ({row_text(frame.transform[:3, 3])}),"
                    f" x axis {x}, y axis {y}, z axis {z}"
                )
        for name, point in self.points.items():
            lines.append(f"point {name} in {point.frame}: ({row_text(point.position)})")
        for name, arrow in self.arrows.items():
            lines.append(f"arrow {name} in {arrow.frame}: from ({row_text(arrow.tail)}) to ({row_text(arrow.tip)})")
        for name, box in self.boxes.items():
            where = row_text(box.transform[:3, 3])
            lines.append(f"box {name} in {box.frame}: middle ({where}), {' x '.join(f'{v:.4g}' for v in box.size)} m")
        for gripper in self.grippers.values():
            lines.append(f"gripper on {gripper.frame}: opening {gripper.opening:.4g} m")
        lines += [
            f"right hand on {hand.frame}: index finger x, middle finger y, thumb z" for hand in self.hands.values()
        ]
        lines += [_describe_marker(published.marker) for published in self.markers.values()]
        lines += self.said(everything=True)
        return "\n".join(lines + ([self.text] if self.text else []))

    def said(self, everything=False):
        """Return the lines that RViz would say of the markers.

        By default without the one on a fresh orientation, which is that of every second arrow, and taken as it is meant.
        """
        lines = []
        for (ns, number), found in self.remarks.items():
            found = [text for _, text in found if everything or text != UNINITIALIZED]
            if published := self.markers.get((ns, number)):
                found += self._frame_missing(published.marker.header.frame_id)
            lines += [f"Marker {ns}/{number}: {text}" for text in found]
        return lines

    def _frame_missing(self, name):
        """Return what RViz says of a marker whose frame is not known, and which are, as a list of one text; or []."""
        if name in self.frames:
            return []
        advice = " Write it without the slash." if name.lstrip("/") in self.frames else ""
        return [f"Frame [{name}] does not exist.{advice} Known frames: {self._known_names()}"]

    # For the above

    def _changed(self):
        """Called after each change; a Viewer passes it on to those who watch."""

    def _known(self, name, what):
        """Return `name` (the root for None) if it is a frame of the scene; else raise ValueError with `what`."""
        if name is None:
            return self.root
        if name == "":
            raise ValueError(f"{what} is empty. Known frames: {', '.join(self.frames)}")
        if _name(name, what) in self.frames:
            return name
        advice = " Write it without the slash." if name.lstrip("/") in self.frames else ""
        raise ValueError(f"{what} {name!r} is not known.{advice} Known frames: {self._known_names()}")

    def _known_names(self):
        return ", ".join([*self.frames][:30]) + (", …" if len(self.frames) > 30 else "")

    def _placed(self, frame, pose, what, kind):
        """Return the known frame in which `pose` (4x4, Pose, PoseStamped) is given, and the 4x4 matrix."""
        if hasattr(pose, "header"):
            if frame not in (None, pose.header.frame_id):
                raise ValueError(f"{kind}={frame!r}, but header.frame_id is {pose.header.frame_id!r}")
            frame, pose = pose.header.frame_id, pose.pose
        frame = self._known(frame, f"{what}: the {kind}")
        pose = libraries.taken(pose) if libraries.is_matrix(pose) else pose
        if hasattr(pose, "orientation"):
            matrix = pose_matrix(pose, f"{what}: the pose")
        else:
            matrix = rigid_transform(pose, f"{what}: the transform")
        within_reach(matrix[:3, 3], f"{what}: the translation")
        return frame, matrix


def _name(name, what):
    """Return a name, which must be a text that is not empty."""
    if not isinstance(name, str) or not name:
        got = repr(name) if name is None or isinstance(name, (str, int, float)) else type(name).__name__
        raise TypeError(f"{what} must be a text, such as 'base_link'; got {got}")
    if len(name) > 100 or not name.isprintable():
        raise ValueError(f"{what} must be at most 100 letters that can be printed; got {name[:100]!r}")
    return name


def _call(method, name):
    """Return how the call that adds the thing `name` is named in errors; raise an error for what is no name."""
    return f"{method}({_name(name, f'{method}: the name')!r})"


def _size(value, what):
    """Return a length in metres, a number that can be drawn."""
    size = numbers(value, what)
    if size.shape != () or not NEAREST <= size <= FARTHEST:
        raise ValueError(f"{what} must be a number of metres from {NEAREST:g} to {FARTHEST:g}; got {value!r}")
    return float(size)


def _position(value, what):
    """Return the three coordinates of a Point, of 3 numbers, or of 4 homogeneous ones."""
    if hasattr(value, "x"):
        return xyz(value, what)
    coordinates = numbers(value, what, lengths=(3, 4))
    if len(coordinates) == 4 and abs(coordinates[3] - 1) > 1e-9:
        raise ValueError(f"{what} has four numbers, so the last must be 1; it is {coordinates[3]:g}")
    return within_reach(coordinates[:3], what)


def pose_matrix(pose, what):
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
    position = numbers([p.x, p.y, p.z], f"{what}'s position", lengths=(3,))
    return tft.translation_matrix(position) @ tft.quaternion_matrix(quaternion)


def _describe_marker(marker):
    """Return one line about a marker."""
    pose = marker_pose(marker)
    text = f"marker {marker_name(marker)} in {marker.header.frame_id}: {marker_type(marker)} at"
    text += f" ({row_text(pose[:3, 3])}), x axis ({row_text(pose[:3, 0])}), y axis ({row_text(pose[:3, 1])})"
    if marker.type in (Marker.ARROW, Marker.LINE_LIST, Marker.LINE_STRIP) and 0 < len(marker.points) <= 6:
        text += ", points " + " ".join(f"({row_text(xyz(p, 'point'))})" for p in marker.points)
    elif marker.points:
        text += f", {len(marker.points)} points"
    if marker.text:
        text += f', text "{marker.text}"'
    return text
