"""A function that is older than its cell, or not there, and a block whose own lines fail: what a student reads then."""

import re
import sys

import nbformat
import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.utils.capture import capture_output
from jupyter_client.manager import start_new_kernel
from support import ASKED, PATIENCE, ROOT
from transform_lab.check import say_what_is_missing
from transform_lab.outdated import follow

NAME = "rotation_about_z"
RIGHT = """def rotation_about_z(degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
"""
WRONG = RIGHT.replace("-s", "s")
UNFINISHED = RIGHT.replace("0, 1]])", "0, 1]]")
UNINDENTED = RIGHT.replace("    return", "  return")
RENAMED = RIGHT.replace(NAME, "rotate_z")
IMPORTS = "import numpy as np\nfrom transform_lab import check, once_done, sum_up\n"
CHECK = f'check("{NAME}", {NAME})'
ABOVE = "run the cells above from the top (Run > Run All Above Selected Cell)"
OLD = f"{NAME}: not checked, Python still has an older version of it.\n"
ALL_RIGHT = f"{NAME}: all right."
MEND = "Mend that cell and run it, then run this one again."


class Notebook:
    """A notebook in IPython: run(text, cell) is what a student reads below the cell; without ids, no cell has one."""

    def __init__(self, ids=True):
        self.ids, self.shell = ids, InteractiveShell.instance()
        self.shell._showtraceback = lambda *_: None  # which a terminal has among what is printed
        follow(say_what_is_missing)
        self.run(IMPORTS, "imports")

    def run(self, text, cell=None):
        cell = cell if self.ids else None
        with capture_output() as shown:
            result = self.shell.run_cell(text, store_history=True, cell_id=cell)
        self.error = result.error_before_exec or result.error_in_exec
        displayed = [output.data["text/plain"] for output in shown.outputs]
        self.html = "".join(output.data.get("text/html", "") for output in shown.outputs)
        return "\n".join([shown.stdout, *displayed]).strip().replace("\n\n", "\n")

    def check(self):
        return self.run(CHECK, "check")


@pytest.fixture
def notebook():
    yield Notebook()
    InteractiveShell.clear_instance()


@pytest.fixture(params=[True, False], ids=["ids", "no ids"])
def either(request):
    """A notebook with cell ids, and one without."""
    yield Notebook(request.param)
    InteractiveShell.clear_instance()


# --- a cell that stopped --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text, error",
    [
        (UNFINISHED, r"SyntaxError: .+, in line \d"),
        (UNINDENTED, "IndentationError: unindent does not match any outer indentation level, in line 3"),
        (f"from nowhere import c\n{RIGHT}", r"ModuleNotFoundError: No module named 'nowhere', in your line 1: `.+`"),
        (f"%%time\nfrom nowhere import c\n{RIGHT}", "ModuleNotFoundError: No module named 'nowhere'"),
    ],
)
def test_after_its_cell_stopped_a_function_is_not_judged(either, text, error):
    either.run(WRONG, "solution")
    either.run(text, "solution")
    says = either.check()
    assert re.fullmatch(f"{re.escape(OLD)}Its cell stopped with {error}\\.\n{re.escape(MEND)}", says)
    assert str(either.error) == OLD.strip()
    assert OLD.strip() in either.html and MEND in either.html and "✗" not in either.html
    either.run(RIGHT, "solution")
    assert either.check() == ALL_RIGHT


@pytest.mark.parametrize("before", [RIGHT, f"{NAME} = lambda degrees: np.eye(3)"], ids=["right", "lambda"])
def test_an_older_function_has_no_points_whatever_it_was(either, before):
    either.run(before, "solution")
    either.run(UNFINISHED, "solution")
    assert either.check().startswith(OLD) and either.error is not None and "✓" not in either.html


def test_a_stub_that_was_filled_in_wrongly_is_not_called_a_stub(either):
    either.run(f"def {NAME}(degrees):\n    raise NotImplementedError", "solution")
    assert "not done yet" in either.check()
    either.run(UNFINISHED, "solution")
    assert either.check().startswith(OLD)


def test_an_error_below_the_function_changes_nothing(either):
    either.run(WRONG, "solution")
    either.run(f"{RIGHT}\n1 / 0", "solution")
    assert isinstance(either.error, ZeroDivisionError)
    assert either.check() == ALL_RIGHT


def test_another_exercise_whose_cell_stops_changes_nothing(either):
    either.run(RIGHT, "solution")
    either.run("def is_rotation(R):\n    return (", "other")
    assert either.check() == ALL_RIGHT


def test_another_cell_that_defines_it_and_stops_is_only_mentioned(notebook):
    notebook.run(RIGHT, "solution")
    notebook.run(UNINDENTED, "copy")
    assert re.fullmatch(
        f"This is about {NAME} as it was before: another cell that defines it stopped with IndentationError: .+, in line 3\\.\n"
        f"{NAME}: all right\\.",
        notebook.check(),
    )
    notebook.run("1", "copy")
    assert notebook.check() == ALL_RIGHT


# --- a function that got another name -------------------------------------------------------------------------------


def test_a_renamed_function_is_named(notebook):
    notebook.run(RIGHT, "solution")
    notebook.run(RENAMED, "solution")
    rename = f"Rename `rotate_z` to `{NAME}` and run that cell, then run this one again."
    assert notebook.check() == f"{OLD}Its cell now defines `rotate_z`.\n{rename}"
    assert "<code>rotate_z</code>" in notebook.html
    notebook.run(RIGHT, "solution")
    assert notebook.check() == ALL_RIGHT


def test_a_cell_that_defines_it_no_longer(notebook):
    notebook.run(RIGHT, "solution")
    notebook.run(f"print({NAME}(30))", "solution")
    gone = "Its cell no longer defines it.\nRun the cell that does, then run this one again."
    assert notebook.check() == f"{OLD}{gone}"
    notebook.run("def is_rotation(R):\n    return True", "solution")  # another exercise is not its new name
    assert notebook.check() == f"{OLD}{gone}"
    notebook.run(RIGHT, "copy")
    assert notebook.check() == ALL_RIGHT


def test_without_ids_a_renamed_function_is_judged_and_mentioned():
    notebook = Notebook(ids=False)
    notebook.run(RIGHT)
    notebook.run("def is_rotation(degrees):\n    return True\ndef shown(scene, degrees): pass")
    assert notebook.check() == ALL_RIGHT
    notebook.run(RENAMED)
    note = f"This is about {NAME} as it was before: `rotate_z` was defined after it."
    assert notebook.check() == f"{note}\n{NAME}: all right."
    InteractiveShell.clear_instance()


def test_a_check_of_the_new_name_says_that_grading_looks_for_the_old(notebook):
    notebook.run(RENAMED, "solution")
    says = f"Grading looks for {NAME}, and there is none: rename rotate_z to it.\n{NAME}: all right."
    assert notebook.run(f'check("{NAME}", rotate_z)', "check") == says
    notebook.run(RIGHT, "solution")
    assert notebook.run(f'check("{NAME}", rotate_z)', "check") == ALL_RIGHT


# --- in doubt, as it is ---------------------------------------------------------------------------------------------

WRAPPED = f"""from functools import wraps
def twice(function):
    @wraps(function)
    def both(*given): return function(*given)
    return both
@twice
{RIGHT}"""


@pytest.mark.parametrize(
    "text, again",
    [
        (RIGHT, f"if False:\n    {NAME} = lambda degrees: 0"),
        (f"{NAME} = lambda degrees: turned(degrees)", f"{NAME} = lambda degrees: turned(degrees)\n1 / 0"),
        (f"from functools import partial\n{NAME} = partial(turned)", f"{NAME} = partial(turned)\n1 / 0"),
        (WRAPPED, f"{WRAPPED}\n1 / 0"),
        (f"%%time\n{RIGHT}", f"%%time\n{RIGHT}1 / 0"),
        (f"%%time\n{RIGHT}", RIGHT),
        (f"exec({RIGHT!r})", f"exec({RIGHT!r}) or 1 / 0"),
        (f"if True:\n    def {NAME}(degrees): return turned(degrees)", f"if False:\n    def {NAME}(): pass\n1 / 0"),
        (f"from a_helper import {NAME}", f"from a_helper import {NAME}\n1 / 0"),
        (f"from a_helper import {NAME}", f"{NAME} = {NAME}"),
        (f"{RIGHT}\nkept = {NAME}", f"{NAME} = kept\n1 / 0"),
        (f"{WRONG}\n{NAME} = own", f"{WRONG}\n{NAME} = own\n1 / 0"),
        ("%run a_helper.py", "%run a_helper.py\n1 / 0"),
    ],
)
def test_no_false_alarm(either, monkeypatch, tmp_path, text, again):
    (tmp_path / "a_helper.py").write_text(f"import numpy as np\n{RIGHT}")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    either.run(f"from a_helper import {NAME} as turned\ndef own(degrees): return turned(degrees)", "helpers")
    either.run(WRONG, "solution")
    for one in (text, again):
        either.run(one, "solution")
        assert either.check() == ALL_RIGHT
    del sys.modules["a_helper"]


def test_of_two_cells_that_define_it_the_one_run_last_is_judged(notebook):
    for cells in (("first", "second"), ("second", "first")):
        notebook.run(WRONG, cells[0])
        notebook.run(RIGHT, cells[1])
        assert notebook.check() == ALL_RIGHT


def test_what_was_run_before_the_import_is_judged_until_its_cell_stops():
    InteractiveShell.instance().run_cell(RIGHT)
    notebook = Notebook()
    assert notebook.check() == ALL_RIGHT
    notebook.run(UNFINISHED, "solution")
    assert notebook.check().startswith(OLD)
    InteractiveShell.clear_instance()


def test_a_check_in_the_cell_that_defines_it(either):
    either.run(UNFINISHED, "solution")
    assert either.run(f"{RIGHT}\n{CHECK}", "solution") == ALL_RIGHT


def test_little_is_kept(notebook):
    for n in range(50):
        notebook.run(f"def f_{n}(x):\n    return x\n" + "#" * 10_000, f"cell {n}")
        notebook.run(f"del f_{n}", f"del {n}")
    from transform_lab import outdated

    assert outdated._followed._made == {} and outdated._followed._changes == {}


def test_while_graded_nothing_is_followed(monkeypatch):
    monkeypatch.setenv("TRANSFORM_LAB_GRADING", "1")
    shell = InteractiveShell.instance()
    before = list(shell.events.callbacks["post_run_cell"])
    follow(say_what_is_missing)
    assert shell.events.callbacks["post_run_cell"] == before
    InteractiveShell.clear_instance()


# --- a function that is not there -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text, why",
    [
        (None, "run the cell that defines it, and keep its name."),
        (UNINDENTED, "its cell stopped with IndentationError: unindent does not match any outer indentation level, in line 3."),
        (RENAMED, f"you have `rotate_z`; if that is it, rename it to `{NAME}` and run its cell."),
        ("def rot_about_z(angle): pass", f"you have `rot_about_z`; if that is it, rename it to `{NAME}` and run its cell."),
        ("def turn(scene, degrees): pass", "run the cell that defines it, and keep its name."),
    ],
)  # fmt: skip
def test_a_function_that_is_not_there(notebook, text, why):
    if text:
        notebook.run(text, "solution")
    assert notebook.check() == f"{NAME} is not there: {why}"
    assert isinstance(notebook.error, NameError)
    says = notebook.run('sum_up("1_rotation")').splitlines()[0]
    assert says == f"{NAME}  0 of {ASKED['1_rotation'].points[NAME]:g}  {why.rstrip('.')}"
    assert notebook.run(f'with once_done("{NAME}"):\n    {NAME}(30)') == f"This part appears once {NAME} is done: {why}"


def test_a_cell_that_stopped_is_forgotten_once_it_has_run(notebook):
    notebook.run(UNINDENTED, "solution")
    notebook.run(RENAMED, "solution")
    assert "you have `rotate_z`" in notebook.check()


def test_other_names_that_are_not_there_are_left_to_python(notebook):
    assert notebook.run("check(nothing, nothing)") == ""
    assert notebook.run(NAME) == ""


def test_no_function_of_a_notebook_is_taken_for_an_exercise(notebook):
    """Those that a notebook's own cells define are there before a student has written anything."""
    for path in sorted((ROOT / "source/transforms").glob("*.ipynb")):
        defined = [
            "".join(re.findall(r"^def .*:\n", cell.source, re.M)).replace(":\n", ": pass\n")
            for cell in nbformat.read(path, 4).cells
            if cell.cell_type == "code" and "### BEGIN SOLUTION" not in cell.source
        ]
        notebook.run("\n".join(defined), path.stem)
        for name in ASKED[path.stem].points:
            assert notebook.run(f'check("{name}", {name})').endswith("run the cell that defines it, and keep its name.")


# --- the last cell --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text, why",
    [
        (UNINDENTED, "its cell stopped with IndentationError: .+, in line 3"),
        (RENAMED, "its cell now defines `rotate_z`"),
    ],
)
def test_the_last_cell_does_not_judge_it_either(notebook, text, why):
    notebook.run(RIGHT, "solution")
    notebook.run(text, "solution")
    says = notebook.run('sum_up("1_rotation")')
    assert re.search(f"^{NAME}  0 of \\d  {OLD.strip().partition(': ')[2].rstrip('.')}: {why}$", says, re.M)
    assert "Right so far: 0 of " in says
    assert "<tr><td>…</td>" in notebook.html and "✓" not in notebook.html


# --- a block whose own lines fail -----------------------------------------------------------------------------------


def cell_of(notebook, start):
    """The text of the notebook's cell that begins with `start`."""
    cells = nbformat.read(ROOT / f"source/transforms/{notebook}.ipynb", 4).cells
    return next(cell.source for cell in cells if cell.source.startswith(start))


BLOCK = cell_of("1_rotation", 'with once_done("is_rotation")')
SOLVED = cell_of("1_rotation", "def is_rotation")
THERE = "candidates = {'one': np.eye(3)}"


@pytest.mark.parametrize(
    "cells, says",
    [
        ([], f"candidates is not there: {ABOVE}, or mend the name if it is a slip."),
        ([SOLVED], f"candidates is not there: {ABOVE}, or mend the name if it is a slip."),
        (["def is_rotation(R):\n    raise NotImplementedError", THERE], "This part appears once is_rotation is done."),
        (
            ["def is_rotation(R):\n    return nothing", THERE],
            "This part appears once is_rotation is right; now it stops with NameError: name 'nothing' is not defined, "
            "in your line 2: `return nothing`",
        ),
        (["def is_rotation(): return True", THERE], "This part appears once is_rotation is right; now it stops with TypeError: "),
        (
            [SOLVED, "candidates = {'one': None}"],
            "is_rotation is right, but this cell stops with AttributeError: .* "
            f"If you changed its lines, undo that; if not, {ABOVE}.",
        ),
        ([SOLVED, THERE], "one   True"),
    ],
)  # fmt: skip
def test_a_block_says_whose_error_it_is(notebook, cells, says):
    for number, text in enumerate(cells):
        notebook.run(text, f"cell {number}")
    assert re.match(re.escape(says).replace(r"\.\*", ".*"), notebook.run(BLOCK, "block"))
    assert notebook.error is None


def test_a_helper_of_the_student_is_the_students(notebook):
    notebook.run(f"{THERE}\ndef helper(R):\n    return nothing\ndef is_rotation(R):\n    return helper(R)", "cell")
    assert "once is_rotation is right; now it stops with NameError" in notebook.run(BLOCK, "block")


def test_a_block_whose_function_is_older_than_its_cell_says_so(notebook):
    notebook.run(f"{THERE}\ndef is_rotation(R):\n    return nothing", "cell")
    notebook.run("def is_rotation(R):\n    return (", "cell")
    assert re.fullmatch(
        rf"This part needs is_rotation as it is now: its cell stopped with SyntaxError: .+, in line 2\. {MEND}",
        notebook.run(BLOCK, "block"),
    )


# --- a kernel -------------------------------------------------------------------------------------------------------


@pytest.fixture
def kernel(slow):
    manager, client = start_new_kernel(cwd=str(ROOT / "source/transforms"))
    yield client
    client.stop_channels()
    manager.shutdown_kernel(now=True)


def run_in(kernel, text, cell):
    """Run a cell as JupyterLab does, with its id; what is displayed and printed below it, and its error's name."""
    content = {"code": text, "silent": False, "store_history": True, "user_expressions": {}, "stop_on_error": True}
    request = kernel.session.msg("execute_request", content, metadata={"cellId": cell})
    kernel.shell_channel.send(request)
    shown = []
    while True:
        message = kernel.get_iopub_msg(timeout=PATIENCE)
        if message["parent_header"].get("msg_id") != request["header"]["msg_id"]:
            continue
        content = message["content"]
        if message["msg_type"] == "status" and content["execution_state"] == "idle":
            kernel.get_shell_msg(timeout=PATIENCE)
            return "\n".join(shown)
        found = content.get("text") or content.get("data", {}).get("text/plain") or content.get("ename")
        shown += [found.strip()] if found else []


def test_in_a_kernel(kernel):
    assert run_in(kernel, IMPORTS, "imports") == ""
    says = f"NameError\n{NAME} is not there: run the cell that defines it, and keep its name."
    assert run_in(kernel, CHECK, "check") == says
    run_in(kernel, RIGHT, "solution")
    assert run_in(kernel, CHECK, "check") == ALL_RIGHT
    assert run_in(kernel, UNINDENTED, "solution") == "IndentationError"
    assert run_in(kernel, CHECK, "check").startswith(f"{OLD}Its cell stopped with IndentationError: ")
    assert run_in(kernel, f"import nowhere\n{WRONG}", "solution") == "ModuleNotFoundError"
    stopped = "Its cell stopped with ModuleNotFoundError: No module named 'nowhere', in your line 1: `import nowhere`."
    assert run_in(kernel, CHECK, "check").startswith(f"{OLD}{stopped}")
    run_in(kernel, RENAMED, "solution")
    assert run_in(kernel, CHECK, "check").startswith(f"{OLD}Its cell now defines `rotate_z`.")
    run_in(kernel, f"import asyncio\nawait asyncio.sleep(0)\n{RIGHT}", "solution")
    assert run_in(kernel, CHECK, "check") == ALL_RIGHT
