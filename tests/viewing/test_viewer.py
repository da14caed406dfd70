"""The viewer: what it accepts, what it says, and that its page and its picture show the frames where they are."""

import base64
import html
import io
import math
import os
import re
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
import umsgpack
from PIL import Image
from support import CHROMIUM_FLAGS, PATIENCE, SOFTWARE_WEBGL
from transform_lab import tft
from transform_lab.lab_markers import arrow_marker, axis_marker
from transform_lab.messages import ColorRGBA, Header, Marker, Point, Pose, PoseStamped, Quaternion, Vector3
from transform_lab.viewing import drawing, markers, page, picture, shapes
from transform_lab.viewing import meshcat_commands as commands
from transform_lab.viewing.camera import Camera
from transform_lab.viewing.page import ASPECT
from transform_lab.viewing.viewer import Viewer

pytestmark = pytest.mark.filterwarnings("ignore:zmq.eventloop.ioloop is deprecated")  # by meshcat

HALF = math.sqrt(0.5)
A_T_B = np.array([[0, -1.0, -0.0, 1], [1, 0, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]])  # a quarter turn about z
B_T_C = np.array([[1.0, 0, 0, 0.5], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]])  # a quarter turn about x
PICTURE = r'src="data:image/webp;base64,([^"]+)"'
POSE_OF_B = Pose(Point(1, 2, 3), Quaternion(0, 0, HALF, HALF))


@pytest.fixture
def viewer():
    """A chain a, b, c, with axes of 1 m."""
    viewer = Viewer("a")
    viewer.add_frame("b", A_T_B, length=1)
    viewer.add_frame("c", B_T_C, parent="b")
    return viewer


def drawn(viewer):
    """The Drawing of a viewer's scene."""
    (found,), _ = drawing.draw_all([viewer])
    return found


def marker_node(viewer):
    """The node of the marker that was published first."""
    return next(node for node in drawn(viewer).nodes if node.path.startswith("markers/"))


def marker(kind, points=(), **fields):
    color, scale = ColorRGBA(1, 0.5, 0, 1), Vector3(0.1, 0.2, 0.3)
    return Marker(header=Header(0, 0, "a"), type=kind, color=color, scale=scale, points=list(points), **fields)


# Filling the scene


def test_lookup_chains_and_inverts(viewer):
    np.testing.assert_allclose(viewer.lookup("a", "c"), A_T_B @ B_T_C, atol=1e-12)
    np.testing.assert_allclose(viewer.lookup("c", "a") @ A_T_B @ B_T_C, np.eye(4), atol=1e-12)
    np.testing.assert_allclose(viewer.lookup("b", "c"), B_T_C, atol=1e-12)
    np.testing.assert_array_equal(viewer.lookup("a", "a"), np.eye(4))


@pytest.mark.parametrize("seed", range(5))
def test_a_path_leads_over_the_common_ancestor_and_its_product_is_the_lookup(seed):
    random = np.random.default_rng(seed)
    tree, names = Viewer("0"), ["0"]
    for number in range(1, 12):
        link = tft.random_rotation_matrix(random.random(3))
        link[:3, 3] = random.uniform(-1, 1, 3)
        tree.add_frame(str(number), link, random.choice(names))
        names.append(str(number))
    for target in names:
        for source in names:
            path, product = tree.path(target, source), np.eye(4)
            assert (path[0], path[-1]) == (target, source) and len(set(path)) == len(path)
            for here, there in zip(path, path[1:]):
                assert here in (tree.frames[there].parent,) or tree.frames[here].parent == there
                product = product @ tree.lookup(here, there)
            np.testing.assert_allclose(product, tree.lookup(target, source), atol=1e-9)
    with pytest.raises(ValueError, match="'12' is not known"):
        tree.path("12", "0")


def test_a_frame_that_is_replaced_takes_its_children_along(viewer):
    viewer.add_frame("b", np.eye(4))
    np.testing.assert_allclose(viewer.lookup("a", "c"), B_T_C, atol=1e-12)


@pytest.mark.parametrize(
    "transform",
    [
        A_T_B,
        A_T_B.tolist(),
        A_T_B.astype(np.float32),
        POSE_OF_B,
        PoseStamped(Header(0, 0, "a"), POSE_OF_B),
        SimpleNamespace(position=SimpleNamespace(x=1, y=2, z=3), orientation=SimpleNamespace(x=0, y=0, z=HALF, w=HALF)),
    ],
    ids=["matrix", "list", "float32", "Pose", "PoseStamped", "another Pose"],
)
def test_what_a_frame_is_made_from(transform):
    viewer = Viewer("a")
    viewer.add_frame("b", transform)
    np.testing.assert_allclose(viewer.lookup("a", "b"), A_T_B, atol=1e-12)


def test_the_header_names_the_parent(viewer):
    viewer.add_frame("d", PoseStamped(Header(0, 0, "b"), POSE_OF_B))
    np.testing.assert_allclose(viewer.lookup("a", "d"), A_T_B @ A_T_B, atol=1e-12)
    with pytest.raises(ValueError, match="parent='c', but header.frame_id is 'b'"):
        viewer.add_frame("e", PoseStamped(Header(0, 0, "b"), POSE_OF_B), parent="c")


def test_the_scene_keeps_copies(viewer):
    matrix, sphere = A_T_B.copy(), marker(Marker.SPHERE)
    viewer.add_frame("d", matrix)
    viewer.publish(sphere)
    matrix[0, 3] = sphere.pose.position.x = 9
    assert viewer.lookup("a", "d")[0, 3] == 1
    assert "SPHERE at (0, 0, 0)" in viewer.description()


@pytest.mark.parametrize(
    "call",
    [
        lambda v: v.lookup("a", "gripper"),
        lambda v: v.lookup("gripper", "a"),
        lambda v: v.add_frame("d", np.eye(4), parent="gripper"),
        lambda v: v.add_point("p", (0, 0, 0), frame="gripper"),
        lambda v: v.add_arrow("p", (0, 0, 1), frame="gripper"),
    ],
)
def test_unknown_frames_are_named_with_those_that_are_known(viewer, call):
    with pytest.raises(ValueError, match="'gripper' is not known. Known frames: a, b, c"):
        call(viewer)


@pytest.mark.parametrize(
    "transform, message",
    [
        (np.eye(3), "must be a 4x4 homogeneous transform.*got 3x3"),
        (np.full((4, 4), math.nan), "NaN or infinity"),
        (A_T_B.T, r"bottom row 0, 0, 0, 1; it is 1, 2, 3, 1"),
        (np.diag([1, 1, 1.1, 1]), "differs from the identity by up to 0.21"),
        (np.diag([1, 1, -1, 1]), "the determinant is -1"),
        (Pose(), r"length is 0\. A fresh Quaternion\(\) is no orientation"),
        (Pose(Point(), Quaternion(0, 0, 1, 1)), r"quaternion of length 1; its length is 1\.414"),
        (Pose(Point(math.inf, 0, 0), Quaternion(0, 0, 0, 1)), "position contains NaN or infinity"),
    ],
)
def test_what_is_no_rigid_transform_is_refused(viewer, transform, message):
    with pytest.raises(ValueError, match=r"add_frame\('d'\): the (pose|transform).*" + message):
        viewer.add_frame("d", transform)
    assert "frame d" not in viewer.description()


@pytest.mark.parametrize("odd", [A_T_B * 1j, np.ma.masked_less(A_T_B, 0), [[10**400] * 4] * 4])
def test_numbers_that_are_no_real_numbers_are_refused(viewer, odd):
    with pytest.raises((TypeError, ValueError), match="must be made of numbers|a number that is too large"):
        viewer.add_frame("d", odd)


def test_a_pose_with_an_array_as_orientation_is_refused(viewer):
    pose = Pose()
    pose.orientation = np.array([0, 0, 0, 1])
    with pytest.raises(TypeError, match="has a ndarray as its orientation; that must be a Quaternion"):
        viewer.add_frame("d", pose)


def test_circles_and_the_fixed_frame_are_refused(viewer):
    with pytest.raises(ValueError, match="circle"):
        viewer.add_frame("b", np.eye(4), parent="c")
    with pytest.raises(ValueError, match="'a' is the frame this viewer was made with"):
        viewer.add_frame("a", np.eye(4))
    with pytest.raises(ValueError, match="length must be a number of metres from 1e-05 to 1e\\+06; got 0"):
        viewer.add_frame("d", np.eye(4), length=0)


@pytest.mark.parametrize("name", [3, None, "", ("a", "b"), np.eye(4)], ids=lambda name: type(name).__name__)
def test_names_are_texts(viewer, name):
    for add in (
        lambda: viewer.add_frame(name, np.eye(4)),
        lambda: viewer.add_point(name, (0, 0, 0)),
        lambda: viewer.add_arrow(name, (1, 0, 0)),
        lambda: viewer.add_box(name, (1, 1, 1)),
        lambda: Viewer(name),
    ):
        with pytest.raises(TypeError, match="must be a text, such as 'base_link'; got "):
            add()


def test_points(viewer):
    viewer.add_point("p", Point(1, 2, 3), frame="b")
    viewer.add_point("q", [1, 2, 3, 1])
    assert "point p in b: (1, 2, 3)" in viewer.description()
    assert "point q in a: (1, 2, 3)" in viewer.description()
    with pytest.raises(ValueError, match="the last must be 1; it is 0"):
        viewer.add_point("r", [1, 2, 3, 0])
    with pytest.raises(ValueError, match="numbers from 0 to 1"):
        viewer.add_point("r", [1, 2, 3], color=(255, 0, 0))


# Markers


@pytest.mark.parametrize(
    "drawn, kinds",
    [
        (marker(Marker.ARROW), ["cylinder", "cone"]),
        (marker(Marker.ARROW, [Point(), Point(1, 0, 0)]), ["cylinder", "cone"]),
        (marker(Marker.CUBE), ["box"]),
        (marker(Marker.SPHERE), ["sphere"]),
        (marker(Marker.CYLINDER), ["cylinder"]),
        (marker(Marker.LINE_LIST, [Point(x, 0, 0) for x in range(4)]), ["cylinder"] * 2),
        (marker(Marker.LINE_STRIP, [Point(x, 0, 0) for x in range(4)]), ["cylinder"] * 3),
        (marker(Marker.CUBE_LIST, [Point(x, 0, 0) for x in range(4)]), ["box"] * 4),
        (marker(Marker.SPHERE_LIST, [Point(x, 0, 0) for x in range(4)]), ["sphere"] * 4),
    ],
)
def test_markers_become_solids(drawn, kinds):
    node = shapes.Node("m", np.eye(4))
    markers.draw_marker(drawn, node)
    assert [solid.kind for solid in node.solids] == kinds
    assert all(solid.color == (1, 0.5, 0, 1) for solid in node.solids)


def test_the_labs_arrow_ends_at_its_point():
    node = shapes.Node("m", np.eye(4))
    markers.draw_marker(arrow_marker(Point(1, 2, 2)), node)
    shaft, head = node.solids
    np.testing.assert_allclose(shaft.matrix @ [0, 0, -0.5, 1], [0, 0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(head.matrix @ [0, 0, 0.5, 1], [1, 2, 2, 1], atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(shaft.matrix[:3, 0]), 0.1)
    np.testing.assert_allclose(np.linalg.norm(head.matrix[:3, 0]), 0.15)


def test_points_and_text_markers():
    node = shapes.Node("m", np.eye(4))
    colors = [ColorRGBA(1, 0, 0, 1), ColorRGBA(0, 1, 0, 1)]
    markers.draw_marker(marker(Marker.POINTS, [Point(1, 2, 3), Point(4, 5, 6)], colors=colors), node)
    markers.draw_marker(marker(Marker.TEXT_VIEW_FACING, text="table"), node)
    assert node.clouds[0].points.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert node.clouds[0].colors.tolist() == [[1, 0, 0, 1], [0, 1, 0, 1]]
    assert node.labels[0].text == "table"


def changed(**fields):
    """A CUBE in frame a with some fields of another kind, as messages take any value."""
    cube = marker(Marker.CUBE, ns="n", id=7)
    for name, value in fields.items():
        setattr(cube, name, value)
    return cube


@pytest.mark.parametrize(
    "wrong, message",
    [
        (changed(color=(1, 0, 0, 1)), "marker n/7: color must be a ColorRGBA; got tuple"),
        (changed(text=5), "marker n/7: text must be a text"),
        (changed(id=[1]), "id, type and action whole numbers"),
        (changed(points=[[0, 0, 0]]), r"marker n/7: points\[0\] must be a Point; got list"),
        (changed(points=None), "marker n/7: points must be a list of Points; got NoneType"),
        (changed(scale=0.1), "marker n/7: scale must be a Vector3; got float"),
        (changed(pose=A_T_B), "marker n/7: pose must be a Pose; got ndarray"),
        (changed(pose=Pose(np.zeros(3), Quaternion())), "marker n/7: .* must be a Point, such as Point"),
        (changed(header="a"), "marker n/7: header must be a Header; got str"),
        (changed(header=SimpleNamespace(frame_id=None)), "header.frame_id must be a text"),
        (POSE_OF_B, "publish takes one Marker; got Pose"),
        ([marker(Marker.CUBE)], "publish takes one Marker; got list"),
    ],
    ids=lambda value: value if isinstance(value, str) else type(value).__name__,
)
def test_fields_of_another_kind_are_named(viewer, wrong, message):
    with pytest.raises(TypeError, match=message):
        viewer.publish(wrong)
    viewer.figure()


@pytest.mark.parametrize(
    "refused, message",
    [
        (marker(Marker.MESH_RESOURCE), "MESH_RESOURCE, a file in a ROS package, is not drawn here; these are: ARROW"),
        (marker(Marker.CUBE_LIST, [Point()] * 2001), "at most 2000 points are drawn; got 2001. POINTS take any number"),
    ],
)
def test_what_rviz_draws_and_we_do_not_is_refused(viewer, refused, message):
    with pytest.raises(ValueError, match=message):
        viewer.publish(refused)
    assert "marker" not in viewer.description()


# What RViz says, tests/ros/test_rviz.py asks RViz; these are what a student reads of it, and what is ours to say.
@pytest.mark.parametrize(
    "odd, words",
    [
        (changed(scale=Vector3(0, 0.1, 0.1)), "Scale contains 0.0 in x, y or z."),
        (changed(color=ColorRGBA(1, 0, 0, 0)), "Marker is fully transparent (color.a is 0.0)."),
        (changed(color=ColorRGBA(255, 0, 0, 1)), "Colors go from 0 to 1 (not to 255)"),
        (changed(pose=Pose(Point(), Quaternion(0, 0, 1, 1))), "Unnormalized quaternion in marker message."),
        (changed(text="cup"), "Non-empty text is ignored."),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_markers_that_are_odd_are_drawn_and_say_so(viewer, odd, words):
    viewer.publish(odd)
    assert f"Marker n/7: {words}" in drawn(viewer).text
    assert f"Marker n/7: {words}" in viewer.description() and "marker n/7 in a: CUBE" in viewer.description()


@pytest.mark.parametrize(
    "wrong, words",
    [
        (marker(Marker.LINE_LIST, [Point()]), "Number of points should be a multiple of 2 for LINE_LIST marker."),
        (marker(Marker.POINTS), "Points should not be empty for specified marker type."),
        (marker(99), "Unknown marker type: 99."),
        (marker(Marker.CUBE, action=7), "Unknown marker action: 7"),
        (changed(scale=Vector3(1, 1, math.nan)), "Scale contains invalid floating point values (nans or infs)"),
        (changed(pose=Pose(Point(1e9, 0, 0), Quaternion(0, 0, 0, 1))), "too far away to be drawn: 1e+09 m. Are these metres?"),
        (changed(header=Header(0, 0, "gripper")), "Frame [gripper] does not exist. Known frames: a, b, c"),
        (changed(header=Header(0, 0, "/a")), "Frame [/a] does not exist. Write it without the slash."),
        (changed(header=Header(0, 0, "")), "Frame [] does not exist."),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)  # fmt: skip
def test_markers_in_error_are_not_drawn_and_say_so(viewer, wrong, words):
    viewer.publish(wrong)
    assert not [node for node in drawn(viewer).nodes if node.path.startswith("markers/")]
    assert words in viewer.description() and words in " ".join(drawn(viewer).text.split("\n"))
    viewer.figure()


ODD_NUMBERS = (0.0, 1.0, -1.0, 0.5, 1e-30, -0.0, 1e7, 1e300, math.nan, math.inf, 255)


def odd_marker(rng):
    """A marker of any type whose numbers are odd ones, most of them not."""

    def number():
        return float(rng.choice(ODD_NUMBERS) if rng.random() < 0.1 else rng.choice(ODD_NUMBERS[:4]))

    made = Marker(header=Header(0, 0, "a"), ns="n", type=int(rng.choice([*range(10), 11, -1, 12])), text="ab\ncd")
    made.pose = Pose(Point(*(number() for _ in "xyz")), Quaternion(*(number() for _ in "xyzw")))
    made.scale, made.color = Vector3(*(number() for _ in "xyz")), ColorRGBA(*(number() for _ in "rgba"))
    count = int(rng.choice([0, 1, 2, 3, 6]))
    made.points = [Point(*(number() for _ in "xyz")) for _ in range(count)]
    made.colors = [ColorRGBA(*(number() for _ in "rgba")) for _ in range(int(rng.choice([0, count, count // 3, 1])))]
    return made


def test_whatever_the_numbers_the_scene_is_shown(thorough):
    """No marker that ROS could send makes an error or a number that cannot be drawn."""
    rng = np.random.default_rng(1)
    for i in range(5000 if thorough else 300):
        viewer, odd = Viewer("a"), odd_marker(rng)
        with np.errstate(all="raise", under="ignore"):
            viewer.publish(odd)
            found = drawn(viewer)
            if i % 60 == 0:
                assert viewer.picture() and page.render(found, "a", "overview")
        numbers = [found.seen, *(solid.matrix for node in found.nodes for solid in node.solids)]
        numbers += [part for node in found.nodes for cloud in node.clouds for part in (cloud.points, cloud.colors)]
        numbers += [part for node in found.nodes for mesh in node.meshes for part in (mesh.corners, mesh.colors)]
        assert all(np.isfinite(part).all() for part in numbers), odd


def test_what_is_said_goes_with_the_marker(viewer):
    viewer.publish(changed(scale=Vector3(0, 1, 1)))
    viewer.publish(changed())
    assert "0.0" not in viewer.description()
    viewer.publish(changed(type=99))
    assert "Unknown" in viewer.description() and "CUBE" not in viewer.description()
    viewer.publish(changed(action=Marker.DELETE))
    assert "Unknown" not in viewer.description()


def test_of_many_markers_some_words_are_shown_and_all_are_in_the_description(viewer):
    for number in range(30):
        viewer.publish(marker(99, ns="n", id=number))
    assert len(drawn(viewer).text.splitlines()) == drawing.MOST_LINES + 1
    assert viewer.description().count("Unknown marker type") == 30


def test_markers_replace_and_delete_each_other(viewer):
    def types():
        return re.findall(r"^marker (\S+) in a: (\w+)", viewer.description(), re.MULTILINE)

    viewer.publish(marker(Marker.CUBE, ns="n", id=1))
    viewer.publish(marker(Marker.SPHERE, ns="n", id=1))
    viewer.publish(marker(Marker.CUBE, ns="n", id=2))
    viewer.publish(marker(Marker.CUBE, ns="m", id=2))
    assert types() == [("n/1", "SPHERE"), ("n/2", "CUBE"), ("m/2", "CUBE")]
    viewer.publish(Marker(ns="n", id=2, action=Marker.DELETE))
    assert types() == [("n/1", "SPHERE"), ("m/2", "CUBE")]
    viewer.publish(Marker(action=Marker.DELETEALL))
    assert types() == []


def test_a_marker_is_drawn_in_the_frame_of_its_header(viewer):
    viewer.publish(axis_marker(PoseStamped(Header(0, 0, "b"), Pose(Point(0.5, 0, 0), Quaternion(HALF, 0, 0, HALF)))))
    node = marker_node(viewer)
    np.testing.assert_allclose(node.transform, A_T_B @ B_T_C, atol=1e-12)


def test_a_fresh_orientation_of_a_marker_is_no_rotation_and_no_opacity_is_invisible(viewer):
    arrow = arrow_marker(Point(1, 0, 0))
    arrow.header.frame_id, arrow.color.a = "b", 0
    viewer.publish(arrow)
    node = marker_node(viewer)
    np.testing.assert_allclose(node.transform, A_T_B, atol=1e-12)
    assert not node.solids and "fully transparent" in drawn(viewer).text
    assert "Uninitialized quaternion" in viewer.description() and "Uninitialized" not in drawn(viewer).text


@pytest.mark.parametrize("locked", [True, False])
def test_a_marker_stays_when_its_frame_moves_unless_it_is_locked_to_it(viewer, locked):
    cube = marker(Marker.CUBE, frame_locked=locked)
    cube.header.frame_id = "b"
    viewer.publish(cube)
    viewer.add_frame("b", np.eye(4))
    np.testing.assert_allclose(marker_node(viewer).transform, np.eye(4) if locked else A_T_B, atol=1e-12)


def test_a_marker_waits_for_its_frame_and_then_stays(viewer):
    waiting = marker(Marker.CUBE)
    waiting.header.frame_id = "late"
    viewer.publish(waiting)
    for transform in (A_T_B, np.eye(4)):
        viewer.add_frame("late", transform)
    np.testing.assert_allclose(marker_node(viewer).transform, A_T_B, atol=1e-12)


# Boxes, grippers, ghosts, the fixed frame, where it is seen from


def test_boxes_are_where_their_pose_says(viewer):
    viewer.add_box("table", (2, 1, 0.1), pose=Pose(Point(0, 0, 1), Quaternion(0, 0, HALF, HALF)), frame="b")
    node = next(node for node in drawn(viewer).nodes if node.path == "boxes/table")
    np.testing.assert_allclose(
        node.transform @ node.solids[0].matrix @ [0.5, 0, 0, 1], A_T_B @ [0, 1, 1, 1], atol=1e-12
    )
    assert "box table in b: middle (0, 0, 1), 2 x 1 x 0.1 m" in viewer.description()
    viewer.add_box("table", (1, 1, 1), pose=PoseStamped(Header(0, 0, "c"), POSE_OF_B))
    assert "box table in c: middle (1, 2, 3)" in viewer.description()
    with pytest.raises(ValueError, match="size must be three numbers of at least 1e-05 m; got 1, 0, 1"):
        viewer.add_box("table", (1, 0, 1))


def test_a_grippers_fingers_lie_along_x_and_move_along_y(viewer):
    viewer.add_gripper("c", opening=0.2)
    node = next(node for node in drawn(viewer).nodes if node.path == "grippers/c")
    np.testing.assert_allclose(node.transform, A_T_B @ B_T_C, atol=1e-12)
    corners = np.array([[x, y, z, 1] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    left, right = ((solid.matrix @ corners.T)[:3] for solid in node.solids[:2])
    assert left[1].min() == pytest.approx(0.1) and right[1].max() == pytest.approx(-0.1)  # 0.2 m between them
    assert left[0].max() > 0 > left[0].min() and np.ptp(left[0]) > np.ptp(left[1])
    assert "gripper on c: opening 0.2 m" in viewer.description()
    with pytest.raises(ValueError, match="'d' is not known"):
        viewer.add_gripper("d")
    with pytest.raises(ValueError, match="opening must be a number of metres from 1e-05 to 1e\\+06; got 0"):
        viewer.add_gripper("c", opening=0)


def test_ghosts_are_translucent(viewer):
    viewer.add_frame("d", np.eye(4), ghost=True)
    viewer.add_point("p", (0, 0, 0), ghost=True)
    viewer.add_arrow("q", (1, 0, 0), ghost=True)
    viewer.add_box("r", (1, 1, 1), ghost=True)
    viewer.add_gripper("c", ghost=True)
    nodes = {node.path: node for node in drawn(viewer).nodes}
    for path in ("frames/d", "points/p", "arrows/q", "boxes/r", "grippers/c"):
        assert all(solid.color[3] < 0.5 for solid in nodes[path].solids), path
    assert all(solid.color[3] == 1 for solid in nodes["frames/b"].solids)
    assert Viewer("a", ghost=True).frames["a"].ghost


def test_any_known_frame_can_be_the_fixed_one(viewer):
    viewer.fixed_frame = "c"
    assert viewer.description().startswith("Scene in the fixed frame c")
    assert "frame b in a: position (1, 2, 3)" in viewer.description()  # what is known does not change
    np.testing.assert_allclose(drawn(viewer).seen_from("c")[0], (np.linalg.inv(A_T_B @ B_T_C) @ [0, 0, 0, 1])[:3])
    with pytest.raises(ValueError, match="'d' is not known. Known frames: a, b, c"):
        viewer.fixed_frame = "d"


def test_the_picture_is_drawn_in_the_fixed_frame(viewer):
    other = Viewer("c")
    other.add_frame("b", np.linalg.inv(B_T_C))
    other.add_frame("a", np.linalg.inv(A_T_B), parent="b", length=1)
    viewer.fixed_frame = "c"
    one, same = (np.array(Image.open(io.BytesIO(v.picture())).convert("L")).astype(int) for v in (viewer, other))
    assert (np.abs(one - same) > 60).mean() < 0.01  # but for the lines and the order of names
    viewer.fixed_frame = "a"
    turned = np.array(Image.open(io.BytesIO(viewer.picture())).convert("L")).astype(int)
    assert (np.abs(one - turned) > 60).mean() > 0.01


@pytest.mark.parametrize(
    "seen_from, right, up",
    [("above", [1, 0, 0], [0, 1, 0]), ("side", [1, 0, 0], [0, 0, 1]), ("behind", [0, -1, 0], [0, 0, 1])],
)
def test_where_a_scene_is_seen_from(seen_from, right, up):
    camera = Camera(np.concatenate([np.eye(3), -np.eye(3)]), ASPECT, seen_from)
    middle = camera.project([0, 0, 0])[0]
    np.testing.assert_allclose((camera.project(right)[0] - middle)[1], 0, atol=0.02)
    assert (camera.project(right)[0] - middle)[0] > 0.1
    assert (camera.project(up)[0] - middle)[1] > 0.1


def test_room_for_a_text_is_kept_free():
    points = np.random.default_rng(1).normal(size=(40, 3))
    places = Camera(points, ASPECT, top=0.3).project(points)[0]
    assert places[:, 1].max() < 0.7 and places[:, 1].min() > 0 and np.ptp(places[:, 1]) > 0.4


def test_what_is_behind_the_camera_has_no_place():
    camera = Camera([[-1, -1, -1], [1, 1, 1]], ASPECT)
    assert np.isnan(camera.project(camera.eye + camera.back)[0]).all()


@pytest.mark.parametrize("at, links", [(None, {"b", "c"}), (["b", "c"], {"c"}), (["a", "b"], {"b"}), (["c"], set())])
def test_no_line_leads_out_of_the_picture(viewer, at, links):
    ((found,), _) = drawing.draw_all([viewer], at)
    assert {node.path.partition("/")[2] for node in found.nodes if node.path.startswith("links/")} == links


def test_looking_at_some_things_leaves_the_others_out_of_view(viewer):
    viewer.add_frame("far", tft.translation_matrix([50, 0, 0]))
    viewer.look(at=["b", "c"])
    seen = drawing.draw_all([viewer], ["b", "c"])[0][0].seen
    assert np.abs(seen).max() < 10
    viewer.figure()
    with pytest.raises(ValueError, match="nothing here is called 'd'. Known names: a, b, c, far"):
        viewer.look(at=["d"])
    with pytest.raises(ValueError, match="seen_from must be one of overview, above, side, behind; got 'left'"):
        viewer.look(seen_from="left")
    assert viewer.look(seen_from="above").at == ["b", "c"]  # what is not said stays


def test_triangles(viewer):
    points = [Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0)]
    colors = [ColorRGBA(1, 0, 0, 1)]
    viewer.publish(marker(Marker.TRIANGLE_LIST, points, colors=colors))
    (mesh,) = marker_node(viewer).meshes
    np.testing.assert_allclose(mesh.corners[0], np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]) * [0.1, 0.2, 0.3])
    assert mesh.colors[0].tolist() == [[1, 0, 0, 1]] * 3
    image = np.array(Image.open(io.BytesIO(viewer.look(at=["a"]).picture())).convert("RGB")).astype(int)
    assert len(image)


def test_what_coincides_but_for_rounding_is_drawn_as_what_coincides():
    viewer = Viewer("a")
    viewer.add_frame("b", tft.translation_matrix([1e-17, 0, 3e-16]))
    assert drawing.draw_all([viewer])[1] == 1.0


def test_each_point_and_triangle_has_its_own_opacity(viewer):
    colors = [ColorRGBA(1, 0, 0, 1), ColorRGBA(0, 1, 0, 0), ColorRGBA(0, 0, 1, 0.25)]
    viewer.publish(marker(Marker.POINTS, [Point(x, 0, 0) for x in range(3)], colors=colors))
    looks = [look for look, _ in commands.properties(drawn(viewer).nodes).values() if look and look[0] == "points"]
    assert len(looks) == 2  # what has opacity 0 is not drawn
    materials = [umsgpack.unpackb(commands.set_object("p", look))["object"]["materials"][0] for look in looks]
    assert sorted(material.get("opacity", 1) for material in materials) == [0.25, 1]
    assert [m["transparent"] for m in materials if m.get("opacity", 1) < 1] == [True]


def test_dollars_are_dollars(viewer):
    viewer.add_frame(r"$\frac$", np.eye(4))
    viewer.figure()
    viewer.text = r"from $\frac$ to here"
    viewer.figure()


def test_a_text_is_cut_to_what_fits(viewer):
    viewer.text = "x" * 1000 + "\n" + "y\n" * 1000
    assert len(viewer.text) < 300
    viewer.text = np.eye(2)
    assert viewer.text == "[[1. 0.]\n [0. 1.]]"


def test_many_frames_are_drawn_in_bearable_time(slow):
    viewer = Viewer("f0")
    for i in range(1, 200):
        viewer.add_frame(f"f{i}", tft.rotation_matrix(0.1, [0, 1, 1]) @ tft.translation_matrix([1, 0, 0]), f"f{i - 1}")
    assert len(viewer.figure()) < 600_000


def test_colours_of_the_picture_are_those_of_the_scene(monkeypatch):
    viewer = Viewer("a", ghost=True)
    for i, color in enumerate([(0, 1, 1), (1, 0, 1), (1, 1, 0), (0, 0, 0), (0.8, 0.5, 0.3), (0.3, 0.9, 0.6)]):
        viewer.add_box(f"b{i}", (1, 1, 1), pose=tft.euler_matrix(i, i, i), color=color, ghost=i % 2)
        viewer.add_frame(f"f{i}", tft.euler_matrix(i, 0, i) @ tft.translation_matrix([0, i, 0]))
    drawn, smaller = [], picture.webp
    monkeypatch.setattr(page, "webp", lambda image: drawn.append(image) or smaller(image))
    shown = base64.b64decode(re.search(PICTURE, viewer.figure())[1])
    kept, painted = (np.array(image.convert("RGB")).astype(int) for image in (Image.open(io.BytesIO(shown)), drawn[0]))
    assert np.abs(kept - painted).max() <= 12


def test_a_text_is_as_high_as_its_scale_says(viewer):
    viewer.publish(marker(Marker.TEXT_VIEW_FACING, text="table"))
    (label,) = marker_node(viewer).labels
    assert label.height == markers.CAPITAL * 0.3
    camera = Camera([[-1, -1, -1], [1, 1, 1]], ASPECT)
    near, far = (picture._font_size(label, tft.translation_matrix(d * camera.back), camera) for d in (1, -1))
    assert near > far > 0


@pytest.mark.parametrize(
    "call",
    [
        lambda v: v.add_frame("d", tft.translation_matrix([1e7, 0, 0])),
        lambda v: v.add_point("p", (0, -1e7, 0)),
        lambda v: v.add_arrow("p", (0, 0, 1e300)),
        lambda v: v.add_box("p", (1, 1, 1), pose=Pose(Point(1e7, 0, 0), Quaternion(0, 0, 0, 1))),
    ],
)
def test_what_is_too_far_away_is_refused(viewer, call):
    with pytest.raises(ValueError, match="too far away to be drawn: .* Are these metres"):
        call(viewer)


def test_only_the_last_value_of_each_thing_is_kept(viewer):
    size = len(viewer.figure())
    for i in range(1000):
        viewer.add_frame("b", A_T_B @ tft.rotation_matrix(i, [0, 0, 1]), length=1)
        viewer.publish(marker(Marker.CUBE, ns="n", id=1))
    viewer.publish(Marker(action=Marker.DELETEALL))
    viewer.add_frame("b", A_T_B, length=1)
    assert abs(len(viewer.figure()) - size) < 100


def test_a_change_sends_what_changed_and_no_more(viewer):
    before = commands.properties(drawn(viewer).nodes)
    assert commands.changes(before, before) == []
    viewer.add_frame("c", B_T_C @ B_T_C, parent="b")
    viewer.add_point("p", (1, 1, 1))
    after = commands.properties(drawn(viewer).nodes)
    found = unpacked(commands.changes(before, after))
    assert {c["path"] for c in found if c["type"] == "set_object"} == {"meshcat/points/p/solid0"}
    moved = {c["path"] for c in found if c["type"] == "set_transform"}
    assert {"meshcat/frames/c", "meshcat/points/p"} <= moved and "meshcat/frames/b" not in moved
    assert {c["path"] for c in unpacked(commands.changes(after, before)) if c["type"] == "delete"} >= {
        "meshcat/points/p"
    }


# Showing it


def test_the_description_says_where_everything_is(viewer):
    viewer.add_arrow("p", (0, 0, 1), tail=(1, 0, 0), frame="c")
    assert viewer.description().splitlines() == [
        "Scene in the fixed frame a (metres)",
        "frame b in a: position (1, 2, 3), x axis (0, 1, 0), y axis (-1, 0, 0), z axis (0, 0, 1)",
        "frame c in b: position (0.5, 0, 0), x axis (1, 0, 0), y axis (0, 0, 1), z axis (0, -1, 0)",
        "arrow p in c: from (1, 0, 0) to (0, 0, 1)",
    ]
    assert repr(viewer) == viewer.description()


def test_one_display_holds_text_and_page_and_is_small(viewer):
    bundle = viewer._repr_mimebundle_()
    assert set(bundle) == {"text/plain", "text/html"}
    assert bundle["text/plain"] == viewer.description()
    assert len(bundle["text/html"]) + len(bundle["text/plain"]) < 300_000
    assert html.escape(viewer.description()) in bundle["text/html"]  # the picture's alternative text
    assert bundle["text/html"] in viewer.html()  # and the same scene gives the same page


GRADED = """
import sys
import numpy as np
import transform_lab as lab
T = np.eye(4)
v = lab.Viewer(); v.add_point('p', (1, 2, 3))
shown = [v, lab.animate_rotation(T), lab.animate_chain(T, T), lab.animate_inverse(T), lab.animate_approach(T, T, T)]
shown += [lab.animate_mirrors(), lab.animate_determinant(T[:3, :3]), lab.animate_retelling(T, T, [1, 2, 3])]
shown += [lab.animate_journey(T, {'pre-grasp': T, 'grasp': T})]
shown.append(lab.Viewer().interact(lambda scene, x: None, x=(0, 1)))
assert all(list(viewer._repr_mimebundle_()) == ['text/plain'] for viewer in shown)
assert lab.plot_columns(T) is lab.plot_quaternion() is lab.plot_from_above(v) is None
print(*(name for name in ('meshcat', 'matplotlib', 'PIL', 'IPython', 'anywidget') if name in sys.modules))
"""


def test_nothing_is_rendered_while_grading():
    environment = {"PYTHONPATH": os.pathsep.join(sys.path), "TRANSFORM_LAB_GRADING": "1"}
    result = subprocess.run([sys.executable, "-c", GRADED], env=environment, capture_output=True, text=True)
    assert (result.returncode, result.stderr, result.stdout.strip()) == (0, "", "")


WITHOUT_SERVER = """
import socket, sys
def refuse(*_): raise AssertionError("a port")
socket.socket.bind = socket.socket.listen = refuse
import numpy as np
import transform_lab as lab
v = lab.Viewer(); v.add_point('p', (1, 2, 3))
assert "srcdoc" in v._repr_mimebundle_()['text/html'] and len(v.html()) > 200_000
lab.animate_chain(np.eye(4), lab.tft.rotation_matrix(1, [1, 2, 3])).figure()
large = ('meshcat', 'pyngrok', 'tornado', 'zmq', 'scipy', 'matplotlib', 'IPython', 'anywidget')
print(*(name for name in large if name in sys.modules))
import meshcat
print(meshcat.geometry.Box, meshcat.Visualizer)
"""


def test_a_scene_needs_no_port_and_no_large_library():
    """meshcat brings a server and a tunnel; its geometry and its script are all that is used of it."""
    environment = {"PYTHONPATH": os.pathsep.join(sys.path)}
    result = subprocess.run([sys.executable, "-c", WITHOUT_SERVER], env=environment, capture_output=True, text=True)
    whole = "<class 'meshcat.geometry.Box'> <class 'meshcat.visualizer.Visualizer'>"  # for who wants it
    assert (result.returncode, result.stdout.splitlines()) == (0, ["", whole]), result.stderr


@pytest.mark.parametrize(
    "points", [np.random.default_rng(1).normal(size=(40, 3)), [[0, 0, 0], [0.1, 0, 0]], [[1, 2, 3]]], ids=len
)
def test_all_points_are_in_view_and_fill_it(points):
    camera = Camera(points, ASPECT)
    places, depths = camera.project(points)
    assert (depths > 0).all() and (places > 0).all() and (places < [ASPECT, 1]).all()
    if len(points) > 1:
        assert (np.ptp(places, axis=0) / [ASPECT, 1]).max() > 0.8


def test_the_picture_shows_the_axes_in_their_colours_where_they_are(viewer):
    found = drawn(viewer)
    camera = Camera(found.seen, ASPECT)
    nodes, (grid, _) = found.nodes, drawing.grid(found.seen)
    image = np.array(picture.render(nodes, grid, camera)).astype(int)
    height, width, _ = image.shape
    for name in "ac":
        a_T_frame = viewer.lookup("a", name)
        for channel in range(3):
            halfway = a_T_frame @ np.append(0.5 * np.eye(3)[channel], 1)
            x, y = camera.project(halfway[:3])[0]
            pixel = image[height - 1 - int(y * height), int(x / ASPECT * width)]
            assert pixel.argmax() == channel and np.sort(pixel)[2] > 2 * np.sort(pixel)[1], (name, channel, pixel)


def test_what_is_nearer_covers_what_is_farther():
    camera = Camera([[-1, -1, -1], [1, 1, 1]], ASPECT)
    red = shapes.placed("sphere", 0.9 * camera.back, 0.5, (1, 0, 0, 1))
    box = shapes.placed("box", -0.9 * camera.back, 0.5, (0, 0, 1, 1))
    for solids in ([red, box], [box, red]):
        image = picture.render([shapes.Node("n", np.eye(4), solids)], np.zeros((1, 2, 3)), camera)
        r, _, b = image.getpixel((image.width // 2, image.height // 2))
        assert r > 230 > 2 * b  # and is lit from where we are


def unpacked(packed):
    return [umsgpack.unpackb(command) for command in packed]


def test_meshcat_gets_the_transforms(viewer):
    found = unpacked(commands.changes({}, commands.properties(drawn(viewer).nodes)))
    moved = {c["path"]: np.reshape(c["matrix"], (4, 4)).T for c in found if c["type"] == "set_transform"}
    np.testing.assert_allclose(moved["meshcat/frames/b"], A_T_B, atol=1e-9)
    np.testing.assert_allclose(moved["meshcat/frames/c"], A_T_B @ B_T_C, atol=1e-9)
    # three.js's cone has its tip at y = +0.5: the first axis' tip, in its frame, is 1 m along x
    np.testing.assert_allclose(moved["meshcat/frames/b/solid1"] @ [0, 0.5, 0, 1], [1, 0, 0, 1], atol=1e-9)


@pytest.mark.parametrize("kind", ["sphere", "cylinder", "cone", "box"])
def test_a_translucent_solid_shows_no_edges_between_its_faces(kind):
    """Where two faces meet, the picture is as dark as on one of the two."""
    camera = Camera([[-1, -1, -1], [1, 1, 1]], ASPECT)
    images = []
    for opacity in (1, 0.3):
        solid = shapes.placed(kind, (0, 0, 0), 1.5, (0.2, 0.2, 0.2, opacity))
        node = shapes.Node("n", np.eye(4), [solid])
        images.append(np.array(picture.render([node], np.zeros((0, 2, 3)), camera)).astype(float))
    opaque, translucent = images
    np.testing.assert_allclose(translucent, 255 - 0.3 * (255 - opaque), atol=3)


def test_names_may_contain_slashes(viewer):
    viewer.add_frame("arm/c", np.eye(4), parent="b")
    viewer.add_frame("arm_c", np.eye(4), parent="b")
    paths = [node.path for node in drawn(viewer).nodes]
    assert len(set(paths)) == len(paths) and all(path.count("/") == 1 for path in paths)


# In a browser

FLAGS = [*CHROMIUM_FLAGS, "--headless", "--virtual-time-budget=8000", "--window-size=800,500", "--dump-dom"]


@pytest.fixture
def dom(chromium, tmp_path):
    """dom(text, *flags): the elements that Chromium makes of a page."""

    def elements(text, *flags):
        (tmp_path / "page.html").write_text(text)
        command = [
            chromium,
            *FLAGS,
            *flags,
            f"--user-data-dir={tmp_path / 'profile'}",
            (tmp_path / "page.html").as_uri(),
        ]
        return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=True).stdout

    return elements


def test_the_page_draws_the_scene_as_seen_by_the_camera(viewer, dom):
    viewer.add_point("</script><b>1", (1, 1, 1))
    found = drawn(viewer)
    camera = Camera(found.seen, ASPECT)
    probe = """<script>setTimeout(() => {
      const frames = window.viewer.scene_tree.find(["meshcat", "frames"]).children;
      const v = window.viewer;
      const p = frames.c.object.position.clone().setFromMatrixPosition(frames.c.object.matrixWorld).project(v.camera);
      const stray = [...document.body.childNodes].filter(node => node.nodeType === 3).map(node => node.data.trim()).join("");
      document.body.dataset.found = JSON.stringify({names: Object.keys(frames), place: [p.x, p.y], stray});
    }, 3000)</script></body>"""
    elements = dom(page.render(found, "a", "overview").replace("</body>", probe), *SOFTWARE_WEBGL)
    found = html.unescape(re.search(r'data-found="([^"]*)"', elements)[1])
    assert '"names":["a","b","c"]' in found and '"stray":""' in found
    x, y = camera.project(viewer.lookup("a", "c")[:3, 3])[0]
    width, height = map(float, re.search(r"<canvas[^>]*width: ([\d.]+)px; height: ([\d.]+)px", elements).groups())
    place = [float(v) for v in re.search(r'"place":\[([^,]*),([^\]]*)\]', found).groups()]
    expected = [(x - ASPECT / 2) * 2 * height / width, 2 * y - 1]  # from -1 to 1 across the window
    np.testing.assert_allclose(place, expected, atol=1e-3)
    labels = re.findall(r'<div class="label"[^>]*>(.*?)</div>', elements)
    axes = [f"{letter}<sub>{name}</sub>" for letter in "xyz" for name in "ABC"]
    assert sorted(labels) == sorted([*axes, "a", "b", "c", html.escape("</script><b>1")])


def test_without_webgl_the_picture_remains(viewer, dom):
    elements = dom(viewer.html(), "--disable-3d-apis")
    assert "<iframe" not in elements
    with_webgl = dom(viewer.html(), *SOFTWARE_WEBGL)
    assert "<iframe" in with_webgl
    assert Image.open(io.BytesIO(base64.b64decode(re.search(PICTURE, elements)[1]))).width > 700


def test_a_hand_is_a_right_hand_along_the_axes_of_its_frame():
    viewer = Viewer("a")
    viewer.add_frame("b", tft.rotation_matrix(0.7, [1, 2, 3]), length=0.1)
    viewer.add_hand("b", length=0.1)
    node = next(node for node in drawn(viewer).nodes if node.path == "hands/b")
    np.testing.assert_allclose(node.transform, viewer.lookup("a", "b"))
    tips = np.array([solid.matrix[:3, 3] for solid in node.solids if solid.kind == "sphere"])
    index, middle, thumb = tips[np.argmax(tips, axis=0)]
    for tip, axis in zip(
        (index, middle, thumb), np.eye(3)
    ):  # each straight along its axis, and no longer than the axis
        assert tip @ axis > 0.08 and tip @ axis < 0.1
        np.testing.assert_allclose(tip * (1 - axis), 0, atol=1e-12)
    wrist = min((solid.matrix[:3, 3] for solid in node.solids), key=lambda place: place[0])
    assert wrist[0] < -0.1  # behind the fingers
    with pytest.raises(ValueError, match="c"):
        viewer.add_hand("c")
