"""What holds of the tests themselves: rooms have quick ones, fixtures bring tools, none reads a clock, benchmarks run."""

import ast
import shutil
import subprocess
import sys

import pytest
from support import ROOT, TOOLS, lacking, run

FILES = sorted((ROOT / "tests").rglob("test_*.py"))
BENCHMARKS = sorted((ROOT / "tests").glob("benchmark_*.py"))
CLOCKS = {"datetime.now", "datetime.utcnow", "os.times", "psutil.cpu_times", "resource.getrusage"}


def chosen(*arguments):
    """The files of the tests that `test` would run."""
    code, said = run(ROOT, "test", "--collect-only", "-q", "-q", *arguments)
    assert code == 0, said
    return {ROOT / line.partition(": ")[0] for line in said.splitlines() if line.startswith("tests/")}


def test_every_room_has_quick_tests(slow):
    assert {path.parent for path in chosen()} == {path.parent for path in FILES}


def test_what_is_named_is_chosen_from_all_tests(slow):
    attacks = ROOT / "tests/sandbox/test_account.py"
    assert attacks not in chosen()
    assert chosen(str(attacks)) == chosen("-k", "test_account") == {attacks}
    slow_one = f"{ROOT}/tests/test_tiers.py::test_every_room_has_quick_tests"
    code, said = run(ROOT, "test", "--numprocesses", "1", slow_one)
    assert code == 0 and "1 passed" in said


def test_a_quick_test_finds_no_tool():
    assert not [tool for tools in TOOLS.values() for tool in tools if shutil.which(tool)]


def test_a_fixture_brings_its_own_tool(sandboxed):
    assert shutil.which("bwrap") and not [tool for tool in TOOLS["browser"] if shutil.which(tool)]


@pytest.mark.parametrize("ci, outcome", [("true", pytest.fail.Exception), ("", pytest.skip.Exception)])
def test_what_is_skipped_elsewhere_fails_in_ci(monkeypatch, ci, outcome):
    monkeypatch.setenv("CI", ci)
    with pytest.raises(outcome, match="needs a tool"):
        lacking("needs a tool")


def test_no_test_reads_a_clock():
    """So that none says how many seconds something takes, which is not true of another machine, nor of a busy one."""
    found = []
    for path in (ROOT / "tests").rglob("*.py"):
        if path in BENCHMARKS or path.parent.name in ("solutions", "lab"):
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            words = ast.unparse(node) if isinstance(node, ast.Attribute | ast.Import | ast.ImportFrom) else ""
            clock = words in CLOCKS or words.startswith("time.") and words != "time.sleep"
            if clock or words.startswith(("from time ", "import timeit", "from timeit ")):
                found.append(f"{path.name}, line {node.lineno}: {words}")
    assert not found, "count calls, bytes or cells; wait by support.wait_for"


@pytest.mark.parametrize("path", BENCHMARKS, ids=[path.stem for path in BENCHMARKS])
def test_a_benchmark_runs(path, slow, sandboxed, chromium):
    result = subprocess.run([sys.executable, path, "--smallest"], cwd=ROOT, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
