"""Objects of other libraries are taken for what they say; tests/libraries has them all, and grades with them.

Here are those of SciPy and of Python itself, and others by their names and protocols.
"""

from array import array
from collections import UserList, deque, namedtuple
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import scipy.sparse
from scipy.spatial.transform import RigidTransform, Rotation
from transform_lab import Point, Pose, Viewer, tft
from transform_lab.judging.calling import call
from transform_lab.judging.codec import Other, decode, encode
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
    "library, name, call",
    [
        ("scipy", "Rotation", "as_quat()"),
        ("jaxlie", "SO3", "as_quaternion_xyzw()"),
        ("pydrake", "RotationMatrix", "ToQuaternion().wxyz()"),
    ],
)
def test_it_is_no_quaternion_of_a_pose_and_told_how_to_get_one(library, name, call):
    answer = made(library, name)
    setattr(type(answer), call.partition("(")[0], lambda self: None)
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


class Vector:
    """As games have it: three numbers with names, and in a row."""

    def __init__(self, x, y, z):
        self.x, self.y, self.z = x, y, z

    def __len__(self):
        return 3

    def __getitem__(self, index):
        return [self.x, self.y, self.z][index]


Named = namedtuple("Named", "x y z")


@pytest.mark.parametrize("kind", [Vector, Named])
def test_three_numbers_with_names_are_a_row_of_them_and_in_a_field_a_point(kind):
    np.testing.assert_array_equal(np.array(decode(encode(kind(1.0, 2.0, 3.0)))), [1, 2, 3])
    assert decode(encode(Pose(position=kind(1.0, 2.0, 3.0)))).position == Point(1, 2, 3)
    assert decode(encode(Point(1.0, 2.0, 3.0))) == Point(1, 2, 3)


class Measured(np.ndarray):
    """A number with a unit, as astropy has it: its own item."""

    def item(self):
        return self


def test_a_number_with_a_unit_is_the_number():
    assert encode(np.array(1.5).view(Measured)) == 1.5


@pytest.mark.parametrize("call", ["matrix", "to_homogeneous", "rotation"])
def test_a_transform_whose_x_is_a_method_is_no_point(call):
    methods = dict.fromkeys(("x", "y", "z", call), lambda self: 1.0)
    assert encode(type("Pose3", (), methods)()) == {"other": f"Pose3 (.{call}() makes an array of it)"}


def test_a_call_that_is_named_is_a_method():
    assert encode(type("Coordinates", (), {"rotation": property(lambda self: TURN)})()) == {"other": "Coordinates"}


def test_one_vector_of_a_class_of_several_has_no_length_and_is_a_point():
    several = {"__len__": no_length, "__getitem__": no_length}
    assert encode(type("Several", (), several)()) == {"other": "Several"}
    assert decode(encode(type("Several", (), {**several, "x": 1.0, "y": 2.0, "z": 3.0})())) == Point(1, 2, 3)


REAL = [
    (Fraction(1, 4), 0.25),
    (Decimal("0.25"), 0.25),
    (array("d", [1, 2, 3]), [1, 2, 3]),
    (deque([1, 2, 3]), [1, 2, 3]),
    (range(3), [0, 1, 2]),
    (np.array([Fraction(1, 2), 1], dtype=object), [0.5, 1]),
    (Rotation.from_matrix(TURN), TURN),
    (RigidTransform.from_matrix(np.eye(4)), np.eye(4)),
    (Rotation.from_matrix([TURN, TURN]), [TURN, TURN]),
]


@pytest.mark.parametrize("answer, numbers", REAL, ids=[type(answer).__name__ for answer, _ in REAL])
def test_what_holds_numbers_is_these_numbers(answer, numbers):
    np.testing.assert_allclose(decode(encode(answer)), numbers, atol=1e-15)


@pytest.mark.parametrize(
    "answer", [1j, np.complex128(1j), np.array([1j]), np.array([None, 1]), b"abc", {1, 2}, scipy.sparse.eye(3), int]
)
def test_what_holds_none_or_would_lose_some_is_refused(answer):
    assert isinstance(decode(encode(answer)), Other)


def test_an_object_that_fails_when_it_is_asked_is_the_students_error():
    class Failing:
        def __getattr__(self, name):
            raise RuntimeError(f"no {name}")

    reply = call(lambda: Failing(), [], {})
    assert reply.outcome == "raised" and reply.error.startswith("RuntimeError: no ")


def test_the_viewer_takes_a_transform_and_tft_says_what_to_call():
    viewer = Viewer("a")
    viewer.add_frame("b", RigidTransform.from_translation([1, 2, 3]))
    np.testing.assert_array_equal(viewer.lookup("a", "b")[:3, 3], [1, 2, 3])
    with pytest.raises(TypeError, match=r"not a RigidTransform \(\.as_matrix\(\) makes an array of it\)"):
        tft.quaternion_from_matrix(RigidTransform.identity())
    with pytest.raises(TypeError, match="not a SE3$"):  # which has x, y and z, and is no Point
        tft.quaternion_matrix(made("spatialmath", "SE3"))
