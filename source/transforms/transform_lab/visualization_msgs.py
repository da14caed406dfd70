"""`import visualization_msgs.msg` of the lab's script, without ROS: visualization_msgs.msg.Marker."""

from . import messages as msg

__all__ = ["msg"]
