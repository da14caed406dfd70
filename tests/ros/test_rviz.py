"""RViz is the measure of the viewer: the same markers, seen by the same camera, are drawn where RViz draws them."""

import io
from dataclasses import replace

import numpy as np
import pytest
import rviz as rviz_itself
from marker_cases import BLUE, DRAWN, UPRIGHT, WRITTEN, M, marker
from PIL import Image, ImageFilter
from support import lacking, wait_for
from transform_lab import tft
from transform_lab.messages import Marker, Point, Pose
from transform_lab.viewing import drawing, page, picture
from transform_lab.viewing.camera import Camera
from transform_lab.viewing.markers import ERROR, INFO, UNINITIALIZED, UNNORMALIZED, WARNING, rviz_says
from transform_lab.viewing.viewer import Viewer

BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
WIDTH, HEIGHT = 792, 495  # of our pictures
B_IN_A = (0, 0.5, 0.5)  # the origin of frame_b
LEVELS = {2: INFO, 4: WARNING, 8: ERROR}  # of rosgraph_msgs/Log
NEAR = 3  # pixels
UPWARD = Pose(Point(-0.6, 0, 0.6), UPRIGHT)
# Pixels for what has another shape by design: a line is a flat ribbon in RViz and a rod here; the points that RViz draws
# with Mesa, as on machines without a graphics card, are turned with the marker, with other drivers they stand upright.
FARTHER = {Marker.LINE_STRIP: 6, Marker.LINE_LIST: 5, Marker.POINTS: 6}
# What is not drawn alike; "Beside RViz" in viewer.py says how.
DIFFERENT = ["points of other width and height", "points without height", "sphere list, not round"]


@pytest.fixture(scope="module")
def rviz(slow):
    """RViz, with frame_b in frame_a."""
    if problem := rviz_itself.problem():
        lacking(problem)
    with rviz_itself.running(Camera(BOX, page.ASPECT), WIDTH, HEIGHT) as running:
        running.frame("frame_b", B_IN_A)
        yield running


def viewer_of(markers):
    """A viewer in which the markers were published."""
    viewer = Viewer("frame_a")
    viewer.add_frame("frame_b", tft.translation_matrix(B_IN_A))
    for each in markers:
        viewer.publish(each)
    return viewer


def markers_alone(viewer):
    """The Drawing of a viewer's markers, without axes, names and words, seen as RViz sees it."""
    (found,), _ = drawing.draw_all([viewer])
    nodes = [n if n.path.startswith("markers/") else replace(n, solids=[], labels=[]) for n in found.nodes]
    return drawing.Drawing(nodes, found.frames, BOX, "")


def still(viewer):
    """Our picture, as RViz's are."""
    nodes = markers_alone(viewer).nodes
    png = picture.render(nodes, np.zeros((1, 2, 3)), Camera(BOX, page.ASPECT))
    return np.array(Image.open(io.BytesIO(png)).convert("RGB"))


def seen(image, hue=None):
    """Where something is drawn on the white, or something red (0), green (1) or blue (2)."""
    image = image.astype(int)
    if hue is None:
        return image.min(axis=2) < 215
    return (image.argmax(axis=2) == hue) & (np.ptp(image, axis=2) > 60)


def distance(one, other):
    """How many pixels some part of `one` is away from the nearest of `other`; 99 for what is not near at all."""
    grown = Image.fromarray(other.astype(np.uint8) * 255)
    for pixels in range(0, 20):
        if (one & (np.array(grown) == 0)).sum() <= 2:  # a pixel or two of a thin edge
            return pixels
        grown = grown.filter(ImageFilter.MaxFilter(3))
    return 99


def difference(theirs, ours):
    """The largest distance between the outlines of all that is drawn, and of what is of each colour."""
    hues = [hue for hue in range(3) if seen(theirs, hue).any() and not _one_colour(theirs)]
    pairs = [(seen(theirs, hue), seen(ours, hue)) for hue in (None, *hues)]
    return max(max(distance(one, other), distance(other, one)) for one, other in pairs)


def _one_colour(image):
    """Whether all is of one colour: then the dark sides, which RViz draws black, belong to it."""
    return sum(seen(image, hue).any() for hue in range(3)) < 2


def tolerance(markers):
    return FARTHER.get(markers[-1].type, NEAR)


@pytest.mark.parametrize("name", [name for name in DRAWN if name not in DIFFERENT])
def test_a_marker_is_drawn_as_rviz_draws_it(rviz, name):
    assert difference(rviz.draw(DRAWN[name]), still(viewer_of(DRAWN[name]))) <= tolerance(DRAWN[name])


@pytest.mark.parametrize("name", DIFFERENT)
def test_what_is_said_to_differ_differs(rviz, name):
    assert difference(rviz.draw(DRAWN[name]), still(viewer_of(DRAWN[name]))) > tolerance(DRAWN[name])


def outline(image):
    """The first and last row and column of what is drawn; none where nothing is."""
    rows, columns = np.nonzero(seen(image))
    return [rows.min(), rows.max(), columns.min(), columns.max()] if len(rows) else []


@pytest.mark.parametrize("name", WRITTEN)
def test_a_text_is_as_high_and_where_it_is_in_rviz(rviz, name):
    """Its letters are of another font."""
    theirs, ours = outline(rviz.draw(WRITTEN[name])), outline(still(viewer_of(WRITTEN[name])))
    assert len(theirs) == len(ours)
    np.testing.assert_allclose(ours, theirs, atol=4)


def test_deleting_needs_no_frame(rviz):
    cubes = [marker(M.CUBE, (0.5, 0.5, 0.5), id=1), marker(M.CUBE, (0.5, 0.5, 0.5), UPWARD, id=2, color=BLUE)]
    for last in (Marker(ns="case", id=1, action=M.DELETE), Marker(action=M.DELETEALL)):
        assert seen(rviz.draw(cubes), 0).any()
        assert difference(rviz.more([last]), still(viewer_of([*cubes, last]))) <= NEAR


def test_a_marker_stays_where_its_frame_was_unless_it_is_locked_to_it(rviz):
    rviz.frame("moving", (0, 0, 0))
    cubes = [marker(M.CUBE, (0.5, 0.5, 0.5), frame="moving", id=1, frame_locked=True)]
    cubes += [marker(M.CUBE, (0.5, 0.5, 0.5), UPWARD, frame="moving", id=2, color=BLUE)]
    viewer = viewer_of([])
    viewer.add_frame("moving", np.eye(4))
    for each in cubes:
        viewer.publish(each)
    assert difference(rviz.draw(cubes), still(viewer)) <= NEAR
    rviz.frame("moving", (0.8, 0, 0))
    viewer.add_frame("moving", tft.translation_matrix((0.8, 0, 0)))
    wait_for(lambda: difference(rviz.more(), still(viewer)) <= NEAR)


def test_a_marker_waits_for_its_frame(rviz):
    waiting = marker(M.CUBE, (0.5, 0.5, 0.5), frame="late")
    viewer = viewer_of([waiting])
    assert not seen(rviz.draw([waiting])).any() and not seen(still(viewer)).any()
    rviz.frame("late", (0.5, 0, 0))
    viewer.add_frame("late", tft.translation_matrix((0.5, 0, 0)))
    assert seen(still(viewer), 0).any()
    wait_for(lambda: difference(rviz.more(), still(viewer)) <= NEAR)


def test_a_lifetime_ends_in_rviz_alone(rviz):
    """It is said so of `publish`."""
    brief = marker(M.CUBE, (0.5, 0.5, 0.5), lifetime=0.5)
    assert seen(still(viewer_of([brief])), 0).any()
    rviz.draw([brief])
    wait_for(lambda: not seen(rviz.more()).any())


# In a browser

SHOWN = (
    "arrow between points", "arrow backwards", "arrow of other width and height", "cube of no height", "cylinder",
    "sphere", "line strip with colors", "triangles of one colour each", "points with colors", "cube list with colors",
)  # fmt: skip


def shown(browser, viewer):
    """The picture that a browser shows of a viewer's page, without the controls below."""
    window = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT + page.ROW})
    window.set_content(page.render(markers_alone(viewer), "frame_a", "overview"))
    window.wait_for_function("document.body.style.background === 'white'")
    png = window.screenshot(clip={"x": 0, "y": 0, "width": WIDTH, "height": HEIGHT})
    window.close()
    return np.array(Image.open(io.BytesIO(png)).convert("RGB"))


@pytest.mark.parametrize("name", SHOWN)
def test_the_page_shows_a_marker_as_rviz_does(rviz, browser, name):
    assert difference(rviz.draw(DRAWN[name]), shown(browser, viewer_of(DRAWN[name]))) <= tolerance(DRAWN[name])


def test_the_page_shows_a_text_as_high_as_rviz_does(rviz, browser):
    theirs, ours = (
        outline(image) for image in (rviz.draw(WRITTEN["text"]), shown(browser, viewer_of(WRITTEN["text"])))
    )
    np.testing.assert_allclose(ours, theirs, atol=4)


# What it says


def logged(each):
    """Whether RViz's log tells what it says of a marker: it does so of interactive ones, which it mends in part before."""
    numbers = [getattr(each.pose.orientation, name) for name in "xyzw"]
    numbers += [getattr(each.pose.position, name) for name in "xyz"] + [each.scale.x, each.scale.y, each.scale.z]
    numbers += [getattr(value, name) for value in each.points for name in "xyz"] + [each.color.r]
    unit = abs(np.linalg.norm(numbers[:4]) - 1) < 1e-3
    return np.isfinite(numbers).all() and unit and any(numbers[7:10]) and each.header.frame_id in ("frame_a", "frame_b")


def test_it_says_what_rviz_says(rviz):
    """The last test of all: of the markers it asks about, some stay in the picture."""
    told = {name: markers[-1] for name, markers in {**DRAWN, **WRITTEN}.items() if logged(markers[-1])}
    heard = dict(zip(told, rviz.remarks(list(told.values()))))
    expected = {name: (LEVELS[found[0]], sorted(found[1].split(" \n"))) for name, found in heard.items() if found}
    said = {name: list(rviz_says(each)) for name, each in told.items() if each.action == M.ADD}
    order = [INFO, WARNING, ERROR]
    worst = {name: max((level for level, _ in found), key=order.index) for name, found in said.items() if found}
    assert {name: (worst[name], sorted(text for _, text in said[name])) for name in worst} == expected
    assert len(expected) > 15 and set(worst.values()) == set(order)


def test_the_words_that_are_not_logged_are_rvizs_too(rviz):
    library = rviz.library("librviz_default_plugin")
    for words in (" contains invalid floating point values (nans or infs)", UNINITIALIZED, UNNORMALIZED):
        assert words.encode() in library
