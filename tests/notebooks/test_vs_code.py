"""Scenes in the frames that VS Code (1.96) puts the outputs of a notebook in, with its rules for what these may do.

From its source: `_createElement` of webviewElement.ts and pre/index.html have the two frames around the outputs and what these
say to be their parent, `generateContent` of backLayerWebView.ts the policy, `renderHTML` of the extension notebook-renderers
how an output comes into the page. A folder that is not trusted shows only what mimeTypeIsAlwaysSecure: of a scene, its text.
"""

import functools
import http.server
import threading

import nbformat
import pytest
from jupyter_lab import drawn
from support import PATIENCE, ROOT
from transform_lab.predictions import place

POLICY = (
    "default-src 'none'; script-src 'self' https://*.vscode-cdn.net 'unsafe-inline' 'unsafe-eval'; "
    "style-src 'self' https://*.vscode-cdn.net 'unsafe-inline'; img-src 'self' https://*.vscode-cdn.net https: http: data:; "
    "font-src 'self' https://*.vscode-cdn.net https:; connect-src https:; child-src https: data:;"
)
OUTER = """<body><iframe sandbox="allow-scripts allow-same-origin allow-forms allow-pointer-lock allow-downloads"
    src="frame.html" width="1000" height="800"></iframe>"""
FRAME = """<meta http-equiv="Content-Security-Policy" content="default-src 'none'; frame-src 'self'; style-src 'unsafe-inline'">
    <body><iframe sandbox="allow-same-origin allow-pointer-lock allow-scripts allow-downloads allow-forms"
    src="outputs.html" style="width: 950px; height: 750px"></iframe>"""
OUTPUTS = f"""<meta http-equiv="Content-Security-Policy" content="{POLICY}"><body><div id="container"></div><script>
    window.parent = window; window.top = window; window.frameElement = null;
    function show(html, shadow) {{
      const element = document.createElement("div"), place = document.createElement("div");
      document.getElementById("container").append(place);
      (shadow ? place.attachShadow({{mode: "open"}}) : place).append(element);
      element.innerHTML = html;
      for (const node of Array.from(element.getElementsByTagName("script"))) {{
        const script = document.createElement("script");
        script.text = node.innerText;
        element.appendChild(script).parentNode.removeChild(script);
      }}
    }}
    </script>"""


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """Of a server with the pages."""
    folder = tmp_path_factory.mktemp("vs_code")
    for name, text in {"outer": OUTER, "frame": FRAME, "outputs": OUTPUTS}.items():
        (folder / f"{name}.html").write_text(f"<!DOCTYPE html>{text}")
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=folder)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@pytest.fixture
def outputs(browser, address):
    """The frame in which VS Code shows outputs."""
    context = browser.new_context()
    context.set_default_timeout(1000 * PATIENCE)
    page = context.new_page()
    page.goto(f"{address}/outer.html")
    yield page.frame(url=f"{address}/outputs.html")
    context.close()


@pytest.fixture(scope="module")
def scenes(run_all):
    """What each cell of a notebook that shows a scene puts out, {type: text}."""
    folder = ROOT / "source/transforms"
    notebook = run_all(nbformat.read(folder / "4_inversion.ipynb", as_version=4), folder)
    shown = [output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", [])]
    return [data for data in shown if "<iframe" in data.get("text/html", "")]


def test_scenes_are_drawn(outputs, scenes):
    assert outputs.evaluate("() => window.parent === window") and len(scenes) > 1
    for scene in scenes:
        outputs.evaluate("html => show(html)", scene["text/html"])
    places = outputs.locator("iframe")
    for i in range(len(scenes)):
        places.nth(i).scroll_into_view_if_needed()
        assert drawn(places.nth(i)).locator("canvas").is_visible()
        assert outputs.locator("img").nth(i).evaluate("image => image.complete && image.naturalWidth")


def test_a_folder_that_is_not_trusted_shows_their_texts(scenes):
    for scene in scenes:
        assert set(scene) == {"text/html", "text/plain"} and scene["text/plain"].startswith("Scene in the fixed frame")


@pytest.mark.parametrize("shadow", [True, False])
def test_predictions_are_answered_whichever_is_shown_first(outputs, shadow):
    for answer, carries in (([1.0], False), ([2.0], True), ([3.0], False), ([4.0], True), ([5.0], False)):
        outputs.evaluate("([html, shadow]) => show(html, shadow)", [place(answer, [], carries=carries), shadow])
    fields = outputs.get_by_label("Your answer")
    fields.nth(4).wait_for()
    for number in range(5):
        fields.nth(number).fill(str(number + 1))
        fields.nth(number).press("Enter")
    said = outputs.locator("output").all_inner_texts()
    assert len(said) == 5 and all(words.startswith("✓ Yes") for words in said)
