"""The ROS 1 messages of the lab: geometry_msgs, std_msgs and visualization_msgs, without ROS.

Field names, default values and constructor forms are those of ROS 1, so code written here runs on a robot when
only its import lines change::

    Pose()                                              # every field at its default
    Pose(Point(1, 2, 3), Quaternion(0, 0, 0, 1))        # every field by position, none left out
    Pose(position=Point(1, 2, 3))                       # some fields by name

As on a robot, a fresh ``Quaternion()`` is 0, 0, 0, 0 (which is no orientation: no turn is 0, 0, 0, 1), a field that
does not exist cannot be set (AttributeError), and what is assigned to a field is not checked. A `stamp` is a Time, a
`lifetime` a Duration (rostime.py); a plain number of seconds is taken in their place, which on a robot cannot be sent.

Source: the message definitions of ROS Noetic, and ``genpy/message.py``.
"""

import dataclasses
from dataclasses import MISSING, dataclass, field
from functools import cache

from .rostime import Duration, Time

__all__ = ["Point", "Vector3", "Quaternion", "Pose", "Header", "PoseStamped", "ColorRGBA", "Marker"]

fields = cache(dataclasses.fields)  # asked for with every new message


class Message:
    """What the messages have in common: the constructor and the text form of ROS 1."""

    __slots__ = ()

    def __init__(self, *args, **kwargs):
        """Make a message from no arguments, from every field by position, or from some fields by name.

        A field that is left out, or given as None, gets its default. Raises TypeError for a wrong number of positional
        arguments or for a mixture of both forms, AttributeError for a name that is not a field (all as in ROS 1).
        """
        kind = type(self).__name__
        names = [f.name for f in fields(type(self))]
        if args and kwargs:
            raise TypeError(f"{kind} takes its fields by position or by name, not both")
        if args and len(args) != len(names):
            raise TypeError(
                f"Invalid number of arguments, args should be {names} args are {args}: {kind} takes no positional"
                f" argument or all {len(names)}; to set some fields only, name them, as in {kind}({names[0]}=...)"
            )
        for name in kwargs:
            if name not in names:
                raise AttributeError(f"{name} is not an attribute of {kind}, whose fields are {', '.join(names)}")
        given = dict(zip(names, args)) if args else kwargs
        for f in fields(type(self)):
            value = given.get(f.name)
            if value is None:
                value = f.default if f.default_factory is MISSING else f.default_factory()
            setattr(self, f.name, value)

    def __str__(self):
        """The text that ``rostopic echo`` and ``print`` show in ROS 1."""
        return _text(self, "")


def _text(value, indent):
    """Return a value as ROS prints it; what takes lines of its own starts a new line, and each begins with `indent`.

    Lists of texts, which none of these messages has, ROS prints with fewer quotes.
    """
    if isinstance(value, str):
        return _quoted(value) if value else "''"
    if type(value) in (list, tuple):
        if not value or type(value[0]) in (bool, int, float):
            return str(list(value))
        return "".join(f"\n{indent}- {_text(item, indent + '  ')}" for item in value)
    if hasattr(value, "nsecs"):  # a Time or a Duration
        return f"\n{indent}secs: {value.secs}\n{indent}nsecs: {value.nsecs:9d}"
    if isinstance(value, Message) or hasattr(value, "_slot_types"):  # which ROS 1's messages have
        lines = (f"{indent}{name}: {_text(getattr(value, name), indent + '  ')}" for name in value.__slots__)
        return ("\n" if indent else "") + "\n".join(lines)
    return str(value)


ESCAPES = dict(zip('\0\a\b\t\n\v\f\r\x1b"\\\x85\xa0\u2028\u2029', '0abtnvfre"\\N_LP'))
WIDTH = 80  # letters after which YAML goes on in the next line


def _quoted(text):
    """Return a text in double quotes, escaped and folded as YAML is written in ROS (by PyYAML)."""
    written, column, escaped = '"', 1, False
    for i, letter in enumerate(text):
        plain = " " <= letter <= "~" and letter not in ESCAPES
        at_word = plain and 0 < i < len(text) - 1 and (letter == " " or escaped)
        if at_word and column > WIDTH or escaped and i > 1 and column > WIDTH + 1:
            written, column = written + "\\\n  ", 2
            if letter == " ":
                written, column = written + "\\", 3
        piece = letter if plain else "\\" + (ESCAPES.get(letter) or _code(ord(letter)))
        written, column, escaped = written + piece, column + len(piece), not plain
    return written + '"'


def _code(number):
    """Return a letter's number as YAML writes it: in two, four or eight digits."""
    return f"x{number:02X}" if number < 1 << 8 else f"u{number:04X}" if number < 1 << 16 else f"U{number:08X}"


@dataclass(init=False, slots=True)
class Point(Message):
    """geometry_msgs/Point: a position, in metres."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass(init=False, slots=True)
class Vector3(Message):
    """geometry_msgs/Vector3: a direction or a size."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


@dataclass(init=False, slots=True)
class Quaternion(Message):
    """geometry_msgs/Quaternion: an orientation, in the order x, y, z, w. A fresh one is 0, 0, 0, 0."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 0.0


@dataclass(init=False, slots=True)
class Pose(Message):
    """geometry_msgs/Pose: a position and an orientation."""

    position: Point = field(default_factory=Point)
    orientation: Quaternion = field(default_factory=Quaternion)


@dataclass(init=False, slots=True)
class Header(Message):
    """std_msgs/Header: when, and in which frame, the data is given."""

    seq: int = 0
    stamp: Time = field(default_factory=Time)
    frame_id: str = ""


@dataclass(init=False, slots=True)
class PoseStamped(Message):
    """geometry_msgs/PoseStamped: a pose and, in its header, the frame it is given in."""

    header: Header = field(default_factory=Header)
    pose: Pose = field(default_factory=Pose)


@dataclass(init=False, slots=True)
class ColorRGBA(Message):
    """std_msgs/ColorRGBA: red, green, blue and opacity, each from 0 to 1."""

    r: float = 0.0
    g: float = 0.0
    b: float = 0.0
    a: float = 0.0


@dataclass(init=False, slots=True)
class Marker(Message):
    """visualization_msgs/Marker: a shape to draw. A `lifetime` of 0 is for ever."""

    ARROW = 0
    CUBE = 1
    SPHERE = 2
    CYLINDER = 3
    LINE_STRIP = 4
    LINE_LIST = 5
    CUBE_LIST = 6
    SPHERE_LIST = 7
    POINTS = 8
    TEXT_VIEW_FACING = 9
    MESH_RESOURCE = 10
    TRIANGLE_LIST = 11

    ADD = 0
    MODIFY = 0
    DELETE = 2
    DELETEALL = 3

    header: Header = field(default_factory=Header)
    ns: str = ""
    id: int = 0
    type: int = 0
    action: int = 0
    pose: Pose = field(default_factory=Pose)
    scale: Vector3 = field(default_factory=Vector3)
    color: ColorRGBA = field(default_factory=ColorRGBA)
    lifetime: Duration = field(default_factory=Duration)
    frame_locked: bool = False
    points: list = field(default_factory=list)
    colors: list = field(default_factory=list)
    text: str = ""
    mesh_resource: str = ""
    mesh_use_embedded_materials: bool = False
