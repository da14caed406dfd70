"""Scenes in JupyterLab as people look at them: wherever the sliders stand, by keyboard, dark, in a narrow window, on paper.

Screenshots go to screenshots/, to be looked at.
"""

import re

import pytest
from jupyter_lab import Opened, Server
from support import ROOT, wait_for
from transform_lab import Viewer

NOTEBOOKS = [path.stem for path in sorted((ROOT / "notebooks/transforms").glob("*.ipynb"))]
SCREENSHOTS = ROOT / "screenshots"
# Pairs of labels of which one covers more of the other than its rim
COVERED = """() => {
  const boxes = [...document.querySelectorAll(".label")].filter(label => label.style.visibility !== "hidden").map(label => {
    const {left, right, top, bottom} = label.getBoundingClientRect(), rim = 0.075;
    const [w, h] = [right - left, bottom - top];
    return {text: label.textContent, left: left + rim * w, right: right - rim * w, top: top + rim * h, bottom: bottom - rim * h};
  });
  return boxes.flatMap((one, i) => boxes.slice(0, i).filter(other => one.left < other.right && other.left < one.right
    && one.top < other.bottom && other.top < one.bottom).map(other => [one.text, other.text]));
}"""

NAME = "control => control.getAttribute('aria-label') || control.labels?.[0]?.firstChild.textContent || control.textContent"
LINES = """cells => cells.map(cell => {
  const words = document.createRange();
  words.selectNodeContents(cell);
  return new Set([...words.getClientRects()].map(part => Math.round(part.bottom))).size;
})"""


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    running = Server(tmp_path_factory.mktemp("jupyter") / "work")
    yield running
    running.stop()


def looks(scene):
    """Yield a word for the scene as it opens, and with each of its sliders and lists at either end."""
    yield "start"
    for number, control in enumerate(scene.locator("#bar div:nth-child(n+2) :is(input, select)").all()):
        for key in ("Home", "End"):
            control.press(key)
            scene.wait_for_timeout(150)
            yield f"{number}_{key.lower()}"


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_no_label_covers_another_wherever_the_sliders_stand(page, server, name):
    notebook = Opened(page, server, name)
    notebook.run_all()
    SCREENSHOTS.mkdir(exist_ok=True)
    found = []
    for figure in notebook.figures():
        scene = notebook.scene(figure)
        for look in looks(scene):
            found += [(figure, look, *pair) for pair in scene.evaluate(COVERED)]
            scene.frame_element().screenshot(path=SCREENSHOTS / f"look_{name}_{figure}_{look}.png")
    assert not found, "\n".join(map(str, ["", *found]))


def test_every_control_is_reached_and_named_by_the_keyboard(page, server):
    notebook = Opened(page, server, "3_chaining")
    notebook.run_all()
    for figure in notebook.figures():
        scene = notebook.scene(figure)
        controls = scene.locator("#bar :is(input, select, button)")
        controls.first.focus()
        names = []
        for number in range(controls.count()):
            assert controls.nth(number).evaluate("control => control === document.activeElement")
            names.append(controls.nth(number).evaluate(NAME))
            page.keyboard.press("Tab")
        assert all(names) and names[:2] == ["Fixed frame", "Seen from"]


def test_the_line_below_names_the_fixed_frame_that_was_chosen(page, server):
    notebook = Opened(page, server, "2_homogeneous_transforms")
    notebook.run_all()
    scene = notebook.scene(notebook.figures()[0])
    caption = scene.frame_element().evaluate_handle("frame => frame.closest('figure').querySelector('figcaption')")
    assert caption.inner_text().startswith("Fixed frame frame_a. Axes")
    scene.get_by_label("Fixed frame").select_option("frame_b")
    assert caption.inner_text().startswith("Fixed frame frame_b. Axes")


def test_a_value_and_the_text_follow_the_arrow_keys(page, server):
    notebook = Opened(page, server, "1_rotation")
    notebook.run_all()
    scene = notebook.scene_with("input[name=degrees]")
    slider, text = scene.locator("input[name=degrees]"), scene.locator("#text")
    said, before = slider.get_attribute("aria-valuetext"), text.inner_text()
    slider.press("ArrowRight")
    wait_for(lambda: text.inner_text() != before)
    assert slider.get_attribute("aria-valuetext") != said and text.get_attribute("aria-live") == "polite"


def test_scenes_follow_the_theme(page, server):
    notebook = Opened(page, server, "1_rotation")
    notebook.run_all()
    scene = notebook.scene(notebook.figures()[1])
    body = "document.body.className"
    assert scene.evaluate(body) == "light"
    for theme, shown in (("JupyterLab Dark", "dark"), ("JupyterLab Light", "light")):
        page.evaluate("theme => window.jupyterapp.commands.execute('apputils:change-theme', {theme})", theme)
        wait_for(lambda: scene.evaluate(body) == shown)
        page.screenshot(path=SCREENSHOTS / f"theme_{shown}.png")


@pytest.mark.parametrize("width", [700, 1200])
def test_no_number_is_broken_on_a_narrow_window(page, server, width):
    page.set_viewport_size({"width": width, "height": 900})
    notebook = Opened(page, server, "2_homogeneous_transforms")
    notebook.run_all()
    last = page.evaluate("() => window.jupyterapp.shell.currentWidget.content.model.cells.length - 1")
    page.evaluate("i => window.jupyterapp.shell.currentWidget.content.scrollToItem(i, 'center')", last)
    points = page.locator(".jp-OutputArea-output table td:nth-child(3)")
    points.first.wait_for()
    page.screenshot(path=SCREENSHOTS / f"width_{width}.png")
    assert set(points.evaluate_all(LINES)) == {1}, "points are broken into two lines"
    codes = page.locator(".jp-OutputArea-output table code")
    assert set(codes.evaluate_all("codes => codes.map(code => code.getClientRects().length)")) == {1}, (
        "a name is broken"
    )


def test_on_paper_the_still_pictures_are_printed(page, server):
    notebook = Opened(page, server, "4_inversion")
    notebook.run_all()
    scene = notebook.scene(notebook.figures()[0])
    page.emulate_media(media="print")
    hidden = "[...document.querySelectorAll('body, .label')].map(one => getComputedStyle(one).visibility)"
    assert set(scene.evaluate(hidden)) == {"hidden"}
    assert re.match(
        "rgba\\(0, 0, 0, 0\\)|transparent", scene.evaluate("getComputedStyle(document.body).backgroundColor")
    )
    page.emulate_media(media="screen")
    assert scene.evaluate("getComputedStyle(document.body).visibility") == "visible"


def test_of_many_scenes_those_that_are_looked_at_are_alive(page):
    """A browser lets the oldest scene go when there are some sixteen of them on one page."""
    viewer = Viewer("frame_a", length=1.0)
    page.set_content("<style>figure { height: 600px }</style>" + viewer.figure() * 20)
    places = page.locator("iframe")

    def alive(number):
        frame = places.nth(number).element_handle().content_frame()
        return frame and frame.evaluate(
            "() => window.viewer && document.body.className && document.body.style.visibility !== 'hidden'"
            " && !viewer.renderer.getContext().isContextLost()"
        )

    for number in range(20):
        places.nth(number).scroll_into_view_if_needed()
        wait_for(lambda: alive(number))
    assert not alive(0)
    for number in (0, 1, 19):
        places.nth(number).scroll_into_view_if_needed()
        wait_for(lambda: alive(number))
