"""No label of a scene covers another one: in the notebooks' scenes, wherever their sliders stand, and in scenes at random."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scenes import NOTEBOOKS, scenes
from transform_lab import Viewer, tft
from transform_lab.viewing import page
from transform_lab.viewing.camera import Camera
from transform_lab.viewing.drawing import in_frame
from transform_lab.viewing.picture import half_size, places
from transform_lab.viewing.shapes import subscript

TOUCH = 0.85  # of a label's box: what is really covered by its letters


def covered(drawing, fixed_frame, camera):
    """Pairs of labels of which one covers the other."""
    nodes = in_frame(drawing.nodes, drawing.frames[fixed_frame])
    boxes = [
        (label, np.array(place), TOUCH * np.array(half_size(label, font)))
        for label, _, font, place in places(nodes, camera)
    ]
    return [
        (f"{one.text}{one.subscript}", f"{other.text}{other.subscript}")
        for i, (one, where, half) in enumerate(boxes)
        for other, there, others_half in boxes[:i]
        if (np.abs(where - there) < half + others_half).all()
    ]


def looks(viewer):
    """[(what, Drawing, Camera)] of the still picture, and of every state in the page, as they first are looked at."""
    scene = viewer.state()
    drawing, states, _ = viewer._drawings(scene)
    top = page.text_height([drawing, *states])
    still = Camera(drawing.seen_from(scene.fixed_frame), page.ASPECT, viewer._seen_from, top)
    seen = np.concatenate([d.seen_from(scene.fixed_frame) for d in (drawing, *states)])
    camera = Camera(seen, page.ASPECT, viewer._seen_from, top)
    return [
        ("the still picture", drawing, still),
        *((f"state {i}", d, camera) for i, d in enumerate(states or [drawing])),
    ]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_no_label_of_a_notebooks_scenes_covers_another(path):
    found = []
    for cell, viewer in scenes(path):
        for what, drawing, camera in looks(viewer):
            found += [(cell, what, *pair) for pair in covered(drawing, viewer.state().fixed_frame, camera)]
    assert not found, "\n".join(map(str, ["", *found]))


@given(st.integers(0, 10**6), st.integers(2, 4))
def test_labels_of_frames_at_random_keep_apart(seed, number):
    random = np.random.default_rng(seed)
    viewer = Viewer("frame_a")
    for name in "bcd"[: number - 1]:
        pose = tft.random_rotation_matrix(random.random(3))
        pose[:3, 3] = random.uniform(-1, 1, 3) * random.choice([0, 0.1, 1])
        viewer.add_frame(f"frame_{name}", pose, ghost=bool(random.integers(2)))
    for _, drawing, camera in looks(viewer):
        assert not covered(drawing, "frame_a", camera)


@pytest.mark.parametrize(
    "name, short",
    [
        ("frame_a", "A"),
        ("B", "B"),
        ("base_link", "base"),
        ("camera", "camera"),
        ("camera_color_optical_frame", "camera_co…"),
    ],
)
def test_an_axis_is_named_by_its_frame_in_short(name, short):
    assert subscript(name) == short
