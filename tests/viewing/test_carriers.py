"""Which figures of a notebook carry what draws them all, in a kernel as JupyterLab asks it, and in one as nbclient does."""

import re

import pytest
from jupyter_client.manager import start_new_kernel
from support import PATIENCE, ROOT
from transform_lab.viewing import carriers, page

IMPORT = "from transform_lab import Viewer"
CARRIED = 200_000  # characters that a figure has more


@pytest.fixture
def figures(slow):
    """figures(text, cell): for each figure that a cell shows, whether it carries. JupyterLab and VS Code tell a cell's id."""
    manager, client = start_new_kernel(cwd=str(ROOT / "source/transforms"))

    def shown(text, cell=None):
        content = {"code": text, "silent": False, "store_history": True, "user_expressions": {}, "stop_on_error": True}
        request = client.session.msg("execute_request", content, metadata={"cellId": cell} if cell else {})
        client.shell_channel.send(request)
        found = []
        while True:
            message = client.get_iopub_msg(timeout=PATIENCE)
            if message["parent_header"].get("msg_id") != request["header"]["msg_id"]:
                continue
            content = message["content"]
            assert message["msg_type"] != "error", content
            if message["msg_type"] == "status" and content["execution_state"] == "idle":
                client.get_shell_msg(timeout=PATIENCE)
                return found
            if "<iframe" in (figure := content.get("data", {}).get("text/html", "")):
                assert ('loading="lazy"' in figure) == (len(figure) < CARRIED)  # what carries is loaded unseen
                found.append(len(figure) > CARRIED)

    shown(IMPORT)
    yield shown
    client.stop_channels()
    manager.shutdown_kernel(now=True)


def test_the_first_two_cells_carry_whenever_they_are_run(figures):
    assert [figures("Viewer()", cell) for cell in "abcd"] == [[True], [True], [False], [False]]
    assert [figures("Viewer()", cell) for cell in "cabe"] == [[False], [True], [True], [False]]
    cleared = (
        "from IPython.display import clear_output\nfor _ in range(2):\n    Viewer().show()\n    clear_output(wait=True)"
    )
    assert figures(cleared, "a") == [True, True]  # whichever stays
    assert figures(cleared, "c") == [False, False]
    assert figures("Viewer().show(live=True)", "c") == [False]


def test_cells_without_an_id_are_told_apart_by_what_they_say(figures):
    assert [figures(f"Viewer('{name}')") for name in "abcab"] == [[True], [True], [False], [True], [True]]


def test_a_page_of_its_own_carries(figures):
    for cell in "abc":
        figures("Viewer()", cell)
    assert figures("from IPython.display import HTML\nHTML(Viewer().html())", "d") == [True]


def test_outside_of_cells_each_figure_carries():
    assert [carriers.carries() for _ in range(5)] == [True] * 5


def test_what_is_carried_is_meshcats_viewer_without_what_is_never_used():
    whole = (page.folder() / "viewer/dist/main.min.js").read_text(encoding="utf-8")
    carried = page._viewer()
    assert 0.75 < len(carried) / len(whole) < 0.82
    assert len(re.findall(r"[{,]\d+:\(\)=>\{\}", carried)) == len(page.UNUSED)
