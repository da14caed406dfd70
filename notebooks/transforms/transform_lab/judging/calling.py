"""Calls a student's function with plain arguments, in the process that has it: the notebook's kernel, or the sandbox."""

import io
import traceback
from collections.abc import Callable
from contextlib import redirect_stdout

from . import codec
from .kinds import ARGUMENT, EARLIER_ANSWER
from .plain import Plain
from .verdict import Reply

# The function that was called last, its answer, and what that was then, as plain data
_before: list = [None, None, None]
MOST_PRINTED = 200  # characters of what a function prints while it is checked


def call(function: Callable, args: list[Plain], kwargs: dict[str, Plain]) -> Reply:
    """The Reply of `function` to plain arguments: fresh objects for each call, and what became of them after it."""
    return reply(function, [codec.decode(arg) for arg in args], {key: codec.decode(arg) for key, arg in kwargs.items()})


def reply(function: Callable, args: list, kwargs: dict) -> Reply:
    """The Reply of `function` to decoded arguments, which have to be fresh."""
    printed = io.StringIO()
    try:
        with redirect_stdout(printed):
            value = function(*args, **kwargs)
            plain = codec.encode(value)  # an object of the student's own may raise when it is asked for its numbers
    except Exception as error:
        if isinstance(error, NotImplementedError) and _raised_in(function, error):
            return Reply("not done")
        return Reply("raised", error=one_line(error))
    after = [[codec.encode(arg) for arg in args], {key: codec.encode(arg) for key, arg in kwargs.items()}]
    same = same_object(function, value, plain, [*args, *kwargs.values()])
    return Reply("returned", plain, after, printed=printed.getvalue()[:MOST_PRINTED], same_object=same)


def same_object(function: Callable, value: object, plain: Plain, given: list) -> str:
    """What the answer to this call (as it is, and as plain data) is instead of an object of its own; see Reply."""
    last, answer, then = _before
    changed = last is function and codec.encode(answer) != then
    _before[:] = function, value, plain
    if changed:
        return EARLIER_ANSWER
    return ARGUMENT if any(value is arg for arg in given) else ""


def _raised_in(function, error):
    """Whether the function itself raised the error, and none that it calls."""
    step = error.__traceback__
    while step.tb_next is not None:
        step = step.tb_next
    return step.tb_frame.f_code is getattr(function, "__code__", step.tb_frame.f_code)


def one_line(error: BaseException) -> str:
    """An exception in one line of bounded length, with the student's own line in which it came up, if there is one."""
    where = ""
    for step in traceback.extract_tb(error.__traceback__):
        line = step.line or ""
        if not (step.filename.startswith("<ipython-input") or "ipykernel_" in step.filename):
            continue
        if not line.startswith("get_ipython()"):  # which is what a %magic was turned into
            where = f", in your line {step.lineno}: `{_shortened(line, 80)}`"
    message = _shortened(f"{type(error).__name__}: {' '.join(str(error).split())}", 180).rstrip(".: ")
    return message + where


def _shortened(text, most):
    return text if len(text) <= most else f"{text[: most - 1]}…"
