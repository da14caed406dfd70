"""Draws a scene as a page: meshcat's viewer, without its server, over a still picture.

The page needs no network and no port. What draws it is not in each page (see carriers.py); until it is there the frame stays
clear, and so where scripts or WebGL are missing, and where `<iframe>` is not allowed it is taken out: the picture is seen.
"""

import base64
import functools
import gzip
import hashlib
import html
import json
import math
import re
from pathlib import Path

import numpy as np

from .camera import FIELD_OF_VIEW, NEAREST, VIEWS, Camera
from .drawing import grid
from .meshcat_commands import block, changes, delete, folder, properties, set_object, set_property, set_transform
from .picture import webp
from .shapes import AROUND, NEAR
from .shapes import path as node_path

ASPECT = 1.6  # width by height of what is drawn
MOST_CHOICES = 40  # of fixed frames to choose from
ROW = 30  # height of a row of controls, in pixels
HERE = Path(__file__).parent
SAFE = str.maketrans("&<>`$", ",./:[")  # for digits of base 85 that mean something in HTML or in a script
# of meshcat's viewer: what makes films (ccapture.js), and what reads files of meshes (OBJ, MTL, Collada, STL)
UNUSED = {"583", "549", "468", "617", "973", "23", "976", "476"}
# In the place of its menu (dat.gui), which these pages do not show: an object that does nothing, whatever is asked of it.
NO_MENU = """376:(e,t,n)=>{
const one=()=>document.createElement("i"),element=()=>{const made=one();made.append(one());made.removeChild=()=>{};return made};
const get=(_,name)=>name==="domElement"?element():menu,menu=new Proxy(class{},{get,apply:()=>menu,construct:()=>menu});
n.d(t,{ZP:()=>menu})},"""


@functools.cache
def script():
    """Return the text that draws scenes (the page's elements, meshcat's viewer, page.js), packed, and its digest."""
    elements, places = _read("scene.html").replace("ROW", str(ROW), 1), {"near": NEAR, "around": AROUND}
    body, places = f"document.body.innerHTML = {json.dumps(elements)};", f"const PLACES = {json.dumps(places)};"
    text = "\n".join([body, _viewer(), places, _read("page.js")]).encode()
    return packed(text), base64.b64encode(hashlib.sha256(text).digest()).decode("ascii")


def _viewer():
    """Return meshcat's viewer, a bundle of numbered modules, without those that these pages do not use."""
    bundle = (folder() / "viewer/dist/main.min.js").read_text(encoding="utf-8")
    modules = re.split(r"(?<=[{,])(?=\d+:(?:function\(|\([\w,]*\)=>|\w=>))", bundle)
    empty = {number: f"{number}:()=>{{}}," for number in UNUSED} | {"376": NO_MENU}
    return "".join(empty.get(module.partition(":")[0], module) for module in modules)


def _read(name):
    """Return the text of a file without its comments and indentation, which need not be packed."""
    return re.sub(r"\n\s+", "\n", re.sub(r" *// .*", "", (HERE / name).read_text(encoding="utf-8")))


def packed(data):
    """Return bytes as a text for a script in an attribute; `unpacked` of page.html is the way back."""
    return base64.b85encode(gzip.compress(data, 9, mtime=0)).decode("ascii").translate(SAFE)


def labels(nodes):
    """Return the labels of `nodes` as the page takes them, in the order in which they choose their places."""
    found = [
        {
            "path": f"meshcat/{node.path}",
            "text": label.text,
            "subscript": label.subscript,
            "position": np.round(label.position, 6).tolist(),
            "near": label.near,
            "height": label.height,
            "color": "rgb({:.0f} {:.0f} {:.0f} / {:.3g})".format(
                *(255 * value for value in label.color[:3]), label.color[3]
            ),
        }
        for node in nodes
        for label in node.labels
    ]
    return sorted(found, key=lambda label: [None, *NEAR].index(label["near"]))


def render(drawing, fixed_frame, seen_from, motion=None, states=(), live=None, carries=True):
    """Return the interactive page (text) of a Drawing. It shows no still picture.

    `seen_from` is one of camera.VIEWS; `states` are Drawings of the same scene that `motion`, a Motion, goes through;
    `live` is the name under which the kernel sends changes; what `carries` holds the script that draws it.
    """
    drawings, found = [drawing, *states], labels(drawing.nodes)
    commands, frames, top = [], [], text_height(drawings)
    there = [name for name in drawing.frames if all(name in d.frames for d in drawings)][:MOST_CHOICES]
    for i, name in enumerate(there):
        seen = np.concatenate([d.seen_from(name) for d in drawings])
        commands.append(set_object(f"grid{i}", ("lines", grid(seen)[0].tobytes())))
        commands.append(set_property(f"grid{i}/<object>", "renderOrder", -1.0))  # first, so that all else covers it
        cameras = {view: Camera(seen, ASPECT, view, top) for view in VIEWS}
        frames.append({
            "name": name,
            "path": f"meshcat/{node_path('frames', name)}",
            "cameras": {v: [_short(c.eye), _short(c.target), float(c.distance)] for v, c in cameras.items()},
        })  # fmt: skip
    commands += [set_property(path, "visible", False) for path in ("Grid", "Axes", "Background")]
    base = properties(drawing.nodes)
    blocks = [block(commands + changes({}, base))]
    moving, told = _add_states(blocks, base, found, states)
    view = {
        "states": told,
        "moving": moving,
        "start": motion.start if states else 0,
        "seconds": motion.seconds if motion else None,
        "controls": [control.as_json() for control in motion.controls] if motion else [],
        "live": live,
        "frames": frames,
        "fixed": there.index(fixed_frame) if fixed_frame in there else 0,
        "seenFrom": seen_from,
        "fov": math.degrees(FIELD_OF_VIEW),
        "nearest": NEAREST,
        "labels": found,
        "text": drawing.text,
    }
    scene = packed(block([json.dumps(view).encode()]) + b"".join(blocks))
    whole, digest = script()
    carried = _read("carried.js").replace("PACKED", whole, 1) if carries else ""
    parts = {"DIGEST": digest, "CARRIED": carried, "SCENE": scene}
    return re.sub("|".join(parts), lambda found: parts[found[0]], _read("page.html"))


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
        commands = [delete(path) for path in varying if path not in state]
        for path in varying:
            if path in state and len(looks[path]) > 1 and state[path][0] is not None:
                commands.append(set_object(path, state[path][0]))
            if path in state:
                commands.append(set_transform(path, state[path][1]))
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


def over_picture(page, picture, description, caption, rows, carries=True):
    """Return HTML that shows `page` in a frame over `picture` (an image), whose alternative text is `description`.

    `rows` of controls stand below the picture. What `carries` the script is loaded although nobody looks at it yet.
    """
    return (
        '<figure style="margin: 0; max-width: 760px">'
        f'<div style="position: relative; aspect-ratio: {ASPECT:g}; background: white; margin-bottom: {rows * ROW}px">'
        f"{_image(picture, description)}"
        f'<iframe srcdoc="{html.escape(page)}" title="The scene, to be turned" loading="{"eager" if carries else "lazy"}"'
        f' style="position: absolute; left: 0; top: 0; width: 100%; height: calc(100% + {rows * ROW}px); border: 0"></iframe>'
        f"</div><figcaption>{html.escape(caption)}</figcaption></figure>"
    )


def still(picture, description, caption):
    """Return HTML that shows `picture` (an image), whose alternative text is `description`."""
    return (
        f'<figure style="margin: 0; max-width: {min(640, picture.width)}px">{_image(picture, description)}'
        f"<figcaption>{html.escape(caption)}</figcaption></figure>"
    )


def _image(picture, description):
    source = base64.b64encode(webp(picture)).decode("ascii")
    return f'<img src="data:image/webp;base64,{source}" alt="{html.escape(description)}" width="100%">'


def _short(values):
    return np.round(values, 6).tolist()
