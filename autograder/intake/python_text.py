"""What a cell's text says as Python: which names it binds, which exercises it checks, what it imports. Nothing of it is run."""

import ast
import re
import textwrap
import warnings
from functools import lru_cache

RUNS_ITS_BODY = r"\s*%%(time|timeit|capture|prun)\b.*\n"  # cell magics of IPython's under which Python stands
# Lines of IPython's own: magics, commands, questions; and what they give a name to.
OWN_LINE = re.compile(r"^([ \t]*)(?:[%!?].*|[\w.]+\?{1,2}[ \t]*)$", re.MULTILINE)
OWN_VALUE = re.compile(r"^([ \t]*[\w, ]+=)[ \t]*[%!].*$", re.MULTILINE)


REMEMBERED = 4_000  # texts: those of the course's own cells come back in every student's notebook


def parsed(source: str) -> ast.Module | None:
    """The syntax tree of a cell, or None where it is no Python; lines of IPython's own count as `pass`."""
    text = re.sub(RUNS_ITS_BODY, "\n", source, count=1) if source.lstrip().startswith("%%") else source
    text = OWN_VALUE.sub(r"\1 None", OWN_LINE.sub(r"\1pass", text))
    for candidate in (text, textwrap.dedent(text)):  # IPython runs a cell that is indented as a whole
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of escapes such as "\d"
                return ast.parse(candidate)
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            continue
    return None


@lru_cache(REMEMBERED)
def binds(source: str) -> frozenset[str]:
    """The names that a cell gives a meaning at its top level: functions, classes, imports, variables."""
    tree = parsed(source)
    if tree is None:  # with a slip in it: what can be seen without parsing
        kinds = r"^(?:async\s+)?(?:def|class)\s+(\w+)", r"^(\w+)\s*=[^=]", r"^(?:import|from)\s.*?(\w+)\s*$"
        return frozenset(name for kind in kinds for name in re.findall(kind, source, re.MULTILINE))
    found: set[str] = set()
    waiting: list[ast.AST] = list(tree.body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            found.add(node.name)
            continue
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            found |= {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.add(node.id)
        if not isinstance(node, (ast.Lambda, ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)):
            waiting += ast.iter_child_nodes(node)
    return frozenset(found)


def defines(source: str) -> list[str]:
    """The functions that a cell defines at its top level, in order."""
    tree = parsed(source)
    return [node.name for node in tree.body if isinstance(node, ast.FunctionDef)] if tree else []


@lru_cache(REMEMBERED)
def checks(source: str) -> tuple[tuple[str, ...], bool]:
    """((the names that a cell calls `check` with), whether it does nothing else than one such call)."""
    tree = parsed(source) if "check" in source else None
    if tree is None:
        return (), False
    names = tuple(name for name in map(_checked, ast.walk(tree)) if name)
    alone = len(names) == len(tree.body) == 1 and isinstance(tree.body[0], ast.Expr) and _checked(tree.body[0].value)
    return names, bool(alone)


def _checked(node):
    if isinstance(node, ast.Call) and getattr(node.func, "id", getattr(node.func, "attr", "")) == "check":
        first = [*node.args[:1], *(keyword.value for keyword in node.keywords if keyword.arg == "name")]
        if first and isinstance(first[0], ast.Constant) and isinstance(first[0].value, str):
            return first[0].value
    return None


def imports(source: str) -> str:
    """The import statements at the top level of a cell."""
    tree = parsed(source)
    lines = [node for node in tree.body if isinstance(node, (ast.Import, ast.ImportFrom))] if tree else []
    return "\n".join(map(ast.unparse, lines))
