"""Somebody with a browser who uses the hub: logs in, opens notebooks, nbgrader's lists and the formgrader, types commands."""

from types import SimpleNamespace

from jupyter_lab import Opened
from support import PATIENCE, wait_for

TYPE = """async line => {
  const { content } = await window.jupyterapp.commands.execute("terminal:create-new");
  const session = content.session;
  while (session.connectionStatus !== "connected") await new Promise(done => setTimeout(done, 100));
  session.send({ type: "stdin", content: [line] });
}"""


class Person:
    """One of the machine's accounts, logged in; each has a browser's cookies of their own."""

    def __init__(self, machine, browser, who):
        self.machine, self.name, self.home = machine, machine.names[who], machine.home[who]
        self.url = f"{machine.url}/user/{self.name}"
        self.context = browser.new_context(viewport={"width": 1400, "height": 900})
        self.context.set_default_timeout(1000 * PATIENCE)
        self.page = self.context.new_page()
        self.page.goto(machine.url)
        self.page.fill("#username_input", self.name)
        self.page.fill("#password_input", "any")
        self.page.click("#login_submit")
        self.lab()

    def lab(self):
        """Lab with nothing open in it."""
        self.page.wait_for_url("**/lab**")
        self.page.goto(f"{self.url}/lab?reset")
        self.page.wait_for_function("() => window.jupyterapp")
        self.page.evaluate("() => window.jupyterapp.restored")
        self.page.locator(".lm-MenuBar-itemLabel", has_text="Nbgrader").wait_for()
        return self.page

    def menu(self):
        """What the menu of nbgrader offers."""
        self.page.locator(".lm-MenuBar-itemLabel", has_text="Nbgrader").click()
        found = self.page.locator(".lm-Menu-item:not(.lm-mod-hidden) .lm-Menu-itemLabel").all_inner_texts()
        self.page.keyboard.press("Escape")
        return [name for name in found if name]

    def open(self, name):
        """Open what the menu of nbgrader calls so."""
        self.page.locator(".lm-MenuBar-itemLabel", has_text="Nbgrader").click()
        self.page.locator(".lm-Menu-itemLabel").get_by_text(name, exact=True).click()

    def assignments(self, button):
        """Open nbgrader's list, press a button in it, and wait until that is done."""
        self.lab()
        self.open("Assignment List")
        self.page.get_by_text("Submitted assignments", exact=True).wait_for()
        asked = self.page.get_by_role("button", name=button, exact=True).last
        with self.page.expect_response(
            lambda answer: "/assignments/" in answer.url and answer.request.method == "POST"
        ):
            asked.click()

    def notebook(self, path):
        """Open a notebook in Lab."""
        server = SimpleNamespace(url=self.url, token="", folder=self.home, stop_kernels=lambda: None)
        return Opened(self.page, server, path, fresh=False)

    def status(self, path):
        """What the server answers to a request of this person's, as a number."""
        return self.context.request.get(f"{self.machine.url}/{path}").status

    def types(self, command):
        """Type a command into a terminal of Lab; what it says."""
        told = self.home / "told.txt"
        told.unlink(missing_ok=True)
        self.lab()
        line = f"({command}) > ~/told.new 2>&1; echo exit $? >> ~/told.new; mv ~/told.new ~/told.txt\n"
        self.page.evaluate(TYPE, line)
        wait_for(told.exists)
        return told.read_text()
