"""The notebooks themselves: solved they earn everything, untouched they run calmly to the end and earn nothing."""

import re

import nbformat
import pytest
from support import NAMES, ROOT
from transform_lab.judging import panel

from autograder.course import Course
from autograder.grading.grade import grading_run
from autograder.grading.judge import judge
from autograder.grading.one_student import check_files
from autograder.intake.restore import restore
from autograder.intake.submission import Submission

SOLVED = sorted((ROOT / "source/transforms").glob("*.ipynb"))
PICTURE = re.compile(r"<img [^>]*>|<iframe (?:[^>\"]|\"[^\"]*\")*>")
RELEASED = sorted((ROOT / "notebooks/transforms").glob("*.ipynb"))


def names(paths):
    return [path.stem for path in paths]


def read(path):
    return nbformat.read(path, as_version=4)


def text_of(cell):
    return "\n".join(output.get("text") or output.get("data", {}).get("text/plain", "") for output in cell.outputs)


def test_each_is_there_solved_and_released():
    assert names(SOLVED) == names(RELEASED) != []


def test_the_solved_notebooks_earn_everything_in_the_sandbox(sandboxed):
    found, refused, mended = check_files(Course(ROOT), SOLVED)
    assert [row.exercise for row, _ in found] == NAMES
    assert [(row.exercise, row.score) for row, _ in found] == [(row.exercise, row.max_score) for row, _ in found]
    assert refused == mended == []


def test_no_cell_of_a_solved_notebook_fails_in_the_sandbox(sandboxed):
    against = grading_run(Course(ROOT), seed=1)
    with against.sandbox(Submission("", {})) as sandbox:
        for path in SOLVED:
            intake = restore(path.read_bytes(), against.released[path.stem])
            judge(intake, against.released[path.stem], against.keys, sandbox)
            outputs = [output for cell in intake.notebook.cells for output in cell.get("outputs", ())]
            assert outputs
            assert not [o for o in outputs if o.output_type == "error" or o.get("name") == "stderr"], path.name


def test_the_untouched_notebooks_earn_nothing_in_the_sandbox(sandboxed):
    found, refused, mended = check_files(Course(ROOT), RELEASED)
    assert [row.score for row, _ in found] == [0.0] * len(NAMES)
    assert {row.status for row, _ in found} == {"error"}
    assert {panel.summary(verdict) for _, verdict in found} == {"Not done yet."}
    assert refused == mended == []


@pytest.mark.parametrize("path", SOLVED, ids=names(SOLVED))
def test_run_all_of_a_solved_notebook(path, run_all):
    notebook = run_all(read(path), path.parent)
    checks = [cell for cell in notebook.cells if cell.source.startswith("check(")]
    assert checks
    for cell in checks:
        assert re.fullmatch(r"\w+: all right\.", text_of(cell)), cell.source

    pages = [o.data["text/html"] for cell in notebook.cells for o in cell.get("outputs", ()) if "<iframe" in str(o)]
    assert len(pages) >= 3 and max(map(len, pages)) <= 300_000
    assert sorted(map(len, pages))[-3] <= 45_000  # but for two, which carry what draws them all
    assert len(nbformat.writes(notebook).encode()) <= 800_000

    # Pictures are told to who cannot see them. (A bare image/png is not: Jupyter has no place for the words.)
    shown = [output["data"] for cell in notebook.cells for output in cell.get("outputs", ()) if "data" in output]
    assert not [data for data in shown if "image/png" in data]
    elements = [element for data in shown for element in PICTURE.findall(data.get("text/html", ""))]
    assert len(elements) >= 2 * len(pages)
    for element in elements:
        assert re.search(r' (alt|title)="[^"]+"', element), element[:100]


@pytest.mark.parametrize("path", RELEASED, ids=names(RELEASED))
def test_run_all_of_an_untouched_notebook_reaches_its_end_calmly(path, run_all):
    notebook = run_all(read(path), path.parent)
    code = [cell for cell in notebook.cells if cell.cell_type == "code" and cell.source.strip()]
    assert code[-1].execution_count == len(code)
    for cell in code:
        assert not [output for output in cell.outputs if output.get("name") == "stderr"], cell.source
        if cell.source.startswith("check("):
            assert ": not done yet." in text_of(cell)


@pytest.mark.parametrize("path", SOLVED, ids=names(SOLVED))
def test_no_code_cell_is_longer_than_a_screen(path):
    for cell in read(path).cells:
        assert cell.cell_type != "code" or cell.source.count("\n") < 45, cell.id


@pytest.mark.parametrize("path", SOLVED, ids=names(SOLVED))
def test_headings_are_in_order(path):
    levels = []
    for cell in read(path).cells:
        if cell.cell_type == "markdown":
            levels += [len(line) - len(line.lstrip("#")) for line in cell.source.splitlines() if line.startswith("#")]
    assert levels[0] == 1 and levels.count(1) == 1
    assert all(after - before <= 1 for before, after in zip(levels, levels[1:]))


def test_a_page_can_be_made_in_the_sandbox_when_a_cell_asks_for_it(sandboxed):
    against = grading_run(Course(ROOT), seed=1)
    with against.sandbox(Submission("", {})) as sandbox, sandbox.notebook() as process:
        run = process.run_cell("from transform_lab import Viewer\nlen(Viewer().html()) > 100_000")
        assert [output["data"]["text/plain"] for output in run.outputs] == ["True"]


LEFT_OVER = """
import matplotlib
import matplotlib.pyplot as plt
plt.switch_backend("template")  # draws nothing
matplotlib.rcParams.update({"savefig.transparent": True, "figure.facecolor": "none", "interactive": True})
plt.figure(figsize=(4, 4))  # an interrupted cell's, never shown and never closed
"""


def test_plots_are_drawn_whatever_is_left_over_in_pyplot(run_all):
    def drawn(*before):
        lines = ["from transform_lab import plot_columns, plot_quaternion\nimport numpy as np", *before]
        cells = [nbformat.v4.new_code_cell(line) for line in (*lines, "plot_columns(np.eye(3));", "plot_quaternion();")]
        notebook = run_all(nbformat.v4.new_notebook(cells=cells), ROOT / "source/transforms")
        return [[output["data"]["text/html"] for output in cell.outputs] for cell in notebook.cells[-2:]]

    plain = drawn()
    assert [len(shown) for shown in plain] == [1, 1] and drawn(LEFT_OVER) == plain
