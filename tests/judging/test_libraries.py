"""Objects of other libraries are taken for what they say; here by their names and protocols, for the libraries are not there."""

from collections import UserList

import numpy as np
import pytest
from transform_lab import Point, Pose
from transform_lab.judging.codec import encode
from transform_lab.libraries import MATRICES, taken

TURN = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def no_length(self):
    raise TypeError("Single rotation has no len()")


def made(library, name, base=object, form=property):
    """An object of a library's class, which has its matrix as an attribute, or as a method."""
    members = {"__module__": f"{library}.inner.rooms", MATRICES[library, name]: form(lambda self: TURN)}
    return type(name, (base,), members | ({} if base is object else {"__len__": no_length}))()


@pytest.mark.parametrize("form", [property, lambda method: method])
@pytest.mark.parametrize("base", [object, tuple, list, UserList])
@pytest.mark.parametrize("library, name", MATRICES)
def test_a_rotation_or_transform_is_its_matrix_whatever_else_it_is(library, name, base, form):
    """JAX's Rotation is a tuple that has no length, spatialmath's SO3 a list of several."""
    answer = made(library, name, base, form)
    np.testing.assert_array_equal(taken(answer), TURN)
    assert encode(answer) == encode(TURN)


@pytest.mark.parametrize(
    "library, name, call", [("scipy", "Rotation", "as_quat()"), ("jaxlie", "SO3", "as_quaternion_xyzw()")]
)
def test_it_is_no_quaternion_of_a_pose_and_told_how_to_get_one(library, name, call):
    answer = made(library, name)
    setattr(type(answer), call.removesuffix("()"), None)
    orientation = encode(Pose(Point(), answer))["fields"]["orientation"]
    assert orientation == {"other": f"{name} (.{call} makes an array of it)"}


class Rows:
    """A matrix as mpmath has it: it makes lists of its rows, and its items are numbered through."""

    def __init__(self, rows):
        self.rows = rows

    def tolist(self):
        return self.rows

    def __len__(self):
        return sum(map(len, self.rows))

    def __getitem__(self, index):
        return [number for row in self.rows for number in row][index]


@pytest.mark.parametrize("rows", [TURN.tolist(), np.eye(4).tolist(), [[1, 2, 3]], [[1], [2], [3]]])
def test_a_matrix_has_the_shape_of_its_lists(rows):
    assert encode(Rows(rows)) == encode(np.array(rows))
