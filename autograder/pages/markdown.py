"""Markdown as it is safe to open in feedback and formgrader: as students wrote it, without what could act on the reader.

It cannot look like what the grader says either: no class but of coloured code, no id that is not marked as theirs, no style
but the alignment of a column. nbgrader_config.py names the filter here.
"""

import html
import itertools
import re
from functools import cache

import nh3
from jinja2 import pass_context
from latex2mathml import converter
from nbconvert.filters.markdown_mistune import (
    InvalidNotebook,
    IPythonRenderer,
    MarkdownWithMath,
    MathBlockParser,
    MathInlineParser,
)
from pygments.token import STANDARD_TYPES

from ..untrusted import calm, clean

PICTURES = ("data:image/png;base64,", "data:image/jpeg;base64,", "data:image/gif;base64,")  # attached to a cell
LONGEST = 20_000  # characters of a cell, pictures not counted; the longest that we give out has below 2,000
EMBEDDED = re.compile(r"data:image/\w+;base64,[\w+/=]+")
SPACES = " " * 500  # a row of them takes the parser the square of its length
# Times as long, and characters more, a page may be: what is defined once may be used in every line.
EXPANDS, MARGIN = 30, 2_000
LONGEST_FORMULA = 2_000  # characters
DEEPEST_FORMULA = 30  # parts of it inside each other
PART = re.compile(r"\\[{}]|(\{|\\begin\b|\\left\b)|(\}|\\end\b|\\right\b)")
LONGEST_LINE = 1_000  # characters of a line of code that is coloured
COLOURED = ("python", "python3", "py", "ipython", "ipython3")  # other languages' lexers can take any time
THEIRS = "user-content-"  # before each id, as code hosts have it
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
    **{f"h{level}": {"id"} for level in range(1, 7)},
    "a": {"href", "id"},
    "img": {"src", "alt", "width", "height"},
    "th": {"align", "style"},
    "td": {"align", "style"},
    "details": {"open"},
    "input": {"checked"},  # of a list of tasks
    **MATHML,
}
RULES = {
    "tags": nh3.ALLOWED_TAGS | {"details", "summary", "input"} | MATHML.keys(),
    "attributes": ATTRIBUTES,
    "allowed_classes": {"span": set(STANDARD_TYPES.values()), "div": {"highlight"}, "a": {"anchor-link"}},
    "set_tag_attribute_values": {"input": {"type": "checkbox", "disabled": ""}},
    "filter_style_properties": {"text-align"},
    "url_schemes": {"http", "https", "mailto", "data"},
    "id_prefix": THEIRS,
}


@pass_context
def markdown2html(context, source):
    """nbconvert's filter of that name, with a page as its result that holds nothing from elsewhere and no script.

    What would take a converter out of proportion to its length is shown as it was written.
    """
    if len(EMBEDDED.sub("", source)) <= LONGEST and SPACES not in source:
        renderer = Renderer(context.get("cell", {}).get("attachments", {}))
        parsers = {"block": BlockParser(), "inline": InlineParser(hard_wrap=False)}
        try:
            made = MarkdownWithMath(renderer, **parsers).render(calm(source))
        except Exception:  # the parser raises what it happens to meet, such as a reference of thousands of digits
            made = None
        if made is not None and len(made) <= EXPANDS * len(source) + MARGIN + renderer.embedded:
            if (cleaned := clean(made, attribute_filter=_attribute, **RULES)) is not None:
                return cleaned
    return f"<pre>{html.escape(source)}</pre>"


def as_it_is(text):
    """In place of nbconvert's strip_files_prefix, which takes the square of a line's length: `_address` leaves no such link."""
    return text


def _bounded(patterns):
    """Patterns of formulas which look for the end of one no further than that, and not through all the rest from each of them."""
    return {
        name: re.sub(r"\.([*+])\?", lambda found: f".{{{'*+'.index(found[1])},{2 * LONGEST_FORMULA}}}?", pattern)
        for name, pattern in patterns.items()
        if "math" in name or name == "latex_environment"
    }


class BlockParser(MathBlockParser):
    SPECIFICATION = MathBlockParser.SPECIFICATION | _bounded(MathBlockParser.SPECIFICATION)


class InlineParser(MathInlineParser):
    SPECIFICATION = MathInlineParser.SPECIFICATION | _bounded(MathInlineParser.SPECIFICATION)


class Renderer(IPythonRenderer):
    """Formulas become MathML, which browsers typeset by themselves: no script, and no address to load one from.

    attachments: {name: {type: data}} of the cell; embedded: characters of those that were shown
    """

    def __init__(self, attachments):
        super().__init__(escape=False, attachments=dict(attachments))
        self.embedded = 0

    def inline_math(self, body):
        return _mathml(body, "inline")

    def block_math(self, body):
        return _mathml(body, "block")

    def block_code(self, code, info=None):
        language = (info or "").split()[:1]
        return super().block_code(code, info if language and language[0] in COLOURED and is_short(code) else None)

    def image(self, text, url, title=None):
        """A picture that is attached to the cell, once: a large one could be asked for in every line."""
        try:
            made = super().image(text, url, title)
        except InvalidNotebook:  # it is attached no more
            return html.escape(text)
        if self.attachments.pop(url.removeprefix("attachment:"), None):
            self.embedded += len(made)
        return made

    def latex_environment(self, name, body):
        return _mathml(f"\\begin{{{name}}}{body}\\end{{{name}}}", "block")


def is_short(code):
    """Whether each line of code is short enough to be coloured; a lexer can take the square of a line's length, and more."""
    return max(map(len, code.split("\n"))) <= LONGEST_LINE


def _mathml(formula, display):
    """LaTeX as MathML; what cannot be converted stays as it was written."""
    try:
        if len(formula) <= LONGEST_FORMULA and _depth(formula) <= DEEPEST_FORMULA:
            return converter.convert(formula, display=display).replace(XMLNS, "")
    except Exception:  # the converter raises what it happens to meet in a formula that is none
        pass
    return f"<code>{html.escape(formula)}</code>"


def _depth(formula):
    """How deep the parts of a formula (groups, environments, brackets that grow) lie inside each other."""
    steps = (bool(found[1]) - bool(found[2]) for found in PART.finditer(formula))
    return max(itertools.accumulate(steps, initial=0))


def _address(value):
    """Links to other notebooks lead to their pages; other files of the assignment do not lie beside these."""
    if re.match(r"(https?|mailto):", value, re.IGNORECASE):
        return value
    page, _, place = value.partition(".ipynb")
    if value.startswith("#"):
        page, place = "", value
    elif re.fullmatch(r"\w+", page) and re.fullmatch(r"(#.*)?", place) and page != value:
        page = f"{page}.html"
    else:
        return None
    return page + (f"#{THEIRS}{place[1:]}" if place else "")


def _attribute(tag, name, value):
    """Pictures are those of the cell itself; links lead where they say; a space in a formula is no wider than the page."""
    if name == "src":
        return value if value.startswith(PICTURES) else None
    if name == "href":
        return _address(value)
    if (tag, name) == ("mspace", "width"):
        return value if re.fullmatch(r"-?\d?(\.\d+)?em", value) else None
    if (tag, name) == ("mstyle", "scriptlevel"):
        return value if value in ("0", "1", "2") else None
    return value


@cache
def heading(text):
    """A heading as the notebook's page has it: the id to jump to, and its text as HTML."""
    made = markdown2html({}, f"# {text}")
    found = re.fullmatch(r'<h1 id="(.*?)">(.*)<a .*</h1>\s*', made, re.DOTALL)
    return (html.unescape(found[1]), found[2]) if found else ("", html.escape(text))
