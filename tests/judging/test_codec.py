"""Values cross to the judge as plain data, and nothing else crosses."""

import json
import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from transform_lab import Point, Pose, PoseStamped, Quaternion
from transform_lab.judging.codec import LARGEST_ARRAY, LONGEST_LIST, NotPlain, Other, decode, encode


def there_and_back(value):
    return decode(json.loads(json.dumps(encode(value))))


@pytest.mark.parametrize("value", [None, True, False, 0, -7, 1.5, "text", [], [1, [2.0, "x"]]])
def test_plain_values_come_back(value):
    result = there_and_back(value)
    assert result == value and type(result) is type(value)


@pytest.mark.parametrize("value", [np.float32(0.5), np.int64(3), np.bool_(True), np.array(2.0)])
def test_numpy_scalars_become_numbers(value):
    assert there_and_back(value) == value.item()
    assert type(there_and_back(value)) is type(value.item())


@pytest.mark.parametrize(
    "value", [np.eye(4), np.arange(3), np.float32([1, 2]), np.array([[True, False]]), np.zeros((0, 3))]
)
def test_arrays_keep_values_and_shape(value):
    np.testing.assert_array_equal(there_and_back(value), value)
    assert there_and_back(value).shape == value.shape


def test_a_matrix_becomes_an_array():
    assert type(there_and_back(np.matrix([[1.0, 2.0]]))) is np.ndarray


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_what_json_cannot_hold_comes_back(value):
    np.testing.assert_equal(there_and_back(value), value)
    np.testing.assert_equal(there_and_back(np.array([value])), np.array([value]))


def test_messages_come_back_by_their_fields():
    pose = Pose(Point(1, 2, 3), Quaternion(0, 0, 0, 1))
    assert there_and_back(pose) == pose
    assert there_and_back(PoseStamped(pose=pose)).pose == pose


ODD = {
    "number": 0.5, "not a number": math.nan, "integer": 3, "large integer": 2**60, "truth": True, "text": "x", "nothing": None,
    "single precision": np.float32(0.1), "array": np.array([0.5]), "infinite array": np.array([1e308, 1e308, math.inf]),
    "long list": [1.0] * 200, "rotation": Rotation.identity(), "class": Point, "itself": Quaternion(),
    "nested": [[[[[[[1.0]]]]]]],
}  # fmt: skip


@pytest.mark.parametrize("value", ODD.values(), ids=ODD)
@pytest.mark.parametrize("around", [lambda value: value, lambda value: [[[[value]]]]], ids=["alone", "deep in lists"])
def test_our_messages_are_read_as_any_objects_with_their_fields(value, around):
    ours, other = Quaternion(0.0, 0.0, 0.0, 1.0), SimpleNamespace(x=0.0, y=value, z=0.0, w=1.0)
    ours.y = value
    pose, twin = Pose(Point(1.0, 2.0, 3.0), ours), SimpleNamespace(position=Point(1.0, 2.0, 3.0), orientation=other)
    assert encode(around(ours)) == encode(around(other))
    assert encode(around(pose)) == encode(around(twin))


def test_our_message_without_a_field_is_read_by_those_it_has():
    quaternion = Quaternion(1, 2, 3, 4)
    del quaternion.w
    assert encode(quaternion) == encode(Point(1, 2, 3))
    del quaternion.x
    assert encode(quaternion) == {"other": "Quaternion"}


def test_any_object_with_the_fields_is_a_message():
    class Ros:
        def __init__(self, **fields):
            self.__dict__.update(fields)

    pose = Ros(position=SimpleNamespace(x=1, y=2, z=3), orientation=Ros(x=0, y=0, z=0, w=1))
    assert there_and_back(pose) == Pose(Point(1, 2, 3), Quaternion(0, 0, 0, 1))


@pytest.mark.parametrize(
    "value, name",
    [
        (object(), "object"),
        ({1: 2}, "dict"),
        (1j, "complex"),
        (2**60, "int"),
        (np.array(["x"]), "array of <U1"),
        (np.zeros(LARGEST_ARRAY + 1), f"array of shape ({LARGEST_ARRAY + 1},)"),
        ([0] * 101, "list"),
    ],
)
def test_what_has_no_plain_form_is_named(value, name):
    result = there_and_back(value)
    assert isinstance(result, Other) and result.type_name == name


@pytest.mark.parametrize("shape", [(), (1,), (3,), (3, 3)])
@pytest.mark.parametrize("kind", [bool, int, float])
def test_what_only_claims_to_be_an_array_is_refused_at_once(shape, kind):
    class Claims:
        __class__ = property(lambda self: np.ndarray)
        ndim, size, dtype = len(shape), math.prod(shape), np.dtype(kind)

    Claims.shape = shape
    for value in (Claims(), [Claims()], (1.0, Claims())):
        with pytest.raises(TypeError, match="Claims claims to be an array of numbers, and is none"):
            encode(value)


def test_lists_in_lists_end_somewhere():
    endless = []
    endless.append(endless)
    assert len(json.dumps(encode(endless))) < 100


class Counted(float):
    """A number that counts how often it is looked at."""

    looks = 0

    def __float__(self):
        self.looks += 1
        return 0.0


@pytest.mark.parametrize("inside", [lambda item: item, lambda item: Point(item, 0, 0)])
def test_no_more_of_a_list_is_looked_at_than_is_kept(inside):
    number = Counted()
    few, many = ([[inside(number)] * LONGEST_LIST] * times for times in (4, LONGEST_LIST))
    assert len(encode(few)) == 4 and number.looks == 4 * LONGEST_LIST
    assert encode(many) == {"other": "list"} and number.looks <= 4 * LONGEST_LIST + LARGEST_ARRAY
    assert encode(Pose(Point(many, 0, 0), Quaternion()))["fields"]["position"]["fields"]["x"] == {"other": "list"}
    assert encode([np.zeros(LARGEST_ARRAY // 2)] * 3) == {"other": "list"}


@pytest.mark.parametrize(
    "plain",
    [
        {},
        {"what": 1},
        {"array": [1, 2], "shape": [3]},
        {"array": [1], "shape": []},
        {"array": [1], "shape": [-1]},
        {"array": [1], "shape": [True]},
        {"array": ["x"], "shape": [1]},
        {"array": [[1]], "shape": [1]},
        {"array": [None], "shape": [1]},
        {"array": "ab", "shape": [2]},
        {"array": [0.0] * (LARGEST_ARRAY + 1), "shape": [LARGEST_ARRAY + 1]},
        {"array": [0.0] * 2 * LARGEST_ARRAY, "shape": [2, LARGEST_ARRAY]},
        {"array": [], "shape": [0, 10**9]},
        {"float": "1.0"},
        {"float": "nan", "more": 1},
        {"message": "os.system", "fields": {}},
        {"message": "Pose", "fields": {"position": 1}},
        {"message": ["Pose"], "fields": {}},
        {"other": 5},
        [[[[[[[[1]]]]]]]],
        "x" * 1000,
        2**70,
        [0] * 1000,
    ],
)
def test_what_encode_cannot_have_written_is_refused(plain):
    with pytest.raises(NotPlain):
        decode(plain)
