"""Notebook 7, started as `jupyter notebook`: each notebook from its first cell to its last, by its own menu."""

import nbformat
import pytest
from jupyter_lab import Opened, Server
from support import ASKED

CELLS = "() => [...window.jupyterapp.shell.currentWidget.content.model.cells].map(cell => cell.sharedModel.toJSON())"


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    running = Server(tmp_path_factory.mktemp("notebook") / "work", "notebook")
    yield running
    running.stop()


@pytest.mark.parametrize("name", ASKED)
def test_run_all_to_the_end(page, server, name):
    notebook = Opened(page, server, name, at="notebooks")
    notebook.wait_until_idle()
    page.get_by_role("menuitem", name="Run", exact=True).click()
    page.get_by_role("menuitem", name="Run All Cells", exact=True).click()
    page.wait_for_function(
        f"""() => {{
          const code = ({CELLS})().filter(cell => cell.cell_type === "code" && cell.source.length);
          return code.every(cell => cell.execution_count !== null)
            && window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.status === "idle";
        }}"""
    )
    code = [cell for cell in page.evaluate(CELLS) if cell["cell_type"] == "code"]
    assert not [cell["source"] for cell in code for output in cell["outputs"] if output["output_type"] == "error"]
    assert notebook.scene(notebook.figures()[-1]).locator("canvas").is_visible()
    page.keyboard.press("Control+s")
    page.wait_for_function("() => !window.jupyterapp.shell.currentWidget.context.model.dirty")
    saved = nbformat.read(server.folder / f"{name}.ipynb", as_version=4).cells
    assert [len(cell.outputs) for cell in saved if cell.cell_type == "code"] == [len(cell["outputs"]) for cell in code]
