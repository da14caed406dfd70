"""Messages that are described in JSON, so that the same ones can be made of ROS's classes and of ours.

{"kind": "Point", "fields": {…}}, {"time": "Duration", "secs": 1, "nsecs": 2}, {"tuple": […]}, {"numpy": "float64", "value": 0.5}.
"""

import copy
import json

import numpy as np

FIELDS = {
    "Point": "x y z",
    "Vector3": "x y z",
    "Quaternion": "x y z w",
    "Pose": "position orientation",
    "Header": "seq stamp frame_id",
    "PoseStamped": "header pose",
    "ColorRGBA": "r g b a",
    "Marker": "header ns id type action pose scale color lifetime frame_locked points colors text mesh_resource"
    " mesh_use_embedded_materials",
}


def build(value, kinds, inside=None):
    """The value that is described, of classes {name: class}; what is inside of its messages of `inside`, where given."""
    inside = inside or kinds
    if isinstance(value, list):
        return [build(item, inside) for item in value]
    if not isinstance(value, dict):
        return value
    if "kind" in value:
        return kinds[value["kind"]](**{name: build(field, inside) for name, field in value["fields"].items()})
    if "time" in value:
        return kinds[value["time"]](value["secs"], value["nsecs"])
    if "tuple" in value:
        return tuple(build(item, inside) for item in value["tuple"])
    return getattr(np, value["numpy"])(value["value"])


def computed(expression, kinds):
    """What an expression of Times and Durations comes to, as JSON; of an error, its name."""
    try:
        value = eval(expression, {**kinds, "copy": copy})
    except Exception as error:
        return type(error).__name__
    return json.dumps(value, default=lambda moment: [type(moment).__name__, moment.secs, moment.nsecs])
