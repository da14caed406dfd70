"""The structure of the code: rooms in an order, no circle, and a place for everything at the top level."""

import ast
import graphlib
import re
import subprocess

import pytest
from support import ROOT

# The rooms of each package, lowest first: a room may use itself and those before it. Those in one line do not use each other.
ROOMS = {
    "transform_lab": [
        "rostime libraries arithmetic",
        "messages validation jupyter",
        "tft lab_markers visualization_msgs",
        "viewing",
        "judging rospy animations plots conversions predictions",
        "cells",
        "outdated",
        "check mistakes",
        "summary",
    ],
    "autograder": [
        "exercises environment files names untrusted",
        "released set_up",
        "course sandbox",
        "proving intake",
        "grading",
        "bridge",
        "pages collecting hub",
        "handout demo doctor",
        "commands",
        "command_line",
        "__main__",
    ],
}
FOLDERS = {"transform_lab": ROOT / "source" / "transforms", "autograder": ROOT}
INSIDE = {
    "channel",
    "executor",
    "forkserver",
    "outputs",
    "seccomp",
    "shell",
}  # run in a notebook's process, where the grader is not
TOP_LEVEL = {
    "README.md",
    "CONTRIBUTING.md",
    "LICENSE",
    "environment.txt",
    "environment.lock",
    "nbgrader_config.py",
    "pyproject.toml",
    "source",
    "notebooks",
    "autograder",
    "tests",
    "findings",
}


PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "autograder" / "docs").glob("*.md"))]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_to_what_is_there(page):
    links = re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8"))
    for path, _, section in (link.partition("#") for link in links if "://" not in link):
        target = (page.parent / path).resolve() if path else page
        assert target.exists(), path
        titles = re.findall(r"(?m)^#+ (.*)$", target.read_text(encoding="utf-8")) if section else []
        assert not section or section in [re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles]


def test_every_page_is_reached_from_the_readme():
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    assert [page.name for page in PAGES[1:] if f"({page.relative_to(ROOT).as_posix()}" not in text] == []


def modules(package):
    """{dotted name: path} of a package's modules."""
    found = {}
    for path in sorted((FOLDERS[package] / package).rglob("*.py")):
        if "students" not in path.parts:  # the demo's, which are data
            parts = path.relative_to(FOLDERS[package]).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def imported(name, path, known):
    """The modules among `known` that a module imports, at its top or later."""
    found = set()
    within = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = within[: len(within) - node.level + 1] if node.level else []
            start = ".".join([*above, *([node.module] if node.module else [])])
            # what is imported from a package is one of its modules, or stands in its __init__
            found.update(f"{start}.{alias.name}" if f"{start}.{alias.name}" in known else start for alias in node.names)
    return {module for module in found if module in known and module != name}


def imports():
    """{module: modules it imports} of both packages."""
    known = {name: path for package in ROOMS for name, path in modules(package).items()}
    return {name: imported(name, path, known) for name, path in known.items()}


def room(module):
    """(package, room) of a module; the package's own __init__ is above all its rooms."""
    package, _, rest = module.partition(".")
    return package, rest.partition(".")[0]


def test_there_is_no_circle_of_modules():
    try:
        graphlib.TopologicalSorter(imports()).prepare()
    except graphlib.CycleError as error:
        pytest.fail(f"these import each other: {' -> '.join(error.args[1])}")


@pytest.mark.parametrize("package", ROOMS)
def test_every_module_lies_in_a_room(package):
    known = {name for line in ROOMS[package] for name in line.split()}
    assert {room(module)[1] for module in modules(package)} - {""} == known


def test_lower_rooms_import_no_upper_one():
    floors = {
        (package, name): floor
        for package, lines in ROOMS.items()
        for floor, line in enumerate(lines)
        for name in line.split()
    }
    upward = [
        f"{module} imports {other}"
        for module, others in imports().items()
        for other in others
        if room(module)[0] == room(other)[0] and room(module) != room(other) and room(module)[1] and room(other)[1]
        if floors[room(other)] >= floors[room(module)]
    ]
    assert not upward, "\n".join(upward)


def test_the_students_package_knows_nothing_of_the_grader():
    assert not [
        (module, other)
        for module, others in imports().items()
        for other in others
        if module.startswith("transform_lab") and other.startswith("autograder")
    ]


def test_nothing_of_the_grader_is_imported_inside_a_sandbox():
    """There, these files lie beside each other and the students' package, and nothing else of ours does."""
    for name in INSIDE:
        tree = ast.parse((ROOT / "autograder" / "sandbox" / f"{name}.py").read_text(encoding="utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom):
                assert node.level == 0 and not node.module.startswith("autograder"), f"{name}: {node.module}"


def test_the_top_level_is_that_of_the_readme():
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True).stdout.splitlines()
    if not tracked:
        pytest.skip("needs a git checkout, to know which files belong to the project")
    entries = {line.partition("/")[0] for line in tracked}
    assert {entry for entry in entries if not entry.startswith(".")} <= TOP_LEVEL
