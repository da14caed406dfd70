"""publish.py SCRIPT: run a script; each of its publishers waits for a listener, and hands over each message at once.

A queue, as scripts ask for one, drops messages when the next comes too soon, which on a busy machine is by chance.
"""

import runpy
import sys
import time

import rospy
from plain import END
from visualization_msgs.msg import Marker

publishers = []


class Publisher(rospy.Publisher):
    def __init__(self, name, data_class, queue_size=None, **options):
        super().__init__(name, data_class, **options)
        while not self.get_num_connections():
            time.sleep(0.01)
        publishers.append(self)


rospy.Publisher = Publisher
try:
    runpy.run_path(sys.argv[1], run_name="__main__")
finally:
    for publisher in publishers:
        publisher.publish(Marker(ns=END))
