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
from transform_lab.viewing.markers import ERROR, INFO, OURS, UNINITIALIZED, UNNORMALIZED, WARNING, remarks
from transform_lab.viewing.viewer import Viewer

BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
WIDTH, HEIGHT = round(picture.HEIGHT * page.ASPECT), picture.HEIGHT  # of our pictures
B_IN_A = (0, 0.5, 0.5)  # the origin of frame_b
LEVELS_UP = [INFO, WARNING, ERROR]
LEVELS = {2: INFO, 4: WARNING, 8: ERROR}  # of rosgraph_msgs/Log
NEAR = 3  # pixels
UPWARD = Pose(Point(-0.6, 0, 0.6), UPRIGHT)
# Pixels for what has another shape by design: a line is a flat ribbon in RViz and a rod here; the points that RViz draws
# with Mesa, as on machines without a graphics card, are turned with the marker, with other drivers they stand upright.
FARTHER = {Marker.LINE_STRIP: 6, Marker.LINE_LIST: 5, Marker.POINTS: 6}
# What is not drawn alike; "Beside RViz" in viewer.py says how.
DIFFERENT = ["points of other width and height", "sphere list, not round"]


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
    return np.array(picture.render(nodes, np.zeros((1, 2, 3)), Camera(BOX, page.ASPECT)))


def seen(image):
    """Where something is drawn on the white, and where something red, green and blue."""
    channels = np.moveaxis(image, 2, 0)
    low, high = (of(of(channels[0], channels[1]), channels[2]) for of in (np.minimum, np.maximum))
    return [low < 215, *((channel == high) & (high - low > 30) for channel in channels)]


def distance(one, other):
    """How many pixels some part of `one` is away from the nearest of `other`; 99 for what is not near at all."""
    rows, columns = np.nonzero(one | other)
    if not len(rows):
        return 0
    part = np.s_[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1]
    grown = Image.fromarray(other[part].astype(np.uint8) * 255)
    for pixels in range(10):
        if (one[part] & (np.array(grown) == 0)).sum() <= 2:  # a pixel or two of a thin edge
            return pixels
        grown = grown.filter(ImageFilter.MaxFilter(3))
    return 99


def difference(theirs, ours):
    """The largest distance between the outlines of all that is drawn, and of what is of each colour, if of several."""
    theirs, ours = seen(theirs), seen(ours)
    several = sum(of_one.any() for of_one in theirs[1:]) > 1  # else what RViz draws black, in the shade, belongs to it
    pairs = list(zip(theirs, ours))[: 4 if several else 1]
    return max(max(distance(one, other), distance(other, one)) for one, other in pairs)


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
    rows, columns = np.nonzero(seen(image)[0])
    return [rows.min(), rows.max(), columns.min(), columns.max()] if len(rows) else []


@pytest.mark.parametrize("name", WRITTEN)
def test_a_text_is_as_high_and_where_it_is_in_rviz(rviz, name):
    """Its letters are of another font."""
    theirs, ours = outline(rviz.draw(WRITTEN[name])), outline(still(viewer_of(WRITTEN[name])))
    assert len(theirs) == len(ours)
    np.testing.assert_allclose(ours, theirs, atol=4)


def test_deleting_needs_no_frame(rviz):
    cubes = [marker(M.CUBE, (0.5, 0.5, 0.5), id=1), marker(M.CUBE, (0.5, 0.5, 0.5), pose=UPWARD, id=2, color=BLUE)]
    for last in (Marker(ns="case", id=1, action=M.DELETE), Marker(action=M.DELETEALL)):
        assert seen(rviz.draw(cubes))[0].any()
        assert difference(rviz.more([last]), still(viewer_of([*cubes, last]))) <= NEAR


def test_a_marker_stays_where_its_frame_was_unless_it_is_locked_to_it(rviz):
    rviz.frame("moving", (0, 0, 0))
    cubes = [marker(M.CUBE, (0.5, 0.5, 0.5), pose=Pose(Point(), UPRIGHT), frame="moving", id=1, frame_locked=True)]
    cubes += [marker(M.CUBE, (0.5, 0.5, 0.5), pose=UPWARD, frame="moving", id=2, color=BLUE)]
    viewer = viewer_of([])
    viewer.add_frame("moving", np.eye(4))
    for each in cubes:
        viewer.publish(each)
    rviz.draw(cubes)
    wait_for(lambda: difference(rviz.more(), still(viewer)) <= NEAR)
    rviz.frame("moving", (0.8, 0, 0))
    viewer.add_frame("moving", tft.translation_matrix((0.8, 0, 0)))
    wait_for(lambda: difference(rviz.more(), still(viewer)) <= NEAR)


def test_a_marker_waits_for_its_frame_and_then_stays(rviz):
    waiting = [marker(M.CUBE, (0.5, 0.5, 0.5), pose=UPWARD, frame="late", color=BLUE)]
    waiting += [marker(M.CUBE, (0.5, 0.5, 0.5), pose=Pose(Point(), UPRIGHT), frame="late", id=1, frame_locked=True)]
    viewer = viewer_of(waiting)
    assert not seen(rviz.draw(waiting))[0].any() and not seen(still(viewer))[0].any()
    for x in (0.5, 0.8):
        rviz.frame("late", (x, 0, 0))
        viewer.add_frame("late", tft.translation_matrix((x, 0, 0)))
        assert seen(still(viewer))[0].any()
        wait_for(lambda: difference(rviz.more(), still(viewer)) <= NEAR)


def test_a_lifetime_ends_in_rviz_alone(rviz):
    """It is said so of `publish`."""
    brief = marker(M.CUBE, (0.5, 0.5, 0.5), lifetime=0.5)
    assert seen(still(viewer_of([brief])))[0].any()
    rviz.draw([brief])
    wait_for(lambda: not seen(rviz.more())[0].any())


# In a browser

SHOWN = (
    "arrow between points", "arrow of other width and height", "cube of no height", "line strip with colors",
    "triangles of one colour each", "points with colors", "cylinder",
)  # fmt: skip


def shown(browser, viewer):
    """The picture that a browser shows of a viewer's page, without the controls below."""
    window = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT + page.ROW})
    window.set_content(page.render(markers_alone(viewer), "frame_a", "overview"))
    window.wait_for_function("document.body.className")
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


# Words that its log does not have: it tells of interactive markers, which RViz mends before, or does not draw at all.
NOT_LOGGED = [
    " contains invalid floating point values (nans or infs)", UNINITIALIZED, UNNORMALIZED, "Scale contains 0.0 in x, y or z.",
    "Width LINE_LIST or LINE_STRIP is 0.0 (scale.x).", "Width and/or height of POINTS is 0.0 (scale.x, scale.y).",
    "Text height of TEXT_VIEW_FACING is 0.0 (scale.z).",
]  # fmt: skip


def logged(each):
    points = np.array([(point.x, point.y, point.z) for point in each.points])
    words = " ".join(text for _, text in remarks(each))
    known = each.action == M.ADD and each.header.frame_id in ("frame_a", "frame_b")
    return known and np.isfinite(points).all() and not any(unlogged in words for unlogged in NOT_LOGGED)


def test_it_says_what_rviz_says(rviz):
    """The last test that draws: of the markers it asks about, some stay in the picture."""
    told = {name: markers[-1] for name, markers in {**DRAWN, **WRITTEN}.items() if logged(markers[-1])}
    heard = dict(zip(told, rviz.remarks(list(told.values()))))
    expected = {name: (LEVELS[found[0]], sorted(found[1].split(" \n"))) for name, found in heard.items() if found}
    said = {name: remarks(each) for name, each in told.items()}
    said = {name: [one for one in found if not one[1].startswith(OURS)] for name, found in said.items()}
    worst = {name: max((level for level, _ in found), key=LEVELS_UP.index) for name, found in said.items() if found}
    assert {name: (worst[name], sorted(text for _, text in said[name])) for name in worst} == expected
    assert len(expected) > 15 and set(worst.values()) == set(LEVELS_UP)


@pytest.mark.parametrize("words", NOT_LOGGED)
def test_words_that_are_not_logged_are_rvizs_too(rviz, words):
    assert words.encode() in rviz.library("librviz_default_plugin")
    assert words in " ".join(text for markers in {**DRAWN, **WRITTEN}.values() for _, text in remarks(markers[-1]))
