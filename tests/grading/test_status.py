"""A status is known to the one list and seen wherever verdicts are: none is dropped, and none that is not there is taken."""

import json
from concurrent.futures import Future

import nbformat
import pytest
from rich.console import Console
from support import ASKED, NAMES, verdicts
from transform_lab.judging.status import STATUSES, Status
from transform_lab.judging.verdict import Verdict

from autograder import commands
from autograder.bridge.gradebook import Writer
from autograder.grading import classroom, grade, records
from autograder.grading.judge import Row
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


@pytest.fixture
def added(monkeypatch):
    """A status that nothing but its entry in the list knows."""
    monkeypatch.setitem(STATUSES, ADDED, Status("The student took it back."))


class Here:
    """Grades in this process, where a test's own status is known."""

    ahead = 1

    def __init__(self, run, jobs):
        self.run = run

    def submit(self, submission):
        done = Future()
        done.set_result(grade.grade_submission(submission, self.run))
        return done

    def close(self):
        """There is nothing to close."""


@pytest.fixture
def graded(course, solved, hand_in, monkeypatch, capsys):
    """graded(status): (a course in which all of a student's first notebook got it, what `grade` printed)."""

    def make(status):
        def restore(content, released):
            intake = real(content, released)
            intake.statuses = dict.fromkeys(released.points, status)
            return intake

        real = grade.restore
        monkeypatch.setattr(grade, "restore", restore)
        monkeypatch.setattr(grade, "key", lambda exercise, seed: {})  # no case is ever called
        monkeypatch.setattr(classroom, "Processes", Here)
        monkeypatch.setattr(commands, "console", Console(width=400, highlight=False, soft_wrap=True))
        hand_in(course, "ann", {NOTEBOOK: solved[NOTEBOOK]})
        assert commands._grade(course, ["ann"], protected=False, jobs=1, with_feedback=False) == []
        return course, capsys.readouterr().out

    return make


@pytest.mark.parametrize("status", [*STATUSES, ADDED])
def test_every_status_is_seen_in_all_that_grading_makes(status, added, graded):
    course, said = graded(status)
    assert {row["status"] for row in verdicts(course) if row["notebook"] == NOTEBOOK} == {status}
    if status != "graded":
        count = len(NAMES if status == "missing" else ASKED[NOTEBOOK].points)  # the other notebooks are missing
        assert f", {count} {status}" in said and f"{status} ({', '.join(ASKED[NOTEBOOK].points)}" in said
    page = (course.reports / "index.html").read_text(encoding="utf-8")
    counts = page.partition(f"<code>{EXERCISE}</code>")[2].partition("</tr>")[0].split('<td class="number')[2:]
    column = STATUSES[status].counts
    assert [cell.partition(">")[2].partition("<")[0] for cell in counts] == ["01"[name == column] for name in COLUMNS]
    if title := STATUSES[status].look:
        section = page.partition(f"<h3>{title}: 1 student</h3>")[2].partition("<h3>")[0]
        assert STATUSES[status].means in section and f"<code>{EXERCISE}</code>" in section
    with Writer(course) as writer:
        assert STATUSES[status].means in feedback.summary(course, "ann", writer.grades()["ann"])
    (path,) = course.autograded("ann").glob("*.ipynb")
    opinions = [
        cell.outputs[0].data["text/html"] for cell in nbformat.read(path, as_version=4).cells if cell.get("outputs")
    ]
    assert len(opinions) == len(ASKED[NOTEBOOK].points)
    assert all(STATUSES[status].means in opinion for opinion in opinions)


@pytest.mark.parametrize("status", [*STATUSES, ADDED])
def test_every_status_is_counted_once_and_said_in_exports(status, added):
    row = Row(NOTEBOOK, EXERCISE, 0.0, 2.0, status)
    ((result,),) = results({"ann": Work([row])}).values()
    assert sum((result.right, result.named, result.unnamed, result.failed, result.undone)) == 1
    assert export._said(row) == f"{EXERCISE} 0 of 2{'' if status == 'graded' else f' ({status})'}"


def test_records_without_words_say_what_the_status_means(added):
    """A look is asked for, too, where an exercise of this status counts as not done."""
    STATUSES[ADDED] = Status("The student took it back.", counts="undone")
    found = look({"ann": Work([Row(NOTEBOOK, EXERCISE, 0.0, 2.0, ADDED)])})
    assert found.reasons == {"Could not be judged": {"ann": {f"status {ADDED}: The student took it back.": [EXERCISE]}}}


def test_each_says_what_it_means_and_how_it_counts():
    assert set(CONTRACT) <= set(STATUSES)
    assert all(name.isidentifier() and status.means.endswith(".") for name, status in STATUSES.items())
    with pytest.raises(ValueError, match="'lost' is no column of the report"):
        Status("It was lost.", counts="lost")


@pytest.mark.parametrize("make", [lambda status: Row("1", "x", 0.0, 2.0, status), lambda status: Verdict("x", status)])
@pytest.mark.parametrize("status", [ADDED, "", "Graded", None])
def test_a_status_that_is_not_in_the_list_is_refused_where_it_is_made(make, status):
    with pytest.raises(ValueError, match="is no status; there are graded, timeout, killed, error, missing, unreadable"):
        make(status)


@pytest.mark.parametrize("status", [ADDED, ["graded"], None])
def test_a_record_with_an_unknown_status_counts_as_not_graded(status, graded):
    course, _ = graded("graded")
    (path,) = course.autograded("ann").glob("*.ipynb")
    assert list(records.recorded(course, "ann")) == [NOTEBOOK]
    notebook = json.loads(path.read_text(encoding="utf-8"))
    notebook["metadata"]["transform_lab"]["rows"][1]["status"] = status
    path.write_text(json.dumps(notebook), encoding="utf-8")
    assert records.recorded(course, "ann") == {}
