"""Markdown as it is safe to open in feedback and formgrader: as students wrote it, without what could act on the reader.

nbgrader_config.py names the filter here.
"""

import html
import re
from functools import cache

import nh3
from jinja2 import pass_context
from latex2mathml import converter
from nbconvert.filters.markdown_mistune import InvalidNotebook, IPythonRenderer, MarkdownWithMath

from ..untrusted import calm

PICTURES = ("data:image/png;base64,", "data:image/jpeg;base64,", "data:image/gif;base64,")  # attached to a cell
LONGEST_FORMULA = 2_000  # characters
XMLNS = (
    ' xmlns="http://www.w3.org/1998/Math/MathML"'  # HTML needs none, and nbconvert's anchors take it amiss in headings
)
MATHML = {
    "math": {"display"},
    "mi": {"mathvariant"},
    "mo": {"stretchy", "fence", "form"},
    "mover": {"accent"},
    "mspace": {"width"},
    "mtable": {"columnalign"},
    "mtd": {"columnalign"},
    "mstyle": {"displaystyle", "scriptlevel"},
    **dict.fromkeys("mn mtext mrow mfrac msqrt mroot msub msup msubsup munder munderover mtr".split(), set()),
}
ATTRIBUTES = {
    **{tag: {"id", "class"} for tag in ("h1", "h2", "h3", "h4", "h5", "h6", "span", "div", "code", "pre")},
    "a": {"href", "class", "id"},
    "img": {"src", "alt", "width", "height"},
    "th": {"align", "style"},
    "td": {"align", "style"},
    "details": {"open"},
    "input": {"checked"},  # of a list of tasks
    **MATHML,
}


@pass_context
def markdown2html(context, source):
    """nbconvert's filter of that name, with a page as its result that holds nothing from elsewhere and no script."""
    renderer = Renderer(escape=False, attachments=context.get("cell", {}).get("attachments", {}))
    return nh3.clean(
        MarkdownWithMath(renderer=renderer).render(calm(source)),
        tags=nh3.ALLOWED_TAGS | {"details", "summary", "input"} | MATHML.keys(),
        attributes=ATTRIBUTES,
        attribute_filter=_attribute,
        set_tag_attribute_values={"input": {"type": "checkbox", "disabled": ""}},
        filter_style_properties={"text-align"},
        url_schemes={"http", "https", "mailto", "data"},
    )


class Renderer(IPythonRenderer):
    """Formulas become MathML, which browsers typeset by themselves: no script, and no address to load one from."""

    def inline_math(self, body):
        return _mathml(body, "inline")

    def block_math(self, body):
        return _mathml(body, "block")

    def image(self, text, url, title=None):
        try:
            return super().image(text, url, title)
        except InvalidNotebook:  # it is attached no more
            return html.escape(text)

    def latex_environment(self, name, body):
        return _mathml(f"\\begin{{{name}}}{body}\\end{{{name}}}", "block")


def _mathml(formula, display):
    """LaTeX as MathML; what cannot be converted stays as it was written."""
    try:
        if len(formula) <= LONGEST_FORMULA:
            return converter.convert(formula, display=display).replace(XMLNS, "")
    except Exception:  # the converter raises what it happens to meet in a formula that is none
        pass
    return f"<code>{html.escape(formula)}</code>"


def _address(value):
    """Links to other notebooks lead to their pages; other files of the assignment do not lie beside these."""
    if value.startswith("#") or re.match(r"(https?|mailto):", value, re.IGNORECASE):
        return value
    page, _, place = value.partition(".ipynb")
    return (
        f"{page}.html{place}"
        if re.fullmatch(r"\w+", page) and re.fullmatch(r"(#.*)?", place) and page != value
        else None
    )


def _attribute(tag, name, value):
    """Pictures are those of the cell itself; links lead where they say; a space in a formula is no wider than the page."""
    if name == "src":
        return value if value.startswith(PICTURES) else None
    if name == "href":
        return _address(value)
    if (tag, name) == ("mspace", "width"):
        return value if re.fullmatch(r"-?\d?(\.\d+)?em", value) else None
    return value


@cache
def heading(text):
    """A heading as the notebook's page has it: the id to jump to, and its text as HTML."""
    made = markdown2html({}, f"# {text}")
    found = re.fullmatch(r'<h1 id="(.*?)">(.*)<a .*</h1>\s*', made, re.DOTALL)
    return (html.unescape(found[1]), found[2]) if found else ("", html.escape(text))
