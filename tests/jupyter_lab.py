"""A JupyterLab of the tests, and a notebook opened in it as a student does."""

import json
import os
import secrets
import shutil
import socket
import subprocess
import sys
import urllib.request

from support import PATIENCE, ROOT, wait_for


class Server:
    """A Jupyter server in a folder of its own with the released notebooks in it.

    application: the module that is run, "jupyterlab" or "notebook"
    """

    def __init__(self, folder, application="jupyterlab"):
        self.folder, self.token = folder, secrets.token_hex(8)
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        self.url = f"http://127.0.0.1:{port}/user/x"
        shutil.copytree(ROOT / "notebooks/transforms", folder, dirs_exist_ok=True)
        names = ("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "IPYTHONDIR", "JUPYTERLAB_SETTINGS_DIR")
        home = {name: str(folder / ".home" / name) for name in names}
        settings = folder / ".home/JUPYTERLAB_SETTINGS_DIR/@jupyterlab/apputils-extension"
        settings.mkdir(parents=True)
        (settings / "notification.jupyterlab-settings").write_text('{"fetchNews": "false", "checkForUpdates": false}')
        self.log = (folder / "jupyter.log").open("w")
        self.process = subprocess.Popen(
            [sys.executable, "-m", application, "--no-browser", "--allow-root", "--ip=127.0.0.1", f"--port={port}",
             "--ServerApp.base_url=/user/x/", f"--IdentityProvider.token={self.token}", f"--ServerApp.root_dir={folder}",
             "--LabApp.expose_app_in_browser=True", "--JupyterNotebookApp.expose_app_in_browser=True"],
            stdout=self.log, stderr=self.log, stdin=subprocess.DEVNULL, env=os.environ | home,
        )  # fmt: skip
        wait_for(self._answers)

    def _answers(self):
        if self.process.poll() is not None:
            raise RuntimeError((self.folder / "jupyter.log").read_text())
        try:
            return self.api("api")
        except OSError:
            return False

    def api(self, path, method="GET"):
        request = urllib.request.Request(f"{self.url}/{path}", method=method)
        request.add_header("Authorization", f"token {self.token}")
        with urllib.request.urlopen(request, timeout=PATIENCE) as answer:
            text = answer.read()
        return json.loads(text) if text else None

    def stop_kernels(self):
        for session in self.api("api/sessions"):
            self.api(f"api/sessions/{session['id']}", "DELETE")

    def stop(self):
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
        self.log.close()


class Opened:
    """A notebook in a page, and what a person does with it."""

    def __init__(self, page, server, name, at="lab/tree", fresh=True):
        self.page, self.name = page, name
        server.stop_kernels()
        released = ROOT / f"notebooks/transforms/{name}.ipynb"
        if fresh and released.exists():
            shutil.copy(released, server.folder)
        query = "?reset&" if at == "lab/tree" else "?"
        page.goto(f"{server.url}/{at}/{name}.ipynb{query}token={server.token}")
        page.wait_for_function("() => window.jupyterapp")
        page.locator(".jp-Notebook .jp-Cell").first.wait_for()
        # until the file has been read, there is one empty cell
        page.wait_for_function("() => window.jupyterapp.shell.currentWidget?.context?.isReady")

    def command(self, name):
        self.page.evaluate("name => window.jupyterapp.commands.execute(name)", name)

    def activate(self, cell):
        self.page.evaluate("i => { window.jupyterapp.shell.currentWidget.content.activeCellIndex = i }", cell)

    def wait_until_idle(self):
        self.page.wait_for_function(
            "() => window.jupyterapp.shell.currentWidget?.sessionContext?.session?.kernel?.status === 'idle'"
        )

    def run_all(self):
        """Run all cells, and wait until the kernel has done them."""
        self.wait_until_idle()
        self.command("notebook:run-all-cells")
        self.page.wait_for_function(
            """() => {
              const cells = [...window.jupyterapp.shell.currentWidget.content.model.cells];
              const code = cells.filter(cell => cell.type === "code" && cell.sharedModel.getSource().trim());
              return code.at(-1).executionCount !== null
                && window.jupyterapp.shell.currentWidget.sessionContext.session.kernel.status === "idle";
            }"""
        )

    def figures(self):
        """Return the cells (their number) that show a scene, and scroll through the notebook so that all are drawn."""
        return self.page.evaluate(
            """() => [...window.jupyterapp.shell.currentWidget.content.model.cells].flatMap((cell, i) =>
              cell.type === "code" && JSON.stringify(cell.sharedModel.toJSON().outputs).includes("<iframe") ? [i] : [])"""
        )

    def place(self, cell):
        """Scroll to a cell and return where its scene is: an iframe."""
        self.page.evaluate("i => window.jupyterapp.shell.currentWidget.content.scrollToItem(i, 'center')", cell)
        notebook = self.page.locator(".jp-NotebookPanel:not(.lm-mod-hidden)")
        place = notebook.locator(f'.jp-Cell[data-windowed-list-index="{cell}"] iframe').last
        place.scroll_into_view_if_needed()
        return place

    def scene(self, cell):
        """Scroll to a cell and return the frame in which its scene is drawn."""
        return drawn(self.place(cell))

    def scene_with(self, selector):
        """Return the first scene that has such an element."""
        return next(scene for scene in map(self.scene, self.figures()) if scene.query_selector(selector))


def drawn(place):
    """Return the frame at `place` (an iframe) once its scene is drawn."""
    frame = place.element_handle().content_frame()
    frame.wait_for_function("() => window.viewer && document.body.className")
    return frame
