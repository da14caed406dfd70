"""A misconception keeps its name where its exercise is a step of another one, or gets none: a wrong name is worse than none."""

import numpy as np
import pytest
from support import SEEDS, judged
from transform_lab import Pose
from transform_lab.judging.diagnosis import GENERAL

from autograder.exercises import EXERCISES
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
