"""nbgrader's pages (feedback, formgrader) as they are safe to open: small, and with nothing in them that acts or loads.

nbgrader_config.py names the Markdown filter and the exporter of feedback pages here.
"""

import copy
import html
import re
from functools import cache
from pathlib import Path

import jinja2
import nbformat
import nh3
from jinja2 import pass_context
from latex2mathml import converter
from markupsafe import Markup
from nbconvert.exporters import HTMLExporter
from nbconvert.filters.markdown_mistune import InvalidNotebook, IPythonRenderer, MarkdownWithMath
from nbgrader.preprocessors import GetGrades
from nbgrader.utils import is_grade
from transform_lab.judging import panel

from . import public_example
from .grading import RECORD
from .outputs import calm

TEMPLATE = Path(__file__).parent / "templates" / "feedback.html.j2"

# --- students' Markdown: as they wrote it, without what could act on the reader ------------------------------------------

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


# --- feedback pages -----------------------------------------------------------------------------------------------------

LARGEST_PAGE = 280_000  # bytes; five of them and the summary stay below 1.5 MB
SHOWN = (150_000, 50_000, 10_000, 0)  # bytes of a student's own cells to try, until the page is small enough
TAKES = {"code": 5, "markdown": 2}  # bytes of the page for each byte of a cell's source: colours, formulas
LEFT_OUT = "[not shown here, or this page would be too large; it is in the notebook that you handed in]"
NOTE = nbformat.v4.new_output("stream", text=LEFT_OUT)


def points(number):
    """Points as they are said: 2, 1.33."""
    return f"{round(number, 2):g}"


@cache
def environment():
    """Jinja, as the pages that we make without nbgrader use it."""
    made = jinja2.Environment(
        loader=jinja2.PackageLoader("autograder"), autoescape=True, trim_blocks=True, lstrip_blocks=True
    )
    made.filters["points"] = points
    made.filters["with_code"] = lambda sentence: Markup(panel.with_code(sentence))
    made.filters["inline"] = lambda text: Markup(heading(text)[1])
    made.filters["time"] = lambda time: time.astimezone().strftime("%Y-%m-%d %H:%M %Z")
    return made


@cache
def heading(text):
    """A heading as the notebook's page has it: the id to jump to, and its text as HTML."""
    made = markdown2html({}, f"# {text}")
    found = re.fullmatch(r'<h1 id="(.*?)">(.*)<a .*</h1>\s*', made, re.DOTALL)
    return (html.unescape(found[1]), found[2]) if found else ("", html.escape(text))


class Grades(GetGrades):
    """nbgrader's step that fetches points and comments; it learns besides which points nobody has given yet."""

    def _get_score(self, cell, resources):
        super()._get_score(cell, resources)
        mark = cell.metadata.nbgrader
        found = self.gradebook.find_grade(mark.grade_id, self.notebook_id, self.assignment_id, self.student_id)
        mark.waiting = found.needs_manual_grade


class Feedback(HTMLExporter):
    """Makes a feedback page for `nbgrader generate_feedback`, and so for ours."""

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.template_paths = [*self.template_paths, str(TEMPLATE.parent)]
        self.template_file = TEMPLATE.name
        self.register_filter("points", points)

    def from_notebook_node(self, nb, resources=None, **kwargs):
        nb = copy.deepcopy(nb)
        self._add_examples(nb)
        for budget in SHOWN:
            page, made = super().from_notebook_node(shortened(nb, budget), copy.deepcopy(resources), **kwargs)
            if len(page.encode()) <= LARGEST_PAGE:
                return page, made
        nb.cells = [cell for cell in nb.cells if "nbgrader" in cell.metadata]  # thousands of cells of their own
        return super().from_notebook_node(shortened(nb, 0), resources, **kwargs)

    def _add_examples(self, nb):
        """After the verdict on an exercise, its mistake in numbers and as a picture, of a case that is no secret."""
        examples = nb.metadata.get(RECORD, {}).get("examples", {})
        for cell in nb.cells:
            name = cell.metadata.get("nbgrader", {}).get("grade_id")
            if name not in examples or not is_grade(cell) or cell.cell_type != "code":
                continue
            try:
                shown = {"text/html": public_example.html(name, examples[name])}
            except (AttributeError, LookupError, TypeError, ValueError) as error:
                self.log.warning("%s: its record is damaged, so no example is shown (%r)", name, error)
                continue
            position = len(cell.outputs) - 1  # the last one says the points
            cell.outputs.insert(position, {"output_type": "display_data", "data": shown, "metadata": {}})


def shortened(nb, budget):
    """A copy of the notebook in which what a student wrote and displayed takes about `budget` bytes of the page.

    From the top, all that still fits is kept. The verdicts are not touched.
    """
    nb, left = copy.deepcopy(nb), budget

    def fits(text, weight=1):
        nonlocal left
        size = weight * len(html.escape(text).encode())
        if size > left:
            return False
        left -= size
        return True

    for cell in nb.cells:
        if not fits(cell.source, TAKES[cell.cell_type]):
            cell.source = LEFT_OUT
        attachments = cell.get("attachments", {})
        cell.attachments = {name: data for name, data in attachments.items() if fits("".join(map(str, data.values())))}
        if cell.cell_type == "code" and not is_grade(cell):
            cell.outputs = [output if fits(_text(output)) else NOTE for output in cell.outputs]
    return nb


def _text(output):
    """All that an output shows, as one text."""
    parts = [output.get("text", ""), *output.get("traceback", ()), *output.get("data", {}).values()]
    return "".join(map(str, parts))
