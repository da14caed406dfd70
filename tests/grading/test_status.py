"""A status is known to the one list and seen wherever verdicts are: none is dropped, and none that is not there is taken."""

import copy
import io
import json
import re
import shutil
from collections import Counter

import nbformat
import pytest
from rich.console import Console
from support import ASKED, NAMES, verdicts
from transform_lab.judging.status import STATUSES, Status
from transform_lab.judging.verdict import Verdict

from autograder import commands
from autograder.bridge.gradebook import Writer
from autograder.course import Course
from autograder.grading import classroom, grade, records
from autograder.grading.judge import Row
from autograder.intake.restore import Intake
from autograder.pages import export, feedback
from autograder.pages.report_data import Work, look, results

ADDED = "added_by_a_test"
NOTEBOOK, EXERCISE = next(iter(ASKED)), NAMES[0]
COLUMNS = ("right", "named", "unnamed", "failed", "undone")  # of "Each exercise", after the average
CONTRACT = (
    "graded",
    "missing",
    "error",
    "timeout",
    "killed",
    "unreadable",
)  # as scripts that read verdicts.csv know them


every_status = pytest.mark.parametrize("status", [*STATUSES, ADDED])


@pytest.fixture(scope="module")
def added():
    """A status that nothing but its entry in the list knows."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(STATUSES, ADDED, Status("The student took it back."))
        yield


class Here:
    """Works in this process, where a test's own status is known."""

    def __init__(self, function, jobs):
        self.function = function

    def each(self, items):
        for item in items:
            yield item, self.function(item)


@pytest.fixture(scope="module")
def graded(released, tmp_path_factory, added):
    """(course, what `grade` printed): a student for each status, named after it; all of their one notebook got it."""

    def with_status(content, released):
        return Intake(copy.deepcopy(released.notebook), dict.fromkeys(released.points, content.decode()))

    course = Course(shutil.copytree(released.root, tmp_path_factory.mktemp("statuses") / "course"))
    for status in STATUSES:
        course.submitted(status).mkdir(parents=True)
        (course.submitted(status) / f"{NOTEBOOK}.ipynb").write_text(status)
    printed = io.StringIO()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(grade, "restore", with_status)
        patch.setattr(grade, "key", lambda *_, **__: {})  # no case is ever called
        patch.setattr(classroom, "Processes", Here)
        patch.setattr(commands, "console", Console(file=printed, width=1000, highlight=False, soft_wrap=True))
        failed = commands._grade(course, list(STATUSES), protected=False, jobs=1, with_feedback=False)
    assert not failed
    return course, printed.getvalue()


@every_status
def test_commands_and_verdicts_have_it(status, graded):
    course, said = graded
    assert {row["status"] for row in verdicts(course) if (row["student"], row["notebook"]) == (status, NOTEBOOK)} == {
        status
    }
    (line,) = (line for line in said.splitlines() if re.match(rf"{status} +\d", line))
    if status != "graded":
        assert f"{status} ({', '.join(ASKED[NOTEBOOK].points)}" in line
        others = len(NAMES) - len(ASKED[NOTEBOOK].points)  # which nobody handed in
        count = len(ASKED[NOTEBOOK].points) + (status == "missing") * len(STATUSES) * others
        assert f", {count} {status}" in said


@every_status
def test_the_report_lists_who_has_it_under_its_title(status, graded):
    course, _ = graded
    page = (course.reports / "index.html").read_text(encoding="utf-8")
    title = STATUSES[status].look
    sections = {
        found[1]: found[2] for found in re.finditer(r"<h3>([^<]*): \d+ students?</h3>(.*?)(?=<h[23])", page, re.DOTALL)
    }
    named = [title for title, section in sections.items() if f'<th scope="row">{status}</th>' in section]
    assert named == ([title] if title else [])
    if title:
        (row,) = re.findall(rf'<th scope="row">{status}</th>(.*?)</tr>', sections[title], re.DOTALL)
        assert STATUSES[status].means in row and all(f"<code>{name}</code>" in row for name in ASKED[NOTEBOOK].points)


def test_the_report_counts_each_once(graded):
    course, _ = graded
    page = (course.reports / "index.html").read_text(encoding="utf-8")
    row = page.partition(f"<code>{EXERCISE}</code></th>")[2].partition("</tr>")[0]
    counts = re.findall(r'<td class="number[^>]*>(\d+)</td>', row)
    columns = Counter(status.counts for status in STATUSES.values())
    assert counts == [str(columns[name]) for name in COLUMNS]


@every_status
def test_the_student_reads_what_it_means(status, graded):
    course, _ = graded
    with Writer(course) as writer:
        assert STATUSES[status].means in feedback.summary(course, status, writer.grades()[status])
    (path,) = course.autograded(status).glob("*.ipynb")
    tested = [cell for cell in nbformat.read(path, as_version=4).cells if cell.get("outputs")]
    assert len(tested) == len(ASKED[NOTEBOOK].points)
    assert all(STATUSES[status].means in cell.outputs[0].data["text/html"] for cell in tested)


@every_status
def test_every_status_is_counted_once_and_said_in_exports(status, added):
    row = Row(NOTEBOOK, EXERCISE, 0.0, 2.0, status)
    ((result,),) = results({"ann": Work([row])}).values()
    assert sum((result.right, result.named, result.unnamed, result.failed, result.undone)) == 1
    assert export._said(row, row.remark) == f"{EXERCISE} 0 of 2{'' if status == 'graded' else f' ({status})'}"


def test_records_without_words_say_what_the_status_means(added, monkeypatch):
    """A look is asked for, too, where an exercise of this status counts as not done."""
    monkeypatch.setitem(STATUSES, ADDED, Status("The student took it back.", counts="undone"))
    found = look({"ann": Work([Row(NOTEBOOK, EXERCISE, 0.0, 2.0, ADDED)])})
    assert found.reasons == {"Could not be judged": {"ann": {f"status {ADDED}: The student took it back.": [EXERCISE]}}}


def test_each_says_what_it_means_and_how_it_counts():
    assert set(CONTRACT) <= set(STATUSES)
    assert all(name.isidentifier() and status.means.endswith(".") for name, status in STATUSES.items())
    with pytest.raises(ValueError, match="'lost' is no column of the report"):
        Status("It was lost.", counts="lost")


@pytest.mark.parametrize("make", [lambda status: Row("1", "x", 0.0, 2.0, status), lambda status: Verdict("x", status)])
@pytest.mark.parametrize("status", ["lost", "", "Graded", None])
def test_a_status_that_is_not_in_the_list_is_refused_where_it_is_made(make, status):
    with pytest.raises(ValueError, match="is no status; there are graded, timeout, killed, error, missing, unreadable"):
        make(status)


@pytest.mark.parametrize("unknown", ["lost", ["graded"], None])
def test_a_record_with_an_unknown_status_counts_as_not_graded(unknown, graded, tmp_path):
    course = Course(shutil.copytree(graded[0].root, tmp_path / "course"))
    (path,) = course.autograded("graded").glob("*.ipynb")
    assert list(records.recorded(course, "graded")) == [NOTEBOOK]
    notebook = json.loads(path.read_text(encoding="utf-8"))
    notebook["metadata"]["transform_lab"]["rows"][1]["status"] = unknown
    path.write_text(json.dumps(notebook), encoding="utf-8")
    assert records.recorded(course, "graded") == {}
