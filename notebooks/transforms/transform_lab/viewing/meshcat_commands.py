"""The commands that meshcat's viewer takes: what it holds of a scene, and what changes that, packed for the way to it."""

import functools
import importlib.util
import math
import struct
import sys
import types
from pathlib import Path

import numpy as np

from .camera import FIELD_OF_VIEW

ALONG_Y = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])  # meshcat's cylinders lie along y
UPRIGHT = {"cylinder": ALONG_Y, "cone": ALONG_Y}
GRID_COLOR = 0xD8DCE2


def folder():
    """Return meshcat's folder."""
    return Path(importlib.util.find_spec("meshcat").submodule_search_locations[0])


@functools.cache
def _geometry():
    """Return meshcat's geometry, loaded alone: the package would load its web server, which takes half a second."""
    package = types.ModuleType(f"{__package__}.meshcat")
    package.__path__ = [str(folder())]
    sys.modules[package.__name__] = package
    return importlib.import_module(f"{package.__name__}.geometry")


def properties(nodes):
    """Return what meshcat holds of `nodes`: for each path the last look (None for a mere place) and 4x4 matrix."""
    found: dict[str, tuple] = {}
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
    commands = [delete(path) for path in old if path not in new]
    for path, (look, matrix) in new.items():
        had = old.get(path)
        if look is not None and (had is None or had[0] != look):
            commands.append(set_object(path, look))
        if had is None or not np.array_equal(had[1], matrix):
            commands.append(set_transform(path, matrix))
    return commands


def delete(path):
    """Return the command that removes what is at `path` and below."""
    return pack({"type": "delete", "path": path})


def set_transform(path, matrix):
    """Return the command that moves what is at `path` to a 4x4 matrix, in the coordinates of its parent."""
    return pack({"type": "set_transform", "path": path, "matrix": np.round(matrix, 9).T.ravel().tolist()})


@functools.lru_cache(500)
def set_object(path, look):
    """Return the command that puts an object of a certain look at `path`."""
    g = _geometry()
    (kind, *rest), opacity = look, 1.0
    if kind == "points":
        points, colors = (np.frombuffer(data).reshape(-1, n).T.astype(np.float32) for data, n in zip(rest, (3, 4)))
        # three.js takes the size for that of a point seen with a field of view of 90 degrees
        element = g.PointCloud(points, colors[:3], size=rest[2] / math.tan(FIELD_OF_VIEW / 2))
        opacity = float(colors[3, 0])
    elif kind == "triangles":
        corners, colors = (np.frombuffer(data).reshape(-1, n) for data, n in zip(rest, (3, 4)))
        faces = np.arange(len(corners), dtype=np.uint32).reshape(-1, 3)
        shape = g.TriangularMeshGeometry(corners.astype(np.float32), faces, colors[:, :3].astype(np.float32))
        element = g.Mesh(shape, g.MeshLambertMaterial(color=0xFFFFFF, vertexColors=True, side=2))
        opacity = float(colors[:3, 3].mean())
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
        element = g.Mesh(solid, g.MeshLambertMaterial(color=color, side=0))  # seen from outside
    # meshcat draws identifiers at random; fixed ones make the same page of the same scene, and a smaller one
    element.uuid, element.geometry.uuid, element.material.uuid = "object", "geometry", "material"
    lowered = element.lower()
    if opacity < 1:  # without depthWrite, what is behind or inside is seen through it
        lowered["materials"][0].update(opacity=opacity, transparent=True, depthWrite=False)
    return pack({"type": "set_object", "path": path, "object": lowered})


def set_property(path, name, value):
    """Return the command that sets a property of the object at `path`."""
    return pack({"type": "set_property", "path": path, "property": name, "value": value})


def pack(command):
    """Return a command (a dictionary) as bytes."""
    import umsgpack

    return umsgpack.packb(command)


def block(commands):
    """Return commands as one block of bytes: their number, then each behind its length."""
    parts = [struct.pack(">I", len(commands))]
    for command in commands:
        parts += [struct.pack(">I", len(command)), command]
    return b"".join(parts)
