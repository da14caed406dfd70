"""Draws a scene as a page: meshcat's viewer, without its server, over a still picture.

The page needs no network and no port. The viewer's script, which meshcat brings along, is compressed into it. Where
scripts or WebGL are missing the frame stays clear, and where `<iframe>` is not allowed it is taken out: in both cases
the picture remains.
"""

import base64
import functools
import gzip
import html
import json
import math
import struct
from importlib import resources

import numpy as np

from .camera import FIELD_OF_VIEW
from .shapes import BESIDE

ALONG_Y = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1.0]])  # meshcat's cylinders lie along y
GRID_COLOR = 0xD8DCE2

PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>Frames</title><style>
html, body { margin: 0; height: 100%; overflow: hidden; }
#pane { width: 100%; height: 100%; cursor: grab; }
#pane canvas { display: block; }
.label { position: absolute; left: 0; top: 0; font: bold 15px sans-serif; white-space: nowrap; pointer-events: none;
  text-shadow: 0 0 2px #fff, 0 0 2px #fff, 0 0 3px #fff, 0 0 3px #fff; }
</style></head><body><div id="pane"></div><script>
const view = VIEW;
async function unpack(text) {
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}
async function draw() {
  const script = document.createElement("script");
  script.textContent = new TextDecoder().decode(await unpack(view.script));
  document.head.append(script);
  const viewer = new MeshCat.Viewer(document.getElementById("pane"));
  window.viewer = viewer;
  viewer.gui.domElement.style.display = "none";
  const packed = await unpack(view.commands), sizes = new DataView(packed);
  for (let at = 0; at < packed.byteLength; at += 4 + sizes.getUint32(at)) {
    viewer.handle_command_bytearray(new Uint8Array(packed, at + 4, sizes.getUint32(at)));
  }
  // three.js has y up: x, y, z of the fixed frame are x, -z, y there.
  const place = ([x, y, z]) => [x, z, -y];
  Object.assign(viewer.camera, view.lens);
  viewer.camera.position.set(...place(view.eye));
  viewer.controls.target.set(...place(view.target));
  viewer.controls.update();
  // The wheel scrolls the notebook until the scene is clicked.
  viewer.controls.enableZoom = false;
  document.addEventListener("pointerdown", () => viewer.controls.enableZoom = true);
  document.documentElement.addEventListener("mouseleave", () => viewer.controls.enableZoom = false);
  const labels = view.labels.map(label => {
    const element = document.createElement("div");
    element.className = "label";
    element.textContent = label.text;
    element.style.color = label.color;
    document.body.append(element);
    return {...label, element, node: viewer.scene_tree.find(label.path).object};
  });
  // First the labels that have a fixed place, then the others where they cover least.
  const project = (label, along) => {
    const p = label.node.position.clone().set(...label.position).multiplyScalar(along);
    p.applyMatrix4(label.node.matrixWorld).project(viewer.camera);
    return {x: (p.x + 1) / 2 * window.innerWidth, y: (1 - p.y) / 2 * window.innerHeight, behind: p.z > 1};
  };
  const write = () => {
    const width = window.innerWidth, height = window.innerHeight;
    const taken = [];  // centre, half width and half height of what is drawn, and how bad it is to cover that
    for (const label of labels) {
      const marks = label.beside ? [1] : [0.3, 0.6, 0.9];  // the thing named, or along the axis to its letter
      for (const along of marks) taken.push({...project(label, along), w: 4, h: 4, bad: 1});
    }
    for (const label of labels) {
      const {x, y, behind} = project(label, 1), w = label.element.offsetWidth / 2, h = label.element.offsetHeight / 2;
      let best = {bad: Infinity};
      for (const [right, up] of label.beside ? view.beside : [[0, 0]]) {
        const place = {x: x + right * w, y: y - up * 2 * h, w, h, bad: 0};
        if (Math.min(place.x, width - place.x) < w || Math.min(place.y, height - place.y) < h) place.bad += 20;
        for (const t of taken) {
          if (Math.abs(place.x - t.x) < w + t.w && Math.abs(place.y - t.y) < h + t.h) place.bad += t.bad;
        }
        if (place.bad < best.bad) best = place;
      }
      taken.push({...best, bad: label.beside ? 20 : 5});
      label.element.style.transform = `translate(${best.x - w}px, ${best.y - h}px)`;
      label.element.style.visibility = behind ? "hidden" : "visible";
    }
  };
  const render = viewer.render.bind(viewer);
  viewer.render = () => { render(); write(); };
  viewer.set_3d_pane_size();
  viewer.render();
  document.body.style.background = "white";
  // A browser keeps some 16 scenes and drops the oldest.
  viewer.renderer.domElement.addEventListener("webglcontextlost", leave);
}
function leave(reason) {  // to the still picture below
  console.warn("The still picture is shown instead of the scene.", reason);
  document.body.replaceChildren();
  document.body.style.background = "none";
  if (window.frameElement) window.frameElement.remove();
}
draw().catch(leave);
</script></body></html>
"""


@functools.cache
def viewer_script():
    """Return meshcat's JavaScript viewer, compressed, as base64 text."""
    script = resources.files("meshcat").joinpath("viewer", "dist", "main.min.js").read_bytes()
    return _packed(script)


def _packed(data):
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")


class _Recorder:
    """Takes the place of meshcat's window: keeps the commands instead of sending them to a server."""

    def __init__(self):
        self.commands = []

    def send(self, command):
        element = getattr(command, "object", None)
        if element is not None:
            # meshcat draws identifiers at random; fixed ones make the same page of the same scene, and a smaller one
            element.uuid, element.geometry.uuid, element.material.uuid = "object", "geometry", "material"
        self.commands.append(command.lower())


def commands(nodes, grid):
    """Return the meshcat commands (dicts) that draw `nodes` and the lines of the `grid` (Nx2x3, fixed frame)."""
    import meshcat
    from meshcat import geometry as g

    recorder = _Recorder()
    root = meshcat.Visualizer(window=recorder)
    for path in ("/Grid", "/Axes", "/Background"):
        root[path].set_property("visible", False)
    behind = g.LineBasicMaterial(color=GRID_COLOR, depthTest=False, depthWrite=False)
    lines = np.reshape(grid, (-1, 3)).T.astype(np.float32)
    root["grid"].set_object(g.LineSegments(g.PointsGeometry(lines), behind))
    root["grid"]["<object>"].set_property("renderOrder", -1)  # drawn first, so that all else covers it
    solids = {
        "box": g.Box([1, 1, 1]),
        "sphere": g.Sphere(0.5),
        "cylinder": g.Cylinder(1, 0.5),
        "cone": g.Cylinder(1, radiusTop=0, radiusBottom=0.5),
    }
    for node in nodes:
        here = root[node.path]
        here.set_transform(node.transform)
        for i, solid in enumerate(node.solids):
            r, g_, b, opacity = solid.color
            color = sum(round(255 * value) << shift for value, shift in ((r, 16), (g_, 8), (b, 0)))
            part = here[f"solid{i}"]
            part.set_object(solids[solid.kind], g.MeshLambertMaterial(color=color, opacity=opacity))
            upright = ALONG_Y if solid.kind in ("cylinder", "cone") else np.eye(4)
            part.set_transform(solid.matrix @ upright)
        for i, cloud in enumerate(node.clouds):
            # three.js takes the size for that of a point seen with a field of view of 90 degrees
            points, colors = cloud.points.T.astype(np.float32), cloud.colors[:, :3].T.astype(np.float32)
            here[f"cloud{i}"].set_object(g.PointCloud(points, colors, size=cloud.size / math.tan(FIELD_OF_VIEW / 2)))
    return recorder.commands


def render(nodes, grid, camera):
    """Return the interactive page (text) of `nodes` and `grid`, first seen by `camera`. It shows no still picture."""
    import umsgpack

    labels = [(label, node) for node in nodes for label in node.labels]
    packets = [umsgpack.packb(command) for command in commands(nodes, grid)]
    view = {
        "script": viewer_script(),
        "commands": _packed(b"".join(struct.pack(">I", len(packet)) + packet for packet in packets)),
        "eye": camera.eye.tolist(),
        "target": camera.target.tolist(),
        "lens": {
            "fov": math.degrees(FIELD_OF_VIEW),
            "near": camera.distance / 100,
            "far": camera.distance * 100,
        },
        "labels": [
            {
                "path": ["meshcat", *node.path.split("/")],
                "text": label.text,
                "position": np.round(label.position, 6).tolist(),
                "beside": label.beside,
                "color": "rgb({:.0f} {:.0f} {:.0f})".format(*(255 * value for value in label.color[:3])),
            }
            for label, node in sorted(labels, key=lambda pair: pair[0].beside)
        ],
        "beside": BESIDE,
    }
    # "</" would end the script element
    return PAGE.replace("VIEW", json.dumps(view).replace("</", "<\\/"), 1)


def over_picture(page, picture, description, caption, aspect):
    """Return HTML that shows `page` in a frame over `picture` (PNG bytes), whose alternative text is `description`."""
    source = base64.b64encode(picture).decode("ascii")
    return (
        '<figure style="margin: 0; max-width: 760px">'
        f'<div style="position: relative; aspect-ratio: {aspect:g}; background: white">'
        f'<img src="data:image/png;base64,{source}" alt="{html.escape(description)}" width="100%">'
        f'<iframe srcdoc="{html.escape(page)}" title="{html.escape(caption)}" loading="lazy"'
        ' style="position: absolute; inset: 0; width: 100%; height: 100%; border: 0"></iframe>'
        f"</div><figcaption>{html.escape(caption)}</figcaption></figure>"
    )
