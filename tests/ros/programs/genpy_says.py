"""genpy_says.py FOLDER, that of transform_lab. Reads questions, a line of JSON each, and answers each with a line.

A described message: its text in ROS, and that of ours with ROS's messages in it. A text: what comes of it as an expression.
"""

import json
import sys

from described import build, computed
from genpy import Duration, Time
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Vector3
from ours import bare
from std_msgs.msg import ColorRGBA, Header
from visualization_msgs.msg import Marker

bare(sys.argv[1])
from transform_lab import messages  # noqa: E402

KINDS = (Point, Vector3, Quaternion, Pose, Header, PoseStamped, ColorRGBA, Marker, Time, Duration)
ROS = {kind.__name__: kind for kind in KINDS}
OURS = {name: getattr(messages, name) for name in ROS}

for line in sys.stdin:
    question = json.loads(line)
    if isinstance(question, str):
        answer = computed(question, ROS)
    else:
        answer = [str(build(question, ROS)), str(build(question, OURS, inside=ROS))]
    print(json.dumps(answer), flush=True)
