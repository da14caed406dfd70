"""The notebooks in a real browser: JupyterLab and Notebook 7 as students open them, saved copies, feedback pages.

The server runs under /user/x/, as behind a JupyterHub. Screenshots go to screenshots/, to be looked at.
"""

import io
import re
import shutil
import subprocess
import sys

import nbformat
import numpy as np
import pytest
from jupyter_lab import Opened, Server, drawn
from PIL import Image
from support import ROOT, wait_for
from transform_lab import tft
from transform_lab.animations import between
from transform_lab.viewing.page import packed

NOTEBOOKS = [path.stem for path in sorted((ROOT / "notebooks/transforms").glob("*.ipynb"))]
SCREENSHOTS = ROOT / "screenshots"
FRAME = "name => viewer.scene_tree.find(['meshcat', 'frames', name]).object.matrix.elements"
ROOT_MATRIX = (
    "() => { const o = viewer.scene_tree.find(['meshcat']).object; o.updateMatrix(); return o.matrix.elements }"
)


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    running = Server(tmp_path_factory.mktemp("jupyter") / "work")
    yield running
    running.stop()


def frame_in(scene, name):
    """The 4x4 matrix of a frame in the root frame, as the browser has it."""
    return np.reshape(scene.evaluate(FRAME, name), (4, 4)).T


def picture(scene, name):
    """Take a screenshot of a scene; return the part of its picture in which something is drawn, but for words."""
    SCREENSHOTS.mkdir(exist_ok=True)
    scene.frame_element().screenshot(path=SCREENSHOTS / f"{name}.png")
    words = scene.add_style_tag(content=".label, #text { display: none }")
    pixels = np.asarray(Image.open(io.BytesIO(scene.locator("canvas").screenshot())).convert("RGB")).astype(int)
    words.evaluate("style => style.remove()")
    return (np.ptp(pixels, axis=2) > 60).mean()  # red, green, blue: neither white nor the grey of the grid


def until(scene, name, expected):
    """Wait until a frame of the scene is at `expected`, a 4x4 matrix, as it comes from the kernel."""
    wait_for(lambda: np.allclose(frame_in(scene, name), expected, atol=1e-6))


def about_z(degrees):
    return tft.rotation_matrix(np.radians(degrees), [0, 0, 1])


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_run_all_in_jupyterlab(page, server, name):
    notebook = Opened(page, server, name)
    notebook.run_all()
    figures = notebook.figures()
    assert len(figures) >= 2
    for i in figures:
        scene = notebook.scene(i)
        frames = scene.evaluate("() => Object.keys(viewer.scene_tree.find(['meshcat', 'frames']).children)")
        assert frames
        assert picture(scene, f"{name}_{i}") > 0.0015, i
    notebook.command("docmanager:save")


def test_a_slider_turns_a_frame_while_it_is_dragged(page, server):
    notebook = Opened(page, server, "1_rotation")
    notebook.run_all()
    scene = notebook.scene_with("input[name=degrees]")
    before = frame_in(scene, "frame_b")
    slider = scene.locator("input[name=degrees]")
    box = slider.bounding_box()
    middle = box["y"] + box["height"] / 2
    page.mouse.move(box["x"] + box["width"] / 2, middle)
    page.mouse.down()
    for step in range(20):
        page.mouse.move(box["x"] + box["width"] * (0.5 + step / 50), middle)
    page.mouse.up()
    degrees = float(scene.locator("output").inner_text())
    until(scene, "frame_b", about_z(degrees))
    assert degrees > 90 and not np.allclose(about_z(degrees), before)
    numbers = [float(number) for number in re.findall(r"-?\d+\.\d*", scene.locator("#text").inner_text())]
    np.testing.assert_allclose(numbers, about_z(degrees)[:3, :3].ravel(), atol=1e-3)  # what the function returned
    picture(scene, "slider")


LIVE = """
import ipywidgets, numpy as np, time
from transform_lab import Viewer, tft
def turn(scene, degrees, axis="z"):
    if degrees == 13:
        raise ValueError("thirteen")
    scene.add_frame("b", tft.rotation_matrix(np.radians(degrees), [0, 0, 1] if axis == "z" else [1, 0, 0]))
turned = Viewer("a").interact(turn, degrees=(0, 360), axis=["z", "x"])
turned
""", """
turned  # again
""", """
followed = Viewer("a")
followed.add_frame("b", np.eye(4))
followed.show(live=True)
slider = ipywidgets.IntSlider(max=360)
slider.observe(lambda change: followed.add_frame("b", tft.rotation_matrix(np.radians(change.new), [0, 0, 1])), "value")
slider
""", """
for i in range(1001):
    followed.add_frame("b", tft.translation_matrix([i / 1000, 0, 0]))
""", """
for i in range(30):
    print("line", i)
    time.sleep(0.05)
"""  # fmt: skip


@pytest.fixture
def live(page, server):
    """A notebook with live scenes, all its cells run."""
    written(server, "live", LIVE)
    notebook = Opened(page, server, "live")
    notebook.run_all()
    return notebook


def test_a_scene_follows_its_viewer(page, live):
    scene = live.scene(2)
    until(scene, "b", tft.translation_matrix([1, 0, 0]))  # after 1,001 changes it shows the last one
    slider = page.locator(".jupyter-widgets [role=slider]").first
    slider.focus()
    slider.press("ArrowRight")
    until(scene, "b", about_z(1))
    sizes = page.evaluate(
        """() => [...window.jupyterapp.shell.currentWidget.content.model.cells]
          .map(cell => JSON.stringify(cell.sharedModel.toJSON().outputs).length)"""
    )
    assert sizes[3] < 100 and sizes[2] < 400_000  # the changes have not made the output grow


def test_scene_and_slider_agree(live):
    scene = live.scene(0)
    slider = scene.locator("input[name=degrees]")
    slider.fill("13")
    scene.wait_for_function("() => document.getElementById('text').textContent === 'ValueError: thirteen'")
    for degrees in range(301, 306):  # not among those computed beforehand, so the kernel has answered
        slider.fill(str(degrees))
        until(scene, "b", about_z(degrees))
    # the browser drops the scene, so that the picture is seen, and it comes back when it is wanted again
    scene.evaluate("() => { viewer.renderer.getContext().getExtension('WEBGL_lose_context').loseContext() }")
    scene.wait_for_function("() => document.body.className === ''")
    assert not scene.locator("canvas").is_visible()
    scene.evaluate("() => { document.documentElement.dispatchEvent(new Event('mouseenter')) }")
    scene = live.scene(0)
    shown = float(scene.locator("output").inner_text())
    until(scene, "b", about_z(shown))
    other = live.scene(1)  # the same viewer, shown before the slider was moved
    shown = float(other.locator("output").inner_text())
    other.locator("input[name=degrees]").fill("77")
    until(other, "b", about_z(77))


def test_dragging_does_not_disturb_a_cell_that_runs(page, live):
    scene = live.scene(0)
    page.evaluate("() => { window.jupyterapp.shell.currentWidget.content.activeCellIndex = 4 }")
    live.command("notebook:run-cell")
    for degrees in range(100, 200, 2):
        scene.locator("input[name=degrees]").fill(str(degrees))
    until(scene, "b", about_z(198))
    live.wait_until_idle()
    printed = page.evaluate(
        "() => window.jupyterapp.shell.currentWidget.content.model.cells.get(4).sharedModel.toJSON().outputs"
    )
    assert "".join(output["text"] for output in printed).split() == [w for i in range(30) for w in ("line", str(i))]


def test_a_drop_down_without_a_kernel_shows_what_was_computed(server, live):
    scene = live.scene(0)
    scene.locator("input[name=degrees]").fill("90")
    until(scene, "b", about_z(90))
    server.stop_kernels()
    scene.locator("select[name=axis]").select_option(label="x")
    scene.wait_for_function("() => viewer.scene_tree.find(['meshcat', 'frames', 'b']).object.matrix.elements[6] > 0.9")


def test_any_frame_can_be_the_fixed_one(page, server):
    notebook = Opened(page, server, "3_chaining")
    notebook.run_all()
    scene = notebook.scene(notebook.figures()[1])  # one link of the chain; in the first, frames come one by one
    before = scene.evaluate("() => viewer.camera.position.toArray()")
    scene.locator("select").first.select_option(label="C")
    assert scene.evaluate("() => viewer.camera.position.toArray()") != before
    root_T_c = frame_in(scene, "C")
    c_T_root = np.reshape(scene.evaluate(ROOT_MATRIX), (4, 4)).T
    np.testing.assert_allclose(c_T_root @ root_T_c, np.eye(4), atol=1e-6)
    before = scene.evaluate("() => viewer.camera.position.toArray()")
    scene.locator("select").nth(1).select_option(label="above")
    assert scene.evaluate("() => viewer.camera.position.toArray()") != before
    picture(scene, "fixed_frame_above")


def test_an_animation_plays(page, server):
    notebook = Opened(page, server, "3_chaining")
    notebook.run_all()
    scene = notebook.scene_with("button")
    play(scene)


def play(scene):
    """Play the staircase of notebook 3, from its first frame to its last."""
    end = frame_in(scene, "B")
    scene.evaluate(
        """() => {
          window.seen = [];
          const render = viewer.render;
          viewer.render = () => { render(); seen.push(viewer.scene_tree.find(['meshcat', 'frames', 'B']).object.position.x) };
        }"""
    )
    scene.locator("button").click()
    scene.wait_for_function("() => seen.length && document.querySelector('button').textContent.includes('Play')")
    places = scene.evaluate("() => seen")
    assert places[0] < 0.5 and places == sorted(places)
    np.testing.assert_allclose(frame_in(scene, "B"), end, atol=1e-6)
    np.testing.assert_allclose(frame_in(scene, "E")[:3, 3], [0, 0, 0.8], atol=1e-6)
    scene.locator("input[type=range]").fill("2.5")  # between two of the moments computed beforehand
    until(scene, "B", between(np.eye(4), end, 2.5 / 6))


def saved(page, server, name, copy):
    """Run a notebook, save it, stop its kernel; return the path of a copy of the file."""
    notebook = Opened(page, server, name)
    notebook.run_all()
    notebook.command("docmanager:save")
    path = server.folder / f"{name}.ipynb"
    wait_for(lambda: page.wait_for_timeout(50) or "<iframe" in path.read_text())
    page.wait_for_timeout(500)
    server.stop_kernels()
    target = server.folder / f"{copy}.ipynb"
    shutil.copy(path, target)
    return target


def test_a_saved_notebook_without_a_kernel(page, server, tmp_path):
    path = saved(page, server, "3_chaining", "saved")
    exported = subprocess.run(
        [sys.executable, "-m", "nbconvert", "--to", "html", "--output-dir", tmp_path, path],
        capture_output=True,
        text=True,
    )
    assert exported.returncode == 0, exported.stderr
    page.goto((tmp_path / "saved.html").as_uri())
    places = page.locator("iframe")
    scenes = []
    for i in range(places.count()):
        places.nth(i).scroll_into_view_if_needed()
        scenes.append(drawn(places.nth(i)))
    play(next(scene for scene in scenes if scene.query_selector("button")))


def test_controls_of_a_saved_notebook_show_what_was_computed_beforehand(page, server):
    saved(page, server, "1_rotation", "kept")
    notebook = Opened(page, server, "1_rotation", fresh=False)  # with a new kernel, which knows nothing
    scene = notebook.scene_with("input[name=degrees]")
    scene.locator("input[name=degrees]").fill("0")
    until(scene, "frame_b", about_z(-180))
    assert scene.locator("#text").inner_text().startswith("[[-1.")


FIGURES = """
from transform_lab import Viewer, tft
def frame(x):
    viewer = Viewer("a")
    viewer.add_frame("b", tft.translation_matrix([x, 0, 0]))
    return viewer
""", "frame(1)", "frame(2)", "frame(3)", "frame(4)"  # fmt: skip
TO_TURN = "To turn this, show the notebook’s first figure, or restart and run all cells."


def written(server, name, cells):
    """Write a notebook of these cells."""
    python = {"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}}
    code = [nbformat.v4.new_code_cell(source.strip()) for source in cells]
    nbformat.write(nbformat.v4.new_notebook(cells=code, metadata=python), server.folder / f"{name}.ipynb")


def four_figures(page, server, name="four"):
    """A notebook with four figures, all its cells run; the first two carry what draws them."""
    written(server, name, FIGURES)
    notebook = Opened(page, server, name)
    notebook.run_all()
    assert shown_in(notebook) == [1, 2, 3, 4]
    return notebook


def reopened(page, server, notebook, forget=True):
    """Save a notebook, and open it as on another day, without its kernel, and by default on another machine."""
    notebook.command("docmanager:save")
    page.goto(f"{server.url}/api")  # a page in which nothing carries anything
    if forget:
        page.evaluate("() => localStorage.clear()")
    return Opened(page, server, notebook.name, fresh=False)


def shown_in(notebook):
    """Where the frame b is in each figure: its number."""
    return [round(frame_in(notebook.scene(i), "b")[0, 3]) for i in notebook.figures()]


def waiting(notebook, cell):
    """The frame of a figure that has nothing to draw it yet: it says what to do, and the picture is seen."""
    place = notebook.place(cell)
    frame = place.element_handle().content_frame()
    frame.get_by_text(TO_TURN).wait_for()
    assert frame.evaluate("() => getComputedStyle(document.body).backgroundColor") == "rgba(0, 0, 0, 0)"
    assert place.evaluate("frame => frame.parentElement.querySelector('img').naturalWidth") > 700
    return frame


def first_moved_to_the_end(notebook):
    notebook.activate(1)
    notebook.command("notebook:cut-cell")
    notebook.activate(3)
    notebook.command("notebook:paste-cell-below")


def first_deleted(notebook):
    notebook.activate(1)
    notebook.command("notebook:delete-cell")


def first_cleared(notebook):
    notebook.activate(1)
    notebook.command("notebook:clear-cell-output")


def last_copied_to_the_top(notebook):
    notebook.activate(4)
    notebook.command("notebook:copy-cell")
    notebook.activate(0)
    notebook.command("notebook:paste-cell-above")


@pytest.mark.parametrize(
    "change, expected",
    [
        (lambda notebook: None, [1, 2, 3, 4]),
        (first_moved_to_the_end, [2, 3, 4, 1]),
        (first_deleted, [2, 3, 4]),
        (first_cleared, [2, 3, 4]),
        (last_copied_to_the_top, [4, 1, 2, 3, 4]),
    ],
)
def test_figures_live_on_in_a_saved_notebook(page, server, change, expected):
    notebook = four_figures(page, server)
    change(notebook)
    assert shown_in(notebook) == expected
    assert shown_in(reopened(page, server, notebook)) == expected


def test_figures_without_what_draws_them_are_pictures_until_it_comes(page, server):
    notebook = four_figures(page, server)
    for _ in range(2):
        first_deleted(notebook)
    notebook = reopened(page, server, notebook)
    frame = waiting(notebook, 1)
    page.screenshot(path=SCREENSHOTS / "waiting.png")
    notebook.wait_until_idle()
    for cell in (0, 2):  # a new kernel's first figure carries
        notebook.activate(cell)
        notebook.command("notebook:run-cell")
    notebook.wait_until_idle()
    frame.wait_for_function("() => document.body.className")
    assert shown_in(notebook) == [3, 4] and frame.get_by_text(TO_TURN).count() == 0


@pytest.mark.parametrize("others", [FIGURES, ("1 + 1",)], ids=["with figures", "without"])
def test_a_figure_copied_into_another_notebook(page, server, others):
    notebook = four_figures(page, server)
    notebook.activate(4)
    notebook.command("notebook:copy-cell")
    written(server, "mine", others)
    page.evaluate("() => { window.jupyterapp.commands.execute('docmanager:open', {path: 'mine.ipynb'}) }")
    page.wait_for_function("() => jupyterapp.shell.currentWidget?.context?.path === 'mine.ipynb'")
    page.wait_for_function("() => jupyterapp.shell.currentWidget.context.isReady")
    mine = Opened.__new__(Opened)
    mine.page, mine.name = page, "mine"
    mine.run_all()
    mine.activate(len(others) - 1)
    mine.command("notebook:paste-cell-below")
    own = [1, 2, 3, 4] if others == FIGURES else []
    assert shown_in(mine) == [*own, 4]
    mine = reopened(page, server, mine, forget=False)
    assert shown_in(mine) == [*own, 4]  # this browser remembers what the first notebook's figures carried
    mine = reopened(page, server, mine)
    if own:
        assert shown_in(mine) == [*own, 4]
    else:
        waiting(mine, len(others))


def test_nothing_is_run_that_others_have_left_in_the_browser(page, server):
    notebook = four_figures(page, server)
    for _ in range(2):
        first_deleted(notebook)
    notebook = reopened(page, server, notebook, forget=False)
    assert shown_in(notebook) == [3, 4]
    notebook.command("docmanager:save")
    page.goto(f"{server.url}/api")
    evil = packed(b"parent.evil = document.body.innerHTML = 'evil'; showScene = () => {}")
    page.evaluate("evil => Object.keys(localStorage).forEach(key => localStorage[key] = evil)", evil)
    notebook = Opened(page, server, "four", fresh=False)
    waiting(notebook, 1)
    assert page.evaluate("() => window.evil") is None


def test_an_untrusted_copy_shows_the_pictures(page, server):
    path = saved(page, server, "4_inversion", "untrusted")
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        if cell.cell_type == "code":
            for output in cell.outputs:  # not what was signed when it was saved
                if "text/html" in output.get("data", {}):
                    output.data["text/html"] += "<p></p>"
    nbformat.write(notebook, path)
    opened = Opened(page, server, "untrusted")
    figures = opened.figures()
    assert figures
    for i in figures:
        page.evaluate("i => window.jupyterapp.shell.currentWidget.content.scrollToItem(i, 'center')", i)
        cell = page.locator(f'.jp-Cell[data-windowed-list-index="{i}"]')
        image = cell.locator("figure img, .jp-RenderedHTML img").first
        image.scroll_into_view_if_needed()
        assert image.evaluate("image => image.complete && image.naturalWidth") > 700
        assert image.get_attribute("alt").startswith("Scene in the fixed frame")
        assert cell.locator("iframe").count() == 0
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / "untrusted.png")


@pytest.mark.parametrize("name", ["glossary", "card", "conventions"])
def test_a_page_of_words_opens_as_it_is_read(page, server, name):
    Opened(page, server, "1_rotation")
    page.locator(f'.jp-Notebook a[href*="{name}.md"]').first.click()
    shown = page.locator(".jp-MarkdownViewer")
    shown.locator("table td").first.wait_for()
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / f"{name}.png")


def test_notebook_7(page, server):
    notebook = Opened(page, server, "2_homogeneous_transforms", at="notebooks")
    notebook.run_all()
    for i in notebook.figures():
        scene = notebook.scene(i)
        assert picture(scene, f"notebook_7_{i}") > 0.003


def test_feedback_opened_from_disk(page, course, hand_in, sandboxed):
    hand_in(course, "ada", {path.stem: path for path in sorted(course.release.glob("*.ipynb"))})
    command = [sys.executable, "-m", "autograder", "grade"]
    subprocess.run(command, cwd=course.root, check=True, capture_output=True, stdin=subprocess.DEVNULL, timeout=300)
    pages = sorted((course.feedback("ada")).glob("[0-9]*.html"))
    assert [page.stem for page in pages] == list(course.notebooks)
    SCREENSHOTS.mkdir(exist_ok=True)
    for path in pages:
        page.goto(path.as_uri())
        page.get_by_text("not done yet").first.wait_for()
        page.screenshot(path=SCREENSHOTS / f"feedback_{path.stem}.png")
