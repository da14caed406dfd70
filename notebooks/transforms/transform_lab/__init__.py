"""What the notebooks of the transform lab import: ROS messages, transformations, a viewer, and `check`.

On a robot, change the import lines and the rest of your code runs as it is:

    from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Vector3
    from std_msgs.msg import ColorRGBA, Header
    from visualization_msgs.msg import Marker
    import tf.transformations as tft
"""

from . import tft
from .check import check, once_done
from .markers import arrow_marker, axis_marker
from .messages import ColorRGBA, Header, Marker, Point, Pose, PoseStamped, Quaternion, Vector3
from .viewer import Viewer

__all__ = [
    "ColorRGBA",
    "Header",
    "Marker",
    "Point",
    "Pose",
    "PoseStamped",
    "Quaternion",
    "Vector3",
    "Viewer",
    "arrow_marker",
    "axis_marker",
    "check",
    "once_done",
    "tft",
]
