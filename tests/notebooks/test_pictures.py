"""What the words say of a picture is true of it as it opens: where things lie as one looks at it, and how they are drawn.

Each sentence that speaks of what is seen has a line in SAID. When one is written, the test asks for its line.
"""

import re

import nbformat
import numpy as np
import pytest
from scenes import NOTEBOOKS, scenes
from transform_lab.viewing import page
from transform_lab.viewing.camera import Camera
from transform_lab.viewing.shapes import rgba, xyz

SEES = re.compile(
    r"(towards|away from) you\b|(seen from|from) above[,;]|From above|seen from behind|in the picture|out of sight"
    r"|\b(pale|strong|orange|grey|yellow|thick)\b|\bthe corner\b|\bparallel\b",
    re.IGNORECASE,
)
OF_NO_PICTURE = [
    "drag to look from elsewhere",
    "Draw its first two columns as arrows",
    "*One* is the rotation by 36.87° from above",
]
X, Y, Z = np.eye(3)
AXES = "markers/axes%2F0"  # what axis_marker publishes


class Picture:
    """A scene as it opens."""

    def __init__(self, viewer):
        self.viewer, self.scene = viewer, viewer.state()
        drawing, states, _ = viewer._drawings(self.scene)
        drawings = states or [drawing]
        seen = np.concatenate([d.seen_from(self.scene.fixed_frame) for d in drawings])
        self.text, self.view, self.drawn = drawing.text, viewer._seen_from, {node.path: node for node in drawing.nodes}
        self.camera = Camera(seen, page.ASPECT, viewer._seen_from, page.text_height([drawing, *states]))

    def toward(self, direction, frame=None):
        """How far a direction of a frame points towards who looks: from -1, away, to 1."""
        fixed_T_frame = self.scene.lookup(self.scene.fixed_frame, frame or self.scene.fixed_frame)
        return float(fixed_T_frame[:3, :3] @ direction @ self.camera.back)

    def turn(self, one, other):
        """Above zero where the way from one direction of the fixed frame to another is counterclockwise in the picture."""
        origin, *tips = (self.place(self.scene.fixed_frame, position) for position in (np.zeros(3), one, other))
        return float(np.linalg.det(np.array(tips) - origin))

    def slope(self, name):
        """How steeply an arrow rises in the picture, in degrees."""
        arrow = self.scene.arrows[name]
        right, up = self.place(arrow.frame, arrow.tip) - self.place(arrow.frame, arrow.tail)
        return float(np.degrees(np.arctan2(up, right)))

    def marker(self):
        return next(iter(self.scene.markers.values())).marker

    def thick(self, path):
        """The thickness of the first cylinder of what is drawn, in metres."""
        return float(np.linalg.norm(self.drawn[path].solids[0].matrix[:3, 1]))

    def arrow(self, name):
        """The direction of an arrow, in its frame."""
        arrow = self.scene.arrows[name]
        return (arrow.tip - arrow.tail) / np.linalg.norm(arrow.tip - arrow.tail)

    def place(self, frame, position=(0, 0, 0)):
        """Where a point of a frame is in the picture: to the right and up."""
        where = self.scene.lookup(self.scene.fixed_frame, frame) @ [*position, 1]
        return self.camera.project(where[:3])[0]

    def in_view(self, frame):
        x, y = self.place(frame)
        return bool(0 < x < page.ASPECT and 0 < y < 1)

    def pale(self):
        """The names of what is drawn translucent; the fixed frame's, too."""
        named = {**self.scene.frames, **self.scene.points, **self.scene.arrows}
        return {name for name, thing in named.items() if thing.ghost}


def colored(color, *expected):
    return np.allclose(color[:3], expected, atol=0.3)


def numbers(picture):
    return re.findall(r"-?\d+\.?\d*", picture.text)


def mistake(right, wrong="mistake"):
    """What is right is drawn pale, and what is wrong is not."""
    return lambda p: right in p.pale() and not {name for name in p.pale() if wrong in name}


# {(notebook, cell of the words): [(what they say, cell of the picture, whether it is so)]}
SAID = {
    ("1_rotation", "frames-say"): [
        ("the thumb is z,\nas in the picture below", "hand-view", lambda p: "hands/frame_a" in p.drawn)],
    ("1_rotation", "turns-say"): [
        ("seen from\nabove, **counterclockwise**", "about-z-drag", lambda p: p.toward(Z) > 0.99 and p.turn(X, Y) > 0)],
    ("1_rotation", "columns"): [
        ("nine numbers in the\ncorner", "columns-drag-view", lambda p: len(numbers(p)) == 9),
        ("The pale axes are A's.", "columns-drag-view", lambda p: p.pale() == {"frame_a"})],
    ("1_rotation", "about-z"): [
        ("only the x axis is drawn here, the strong red arrow, seen from above,", "about-z-drag",
         lambda p: p.view == "above" and [*p.scene.arrows] == ["x of B"] and colored(p.scene.arrows["x of B"].color, 1, 0, 0)),
        ("The pale\naxes are A's.", "about-z-drag", lambda p: p.pale() == {"frame_a"})],
    ("1_rotation", "about-z-exercise"): [
        ("Seen from above, its tip walks along the circle", "about-z-drag", lambda p: p.toward(Z) > 0.99)],
    ("1_rotation", "two-axes-say-unfold"): [
        ("Backward, towards you", "two-axes-view", lambda p: p.toward(p.arrow("z of B")) > 0.9)],
    ("1_rotation", "two-axes-look"): [
        ("seen from behind A: A's x axis goes away from you", "two-axes-view", lambda p: p.toward(X) < -0.9),
        ("the third\narrow come towards you", "two-axes-view", lambda p: p.toward(p.arrow("z of B")) > 0.9)],
    ("1_rotation", "which"): [
        ("the numbers in the corner", "which-drag", lambda p: len(numbers(p)) == 10)],
    ("1_rotation", "which-say"): [
        ("the numbers in the corner above, is the dot product", "which-drag", lambda p: len(numbers(p)) == 10),
    ],
    ("1_rotation", "diagonal-unfold"): [
        ("Frame A is drawn pale", "diagonal-view", lambda p: p.pale() == {"frame_a"})],
    ("1_rotation", "mistakes"): [
        ("The pale frame is where it should be.", cell, mistake("frame_b"))
        for cell in ("mistake-rows", "mistake-radians", "mistake-left")],
    ("2_homogeneous_transforms", "example-one-look"): [
        ("The thin grey line joins a frame", "example-one-view", lambda p: "links/frame_b" in p.drawn)],
    ("2_homogeneous_transforms", "example-two"): [
        ("Roll the hand in the picture", "hand-drag", lambda p: "hands/hand" in p.drawn)],
    ("2_homogeneous_transforms", "aim"): [
        ("the pale frame is where the gripper should be", "aim-view", lambda p: p.pale() == {"target"})],
    ("2_homogeneous_transforms", "demo-unfold"): [
        ("The marker's axes are thick and bear no letters", "demo-axes",
         lambda p: not p.drawn[AXES].labels and p.thick(AXES) > 2 * p.thick("frames/frame_a"))],
    ("2_homogeneous_transforms", "demo-point"): [
        ("a yellow arrow from A's origin", "demo-arrow", lambda p: colored(rgba(p.marker().color, ""), 1, 1, 0)),
        ("the yellow arrow ends at the tip of the red axis", "demo-arrow",
         lambda p: np.allclose(p.place("frame_b", X), p.place("frame_a", xyz(p.marker().points[1], ""))))],
    ("2_homogeneous_transforms", "directions-unfold"): [
        ("below one arrow starts at A's origin and one at B's. They are parallel.", "directions-view",
         lambda p: abs(p.slope("the direction, from A") - p.slope("the same, from B")) < 6)],
    ("2_homogeneous_transforms", "mistakes"): [
        ("The pale frame, or point, is where it should be.", cell, mistake(name))
        for cell, name in (("mistake-order", "frame_b"), ("mistake-zero", "p"), ("mistake-position", "frame_b"))],
    ("3_chaining", "one-link-unfold"): [
        ("as\nthe text in the corner says", "one-link-view", lambda p: "D in C" in p.text)],
    ("3_chaining", "pose"): [
        ("One of the two\npositions in the corner", "pose-drag", lambda p: len(numbers(p)) == 6)],
    ("3_chaining", "pose-look"): [
        ("The proof is in the picture.", "pose-check-view", lambda p: p.in_view("cup")),
        ("The thick axes should cover the cup's thin ones.", "pose-check-view",
         lambda p: p.thick(AXES) > 2 * p.thick("frames/cup"))],
    ("3_chaining", "mistakes"): [
        ("The pale frame is where it should be.", cell, mistake(name))
        for cell, name in (("mistake-reversed", "frame_c"), ("mistake-added", "cup"), ("mistake-orientation", "cup"))],
    ("3_chaining", "mistake-added-say"): [
        ("Seen from above; the room's frame is out of sight.", "mistake-added",
         lambda p: p.view == "above" and not p.in_view("room"))],
    ("4_inversion", "other-side"): [
        ("read `a_T_b` in the corner", "other-side-drag", lambda p: len(numbers(p)) == 16)],
    ("4_inversion", "other-side-play"): [
        ("the pale axes are where\n*you* stand", "other-side-animation", lambda p: p.pale() == {"you"})],
    ("4_inversion", "undo-say"): [
        ("The orange point is where you get", "transpose-drag", lambda p: colored(p.scene.points["minus t"].color, 1, 0.5, 0))],
    ("4_inversion", "camera-look"): [
        ("with the object in the picture", "camera-arrow", lambda p: np.allclose(
            p.place("gripper_link", p.scene.arrows["reach"].tip), p.place("camera_link", X)))],
    ("4_inversion", "tree-unfold"): [
        ("the corner shows the product", "tree-view", lambda p: "inv(base_T_gripper) @ base_T_camera" in p.text)],
    ("4_inversion", "mistakes"): [
        ("What is wanted is drawn pale", cell, mistake(name))
        for cell, name in (("mistake-minus", "A"), ("mistake-none", "A"), ("mistake-other", "C"))],
    ("5_pre_grasp", "problem-see"): [
        ("in the corner where that is in the base frame", "problem-drag", lambda p: "gripper in base" in p.text),
        ("too far off to be in the picture", "problem-drag", lambda p: not p.in_view("base_link"))],
    ("5_pre_grasp", "behind-predict-unfold"): [
        ("See below, from above and as a film.", "problem-animation", lambda p: p.view == "above")],
    ("5_pre_grasp", "problem-flat-say"): [
        ("From above, and as a film: the orange gripper, *wrong*,", "problem-animation",
         lambda p: p.view == "above" and colored(p.scene.grippers["wrong"].color, 1, 0.5, 0)),
        ("the grey one, *gripper_link*,", "problem-animation",
         lambda p: np.ptp(p.scene.grippers["gripper_link"].color[:3]) < 0.15)],
    ("5_pre_grasp", "journey-say"): [
        ("The orange gripper makes the journey", "journey-film",
         lambda p: colored(p.scene.grippers["mistake"].color, 1, 0.5, 0))],
    ("5_pre_grasp", "mistakes"): [
        ("Seen from above; the gripper of the mistake is the strong one.", "mistake-base",
         lambda p: p.view == "above" and p.scene.grippers["pre-grasp"].ghost and not p.scene.grippers["mistake"].ghost),
        *(("the pale frame is its pre-grasp pose", cell, mistake("pre-grasp"))
          for cell in ("mistake-base", "mistake-front", "mistake-yaw"))],
}  # fmt: skip


def sentences(text):
    """The sentences of a Markdown cell that speak of what is seen."""
    plain = re.sub(r"<summary>.*?</summary>|^#.*$", "", text, flags=re.MULTILINE)
    parts = [" ".join(part.split()) for part in re.split(r"(?<=[.?!)])\s+|\n\n", plain)]
    return [part for part in parts if SEES.search(part) and not any(words in part for words in OF_NO_PICTURE)]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_what_is_said_of_a_picture_is_true_of_it_as_it_opens(path):
    shown = dict(scenes(path))
    for (notebook, cell), claims in SAID.items():
        for words, picture, holds in claims if notebook == path.stem else []:
            assert holds(Picture(shown[picture])), f"{notebook}, {cell}: “{words}” is not so in {picture}"


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_each_sentence_on_a_picture_is_looked_at(path):
    found = {}
    for cell in nbformat.read(path, as_version=4).cells:
        if cell.cell_type == "markdown":
            claims = [" ".join(words.split()) for words, *_ in SAID.get((path.stem, cell.id), ())]
            text = " ".join(cell.source.split())
            assert all(words in text for words in claims), f"{cell.id}: adapt SAID to the text, {claims}"
            for sentence in sentences(cell.source):
                if not any(
                    words in " ".join(sentence.split()) or " ".join(sentence.split()) in words for words in claims
                ):
                    found[cell.id] = sentence
    assert not found, f"Say in SAID what these sentences mean in the picture: {found}"
