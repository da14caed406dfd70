"""What students write, as feedback and formgrader show it: theirs to read, without what could act on the reader."""

import base64
import re

import nbformat
import pytest
from support import Parsed, markdown, run

ONE = "1_rotation"
PIXEL = base64.b64encode(b"\x89PNG\r\n\x1a\n" + bytes(20)).decode()
ATTACKS = [
    "<script>MARK()</script>",
    "<img src=x onerror=MARK()>",
    "<img src='https://example.com/MARK.png'>",
    "![picture](https://example.com/MARK.png)",
    "<iframe src='https://example.com/MARK'></iframe>",
    "<object data='MARK'></object><embed src='MARK'>",
    "<svg onload=MARK()><script>MARK()</script></svg>",
    "[link](javascript:MARK())",
    "<a href='java\nscript:MARK()'>x</a>",
    "<a href='data:text/html,<script>MARK()</script>'>x</a>",
    "<style>body { background: url(https://example.com/MARK) }</style>",
    "<div style='position: fixed; background: url(https://example.com/MARK)'>x</div>",
    "<link rel=stylesheet href='https://example.com/MARK.css'><meta http-equiv=refresh content='0; url=MARK'>",
    "<form action='https://example.com/MARK'><input name=MARK><button>Points</button></form>",
    r"$\href{javascript:MARK()}{x} \require{MARK} \style{background: url(MARK)}{y}$",
    "<math><mtext><script>MARK()</script></mtext></math>",
    "<base href='https://example.com/MARK'>",
    "</div></body><script>MARK()</script>",
]


FORBIDDEN = {"script", "iframe", "object", "embed", "svg", "style", "link", "meta", "form", "base", "button"}


@pytest.mark.parametrize("attack", ATTACKS)
def test_nothing_that_acts_is_left(attack):
    for tag, attributes in Parsed(markdown(attack)).tags:
        assert tag not in FORBIDDEN
        assert not [name for name in attributes if name.startswith("on")]
        assert "MARK" not in attributes.get("style", "")
        assert not attributes.get("src") or attributes["src"].startswith("data:image/")
        assert not attributes.get("href", "").lower().replace("\n", "").startswith(("javascript", "data"))
    assert "\\href" not in markdown(attack) and "\\require" not in markdown(attack)


@pytest.mark.parametrize(
    "text, shown",
    [
        ("> a quote", "<blockquote>"),
        ("`a < b` and a & b", "<code>a &lt; b</code> and a &amp; b"),
        ("$T_1 < T_2$", "<msub><mi>T</mi><mn>1</mn></msub><mo>&lt;</mo>"),
        ("$$\\sqrt{2}$$", '<math display="block"><mrow><msqrt>'),
        ("$x_1_2$ & $x^2$", "<code>x_1_2</code> &amp; <math"),
        (f"${'x' * 3000}$", "<code>xxx"),
        ("# What $x$ is", 'is<a class="anchor-link"'),
        ("![hand](attachment:gone.png)", "<p>hand</p>"),
        ("| a | b |\n|---|---|\n| 1 | 2 |", "<td>1</td>"),
        ("<details><summary>s</summary>t</details>", "<details><summary>s</summary>t</details>"),
        ("[ROS](https://www.ros.org)", 'href="https://www.ros.org"'),
        ("# Title", "<h1"),
        ("```python\nx = 1\n```", "<pre>"),
    ],
)
def test_what_is_only_text_stays(text, shown):
    assert shown in markdown(text)


def test_pictures_attached_to_the_cell_stay():
    assert "data:image/png" in markdown("![hand](attachment:hand.png)", attachments={"hand.png": {"image/png": PIXEL}})
    svg = {"x.svg": {"image/svg+xml": base64.b64encode(b"<svg onload='MARK()'/>").decode()}}
    assert "svg" not in markdown("![hand](attachment:x.svg)", attachments=svg)


def test_a_page_of_feedback_holds_nothing_of_it(course, hand_in, solved, sandboxed):
    """Markdown, raw cells, attachments and outputs, through the real nbgrader."""
    notebook = nbformat.read(solved[ONE], as_version=4)
    for attack in ATTACKS:
        notebook.cells.append(nbformat.v4.new_markdown_cell(attack))
        notebook.cells.append(nbformat.v4.new_raw_cell(attack, metadata={"raw_mimetype": "text/html"}))
        notebook.cells.append(
            nbformat.v4.new_code_cell(
                f"from IPython.display import HTML, Latex, Markdown, display\nattack = {attack!r}\n"
                "display(HTML(attack)); display(Markdown(attack)); display(Latex(attack)); print(attack)\n"
                "display({'image/svg+xml': attack, 'application/javascript': 'MARK()'}, raw=True)"
            )
        )
    hand_in(course, "eve", {ONE: notebook})
    hand_in(course, "honest", {ONE: solved[ONE]})
    code, said = run(course, "grade")
    assert code == 0, said
    graded = nbformat.read(course.autograded("eve") / f"{ONE}.ipynb", as_version=4)
    assert {cell.cell_type for cell in graded.cells} == {"code", "markdown"}  # nbconvert shows raw cells unfiltered
    pages = [Parsed((course.feedback(name) / f"{ONE}.html").read_text()).tags for name in ("eve", "honest")]
    active, expected = [[tag for tag in page if tag[0] in FORBIDDEN] for page in pages]
    assert active == expected and {tag for tag, _ in active} == {"meta", "style"}  # the page's own
    for tag, attributes in pages[0]:
        address = attributes.pop("href", "#")  # waits until it is followed; to other pages of the feedback, or away
        assert address.startswith(("https:", "#")) or re.fullmatch(r"\w+\.html", address), address
        assert "MARK" not in "".join(value or "" for value in attributes.values())
