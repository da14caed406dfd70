"""Answers look-ups by tf2. Reads [{"frames": [[parent, child, [x, y, z], [x, y, z, w]]], "asked": [[target, source]]}], writes
for each a list of {"translation", "rotation"} or {"error": name of the exception, "says": its words}.
"""

import json
import sys

import rospy
import tf2_ros
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3


def lookup(buffer, target, source):
    try:
        found = buffer.lookup_transform_core(target, source, rospy.Time(0))
    except tf2_ros.TransformException as error:
        return {"error": type(error).__name__, "says": str(error)}
    assert (found.header.frame_id, found.child_frame_id) == (target, source)
    to, q = found.transform.translation, found.transform.rotation
    return {"translation": [to.x, to.y, to.z], "rotation": [q.x, q.y, q.z, q.w]}


def answers(frames, asked):
    buffer = tf2_ros.BufferCore()
    for parent, child, translation, rotation in frames:
        sent = TransformStamped(child_frame_id=child)
        sent.header.frame_id = parent
        sent.transform.translation, sent.transform.rotation = Vector3(*translation), Quaternion(*rotation)
        buffer.set_transform_static(sent, "test")
    return [lookup(buffer, *frames) for frames in asked]


print(json.dumps([answers(**tree) for tree in json.load(sys.stdin)]))
