"""nbgrader's feedback pages: small, and with nothing in them that acts or loads.

nbgrader_config.py names the exporter here, and the step before it.
"""

import contextlib
import copy
import hashlib
import html
import json
import os
import re
from functools import cache, partial
from pathlib import Path

import nbformat
from jinja2 import pass_context
from nbconvert.exporters import HTMLExporter, TemplateExporter
from nbconvert.filters.highlight import _pygments_highlight
from nbconvert.filters.widgetsdatatypefilter import WidgetsDataTypeFilter
from nbgrader.api import Gradebook, Notebook, SubmittedAssignment
from nbgrader.preprocessors import NbGraderPreprocessor
from nbgrader.utils import is_grade, is_solution, is_task
from pygments.formatters import HtmlFormatter

from ..bridge.gradebook import grades as grades_in
from ..grading.judge import opinion
from ..grading.records import RECORD, verdicts
from . import examples
from .bounded import LEFT_OUT as LEFT_OUT
from .bounded import Bounded, bared, is_test, shortened
from .rendering import points

TEMPLATE = Path(__file__).parent / "templates" / "feedback.html.j2"
LARGEST_PAGE = 280_000  # bytes; five of them and the summary stay below 1.5 MB
SHOWN = (150_000, 50_000, 10_000, 0)  # bytes of a student's own cells to try, until the page is small enough
MOST_KEPT = 30_000_000  # characters of cells' pages that are kept for the next notebooks
NAMELESS, NO_NAME = re.compile(r"<img (?![^>]*\balt=)"), "No description has been provided for this image"


class FetchGrades(NbGraderPreprocessor):
    """In the place of nbgrader's step that fetches points and comments: it tells besides which points nobody has given yet,
    and asks the gradebook once for a notebook, or not at all where our own command has the grades already.
    """

    def preprocess(self, nb, resources):
        told = resources["nbgrader"]
        grades = told.get("grades") or self._asked(told)
        for cell in nb.cells:
            mark = cell.metadata.get("nbgrader")
            if is_solution(cell) or is_task(cell):
                mark.comment = grades.comments.get(mark.grade_id)
            if is_grade(cell) or is_task(cell):
                found = grades.cells[mark.grade_id]
                mark.score, mark.points, mark.waiting = found.earned, found.most, found.waiting
        told["score"] = sum(found.earned for found in grades.cells.values()) - grades.penalty
        told["max_score"] = sum(found.most for found in grades.cells.values())
        told["late_penalty"] = grades.penalty
        return nb, resources

    def _asked(self, names):
        """The NotebookGrades of a notebook in nbgrader's own command."""
        student, notebook = names["student"], names["notebook"]
        with Gradebook(names["db_url"]) as gradebook:
            return grades_in(gradebook, SubmittedAssignment.student_id == student, Notebook.name == notebook)[student][
                notebook
            ]


class Pieces:
    """Texts that were made of other texts, and take about as long to make as the page: the class's cells are mostly the same.

    folder: where the processes of a run leave them to each other
    """

    def __init__(self, folder=None):
        self.folder, self.known, self.size, self.left = folder, {}, 0, 0

    def get(self, text):
        """What was made of this text, or None where this process does not know."""
        return self.known.get(_digest(text))

    def of(self, text, make):
        """What `make()` makes of this text, and of nothing else."""
        digest = _digest(text)
        if digest not in self.known:
            made = self._found(digest)
            if made is None:
                made = make()
                self._leave(digest, made)
            if self.size + len(made) > MOST_KEPT:
                self.known, self.size = {}, 0
            self.known[digest] = made
            self.size += len(made)
            return made
        return self.known[digest]

    def _found(self, digest):
        """What another process has made, or None."""
        if self.folder:
            with contextlib.suppress(OSError):
                return (self.folder / digest).read_bytes().decode("utf-8", "surrogatepass")
        return None

    def _leave(self, digest, made):
        if self.folder and self.left + len(made) <= MOST_KEPT:
            self.left += len(made)
            with contextlib.suppress(OSError):
                fresh = self.folder / f"{digest}.{os.getpid()}"
                fresh.write_bytes(made.encode("utf-8", "surrogatepass"))
                fresh.rename(self.folder / digest)


def _digest(text):
    return hashlib.sha256(text.encode()).hexdigest()


class Owned(nbformat.NotebookNode):
    """A notebook that is nobody else's, so that it need not be copied before it is changed; nbconvert does that, too."""

    def __deepcopy__(self, _):
        return self


@cache
def _formatter(lexer):
    return HtmlFormatter(cssclass=html.escape(f" highlight hl-{lexer}"))


class Feedback(HTMLExporter):
    """Makes a feedback page for `nbgrader generate_feedback`, and so for ours.

    There is a page whatever the student's notebook holds: where one cannot be made of it, the verdicts alone.
    """

    bare = False  # whether to leave out from the start what the student wrote and displayed

    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.template_paths = [*self.template_paths, str(TEMPLATE.parent)]
        self.template_file = TEMPLATE.name
        self.register_filter("points", points)
        self._markdown = self.environment.filters["markdown2html"]
        self.register_filter("markdown2html", self._marked_down)
        self.environment.globals.update(known=self._known, once=self._once)
        self.pieces = Pieces()

    def _init_preprocessors(self):
        super()._init_preprocessors()
        self._preprocessors = [step for step in self._preprocessors if not isinstance(step, Bounded)]  # see `_whole`

    def from_file(self, file_stream, resources=None, **kwargs):
        """As nbconvert's, but for the validation, which takes as long as the page; the grader has written this file."""
        return self.from_notebook_node(Owned(nbformat.v4.reads(file_stream.read())), resources, **kwargs)

    def from_notebook_node(self, nb, resources=None, **kwargs):
        if not isinstance(nb, Owned):
            nb = nbformat.from_dict(nb)  # a copy
        self._word_anew(nb)
        if not self.bare:
            try:
                return self._whole(nb, resources, **kwargs)
            except Exception as error:  # whatever is in the notebook
                reason = f"{type(error).__name__}: {error}"[:200]
            self.log.error(
                "%s: no page could be made of the notebook, so it holds the verdicts alone (%s)",
                *((resources or {}).get("nbgrader", {}).get("notebook", "a notebook"), reason),
            )
        return self._page(shortened(bared(nb), SHOWN[0]), resources, **kwargs)

    def _whole(self, nb, resources, **kwargs):
        """The page with as much of the student's own cells as keeps it small."""
        self._add_examples(nb)
        for budget in SHOWN:
            page, made = self._page(shortened(nb, budget), copy.deepcopy(resources), **kwargs)
            if len(page.encode()) <= LARGEST_PAGE:
                break
        return page, made

    def _page(self, nb, resources, **kwargs):
        """As HTMLExporter makes it, but for its last step, which takes half the time: it parses the whole page once more to
        give pictures an alternative text, and to make parts focusable that a template of classic form has not.
        """
        made, language = self._init_resources(resources), nb.metadata.get("language_info", {})
        lexer = language.get("pygments_lexer", language.get("name"))
        self.register_filter("highlight_code", partial(self._coloured, lexer or "ipython3"))
        outputs = WidgetsDataTypeFilter(notebook_metadata=self._nb_metadata, parent=self, resources=made)
        self.register_filter("filter_data_type", outputs)
        nb.metadata.pop(RECORD, None)  # the cells have what is shown of it
        self._about = nb.metadata
        page, made = TemplateExporter.from_notebook_node(self, Owned(nb), made, **kwargs)
        self._nb_metadata.clear()  # one page after the other is made
        return NAMELESS.sub(f'<img alt="{NO_NAME}" ', page), made

    def _preprocess(self, nb, resources):
        """The steps alone: this `nb` is nobody else's, and need not be validated after each of them."""
        for step in self._preprocessors:
            nb, resources = step(nb, resources)
        return nb, resources

    def _coloured(self, lexer, source, metadata):
        """Code as nbconvert's Highlight2HTML colours it; to make the formatter takes as long as to colour a cell."""
        told = {"magics_language": metadata["magics_language"]} if "magics_language" in metadata else {}
        return self.pieces.of(
            json.dumps(["code", lexer, told, source]),
            lambda: _pygments_highlight(source or " ", _formatter(lexer), lexer, told),
        )

    @pass_context
    def _marked_down(self, context, source):
        """Markdown as the filter in the course's settings has it."""
        about = ["markdown", context.get("cell", {}).get("attachments", {}), source]
        return self.pieces.of(json.dumps(about), lambda: self._markdown(context, source))

    def _known(self, cells):
        """[(cell, its piece of the page, or None where that is not made yet)]"""
        return [(cell, self.pieces.get(self._all_of(cell))) for cell in cells]

    def _once(self, cell, caller):
        """What the template's `caller` makes of a cell; of one that is the same in all it is made once."""
        return self.pieces.of(self._all_of(cell), caller)

    def _all_of(self, cell):
        return json.dumps([self._about, cell])

    def _word_anew(self, nb):
        """The verdicts in today's words; the notebook has those of the day it was graded."""
        found = verdicts(nb.metadata.get(RECORD, {}))
        for cell in nb.cells:
            name = cell.metadata.get("nbgrader", {}).get("grade_id")
            if name in found and is_test(cell) and cell.outputs:
                cell.outputs[0] = nbformat.from_dict(opinion(found[name]))

    def _add_examples(self, nb):
        """After the verdict on an exercise, its mistake in numbers and as a picture, of a case that is no secret."""
        found = nb.metadata.get(RECORD, {}).get("examples", {})
        for cell in nb.cells:
            name = cell.metadata.get("nbgrader", {}).get("grade_id")
            if name not in found or not is_test(cell) or not cell.outputs:
                continue
            try:
                text = found[name]
                made = self.pieces.of(json.dumps(["example", name, text]), lambda: examples.of_answer(name, text))
            except Exception as error:  # a damaged record, or an answer that cannot be drawn
                self.log.warning("%s: its record is damaged, so no example is shown (%r)", name, error)
                continue
            position = len(cell.outputs) - 1  # the last one says the points
            cell.outputs.insert(position, nbformat.v4.new_output("display_data", {"text/html": made}))


class BareFeedback(Feedback):
    """As Feedback, of the verdicts alone: for a notebook of which a page takes too much time or memory.

    A class of its own, because nbgrader takes settings of "Feedback" for old ones of its command.
    """

    bare = True
