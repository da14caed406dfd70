"""Calls solutions of exercises with their cases; messages are ROS's, those given and those returned.

solutions.py FOLDER, that of transform_lab, whose codec reads and writes the cases. Reads {exercise: {"cells": [source], "cases":
[[args, kwargs]]}}, writes {exercise: [[answer, arguments afterwards]]}, all of it plain data.
"""

import json
import sys
from types import ModuleType

import numpy as np
from ours import bare


def codec_of(folder, messages):
    """The codec, with these messages in the place of ours."""
    bare(folder)
    sys.modules["transform_lab.messages"] = messages
    from transform_lab.judging import codec

    return codec


def answers(codec, name, cells, cases):
    names = {}
    for cell in cells:
        exec(cell, names)
    for args, kwargs in cases:
        args, kwargs = [codec.decode(arg) for arg in args], {key: codec.decode(arg) for key, arg in kwargs.items()}
        answer = names[name](*args, **kwargs)
        assert isinstance(answer, (np.ndarray, bool)) or type(answer).__module__.startswith("geometry_msgs.msg"), answer
        yield (
            codec.encode(answer),
            [list(map(codec.encode, args)), {key: codec.encode(arg) for key, arg in kwargs.items()}],
        )


if __name__ == "__main__":
    from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion
    from std_msgs.msg import Header

    messages = ModuleType("transform_lab.messages")
    vars(messages).update({kind.__name__: kind for kind in (Point, Pose, PoseStamped, Quaternion, Header)})
    codec = codec_of(sys.argv[1], messages)
    asked = json.load(sys.stdin)
    print(json.dumps({name: list(answers(codec, name, **given)) for name, given in asked.items()}))
