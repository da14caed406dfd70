"""What objects of other libraries hold, as NumPy's and Python's own numbers. They are known by their names and protocols.

| object                                                       | taken as                                        |
|--------------------------------------------------------------|-------------------------------------------------|
| what NumPy takes for an array: JAX, Torch, SymPy, Pinocchio  | the array                                       |
| one rotation or transform: SciPy, JAX, spatialmath, Drake, … | its 3x3 or 4x4 matrix, the one thing that it says |
| a number of SymPy, Fraction, Decimal, mpmath, …              | a float, an int where it is whole by its type   |
| a truth of SymPy, …                                          | True, False                                     |

A quaternion is none of these: which of its numbers is w, only the names of its fields tell.
"""

import re
from collections.abc import Mapping
from functools import cache
from numbers import Integral

import numpy as np

MOST = 1_000  # numbers of one object

# (library, class) of what is one matrix and nothing else, and the attribute or method that gives it
MATRICES = {
    ("scipy", "Rotation"): "as_matrix",
    ("scipy", "RigidTransform"): "as_matrix",
    ("jax", "Rotation"): "as_matrix",
    ("jaxlie", "SO3"): "as_matrix",
    ("jaxlie", "SE3"): "as_matrix",
    ("spatialmath", "SO3"): "A",
    ("spatialmath", "SE3"): "A",
    ("pydrake", "RotationMatrix"): "matrix",
    ("pydrake", "RigidTransform"): "GetAsMatrix4",
    ("pydrake", "Isometry3"): "matrix",
    ("gtsam", "Rot3"): "matrix",
    ("gtsam", "Pose3"): "matrix",
}
# What makes an array of an object that is not taken by itself; the first that it has is named
CALLS = (
    "as_matrix()", "GetAsMatrix4()", "detach().cpu().numpy()", "to_numpy()", "toarray()", "homogeneous_matrix()",
    "to_homogeneous()", "ToRotationMatrix()", "R", "SE3().A", "matrix()", "rotation()",
)  # fmt: skip
# And in the field of a message
TO_QUATERNION = ("as_quat()", "as_quaternion_xyzw()", "ToQuaternion().wxyz()", "vec_xyzs", *CALLS)
FIELDS = "xyzw"  # of a quaternion


def is_matrix(value):
    """Whether `value` is a rotation or a transform of another library, of which this module knows the matrix."""
    return _giver(type(value)) is not None


def is_transform(value):
    """Whether it is a matrix, or has methods x, y, z and for its matrix, as other libraries' transforms do: it is no Point."""
    kind = type(value)
    return is_matrix(value) or (callable(getattr(kind, "x", None)) and _call(kind, CALLS) is not None)


def is_array(value):
    """Whether NumPy takes it for an array, or takes it apart as it does a list: a range, SymPy's Array, a vector of a game's."""
    kind = type(value)
    if hasattr(kind, "__array__"):
        return True
    if isinstance(value, (str, bytes, Mapping)) or not hasattr(kind, "__len__") or not hasattr(kind, "__getitem__"):
        return False
    if hasattr(kind, "matrix"):  # a quaternion of spatialmath's is a list, too
        return False
    try:
        return len(value) <= MOST
    except TypeError:  # one vector, of a class of several
        return False


def taken(value):
    """The array, float, int or bool that `value` stands for; None for what has none, whatever it raises when it is asked."""
    try:
        if is_matrix(value):
            return _matrix(value)
        return _array(_as_array(value)) if is_array(value) else _number(value)
    except Exception:
        # Its own: of SymPy's symbols, of tensors with gradients or elsewhere, of rows that differ in length, …
        return None


def described(value, calls=CALLS):
    """The name of an object's type; with the call that makes an array of it, where it has one of these."""
    kind = type(value)
    call = _call(kind, calls)
    return f"{kind.__name__} (.{call} makes an array of it)" if call else kind.__name__


@cache
def _call(kind, calls):
    """The first of `calls` that objects of this type have; what is called there is a method, what is not is none."""

    def has(call):
        name = re.split(r"\W", call)[0]
        return hasattr(kind, name) and callable(getattr(kind, name)) == call.startswith(f"{name}(")

    return next(filter(has, calls), None)


@cache
def _giver(kind):
    """The attribute or method that gives the one matrix of objects of this type; None for any other type."""
    classes = ((str(one.__module__).partition(".")[0], one.__name__) for one in kind.__mro__)
    return next((MATRICES[one] for one in classes if one in MATRICES), None)


def _matrix(value):
    """The matrix of a rotation or transform; of several, all of them as an array of three dimensions."""
    found = getattr(value, _giver(type(value)))
    return np.array(found() if callable(found) else found)


def _as_array(value):
    """As NumPy takes it; what makes lists of itself has its rows there, and may be numbered through without (mpmath)."""
    flat = hasattr(value, "tolist") and not hasattr(value, "__array__")
    return np.asarray(value.tolist() if flat else value)


def _array(array):
    """An array of numbers or truths; of objects, one with what each of them is taken for."""
    if array.dtype.kind in "biuf":
        return array if array.ndim else array.item()
    if array.dtype.kind != "O" or array.size > MOST or not array.ndim:
        return None
    found = [_number(item) for item in array.flat]
    return None if None in found else np.array(found).reshape(array.shape)


def _number(value):
    """The float, int or bool that a number or a truth is, None for what is none, or would lose something as a float."""
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, Integral):
        return int(value)
    if hasattr(value, "__array__"):
        found = np.asarray(value)
        return found.item() if found.ndim == 0 and found.dtype.kind in "biuf" else None
    if isinstance(value, str) or all(hasattr(value, field) for field in FIELDS) or np.iscomplexobj(value):
        return None
    if hasattr(type(value), "__float__"):
        return float(value)
    truth = next((truth for truth in (True, False) if (value == truth) is True), None)
    return truth if hasattr(type(value), "__bool__") else None
