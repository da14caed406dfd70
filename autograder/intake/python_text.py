"""What a cell's text says as Python: what it defines, which exercises it checks, what it imports. Nothing of it is run."""

import ast
import re
import textwrap
import warnings
from collections.abc import Iterator
from functools import lru_cache

RUNS_ITS_BODY = (
    r"(?:\s*#.*\n)*\s*%%(time|timeit|capture|prun)\b.*\n"  # cell magics of IPython's under which Python stands
)
# Lines of IPython's own: magics, commands, questions; and what they give a name to.
OWN_LINE = re.compile(r"^([ \t]*)(?:[%!?].*|[\w.]+\?{1,2}[ \t]*)$", re.MULTILINE)
OWN_VALUE = re.compile(r"^([ \t]*[\w, ]+=)[ \t]*[%!].*$", re.MULTILINE)
FENCED = re.compile(
    r"^[ \t]*(```+|~~~+)[ \t]*\{?(?:i?python3?|py)?\}?[ \t]*\n(.*?)^[ \t]*\1[ \t]*$", re.MULTILINE | re.DOTALL
)
UNSEEN = re.compile(r"^\s*from\s+\S+\s+import\s+\*|^\s*%(?:run|load)\b|\bexec\(|\bglobals\(", re.MULTILINE)
MAKES_FUNCTIONS = {"partial", "wraps", "lru_cache", "cache", "vectorize", "reduce", "compose", "njit", "jit", "getattr"}
REMEMBERED = 4_000  # texts: those of the course's own cells come back in every student's notebook


def parsed(source: str) -> ast.Module | None:
    """The syntax tree of a cell, or None where it is no Python; lines of IPython's own count as `pass`."""
    text = source
    if "%%" in text and (found := re.match(RUNS_ITS_BODY, text)):
        text = "\n" * found[0].count("\n") + text[found.end() :]
    text = OWN_VALUE.sub(r"\1 None", OWN_LINE.sub(r"\1pass", text))
    return tree_of(text) or tree_of(textwrap.dedent(text))  # IPython runs a cell that is indented as a whole


def tree_of(text: str) -> ast.Module | None:
    """The syntax tree of a text as it stands, or None where it is no Python."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of escapes such as "\d"
            return ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None


@lru_cache(REMEMBERED)
def binds(source: str) -> frozenset[str]:
    """The names that a cell gives a meaning at its top level: functions, classes, imports, variables."""
    tree = parsed(source)
    if tree is None:  # with a slip in it: what can be seen without parsing
        kinds = r"^\s*(?:async\s+)?(?:def|class)\s+(\w+)", r"^(\w+)\s*=[^=]", r"^(?:import|from)\s.*?(\w+)\s*$"
        return frozenset(name for kind in kinds for name in re.findall(kind, source, re.MULTILINE))
    found: set[str] = set()
    for node in _at_top_level(tree):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            found.add(node.name)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            found |= {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            found.add(node.id)
    return frozenset(found)


@lru_cache(REMEMBERED)
def defines(source: str) -> tuple[str, ...]:
    """The functions that a cell defines by `def` at its top level, also within `if`, `try` and the like, in order."""
    tree = parsed(source)
    if tree is None:
        return tuple(re.findall(r"^\s*(?:async\s+)?def\s+(\w+)", source, re.MULTILINE))
    kinds = ast.FunctionDef, ast.AsyncFunctionDef
    found = [node for node in _at_top_level(tree) if isinstance(node, kinds)]
    return tuple(node.name for node in sorted(found, key=lambda node: node.lineno))


@lru_cache(REMEMBERED)
def takes(source: str) -> frozenset[str]:
    """The names that a cell gives to functions from elsewhere: by import, `lambda`, another name, `partial(…)`."""
    tree = parsed(source)
    found: set[str] = set()
    for node in _at_top_level(tree) if tree else ():
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            found |= {alias.asname or alias.name for alias in node.names}
        elif isinstance(node, ast.Assign) and _is_function(node.value):
            names = {target.id for target in node.targets if isinstance(target, ast.Name)}
            found |= names - {used.id for used in ast.walk(node.value) if isinstance(used, ast.Name)}
    return frozenset(found)


def _is_function(node):
    if isinstance(node, ast.Call):
        called = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
        return called in MAKES_FUNCTIONS
    return isinstance(node, (ast.Lambda, ast.Name, ast.Attribute))


def _at_top_level(tree) -> Iterator[ast.AST]:
    """The nodes of a tree that are not inside a function, a class or a comprehension, with those themselves."""
    waiting: list[ast.AST] = list(tree.body)
    blocks = ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Lambda
    comprehensions = ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp
    while waiting:
        node = waiting.pop()
        yield node
        if not isinstance(node, blocks + comprehensions):
            waiting += ast.iter_child_nodes(node)


def may_define_unseen(source: str) -> bool:
    """Whether a cell may define what its text does not name: `from mine import *`, `%run`, `exec`."""
    return UNSEEN.search(source) is not None


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


def uses(source: str) -> set[str]:
    """The names that a cell mentions."""
    tree = parsed(source)
    return {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)} if tree else set()


@lru_cache(REMEMBERED)
def code_of(source: str) -> str | None:
    """A cell's code without comments and layout, to compare it by; None where it is no Python."""
    tree = parsed(source)
    return ast.dump(tree) if tree else None


def code_in(text: str) -> str | None:
    """The Python of a text cell, or of the fenced blocks in it, whose other lines become comments; None without any."""
    if parsed(text) is not None:
        return text
    pieces, end = [], 0
    for block in FENCED.finditer(text):
        pieces += [_as_comment(text[end : block.start()]), block[2].rstrip()]
        end = block.end()
    code = "\n".join(filter(None, [*pieces, _as_comment(text[end:])]))
    return code if pieces and parsed(code) is not None else None


def _as_comment(text):
    return "\n".join(f"# {line}".rstrip() for line in text.strip().splitlines())


def continues(first: str, second: str) -> bool:
    """Whether two cells are the halves of one that was split in the middle of a statement."""
    first, second = OWN_LINE.sub(r"\1pass", first), OWN_LINE.sub(r"\1pass", second)
    begins_within = re.match(r"(?:[ \t]*(?:#.*)?\n)*(?:[ \t]+\S|[)\]}])", second)
    return bool(begins_within or tree_of(first) is None) and tree_of(f"{first}\n{second}") is not None


def imports(source: str) -> str:
    """The import statements at the top level of a cell."""
    tree = parsed(source)
    lines = [node for node in tree.body if isinstance(node, (ast.Import, ast.ImportFrom))] if tree else []
    return "\n".join(map(ast.unparse, lines))
