"""A notebook shows in the sandbox what it shows in Jupyter: the same cells run in ipykernel through nbclient, and compared."""

import json
import os
import re
import shutil
from contextlib import suppress
from importlib.resources import files
from itertools import chain
from pathlib import Path
from queue import Empty

import nbformat
import pytest
from editing import solution
from jupyter_cells import HANDED_IN, NOTEBOOKS
from support import PATIENCE, ROOT

from autograder.course import Course
from autograder.grading.grade import grade_submission, grading_run
from autograder.intake.submission import Submission
from autograder.sandbox import Ended, ForkServer, Limits, Sandbox
from autograder.sandbox.host import SHELL

PACKAGE = ROOT / "source/transforms/transform_lab"
PATIENT = Limits(cell=PATIENCE, call=PATIENCE, notebook=PATIENCE, submission=PATIENCE, cpu=PATIENCE)
DIFFERS = "# %% differs: "
ENDLESS = ("infinite-loop", "timeout")  # in the names of nbgrader's notebooks


def cells_of(text):
    """[(source, why it differs or None)] of a notebook in the table."""
    found, why = [], None
    for part in re.split(r"^(# %%.*\n)", text.removeprefix("\n"), flags=re.MULTILINE):
        if part.startswith("# %%"):
            why = part.removeprefix(DIFFERS).strip() if part.startswith(DIFFERS) else None
        else:
            found.append((part.removesuffix("\n"), why))
    return found


@pytest.fixture(scope="module")
def in_jupyter(slow, tmp_path_factory):
    """in_jupyter(sources): [(outputs, number)] of these cells, which ipykernel runs and nbclient keeps, made comparable."""
    from nbclient import NotebookClient

    class Client(NotebookClient):
        """nbclient does not notice a reply that comes while it tells an ipywidgets.Output what it holds, until it looks again."""

        async def async_start_new_kernel_client(self):
            kernel = await super().async_start_new_kernel_client()
            channel, get_msg = kernel.shell_channel, kernel.shell_channel.get_msg

            async def look_every_second(timeout):
                for _ in range(int(timeout)):
                    with suppress(Empty):
                        return await get_msg(timeout=1)
                raise Empty

            channel.get_msg = look_every_second
            return kernel

    def run(sources):
        home, folder = tmp_path_factory.mktemp("home"), tmp_path_factory.mktemp("of") / "course/transforms"
        shutil.copytree(PACKAGE, folder / PACKAGE.name, ignore=shutil.ignore_patterns("key.json", "__pycache__"))
        for name, content in HANDED_IN.items():
            (folder / name).parent.mkdir(exist_ok=True)
            (folder / name).write_bytes(content)
        notebook = nbformat.v4.new_notebook(cells=list(map(nbformat.v4.new_code_cell, sources)))
        ours = ("PYTHON", "PYTEST", "CI", "COLUMNS")  # ipykernel leaves out what commands write, where it sees pytest's
        environment = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
        environment |= {"HOME": str(home), "TRANSFORM_LAB_GRADING": "1", "LANG": "C.UTF-8", "SHELL": SHELL}
        environment["PYTHONDONTWRITEBYTECODE"] = "1"
        client = Client(notebook, timeout=PATIENCE, allow_errors=True, resources={"metadata": {"path": str(folder)}})
        client.execute(env=environment)
        return [(comparable(cell.outputs, folder, home), cell.execution_count) for cell in notebook.cells]

    return run


@pytest.fixture
def in_sandbox(sandboxed):
    """The same of the sandbox."""

    def run(sources, expected=frozenset()):
        with Sandbox(PACKAGE, HANDED_IN, PATIENT) as box, box.notebook(cells=sources, expected=expected) as process:
            for source in sources:
                if source.strip():  # nbclient passes over the others, and so does the grader
                    try:
                        process.run_cell(source)
                    except Ended as ended:
                        pytest.fail(f"{ended}: {source}")
            runs = iter(process.runs)
            shown = [next(runs) if source.strip() else None for source in sources]
        return [
            (comparable(run.outputs, Path("/course/transforms"), Path("/tmp")), run.execution_count)
            if run
            else ([], None)
            for run in shown
        ]

    return run


FRAME = r"(?:Cell|File) |\w+(?:Error|Exception)\b"  # how a frame of a traceback begins, or what is below the last
# What must differ between two runs, whoever runs them, and what the two write in other words: (pattern, what stands for it)
NOISE = [
    (r"\x1b\[[\d;]*m", ""),  # the sandbox leaves out a traceback's colours,
    (rf"\n+(?={FRAME})", "\n"),  # and then IPython some empty lines
    (r"\b0x[\da-f]+|\b7[\da-f]{11}\b", "ADDRESS"),
    (r"\b[\da-f]{32}\b", "ID"),
    (r"(/tmp/ipykernel_\d+/)?\b\d+\.py\b", "CELL.py"),
    (r"\b(Thread|Task)-\d+", r"\1-N"),
    (r"\d[\d.e+]* ?(s|ms|μs|ns)\b", "TIME"),
    (r"\bFile ~/", "File /tmp/"),  # where the project lies in what is a notebook's home in the sandbox
    (r"(maximum recursion depth exceeded)[\w ]*", r"\1"),  # in whose hands it is then, hangs on where it began
    # what lies in the kernel's own code: its files are others
    (rf"(?m)^File \S*(?:/ipykernel/|/grader-\w+/).*\n(?:(?!{FRAME}).*\n?)*", ""),
    (r"\n+ +\[\.\.\. skipping similar frames: .*", ""),  # see `once`
]


def comparable(outputs, folder, home):
    """Outputs as JSON, without what must differ."""
    comparable, streams = [], {}
    for output in chain(outputs, [{}]):
        if output.get("output_type") == "stream":  # the two streams have an order of their own only if they are flushed
            streams[output["name"]] = streams.get(output["name"], "") + output["text"]
            continue
        comparable += [{"stream": name, "text": streams[name]} for name in sorted(streams)]
        streams = {}
        if output:
            output = json.loads(json.dumps(output))
            if "traceback" in output:
                output["traceback"] = "\n".join(output["traceback"])
            comparable.append(output)
    return [_quiet(output, folder, home) for output in comparable]


def _quiet(value, folder, home):
    if isinstance(value, dict):
        quiet = {key: _quiet(part, folder, home) for key, part in value.items()}
        return quiet | {"traceback": once(quiet["traceback"])} if "traceback" in quiet else quiet
    if isinstance(value, list):
        return [_quiet(part, folder, home) for part in value]
    if not isinstance(value, str):
        return value
    for path, name in (folder, "FOLDER"), (folder.parent, "COURSE"):
        value = value.replace(str(path), name)
    value = re.sub(rf"(?m)^{home}$", "HOME", value)
    for pattern, instead in NOISE:
        value = re.sub(pattern, instead, value)
    return value


def once(traceback):
    """The frames of a traceback, each once: of many that repeat each other the sandbox counts those that Jupyter lists."""
    return list(dict.fromkeys(re.split(rf"\n(?={FRAME})", traceback)))


def of_nbgrader():
    """All code cells of nbgrader's own test notebooks which come to an end."""
    sources = {}
    for path in sorted(Path(str(files("nbgrader"))).glob("tests/**/*.ipynb")):
        if not path.stem.startswith(ENDLESS):
            for cell in json.loads(path.read_text(encoding="utf-8")).get("cells", []):
                if cell["cell_type"] == "code":
                    sources["".join(cell["source"])] = None
    return [(source, None) for source in sources]


@pytest.mark.parametrize("name", [*NOTEBOOKS, "nbgrader's"])
def test_cells_show_what_they_show_in_jupyter(in_jupyter, in_sandbox, name):
    """Those that are marked in the table differ: where one does no longer, the mark has to go."""
    cells = cells_of(NOTEBOOKS[name]) if name in NOTEBOOKS else of_nbgrader()
    sources = [source for source, _ in cells]
    wrong = []
    for (source, why), there, here in zip(cells, in_jupyter(sources), in_sandbox(sources), strict=True):
        if (there == here) is not (why is None):
            wrong.append({"cell": source, "differs": why, "in Jupyter": there, "in the sandbox": here})
    assert not wrong, json.dumps(wrong, indent=1)


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_expected_cells_show_the_same(in_sandbox, monkeypatch, name):
    """What was made of a cell before is what IPython makes of it when it is run."""
    sources = [source for source, _ in cells_of(NOTEBOOKS[name])]
    monkeypatch.setattr(ForkServer, "current", None)  # one that expects nothing
    as_they_come = in_sandbox(sources)
    server = ForkServer.current
    for _ in range(2):  # each of several graders says what it expects
        server.expected = frozenset()
        made = in_sandbox(sources, frozenset(sources))
    assert ForkServer.current is server and server.expected == frozenset(sources)
    for source, before, now in zip(sources, as_they_come, made, strict=True):
        assert now == before, source


def test_other_cells_are_run_as_they_are(in_sandbox, monkeypatch):
    """However often the same cells were expected before, none of them is run in the place of another cell."""
    monkeypatch.setattr(ForkServer, "current", None)
    expected = frozenset({"\n".join(f"a{n} = {n}" for n in range(300))})
    others = [f"n = {n}\nm = n + 1\nprint(n, m)" for n in range(100)]
    for _ in range(3):
        shown = in_sandbox(others, expected)
        assert [outputs for outputs, _ in shown] == [
            [{"stream": "stdout", "text": f"{n} {n + 1}\n"}] for n in range(100)
        ]
        ForkServer.current.expected = frozenset()


CHANGES = {
    "a transformer of lines": """
get_ipython().input_transformers_cleanup.append(lambda lines: [line.replace('1', '7') for line in lines])""",
    "a transformer of text": """
get_ipython().input_transformers_post.append(lambda lines: [line.replace('1', '7') for line in lines])""",
    "a transformer of the tree": """
import ast
class Seven(ast.NodeTransformer):
    def visit_Constant(self, node):
        return ast.Constant(7) if node.value == 1 else node
get_ipython().ast_transformers.append(Seven())""",
    "all values shown": "get_ipython().ast_node_interactivity = 'all'",
    "assigned values shown": "get_ipython().ast_node_interactivity = 'last_expr_or_assign'",
    "warnings as errors": "import warnings; warnings.simplefilter('error')",
    "annotations of the future": "from __future__ import annotations",
    "operators of the future": "from __future__ import barry_as_FLUFL",
    "no await at the top": "get_ipython().autoawait = False",
}
AFTER = [
    "n = 1",
    "n",
    "n;",
    "n\nn",
    "n != 2\nn",
    "def f(x: absent = 1): return x\nf()",
    "f()",
    "'\\d'",
    "n is 1",
    "import asyncio\nawait asyncio.sleep(0, 1)",
    "1 +",
    "%time",
    "?n",
    "f.__annotations__",
]


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_expected_cells_heed_what_a_cell_above_has_changed(in_sandbox, monkeypatch, change):
    monkeypatch.setattr(ForkServer, "current", None)
    as_they_come = in_sandbox([change, *AFTER])
    assert in_sandbox([change, *AFTER], frozenset(AFTER)) == as_they_come
    assert as_they_come != in_sandbox(["0", *AFTER])


def test_a_graded_notebook_shows_what_a_cell_below_changed(sandboxed):
    name = "3_chaining"
    raw = solution(name)
    for source in ("handle.update('changed')", "handle = display('first', display_id=True)"):
        raw["cells"].insert(1, {"cell_type": "code", "metadata": {}, "source": source})
    run = grading_run(Course(ROOT), 7, notebooks=[name])
    graded = grade_submission(Submission("ann", {f"{name}.ipynb": json.dumps(raw).encode()}), run)
    above, below = json.loads(graded.notebooks[name])["cells"][1:3]
    assert above["outputs"][0]["data"] == {"text/plain": ["'changed'"]} and below["outputs"] == []


# Exceptions with a thousand frames and more, kept as `error`.
DEEP = {
    "a function": "def f(x): return f(x + 1)\nf(0)",
    "two functions": "def even(x): return odd(x)\ndef odd(x): return even(x)\neven(0)",
    "a representation": "class A:\n    def __repr__(self): return repr(self)\nrepr(A())",
    "a comparison": "class A:\n    def __eq__(self, other): return self == other\nA() == 1",
    "an attribute": "class A:\n    def __getattr__(self, name): return self.absent\nA().x",
    "text that is run": "exec('def g(): return g()'); g()",
    "a module": "import helper; helper.recurse(0)",
    "deeper": "import sys; sys.setrecursionlimit(5000)\ndef f(x): return f(x + 1)\nf(0)",
}
SHOW = """
import inspect, sys
calls = searched = 0
def count(frame, event, _):
    global calls, searched
    calls += event == "call"
    searched += event == "call" and frame.f_code is inspect.ismodule.__code__  # a module, for a line of the traceback
sys.setprofile(count)
get_ipython().showtraceback((type(error), error, error.__traceback__))
sys.setprofile(None)
print(calls, searched)
"""


@pytest.mark.parametrize("source", DEEP.values(), ids=DEEP)
def test_an_endless_recursion_is_shown_without_looking_at_each_of_its_frames(sandboxed, source):
    *body, last = source.split("\n")
    cell = "\n".join([*body, "try:", f"    {last}", "except RecursionError as found:", "    error = found"])
    with Sandbox(PACKAGE, HANDED_IN, PATIENT) as box, box.notebook() as process:
        for part in (cell, "1 / 0", SHOW):  # the second loads what any traceback needs
            outputs = process.run_cell(part).outputs
    shown = outputs[0]
    assert shown["ename"] == "RecursionError" and len("\n".join(shown["traceback"])) < 20_000
    calls, searched = map(int, outputs[1]["text"].split())
    assert calls < 300_000 and searched < 50_000
