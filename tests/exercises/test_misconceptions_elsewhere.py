"""A misconception keeps its name where its exercise is a step of another one, or gets none: a wrong name is worse than none."""

import numpy as np
import pytest
from solutions.wrong import WRONG
from support import SEEDS, judged, key_of
from transform_lab.judging.naming import GENERAL
from transform_lab.judging.plain import has_to_be_wrong

from autograder.exercises import EXERCISES, Misconception
from autograder.exercises.cases import matrix, orientation, pose, pose_of, position

inv = np.linalg.inv


def homogeneous(p):
    return np.append(p, 1.0)


def parts(T):
    return T[:3, :3], T[:3, 3]


def as_pose(T):
    return pose(T[:3, :3], T[:3, 3])


# {(exercise, the exercise that is a step of it): [from the step to the whole, with right steps before and after it]}
STEPS = {
    ("transform_pose", "transform_to_pose"): [lambda step: lambda T, p: step(T @ matrix(p))],
    ("transform_pose", "pose_to_transform"): [lambda step: lambda T, p: as_pose(T @ step(p))],
    ("transform_pose", "make_transform"): [
        lambda step: lambda T, p: as_pose(T @ step(matrix(p)[:3, :3], position(p))),
    ],
    ("transform_pose", "transform_point"): [
        lambda step: lambda T, p: pose_of(step(T, position(p)), orientation(as_pose(T @ matrix(p)))),
    ],
    ("transform_pose", "chain"): [lambda step: lambda T, p: as_pose(step(T, matrix(p)))],
    ("waypoint", "pose_to_transform"): [
        lambda step: lambda o, offset: pose_of((step(o) @ homogeneous(offset))[:3], orientation(o)),
        lambda step: lambda o, offset: pose_of((step(o) @ homogeneous(offset))[:3], orientation(as_pose(step(o)))),
    ],
    ("waypoint", "transform_point"): [
        lambda step: lambda o, offset: pose_of(step(matrix(o), np.asarray(offset)), orientation(o)),
    ],
    ("waypoint", "transform_to_pose"): [
        lambda step: lambda o, offset: step(matrix(o) @ matrix(pose_of(offset, (0, 0, 0, 1)))),
        lambda step: lambda o, offset: pose_of((matrix(o) @ homogeneous(offset))[:3], orientation(step(matrix(o)))),
    ],
    ("waypoint", "transform_pose"): [lambda step: lambda o, offset: step(matrix(o), pose_of(offset, (0, 0, 0, 1)))],
    ("waypoint", "chain"): [
        lambda step: lambda o, offset: as_pose(step(matrix(o), matrix(pose_of(offset, (0, 0, 0, 1)))))
    ],
    ("relative_transform", "invert_transform"): [lambda step: lambda b, c: step(b) @ c],
    ("relative_transform", "chain"): [lambda step: lambda b, c: step(inv(b), c)],
    ("relative_transform", "make_transform"): [
        lambda step: lambda b, c: step(*parts(inv(b) @ c)),
    ],
    ("object_in_gripper", "invert_transform"): [
        lambda step: lambda camera, gripper, p: (step(gripper) @ camera @ homogeneous(p))[:3]
    ],
    ("object_in_gripper", "relative_transform"): [
        lambda step: lambda camera, gripper, p: (step(gripper, camera) @ homogeneous(p))[:3]
    ],
    ("object_in_gripper", "chain"): [
        lambda step: lambda camera, gripper, p: (step(inv(gripper), camera) @ homogeneous(p))[:3]
    ],
    ("object_in_gripper", "transform_point"): [
        lambda step: lambda camera, gripper, p: step(inv(gripper) @ camera, p),
        lambda step: lambda camera, gripper, p: step(inv(gripper), (camera @ homogeneous(p))[:3]),
        lambda step: lambda camera, gripper, p: (inv(gripper) @ homogeneous(step(camera, p)))[:3],
    ],
    ("invert_transform", "make_transform"): [lambda step: lambda T: step(T[:3, :3].T, -T[:3, :3].T @ T[:3, 3])],
    ("pose_to_transform", "make_transform"): [lambda step: lambda p: step(matrix(p)[:3, :3], position(p))],
    ("chain", "make_transform"): [
        lambda step: lambda *transforms: step(*parts(np.linalg.multi_dot((*transforms, np.eye(4))))),
    ],
}
# pre_grasp is a waypoint with an offset along the x axis
STEPS |= {
    ("pre_grasp", step): [
        lambda step, make=make: lambda o, distance=0.1: make(step)(o, np.array([-distance, 0.0, 0.0])) for make in makes
    ]
    for (exercise, step), makes in STEPS.items()
    if exercise == "waypoint"
}


# Where a step's mistake gives the very numbers that another misconception of the whole gives, under a name that says what is
# seen there: {whole: {id in the step: ids in the whole}}
SAME_NUMBERS = {
    "transform_pose": {
        "position-missing": {"wrong-position"},
        "orientation-identity": {"wrong-orientation"},
        "bottom-row-wrong": {"translation-dropped"},
        "applied-twice": {"rotation-applied-twice"},
        "rest-ignored": {"wrong-position"},
        "translation-dropped": {"position-missing"},
        "transforms-left-out": {
            "wrong-orientation", "wrong-position", "orientation-not-transformed", "position-not-transformed"
        },
        "wrong-transform-inverted": {"wrong-direction", "rotation-transposed"},
    },
    "waypoint": {
        "orientation-identity": {"base-frame-offset"},
        "translation-in-bottom-row": {"position-missing"},
        "translation-dropped": {"position-missing"},
        "offset-not-rotated": {"base-frame-offset"},
        "offset-not-rotated;order-reversed": {"base-frame-offset"},
        "applied-twice": {"rotation-applied-twice"},
        "rest-ignored": {"offset-missing"},
        "angle-not-halved": {"rotation-applied-twice"},
        "orientation-not-transformed": {"orientation-identity"},
        "position-not-transformed": {"product-missing"},
        "wrong-position": {"offset-missing"},
        "order-reversed": {"base-frame-offset"},
        "order-reversed;quaternion-order": {"base-frame-offset"},
        "change-of-basis": {"orientation-identity"},
        "updated-too-early": {"order-reversed"},
        "transforms-left-out": {"orientation-identity", "product-missing", "offset-missing"},
        "wrong-transform-inverted": {"wrong-sign"},
    },
    "relative_transform": {
        "translation-dropped": {"position-missing"},
        "transforms-left-out": {"transform-left-out"},
        "wrong-transform-inverted": {"inverse-missing"},
    },
    "object_in_gripper": {
        "translation-in-bottom-row": {"inverse-by-transpose"},
        "inverse-parts-separately;translation-in-bottom-row": {"inverse-by-transpose"},
        "position-missing": {"inverse-by-transpose", "translation-dropped"},
        "translation-dropped": {"inverse-by-transpose"},
        "wrong-direction": {"wrong-transform-inverted", "inverse-missing"},
        "updated-too-early": {"order-reversed"},
        "transforms-left-out": {"transform-left-out"},
        "wrong-transform-inverted": {"inverse-missing"},
        "order-reversed": {"wrong-transform-inverted", "translation-dropped"},
        "rotation-transposed": {"rotation-not-inverted"},
    },
    "invert_transform": {
        "rotation-transposed": {"rotation-not-inverted"},
        "order-reversed;rotation-transposed": {"rotation-not-inverted"},
        "wrong-direction": {"inverse-missing", "translation-not-inverted"},
    },
    "chain": {"position-missing": {"translation-dropped"}},
    "pose_to_transform": {},
}  # fmt: skip
SAME_NUMBERS["pre_grasp"] = SAME_NUMBERS["waypoint"]


@pytest.mark.parametrize("whole, step", STEPS, ids=lambda name: name)
def test_a_step_keeps_its_name_or_has_none(whole, step, thorough):
    misconceptions = EXERCISES[step].misconceptions
    found = []
    for make in STEPS[whole, step]:
        for misconception in misconceptions[:: 1 if thorough else 7]:
            own = {*misconception.id.split(";"), *SAME_NUMBERS[whole].get(misconception.id, ())} | set(GENERAL)
            for seed in SEEDS[:2] if thorough else SEEDS[:1]:
                called = judged(whole, make(misconception.wrong), seed).misconceptions
                if not set(called) <= own:
                    found.append(f"{misconception.id} of {step} is called {called} in {whole}")
    assert not found, "\n".join(found)


# --- what leaves a part of the answer open ----------------------------------------------------------------------------


def loosely(name):
    """The misconceptions of an exercise that leave something open."""
    varies = Misconception.__dataclass_fields__["varies"].default
    return [misconception for misconception in EXERCISES[name].misconceptions if misconception.varies is not varies]


@pytest.mark.parametrize("name", [name for name in EXERCISES if loosely(name)])
def test_what_is_open_alone_is_no_reason_for_a_name(name):
    """Right but for the cases that one of them leaves open, and half of those right, too: something else is wrong."""
    public = key_of(name)
    for misconception in loosely(name):
        index = EXERCISES[name].misconceptions.index(misconception)
        if not any(has_to_be_wrong(case["wrong"][index]) for case in public["cases"]):
            continue  # it is known by what it answers
        unclear = [n for n, case in enumerate(public["cases"]) if isinstance(case["wrong"][index], dict)]
        cases = iter(range(len(public["cases"])))

        def often_right(*args, wrong=misconception.wrong, unclear=unclear, cases=cases, **kwargs):
            return (wrong if next(cases) in unclear[::2] else EXERCISES[name].reference)(*args, **kwargs)

        assert misconception.id not in ";".join(judged(name, often_right).misconceptions), misconception.id


FALSE_BEFORE = {  # what was called trace-formula-only, though it is something else
    "branch-wrong": [("transform_to_pose", "ttp_slip_in_z_branch"), ("transform_to_pose", "ttp_shepperd_slip_y")],
    "branch-missing": [("transform_pose", "tp_x_branch_only")],
    "gimbal-lock": [("transform_pose", "tp_angles_there_and_back"), ("waypoint", "wp_angles_there_and_back")],
}


@pytest.mark.parametrize("identifier", FALSE_BEFORE)
def test_formulas_that_break_elsewhere_are_not_called_by_the_trace(identifier, thorough):
    written = {function.__name__: function for _, _, function in WRONG}
    for name, function in FALSE_BEFORE[identifier]:
        for seed in SEEDS if thorough else SEEDS[:2]:
            assert judged(name, written[function], seed).misconceptions == (identifier,)
