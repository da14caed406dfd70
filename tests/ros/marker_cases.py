"""Markers for RViz and our viewer to draw: of each type, and odd ones. Red, green and blue are easily told apart."""

import math

from transform_lab.messages import ColorRGBA, Header, Marker, Point, Pose, Quaternion, Vector3

M = Marker
RED, GREEN, BLUE = ColorRGBA(1, 0, 0, 1), ColorRGBA(0, 1, 0, 1), ColorRGBA(0, 0, 1, 1)
CLEAR = ColorRGBA(0, 0, 0, 0)
NAN, INF = math.nan, math.inf
TURNED = Quaternion(0.18, -0.3, 0.54, math.sqrt(1 - 0.18**2 - 0.3**2 - 0.54**2))
HERE = Pose(Point(0.2, -0.1, 0.15), TURNED)
UPRIGHT = Quaternion(0, 0, 0, 1)
CORNERS = [(0, 0, 0), (0.9, 0, 0), (0.9, 0.7, 0), (0.2, 0.7, 0.6)]
TRIANGLES = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 0.2), (-1, 0, 0.2), (0, 0.3, 1)]
APART = [(-0.7, 0, 0), (0, 0.5, 0.3), (0.7, -0.4, 0)]


def marker(kind, scale=(1, 1, 1), points=(), pose=HERE, color=RED, frame="frame_a", **fields):
    """A marker; `scale` and each of the `points` are three numbers."""
    made = Marker(
        header=Header(0, 0, frame), type=kind, pose=pose, scale=Vector3(*scale), color=color,
        points=[Point(*p) for p in points], **fields,
    )  # fmt: skip
    made.ns = made.ns or "case"
    return made


def faint(color, opacity=0.5):
    return ColorRGBA(color.r, color.g, color.b, opacity)


DRAWN = {  # by name: the markers that are published one after the other
    "arrow": [marker(M.ARROW, (1.2, 0.1, 0.1))],
    "arrow of other width and height": [marker(M.ARROW, (1.2, 0.1, 0.3))],
    "arrow of no height": [marker(M.ARROW, (1.2, 0.2, 0))],
    "arrow backwards": [marker(M.ARROW, (-1, 0.1, 0.1))],
    "arrow that is thick": [marker(M.ARROW, (0.5, 0.4, 0.4))],
    "arrow between points": [marker(M.ARROW, (0.05, 0.15, 0.3), [(-0.5, 0, 0), (0.6, 0.5, 0.4)])],
    "arrow between points, head by default": [marker(M.ARROW, (0.1, 0.2, 0), [(-0.5, 0, 0), (0.6, 0.5, 0.4)])],
    "arrow between points, head too long": [marker(M.ARROW, (0.1, 0.2, 9), [(0, 0, 0), (0.6, 0.5, 0.4)])],
    "arrow between points, head negative": [marker(M.ARROW, (0.1, 0.2, -0.2), [(0, 0, 0), (0.6, 0.5, 0.4)])],
    "arrow along -x": [marker(M.ARROW, (0.1, 0.2, 0), [(0, 0, 0), (-1, 0, 0)], Pose(Point(), UPRIGHT))],
    "arrow along z": [marker(M.ARROW, (0.1, 0.2, 0), [(0, 0, 0), (0, 0, 1)], Pose(Point(), UPRIGHT))],
    "arrow without width": [marker(M.ARROW, (0, 0.2, 0.3), [(0, 0, 0), (0.6, 0.5, 0.4)])],
    "arrow without width or head": [marker(M.ARROW, (0, 0, 0), [(0, 0, 0), (0.6, 0.5, 0.4)])],
    "arrow without scale": [marker(M.ARROW, (0, 0, 0))],
    "arrow of no length": [marker(M.ARROW, (0.1, 0.2, 0), [(0.3, 0, 0), (0.3, 0, 0)])],
    "arrow of one point": [marker(M.ARROW, (0.1, 0.2, 0), [(1, 0, 0)])],
    "arrow of three points": [marker(M.ARROW, (0.1, 0.2, 0), APART)],
    "arrow with colors": [marker(M.ARROW, (1, 0.1, 0.1), colors=[GREEN, BLUE])],
    "cube": [marker(M.CUBE, (1.2, 0.5, 0.3))],
    "sphere": [marker(M.SPHERE, (1.2, 0.5, 0.3))],
    "cylinder": [marker(M.CYLINDER, (0.4, 0.7, 1.2))],
    "cylinder upright": [marker(M.CYLINDER, (0.5, 0.5, 1.2), pose=Pose(Point(), UPRIGHT))],
    "cube of no height": [marker(M.CUBE, (1.2, 0.5, 0))],
    "sphere of no height": [marker(M.SPHERE, (1.2, 0.5, 0))],
    "cylinder of no height": [marker(M.CYLINDER, (1.2, 0.5, 0))],
    "cube of no size": [marker(M.CUBE, (0, 0, 0))],
    "cube of negative size": [marker(M.CUBE, (-1.2, 0.5, 0.3))],
    "cylinder of negative sizes": [marker(M.CYLINDER, (-0.4, -0.7, -1.2))],
    "cube with points": [marker(M.CUBE, (0.5, 0.5, 0.3), APART)],
    "cube with colors and none of its own": [marker(M.CUBE, color=CLEAR, colors=[GREEN])],
    "line strip": [marker(M.LINE_STRIP, (0.1, 0, 0), CORNERS)],
    "line strip with colors": [marker(M.LINE_STRIP, (0.1, 0, 0), CORNERS, colors=[RED, RED, BLUE, BLUE])],
    "line strip of one point": [marker(M.LINE_STRIP, (0.1, 0, 0), CORNERS[:1])],
    "line strip without width": [marker(M.LINE_STRIP, (0, 0, 0), CORNERS)],
    "line strip of negative width": [marker(M.LINE_STRIP, (-0.1, 0, 0), CORNERS)],
    "line list": [marker(M.LINE_LIST, (0.1, 0, 0), CORNERS)],
    "line list with colors": [marker(M.LINE_LIST, (0.1, 0, 0), CORNERS, colors=[RED, RED, BLUE, BLUE])],
    "line list with colors that change": [marker(M.LINE_LIST, (0.1, 0, 0), CORNERS[:2], colors=[RED, BLUE])],
    "line list of three points": [marker(M.LINE_LIST, (0.1, 0, 0), CORNERS[:3])],
    "line list with colors and none of its own": [
        marker(M.LINE_LIST, (0.1, 0, 0), CORNERS, color=CLEAR, colors=[RED, RED, BLUE, BLUE])
    ],
    "cube list": [marker(M.CUBE_LIST, (0.3, 0.5, 0.2), APART)],
    "cube list with colors": [marker(M.CUBE_LIST, (0.3, 0.5, 0.2), APART, colors=[RED, GREEN, BLUE])],
    "sphere list": [marker(M.SPHERE_LIST, (0.4, 0.4, 0.4), APART)],
    "sphere list, not round": [marker(M.SPHERE_LIST, (0.6, 0.4, 0.2), APART)],
    "sphere list with colors": [marker(M.SPHERE_LIST, (0.4, 0.4, 0.4), APART, colors=[RED, GREEN, BLUE])],
    "points": [marker(M.POINTS, (0.2, 0.2, 0), APART)],
    "points of other width and height": [marker(M.POINTS, (0.4, 0.1, 0), APART)],
    "points without height": [marker(M.POINTS, (0.2, 0, 0), APART)],
    "points without width": [marker(M.POINTS, (0, 0.2, 0), APART)],
    "points of negative size": [marker(M.POINTS, (-0.2, -0.2, 0), APART)],
    "points with colors": [marker(M.POINTS, (0.2, 0.2, 0), APART, colors=[RED, GREEN, BLUE])],
    "points with one color": [marker(M.POINTS, (0.2, 0.2, 0), APART, colors=[GREEN])],
    "points, one of them clear": [
        marker(M.POINTS, (0.2, 0.2, 0), APART, colors=[RED, faint(GREEN, 0), faint(BLUE)])
    ],
    "cubes, one of them clear": [
        marker(M.CUBE_LIST, (0.2, 0.2, 0.2), APART, colors=[RED, faint(GREEN, 0), faint(BLUE)])
    ],
    "no points": [marker(M.POINTS, (0.2, 0.2, 0))],
    "no cubes": [marker(M.CUBE_LIST)],
    "no triangles": [marker(M.TRIANGLE_LIST)],
    "triangles": [marker(M.TRIANGLE_LIST, (0.8, 0.6, 1), TRIANGLES)],
    "triangles of one colour each": [marker(M.TRIANGLE_LIST, (1, 1, 1), TRIANGLES, colors=[RED, BLUE])],
    "triangles with a colour at each corner": [
        marker(M.TRIANGLE_LIST, (1, 1, 1), TRIANGLES, colors=[RED] * 3 + [BLUE] * 3)
    ],
    "triangles, clear but for their corners": [
        marker(M.TRIANGLE_LIST, (1, 1, 1), TRIANGLES, color=CLEAR, colors=[RED] * 3 + [BLUE] * 3)
    ],
    "triangles, clear but for each one's colour": [
        marker(M.TRIANGLE_LIST, (1, 1, 1), TRIANGLES, color=CLEAR, colors=[RED, BLUE])
    ],
    "triangles, one of them clear": [
        marker(M.TRIANGLE_LIST, (1, 1, 1), TRIANGLES, colors=[RED] * 3 + [faint(BLUE, 0)] * 3)
    ],
    "triangles, one of them and all clear": [
        marker(M.TRIANGLE_LIST, (1, 1, 1), TRIANGLES, color=CLEAR, colors=[RED] * 3 + [faint(BLUE, 0)] * 3)
    ],
    "triangles of four points": [marker(M.TRIANGLE_LIST, (1, 1, 1), TRIANGLES[:4])],
    "triangles with two colors too many": [marker(M.TRIANGLE_LIST, (1, 1, 1), TRIANGLES, colors=[RED] * 4)],
    "triangles of no height": [marker(M.TRIANGLE_LIST, (1, 1, 0), TRIANGLES)],
    "triangles mirrored": [marker(M.TRIANGLE_LIST, (-1, 1, 1), TRIANGLES)],
    "quaternion of zeros": [marker(M.CUBE, (1.2, 0.5, 0.3), pose=Pose(Point(0.2, 0, 0), Quaternion()))],
    "quaternion twice too long": [marker(M.CUBE, (1.2, 0.5, 0.3), pose=Pose(Point(), Quaternion(0.36, -0.6, 1.08, 1.54)))],
    "quaternion of length 1.41": [marker(M.CUBE, (1.2, 0.5, 0.3), pose=Pose(Point(), Quaternion(0, 0, 1, 1)))],
    "quaternion too short": [marker(M.CUBE, (1.2, 0.5, 0.3), pose=Pose(Point(), Quaternion(0.1, 0, 0.3, 0.2)))],
    "half opaque": [marker(M.CUBE, (1, 0.5, 0.3), color=faint(RED))],
    "clear": [marker(M.CUBE, (1, 0.5, 0.3), color=faint(RED, 0))],
    "clear line": [marker(M.LINE_LIST, (0.1, 0, 0), CORNERS, color=faint(RED, 0))],
    "line of clear colors": [marker(M.LINE_LIST, (0.1, 0, 0), CORNERS, colors=[faint(BLUE, 0)] * 4)],
    "brighter than bright": [marker(M.CUBE, (1, 0.5, 0.3), color=ColorRGBA(255, 0, 0, 255))],
    "negative colour": [marker(M.CUBE, (1, 0.5, 0.3), color=ColorRGBA(1, -1, -1, 1))],
    "far away": [marker(M.CUBE, pose=Pose(Point(1e9, 0, 0), UPRIGHT))],
    "NaN position": [marker(M.CUBE, pose=Pose(Point(NAN, 0, 0), UPRIGHT))],
    "NaN orientation": [marker(M.CUBE, pose=Pose(Point(), Quaternion(0, 0, 0, NAN)))],
    "infinite scale": [marker(M.CUBE, (INF, 1, 1))],
    "NaN colour": [marker(M.CUBE, color=ColorRGBA(NAN, 0, 0, 1))],
    "NaN point of a strip": [marker(M.LINE_STRIP, (0.1, 0, 0), [*CORNERS[:2], (NAN, 0, 0), *CORNERS[2:]])],
    "NaN colour of a strip": [
        marker(M.LINE_STRIP, (0.1, 0, 0), CORNERS, colors=[RED, ColorRGBA(NAN, 0, 0, 1), RED, RED])
    ],
    "NaN point of an arrow": [marker(M.ARROW, (0.1, 0.2, 0), [(0, 0, 0), (NAN, 0, 0)])],
    "unknown type": [marker(99)],
    "unknown action": [marker(M.CUBE, action=7)],
    "unknown frame": [marker(M.CUBE, frame="nowhere")],
    "no frame": [marker(M.CUBE, frame="")],
    "frame with a slash": [marker(M.CUBE, frame="/frame_a")],
    "another frame": [marker(M.CUBE, (0.5, 0.3, 0.2), frame="frame_b")],
    "text alone is ignored": [marker(M.CUBE, (1, 0.5, 0.3), text="cube")],
    "same id": [marker(M.CUBE, id=1), marker(M.ARROW, (1, 0.1, 0.1), id=1, color=BLUE)],
    "same id, now in error": [marker(M.CUBE, id=1), marker(M.LINE_LIST, (0.1, 0, 0), CORNERS[:3], id=1)],
    "same id in another namespace": [
        marker(M.CUBE, (0.5, 0.5, 0.5), pose=Pose(Point(-0.6, 0, 0), UPRIGHT)),
        marker(M.CUBE, (0.5, 0.5, 0.5), pose=Pose(Point(0.6, 0, 0), UPRIGHT), color=BLUE, ns="other"),
    ],
    "deleted": [
        marker(M.CUBE, (0.5, 0.5, 0.5), id=1),
        marker(M.CUBE, (0.5, 0.5, 0.5), pose=Pose(Point(0.6, 0, 0), UPRIGHT), color=BLUE, id=2),
        marker(M.CUBE, id=1, action=M.DELETE),
    ],
    "deleted in another namespace": [marker(M.CUBE, id=1), marker(M.CUBE, id=1, action=M.DELETE, ns="other")],
    "all deleted": [marker(M.CUBE, id=1), marker(M.CUBE, id=2, ns="other"), marker(M.CUBE, action=M.DELETEALL)],
    "what is nearer": [
        marker(M.CUBE, (0.6, 0.6, 0.6), pose=Pose(Point(0, -0.4, 0), UPRIGHT), id=1),
        marker(M.CUBE, (0.6, 0.6, 0.6), pose=Pose(Point(0.2, 0.6, 0.3), UPRIGHT), color=BLUE, id=2),
    ],
}  # fmt: skip

WRITTEN = {
    "text": [marker(M.TEXT_VIEW_FACING, (0, 0, 0.3), text="HOME")],
    "text of small letters": [marker(M.TEXT_VIEW_FACING, (0, 0, 0.3), text="axes")],
    "text of two lines": [marker(M.TEXT_VIEW_FACING, (0, 0, 0.25), text="HOME\nBASE")],
    "text with other scales": [marker(M.TEXT_VIEW_FACING, (5, 5, 0.2), text="HOME")],
    "text without height": [marker(M.TEXT_VIEW_FACING, (1, 1, 0), text="HOME")],
    "no text": [marker(M.TEXT_VIEW_FACING, (0, 0, 0.3))],
    "text of blanks": [marker(M.TEXT_VIEW_FACING, (0, 0, 0.3), text=" \n")],
    "clear text": [marker(M.TEXT_VIEW_FACING, (0, 0, 0.3), text="HOME", color=faint(RED, 0))],
}
