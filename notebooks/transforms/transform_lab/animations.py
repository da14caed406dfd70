"""Animations that explain: a rotation that grows, a chain put together, two frames from either side, an approach.

Each returns a Viewer: as the last line of a cell it is displayed, with a button to play it.
"""

import math

import numpy as np

from . import tft
from .validation import numbers, rigid_transform, row_text
from .viewing.shapes import ORANGE, STEEL
from .viewing.viewer import Viewer

__all__ = ["animate_approach", "animate_chain", "animate_inverse", "animate_rotation"]


def animate_rotation(rotation, names=("frame_a", "frame_b")):
    """Return a Viewer in which a frame turns out of another, about the axis of `rotation`, from 0 to its whole angle.

    `rotation` is a 3x3 rotation matrix a_R_b, a 4x4 transform, whose translation is left out, or a unit quaternion x, y,
    z, w; one with a negative w turns by more than 180 degrees. Angle and quaternion are shown as they grow.

    Raises ValueError for what is no rotation. Source: Euler's rotation theorem.
    """
    _two(names, "animate_rotation")
    x, y, z, w = _quaternion(rotation)
    sine = math.hypot(x, y, z)
    angle = 2 * math.atan2(sine, w)
    axis = np.array([x, y, z]) / sine if sine > 1e-9 else np.array([0, 0, 1.0])
    viewer = Viewer(names[0], ghost=True)
    if angle > 1e-6:
        viewer.add_arrow("axis", 1.3 * axis)

    def turn(scene, moment):
        scene.add_frame(names[1], tft.rotation_matrix(moment * angle, axis), length=1.0)
        quaternion = [*(axis * math.sin(moment * angle / 2)), math.cos(moment * angle / 2)]
        columns = "  ".join(f"{letter} {round(number, 3) + 0.0:6.3f}" for letter, number in zip("xyzw", quaternion))
        return f"{math.degrees(moment * angle):.0f}° about ({row_text(np.round(axis, 3))})\n{columns}"

    return viewer.animate(turn)


def animate_chain(*transforms, names="ABCDEFGHIJKLMNOPQRSTUVWXYZ"):
    """Return a Viewer in which a chain of frames is put together link by link.

    `transforms` are 4x4 arrays whose inner names fit: a_T_b, b_T_c, c_T_d, ...; `names` are those of the frames, one
    more than there are transforms. The transform from the first frame to the last so far is shown as it grows.

    Raises ValueError for no transform, too few names, and for what is no rigid transform.
    """
    if len(transforms) == 1 and np.ndim(transforms[0]) == 3:
        raise ValueError("animate_chain takes transforms one by one: write animate_chain(*transforms)")
    links = [rigid_transform(T, f"animate_chain: transform {i}") for i, T in enumerate(transforms, 1)]
    if not links or len(names) <= len(links):
        raise ValueError(f"animate_chain takes one transform or more and one name more; got {len(links)}, {len(names)}")
    viewer = Viewer(names[0])

    def assemble(scene, moment):
        done = moment * len(links)
        for i, link in enumerate(links[: max(1, math.ceil(done))]):
            scene.add_frame(names[i + 1], between(np.eye(4), link, min(done - i, 1)), parent=names[i])
        last = max(1, math.ceil(done))
        product = " @ ".join(f"{names[i]}_T_{names[i + 1]}" for i in range(last))
        if last - done > 1e-9:
            return f"{product}\n{names[last]} starts where {names[last - 1]} is, and moves along its axes"
        whole = f"{names[0]}_T_{names[last]}"
        matrix = _matrix_text(scene.lookup(names[0], names[last]))
        return f"{product if product == whole else f'{whole} = {product}'}\n{matrix}"

    return viewer.animate(assemble, seconds=2 * len(links))


def animate_inverse(a_T_b, names=("A", "B")):
    """Return a Viewer with the same two frames seen from either side: first frame A is the fixed one, then frame B.

    `a_T_b` is a 4x4 transform; at first it is shown beside the frames, at the end its inverse is, b_T_a.

    Raises ValueError for what is no rigid transform.
    """
    a, b = _two(names, "animate_inverse")
    a_T_b = rigid_transform(a_T_b, "animate_inverse: the transform")
    b_T_a = tft.inverse_matrix(a_T_b)
    viewer = Viewer("viewer", ghost=True)

    def change_sides(scene, moment):
        part = min(max((moment - 0.25) / 0.5, 0), 1)
        scene.add_frame(a, between(np.eye(4), b_T_a, part))
        scene.add_frame(b, a_T_b, parent=a)
        if part == 0:
            return f"{a} is the fixed frame. {a}_T_{b}:\n{_matrix_text(a_T_b)}"
        if part == 1:
            return f"{b} is the fixed frame. {b}_T_{a}:\n{_matrix_text(b_T_a)}"
        return f"from {a}'s side to {b}'s; how they stand to each other does not change"

    return viewer.animate(change_sides, seconds=6)


def animate_approach(object_pose, pre_grasp_pose, wrong_pose=None):
    """Return a Viewer in which a gripper goes to a pre-grasp pose, and from there straight ahead to the object.

    The poses are Pose messages (or 4x4 transforms) in base_link: the object, where the gripper stops first, and perhaps
    a wrong idea of that, to which an orange gripper goes. Straight ahead is along the gripper's own x axis, by as much as
    the pre-grasp position is away from the object.

    Raises ValueError for what is no rigid transform.
    """
    viewer = Viewer("base_link")
    viewer.add_frame("object", object_pose, length=0.05)
    viewer.add_box("object", (0.04, 0.04, 0.14), frame="object")
    viewer.add_frame("pre-grasp", pre_grasp_pose, length=0.04, ghost=True)
    base_T_object, base_T_stop = (viewer.lookup("base_link", name) for name in ("object", "pre-grasp"))
    ahead = tft.translation_matrix([np.linalg.norm(base_T_object[:3, 3] - base_T_stop[:3, 3]), 0, 0])
    home = between(base_T_stop, np.eye(4), 0.5)
    home[:3, 3] = base_T_stop[:3, 3] + [-0.06, 0, 0.1]
    stops = {"gripper_link": base_T_stop}
    if wrong_pose is not None:
        viewer.add_frame("wrong", wrong_pose)
        stops = {"wrong": viewer.lookup("base_link", "wrong"), **stops}

    def approach(scene, moment):
        for name, stop in stops.items():
            there, on = min(moment / 0.5, 1), max((moment - 0.6) / 0.4, 0)
            pose = between(home, stop, there) if there < 1 else between(stop, stop @ ahead, on)
            scene.add_frame(name, pose, length=0.03)
            scene.add_gripper(name, color=ORANGE if name == "wrong" else STEEL, ghost=name == "wrong")
        if moment < 0.5:
            return "1  to the pre-grasp pose"
        if moment < 1:
            return "2  straight ahead, along the gripper's own x axis"
        ends = {name: np.linalg.norm((stop @ ahead)[:3, 3] - base_T_object[:3, 3]) for name, stop in stops.items()}
        return "3  " + "; ".join(f"{name} ends {100 * off:.1f} cm from the object" for name, off in ends.items())

    return viewer.animate(approach, seconds=6).look(at=["object", "pre-grasp", *stops])


def between(start, end, part):
    """Return the 4x4 transform a `part` (0 to 1) of the way: turned about one axis, moved along a straight line."""
    turns = tft.quaternion_from_matrix(start), tft.quaternion_from_matrix(end)
    matrix = tft.quaternion_matrix(tft.quaternion_slerp(*turns, part))
    matrix[:3, 3] = (1 - part) * start[:3, 3] + part * end[:3, 3]
    return matrix


def _two(names, what):
    if len(names) != 2:
        raise ValueError(f"{what}: names must be those of two frames; got {names!r}")
    return names


def _quaternion(rotation):
    """Return the unit quaternion of a 3x3, a 4x4 or a quaternion."""
    values = numbers(rotation, "animate_rotation: the rotation")
    if values.shape == (4,):
        if abs(np.linalg.norm(values) - 1) > 1e-3:
            raise ValueError(f"animate_rotation: a quaternion must have length 1; it is {np.linalg.norm(values):.4g}")
        return values / np.linalg.norm(values)
    if values.shape == (3, 3):
        values = np.block([[values, np.zeros((3, 1))], [np.zeros((1, 3)), 1]])
    return tft.quaternion_from_matrix(rigid_transform(values, "animate_rotation: the rotation"))


def _matrix_text(matrix):
    return "\n".join(" ".join(f"{round(number, 3) + 0.0:7.3f}" for number in row) for row in matrix)
