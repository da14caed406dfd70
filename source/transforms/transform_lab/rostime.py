"""Moments and spans of time as ROS 1 has them: whole seconds and nanoseconds.

They compute and compare as genpy's do, but for two things: a number of seconds is equal to a Time or Duration of as many,
because a plain number may stand in a message's `stamp` or `lifetime` here; and `repr` is a constructor call.

Source: genpy/rostime.py of ROS Noetic.
"""

from functools import total_ordering
from numbers import Integral, Real

__all__ = ["Duration", "Time"]

SECOND = 1_000_000_000  # nanoseconds


@total_ordering
class _Seconds:
    """What Time and Duration have in common: `secs`, any integer, and `nsecs`, from 0 to less than a second."""

    __slots__ = ("secs", "nsecs")

    def __init__(self, secs=0, nsecs=0):
        """Take whole seconds and nanoseconds, or one float of seconds (what is left of a nanosecond is cut off)."""
        if not isinstance(secs, Integral):
            if nsecs != 0:
                raise ValueError("if secs is a float, nsecs cannot be set")
            secs, nsecs = _parts(secs)
        self.secs, self.nsecs = int(secs), int(nsecs)
        self.canon()

    @classmethod
    def from_sec(cls, float_secs):
        """Make one from a float of seconds, such as `time.time()` gives."""
        return cls(*_parts(float_secs))

    def set(self, secs, nsecs):
        """Set both fields, as they are given."""
        self.secs, self.nsecs = secs, nsecs

    def canon(self):
        """Carry nanoseconds that make up seconds over to `secs`."""
        self.secs, self.nsecs = self.secs + self.nsecs // SECOND, self.nsecs % SECOND

    def is_zero(self):
        """Return whether both fields are 0."""
        return self.secs == 0 and self.nsecs == 0

    def to_sec(self):
        """Return the time in seconds, a float."""
        return float(self.secs) + self.nsecs / 1e9

    def to_nsec(self):
        """Return the time in nanoseconds, an integer."""
        return self.secs * SECOND + self.nsecs

    def __bool__(self):
        return not self.is_zero()

    def __eq__(self, other):
        if isinstance(other, Real):
            return self.to_sec() == other
        return self._is_of_kind(other) and self.to_nsec() == other.to_nsec()

    def __lt__(self, other):
        return self.to_nsec() < other.to_nsec() if self._is_of_kind(other) else NotImplemented

    def __hash__(self):
        return hash(self.to_sec())  # that of a number that is equal

    def __str__(self):
        return str(self.to_nsec())

    def __repr__(self):
        return f"{type(self).__name__}(secs={self.secs}, nsecs={self.nsecs})"

    def _is_of_kind(self, other):
        return isinstance(other, _Seconds) and isinstance(other, Time) == isinstance(self, Time)

    def _moved(self, other, sign):
        return type(self)(self.secs + sign * other.secs, self.nsecs + sign * other.nsecs)


class Time(_Seconds):
    """A moment, in seconds since 1970. Raises TypeError for one before that."""

    __slots__ = ()

    def __init__(self, secs=0, nsecs=0):
        super().__init__(secs, nsecs)
        if self.secs < 0:
            raise TypeError("time values must be positive")

    def to_time(self):
        """Return the moment in seconds, a float, as `time.time()` gives it."""
        return self.to_sec()

    def __add__(self, other):
        return self._moved(other, 1) if isinstance(other, Duration) else NotImplemented

    __radd__ = __add__

    def __sub__(self, other):
        """A Time before this one by a Duration; or the Duration since another Time."""
        if isinstance(other, Time):
            return Duration(self.secs - other.secs, self.nsecs - other.nsecs)
        return self._moved(other, -1) if isinstance(other, Duration) else NotImplemented


class Duration(_Seconds):
    """A span of time, in seconds; it may be negative: then `secs` is, and `nsecs` is counted from there upwards."""

    __slots__ = ()

    def __neg__(self):
        return type(self)(-self.secs, -self.nsecs)

    def __abs__(self):
        return self if self.secs >= 0 else -self

    def __add__(self, other):
        return self._moved(other, 1) if isinstance(other, Duration) else NotImplemented

    __radd__ = __add__

    def __sub__(self, other):
        return self._moved(other, -1) if isinstance(other, Duration) else NotImplemented

    def __mul__(self, factor):
        if isinstance(factor, Integral):
            return type(self)(self.secs * factor, self.nsecs * factor)
        return self.from_sec(self.to_sec() * factor) if isinstance(factor, Real) else NotImplemented

    __rmul__ = __mul__

    def __truediv__(self, divisor):
        """A Duration divided by a number is a Duration; by another Duration, a float."""
        if isinstance(divisor, Duration):
            return self.to_sec() / divisor.to_sec()
        return self.from_sec(self.to_sec() / divisor) if isinstance(divisor, Real) else NotImplemented

    def __floordiv__(self, divisor):
        """As `/`, rounded down to whole seconds, or to an integer."""
        if isinstance(divisor, Duration):
            return int(self.to_sec() // divisor.to_sec())
        return self.from_sec(self.to_sec() // divisor) if isinstance(divisor, Real) else NotImplemented

    def __mod__(self, divisor):
        return self.from_sec(self.to_sec() % divisor.to_sec()) if isinstance(divisor, Duration) else NotImplemented

    def __divmod__(self, divisor):
        return (self // divisor, self % divisor) if isinstance(divisor, Duration) else NotImplemented


def _parts(seconds):
    """Return a float of seconds as whole seconds and nanoseconds, both cut off towards zero."""
    whole = int(seconds)
    return whole, int((seconds - whole) * SECOND)
