"""The viewer's look-ups are those of TF: a buffer of tf2 is told the same frames, and asked for the same."""

import numpy as np
import pytest
from transform_lab import Point, Pose, Quaternion, Viewer, tft

UNKNOWN = "nowhere"


def tree(rng, size):
    """Frames [parent, child, translation, rotation] in the order they are told: a chain, a bush or between, some told twice."""
    names, reach = ["root"], rng.choice([1, 2, size])
    frames = []
    for i in range(size):
        parent = names[-int(rng.integers(1, min(reach, len(names)) + 1))]
        names.append(f"frame_{i}")
        frames.append([parent, names[-1], *placed(rng)])
    for parent, child, *_ in [frames[i] for i in rng.integers(size, size=size // 3)]:
        frames.append([str(rng.choice(["root", parent])), child, *placed(rng)])  # again, and perhaps under the root
    return frames, names


def placed(rng):
    turn = rng.normal(size=4)
    return list(rng.normal(size=3) * 10.0 ** rng.integers(-3, 3)), list(turn / np.linalg.norm(turn))


def two(rng, names):
    return list(map(str, rng.choice([*names, UNKNOWN], size=2)))


def drawn(frames):
    """A viewer of these frames, some given as poses and some as matrices."""
    viewer = Viewer("root")
    for i, (parent, child, translation, rotation) in enumerate(frames):
        pose = Pose(Point(*translation), Quaternion(*rotation))
        matrix = tft.translation_matrix(translation) @ tft.quaternion_matrix(rotation)
        viewer.add_frame(child, pose if i % 2 else matrix, parent=parent)
    return viewer


def test_lookups(ros):
    rng = np.random.default_rng(24)
    trees = [tree(rng, size) for size in rng.integers(1, 12, size=60)]
    asked = [[pair for _ in range(25) if (pair := two(rng, names)) != [UNKNOWN] * 2] for _, names in trees]
    found = ros.ask("frames.py", [{"frames": frames, "asked": pairs} for (frames, _), pairs in zip(trees, asked)])
    refused = 0
    for (frames, names), pairs, answers in zip(trees, asked, found, strict=True):
        viewer = drawn(frames)
        for pair, answer in zip(pairs, answers, strict=True):
            viewer.fixed_frame = str(rng.choice(names))  # which changes no answer
            if "error" in answer:
                refused += 1
                with pytest.raises(ValueError, match=UNKNOWN):
                    viewer.lookup(*pair)
                assert UNKNOWN in pair and UNKNOWN in answer["says"], answer
            else:
                there = tft.translation_matrix(answer["translation"]) @ tft.quaternion_matrix(answer["rotation"])
                np.testing.assert_allclose(viewer.lookup(*pair), there, rtol=1e-9, atol=1e-9, err_msg=str(pair))
    assert 50 < refused < 500


def test_a_frame_nobody_knows_described_in_itself(ros):
    """tf2 has an answer where both names are the same, whoever knows them; here a slip of the pen is told."""
    ((answer,),) = ros.ask("frames.py", [{"frames": [], "asked": [[UNKNOWN] * 2]}])
    assert answer == {"translation": [0, 0, 0], "rotation": [0, 0, 0, 1]}
    with pytest.raises(ValueError, match=UNKNOWN):
        Viewer("root").lookup(UNKNOWN, UNKNOWN)


@pytest.mark.parametrize(
    "pair", [("", "root"), ("root", ""), ("/root", "a"), ("a", "/root"), ("a ", "root"), ("A", "root")]
)
def test_names_that_tf_does_not_know(ros, pair):
    frames = [["root", "a", [1, 2, 3], [0, 0, 0, 1]]]
    ((answer,),) = ros.ask("frames.py", [{"frames": frames, "asked": [pair]}])
    assert answer["error"] in ("LookupException", "InvalidArgumentException")
    with pytest.raises(ValueError):
        drawn(frames).lookup(*pair)
