"""The animations that explain, the controls, and the flat plots: what they show at each moment, and what they refuse."""

import base64
import gzip
import html
import json
import math
import re

import numpy as np
import pytest
from transform_lab import (
    Point,
    Pose,
    Quaternion,
    Viewer,
    animate_approach,
    animate_chain,
    animate_determinant,
    animate_inverse,
    animate_journey,
    animate_mirrors,
    animate_retelling,
    animate_rotation,
    plot_columns,
    plot_from_above,
    plot_quaternion,
    tft,
)
from transform_lab.viewing.motion import MOST_STATES, STATES, control
from transform_lab.viewing.page import SAFE

pytestmark = pytest.mark.filterwarnings("ignore:zmq.eventloop.ioloop is deprecated")  # by meshcat

STEP = np.array([[0.0, -1, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0.2], [0, 0, 0, 1]])
TILTED = tft.euler_matrix(0.4, -0.7, 2.0)
TILTED[:3, 3] = [0.3, -0.2, 0.9]
H = math.sqrt(0.5)
OBJECT = Pose(Point(0.6, -0.1, 0.7), Quaternion(0, 0, 0.38268343, 0.92387953))
STOP = Pose(Point(0.529289, -0.170711, 0.7), Quaternion(0, 0, 0.38268343, 0.92387953))
OLD_HAND = Pose(Point(0.5, -0.1, 0.7), Quaternion(0, 0, 0.38268343, 0.92387953))


def at(viewer, moment):
    """The scene of an animation at a moment."""
    return viewer._motion.scene(viewer, moment, strict=True)


# Animations


@pytest.mark.parametrize(
    "rotation, degrees, axis",
    [
        ([0.5, 0.5, 0.5, 0.5], 120, [1, 1, 1]),
        (tft.rotation_matrix(math.pi, [0, 0, 1]), 180, [0, 0, 1]),
        (tft.rotation_matrix(0.5, [1, 2, 3])[:3, :3], math.degrees(0.5), [1, 2, 3]),
        ([0, 0, -H, -H], 270, [0, 0, -1]),
        ([0, 0, 0, -1], 360, [0, 0, 1]),
        (np.eye(3), 0, [0, 0, 1]),
    ],
)
def test_a_rotation_grows_to_its_angle_about_its_axis(rotation, degrees, axis):
    viewer = animate_rotation(rotation)
    for moment in (0, 0.3, 1):
        expected = tft.rotation_matrix(moment * math.radians(degrees), axis)
        scene = at(viewer, moment)
        np.testing.assert_allclose(scene.lookup("frame_a", "frame_b"), expected, atol=1e-9)
        assert f"{moment * degrees:.0f}° about" in scene.text


def test_a_chain_is_put_together_link_by_link():
    viewer = animate_chain(STEP, TILTED, STEP)
    assert list(at(viewer, 0).frames) == ["A", "B"]
    np.testing.assert_allclose(at(viewer, 0).lookup("A", "B"), np.eye(4), atol=1e-9)
    half = at(viewer, 0.5)
    assert list(half.frames) == ["A", "B", "C"]
    np.testing.assert_allclose(half.lookup("A", "B"), STEP, atol=1e-9)
    np.testing.assert_allclose(half.lookup("B", "C")[:3, 3], TILTED[:3, 3] / 2, atol=1e-9)
    end = at(viewer, 1)
    np.testing.assert_allclose(end.lookup("A", "D"), STEP @ TILTED @ STEP, atol=1e-9)
    assert "a_T_d = a_T_b @ b_T_c @ c_T_d" in end.text
    assert f"{(STEP @ TILTED @ STEP)[0, 3]:7.3f}" in end.text


def test_an_inverse_is_the_same_frames_from_the_other_side():
    viewer = animate_inverse(TILTED)
    for moment in (0, 0.4, 0.6, 1):
        np.testing.assert_allclose(at(viewer, moment).lookup("A", "B"), TILTED, atol=1e-9)
    np.testing.assert_allclose(at(viewer, 0).lookup("you", "A"), np.eye(4), atol=1e-9)
    np.testing.assert_allclose(at(viewer, 1).lookup("you", "B"), np.eye(4), atol=1e-9)
    assert "A. a_T_b" in at(viewer, 0).text and "B. b_T_a" in at(viewer, 1).text
    assert f"{np.linalg.inv(TILTED)[1, 3]:7.3f}" in at(viewer, 1).text


def test_an_approach_stops_at_the_pre_grasp_pose_and_a_wrong_one_misses():
    viewer = animate_approach(OBJECT, STOP, wrong_pose=OLD_HAND)
    stop, end = at(viewer, 0.55), at(viewer, 1)
    np.testing.assert_allclose(stop.lookup("pre-grasp", "gripper_link"), np.eye(4), atol=1e-6)
    np.testing.assert_allclose(end.lookup("object", "gripper_link"), np.eye(4), atol=1e-5)
    missed = np.linalg.norm(end.lookup("object", "wrong")[:3, 3])
    assert f"wrong ends {100 * missed:.1f} cm from the object; gripper_link ends 0.0 cm" in end.text
    assert missed > 0.05


@pytest.mark.parametrize("degrees", [30, 90, 180, -120])
@pytest.mark.parametrize("point", [(0.9, -0.3, 0.2), (0, 1, 0), (-0.2, 0.5, -1)])
def test_two_mirrors_turn_by_twice_their_angle_and_are_the_quaternion(degrees, point):
    viewer = animate_mirrors(degrees, point)
    turn = tft.rotation_matrix(math.radians(degrees), [0, 0, 1])
    scene = at(viewer, 1)
    np.testing.assert_allclose(scene.points["twice mirrored"].position, turn[:3, :3] @ point, atol=1e-12)
    _, _, z, w = tft.quaternion_about_axis(math.radians(degrees), [0, 0, 1])
    assert scene.text.endswith(f"w = cos {degrees / 2:g}° = {w:.4f}   z = sin {degrees / 2:g}° = {z:.4f}")
    middle = at(viewer, 0.25).points["once mirrored"].position
    assert abs(middle[1]) < 1e-12  # half of the way it is in the first mirror, which stands along x


@pytest.mark.parametrize("matrix", [np.diag([1, 1, -1]), np.diag([2, 0.5, 1]), [[1, 0.5, 0], [0, 1, 0], [0, 0, 1]]])
def test_a_determinant_is_the_volume_of_the_box_that_the_columns_span(matrix):
    viewer = animate_determinant(matrix)
    scene = at(viewer, 1)
    assert f"volume {np.linalg.det(matrix):.2f}" in scene.text
    (published,) = scene.markers.values()
    corners = {tuple(np.round([p.x, p.y, p.z], 9)) for p in published.marker.points}
    wanted = {tuple(np.round(np.array(matrix) @ [i & 1, i >> 1 & 1, i >> 2 & 1], 9)) for i in range(8)}
    assert corners == wanted and len(published.marker.points) == 24


def test_a_mirrored_box_is_flat_on_its_way():
    assert [line.split("   ")[1] for line in (at(animate_determinant(np.diag([1, 1, -1])), moment).text.splitlines()[-1]
            for moment in (0, 0.5, 1))] == ["a right hand", "flat: no volume", "a left hand"]  # fmt: skip


def test_a_point_stays_while_one_frame_after_the_other_tells_of_it():
    p_in_c, c_in_a = [0.5, 0.3, 0.4], STEP @ TILTED
    viewer = animate_retelling(STEP, TILTED, p_in_c)
    p_in_a = (c_in_a @ [*p_in_c, 1])[:3]
    for moment in (0, 0.2, 0.5, 0.8, 1):
        arrows = list(at(viewer, moment).arrows.values())
        np.testing.assert_allclose(arrows[-1].tip, p_in_a, atol=1e-12)
        assert all(np.allclose(one.tip, other.tail) for one, other in zip(arrows, arrows[1:]))
    told = [at(viewer, moment) for moment in (0, 0.5, 1)]
    assert [scene.text.splitlines()[0] for scene in told] == ["p_c", "p_b = b_T_c p_c", "p_a = a_T_b b_T_c p_c"]
    for scene, origin in zip(told, (c_in_a[:3, 3], STEP[:3, 3], [0, 0, 0])):
        np.testing.assert_allclose(next(iter(scene.arrows.values())).tail, origin, atol=1e-12)


def test_a_journey_leads_from_stop_to_stop_and_takes_the_object_along():
    stops = {"pre-grasp": STOP, "grasp": OBJECT, "lift": Pose(Point(0.6, -0.1, 0.85), OBJECT.orientation)}
    viewer = animate_journey(OBJECT, stops, {**stops, "lift": STOP})
    for moment, pose in zip((0, 0.5, 1), stops.values()):
        place = at(viewer, moment).lookup("base_link", "gripper_link")[:3, 3]
        np.testing.assert_allclose(place, [pose.position.x, pose.position.y, pose.position.z], atol=1e-9)
    frames = [at(viewer, moment).boxes["block"].frame for moment in (0.25, 0.5, 0.75)]
    assert frames == ["base_link", "base_link", "gripper_link"]
    wrong = at(viewer, 1).lookup("base_link", "mistake")[:3, 3]
    np.testing.assert_allclose(wrong, [STOP.position.x, STOP.position.y, STOP.position.z], atol=1e-9)


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: animate_rotation(np.diag([1, 1, -1])), "determinant is -1"),
        (lambda: animate_rotation([0, 0, 1, 1]), "length 1; it is 1.414"),
        (lambda: animate_rotation([0, 0, math.nan, 1]), "NaN"),
        (lambda: animate_chain(), "one transform or more"),
        (lambda: animate_chain(STEP, STEP, names="AB"), "one name more; got 2, 2"),
        (lambda: animate_chain(STEP, STEP.T), "transform 2 must have the bottom row"),
        (lambda: animate_chain([STEP, STEP]), r"write animate_chain\(\*transforms\)"),
        (lambda: animate_rotation(np.eye(3), names=("a",)), "must be those of two frames"),
        (lambda: animate_inverse(STEP, names=("a",)), "must be those of two frames"),
        (lambda: animate_inverse(np.zeros((4, 4))), "bottom row"),
        (lambda: animate_approach(Pose(), STOP), "no orientation"),
        (lambda: Viewer().animate(lambda scene, moment: None, seconds=0), "seconds must be a number above 0"),
        (lambda: Viewer().animate(lambda scene, moment: None, seconds=math.inf), "seconds must be a number above 0"),
    ],
)
def test_what_cannot_be_animated_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()


def test_all_states_of_an_animation_are_in_its_page_and_nothing_is_left_behind():
    viewer = animate_chain(STEP, STEP)
    _, states, _ = viewer._drawings(viewer.state())
    assert len(states) == STATES
    assert "C" not in states[0].frames and "C" in states[-1].frames
    np.testing.assert_allclose(states[-1].frames["C"], STEP @ STEP, atol=1e-9)
    assert list(viewer.frames) == ["A"]  # the animation adds to a copy
    assert "frame C in B" in viewer.description()  # the words tell of what is shown


# Controls


def turn(scene, degrees, axis="z"):
    scene.add_frame("b", tft.rotation_matrix(math.radians(degrees), {"x": [1, 0, 0], "z": [0, 0, 1]}[axis]))
    return np.array([degrees])


def test_controls_start_in_the_middle_or_at_the_default():
    viewer = Viewer("a").interact(turn, degrees=(0, 90, 30), axis=["x", "z"])
    assert viewer._motion.arguments == {"degrees": 60, "axis": "z"}
    np.testing.assert_allclose(viewer.state().lookup("a", "b"), tft.rotation_matrix(math.radians(60), [0, 0, 1]))
    assert viewer.state().text == "[60]"


def test_a_few_states_are_computed_for_notebooks_without_a_kernel():
    motion = Viewer("a").interact(turn, degrees=(0, 90, 30), axis=["x", "z"])._motion
    assert len(motion.settings()) == 8
    assert motion.settings()[motion.start] == motion.arguments
    long = Viewer("a").interact(lambda scene, degrees=7: None, degrees=(0, 360))._motion
    assert 30 < len(long.settings()) <= MOST_STATES and long.settings()[long.start] == {"degrees": 7}
    many = Viewer("a").interact(lambda scene, p, q: None, p=(0.0, 1.0), q=(0.0, 1.0))._motion
    assert many.settings() == []


@pytest.mark.parametrize(
    "motion",
    [
        lambda viewer, show: viewer.interact(show, moment=(0, 90)),
        lambda viewer, show: viewer.interact(show, moment=(0, 1000)),
        lambda viewer, show: viewer.animate(show),
    ],
)
def test_a_display_computes_each_state_once(motion, monkeypatch, capsys):
    asked = []

    def show(scene, moment):
        asked.append(moment)
        print("asked")

    viewer = motion(Viewer("a"), show)
    states = viewer._motion.settings()
    asked.clear()
    capsys.readouterr()
    viewer._repr_mimebundle_()
    assert sorted(asked) == sorted(state["moment"] if isinstance(state, dict) else state for state in states)
    assert capsys.readouterr().out == "asked\n"  # of the state that is shown
    asked.clear()
    monkeypatch.setenv("TRANSFORM_LAB_GRADING", "1")
    viewer._repr_mimebundle_()
    assert len(asked) == 1


def test_an_error_of_the_function_is_raised_at_first_and_shown_later():
    def fails_at_90(scene, degrees):
        return 1 / (90 - degrees)

    viewer = Viewer("a").interact(fails_at_90, degrees=(0, 90, 45))
    assert viewer._motion.scene(viewer, {"degrees": 90}).text == "ZeroDivisionError: division by zero"
    with pytest.raises(ZeroDivisionError):
        Viewer("a").interact(fails_at_90, degrees=[90])


@pytest.mark.parametrize(
    "choices", [(90, 0), (0, 90, 0), (0, 90, 100), (0, 1, 2, 3), (0.0, 1.0, 1e-9), ("a", "b"), 5, "xyz", [], None]
)
def test_what_is_no_control_says_what_is(choices):
    with pytest.raises(ValueError, match=r"angle=.*(use \(min, max\)|the step must lead)"):
        control("angle", choices)


@pytest.mark.parametrize(
    "choices, default, message",
    [
        ((0, 90), 500, "the default 500 is not between min and max"),
        ((0, 90), None, "the default None is not between min and max"),
        (["a", "b"], "c", "the default 'c' is not one of these"),
        ((0, math.inf), 1, "use (min, max)"),
    ],
)
def test_a_default_that_is_not_among_the_choices_is_refused(choices, default, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        control("angle", choices, default)


def test_controls_take_numbers_of_numpy_and_options_of_any_kind():
    assert control("n", (np.int64(0), np.int64(4))).values == [0, 1, 2, 3, 4]
    one, other = np.eye(3), np.zeros(3)
    assert control("R", [one, other], other).index == 1
    assert control("any", [None, 1, "1"], "1").index == 2


def test_very_many_combinations_are_not_computed():
    names = [f"p{i}" for i in range(8)]
    motion = Viewer("a").interact(lambda scene, **values: None, **{name: (0, 360) for name in names})._motion
    assert motion.settings() == []


def test_the_viewers_text_stays_where_a_function_returns_none():
    viewer = Viewer("a")
    viewer.text = "hello"
    assert viewer.interact(lambda scene, n: None, n=[1]).state().text == "hello"
    assert viewer.interact(lambda scene, n: n, n=[1]).state().text == "1"


def test_what_is_looked_at_may_come_later():
    viewer = animate_chain(STEP, STEP).look(at=["C"])
    assert "<iframe" in viewer.figure()


def test_only_frames_of_every_state_can_be_the_fixed_one():
    page = animate_chain(STEP, STEP).figure()
    assert page.count("<iframe") == 1
    view = told(animate_chain(STEP, STEP))
    assert [frame["name"] for frame in view["frames"]] == ["A", "B"]


def told(viewer):
    """What the page of a viewer is told, in words and numbers."""
    source = re.search(r'srcdoc="([^"]*)"', viewer.figure())[1]
    packed = re.search(r"showScene\(await unpacked\(`([^`]*)`", html.unescape(source))[1]
    data = gzip.decompress(base64.b85decode(packed.translate({new: old for old, new in SAFE.items()})))
    return json.loads(data[8 : 8 + int.from_bytes(data[4:8], "big")])


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda v: v.animate(lambda moment: None), r"the function must take \(scene, moment\)"),
        (lambda v: v.interact(lambda x: None, x=(0, 3)), r"the function must take \(scene, x\)"),
        (lambda v: v.animate(3), "must be a function; got int"),
    ],
)
def test_a_function_of_other_arguments_is_refused(call, message):
    with pytest.raises(TypeError, match=message):
        call(Viewer("a"))


def test_a_function_that_adds_to_the_viewer_is_told():
    viewer = Viewer("a")
    with pytest.raises(ValueError, match="must add to the scene it is given, and not to the viewer"):
        viewer.animate(lambda scene, moment: viewer.add_frame("b", np.eye(4)))


def test_a_viewer_knows_what_its_controls_add():
    viewer = Viewer("a").interact(turn, degrees=(0, 90, 45))
    np.testing.assert_allclose(viewer.lookup("a", "b"), tft.rotation_matrix(math.radians(45), [0, 0, 1]))
    viewer.fixed_frame = "b"
    assert "<iframe" in viewer.figure()


def test_a_fixed_frame_that_is_taken_away_leaves_the_root():
    def appears(scene, there):
        if there:
            scene.add_frame("b", STEP)

    viewer = Viewer("a").interact(appears, there=True)
    viewer.fixed_frame = "b"
    viewer._motion.controls[0].index = 1
    assert "Fixed frame a." in viewer.figure()
    assert viewer.description().startswith("Scene in the fixed frame a")
    assert plot_from_above(viewer).get_xlabel() == "x of a"


def test_numbers_of_a_slider_are_written_in_full():
    assert control("n", (1000000, 1000010)).as_json()["values"][3] == "1000003"
    assert control("x", (0.0, 1e-9)).as_json()["values"][1] == "1e-11"


def test_a_missing_control_is_named():
    with pytest.raises(ValueError, match="give a control for degrees, such as degrees="):
        Viewer("a").interact(turn, axis=["x"])
    with pytest.raises(ValueError, match="at least one control"):
        Viewer("a").interact(lambda scene: None)


# Flat plots


@pytest.fixture(autouse=True)
def no_windows():
    import matplotlib
    import matplotlib.pyplot as plt

    matplotlib.use("agg")
    yield
    plt.close("all")


def arrows(ax):
    """The ends (tail, tip) of the arrows in a plot."""
    return [(np.array(note.xyann), np.array(note.xy)) for note in ax.texts if getattr(note, "arrow_patch", None)]


def test_columns_are_drawn_as_arrows():
    a_R_b = tft.rotation_matrix(0.6, [0, 0, 1])[:3, :3]
    tips = [tip for _, tip in arrows(plot_columns(a_R_b))]
    np.testing.assert_allclose(tips, [[1, 0], [0, 1], a_R_b[:2, 0], a_R_b[:2, 1]], atol=1e-9)


def test_a_quaternion_against_its_angle():
    ax = plot_quaternion([0, 0, 2])
    lines = {line.get_label(): line for line in ax.lines}
    degrees = lines["z"].get_xdata()
    np.testing.assert_allclose(lines["z"].get_ydata(), np.sin(np.radians(degrees) / 2), atol=1e-9)
    np.testing.assert_allclose(lines["w"].get_ydata()[[0, -1]], [1, 1], atol=1e-9)
    assert lines["w"].get_ydata()[list(degrees).index(360)] == pytest.approx(-1)
    assert len({line.get_linestyle() for line in ax.lines}) == 4  # colour is not the only cue


def test_a_scene_from_above_is_drawn_in_the_fixed_frame():
    viewer = Viewer("base_link")
    viewer.add_frame("object", OBJECT, length=0.05)
    viewer.add_box("object", (0.04, 0.04, 0.1), frame="object")
    viewer.add_arrow("up", (0, 1, 0), tail=(0.5, 0, 0))
    viewer.fixed_frame = "object"
    tails = [tuple(tail.round(6)) for tail, _ in arrows(plot_from_above(viewer))]
    base_in_object = np.linalg.inv(viewer.lookup("base_link", "object"))[:2, 3]
    arrow_in_object = np.linalg.inv(viewer.lookup("base_link", "object")) @ [0.5, 0, 0, 1]
    assert tuple(arrow_in_object[:2].round(6)) in tails
    assert (0, 0) in tails and tuple(base_in_object.round(6)) in tails


def test_a_plot_shows_what_an_animation_or_controls_add():
    viewer = Viewer("a").interact(turn, degrees=(0, 90, 45))
    assert [text.get_text() for text in plot_from_above(viewer).texts if text.get_text()] == [*"XYa", *"XYb"]


@pytest.mark.parametrize(
    "call, message",
    [
        (lambda: plot_columns(np.eye(4)), "3x3"),
        (lambda: plot_quaternion([0, 0, 0]), "must not be 0, 0, 0"),
    ],
)
def test_what_cannot_be_plotted_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
