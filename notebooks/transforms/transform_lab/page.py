"""Draws a scene as a page: meshcat's viewer, without its server, over a still picture.

The page needs no network and no port. The viewer's script, which meshcat brings along, is compressed into it. Where
scripts or WebGL are missing the frame stays clear, and where `<iframe>` is not allowed it is taken out: in both cases
the picture remains.
"""

import base64
import functools
import gzip
import hashlib
import html
import json
import math
import struct
from importlib import resources
from pathlib import Path

import numpy as np

from .camera import FIELD_OF_VIEW, VIEWS, Camera
from .drawing import grid
from .shapes import BESIDE, path

ASPECT = 1.6  # width by height of what is drawn
ROW = 30  # height of a row of controls, in pixels
ALONG_Y = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])  # meshcat's cylinders lie along y
UPRIGHT = {"cylinder": ALONG_Y, "cone": ALONG_Y}
GRID_COLOR = 0xD8DCE2
HERE = Path(__file__).parent


@functools.cache
def viewer_script():
    """Return meshcat's JavaScript viewer and the code of these pages, compressed, as base64 text."""
    meshcat = resources.files("meshcat").joinpath("viewer", "dist", "main.min.js").read_bytes()
    return _packed(meshcat + b"\n" + (HERE / "page.js").read_bytes())


def _packed(data):
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")


# --- meshcat's commands ---------------------------------------------------------------------------------------------


def properties(nodes):
    """Return what meshcat holds of `nodes`: for each path the last look (None for a mere place) and 4x4 matrix."""
    found = {}
    for node in nodes:
        here = f"meshcat/{node.path}"
        found[here] = None, node.transform
        for i, solid in enumerate(node.solids):
            matrix = solid.matrix @ UPRIGHT[solid.kind] if solid.kind in UPRIGHT else solid.matrix
            found[f"{here}/solid{i}"] = (solid.kind, solid.color), matrix
        for i, cloud in enumerate(node.clouds):
            look = "points", cloud.points.tobytes(), cloud.colors.tobytes(), cloud.size
            found[f"{here}/cloud{i}"] = look, np.eye(4)
        for i, mesh in enumerate(node.meshes):
            found[f"{here}/mesh{i}"] = ("triangles", mesh.corners.tobytes(), mesh.colors.tobytes()), np.eye(4)
    return found


def changes(old, new):
    """Return meshcat's commands (packed bytes) that turn the properties `old` into `new`."""
    commands = [_delete(path) for path in old if path not in new]
    for path, (look, matrix) in new.items():
        had = old.get(path)
        if look is not None and (had is None or had[0] != look):
            commands.append(_set_object(path, look))
        if had is None or not np.array_equal(had[1], matrix):
            commands.append(_set_transform(path, matrix))
    return commands


def _delete(path):
    return _pack({"type": "delete", "path": path})


def _set_transform(path, matrix):
    return _pack({"type": "set_transform", "path": path, "matrix": np.round(matrix, 9).T.ravel().tolist()})


@functools.lru_cache(500)
def _set_object(path, look):
    """Return the command that puts an object of a certain look at `path`."""
    from meshcat import geometry as g

    kind, *rest = look
    if kind == "points":
        points, colors = (np.frombuffer(data).reshape(-1, n).T.astype(np.float32) for data, n in zip(rest, (3, 4)))
        # three.js takes the size for that of a point seen with a field of view of 90 degrees
        element = g.PointCloud(points, colors[:3], size=rest[2] / math.tan(FIELD_OF_VIEW / 2))
    elif kind == "triangles":
        corners, colors = (np.frombuffer(data).reshape(-1, n) for data, n in zip(rest, (3, 4)))
        faces = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
        shape = g.TriangularMeshGeometry(corners.astype(np.float32), faces, colors[:, :3].astype(np.float32))
        material = g.MeshLambertMaterial(color=0xFFFFFF, opacity=float(colors[0, 3]), vertexColors=True, side=2)
        element = g.Mesh(shape, material)
    elif kind == "lines":
        lines = np.frombuffer(rest[0]).reshape(-1, 3).T.astype(np.float32)
        element = g.LineSegments(g.PointsGeometry(lines), g.LineBasicMaterial(GRID_COLOR, depthWrite=False))
    else:
        solid = {
            "box": g.Box([1, 1, 1]),
            "sphere": g.Sphere(0.5),
            "cylinder": g.Cylinder(1, 0.5),
            "cone": g.Cylinder(1, radiusTop=0, radiusBottom=0.5),
        }[kind]
        r, g_, b, opacity = rest[0]
        color = sum(round(255 * value) << shift for value, shift in ((r, 16), (g_, 8), (b, 0)))
        element = g.Mesh(solid, g.MeshLambertMaterial(color=color, opacity=opacity))
    # meshcat draws identifiers at random; fixed ones make the same page of the same scene, and a smaller one
    element.uuid, element.geometry.uuid, element.material.uuid = "object", "geometry", "material"
    return _pack({"type": "set_object", "path": path, "object": element.lower()})


def _pack(command):
    import umsgpack

    return umsgpack.packb(command)


def block(commands):
    """Return commands as one block of bytes: their number, then each behind its length."""
    parts = [struct.pack(">I", len(commands))]
    for command in commands:
        parts += [struct.pack(">I", len(command)), command]
    return b"".join(parts)


# --- words ----------------------------------------------------------------------------------------------------------


def labels(nodes):
    """Return the labels of `nodes` as the page takes them: first those that have a fixed place."""
    found = [
        {
            "path": f"meshcat/{node.path}",
            "text": label.text,
            "position": np.round(label.position, 6).tolist(),
            "beside": label.beside,
            "height": label.height,
            "color": "rgb({:.0f} {:.0f} {:.0f})".format(*(255 * value for value in label.color[:3])),
        }
        for node in nodes
        for label in node.labels
    ]
    return sorted(found, key=lambda label: label["beside"])


# --- the page -------------------------------------------------------------------------------------------------------


def render(drawing, fixed_frame, seen_from, motion=None, states=(), live=None):
    """Return the interactive page (text) of a Drawing. It shows no still picture.

    `seen_from` is one of camera.VIEWS; `states` are Drawings of the same scene that `motion`, a Motion, goes through;
    `live` is the name under which the kernel sends changes.
    """
    drawings = [drawing, *states]
    commands, frames = [], []
    for i, name in enumerate(drawing.frames):
        seen = np.concatenate([d.seen_from(name) for d in drawings if name in d.frames])
        commands.append(_set_object(f"grid{i}", ("lines", grid(seen)[0].tobytes())))
        # drawn first, so that all else covers it
        ahead = {"type": "set_property", "path": f"grid{i}/<object>", "property": "renderOrder", "value": -1.0}
        commands.append(_pack(ahead))
        cameras = {view: Camera(seen, ASPECT, view, text_height(drawings)) for view in VIEWS}
        frames.append({
            "name": name,
            "path": f"meshcat/{path('frames', name)}",
            "cameras": {v: [_short(c.eye), _short(c.target), float(c.distance)] for v, c in cameras.items()},
        })  # fmt: skip
    for where in ("Grid", "Axes", "Background"):
        commands.append(_pack({"type": "set_property", "path": where, "property": "visible", "value": False}))
    base = properties(drawing.nodes)
    blocks = [block(commands + changes({}, base))]
    moving, told = _add_states(blocks, base, labels(drawing.nodes), states)
    view = {
        "states": told,
        "moving": moving,
        "start": motion.start() if states else 0,
        "seconds": motion.seconds if motion else None,
        "controls": [control.told() for control in motion.controls] if motion else [],
        "live": live,
        "frames": frames,
        "fixed": list(drawing.frames).index(fixed_frame),
        "seenFrom": seen_from,
        "fov": math.degrees(FIELD_OF_VIEW),
        "labels": labels(drawing.nodes),
        "beside": BESIDE,
        "text": drawing.text,
    }
    scene = _packed(block([json.dumps(view).encode()]) + b"".join(blocks))
    script = viewer_script()
    version = hashlib.sha256(script.encode()).hexdigest()[:12]
    page = (HERE / "page.html").read_text(encoding="utf-8").replace("ROW", str(ROW), 1)
    return page.replace("PAGE", json.dumps({"version": version, "script": script, "scene": scene}), 1)


def _add_states(blocks, base, base_labels, drawings):
    """Append a block for each of `drawings`; return the paths that move, and what else the page is told of each.

    A block holds all that differs between any two states, so the states can be shown in any order.
    """
    states = [properties(drawing.nodes) for drawing in drawings]
    every = dict.fromkeys(path for state in (base, *states) for path in state)
    varying = [path for path in every if not all(_same(base.get(path), state.get(path)) for state in states)]
    moving = [path for path in varying if sum(path in state for state in states) > 1]
    looks = {path: {state[path][0] if path in state else "none" for state in (base, *states)} for path in varying}
    told = []
    for drawing, state in zip(drawings, states):
        commands = [_delete(path) for path in varying if path not in state]
        for path in varying:
            if path in state and len(looks[path]) > 1 and state[path][0] is not None:
                commands.append(_set_object(path, state[path][0]))
            if path in state:
                commands.append(_set_transform(path, state[path][1]))
        blocks.append(block(commands))
        told.append({"moving": [i for i, path in enumerate(moving) if path in state], "text": drawing.text})
        if (found := labels(drawing.nodes)) != base_labels:
            told[-1]["labels"] = found
    return moving, told


def _same(one, other):
    if one is None or other is None:
        return one is other
    return one[0] == other[0] and np.array_equal(one[1], other[1])


def text_height(drawings):
    """Return the part of the picture's height, from 0 to 1, that the longest text of `drawings` takes at the top."""
    lines = max(drawing.text.count("\n") + 1 if drawing.text else 0 for drawing in drawings)
    return min(0.02 + 0.035 * lines, 0.4) if lines else 0.0


def over_picture(page, picture, description, caption, rows):
    """Return HTML that shows `page` in a frame over `picture` (PNG bytes), whose alternative text is `description`.

    `rows` of controls stand below the picture.
    """
    source = base64.b64encode(picture).decode("ascii")
    return (
        '<figure style="margin: 0; max-width: 760px">'
        f'<div style="position: relative; aspect-ratio: {ASPECT:g}; background: white; margin-bottom: {rows * ROW}px">'
        f'<img src="data:image/png;base64,{source}" alt="{html.escape(description)}" width="100%">'
        f'<iframe srcdoc="{html.escape(page)}" title="{html.escape(caption)}" loading="lazy" style="position: absolute;'
        f' left: 0; top: 0; width: 100%; height: calc(100% + {rows * ROW}px); border: 0"></iframe>'
        f"</div><figcaption>{html.escape(caption)}</figcaption></figure>"
    )


def _short(values):
    return np.round(values, 6).tolist()
