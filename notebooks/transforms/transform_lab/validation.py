"""Turns what a caller passes in into arrays, and says in plain words what is wrong with it."""

import numpy as np

from . import libraries

# How far a rotation's entries may be off: 0.707 for cos 45 degrees passes, as it does in ROS.
TOLERANCE = 1e-3
NEAREST = 1e-5  # metres; smaller things cannot be seen
FARTHEST = 1e6  # metres; farther away, a graphics card's 32-bit numbers no longer tell decimetres apart


def numbers(value, what, lengths=None):
    """Return `value` (numbers, lists of numbers, an array) as a new float64 array; `what` names it in errors.

    With `lengths`, the result is a vector of one of these lengths. Raises TypeError if `value` is not made of numbers
    (a message, say), ValueError for another length, unequal rows, NaN or infinity.
    """
    plain = type(value) is np.ndarray and value.dtype == np.float64  # as most are: it is made of numbers
    array = np.array(value) if plain else _numeric(value, what)
    if lengths is not None:
        if array.size not in lengths or array.size != max(array.shape, default=0):
            expected = " or ".join(str(n) for n in lengths)
            raise ValueError(f"{what} must be {expected} numbers; got {shape_text(array)}")
        array = array.reshape(-1)
    if not np.isfinite(array).all():
        raise ValueError(f"{what} contains NaN or infinity: {array.tolist()}")
    return array


def _numeric(value, what):
    """Return `value`, which is no array of floats, as one."""
    if libraries.is_matrix(value):
        raise TypeError(f"{what} must be a plain array of numbers, not a {libraries.described(value)}")
    for fields, spelling in [("xyzw", "q"), ("xyz", "p")]:
        if all(hasattr(value, field) for field in fields):
            spelled_out = ", ".join(f"{spelling}.{field}" for field in fields)
            raise TypeError(
                f"{what} must be a plain list of numbers, not a {type(value).__name__} message: write [{spelled_out}]"
            )
    if value is None:
        raise TypeError(f"{what} must be made of numbers; got None. Does your function return its result?")
    try:
        kind = np.asarray(value).dtype.kind
        if np.ma.is_masked(value) or kind in "cSU":
            raise TypeError  # NumPy would drop imaginary parts, show what is masked, and read numbers in texts
        if kind == "O" and any(item is None or isinstance(item, (str, bytes)) for item in np.asarray(value).flat):
            raise TypeError
        return np.array(value, dtype=np.float64)
    except TypeError:
        got = repr(value) if isinstance(value, (str, list, tuple)) and len(repr(value)) < 80 else type(value).__name__
        raise TypeError(f"{what} must be made of numbers; got {got}") from None
    except OverflowError:
        raise ValueError(f"{what} has a number that is too large") from None
    except ValueError:
        raise ValueError(f"{what} must be made of numbers, in rows of equal length; got {value!r}") from None


def shape_text(array):
    """Return an array's shape in words: "3x3", "3 numbers", "a single number"."""
    if array.ndim == 0:
        return "a single number"
    return f"{array.size} numbers" if array.ndim == 1 else "x".join(str(n) for n in array.shape)


def rigid_transform(matrix, what):
    """Return `matrix` as a new 4x4 float64 array, a homogeneous transform; `what` starts the error messages.

    Raises ValueError naming the property that fails: the shape, finite entries, the bottom row 0, 0, 0, 1, columns of
    length 1 at right angles (R.T @ R = I), or the determinant (+1; -1 is a reflection).
    """
    T = numbers(matrix, what)
    if T.shape != (4, 4):
        advice = " Put the rotation into the upper left of np.eye(4)." if T.shape == (3, 3) else ""
        raise ValueError(f"{what} must be a 4x4 homogeneous transform as in ROS; got {shape_text(T)}.{advice}")
    if np.abs(T[3] - (0, 0, 0, 1)).max() > TOLERANCE:
        advice = " The translation belongs into the last column, T[:3, 3]." if T[3, :3].any() else ""
        raise ValueError(f"{what} must have the bottom row 0, 0, 0, 1; it is {row_text(T[3])}.{advice}")
    R = T[:3, :3]
    error = np.abs(R.T @ R - np.eye(3)).max()
    if error > TOLERANCE:
        lengths = np.linalg.norm(R, axis=0)
        raise ValueError(
            f"{what} has no rotation matrix in its upper left: R.T @ R differs from the identity by up to {error:.3g}."
            f" The columns must have length 1 and be at right angles; their lengths are {row_text(lengths)}."
        )
    determinant = np.linalg.det(R)
    if determinant < 0:
        raise ValueError(
            f"{what} has a reflection in its upper left, not a rotation: the determinant is {determinant:.3g} and must"
            " be +1. The axes are left-handed: one of them points the wrong way, or two are swapped."
        )
    return T


def within_reach(position, what):
    """Return `position` (an array, in metres) if it can be drawn; raise ValueError for what is too far away."""
    if np.abs(position).max(initial=0) > FARTHEST:
        farthest = position.flat[np.abs(position).argmax()]
        raise ValueError(f"{what} is too far away to be drawn: {farthest:.4g} m. Are these metres?")
    return position


def row_text(values):
    """Return numbers as text, "0, 0, 0.5, 1"."""
    return ", ".join(f"{round(float(value), 6) + 0.0:.4g}" for value in values)  # + 0.0 turns -0 into 0
