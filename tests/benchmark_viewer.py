"""How large and how fast the viewer's figures are: `python tests/benchmark_viewer.py [--against REVISION]`.

Prints what the solved notebooks weigh, saved with their outputs and exported (goal: at most 800 kB each); the CPU seconds
of importing transform_lab, of the first figure and of later ones (goals: 0.25, 0.5, 0.1), here and, in turn, in another
revision; for each kind of figure, the size of its HTML and the median time to make it; how many changes a second the
kernel can turn into messages; and, with Chromium, how many a second arrive and are drawn while a slider is dragged in
JupyterLab (goal: at least 25; here the graphics are computed without a graphics card). `--smallest` measures everything for
a moment, to see that it works.
"""

import argparse
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "source/transforms"))

import nbformat
import numpy as np
from nbclient import NotebookClient
from nbconvert import HTMLExporter
from rich.console import Console
from rich.table import Table
from transform_lab import (
    Point,
    Pose,
    Quaternion,
    Viewer,
    animate_approach,
    animate_chain,
    animate_inverse,
    animate_rotation,
    tft,
)
from transform_lab.viewing.drawing import draw
from transform_lab.viewing.meshcat_commands import block, changes, properties
from transform_lab.viewing.page import labels

ROOT = Path(__file__).resolve().parent.parent
parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--against", metavar="REVISION", help="measure this revision, too")
parser.add_argument("--smallest", action="store_true", help="measure everything for a moment")
options = parser.parse_args()
REPEATS = 1 if options.smallest else 7
# What is run in a process of its own: importing alone, then figures, the last of which is measured.
FIGURE = """
import sys, time
import numpy as np
from transform_lab import Viewer, animate_rotation
def moving(): return animate_rotation([0.5, 0.5, 0.5, 0.5])
def still():
    viewer = Viewer("a")
    viewer.add_frame("b", np.array([[0.0, -1, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0.2], [0, 0, 0, 1]]))
    return viewer
for make in {made}:
    start = time.process_time()
    make()._repr_mimebundle_()
print(time.process_time() - start)
"""
TIMED = {
    "import transform_lab": None,
    "first figure": "[still]",
    "first figure, an animation": "[moving]",
    "later figure": "[still] * 5",
    "later figure, an animation": "[still] + [moving] * 5",
}
STEP = np.array([[0.0, -1, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0.2], [0, 0, 0, 1]])
OBJECT = Pose(Point(0.6, -0.1, 0.7), Quaternion(0, 0, 0.38268343, 0.92387953))
STOP = Pose(Point(0.529289, -0.170711, 0.7), Quaternion(0, 0, 0.38268343, 0.92387953))


def turn(scene, degrees):
    scene.add_frame("b", tft.rotation_matrix(np.radians(degrees), [0, 0, 1]))
    return scene.lookup("a", "b")


def chain():
    viewer = Viewer("A")
    for parent, child in ["AB", "BC", "CD", "DE"]:
        viewer.add_frame(child, STEP, parent=parent)
    return viewer


def figures():
    """The viewers that are measured, by a name."""
    frames = Viewer("a")
    frames.add_frame("b", STEP)
    grasp = Viewer("base_link")
    grasp.add_frame("object", OBJECT, length=0.05)
    grasp.add_box("object", (0.04, 0.04, 0.1), frame="object")
    grasp.add_frame("pre-grasp", STOP, length=0.05)
    grasp.add_gripper("pre-grasp")
    return {
        "two frames": frames,
        "five frames": chain(),
        "pre-grasp with a gripper": grasp.look(at=["object", "pre-grasp"]),
        "a rotation grows": animate_rotation([0.5, 0.5, 0.5, 0.5]),
        "a chain, link by link": animate_chain(STEP, STEP, STEP, STEP),
        "an inverse from both sides": animate_inverse(STEP),
        "an approach, right and wrong": animate_approach(OBJECT, STOP, OBJECT),
        "a slider of 361 places": Viewer("a").interact(turn, degrees=(-180, 180)),
    }


def cpu(made, root):
    """CPU seconds of importing transform_lab as it is in `root`, the interpreter's start included, or of a figure."""
    environment = {**os.environ, "PYTHONPATH": str(root / "source/transforms")}
    code = "import transform_lab" if made is None else FIGURE.format(made=made)
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run([sys.executable, "-c", code], env=environment, cwd=root, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return used if made is None else float(run.stdout)


def weights(path):
    """Bytes of a solved notebook with its outputs, and of the page that nbconvert makes of it."""
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, resources={"metadata": {"path": str(path.parent)}}, store_widget_state=False).execute()
    page, _ = HTMLExporter().from_notebook_node(notebook)
    return len(nbformat.writes(notebook).encode()), len(page.encode())


def compared(roots):
    """Tables of the CPU seconds and of the notebooks' sizes in these folders, {revision: folder}."""
    times = Table("CPU seconds", *roots)
    for what, made in TIMED.items():
        rounds = [[cpu(made, root) for root in roots.values()] for _ in range(REPEATS)]
        times.add_row(what, *(f"{statistics.median(column):.3f}" for column in zip(*rounds)))
    sizes = Table("solved notebook, saved / exported (kB)", *roots)
    for path in sorted((ROOT / "source/transforms").glob("*.ipynb"))[: 1 if options.smallest else None]:
        found = [weights(root / path.relative_to(ROOT)) for root in roots.values()]
        sizes.add_row(path.stem, *(" / ".join(f"{size / 1000:.0f}" for size in pair) for pair in found))
    return times, sizes


def kernel_rate(seconds):
    """How many changes a second are turned into messages: one frame of five turns."""
    viewer, count, start = chain(), 0, time.perf_counter()
    sent = properties(draw(viewer, 0.5).nodes)
    while time.perf_counter() - start < seconds:
        viewer.add_frame("B", STEP @ tft.rotation_matrix(count / 100, [0, 0, 1]), parent="A")
        nodes = draw(viewer.state(), 0.5).nodes
        now = properties(nodes)
        block(changes(sent, now)), labels(nodes)
        sent, count = now, count + 1
    return count / (time.perf_counter() - start)


def browser_rate(seconds):
    """How many changes a second are drawn in JupyterLab while the slider of notebook 1 is dragged."""
    from jupyter_lab import Opened, Server
    from playwright.sync_api import sync_playwright
    from support import CHROMIUM_FLAGS, PATIENCE, SOFTWARE_WEBGL, chromium_here

    if not chromium_here():
        return None
    temporary = tempfile.TemporaryDirectory()
    server = Server(Path(temporary.name) / "work")
    try:
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(
                executable_path=chromium_here(), args=[*CHROMIUM_FLAGS, *SOFTWARE_WEBGL]
            )
            page = browser.new_page(viewport={"width": 1100, "height": 900})
            page.set_default_timeout(1000 * PATIENCE)
            notebook = Opened(page, server, "1_rotation")
            notebook.run_all()
            scene = notebook.scene_with("input[name=degrees]")
            return scene.evaluate(
                """most => new Promise(done => {
                  const slider = document.querySelector("input[name=degrees]"), start = performance.now();
                  let heard = 0, at = 0;
                  addEventListener("message", event => heard += event.data?.from === "kernel");
                  (function drag() {
                    slider.value = ++at % (+slider.max + 1);
                    slider.dispatchEvent(new Event("input"));
                    const seconds = (performance.now() - start) / 1000;
                    seconds < most ? setTimeout(drag, 8) : done(heard / seconds);
                  })();
                })""",
                seconds,
            )
    finally:
        server.stop()
        temporary.cleanup()


def figure_table():
    table = Table("figure", "HTML (kB)", "time (ms)")
    for name, viewer in figures().items():
        viewer.figure()
        times = []
        for _ in range(REPEATS):
            start = time.perf_counter()
            size = len(viewer.figure())
            times.append(1000 * (time.perf_counter() - start))
        table.add_row(name, f"{size / 1000:.0f}", f"{statistics.median(times):.0f}")
    return table


if __name__ == "__main__":
    console, roots = Console(), {"here": ROOT}
    with tempfile.TemporaryDirectory() as folder:
        git = ["git", "-C", str(ROOT), "worktree"]
        if options.against:
            roots[options.against] = Path(folder, "other")
            subprocess.run(
                [*git, "add", "--quiet", "--detach", str(roots[options.against]), options.against], check=True
            )
        try:
            console.print(*compared(roots), sep="\n")
        finally:
            if options.against:
                subprocess.run([*git, "remove", "--force", str(roots[options.against])], check=True)
    console.print(figure_table())
    console.print(f"changes a second, made by the kernel: {kernel_rate(0.1 if options.smallest else 2):.0f}")
    rate = browser_rate(1 if options.smallest else 5)
    seen = f"{rate:.0f}" if rate is not None else "not measured, for there is no Chromium"
    console.print(f"changes a second, drawn while a slider is dragged in JupyterLab: {seen}")
