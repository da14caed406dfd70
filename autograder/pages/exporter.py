"""nbgrader's feedback pages: small, and with nothing in them that acts or loads.

nbgrader_config.py names the exporter here, and the step before it.
"""

import copy
import re
from pathlib import Path

import nbformat
from nbconvert.exporters import HTMLExporter, TemplateExporter
from nbconvert.filters import Highlight2HTML
from nbconvert.filters.widgetsdatatypefilter import WidgetsDataTypeFilter
from nbgrader.preprocessors import GetGrades

from ..grading.judge import opinion
from ..grading.records import RECORD, verdicts
from . import examples
from .bounded import LEFT_OUT as LEFT_OUT
from .bounded import bared, is_test, shortened
from .rendering import points

TEMPLATE = Path(__file__).parent / "templates" / "feedback.html.j2"
LARGEST_PAGE = 280_000  # bytes; five of them and the summary stay below 1.5 MB
SHOWN = (150_000, 50_000, 10_000, 0)  # bytes of a student's own cells to try, until the page is small enough
NAMELESS, NO_NAME = re.compile(r"<img (?![^>]*\balt=)"), "No description has been provided for this image"


class FetchGrades(GetGrades):
    """nbgrader's step that fetches points and comments; it learns besides which points nobody has given yet."""

    def _get_score(self, cell, resources):
        super()._get_score(cell, resources)
        mark = cell.metadata.nbgrader
        found = self.gradebook.find_grade(mark.grade_id, self.notebook_id, self.assignment_id, self.student_id)
        mark.waiting = found.needs_manual_grade


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

    def from_notebook_node(self, nb, resources=None, **kwargs):
        nb = copy.deepcopy(nb)
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
        self.register_filter("highlight_code", Highlight2HTML(pygments_lexer=lexer, parent=self))
        outputs = WidgetsDataTypeFilter(notebook_metadata=self._nb_metadata, parent=self, resources=made)
        self.register_filter("filter_data_type", outputs)
        page, made = TemplateExporter.from_notebook_node(self, nb, made, **kwargs)
        return NAMELESS.sub(f'<img alt="{NO_NAME}" ', page), made

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
                shown = {"text/html": examples.of_answer(name, found[name])}
            except Exception as error:  # a damaged record, or an answer that cannot be drawn
                self.log.warning("%s: its record is damaged, so no example is shown (%r)", name, error)
                continue
            position = len(cell.outputs) - 1  # the last one says the points
            cell.outputs.insert(position, {"output_type": "display_data", "data": shown, "metadata": {}})


class BareFeedback(Feedback):
    """As Feedback, of the verdicts alone: for a notebook of which a page takes too much time or memory.

    A class of its own, because nbgrader takes settings of "Feedback" for old ones of its command.
    """

    bare = True
