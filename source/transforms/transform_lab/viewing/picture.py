"""Draws a scene as a still picture, for where scripts or WebGL are missing: notebooks not trusted, saved pages."""

import functools
import importlib.util
import io
import math
from pathlib import Path

import numpy as np

from .shapes import AROUND, NEAR, moved

HEIGHT = 475  # pixels: as large as it is shown at most
FINE = 2  # times as many pixels in each direction are painted first, so that edges are smooth
NAME, SUBSCRIPT, WORDS = 15, 11, 14  # height of letters: of names, and of the text in the corner
CAPITAL = 0.72  # of its font's size: the height of a capital letter
MIDDLE = 0.26  # of its font's size: how far the middle of a line is above the line that letters stand on
LOWER = 0.23  # of a capital letter's height
LOWERED = 4  # pixels, a subscript
COVERED = 20  # how bad it is to cover another label, or to stand on the edge of the picture
LINE = 0.038  # height of a line, of the picture's height
BOLD = "DejaVuSans-Bold.ttf"
LARGEST = 600  # of a font; above it the picture would be all letter
COLORS = [max(255 - (255 - value + 12) // 24 * 24, 0) for value in range(256)] * 3  # from white down
GRID = "#d3d3d3"  # of lines as wide as a fine pixel: the pixels in which they are have the same shade of COLORS
LIGHT = np.array([0.3, 0.2, 0.95])  # in the camera's right, up and backward directions


def render(nodes, grid, camera, text=""):
    """Return the image (Pillow's) of `nodes` and the lines of the `grid` (Nx2x3), seen by `camera`, all in the fixed frame.

    `text` stands in the upper left.
    """
    from PIL import Image, ImageDraw

    image = Image.new("RGB", (round(FINE * HEIGHT * camera.aspect), FINE * HEIGHT), "white")
    pen = ImageDraw.Draw(image, "RGBA")
    lines = camera.project(grid)[0]
    for line in _pixels(lines[np.isfinite(lines).all(axis=(1, 2))]):
        pen.line(line, fill=GRID)
    sheets = []  # of faces, with the distance at which they are painted
    for node in nodes:
        for solid in node.solids:
            faces = _shown(*_solid(node, solid, camera))
            sheets += [(faces[0][0], faces)] if faces and solid.color[3] < 1 else [(face[0], [face]) for face in faces]
        parts = [_cloud(node, cloud, camera) for cloud in node.clouds]
        parts += [_mesh(node, mesh, camera) for mesh in node.meshes]
        sheets += [(face[0], [face]) for part in parts for face in _shown(*part)]
    for _, faces in sorted(sheets, key=lambda sheet: -sheet[0]):  # what is nearer is painted later
        if len(faces) == 1:
            pen.polygon(faces[0][1], fill=faces[0][2])
        else:
            _paint(image, faces)
    image = image.reduce(FINE)
    pen = ImageDraw.Draw(image, "RGBA")
    _write(pen, nodes, camera)
    if text:
        font = _font("DejaVuSansMono.ttf", WORDS)
        box = pen.multiline_textbbox((10, 10), text, font, spacing=2)
        pen.rectangle((box[0] - 3, box[1] - 3, box[2] + 3, box[3] + 3), fill=(255, 255, 255, 204))
        pen.multiline_text((10, 10), text, "#222222", font, spacing=2)
    return image


def _shown(places, colors, distances):
    """Return the faces that are in front of the camera, the nearest first: distance, pixels, colour of each."""
    shown = np.flatnonzero(np.isfinite(places).all(axis=(1, 2)))
    shown = shown[np.argsort(distances[shown])]
    shades = np.round(255 * colors[shown]).astype(int).tolist()
    return list(zip(distances[shown].tolist(), _pixels(places[shown]), map(tuple, shades)))


def _paint(image, faces):
    """Paint what is seen of a translucent solid in one piece, for where two faces meet none must be painted twice."""
    from PIL import Image, ImageDraw

    corners = np.array([pixels for _, pixels, _ in faces]).reshape(-1, 2)
    left, top = np.maximum(np.floor(corners.min(axis=0)).astype(int), 0).tolist()
    right, bottom = np.minimum(np.ceil(corners.max(axis=0)).astype(int) + 1, image.size).tolist()
    if left >= right or top >= bottom:
        return
    sheet = image.crop((left, top, right, bottom))
    cover = Image.new("L", sheet.size)
    colors, opacities = ImageDraw.Draw(sheet), ImageDraw.Draw(cover)
    for _, pixels, shade in faces:
        place = [number - (left, top)[i % 2] for i, number in enumerate(pixels)]
        colors.polygon(place, fill=shade[:3])
        opacities.polygon(place, fill=shade[3])
    image.paste(sheet, (left, top), cover)


def _pixels(places):
    """Return places in the picture (Nx…x2) as lists of pixels, x, y, x, y, …, from the upper left of the fine picture."""
    pixels = (np.array([0, 1]) + places * [1, -1]) * (FINE * HEIGHT)
    return np.clip(pixels, -1e8, 1e8).reshape(len(places), math.prod(places.shape[1:])).tolist()


@functools.cache
def _font(name, size):
    """Return a font of Matplotlib's, which need not be imported for it."""
    from PIL import ImageFont

    matplotlib = importlib.util.find_spec("matplotlib").submodule_search_locations[0]
    return ImageFont.truetype(Path(matplotlib, "mpl-data", "fonts", "ttf", name), size)


def webp(image):
    """Return an image as a WebP file (bytes) for a page: without loss, but with colours off by up to 12 of 255 for its size."""
    from PIL import WebPImagePlugin  # noqa: F401, or Pillow would load all its formats to find this one

    file = io.BytesIO()
    image.point(COLORS).save(file, "WEBP", lossless=True, quality=30, method=3)
    return file.getvalue()


def _write(pen, nodes, camera):
    """Write the labels where `places` has them."""
    for label, size, font, (x, y) in places(nodes, camera):
        color = tuple(round(255 * value) for value in label.color)
        lines, small = label.text.split("\n"), _font(BOLD, SUBSCRIPT)
        width = max(map(font.getlength, lines)) + small.getlength(label.subscript)
        style = {"anchor": "ls", "stroke_width": 2, "stroke_fill": "white"}
        for i, words in enumerate(lines):
            below = (i - (len(lines) - 1) / 2) * 1.15 + MIDDLE
            left, base = x * HEIGHT - width / 2, (1 - y) * HEIGHT + below * size
            pen.text((left, base), words, color, font, **style)
            if label.subscript:
                pen.text((left + font.getlength(words), base + LOWERED), label.subscript, color, small, **style)


def places(nodes, camera):
    """Return [(label, size of its letters in pixels, font, the place of its middle)] in the order in which they are placed.

    A place is as `camera.project` has it.
    """
    shown = [(label, node.transform) for node in nodes for label in node.labels if _in_view(label, node, camera)]
    taken = []  # centre, half width and half height of what is drawn, and how bad it is to cover that
    for label, transform in shown:
        marks = [1] if label.near == "thing" else [0.3, 0.6, 0.8]  # the thing named, or along the axis to its letter
        found = camera.project(moved(transform, np.outer(marks, label.position)))[0]
        taken += [(x, y, LINE / 4, LINE / 4, 1) for x, y in found]
    placed = []
    for label, transform in sorted(shown, key=lambda pair: [None, *NEAR].index(pair[0].near)):
        place, before = camera.project(moved(transform, np.outer([1, 0.9], label.position)))[0]
        size = _font_size(label, transform, camera)
        font = _font(BOLD if label.height is None else "DejaVuSans.ttf", size)
        half_width, half_height = half_size(label, font)
        along, across = np.array([half_width, 0]), np.array([0, LINE])
        if label.near == "tip":
            along = LINE * (place - before) / (np.linalg.norm(place - before) or 1)
            across = np.array([-along[1], along[0]])
        candidates = [place + one * along + other * across for one, other in NEAR.get(label.near, [(0, 0)])]
        marks = np.array(taken)
        w, h, badness = marks[:, 2:].T

        def badness_at(candidate):
            x, y = np.abs(marks[:, :2] - candidate).T
            edge = np.minimum(candidate, [camera.aspect, 1] - candidate)
            cut_off = np.any(edge < [half_width, half_height])
            return badness[(x < half_width + w) & (y < half_height + h)].sum() + COVERED * cut_off

        best = min(candidates, key=badness_at)
        if label.near and badness_at(best) >= COVERED:
            best = min([best, *(place + LINE * np.array(offset) for offset in AROUND)], key=badness_at)
        x, y = best
        taken.append((x, y, half_width, half_height, COVERED))
        if label.height is not None:  # RViz has a text lower than its position
            y -= LOWER * CAPITAL * size / HEIGHT
        placed.append((label, size, font, (x, y)))
    return placed


def half_size(label, font):
    """Return half the width and half the height of a label that is no marker's, in heights of the picture."""
    width = max(map(font.getlength, label.text.split("\n"))) + _font(BOLD, SUBSCRIPT).getlength(label.subscript)
    return width / 2 / HEIGHT, LINE / 2


def _in_view(label, node, camera):
    """Whether what a label names can be seen; where everything else has moved out of view, its name goes too."""
    place = camera.project(moved(node.transform, label.position))[0]
    return bool(((place > 0) & (place < [camera.aspect, 1])).all())


def _font_size(label, transform, camera):
    """Return the size in pixels of a label's text."""
    if label.height is None:
        return NAME
    depth = camera.project(moved(transform, label.position))[1]
    return min(max(round(HEIGHT * label.height / (2 * camera.tangent * depth) / CAPITAL), 1), LARGEST)


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
