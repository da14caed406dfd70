"""The messages behave as those of ROS 1 do."""

import copy
import dataclasses
import pickle

import pytest
from transform_lab.lab_markers import arrow_marker, axis_marker
from transform_lab.messages import ColorRGBA, Header, Marker, Point, Pose, PoseStamped, Quaternion, Vector3
from transform_lab.rostime import Duration, Time

FIELDS = {
    Point: "x y z",
    Vector3: "x y z",
    Quaternion: "x y z w",
    Pose: "position orientation",
    Header: "seq stamp frame_id",
    PoseStamped: "header pose",
    ColorRGBA: "r g b a",
    Marker: "header ns id type action pose scale color lifetime frame_locked points colors text mesh_resource"
    " mesh_use_embedded_materials",
}


@pytest.mark.parametrize("kind", FIELDS)
def test_fields_and_their_order(kind):
    assert " ".join(f.name for f in dataclasses.fields(kind)) == FIELDS[kind]
    values = list(range(1, len(FIELDS[kind].split()) + 1))
    message = kind(*values)
    assert [getattr(message, name) for name in FIELDS[kind].split()] == values
    assert message == kind(**dict(zip(FIELDS[kind].split(), values)))


def test_defaults():
    assert Point() == Point(0, 0, 0)
    assert Quaternion() == Quaternion(0, 0, 0, 0)
    assert Pose() == Pose(Point(0, 0, 0), Quaternion(0, 0, 0, 0))
    assert Header() == Header(0, 0, "")
    marker = Marker()
    assert (marker.type, marker.action, marker.ns, marker.points, marker.frame_locked) == (0, 0, "", [], False)
    assert isinstance(marker.header.stamp, Time) and isinstance(marker.lifetime, Duration)
    assert isinstance(marker.scale, Vector3) and isinstance(marker.color, ColorRGBA)
    assert isinstance(Point().x, float)


def test_defaults_are_fresh_for_each_message():
    first, second = PoseStamped(), PoseStamped()
    first.pose.position.x = 1
    first.header.frame_id = "a"
    first.header.stamp.secs = 1
    assert second == PoseStamped()
    marker = Marker()
    marker.points.append(Point())
    assert Marker().points == []


def test_keywords_set_some_fields_and_none_means_the_default():
    assert Pose(position=Point(1, 2, 3)).orientation == Quaternion()
    assert Pose(None, Quaternion(0, 0, 0, 1)).position == Point()


@pytest.mark.parametrize("arguments", [(1,), (1, 2), (1, 2, 3, 4)])
def test_wrong_number_of_positional_arguments(arguments):
    with pytest.raises(TypeError, match=r"Invalid number of arguments, args should be \['x', 'y', 'z'\]"):
        Point(*arguments)


def test_position_and_name_do_not_mix():
    with pytest.raises(TypeError, match="by position or by name, not both"):
        Point(1, 2, z=3)


def test_unknown_fields():
    with pytest.raises(AttributeError, match="q is not an attribute of Point"):
        Point(q=1)
    pose = Pose()
    with pytest.raises(AttributeError, match="q"):
        pose.orientation.q = 1
    with pytest.raises(AttributeError):
        Marker().colour = ColorRGBA()


def test_assignment_is_not_checked():
    pose = Pose()
    pose.orientation = [0, 0, 0, 1]
    assert pose.orientation == [0, 0, 0, 1]


def test_equality_is_by_kind_and_fields():
    assert Point(1, 2, 3) != Point(1, 2, 4)
    assert Point(1, 2, 3) != Vector3(1, 2, 3)
    assert PoseStamped(Header(0, 0, "a"), Pose()) != PoseStamped(Header(0, 0, "b"), Pose())


def test_copies():
    stamped = PoseStamped(header=Header(0, Time(1, 2), "a"))
    assert copy.deepcopy(stamped) == pickle.loads(pickle.dumps(stamped)) == stamped
    pose = Pose(Point(1, 2, 3), Quaternion(0, 0, 0, 1))
    for clone in (copy.deepcopy(pose), pickle.loads(pickle.dumps(pose))):
        assert clone == pose
        clone.position.x = 9
        assert pose.position.x == 1


def test_repr_is_a_constructor_call():
    for stamp in (2.0, Time(2, 5)):
        stamped = PoseStamped(Header(1, stamp, "base"), Pose(Point(1, 2, 3), Quaternion(0, 0, 0, 1)))
        assert eval(repr(stamped)) == stamped
    assert eval(repr(Marker(lifetime=Duration(-1.5)))) == Marker(lifetime=Duration(-1.5))
    assert repr(Point(1, 2.5, 3)) == "Point(x=1, y=2.5, z=3)"


def test_str_is_the_text_of_ros():
    """Of any message, see test_messages_on_a_robot.py."""
    assert str(Pose(Point(1, 2, 3), Quaternion(0, 0, 0, 1))) == (
        "position: \n  x: 1\n  y: 2\n  z: 3\norientation: \n  x: 0\n  y: 0\n  z: 0\n  w: 1"
    )
    assert str(Header()) == "seq: 0\nstamp: \n  secs: 0\n  nsecs:         0\nframe_id: ''"
    assert str(Header(0, 0, "base")).endswith('frame_id: "base"')
    text = str(Marker(points=[Point(1, 2, 3)]))
    assert "points: \n  - \n    x: 1\n    y: 2\n    z: 3\ncolors: []" in text
    assert str(Header(0, 2.5, 'a "b"\\\né')) == """seq: 0\nstamp: 2.5\nframe_id: "a \\"b\\"\\\\\\n\\xE9\""""


def test_marker_constants():
    names = "ARROW CUBE SPHERE CYLINDER LINE_STRIP LINE_LIST CUBE_LIST SPHERE_LIST POINTS TEXT_VIEW_FACING"
    names += " MESH_RESOURCE TRIANGLE_LIST"
    assert [getattr(Marker, name) for name in names.split()] == list(range(12))
    assert (Marker.ADD, Marker.MODIFY, Marker.DELETE, Marker.DELETEALL) == (0, 0, 2, 3)
    assert Marker().LINE_LIST == Marker.LINE_LIST


def test_axis_marker_is_that_of_the_lab():
    stamped = PoseStamped(Header(0, 0, "frame_a"), Pose(Point(0, 0, 0.5), Quaternion(0, 0, 0, 1)))
    marker = axis_marker(stamped)
    assert (marker.ns, marker.type, marker.scale.x) == ("axes", Marker.LINE_LIST, 0.1)
    assert marker.header is stamped.header and marker.pose is stamped.pose
    origin = Point(0, 0, 0)
    assert marker.points == [origin, Point(1, 0, 0), origin, Point(0, 1, 0), origin, Point(0, 0, 1)]
    red, green, blue = ColorRGBA(1, 0, 0, 1), ColorRGBA(0, 1, 0, 1), ColorRGBA(0, 0, 1, 1)
    assert marker.colors == [red, red, green, green, blue, blue]


def test_arrow_marker_is_that_of_the_lab():
    tip = Point(1, 2, 3)
    marker = arrow_marker(tip)
    assert (marker.ns, marker.type, marker.header.frame_id) == ("arrow", Marker.ARROW, "frame_a")
    assert marker.points == [Point(0, 0, 0), tip] and marker.points[1] is tip
    assert (marker.scale.x, marker.scale.y) == (0.1, 0.15)
    assert marker.color == ColorRGBA(1, 1, 0, 1)
