"""Poses as matrices and back, under the names that they have on a robot with ROS 1: `numpify` and `msgify` of ros_numpy.

Given from notebook 3 on. In notebook 2 these are exercises, and there they refuse. With ROS 2, take these: ros2_numpy 0.0.5 hands
the quaternion to a library that reads w first, and a pose comes out turned (findings/ros2_numpy_turns_a_pose.sh).

Source: the README of ros_numpy, in which a Pose is "the homogeneous transformation matrix from the origin".
"""

from . import tft
from .jupyter import names
from .messages import Point, Pose, Quaternion
from .validation import rigid_transform
from .viewing.scene import pose_matrix

__all__ = ["msgify", "numpify"]

ONLY_IN_NOTEBOOK_2 = "hand_transform"


def numpify(pose):
    """Return the homogeneous transform a_T_b (4x4) of a Pose of frame B in frame A; metres, a unit quaternion.

    Raises TypeError for what is no Pose, ValueError for an orientation that is none, such as 0, 0, 0, 0.
    """
    _given("numpify")
    if not (hasattr(pose, "position") and hasattr(pose, "orientation")):
        stamped = " A PoseStamped has its Pose in the field pose." if hasattr(pose, "pose") else ""
        raise TypeError(f"numpify takes a Pose here; got {type(pose).__name__}.{stamped}")
    return pose_matrix(pose, "numpify: the pose")


def msgify(kind, matrix):
    """Return a new Pose of frame B in frame A for the homogeneous transform a_T_b, `matrix` (4x4, metres); `kind` is Pose.

    Raises TypeError for another kind of message, ValueError for what is no rigid transform.
    """
    _given("msgify")
    if getattr(kind, "__name__", "") != "Pose":
        raise TypeError("msgify takes the kind of message first, and here it makes a Pose: msgify(Pose, matrix)")
    T = rigid_transform(matrix, "msgify: the matrix")
    x, y, z, w = tft.quaternion_from_matrix(T).tolist()
    position = dict(zip("xyz", T[:3, 3].tolist()))
    return Pose(position=Point(**position), orientation=Quaternion(x=x, y=y, z=z, w=w))


def _given(name):
    if ONLY_IN_NOTEBOOK_2 in names():
        raise ValueError(f"{name} is given from notebook 3 on; in notebook 2 it is an exercise to do this by hand")
