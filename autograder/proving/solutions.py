"""What an exercise is proved with: its misconceptions, mutants, shortcuts and cheats, the notebook's and people's solutions."""

import ast
import importlib
import linecache
import pkgutil
import sys
from collections.abc import Callable
from dataclasses import dataclass

import nbformat

from ..course import CourseError
from .cheats import cheats
from .errors import told
from .mutants import Mutant, mutants
from .shortcuts import shortcuts

NOTEBOOK = "notebook: "  # begins what was changed in the notebook's solution


@dataclass(frozen=True)
class Tried:
    """One function that is called on all cases, and whether it has to be right in all of them."""

    kind: str  # "misconception", "mutant", "shortcut", "equivalent", "right", "wrong" or "cheat"
    label: str  # unique among those of its kind
    function: Callable  # of a cheat from nothing to a function that has not been called yet: it knows what it was asked
    mutant: Mutant | None = None
    misconception: str = ""  # its id
    notebook: bool = False  # it is the notebook's solution

    @property
    def right(self):
        return self.kind in ("equivalent", "right")

    def fresh(self):
        """The function as nobody has called it yet."""
        return self.function() if self.kind == "cheat" else self.function


def to_be_tried(course, exercise):
    """The list of Tried of an exercise; mutants and shortcuts are "equivalent" when the specification declares them so."""
    solution = notebook_solution(course, exercise.name)
    right, wrong = own_solutions(course, exercise.name)
    changed = {each.what: each for each in mutants(exercise.reference, "autograder.exercises")}
    if solution:
        changed |= {f"{NOTEBOOK}{each.what}": each for each in mutants(solution)}
    alike = {what for what in changed if {what, what.removeprefix(NOTEBOOK)} & _declared(exercise)}
    return [
        *(
            Tried(
                "misconception", f"{misconception.id} ({number})", misconception.wrong, misconception=misconception.id
            )
            for number, misconception in enumerate(exercise.misconceptions, 1)
        ),
        *(
            Tried("equivalent" if what in alike else "mutant", what, mutant.function, mutant)
            for what, mutant in changed.items()
        ),
        *(
            Tried("equivalent" if what in _declared(exercise) else "shortcut", what, function)
            for what, function in shortcuts(exercise).items()
        ),
        *([Tried("right", "the notebook's solution", solution, notebook=True)] if solution else []),
        *(Tried("right", label, function) for label, function in right.items()),
        *(Tried("wrong", label, function) for label, function in wrong.items()),
        *(Tried("cheat", label, make) for label, make in cheats(exercise).items()),
    ]


def made_no_longer(exercise, tried):
    """What the specification declares as equivalent, and no mutant is."""
    made = {each.label for each in tried if each.kind == "equivalent"}
    return sorted(what for what in _declared(exercise) if not {what, f"{NOTEBOOK}{what}"} & made)


def _declared(exercise):
    return {what for changes in exercise.equivalent.values() for what in changes}


def notebook_solution(course, name):
    """The function `name` as the notebooks in source/ solve it, or None where no cell does."""
    for path in sorted(course.source.glob("*.ipynb")):
        cells = [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
        for cell in cells:
            if cell.metadata.get("nbgrader", {}).get("grade_id") == f"{name}-solution":
                return _function(name, cell.source, f"{path.name}, cell {name}-solution", _imports(cells))
    return None


def _function(name, source, file, namespace):
    linecache.cache[file] = len(source), None, source.splitlines(keepends=True), file  # for inspect and Mutant.source
    try:
        exec(compile(source, file, "exec"), namespace)
    except Exception as error:
        raise CourseError(f"{file} cannot be run: {told(error)}") from None
    if name not in namespace:
        raise CourseError(f"{file} does not define {name}.")
    return namespace[name]


def _imports(cells):
    """The names that a notebook's cells import."""
    namespace = {}
    for cell in cells:
        try:
            statements = ast.parse(cell.source).body
        except SyntaxError:  # a line of IPython's own, such as %matplotlib
            continue
        found = [each for each in statements if isinstance(each, (ast.Import, ast.ImportFrom))]
        exec(compile(ast.Module(found, []), "<imports>", "exec"), namespace)
    return namespace


def own_solutions(course, name):
    """{label: function} of the right solutions in tests/solutions/, and of the wrong ones.

    Every module there is read; it may use the decorators `@right("chain")` of right.py and
    `@wrong("chain", "order-reversed")` of wrong.py, the latter with the misconceptions that a good teacher would name.
    """
    folder = course.root / "tests" / "solutions"
    if not folder.is_dir():
        return {}, {}
    if str(folder.parent) not in sys.path:
        sys.path.insert(0, str(folder.parent))
    for module in ("right", "wrong", *sorted(each.name for each in pkgutil.iter_modules([str(folder)]))):
        try:
            importlib.import_module(f"solutions.{module}")
        except Exception as error:
            raise CourseError(f"tests/solutions/{module}.py cannot be read: {told(error)}") from None
    registered, declared = sys.modules["solutions.right"], sys.modules["solutions.wrong"]
    right = {label: function for (of, function), label in zip(registered.RIGHT, registered.NAMES) if of == name}
    return right, {function.__name__: function for of, _, function in declared.WRONG if of == name}
