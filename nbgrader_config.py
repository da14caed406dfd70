"""nbgrader's settings for this course: `nbgrader autograde` and the formgrader grade through our plug-in."""

import sys
import warnings
from pathlib import Path

from sqlalchemy.exc import SAWarning

ROOT = str(Path(__file__).resolve().parent)
if ROOT not in sys.path:
    sys.path.insert(0, ROOT)

# nbgrader was written for an older SQLAlchemy, which warns of the way it adds submissions; the result is right.
warnings.filterwarnings("ignore", category=SAWarning, module=r"nbgrader\.api")

c = get_config()  # noqa: F821 (nbgrader provides it)

c.CourseDirectory.root = ROOT
c.CourseDirectory.release_directory = "notebooks"
# What the course is called in nbgrader's exchange, which refuses a course without a name; another one for each year keeps
# their submissions apart. Students need the same name in their configuration; where the exchange lies is the machine's.
c.CourseDirectory.course_id = "transforms"

# Submitted notebooks are mended on the way in, so that a broken one stops neither its student's others nor the batch.
c.Autograde.exporter_class = "autograder.bridge.plugin.Exporter"
c.Autograde.sanitize_preprocessors = [
    "nbgrader.preprocessors.OverwriteCells",
    "nbgrader.preprocessors.CheckCellMetadata",
]
# In place of nbgrader's Execute, our judge: a sandbox for the notebook, verdicts from outside its process.
c.Autograde.autograde_preprocessors = [
    "autograder.bridge.plugin.Judge",
    "nbgrader.preprocessors.LimitOutput",
    "nbgrader.preprocessors.SaveAutoGrades",
    "nbgrader.preprocessors.AssignLatePenalties",
    "nbgrader.preprocessors.CheckCellMetadata",
]
# What students write is shown in feedback and formgrader without scripts and without anything from elsewhere.
# It cannot look like, cover or move what the grader says, and takes no longer than its size allows.
c.HTMLExporter.filters = {
    "markdown2html": "autograder.pages.markdown.markdown2html",
    "strip_files_prefix": "autograder.pages.markdown.as_it_is",
}
c.HTMLExporter.preprocessors = ["autograder.pages.bounded.Bounded"]
c.HTMLExporter.template_file = f"{ROOT}/autograder/pages/templates/formgrade.html.j2"
# Students write into the exchange: what they put there counts as theirs alone, neither fetches files of the instructor's nor
# stops the others.
c.ExchangeFactory.release_assignment = "autograder.intake.exchange.ReleaseAssignment"
c.ExchangeFactory.collect = "autograder.intake.exchange.Collect"
c.ExchangeFactory.release_feedback = "autograder.intake.exchange.ReleaseFeedback"
# `nbgrader zip_collect` knows the downloads of learning management systems.
c.ZipCollectApp.collector_plugin = "autograder.collecting.zip_collect.Collector"
# Feedback pages that need no network, say a mistake in numbers and frames, and stay small.
c.GenerateFeedback.exporter_class = "autograder.pages.exporter.Feedback"
c.GenerateFeedback.preprocessors = [
    "autograder.pages.exporter.FetchGrades",
    "nbconvert.preprocessors.CSSHTMLHeaderPreprocessor",
]
