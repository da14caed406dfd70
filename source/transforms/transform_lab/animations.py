"""Animations that explain: a rotation that grows or is made of two mirrors, a volume that a matrix makes of a cube, a chain put
together or told of by one frame after the other, two frames from either side, an approach.

Each returns a Viewer: as the last line of a cell it is displayed, with a button to play it.
"""

import math

import numpy as np

from . import tft
from .messages import ColorRGBA, Marker, Point
from .validation import numbers, rigid_transform, row_text
from .viewing.shapes import ORANGE, PURPLE, STEEL, X_RED, Y_GREEN, Z_BLUE
from .viewing.viewer import Viewer

__all__ = [
    "animate_approach",
    "animate_chain",
    "animate_determinant",
    "animate_inverse",
    "animate_journey",
    "animate_mirrors",
    "animate_retelling",
    "animate_rotation",
]
EDGES = [(i, i | bit) for i in range(8) for bit in (1, 2, 4) if not i & bit]  # of a cube, its corners counted in binary


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


def animate_mirrors(degrees=90, point=(0.9, -0.3, 0.2)):
    """Return a Viewer in which two mirrors turn a point about z by `degrees`, twice the angle between them.

    The mirrors stand on z, the first along x. `point` is 3 numbers, in metres. A quaternion holds the mirrors: w is the dot
    product of their normals, and x, y, z is the cross product.

    Source: a turn by an angle is two reflections in planes at half that angle (Cartan and Dieudonné's theorem).
    """
    half = math.radians(degrees) / 2
    normals = [np.array([-math.sin(angle), math.cos(angle), 0]) for angle in (0, half)]
    places = [numbers(point, "animate_mirrors: the point", lengths=(3,))]
    for normal in normals:
        places.append(places[-1] - 2 * (places[-1] @ normal) * normal)
    viewer = Viewer("frame_a", length=0.5)
    for name, angle in (("first mirror", 0), ("second mirror", half)):
        mirror = tft.rotation_matrix(angle, [0, 0, 1]) @ tft.translation_matrix([0.6, 0, 0])
        viewer.add_box(name, (1.2, 0.01, 0.8), mirror, color=(0.55, 0.7, 0.85), ghost=True)
    viewer.add_point("p", places[0])

    def reflect(scene, moment):
        done = 2 * moment
        for i, name in enumerate(["once mirrored", "twice mirrored"][: math.ceil(done)]):
            part = min(done - i, 1)
            scene.add_point(name, (1 - part) * places[i] + part * places[i + 1], color=ORANGE if i else PURPLE)
        if moment < 1:
            return "straight through the mirror, as far behind it as it was before it"
        w, z = normals[0] @ normals[1], np.cross(*normals)[2]
        lines = f"between the mirrors: {degrees / 2:g}°   from p to twice mirrored: {degrees:g}°"
        return f"{lines}\nw = cos {degrees / 2:g}° = {w:.4f}   z = sin {degrees / 2:g}° = {z:.4f}"

    return viewer.animate(reflect).look(seen_from="above")


def animate_determinant(matrix):
    """Return a Viewer in which the columns of a 3x3 `matrix` grow out of the axes, and the volume that they span is told.

    The unit cube has the volume 1; what the matrix makes of it has its determinant, below zero where it is turned inside out.

    Raises ValueError for what is no 3x3 matrix of numbers.
    """
    M = numbers(matrix, "animate_determinant: the matrix")
    if M.shape != (3, 3):
        raise ValueError(f"animate_determinant: the matrix must be 3x3; got shape {M.shape}")

    def grow(scene, moment):
        columns = (1 - moment) * np.eye(3) + moment * M
        for letter, column, color in zip("xyz", columns.T, (X_RED, Y_GREEN, Z_BLUE)):
            scene.add_arrow(letter, column, color=color)
        corners = [columns @ [i >> bit & 1 for bit in range(3)] for i in range(8)]
        box = Marker(type=Marker.LINE_LIST)
        box.header.frame_id, box.pose.orientation.w, box.scale.x = "frame_a", 1.0, 0.015
        box.color = ColorRGBA(*STEEL)
        box.points = [Point(*corners[end].tolist()) for edge in EDGES for end in edge]
        scene.publish(box)
        volume = round(float(np.linalg.det(columns)), 2) + 0.0
        kind = "flat: no volume" if volume == 0 else "a left hand" if volume < 0 else "a right hand"
        return f"columns:\n{_matrix_text(columns)}\nvolume {volume:.2f}   {kind}"

    return Viewer("frame_a", ghost=True).animate(grow, seconds=6)


def animate_retelling(a_T_b, b_T_c, p_in_c):
    """Return a Viewer in which one point is told in frame C, then in B, then in A: along the axes of each.

    `a_T_b` and `b_T_c` are 4x4 transforms, `p_in_c` is 3 numbers, in metres. The point stays; who tells of it changes.

    Raises ValueError for what is no rigid transform.
    """
    a_T_b = rigid_transform(a_T_b, "animate_retelling: a_T_b")
    a_T_c = a_T_b @ rigid_transform(b_T_c, "animate_retelling: b_T_c")
    p_in_c = numbers(p_in_c, "animate_retelling: p_in_c", lengths=(3,))
    tellers = {"p_c": a_T_c, "p_b = b_T_c p_c": a_T_b, "p_a = a_T_b b_T_c p_c": np.eye(4)}
    viewer = Viewer("A")
    viewer.add_frame("B", a_T_b)
    viewer.add_frame("C", a_T_c)
    viewer.add_point("p", p_in_c, frame="C")
    p_in_a = (a_T_c @ [*p_in_c, 1])[:3]

    def retell(scene, moment):
        done = 2 * moment
        told = round(done)
        start, end = list(tellers.values())[min(int(done), 1) :][:2]
        teller = between(start, end, done - min(int(done), 1))
        numbers_there = (tft.inverse_matrix(teller) @ [*p_in_a, 1])[:3]
        corner = np.zeros(3)
        for i, color in enumerate((X_RED, Y_GREEN, Z_BLUE)):
            further = corner + numbers_there[i] * np.eye(3)[i]
            ends = [(teller @ [*end, 1])[:3] for end in (corner, further)]
            scene.add_arrow(f"along {'xyz'[i]}", ends[1], tail=ends[0], color=color)
            corner = further
        return f"{list(tellers)[told]}\n= {row_text(np.round(numbers_there, 2) + 0.0)}"

    return viewer.animate(retell, seconds=6)


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
        product = " @ ".join(_in_code(names[i], names[i + 1]) for i in range(last))
        if last - done > 1e-9:
            return f"{product}\n{names[last]} starts where {names[last - 1]} is, and moves along its axes"
        whole = _in_code(names[0], names[last])
        matrix = _matrix_text(scene.lookup(names[0], names[last]))
        return f"{product if product == whole else f'{whole} = {product}'}\n{matrix}"

    return viewer.animate(assemble, seconds=2 * len(links))


def animate_inverse(a_T_b, names=("A", "B")):
    """Return a Viewer with the same two frames seen from either side: first you stand in frame A, then in frame B.

    `a_T_b` is a 4x4 transform; at first it is shown beside the frames, at the end its inverse is, b_T_a.

    Raises ValueError for what is no rigid transform.
    """
    a, b = _two(names, "animate_inverse")
    a_T_b = rigid_transform(a_T_b, "animate_inverse: the transform")
    b_T_a = tft.inverse_matrix(a_T_b)
    viewer = Viewer("you", ghost=True)

    def change_sides(scene, moment):
        part = min(max((moment - 0.25) / 0.5, 0), 1)
        scene.add_frame(a, between(np.eye(4), b_T_a, part))
        scene.add_frame(b, a_T_b, parent=a)
        if part == 0:
            return f"you stand in {a}. {_in_code(a, b)}:\n{_matrix_text(a_T_b)}"
        if part == 1:
            return f"you stand in {b}. {_in_code(b, a)}:\n{_matrix_text(b_T_a)}"
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


def animate_journey(object_pose, stops, wrong_stops=None):
    """Return a Viewer in which a gripper goes from stop to stop; at the one that is called "grasp" it takes the object along.

    `object_pose` and the poses of `stops`, {name: pose}, are Pose messages (or 4x4 transforms) in base_link. `wrong_stops`, of
    the same names, is the journey of a mistake: an orange gripper makes it at the same time, and takes nothing along.

    Raises ValueError for fewer than two stops, other names, and for what is no rigid transform.
    """
    if len(stops) < 2 or wrong_stops and [*wrong_stops] != [*stops]:
        raise ValueError(
            f"animate_journey takes two stops or more, wrong ones of the same names; got {', '.join(stops)}"
        )
    viewer, known = Viewer("base_link"), Viewer("base_link")
    known.add_frame("object", object_pose)
    base_T_object = known.lookup("base_link", "object")
    viewer.add_box("table", (0.5, 0.5, 0.01), tft.translation_matrix(base_T_object[:3, 3] - [0, 0, 0.055]))
    journeys = {}
    for gripper, poses in (("mistake", wrong_stops or {}), ("gripper_link", stops)):
        for name, pose in poses.items():
            known.add_frame(name, pose)
            journeys.setdefault(gripper, []).append(known.lookup("base_link", name))
    names, legs = list(stops), len(stops) - 1
    grasped = names.index("grasp") if "grasp" in names else legs

    def travel(scene, moment):
        done = moment * legs
        leg = min(int(done), legs - 1)
        for gripper, poses in journeys.items():
            wrong = gripper == "mistake"
            scene.add_frame(gripper, between(poses[leg], poses[leg + 1], done - leg), length=0.04, ghost=wrong)
            scene.add_gripper(gripper, opening=0.06, color=ORANGE if wrong else STEEL, ghost=wrong)
        held = done > grasped
        scene.add_frame("object", base_T_object, length=0.05, ghost=held)
        gripper_T_block = tft.inverse_matrix(journeys["gripper_link"][grasped]) @ base_T_object
        block = gripper_T_block if held else base_T_object
        scene.add_box("block", (0.04, 0.04, 0.1), block, frame="gripper_link" if held else "base_link")
        return f"{names[leg]} to {names[leg + 1]}" if done < legs else names[-1]

    return viewer.animate(travel, seconds=2 * legs).look(at=["block", *journeys])


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


def _in_code(target, source):
    """The name that the transform between two frames has in code: a_T_b for A and B."""
    return "_T_".join(name.lower() if len(name) == 1 else name for name in (target, source))


def _matrix_text(matrix):
    return "\n".join(" ".join(f"{round(number, 3) + 0.0:7.3f}" for number in row) for row in matrix)
