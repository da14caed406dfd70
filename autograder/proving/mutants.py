"""Every syntactic mutant of a function: one operator, constant, index, sign, field, argument or statement changed.

Mutation testing asks of a set of cases what Clegg, McMinn and Fraser (ICSE SEET 2021) ask of a grading test suite: is
there a wrong program that it takes for right?
"""

import ast
import inspect
import linecache
import textwrap
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

AXES = {"x": "y", "y": "z", "z": "x", "w": "x"}
SWAPPED = {
    ast.Add: [ast.Sub], ast.Sub: [ast.Add], ast.Mult: [ast.Div, ast.Add], ast.Div: [ast.Mult], ast.MatMult: [ast.Mult],
    ast.Lt: [ast.LtE, ast.Gt], ast.LtE: [ast.Lt, ast.GtE], ast.Gt: [ast.GtE, ast.Lt], ast.GtE: [ast.Gt, ast.LtE],
    ast.Eq: [ast.NotEq], ast.NotEq: [ast.Eq], ast.And: [ast.Or], ast.Or: [ast.And],
}  # fmt: skip


@dataclass(frozen=True)
class Mutant:
    """A function with one thing changed: what was changed, and the line of the source that it was changed in."""

    what: str  # "transform_point: a_T_b @ p -> p @ a_T_b"; the same change in a second place is told by " [2]"
    function: Callable
    file: str
    line: int
    source: str


def mutants(function, package=None):
    """The Mutants of a function.

    Functions of `package` (the beginning of a module's name) that it calls are part of it, and mutated like it.
    """
    found, times = [], Counter()
    for what, mutant, code, line in _mutants(function, package):
        times[what] += 1
        text = linecache.getline(code.co_filename, line).strip()
        told = what if times[what] == 1 else f"{what} [{times[what]}]"
        found.append(Mutant(told, mutant, code.co_filename, line, text))
    return found


def _mutants(function, package):
    """(what was changed, the changed function, the code it stands in, the line) for each of them."""
    functions = _with_those_it_calls(function, package)
    body = [ast.parse(textwrap.dedent(inspect.getsource(each))).body[0] for each in functions]
    namespace = {name: value for each in reversed(functions) for name, value in each.__globals__.items()}
    tree = ast.Module(body=body, type_ignores=[])
    for definition, code in zip(body, (each.__code__ for each in functions)):
        if ast.get_docstring(definition) is not None:
            del definition.body[0]
        for holder, index, node in _places(definition):
            for changed in _variants(node):
                before, after = ast.unparse(node), ast.unparse(ast.fix_missing_locations(changed))
                if before == after:
                    continue
                holder[index] = changed
                try:
                    made = _made(tree, namespace, function.__name__)
                finally:
                    holder[index] = node
                yield f"{definition.name}: {before} -> {after}", made, code, code.co_firstlineno + node.lineno - 1
        for statements in _blocks(definition):
            for index in range(len(statements)) if len(statements) > 1 else ():
                dropped = statements.pop(index)
                try:
                    made = _made(tree, namespace, function.__name__)
                finally:
                    statements.insert(index, dropped)
                what = f"{definition.name}: without {ast.unparse(dropped)}"
                yield what, made, code, code.co_firstlineno + dropped.lineno - 1


def _with_those_it_calls(function, package):
    found, waiting = [], [function]
    while waiting:
        each = waiting.pop()
        if each in found:
            continue
        found.append(each)
        for name in each.__code__.co_names if package else ():
            called = each.__globals__.get(name)
            if inspect.isfunction(called) and called.__module__.startswith(package):
                waiting.append(called)
    return found


def _made(tree, namespace, name):
    """The function `name` of the changed source."""
    made = dict(namespace)
    exec(compile(ast.fix_missing_locations(tree), "<mutant>", "exec"), made)
    return made[name]


class _Field(list):
    """One field of a node, written to like a list."""

    def __init__(self, node, name):
        self.node, self.name = node, name

    def __setitem__(self, index, value):
        setattr(self.node, self.name, value)


def _places(tree):
    """(holder, index, node) for every expression below `tree`, with what holds it."""
    for parent in list(ast.walk(tree)):
        for name, value in list(ast.iter_fields(parent)):
            if isinstance(value, ast.expr):
                yield _Field(parent, name), 0, value
            elif isinstance(value, list):
                for index, item in enumerate(value):
                    if isinstance(item, ast.expr):
                        yield value, index, item


def _blocks(tree):
    for parent in ast.walk(tree):
        for name in ("body", "orelse"):
            statements = getattr(parent, name, None)
            if isinstance(statements, list) and statements and isinstance(statements[0], ast.stmt):
                yield statements


def _variants(node):
    """Nodes that may stand in the place of this one."""
    kind = type(node)
    if kind is ast.BinOp:
        yield from (ast.BinOp(node.left, other(), node.right) for other in SWAPPED.get(type(node.op), []))
        if not isinstance(node.op, (ast.Add, ast.Mult)):
            yield ast.BinOp(node.right, node.op, node.left)
        yield from (node.left, node.right)
        yield ast.BinOp(node.left, node.op, ast.UnaryOp(ast.USub(), node.right))
    elif kind is ast.UnaryOp:
        yield node.operand
    elif kind is ast.BoolOp:
        yield from (ast.BoolOp(other(), node.values) for other in SWAPPED[type(node.op)])
        others = ([v for v in node.values if v is not value] for value in node.values)
        yield from (rest[0] if len(rest) == 1 else ast.BoolOp(node.op, rest) for rest in others)
    elif kind is ast.Compare:
        for other in SWAPPED.get(type(node.ops[0]), []):
            yield ast.Compare(node.left, [other(), *node.ops[1:]], node.comparators)
    elif kind is ast.Constant:
        yield from (ast.Constant(value) for value in _other_constants(node.value))
    elif kind is ast.Attribute and isinstance(node.ctx, ast.Load):
        if node.attr == "T":
            yield node.value
        if node.attr in AXES:
            yield ast.Attribute(node.value, AXES[node.attr], node.ctx)
    elif kind is ast.Subscript and isinstance(node.ctx, ast.Load):
        yield node.value
    elif kind in (ast.List, ast.Tuple) and isinstance(node.ctx, ast.Load):
        for index in range(len(node.elts) - 1):
            swapped = list(node.elts)
            swapped[index : index + 2] = reversed(swapped[index : index + 2])
            yield kind(swapped, node.ctx)
    elif kind is ast.Call:
        yield from _other_calls(node)
    elif kind is ast.Name and isinstance(node.ctx, ast.Load):
        yield ast.UnaryOp(ast.USub(), node)


def _other_constants(value):
    if isinstance(value, bool):
        yield not value
    elif isinstance(value, (int, float)):
        yield from dict.fromkeys((value + 1, value - 1, -value, 0 * value) if value else (1, -1))
    elif isinstance(value, str):
        yield from (other for other in "xyz" if value in ("x", "y", "z") and other != value)


def _other_calls(node):
    for index in range(len(node.args) - 1):
        swapped = list(node.args)
        swapped[index : index + 2] = reversed(swapped[index : index + 2])
        yield ast.Call(node.func, swapped, node.keywords)
    if len(node.args) == 1 and not isinstance(node.args[0], ast.Starred):
        yield node.args[0]
    for index in range(len(node.keywords)):
        yield ast.Call(node.func, node.args, node.keywords[:index] + node.keywords[index + 1 :])
