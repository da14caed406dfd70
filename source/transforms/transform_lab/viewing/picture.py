"""Draws a scene as a still picture, for where scripts or WebGL are missing: notebooks not trusted, saved pages."""

import io
import math

import numpy as np

from .shapes import BESIDE, moved

HEIGHT = 4.5  # inches
DOTS_PER_INCH = 110
CAPITAL = 0.72  # of its font's size: the height of a capital letter
LOWER = 0.23  # of a capital letter's height
LIGHT = np.array([0.3, 0.2, 0.95])  # in the camera's right, up and backward directions


def render(nodes, grid, camera, text=""):
    """Return the PNG (bytes) of `nodes` and the lines of the `grid` (Nx2x3), seen by `camera`, all in the fixed frame.

    `text` stands in the upper left.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.figure import Figure

    figure = Figure(figsize=(HEIGHT * camera.aspect, HEIGHT), dpi=DOTS_PER_INCH, facecolor="white")
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_axes([0, 0, 1, 1], xlim=(0, camera.aspect), ylim=(0, 1))
    axes.set_axis_off()

    lines = camera.project(grid)[0]
    axes.add_collection(
        LineCollection(lines[np.isfinite(lines).all(axis=(1, 2))], colors="#d8dce2", linewidths=0.7, zorder=0)
    )
    polygons, colors, depths = [], [], []
    for node in nodes:
        parts = [_solid(node, solid, camera) for solid in node.solids]
        parts += [_cloud(node, cloud, camera) for cloud in node.clouds]
        parts += [_mesh(node, mesh, camera) for mesh in node.meshes]
        for places, shades, distances in parts:
            shown = np.isfinite(places).all(axis=(1, 2))  # in front of the camera
            polygons.extend(places[shown])
            colors.extend(shades[shown])
            depths.extend(distances[shown])
    order = np.argsort(depths)[::-1]  # what is nearer is painted later
    polygons, colors = np.reshape(polygons, (-1, 4, 2))[order], np.reshape(colors, (-1, 4))[order]
    edges = colors * [1, 1, 1, 0] + np.outer(colors[:, 3] == 1, [0, 0, 0, 1])  # close the seams, but of solid colours
    axes.add_collection(PolyCollection(polygons, facecolors=colors, edgecolors=edges, linewidths=0.3, zorder=1))
    _write(axes, nodes, camera)
    if text:
        axes.text(0.02, 0.98, text, parse_math=False, family="monospace", fontsize=9, va="top", color="#222222", zorder=4,
                  bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 2})  # fmt: skip

    canvas.draw()
    return _png(np.asarray(canvas.buffer_rgba()))


def _png(pixels):
    """Return a PNG file with a palette of 256 colours: half the size, no colour off by more than 14 of 255."""
    from PIL import Image

    file = io.BytesIO()
    Image.fromarray(pixels).convert("RGB").quantize(256, method=Image.Quantize.MAXCOVERAGE).save(
        file, "PNG", optimize=True
    )
    return file.getvalue()


def _write(axes, nodes, camera):
    """Write the labels: those that have a fixed place, then the others where they cover least."""
    from matplotlib.patheffects import withStroke

    line = 0.038  # height of a line, of the picture's height
    labels = [(label, node.transform) for node in nodes for label in node.labels if _in_view(label, node, camera)]
    taken = []  # centre, half width and half height of what is drawn, and how bad it is to cover that
    for label, transform in labels:
        marks = [1] if label.beside else [0.3, 0.6, 0.9]  # the thing named, or along the axis to its letter
        places = camera.project(moved(transform, np.outer(marks, label.position)))[0]
        taken += [(x, y, line / 4, line / 4, 1) for x, y in places]
    for label, transform in sorted(labels, key=lambda pair: pair[0].beside):
        place = camera.project(moved(transform, label.position))[0]
        half_width, half_height = 0.011 * len(label.text), line / 2
        candidates = [place + [right * half_width, up * line] for right, up in BESIDE] if label.beside else [place]

        marks = np.array(taken)
        w, h, badness = marks[:, 2:].T

        def badness_at(candidate):
            x, y = np.abs(marks[:, :2] - candidate).T
            edge = np.minimum(candidate, [camera.aspect, 1] - candidate)
            cut_off = np.any(edge < [half_width, half_height])
            return badness[(x < half_width + w) & (y < half_height + h)].sum() + 20 * cut_off

        x, y = min(candidates, key=badness_at)
        taken.append((x, y, half_width, half_height, 20 if label.beside else 5))
        weight = "bold" if label.height is None else "normal"
        style = {"fontweight": weight, "ha": "center", "va": "center", "ma": "left", "parse_math": False}
        outline = [withStroke(linewidth=3, foreground="white")]
        size = _font_size(label, transform, camera)
        if (
            label.height is not None
        ):  # RViz has a text lower than its position, and the middle of our font's line is high
            y -= LOWER * CAPITAL * size / (72 * HEIGHT)
        axes.text(x, y, label.text, color=label.color, fontsize=size, path_effects=outline, **style)


def _in_view(label, node, camera):
    """Whether what a label names can be seen; where everything else has moved out of view, its name goes too."""
    place = camera.project(moved(node.transform, label.position))[0]
    return bool(((place > 0) & (place < [camera.aspect, 1])).all())


def _font_size(label, transform, camera):
    """Return the size in points of a label's text."""
    if label.height is None:
        return 10
    depth = camera.project(moved(transform, label.position))[1]
    # above 400 points the picture would be all letter
    return min(72 * HEIGHT * label.height / (2 * camera.tangent * depth) / CAPITAL, 400)


def _solid(node, solid, camera):
    """Return what can be seen of a solid: polygons (Nx4x2) in the picture, their colours and their distances."""
    matrix = node.transform @ solid.matrix
    faces = moved(matrix, UNIT[solid.kind])
    centers = faces.mean(axis=1)
    normals = np.cross(faces[:, 2] - faces[:, 0], faces[:, 3] - faces[:, 1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    outward = np.sign(((centers - matrix[:3, 3]) * normals).sum(axis=1))
    normals *= outward[:, None]
    facing = ((camera.eye - centers) * normals).sum(axis=1) > 0
    faces, normals = faces[facing], normals[facing]
    brightness = _brightness(normals, camera)
    colors = np.column_stack([np.outer(brightness, solid.color[:3]), np.full(len(faces), solid.color[3])])
    places, depths = camera.project(faces)
    return places, colors, depths.mean(axis=1)


def _cloud(node, cloud, camera):
    """Return the squares of a point cloud, as `_solid` does."""
    points = moved(node.transform, cloud.points)
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) @ [camera.right, camera.up] * cloud.size / 2
    places, depths = camera.project(points[:, None] + corners)
    return places, cloud.colors, depths.mean(axis=1)


def _mesh(node, mesh, camera):
    """Return the triangles of a mesh as polygons of four corners, as `_solid` does; both sides are seen."""
    corners = moved(node.transform, mesh.corners)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    towards = np.sign(((camera.eye - corners.mean(axis=1)) * normals).sum(axis=1))
    colors = mesh.colors.mean(axis=1)
    colors[:, :3] *= _brightness(normals * towards[:, None], camera)[:, None]
    places, depths = camera.project(corners[:, [0, 1, 2, 2]])
    return places, colors, depths.mean(axis=1)


def _brightness(normals, camera):
    """Return how bright surfaces with these normals (Nx3) are, from 0 to 1."""
    light = LIGHT @ [camera.right, camera.up, camera.back] / np.linalg.norm(LIGHT)
    return 0.62 + 0.38 * np.clip(normals @ light, 0, 1)


def _grid_of_faces(surface, across, along):
    """Return the four-cornered faces (Nx4x3) of `surface`, a function of two numbers from 0 to 1."""
    u, v = np.linspace(0, 1, across + 1), np.linspace(0, 1, along + 1)
    p = np.array([[surface(a, b) for b in v] for a in u])
    return np.stack([p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]], axis=2).reshape(-1, 4, 3)


def _round(radius, height):
    """Return the surface of revolution whose radius and height are functions of a number from 0 to 1."""
    return lambda a, b: (
        radius(b) * math.cos(2 * math.pi * a), radius(b) * math.sin(2 * math.pi * a), height(b)
    )  # fmt: skip


def _units():
    """Return the faces of the unit solids by their kind."""
    top = _grid_of_faces(_round(lambda b: 0.5 * b, lambda b: 0.5), 20, 1)
    bottom = top * [1, 1, -1]
    side = _grid_of_faces(lambda a, b: (a - 0.5, b - 0.5, 0.5), 4, 4)
    sides = [side, side[..., [1, 2, 0]], side[..., [2, 0, 1]]]
    return {
        "cylinder": np.concatenate([_grid_of_faces(_round(lambda b: 0.5, lambda b: b - 0.5), 20, 6), top, bottom]),
        "cone": np.concatenate([_grid_of_faces(_round(lambda b: 0.5 - 0.5 * b, lambda b: b - 0.5), 20, 3), bottom]),
        "sphere": _grid_of_faces(
            _round(lambda b: 0.5 * math.sin(math.pi * b), lambda b: 0.5 * math.cos(math.pi * b)), 20, 10
        ),
        "box": np.concatenate([s * sign for s in sides for sign in (1, -1)]),
    }


UNIT = _units()
