"""A ROS node that does what rviz.py asks of it, a line of JSON each. It runs in the system's Python, which has ROS."""

import json
import queue
import re
import sys

import geometry_msgs.msg
import rosgraph_msgs.msg
import rospy
import std_msgs.msg
import tf2_msgs.msg
import visualization_msgs.msg as vis

LAST = 4711  # the type of a marker that RViz is sure to say something of


def filled(message, fields):
    """`message` with the values of `fields`, what json makes of one of transform_lab's messages."""
    for name, value in fields.items():
        if name == "points":
            value = [filled(geometry_msgs.msg.Point(), each) for each in value]
        elif name == "colors":
            value = [filled(std_msgs.msg.ColorRGBA(), each) for each in value]
        elif name in ("lifetime", "stamp"):
            value = (rospy.Time if name == "stamp" else rospy.Duration).from_sec(value)
        elif isinstance(value, dict):
            value = filled(getattr(message, name), value)
        setattr(message, name, value)
    return message


def connected(name, kind, **options):
    """A publisher to a topic that somebody listens to."""
    publisher = rospy.Publisher(name, kind, queue_size=1000, **options)
    while not publisher.get_num_connections():
        rospy.sleep(0.02)
    return publisher


def interactive(number, fields):
    """An interactive marker of one marker, whose fields are given."""
    control = vis.InteractiveMarkerControl(always_visible=True, markers=[filled(vis.Marker(), fields)])
    made = vis.InteractiveMarker(name=str(number), scale=1, controls=[control])
    made.header.frame_id = "frame_a"
    made.pose.orientation.w = 1
    return made


def remarks(markers, said):
    """What RViz logs of markers in interactive ones: what its panel shows, without a log, of those by themselves."""
    marks = [interactive(i, fields) for i, fields in enumerate([*markers, {"type": LAST}])]
    update = connected("/remarks/update", vis.InteractiveMarkerUpdate)
    init = rospy.Publisher("/remarks/update_full", vis.InteractiveMarkerInit, queue_size=1, latch=True)
    init.publish(vis.InteractiveMarkerInit(server_id="tests", seq_num=1, markers=marks))
    found = {}
    while len(markers) not in found:
        update.publish(vis.InteractiveMarkerUpdate(server_id="tests", seq_num=1))  # a sign of life, which it waits for
        try:
            entry = said.get(timeout=0.2)
        except queue.Empty:
            continue
        if called := re.match(r"Marker '(\d+)/\d+': (.*)", entry.msg, re.DOTALL):  # by the interactive marker's name
            found[int(called[1])] = entry.level, called[2]
    return [found.get(i) for i in range(len(markers))]


def main():
    rospy.init_node("tests", disable_signals=True)
    said = queue.Queue()
    rospy.Subscriber("/rosout", rosgraph_msgs.msg.Log, said.put)
    markers = connected("/visualization_marker", vis.Marker)
    frames = connected("/tf_static", tf2_msgs.msg.TFMessage, latch=True)
    print("ready", flush=True)
    for line in sys.stdin:
        task, values = json.loads(line)
        answer = None
        if task == "draw":
            for fields in values:
                markers.publish(filled(vis.Marker(), fields))
        elif task == "frame":
            frame = geometry_msgs.msg.TransformStamped(child_frame_id=values["name"])
            frame.header.frame_id = "frame_a"
            filled(frame.transform, values["transform"])
            frames.publish(tf2_msgs.msg.TFMessage([frame]))
        else:
            answer = remarks(values, said)
        print(json.dumps(answer), flush=True)


main()
