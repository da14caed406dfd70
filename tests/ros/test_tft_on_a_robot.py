"""tft gives the numbers that ROS's own tf.transformations gives, and passes the examples that ROS has for it."""

import ast
import doctest
import itertools
import math
import random

import numpy as np
import pytest
from transform_lab import tft

SEQUENCES = ["".join(three) for three in itertools.product("xyz", repeat=3) if three[1] not in (three[0], three[2])]
AXES = [frame + sequence for frame in "sr" for sequence in SEQUENCES]
FIND = "import tf.transformations; print(tf.transformations.__file__)"
TUPLES = "import json, tf.transformations as t; print(json.dumps([[a, list(b)] for a, b in t._AXES2TUPLE.items()]))"
# What ROS's examples use of its own that is not here, and functions that are not
NOT_HERE = {
    "Arcball", "arcball_map_to_sphere", "clip_matrix", "orthogonalization_matrix", "projection_from_matrix", "projection_matrix",
    "reflection_from_matrix", "scale_from_matrix", "shear_from_matrix", "shear_matrix",
}  # fmt: skip


def plain(value):
    return np.asarray(value).tolist() if not isinstance(value, tuple) else [plain(item) for item in value]


def calls():
    """[function, arguments] of every function whose numbers are determined by its arguments."""
    rng = np.random.default_rng(24)

    def some(*shape):
        return rng.normal(size=shape).tolist()

    def turn():
        q = rng.normal(size=4)
        return (q / np.linalg.norm(q)).tolist()

    def rotation():
        return tft.quaternion_matrix(turn())

    def transform():
        return (tft.translation_matrix(some(3)) @ rotation()).tolist()

    quarter = [
        tft.euler_matrix(*(n * math.pi / 2 for n in turns)).round().tolist()
        for turns in itertools.product(range(4), repeat=3)
    ]
    found = [["identity_matrix", []], ["concatenate_matrices", []]]
    for matrix in [*quarter, *(transform() for _ in range(300))]:
        found += [
            ["quaternion_from_matrix", [matrix]],
            ["translation_from_matrix", [matrix]],
            ["inverse_matrix", [matrix]],
        ]
    for axes in AXES:
        for angles in (some(3), some(3), [0.4, 0.0, -2.0], [3.0, -2.9, 0.1]):
            found += [["euler_matrix", [*angles, axes]], ["quaternion_from_euler", [*angles, axes]]]
            found += [["euler_from_matrix", [transform(), axes]], ["euler_from_quaternion", [turn(), axes]]]
        found += [["euler_from_matrix", [matrix, axes]] for matrix in quarter]  # gimbal lock, half turns, no turn
        found += [["euler_from_matrix", [rotation()[:3, :3].tolist(), axes]]]
    for frame, parity, repetition, first in itertools.product((0, 1), (0, 1), (0, 1), range(3)):
        axes = {"tuple": [first, parity, repetition, frame]}
        found += [["euler_matrix", [*some(3), axes]], ["euler_from_matrix", [transform(), axes]]]
    for _ in range(50):
        q, p, r = turn(), turn(), turn()
        found += [[name, [q]] for name in ("quaternion_matrix", "quaternion_conjugate", "quaternion_inverse")]
        found += [
            ["quaternion_matrix", [some(4)]],
            ["quaternion_inverse", [some(4)]],
            ["quaternion_multiply", [some(4), some(4)]],
        ]
        found += [["quaternion_slerp", [q, p, rng.uniform()]], ["quaternion_slerp", [q, p, rng.uniform(), 2, False]]]
        found += [["quaternion_slerp", [q, q, 0.5]], ["quaternion_slerp", [q, r, 0]], ["quaternion_slerp", [q, r, 1.0]]]
        found += [["quaternion_about_axis", [*some(1), some(3)]], ["random_quaternion", [rng.uniform(size=3).tolist()]]]
        found += [
            ["random_rotation_matrix", [rng.uniform(size=3).tolist()]],
            ["rotation_matrix", [*some(1), some(3), some(3)]],
        ]
        found += [["rotation_matrix", [*some(1), some(3)]], ["rotation_matrix", [*some(1), some(4), [*some(3), 1.0]]]]
        found += [["translation_matrix", [some(3)]], ["concatenate_matrices", [transform(), transform(), transform()]]]
        found += [
            ["is_same_transform", [transform(), transform()]],
            ["is_same_transform", [quarter[7], (3 * np.array(quarter[7])).tolist()]],
        ]
        found += [
            ["reflection_matrix", [some(3), some(3)]],
            ["scale_matrix", some(1)],
            ["scale_matrix", [*some(1), some(3)]],
        ]
        found += [["scale_matrix", [*some(1), some(3), some(3)]], ["scale_matrix", [*some(1), None, some(3)]]]
        found += [["unit_vector", [some(5)]], ["unit_vector", [some(4, 3), 1]], ["unit_vector", [some(4, 3)]]]
        found += [
            ["vector_norm", [some(5)]],
            ["vector_norm", [some(4, 3), 0]],
            ["vector_norm", [[]]],
            ["unit_vector", [[]]],
        ]
        parts = [
            rng.uniform(0.5, 2.0, size=3).tolist(),
            some(3),
            rng.uniform(-1.4, 1.4, size=3).tolist(),
            some(3),
            [*some(3), 2.0],
        ]
        found += [["compose_matrix", parts], ["compose_matrix", parts[:4]], ["compose_matrix", [None, None, parts[2]]]]
        composed = [tft.compose_matrix(*parts[:n]).tolist() for n in range(1, 6)]
        found += [
            ["decompose_matrix", [matrix]]
            for matrix in (*composed, transform(), (np.diag([1, 1, -1, 1]) @ transform()).tolist())
        ]
        points = rng.normal(size=(3, 6))
        moved = (rotation()[:3, :3] @ points + rng.normal(size=(3, 1))) * rng.uniform(0.5, 2.0)
        for scaling in (False, True):
            found += [["superimposition_matrix", [points.tolist(), moved.tolist(), scaling]]]
            found += [["superimposition_matrix", [points.tolist(), (moved + 0.1 * points[::-1]).tolist(), scaling]]]
    return found


def here(name, arguments):
    given = [tuple(argument["tuple"]) if isinstance(argument, dict) else argument for argument in arguments]
    return plain(getattr(tft, name)(*given))


def flat(value):
    return [number for item in value for number in flat(item)] if isinstance(value, list) else [value]


def test_the_same_numbers(ros):
    asked = calls()
    differ = []
    for call, there in zip(asked, ros.ask("call_tft.py", asked), strict=True):
        ours, theirs = flat(here(*call)), flat(there.get("gives"))
        if len(ours) != len(theirs) or not np.allclose(ours, theirs, rtol=1e-7, atol=1e-7):
            differ.append((call, there, ours))
    assert len(asked) > 4_000 and {name for name, _ in asked} >= set(tft.__all__) - {
        "rotation_from_matrix",
        "random_vector",
    }
    assert not differ, (
        f"{len(differ)} of {len(asked)}: {sorted({call[0] for call, _, _ in differ})}, such as {differ[0]}"
    )


NO_NUMBER = [None, "0.5", [0.5, 1.0], [[0.5], [1.0]]]


@pytest.mark.parametrize(
    "name, arguments, angles",
    [
        ("euler_matrix", [0.1, 0.2, 0.3], (0, 1, 2)),
        ("quaternion_from_euler", [0.1, 0.2, 0.3], (0, 1, 2)),
        ("quaternion_about_axis", [0.1, [0, 0, 1]], (0,)),
        ("rotation_matrix", [0.1, [0, 0, 1]], (0,)),
    ],
)
def test_what_is_no_angle_is_refused_as_in_ros(ros, name, arguments, angles):
    asked = [
        [name, [*arguments[:position], wrong, *arguments[position + 1 :]]]
        for position in angles
        for wrong in [*NO_NUMBER, math.inf]
    ]
    for (_, given), there in zip(asked, ros.ask("call_tft.py", asked), strict=True):
        assert there.get("raises") in ("TypeError", "ValueError")
        with pytest.raises((TypeError, ValueError), match=name):
            getattr(tft, name)(*given)
    with pytest.raises(TypeError, match=name):
        getattr(tft, name)(1j, *arguments[1:])


@pytest.mark.filterwarnings("ignore:invalid escape sequence")
def test_examples_of_ros(ros):
    """The doctests in ROS's file, with our functions; Python 2's print and NumPy 1's numbers are as they were."""
    with open(ros.run("-c", FIND).stdout.strip(), encoding="utf-8") as file:
        tree = ast.parse(file.read())
    own = {node.name for node in tree.body if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")}
    assert own - set(tft.__all__) == {name for name in own if name in NOT_HERE or name.startswith("arcball_")}
    axes = dict(ast.literal_eval(ros.run("-c", TUPLES).stdout))
    attempted, said = 0, []
    np.random.seed(24)
    for node in tree.body:
        text = ast.get_docstring(node) if getattr(node, "name", None) in tft.__all__ else None
        text = (
            (text or "").replace("print size", "print(size)").replace('print axes, "failed"', 'print(axes, "failed")')
        )
        names = {
            **{name: getattr(tft, name) for name in tft.__all__},
            "numpy": np,
            "math": math,
            "random": random,
            "_AXES2TUPLE": axes,
            "_TUPLE2AXES": {tuple(code): name for name, code in axes.items()},
        }
        examples = doctest.DocTestParser().get_doctest(text, names, getattr(node, "name", ""), None, 0)
        with np.printoptions(legacy="1.25"):
            attempted += doctest.DocTestRunner().run(examples, out=said.append).attempted
    assert attempted > 150 and not said, "".join(said)
