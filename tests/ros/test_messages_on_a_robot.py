"""Messages, Time and Duration say and compute what ROS's do: any message is printed and any expression computed by both."""

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from ros.programs.described import FIELDS, build, computed
from support import ROOT
from test_lab_script import run_script
from transform_lab import messages, rospy

OURS = {name: getattr(messages, name) for name in (*FIELDS, "Time", "Duration")}


@pytest.fixture(scope="module")
def genpy_says(ros):
    """genpy_says(question): what a program on the robot answers, which runs as long as there are questions."""
    with ros.conversation("genpy_says.py", ROOT / "source/transforms/transform_lab") as ask:
        yield ask


def message(kind, fields):
    """A strategy for messages of a kind, some of whose fields are given, by one strategy for each or for all."""
    names = FIELDS[kind].split()
    fields = fields if isinstance(fields, dict) else dict.fromkeys(names, fields)
    return st.fixed_dictionaries(
        {"kind": st.just(kind), "fields": st.fixed_dictionaries({}, optional={name: fields[name] for name in names})}
    )


WHOLE = st.integers(-(2**31), 2**31 - 1)
NSECS = st.integers(0, 10**9 - 1)
NUMPY = st.fixed_dictionaries(
    {"numpy": st.sampled_from(["float64", "float32", "int64", "bool_"]), "value": st.integers(-9, 9)}
)
NUMBERS = st.floats() | WHOLE | NUMPY | st.booleans()
TEXTS = st.text(max_size=100) | st.text('ab "\\\n\té€😀', max_size=250)
TIMES = st.fixed_dictionaries({"time": st.just("Time"), "secs": st.integers(0, 2**32 - 1), "nsecs": NSECS})
DURATIONS = st.fixed_dictionaries({"time": st.just("Duration"), "secs": WHOLE, "nsecs": NSECS})
POINTS, COLORS, VECTORS = message("Point", NUMBERS), message("ColorRGBA", NUMBERS), message("Vector3", NUMBERS)
POSES = message("Pose", {"position": POINTS, "orientation": message("Quaternion", NUMBERS)})
HEADERS = message("Header", {"seq": WHOLE, "stamp": TIMES | NUMBERS, "frame_id": TEXTS})
PLAIN_LISTS = st.lists(st.floats()) | st.lists(WHOLE) | st.lists(st.booleans()) | st.lists(NUMPY, max_size=3)


def lists(things):
    found = st.lists(things, max_size=3)
    return found | st.fixed_dictionaries({"tuple": found}) | PLAIN_LISTS


MARKERS = message(
    "Marker",
    {
        "header": HEADERS, "ns": TEXTS, "id": WHOLE, "type": WHOLE, "action": WHOLE, "pose": POSES, "scale": VECTORS,
        "color": COLORS, "lifetime": DURATIONS | NUMBERS, "frame_locked": st.booleans(), "points": lists(POINTS),
        "colors": lists(COLORS) | st.lists(TIMES, max_size=2), "text": TEXTS, "mesh_resource": TEXTS,
        "mesh_use_embedded_materials": st.booleans(),
    },
)  # fmt: skip
MESSAGES = POINTS | POSES | HEADERS | message("PoseStamped", {"header": HEADERS, "pose": POSES}) | MARKERS


@given(described=MESSAGES)
@example(described={"kind": "Marker", "fields": {"text": f'{"a b" * 25}\n{"é" * 30} " \\ {"c" * 200}', "ns": " "}})
def test_texts(genpy_says, described):
    theirs, mixed = genpy_says(described)
    assert str(build(described, OURS)) == theirs
    assert mixed == theirs


FACTORS = st.floats(-1e6, 1e6) | st.integers(-(10**6), 10**6)
ANY_TIME = (
    st.builds(
        "{}({}, {})".format,
        st.sampled_from(["Time", "Duration"]),
        st.integers(-3, 10**9),
        st.integers(-(10**10), 10**10),
    )
    | st.builds("{}({})".format, st.sampled_from(["Time", "Duration", "Time.from_sec", "Duration.from_sec"]), FACTORS)
    | st.builds("{}({})".format, st.sampled_from(["Time", "Duration"]), st.sampled_from(["", "1.5, 1", "'1'", "None"]))
)
OPERATORS = st.sampled_from("+ - * / // % < <= > >=".split())
EXPRESSIONS = (
    st.builds("{} {} {}".format, ANY_TIME, OPERATORS | st.sampled_from(["==", "!="]), ANY_TIME)
    | st.builds("{} {} {}".format, ANY_TIME, OPERATORS, FACTORS)
    | st.builds("{} {} {}".format, FACTORS, OPERATORS, ANY_TIME)
    | st.builds("{}({})".format, st.sampled_from(["abs", "-", "bool", "str", "float", "copy.deepcopy"]), ANY_TIME)
    | st.builds("{}.{}()".format, ANY_TIME, st.sampled_from("to_sec to_nsec to_time is_zero canon".split()))
    | st.builds("divmod({}, {})".format, ANY_TIME, ANY_TIME)
    | st.builds("(lambda t: [t.set(7, {}), t.secs, t.nsecs, t.canon(), t.secs, t.nsecs])({})".format, FACTORS, ANY_TIME)
)


@given(expression=EXPRESSIONS)
def test_times(genpy_says, expression):
    assert computed(expression, OURS) == genpy_says(expression)


def test_rospys_times_are_kept_by_what_is_computed_of_them():
    moment = rospy.Time(3) + rospy.Duration(0.5)
    assert type(moment) is rospy.Time and moment == messages.Time(3, 500_000_000)
    assert moment - rospy.Time(1) == rospy.Duration(2.5)


@pytest.mark.parametrize("kind", [messages.Time, messages.Duration])
def test_a_number_of_seconds_is_as_good_as_a_time(kind):
    """Not so in ROS, where it cannot be sent either."""
    assert kind() == 0 and kind(1.5) == 1.5 and kind(2) != 1.5 and 2 == kind(2)
    assert {kind(1.5): "found"}[1.5] == "found"
    assert messages.Header(0, 1.5, "a") == messages.Header(0, messages.Time(1.5), "a")
    assert messages.Time(1) != messages.Duration(1)


MIXED = """
import itertools
import genpy, geometry_msgs.msg, std_msgs.msg, visualization_msgs.msg as theirs
import transform_lab as ours
from transform_lab import rospy

rospy.init_node("mixed")
publishers = [rospy.Publisher("topic", kind, queue_size=1) for kind in (theirs.Marker, ours.visualization_msgs.msg.Marker)]
stamps = [genpy.Time(3), rospy.Time(3), rospy.Time.now(), 3, 3.5]
lifetimes = [genpy.Duration(2), rospy.Duration(2), 2, 0.5]
kinds = itertools.product([theirs.Marker, ours.Marker], [std_msgs.msg.Header, ours.Header], [geometry_msgs.msg, ours])
for marker_class, header_class, geometry in kinds:
    for stamp, lifetime in itertools.product(stamps, lifetimes):
        marker = marker_class(ns=f"{marker_class.__module__} {header_class.__module__} {geometry.__name__}", type=4)
        marker.header = header_class(0, stamp, "map")
        marker.pose = geometry.Pose(geometry.Point(1, 2, 3), geometry.Quaternion(0, 0, 0, 1))
        marker.points = [geometry.Point(), geometry.Point(1, 0, 0)]
        marker.color.a, marker.scale.x, marker.lifetime = 1, 0.1, lifetime
        if marker_class is ours.Marker:
            assert str(marker).count("nsecs:") == sum(hasattr(value, "nsecs") for value in (stamp, lifetime))
        for publisher in publishers:
            publisher.publish(marker)
for duration in (genpy.Duration(0, 1000), rospy.Duration(0, 1000), 1e-6):
    rospy.sleep(duration)
print(marker.header.seq, len(rospy._node.viewer.markers))
"""


def test_messages_of_both_kinds_are_published_here(ros, tmp_path):
    ran = run_script(MIXED, tmp_path, ros.messages(tmp_path))
    assert (ran.returncode, ran.stderr) == (0, "")
    assert ran.stdout.startswith("160 8\n")
    assert (tmp_path / "mixed.html").read_text().count("in map: LINE_STRIP at (1, 2, 3)") >= 8
