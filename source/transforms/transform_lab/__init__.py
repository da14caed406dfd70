"""What the notebooks of the transform lab import: ROS messages, transformations, a viewer, and `check`.

On a robot, change the import lines and the rest of your code runs as it is:

    from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Vector3
    from std_msgs.msg import ColorRGBA, Header
    from visualization_msgs.msg import Marker
    import tf.transformations as tft
    from ros_numpy import msgify, numpify
    import rospy
"""

from . import rospy, tft, visualization_msgs
from .animations import (
    animate_approach,
    animate_chain,
    animate_determinant,
    animate_inverse,
    animate_journey,
    animate_mirrors,
    animate_retelling,
    animate_rotation,
)
from .check import check, once_done, say_what_is_missing
from .conversions import msgify, numpify
from .lab_markers import arrow_marker, axis_marker
from .messages import ColorRGBA, Header, Marker, Point, Pose, PoseStamped, Quaternion, Vector3
from .mistakes import show_mistake
from .outdated import follow
from .plots import plot_columns, plot_from_above, plot_quaternion
from .predictions import predict
from .summary import sum_up
from .viewing.viewer import Viewer

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
    "animate_approach",
    "animate_chain",
    "animate_determinant",
    "animate_inverse",
    "animate_journey",
    "animate_mirrors",
    "animate_retelling",
    "animate_rotation",
    "arrow_marker",
    "axis_marker",
    "check",
    "msgify",
    "numpify",
    "once_done",
    "plot_columns",
    "plot_from_above",
    "plot_quaternion",
    "predict",
    "rospy",
    "show_mistake",
    "sum_up",
    "tft",
    "visualization_msgs",
]

follow(say_what_is_missing)
