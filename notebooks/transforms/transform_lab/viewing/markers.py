"""Markers as RViz draws them, and what it says of those that are odd. tests/ros/test_rviz.py compares it with RViz itself.

RViz refuses nothing: a marker that is in error is not drawn, and the display's status says why. So it is here.
"""

from numbers import Integral

import numpy as np

from .. import tft
from ..messages import Marker
from ..validation import FARTHEST
from .shapes import Cloud, Label, Mesh, Solid, arrow, placed, rod

ERROR, WARNING, INFO = "error", "warning", "info"  # what is in error is not drawn
MOST = 2000  # points of what is drawn as solids; more would take a browser seconds
SOLIDS = {Marker.CUBE: "box", Marker.SPHERE: "sphere", Marker.CYLINDER: "cylinder"}
SOLID_LISTS = {Marker.CUBE_LIST: "box", Marker.SPHERE_LIST: "sphere"}
LINES = (Marker.LINE_STRIP, Marker.LINE_LIST)
OF_POINTS = (*LINES, *SOLID_LISTS, Marker.POINTS, Marker.TRIANGLE_LIST)  # these take points, and colors
TYPE_NAMES = (
    "ARROW CUBE SPHERE CYLINDER LINE_STRIP LINE_LIST CUBE_LIST SPHERE_LIST POINTS TEXT_VIEW_FACING"
    " MESH_RESOURCE TRIANGLE_LIST"
).split()
UNINITIALIZED = "Uninitialized quaternion, assuming identity."
UNNORMALIZED = "Unnormalized quaternion in marker message."
BEYOND = "Colors go from 0 to 1 (not to 255); what is beyond is drawn as 0 or 1."
NARROW = "A negative width (scale.x) is not drawn."
LOW = "A negative text height (scale.z) is not drawn."
FAR = "It is too far away to be drawn"
OURS = (BEYOND, NARROW, LOW, FAR)  # how what RViz does not say begins
OPAQUE = 0.9998  # from here on RViz does not blend
CAPITAL = 0.61  # of scale.z: the height of a capital letter in RViz's font
PIECES = 12  # that a line between two colours is drawn in
FLAT = 1e-5  # of a thing's size: how thick it is drawn when it has no thickness


def marker_name(marker):
    """Return how a marker is called in messages: its namespace and its id."""
    return f"{marker.ns}/{marker.id}"


def marker_type(marker):
    """Return the name of a marker's type, such as "LINE_LIST", or its number if there is none."""
    return dict(enumerate(TYPE_NAMES)).get(marker.type, str(marker.type))


def marker_pose(marker):
    """Return the 4x4 matrix of a marker's pose: as in RViz, an orientation of zeros is no rotation, any other is made
    one of length 1.
    """
    q = _xyzw(marker)
    if q.any():
        q = q / np.abs(q).max()  # first, for its square may be too large a number
        turn = tft.quaternion_matrix(q / np.linalg.norm(q))
    else:
        turn = np.eye(4)
    return tft.translation_matrix(_xyz(marker.pose.position)) @ turn


# What is no marker


def check_fields(marker):
    """Raise TypeError for what ROS could not send: no Marker, or one of whose fields holds something of another kind.

    Raises ValueError for a mesh, and for more points than can be drawn here.
    """
    wanted = {"header": (["frame_id"], "a Header"), "pose": (["position", "orientation"], "a Pose"),
              "scale": ("xyz", "a Vector3"), "color": ("rgba", "a ColorRGBA")}  # fmt: skip
    if not all(hasattr(marker, name) for name in (*wanted, "ns", "id", "type", "action", "points", "colors", "text")):
        raise TypeError(f"publish takes one Marker; got {type(marker).__name__}")
    what = f"marker {marker_name(marker)}:"
    for field, (names, kind) in wanted.items():
        _need(getattr(marker, field), names, f"{what} {field}", kind)
    _need_numbers(
        marker.pose.position, "xyz", f"{what} the pose's position", "a Point, such as Point(x=1.0, y=2.0, z=3.0)"
    )
    _need_numbers(marker.pose.orientation, "xyzw", f"{what} the pose's orientation", "a Quaternion")
    _need_numbers(marker.scale, "xyz", f"{what} scale", "a Vector3")
    _need_numbers(marker.color, "rgba", f"{what} color", "a ColorRGBA")
    for field, names, kind in (("points", "xyz", "Point"), ("colors", "rgba", "ColorRGBA")):
        values = getattr(marker, field)
        if not isinstance(values, (list, tuple)):
            raise TypeError(f"{what} {field} must be a list of {kind}s; got {type(values).__name__}")
        for i, value in enumerate(values):
            _need_numbers(value, names, f"{what} {field}[{i}]", f"a {kind}")
    if not isinstance(marker.header.frame_id, str):
        raise TypeError(f"{what} header.frame_id must be a text; got {type(marker.header.frame_id).__name__}")
    if not isinstance(marker.text, str) or not all(
        isinstance(n, Integral) for n in (marker.id, marker.type, marker.action)
    ):
        raise TypeError(f"{what} text must be a text, and id, type and action whole numbers")
    if marker.type == Marker.MESH_RESOURCE:
        drawn = ", ".join(name for name in TYPE_NAMES if name != "MESH_RESOURCE")
        raise ValueError(f"{what} a MESH_RESOURCE, a file in a ROS package, is not drawn here; these are: {drawn}")
    if len(marker.points) > MOST and marker.type != Marker.POINTS:
        raise ValueError(f"{what} at most {MOST} points are drawn; got {len(marker.points)}. POINTS take any number")


def _need(value, names, what, kind):
    if not all(hasattr(value, name) for name in names):
        raise TypeError(f"{what} must be {kind}; got {type(value).__name__}")


def _need_numbers(value, names, what, kind):
    """Raise TypeError unless `value` has fields of these names, each a real number (NaN and infinity are such)."""
    if hasattr(value, "w") and "w" not in names:
        raise TypeError(f"{what} must be {kind}; got {type(value).__name__}")
    _need(value, names, what, kind)
    for name in names:
        field = getattr(value, name)
        try:
            if isinstance(field, str) or np.ndim(field):
                raise TypeError
            float(field)
        except (TypeError, ValueError, OverflowError):
            raise TypeError(f"{what}.{name} must be a number; got {type(field).__name__}") from None


# What RViz says


def remarks(marker):
    """Return what there is to say of a marker that is published, as (level, text). With an ERROR nothing is drawn."""
    said = list(_of_rviz(marker))
    return said if ERROR in dict(said) else [*said, *_of_ours(marker)]


def _of_rviz(marker):
    """Yield what RViz says of a marker, in its words, as (level, text): checkMarkerMsg of RViz 1.14."""
    kind, scale, points, q = marker.type, _xyz(marker.scale), marker.points, _xyzw(marker)
    yield from _finite("Position", _xyz(marker.pose.position))
    if kind not in range(len(TYPE_NAMES)):
        yield ERROR, f"Unknown marker type: {kind}."
        return
    if kind not in (Marker.POINTS, Marker.TEXT_VIEW_FACING):
        yield from _finite("Orientation", q)
        if not q.any():
            yield INFO, UNINITIALIZED
        elif not abs(sum(value * value for value in q.tolist()) - 1) < 10e-3:
            yield WARNING, UNNORMALIZED
    if kind in LINES:
        if scale[0] == 0:
            yield WARNING, "Width LINE_LIST or LINE_STRIP is 0.0 (scale.x)."
    elif kind == Marker.POINTS:
        if not scale[:2].all():
            yield WARNING, "Width and/or height of POINTS is 0.0 (scale.x, scale.y)."
    elif kind == Marker.TEXT_VIEW_FACING:
        if scale[2] == 0:
            yield WARNING, "Text height of TEXT_VIEW_FACING is 0.0 (scale.z)."
    else:
        yield from _finite("Scale", scale)
        if not scale[: 2 if kind == Marker.ARROW and scale[:2].all() else 3].all():
            yield WARNING, "Scale contains 0.0 in x, y or z."
    yield from _of_points(marker) if kind in OF_POINTS else _without_points(marker)
    if not (kind in OF_POINTS and marker.colors):
        yield from _finite("Color", _rgba(marker.color))
        if marker.color.a == 0:
            yield INFO, "Marker is fully transparent (color.a is 0.0)."
    if kind == Marker.ARROW and len(points) == 2:
        for point in points:
            yield from _finite("Position", _xyz(point))
    if kind == Marker.TEXT_VIEW_FACING:
        if not marker.text.strip(" \t\n\v\f\r"):
            yield ERROR, "Text is empty or only consists of whitespace."
    elif marker.text:
        yield INFO, "Non-empty text is ignored."
    if getattr(marker, "mesh_resource", ""):
        yield INFO, "Non-empty mesh_resource is ignored."
    if getattr(marker, "mesh_use_embedded_materials", False):
        yield INFO, "mesh_use_embedded_materials is ignored."


def _of_points(marker):
    """What RViz says of the points and colors of a marker that is made of them."""
    kind, count, colors = marker.type, len(marker.points), len(marker.colors)
    if not count:
        yield ERROR, "Points should not be empty for specified marker type."
    if kind == Marker.TRIANGLE_LIST and count % 3:
        yield ERROR, "Number of points should be a multiple of 3 for TRIANGLE_LIST marker."
    if kind == Marker.LINE_LIST and count % 2:
        yield ERROR, "Number of points should be a multiple of 2 for LINE_LIST marker."
    if kind == Marker.LINE_STRIP and count <= 1:
        yield ERROR, "At least two points are required for a LINE_STRIP marker."
    if colors not in (0, count) and not (kind == Marker.TRIANGLE_LIST and 3 * colors == count):
        yield ERROR, "Number of colors doesn't match number of points."


def _without_points(marker):
    """What RViz says of the points and colors of another marker."""
    if marker.type == Marker.ARROW:
        if len(marker.points) not in (0, 2):
            yield ERROR, "Number of points for an ARROW marker should be either 0 or 2."
    elif marker.points:
        yield WARNING, "Non-empty points array is ignored."
    if marker.colors:
        yield WARNING, "Non-empty colors array is ignored."


def _finite(field, values):
    if not np.isfinite(values).all():
        yield ERROR, f"{field} contains invalid floating point values (nans or infs)"


def _of_ours(marker):
    """Yield what RViz leaves unsaid, as (level, text): what it draws otherwise than it was meant, or not at all."""
    points, colors, scale = _points(marker), _colors(marker), _xyz(marker.scale)
    yield from _finite("Orientation", _xyzw(marker))
    yield from _finite("Scale", scale)
    with np.errstate(over="ignore", invalid="ignore"):
        lengths = np.vstack([_xyz(marker.pose.position), points, scale, points * scale])
    farthest = np.nanmax(np.abs(lengths))
    if farthest > FARTHEST:
        yield ERROR, f"{FAR}: {farthest:.4g} m. Are these metres?"
    for i in np.flatnonzero(~np.isfinite(points).all(axis=1))[:1]:
        yield WARNING, f"invalid point[{i}] ({', '.join(f'{v:.2f}' for v in points[i])})"
    for i in np.flatnonzero(~np.isfinite(colors).all(axis=1))[:1]:
        yield WARNING, f"invalid color[{i}] ({', '.join(f'{v:.2f}' for v in colors[i])})"
    if (np.abs(np.vstack([colors, _rgba(marker.color)]) - 0.5) > 0.5).any():
        yield WARNING, BEYOND
    if marker.type in LINES and marker.scale.x < 0:
        yield ERROR, NARROW
    if marker.type == Marker.TEXT_VIEW_FACING and marker.scale.z < 0:
        yield ERROR, LOW


# What RViz draws


def draw_marker(marker, node):
    """Hang on `node` what `marker`, one without an ERROR, shows, in the coordinates of its pose. Sizes mean what they
    mean in RViz: a size of 0 is flat, a negative one mirrored, of colours beyond 0 to 1 the nearest is drawn.
    """
    size, kind, color = _xyz(marker.scale), marker.type, _drawn(_rgba(marker.color))
    points, colors = _points(marker), _colors(marker)
    if not len(colors) or kind not in OF_POINTS:
        if color[3] == 0:
            return
        colors = np.tile(color, (len(points), 1))
    elif kind in (*LINES, Marker.TRIANGLE_LIST):
        colors = _blended(colors, color[3], kind in LINES, len(points))
    if kind == Marker.LINE_STRIP:  # goes on at the next valid point
        valid = np.isfinite(points).all(axis=1) & np.isfinite(colors).all(axis=1)
        points, colors = points[valid], colors[valid]
    colors = _drawn(colors)
    if kind == Marker.ARROW:
        node.solids += _arrow(points, size, tuple(color.tolist()))
    elif kind in SOLIDS:
        node.solids += _solid(SOLIDS[kind], (0, 0, 0), size, tuple(color.tolist()))
    elif kind in SOLID_LISTS:
        for point, each in zip(points, colors):
            node.solids += _solid(SOLID_LISTS[kind], point, size, tuple(each.tolist()))
    elif kind in LINES and size[0] > 0:
        node.solids += _lines(points, colors, size[0], kind == Marker.LINE_STRIP)
    elif kind == Marker.POINTS and (np.abs(size[:2]) > 0).all():
        for some in _of_one_opacity(np.where(np.isfinite(points).all(axis=1)[:, None], colors, 0)):
            node.clouds.append(Cloud(points[some], colors[some], abs(size[0])))
    elif kind == Marker.TEXT_VIEW_FACING and size[2] > 0:
        node.labels.append(Label(marker.text, np.zeros(3), tuple(color.tolist()), height=CAPITAL * size[2]))
    elif kind == Marker.TRIANGLE_LIST:
        corners, colors = (points * size).reshape(-1, 3, 3), colors.reshape(-1, 3, 4)
        for some in _of_one_opacity(np.where(np.isfinite(corners).all(axis=(1, 2))[:, None, None], colors, 0)):
            node.meshes.append(Mesh(corners[some], colors[some]))


def _blended(colors, opacity, lines, count):
    """Return the colours of `count` points of lines or triangles, with the opacities they have in RViz.

    `opacity` is that of the marker's own colour. It decides whether anything is translucent; for triangles with a colour
    at each corner these decide.
    """
    at_corners = len(colors) == count
    colors = colors if at_corners else colors.repeat(3, axis=0)
    blends = (colors[:, 3] < OPAQUE).any() if at_corners and not lines else opacity < OPAQUE
    opacities = colors[:, 3] * (1 if lines else opacity) if blends else np.ones(count)
    return np.column_stack([colors[:, :3], opacities])


def _arrow(points, size, color):
    """Return the solids of an ARROW: from point to point, or of `size` along x. Its head is twice as wide then."""
    if not len(points):
        length, width, height = _thick(size)
        matrix = np.diag([length, np.copysign(width, length), abs(height), 1])
        return (
            [Solid(s.kind, matrix @ s.matrix, color) for s in arrow((0, 0, 0), (1, 0, 0), color, 1, 2, 0.23)]
            if size.any()
            else []
        )
    tail, tip = points
    length, (shaft, head) = np.linalg.norm(tip - tail), np.abs(size[:2])
    if length == 0:
        return _solid("cylinder", tail, np.array([max(shaft, head)] * 2 + [0]), color)
    long = np.clip(size[2], FLAT * length, length) if size[2] else 0.23 * length
    solids = arrow(tail, tip, color, max(shaft, FLAT * head), max(head, FLAT * shaft), long)
    return [solid for solid in solids if (shaft if solid.kind == "cylinder" else head) > 0]


def _solid(kind, position, size, color):
    """Return a solid, or none where there is nothing to be seen of it."""
    if not size.any() or not color[3] or not np.isfinite(position).all():
        return []
    return [placed(kind, position, np.abs(_thick(size)), color)]


def _thick(size):
    """Return `size` with a little instead of 0, as what has no thickness is seen all the same."""
    return np.where(size == 0, FLAT * np.abs(size).max(), size)


def _lines(points, colors, width, strip):
    """Return the solids of lines from point to point, or from each second point to the next; colours change evenly."""
    solids = []
    for i in range(0, len(points) - 1, 1 if strip else 2):
        pieces = 1 if np.array_equal(colors[i], colors[i + 1]) else PIECES
        ends = np.linspace(points[i], points[i + 1], pieces + 1)
        shades = np.linspace(colors[i], colors[i + 1], 2 * pieces + 1)[1::2]
        if np.isfinite(ends).all():
            for start, end, shade in zip(ends, ends[1:], shades):
                solids += rod(start, end, width, tuple(shade.tolist())) if shade[3] else []
    return solids


def _of_one_opacity(colors):
    """Yield, for each opacity above 0 in `colors` (Nx4 or Nx3x4), which of the N have it."""
    opacities = colors[..., 3].reshape(len(colors), -1).mean(axis=1)
    for opacity in np.unique(opacities[opacities > 0]):
        yield opacities == opacity


def _drawn(colors):
    """Return colours as they can be drawn: from 0 to 1, and without any opacity where there is NaN or infinity."""
    return np.where(np.isfinite(colors).all(axis=-1, keepdims=True), np.clip(colors, 0, 1), 0)


def _xyz(value):
    return np.array([value.x, value.y, value.z], float)


def _xyzw(marker):
    q = marker.pose.orientation
    return np.array([q.x, q.y, q.z, q.w], float)


def _rgba(value):
    return np.array([value.r, value.g, value.b, value.a], float)


def _points(marker):
    return np.array([(p.x, p.y, p.z) for p in marker.points], float).reshape(-1, 3)


def _colors(marker):
    return np.array([(c.r, c.g, c.b, c.a) for c in marker.colors], float).reshape(-1, 4)
