"""Whatever students write or display: it is shown or said not to be, and costs in proportion to its length."""

import html
import json

import nbformat
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from latex2mathml import converter
from support import Parsed, markdown

from autograder import untrusted
from autograder.pages import bounded
from autograder.pages import markdown as pages_markdown
from autograder.untrusted import calm, clean, safe, terminal

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(st.characters(), max_size=40),
    lambda inside: st.lists(inside, max_size=4) | st.dictionaries(st.text(max_size=8), inside, max_size=4),
    max_leaves=20,
)
MIMES = st.sampled_from([*untrusted.TEXT, *untrusted.PICTURES, "text/html", "image/svg+xml", "application/javascript"])
HTML_BITS = st.sampled_from(
    [
        "<b>",
        "</b>",
        "<b title=1>",
        "<p>",
        "</p>",
        "x",
        "&",
        "<",
        "<table>",
        "<td>",
        "<li>",
        "<!--",
        "é",
        "\ud800",
        "\x1b[1m",
    ]
)
OUTPUTS = st.fixed_dictionaries(
    {"output_type": st.sampled_from(["stream", "error", "display_data", "execute_result", "update"])},
    optional={
        "name": JSON, "text": JSON, "ename": JSON, "evalue": JSON, "traceback": JSON, "execution_count": JSON,
        "data": JSON | st.dictionaries(MIMES, JSON | st.lists(HTML_BITS, max_size=60).map("".join), max_size=4),
    },
)  # fmt: skip


def size(value):
    if isinstance(value, dict):
        return sum(size(key) + size(item) for key, item in value.items())
    return sum(map(size, value)) if isinstance(value, list) else len(str(value))


@settings(max_examples=400, deadline=None)
@given(JSON | OUTPUTS)
def test_any_json_becomes_an_output_of_its_size_or_none(output):
    made = safe(output)
    if made is None:
        return
    cell = nbformat.v4.new_code_cell("", outputs=[nbformat.from_dict(made)])
    nbformat.validate(nbformat.v4.new_notebook(cells=[cell]))
    json.dumps(made, ensure_ascii=False).encode("utf-8")
    assert size(made) <= untrusted.GROWS * size(output) + 100


@pytest.mark.parametrize("count", [-1, 10**9, 1.0, True, "1", None])
def test_what_counts_no_runs_is_left_out(count):
    made = safe({"output_type": "execute_result", "data": {"text/plain": "0"}, "execution_count": count})
    assert made["execution_count"] is None
    assert safe({**made, "execution_count": 7})["execution_count"] == 7


@pytest.mark.parametrize(
    "output",
    [
        {"output_type": "stream", "text": 10**5000},
        {"output_type": "error", "ename": {}, "evalue": 10**5000, "traceback": [1, None]},
        {"output_type": "display_data", "data": {"image/png": "é"}},
        {"output_type": "display_data", "data": {"text/html": "&#" + "1" * 9000 + ";"}},
        {"output_type": ["stream"]},
        [],
    ],
)
def test_what_is_no_output_raises_nothing(output):
    made = safe(output)
    assert made is None or made["output_type"] == output["output_type"]


@pytest.mark.parametrize(
    "text, calmed",
    [
        ("javascript:x", "javascript x"),
        ("JaVa\nScript:x", "javascript x"),
        ("&#106;avascript:x", "javascript x"),
        ("&#x000000000006A;avascript&colon;x", "javascript x"),
        ("java&Tab;script&#58;x", "javascript x"),
        (r"\href{a}{b} \htmlClass{x} \cssId{y}", "href{a}{b} htmlClass{x} cssId{y}"),
        (r"\\href{a}{b}", "href{a}{b}"),  # not the half of it, which would make a command of what was none
        (r"\hrefs JavaScript: the good parts &amp;#106;", r"\hrefs javascript  the good parts &amp;#106;"),
        ("&#" + "1" * 9000 + ";", "&#" + "1" * 9000 + ";"),
        ("&" + "amp;" * 9000, "&" + "amp;" * 9000),
    ],
)
def test_what_is_calmed(text, calmed):
    assert calm(text) == calmed == calm(calmed)


@pytest.mark.parametrize("inside", ["", "<!-- -->", "<script></script>", "&Tab;", "&NewLine;"])
@pytest.mark.parametrize("mime", ["text/html", "text/markdown"])
def test_no_link_of_an_output_runs_a_script_wherever_it_is_opened(mime, inside):
    data = safe({"output_type": "display_data", "data": {mime: f"[x](java{inside}&#115;cript:MARK) ![y](//a.b)"}})[
        "data"
    ]
    assert "javascript:" not in "".join(html.unescape(data[mime]).split()).lower()
    assert mime == "text/html" or "![" not in data[mime]
    assert safe({"output_type": "display_data", "data": {"text/markdown": "!<!-- -->[x](//a)"}})["data"] == {
        "text/markdown": "[x](//a)"
    }


def test_references_of_thousands_of_digits_and_nested_ones_are_shown():
    """The verdict on the notebook and its page are not to be lost over one."""
    digits, nested = "&#" + "1" * 5000 + ";", "&" + "amp;" * 4000 + "#106;avascript:"
    for source in (digits, nested, f"[a]({digits})", f"[a]({nested})", f"<b title='{digits}'>x</b>"):
        assert markdown(source)
        output = safe({"output_type": "display_data", "data": {"text/html": source, "text/markdown": source}})
        assert output["data"]


def test_elements_that_a_parser_repeats_are_not_given_to_it(monkeypatch):
    many = "<p>" + "".join(f"<b title={k}>" for k in range(400)) + "<p>x" * 1000
    given = []
    monkeypatch.setattr(untrusted.nh3, "clean", lambda text, **rules: given.append(text) or text)
    assert clean(many) is None and given == []
    assert clean("<b title=1>x</b>" * 100) is not None and len(given) == 1
    output = safe({"output_type": "display_data", "data": {"text/html": many}})
    assert output["data"] == {"text/plain": many} and len(given) == 1  # as text


def test_what_grows_or_is_too_deep_is_shown_as_it_was_written():
    assert clean("<p>" + "<b><i><u><s><code><em><small>" * 3 + "<p>x" * 200) is None
    assert clean("<div>" * 90) == "<div>" * 90 + "</div>" * 90
    assert clean("<div>" * 200 + "<br>") is None
    assert clean("<br>" * 200) is not None
    shown = markdown("<div>" * 200)
    assert shown == f"<pre>{html.escape('<div>' * 200)}</pre>"


@pytest.mark.parametrize(
    "source",
    [
        "a" * (pages_markdown.LONGEST + 1),
        "a" + " " * 600 + "b",
        "[a]: https://example.com/" + "b" * 3000 + "\n\n" + "[a] " * 500,
    ],
)
def test_markdown_out_of_proportion_is_shown_as_it_was_written(source):
    assert markdown(source) == f"<pre>{html.escape(source)}</pre>"


def test_a_long_cell_of_little_text_and_a_large_picture_is_markdown():
    assert markdown(f"# Mine\n\n![x](data:image/png;base64,{'A' * 50_000})").count("<img") == 1


def test_an_attached_picture_is_shown_once():
    """Or a cell of n bytes would ask for n pictures of n bytes."""
    made = markdown("![x](attachment:a.png)\n" * 300, attachments={"a.png": {"image/png": "A" * 10_000}})
    assert made.count("<img") == 1 and made.count("x") >= 300


def test_formulas_that_reach_the_converter_are_short_and_flat(monkeypatch):
    given = []
    monkeypatch.setattr(converter, "convert", lambda formula, display: given.append(formula) or "<math></math>")
    kept = r"\begin{matrix}" * 20 + r"\end{matrix}" * 20
    for formula in (
        "x" * 2001,
        "{" * 40 + "}" * 40,
        r"\begin{matrix}" * 40 + r"\end{matrix}" * 40,
        r"\left(" * 40,
        kept,
    ):
        markdown(f"${formula}$")
        markdown(f"$${formula}$$")
    assert set(given) == {kept}


def test_the_search_for_a_formulas_end_is_bounded():
    for parser in (pages_markdown.BlockParser, pages_markdown.InlineParser):
        patterns = [pattern for name, pattern in parser.SPECIFICATION.items() if "math" in name or "latex" in name]
        assert patterns and not [pattern for pattern in patterns if ".*?" in pattern or ".+?" in pattern]


@pytest.mark.parametrize("language, coloured", [("python", True), ("perl", False), ("c++", False), ("", False)])
def test_only_the_lexers_of_the_course_are_used(language, coloured):
    assert ('class="highlight"' in markdown(f"```{language}\nx = 1\n```")) is coloured
    assert 'class="highlight"' not in markdown(f"```{language}\n{'a.' * 1000}\n```")


def test_a_terminals_text_keeps_few_colours_and_no_other_command():
    assert terminal("\x1b[1;31mred\x1b[0m\x1b[2Jx\x1b]0;title\x07\x1b[") == "\x1b[1;31mred\x1b[0mx]0;title\x07"
    assert terminal("\x1b[1m" * 2000 + "x") == "x"
    assert terminal("\x1b[" + ";" * 9000 + "mx") == "x"


# --- a page -----------------------------------------------------------------------------------------------------------

ANSWER = {"nbgrader": {"grade": True, "solution": True, "locked": False, "grade_id": "question", "points": 2}}
TEST = {"nbgrader": {"grade": True, "solution": False, "locked": True, "grade_id": "chain", "points": 2}}


def notebook(*cells):
    return nbformat.v4.new_notebook(cells=list(cells))


def test_what_is_asked_for_is_shown_before_what_a_student_adds():
    before = [nbformat.v4.new_markdown_cell("b" * 1000) for _ in range(500)]
    answer = nbformat.v4.new_markdown_cell("My answer. " * 100, metadata=ANSWER)
    made = bounded.shortened(notebook(*before, answer), 10_000)
    assert made.cells[-1].source == answer.source
    assert [cell.source for cell in made.cells].count(bounded.LEFT_OUT) == 1 and len(made.cells) < 20


def test_thousands_of_outputs_are_a_few_and_a_note():
    cell = nbformat.v4.new_code_cell("x", outputs=[nbformat.v4.new_output("stream", text="x")] * 5000)
    made = bounded.shortened(notebook(cell), 10_000)
    assert len(made.cells[0].outputs) < 50 and made.cells[0].outputs[-1] == bounded.NOTE


@pytest.mark.parametrize(
    "source, plain", [("x = 1", False), ("a." * 2000, True), ("%%perl\ns{}", True), ("  %%html\n<a>", True)]
)
def test_code_that_a_lexer_would_take_long_for_is_not_coloured(source, plain):
    (cell,) = bounded.shortened(notebook(nbformat.v4.new_code_cell(source)), 100_000).cells
    assert (cell.metadata.get("magics_language") == "text") is plain


def test_a_verdict_is_in_the_graders_order():
    """A student's error message stands in it."""
    says = "It raised ValueError: \u202eA" + "\u0301" * 50 + "\u2067"
    output = nbformat.v4.new_output("display_data", data={"text/html": says, "text/plain": says})
    made = bounded.shortened(notebook(nbformat.v4.new_code_cell("check()", metadata=TEST, outputs=[output])), 0)
    assert set(made.cells[0].outputs[0].data.values()) == {"It raised ValueError: A\u0301\u0301"}


def test_a_bare_page_has_the_graders_cells_alone():
    says = nbformat.v4.new_output("display_data", data={"text/plain": "chain: all right."})
    cells = [
        nbformat.v4.new_markdown_cell("MARK"),
        nbformat.v4.new_code_cell("MARK", outputs=[says]),
        nbformat.v4.new_markdown_cell("MARK", metadata=ANSWER, attachments={"MARK": {"image/png": ""}}),
        nbformat.v4.new_code_cell("check()", metadata=TEST, outputs=[says]),
    ]
    made = bounded.bared(notebook(*cells))
    assert "MARK" not in json.dumps(made) and len(made.cells) == 3
    assert made.cells[0].source == bounded.BARE and made.cells[2].outputs == [says]


# --- what looks like the grader ---------------------------------------------------------------------------------------

IMITATIONS = [
    '<div class="panel panel-primary nbgrader_cell said" id="chain" style="position:fixed;top:0">x</div>',
    '<span class="said pull-right n" style="margin:-99px">x</span>',
    '<h1 id="chain" class="said">x</h1><a id="top" name="top" class="said anchor-link">x</a>',
    "# chain",
    '<table class="said" style="position:absolute"><tr><td style="position:fixed;text-align:left" class="x">x</td></tr></table>',
    '<p class="said" id="chain" dir="rtl">x</p><input id="chain" class="score" type="number" value="2">',
    '<math class="said"><mstyle scriptlevel="-60" mathsize="900%"><mspace width="-99em"></mspace></mstyle></math>',
    "```python\nx = 1\n```",
]


@pytest.mark.parametrize("source", IMITATIONS)
def test_no_class_id_or_style_is_one_of_the_graders(source):
    for tag, attributes in Parsed(markdown(source)).tags:
        classes = set(attributes.get("class", "").split())
        assert not classes & {"said", "theirs", "panel", "panel-primary", "nbgrader_cell", "pull-right", "score", "x"}
        assert attributes.get("id", "user-content-").startswith("user-content-")
        assert attributes.get("style", "text-align:left").rstrip(";") == "text-align:left"
        assert not attributes.keys() & {"name", "dir", "value", "mathsize"}
        assert attributes.get("scriptlevel", "0") in ("0", "1", "2")
    data = safe({"output_type": "display_data", "data": {"text/html": f"{source} x"}})["data"]
    for _, attributes in Parsed(data["text/html"]).tags:
        assert not attributes.keys() & {"class", "id", "style", "name"}


def test_links_among_a_students_own_headings_still_lead_there():
    tags = Parsed(markdown("[there](#My-part) [other](2_homogeneous_transforms.ipynb#Part)\n\n# My part")).tags
    (identifier,) = [attributes["id"] for _, attributes in tags if "id" in attributes]
    links = [attributes["href"] for tag, attributes in tags if tag == "a"]
    assert f"#{identifier}" == links[0] == "#user-content-My-part" == links[2]
    assert links[1] == "2_homogeneous_transforms.html#user-content-Part"
