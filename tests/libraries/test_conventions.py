"""What conventions.md says of libraries is what these libraries do, in the versions that it names."""

import json
import re
import subprocess

import numpy as np
import pytest
from libraries import measure
from support import ROOT

PAGE = (ROOT / "source/transforms/conventions.md").read_text(encoding="utf-8")
PINS = (ROOT / "environment.txt", ROOT / "tests/libraries/requirements.txt")
ELSEWHERE = ["ROS 1"]  # not of the Python Package Index
PACKAGES = {
    "spatialmath": "spatialmath-python",
    "Pinocchio": "pin",
}  # where a library's package is called something else


def table(first_column, *, beginning):
    """The rows of a table of the page, as dictionaries by the words above them, {first word of the row: row}."""
    lines = PAGE[PAGE.index(beginning) :].splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(f"| {first_column} |"))
    heads, _, *rows = [
        [cell.strip().strip("`") for cell in line.strip("|").split(" | ")]
        for line in lines[start : lines.index("", start)]
    ]
    return {row[0]: dict(zip(heads, row, strict=True)) for row in rows}


MEASURED = {
    re.sub(r" [\d.]+$", "", name): row for name, row in table("library", beginning="Fourteen libraries").items()
}
CODE = {
    name: [row["a_T_c"], row["ROS's roll, pitch, yaw"]]
    for name, row in table("library", beginning="The same product").items()
}


def test_both_tables_are_of_the_same_libraries():
    assert list(MEASURED) == list(CODE) == list(measure.LIBRARIES)


@pytest.mark.parametrize("name", [name for name in MEASURED if name not in ELSEWHERE])
def test_versions_are_those_that_are_measured(name):
    package, version = PACKAGES.get(name, name).lower(), MEASURED[name]["library"].rpartition(" ")[2]
    assert any(f"\n{package}=={version}" in path.read_text().lower() for path in PINS)


@pytest.fixture(scope="module")
def found(libraries):
    return libraries.ask("measure.py", CODE, *(name for name in CODE if name not in ELSEWHERE))


def compare(name, found):
    row = MEASURED[name]
    assert {head: found[head] for head in row if head != "library"} == {
        head: row[head] for head in row if head != "library"
    }
    assert found["version"] == row["library"].rpartition(" ")[2]
    c, s = (function([measure.ROLL, measure.PITCH, measure.YAW]) for function in (np.cos, np.sin))
    Rx = np.array([[1, 0, 0], [0, c[0], -s[0]], [0, s[0], c[0]]])
    Ry = np.array([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]])
    Rz = np.array([[c[2], -s[2], 0], [s[2], c[2], 0], [0, 0, 1]])
    product, turns = found["expressions"]
    np.testing.assert_allclose(product, (measure.A_T_B @ measure.B_T_C)[:3, :3], atol=1e-12)
    np.testing.assert_allclose(turns, Rz @ Ry @ Rx, atol=1e-12)


@pytest.mark.parametrize("name", [name for name in measure.LIBRARIES if name not in ELSEWHERE])
def test_a_library_does_what_the_page_says(found, name):
    compare(name, found[name])


def test_ros_does_what_the_page_says(ros):
    ran = ros.run(ROOT / "tests/libraries/measure.py", *ELSEWHERE, input=json.dumps(CODE))
    assert ran.returncode == 0, ran.stderr
    found = json.loads(ran.stdout)["ROS 1"]
    packaged = subprocess.run(
        ["dpkg-query", "-W", "-f", "${Version}", "python3-tf"], capture_output=True, text=True
    ).stdout
    compare("ROS 1", found | {"version": packaged.rpartition("-")[0]})
