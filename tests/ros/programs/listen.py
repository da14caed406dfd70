"""listen.py TOPIC: print each marker that arrives as a line of JSON, until a script has ended that publish.py runs."""

import json
import sys

import rospy
from plain import END, plain
from visualization_msgs.msg import Marker


def hear(marker):
    if marker.ns == END:
        rospy.signal_shutdown(END)
    else:
        print(json.dumps(plain(marker)), flush=True)


rospy.init_node("listener")
rospy.Subscriber(sys.argv[1], Marker, hear)
rospy.spin()
