"""How large and how fast the viewer's figures are: `python tests/benchmark_viewer.py`.

Prints, for each kind of figure, the size of its HTML (goal: at most 350 kB) and the median time to make it once the
modules are imported (goal: at most 300 ms); how many changes a second the kernel can turn into messages; and, with
Chromium, how many a second arrive and are drawn while a slider is dragged in JupyterLab (goal: at least 25; here the
graphics are computed without a graphics card). `--smallest` measures everything for a moment, to see that it works.
"""

import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "source/transforms"))

import numpy as np
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

SMALLEST = "--smallest" in sys.argv
REPEATS = 1 if SMALLEST else 7
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


if __name__ == "__main__":
    table = Table("figure", "HTML (kB)", "time (ms)")
    for name, viewer in figures().items():
        viewer.figure()
        times = []
        for _ in range(REPEATS):
            start = time.perf_counter()
            size = len(viewer.figure())
            times.append(1000 * (time.perf_counter() - start))
        table.add_row(name, f"{size / 1000:.0f}", f"{statistics.median(times):.0f}")
    console = Console()
    console.print(table)
    console.print(f"changes a second, made by the kernel: {kernel_rate(0.1 if SMALLEST else 2):.0f}")
    rate = browser_rate(1 if SMALLEST else 5)
    seen = f"{rate:.0f}" if rate is not None else "not measured, for there is no Chromium"
    console.print(f"changes a second, drawn while a slider is dragged in JupyterLab: {seen}")
