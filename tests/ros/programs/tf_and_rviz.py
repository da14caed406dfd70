"""What notebooks import and a robot has under other names: TF keeps the frames, RViz shows the markers.

What only draws or judges does nothing here; what it is given has been computed before.
"""

import io
from types import SimpleNamespace

import rospy
import tf.transformations as tft
import tf2_ros
import yaml
from cells import Watched, nullcontext
from geometry_msgs.msg import Point, Pose, Quaternion, TransformStamped


class TfAndRviz:
    """Keeps frames in a buffer of tf2, and takes markers that can be sent."""

    def __init__(self, fixed_frame="world", ghost=False, length=None):
        self.root, self.buffer = fixed_frame, tf2_ros.BufferCore()

    def add_frame(self, name, transform, parent=None, length=None, ghost=False):
        sent = TransformStamped(child_frame_id=name)
        sent.header.frame_id = parent or self.root
        to, turned = sent.transform.translation, sent.transform.rotation
        if hasattr(transform, "position"):
            p, q = transform.position, transform.orientation
            to.x, to.y, to.z = p.x, p.y, p.z
            turned.x, turned.y, turned.z, turned.w = q.x, q.y, q.z, q.w
        else:
            to.x, to.y, to.z = tft.translation_from_matrix(transform)
            turned.x, turned.y, turned.z, turned.w = tft.quaternion_from_matrix(transform)
        self.buffer.set_transform_static(sent, "notebook")

    def lookup(self, target, source):
        found = self.buffer.lookup_transform_core(target, source, rospy.Time(0)).transform
        to, q = found.translation, found.rotation
        return tft.translation_matrix([to.x, to.y, to.z]) @ tft.quaternion_matrix([q.x, q.y, q.z, q.w])

    @property
    def frames(self):
        told = yaml.safe_load(self.buffer.all_frames_as_yaml())
        parents = {self.root: None} | {name: frame["parent"] for name, frame in told.items()}
        return {name: SimpleNamespace(parent=parent) for name, parent in parents.items()}

    def path(self, target, source):
        ways = []
        for name in (target, source):
            way = [name]
            while way[-1] != self.root:
                way.append(self.frames[way[-1]].parent)
            ways.append(way)
        up = [name for name in ways[0] if name not in ways[1]]
        down = [name for name in ways[1] if name not in ways[0]]
        meeting = next(name for name in ways[0] if name in ways[1])
        return [*up, meeting, *reversed(down)]

    def publish(self, marker):
        marker._check_types()
        marker.serialize(io.BytesIO())

    def _draw(self, *arguments, **options):
        return self

    add_point = add_arrow = add_box = add_gripper = add_hand = look = _draw


class Viewer(Watched, TfAndRviz):
    pass


def check(exercise, function):
    pass


def draw(*arguments, **options):
    return Viewer()


def numpify(pose):
    """As ros_numpy has it, which Debian has not."""
    p, q = pose.position, pose.orientation
    return tft.translation_matrix([p.x, p.y, p.z]) @ tft.quaternion_matrix([q.x, q.y, q.z, q.w])


def msgify(kind, matrix):
    assert kind is Pose
    return Pose(Point(*tft.translation_from_matrix(matrix)), Quaternion(*tft.quaternion_from_matrix(matrix)))


once_done = nullcontext
animate_approach = animate_chain = animate_determinant = animate_inverse = animate_journey = draw
animate_mirrors = animate_retelling = animate_rotation = draw
plot_columns = plot_from_above = plot_quaternion = predict = show_mistake = sum_up = draw
