"""What decides a grade, and what makes a page, each in one number.

- Of grades: the released notebooks, the limits, and the modules on the way from a file to its verdict: all that those
  of FILE_TO_VERDICT import, one from the other, but for SHOWS, which words and draws; and what else of the students'
  package a function may compute with, which is all that imports none of SHOWS.
- Of pages: the templates, and all that the modules of PAGES import, one from the other.

Of a module its syntax counts: no comment, layout or docstring. What the exercises' misconceptions say and their hints
count for pages alone, which have them as they are now (see records.py), and so do mutants declared as equivalent. Of a
package that is imported the version counts that environment.txt pins: what a student's function answers is NumPy's
doing, too.
"""

import ast
import contextlib
import hashlib
import itertools
import json
import sys
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import NamedTuple

from ..environment import pins
from ..files import replace
from ..sandbox.bubblewrap import CODE

AUTOGRADER = Path(__file__).parent.parent
EXERCISES, PACKAGE = "autograder.exercises.", "transform_lab."
SPECIFIED = tuple(EXERCISES + path.stem for path in (AUTOGRADER / "exercises").glob("*.py"))  # imported by their names
FILE_TO_VERDICT = (
    "autograder.intake.submission",
    "autograder.released",
    "autograder.grading.grade",
    *SPECIFIED,
    *(f"autograder.sandbox.{Path(file).stem}" for file in CODE),  # run as files
)
PAGES = ("autograder.pages.feedback", "autograder.pages.exporter", "autograder.pages.markdown", *SPECIFIED)
GATHERS = PACKAGE + "__init__"  # imported along with each module of the package, and imports them all
EQUIVALENT = "equivalent"  # the exercises' module, and field, of what only `prove` asks for
SHOWS = tuple(PACKAGE + part for part in ("viewing.", "judging.panel", "judging.lines", "judging.comparison"))
REMEMBERED = Path(__file__).parent / "__pycache__" / "digests.json"


def of_grades(course, limits):
    """The digest of all that decides a grade."""
    released = {name: notebook.digest for name, notebook in course.notebooks.items()}
    return _digest(_of_code(course.package)[0], released, asdict(limits))


@cache
def of_pages(course):
    """The digest of all that makes a page; asked once in a process, which does not load its code again either."""
    return _of_code(course.package)[1]


def _of_code(package):
    """[digest of the code that decides grades, digest of the code and templates that make pages]

    Reading the syntax of a hundred modules takes half a second.
    """
    return remembered(REMEMBERED, package, work_out)


def remembered(file, package, work_out):
    """What `work_out` makes of the Files (plain data): what it made of the very same ones before, if `file` has that."""
    files = files_of(package)
    told = _told(files)
    with contextlib.suppress(OSError, ValueError):
        known, found = json.loads(file.read_text(encoding="utf-8"))
        if known == told:
            return found
    found = work_out(files)
    if _told(files_of(package)) == told:  # nobody has changed one meanwhile
        with contextlib.suppress(OSError):  # where nothing can be written, it is worked out each time
            file.parent.mkdir(exist_ok=True)
            replace(file, json.dumps([told, found]))
    return found


def _told(files):
    return _digest({name: _sha(source) for name, source in files.modules.items()}, files.templates, files.versions)


class Files(NamedTuple):
    """modules: {dotted name: source}, where the name of a package's own file ends in `.__init__`

    templates: {name: digest}; versions: {package: version}
    """

    modules: dict
    templates: dict
    versions: dict


def files_of(package):
    """The Files of the grader and of the students' package."""
    return Files(
        {
            ".".join((top, *path.relative_to(folder).with_suffix("").parts)): path.read_bytes()
            for top, folder in (("autograder", AUTOGRADER), ("transform_lab", package))
            for path in folder.rglob("*.py")
        },
        {path.name: _sha(path.read_bytes()) for path in (AUTOGRADER / "pages" / "templates").glob("[!.]*")},
        {
            "python": list(sys.version_info[:2]),
            **dict(pins((AUTOGRADER.parent / "environment.txt").read_text(encoding="utf-8"))),
        },
    )


def work_out(files):
    """What `_of_code` gives, of these Files."""
    decide, make = deciding(files.modules), reached(files.modules, PAGES)
    return [
        _digest(_syntax(files.modules, decide, _words()), _imported_versions(files, decide)),
        _digest(_syntax(files.modules, make), _imported_versions(files, make), files.templates),
    ]


def deciding(modules):
    """The names of the modules that decide a grade."""
    package = {name for name in reached(modules, [GATHERS]) if name.startswith(PACKAGE)}
    shows = {name for name in package if any(map(_shows, reached(modules, [name], without=(GATHERS,))))}
    return reached(modules, FILE_TO_VERDICT, without=(GATHERS, EXERCISES + EQUIVALENT, *SHOWS)) | (package - shows)


def _shows(name):
    return name.startswith(SHOWS)


def reached(modules, start, without=()):
    """The modules of `start`, those that they import (one from the other, at their top or later), and the packages of all.

    without: beginnings of names; these modules are left out, with what they alone import
    """
    found, waiting = set(), list(start)
    while waiting:
        name = waiting.pop()
        if name in found or name.startswith((__name__, *without)):  # this one decides nothing that it counts
            continue
        found.add(name)
        for mentioned in _read(name, modules[name])[1]:
            for step in itertools.accumulate(mentioned.split("."), "{}.{}".format):
                waiting += {step, f"{step}.__init__"} & modules.keys()
    return found


def _imported_versions(files, names):
    imported = {
        mentioned.partition(".")[0].lower() for name in names for mentioned in _read(name, files.modules[name])[1]
    }
    return {package: version for package, version in files.versions.items() if package.lower() in {*imported, "python"}}


def _syntax(modules, names, words=frozenset()):
    """{name: digest of the module's syntax}; with `words`, of exercises only what decides."""
    return {
        name: _decisive(modules[name], words) if words and name.startswith(EXERCISES) else _read(name, modules[name])[0]
        for name in names
    }


@cache
def _read(name, source):
    """(digest of a module's syntax, the dotted names that it imports: of modules, and of what is taken from these)"""
    tree, mentioned = _parsed(source), set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            mentioned.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            start = [*(name.split(".")[: -node.level] if node.level else ()), *([node.module] if node.module else ())]
            mentioned.update(".".join([*start, alias.name]) for alias in node.names)
    return _digest(ast.dump(tree)), mentioned


@cache
def _decisive(source, words):
    """The digest of an exercises' module without the texts that consist of `words`, and without equivalent mutants."""
    tree = _parsed(source)
    tree.body = [line for line in tree.body if not (isinstance(line, ast.ImportFrom) and line.module == EQUIVALENT)]
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            node.keywords = [keyword for keyword in node.keywords if keyword.arg != EQUIVALENT]
        if _is_text(node) and words.issuperset(node.value.split("\n")):
            node.value = ""
    return _digest(ast.dump(tree))


def _parsed(source):
    """The syntax of a module without its docstrings."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(getattr(node, "body", None), list):
            node.body = [line for line in node.body if not (isinstance(line, ast.Expr) and _is_text(line.value))]
    return tree


def _is_text(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _words():
    """Every line that a misconception says or gives as a hint."""
    from ..exercises import EXERCISES

    texts = (text for exercise in EXERCISES.values() for m in exercise.misconceptions for text in (m.says, m.hint))
    return frozenset(line for text in texts for line in text.split("\n"))


def _digest(*parts):
    return _sha(json.dumps(parts, sort_keys=True).encode())


def _sha(content):
    return hashlib.sha256(content).hexdigest()
