"""Which run of a cell made each function of a notebook, and what has become of that cell since.

The kernel keeps a function until a cell makes another one of that name. Once the cell was changed, and fails or gives its
function another name, the function that is there is older than the cell's text. IPython tells of each run its text, its
error and, where the front end sends it, the cell's id. Where these leave a doubt, a function counts as up to date.
"""

import re
from dataclasses import dataclass
from types import FunctionType
from typing import NamedTuple

from .judging.calling import one_line

FUNCTION = re.compile(r"^([ \t]*)(?:(?:async[ \t]+)?def[ \t]+(\w+)|(\w+)[ \t]*=[ \t]*lambda\b)", re.M)


@dataclass(frozen=True)
class Change:
    """What has happened after a function was made, or instead of its being made.

    cell: the id of the cell that was run
    stopped: the error with which it stopped before it made the function, in one line; "" where it did not stop
    instead: names of the functions that it made instead
    certain: False where that was perhaps another cell, so that the function may be up to date all the same
    """

    cell: str | None
    stopped: str = ""
    instead: tuple[str, ...] = ()
    certain: bool = True


class Made(NamedTuple):
    """A function, and the run of a cell that made it.

    cell: the cell's id; None where it is not known
    defines: names of the functions that the cell's text defined then
    """

    function: FunctionType
    cell: str | None = None
    defines: frozenset[str] = frozenset()


class Run(NamedTuple):
    """A run of a cell: the cell's id or None, its text, the error with which it stopped ("" if none), what it made."""

    cell: str | None
    text: str
    stopped: str
    new: frozenset[str]


class Cells:
    """What the cells of a notebook have made since `transform_lab` was imported in it."""

    def __init__(self, shell):
        self.shell = shell
        self._made = {name: Made(function) for name, function in functions(shell.user_ns).items()}
        self._changes = {}
        shell.events.register("post_run_cell", self._after)

    def change(self, name, function=None):
        """What has happened since `function` was made under this name, or without one, why none was; None if nothing has."""
        made = self._made.get(name)
        if (function is not None or name in self.shell.user_ns) and (made is None or made.function is not function):
            return None
        return self._changes.get(name)

    def _after(self, result):
        if result is None:  # a cell that was cancelled
            return
        now = functions(self.shell.user_ns)
        new = {name for name in now if name not in self._made or self._made[name].function is not now[name]}
        run = Run(getattr(result.info, "cell_id", None), result.info.raw_cell or "", _stopped(result), frozenset(new))
        # what an earlier run of this cell did is past
        self._changes = {
            name: change for name, change in self._changes.items() if run.cell is None or change.cell != run.cell
        }
        missed = defined(run.text, indented=result.error_before_exec is not None) - new if run.stopped else set()
        for name in missed | (self._made.keys() & now.keys()) - new:
            made = self._made.get(name)
            change = _missed(made, run) if name in missed else self._replaced(name, made, run)
            if change and (change.certain or not self._changes.get(name, change).certain):
                self._changes[name] = change
        defines = frozenset(defined(run.text)) if new else frozenset()
        self._made = {name: Made(now[name], run.cell, defines) if name in new else self._made[name] for name in now}
        for name in new:
            self._changes.pop(name, None)

    def _replaced(self, name, made, run):
        """The Change when the run of a cell that does not define the function has other functions in its place."""
        others = tuple(sorted(run.new - made.defines))
        if None in (run.cell, made.cell):
            parameters = parameters_of(made.function)
            others = tuple(other for other in others if parameters_of(self.shell.user_ns[other]) == parameters != ())
            return Change(run.cell, instead=others, certain=False) if others and not _binds(run.text, name) else None
        if run.cell != made.cell or name not in made.defines or _binds(run.text, name):
            return None
        return Change(run.cell, "" if others or not defined(run.text, indented=True) else run.stopped, others)


def _missed(made, run):
    """The Change when a run stopped before it made a function that its text defines."""
    return Change(run.cell, run.stopped, certain=made is None or None in (run.cell, made.cell) or run.cell == made.cell)


def functions(namespace):
    """{name: function} of the functions that cells have made by `def` or `lambda`, under this name.

    Each run makes new ones, so that one that is the same as before was not made by the run.
    """
    return {
        name: value
        for name, value in list(namespace.items())
        if type(value) is FunctionType and value.__module__ == "__main__" and value.__name__ in (name, "<lambda>")
    }


def defined(text, indented=False):
    """Names of the functions that a cell's text defines, be it right Python or not; on request those in blocks, too."""
    return {found[2] or found[3] for found in FUNCTION.finditer(text) if indented or not found[1]}


def parameters_of(function):
    """The names of a function's parameters, as an exercise has them: with a star where there may be any number."""
    code = function.__code__
    names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    return (*names, f"*{code.co_varnames[len(names)]}") if code.co_flags & 0x04 else names


def _binds(text, name):
    """Whether a cell's text may give the name a value in some way; in doubt it does."""
    binding = rf"\b{name}\b[^\n=()]*=(?!=)|\bimport\b.*\b{name}\b|\b(as|for|global|def|class)\s+{name}\b"
    return re.search(binding, text) is not None


def _stopped(result):
    """The error with which a run stopped, in one line; "" if it did not."""
    if (error := result.error_before_exec) is not None:
        line = f", in line {error.lineno}" if getattr(error, "lineno", None) else ""
        return f"{type(error).__name__}: {getattr(error, 'msg', error)}{line}"
    return "" if result.error_in_exec is None else one_line(result.error_in_exec)
