"""The grader's own work on a submission has limits, which another process keeps; nothing that is handed in stops the others."""

import os
import time
from functools import partial

import pytest
from nbgrader.api import InvalidEntry
from sqlalchemy.exc import OperationalError
from support import ASKED, points, run, scores, statuses, wait_for

from autograder.bridge.gradebook import Writer
from autograder.grading import classroom, workers
from autograder.grading.classroom import grade_class
from autograder.grading.failure import Failure
from autograder.grading.grade import grading_run
from autograder.grading.workers import DIED, Processes

ONE = "1_rotation"


def work(folder, item):
    """What a worker is asked for here: one thing of each kind."""
    if item == "endless":
        while True:
            pass
    if item == "much":
        kept = b"x" * 400_000_000
        time.sleep(60)  # takes no processor time, and is long enough to be seen
        return len(kept)
    if item == "gone":
        os._exit(1)
    if item == "gone once":
        try:
            (folder / "been").mkdir()
        except FileExistsError:
            return item
        os._exit(1)
    if item == "a bug":
        raise ValueError("no\nlines")
    if item == "no disk":
        raise OSError(28, "No space left on device")
    return item


@pytest.fixture
def done(tmp_path, monkeypatch):
    """{item: what came of it}, with limits that are soon reached."""
    monkeypatch.setattr(workers, "PROCESSOR", 0.5)
    monkeypatch.setattr(workers, "MEMORY", 200_000_000)

    def done(*items, jobs=2):
        return dict(Processes(partial(work, tmp_path), jobs).each(items))

    return done


def test_each_is_worked_on_once_and_who_is_over_a_limit_is_ended(done):
    items = ["endless", "a", "much", "b", "gone", "c", "gone once", "a bug", "no disk", *map(str, range(20))]
    found = done(*items)
    assert found.keys() == set(items)
    honest = {item: what for item, what in found.items() if not isinstance(what, Failure)}
    assert honest == {item: item for item in ("a", "b", "c", "gone once", *map(str, range(20)))}
    assert found["endless"] == Failure("the grader's own work on it took more than 0.5 s of processor time", True)
    assert "GB of memory" in found["much"].words and found["much"].of_content
    assert found["gone"] == DIED
    assert found["a bug"] == Failure("ValueError: no lines", True)
    assert not found["no disk"].of_content


def test_those_who_take_long_do_not_keep_the_others_waiting(tmp_path, monkeypatch):
    """With one process at a time, who waits for something is overtaken."""
    monkeypatch.setattr(workers, "SLOW", 0.1)

    def wait_for_the_last(item):
        while item == "first" and not (tmp_path / "last").exists():
            time.sleep(0.01)
        (tmp_path / item).touch()
        return item

    assert [item for item, _ in Processes(wait_for_the_last, 1).each(["first", "second", "last"])][-1] == "first"


def begun(folder, item):
    (folder / str(item)).touch()
    return item


def test_a_worker_has_its_next_while_what_came_of_the_last_is_recorded(tmp_path):
    for item, _ in Processes(partial(begun, tmp_path), 1).each([1, 2, 3]):
        wait_for(lambda item=item: item == 3 or (tmp_path / str(item + 1)).exists())


def test_no_worker_is_left(done):
    for _ in Processes(partial(work, None), 3).each("abcdef"):
        break
    children = os.listdir(f"/proc/{os.getpid()}/task/{os.getpid()}")
    assert "children" not in children or not workers.multiprocessing.active_children()


@pytest.mark.parametrize("what", ["endless", "much", "gone", "a bug"])
def test_what_cannot_be_judged_has_rows_a_page_and_a_line(what, course, hand_in, solved, sandboxed, monkeypatch):
    """Whatever goes wrong in reading or judging what was handed in."""
    monkeypatch.setattr(workers, "PROCESSOR", 3.0)
    monkeypatch.setattr(workers, "MEMORY", 400_000_000)
    for student in ("ann", "bad", "cid"):
        hand_in(course, student, {ONE: solved[ONE]})
    read = classroom.submission_of
    monkeypatch.setattr(
        classroom,
        "submission_of",
        lambda course, student: work(None, what) if student == "bad" else read(course, student),
    )
    with Writer(course) as writer:
        found = {
            student: rest
            for student, *rest in grade_class(course, course.students(), grading_run(course, 1), writer, jobs=2)
        }
    assert all(problem is None for _, problem in found.values())
    rows = [row for row in found["bad"][0].rows if row.notebook == ONE]
    assert {row.exercise: row.status for row in rows} == dict.fromkeys(ASKED[ONE].points, "killed")
    assert "it could not be judged" in found["bad"][0].problems[0]
    for student in ("ann", "cid"):
        assert sum(row.score for row in found[student][0].rows) == points(ONE)
    monkeypatch.undo()
    assert run(course, "grade", "bad")[0] == 0  # is tried again, since nobody has judged it yet
    assert sum(scores(course, "bad").values()) == points(ONE)


def test_what_the_database_lacks_is_no_fault_of_the_students(course, hand_in, solved, sandboxed, monkeypatch):
    """nbgrader raises its own error in place of the database's; the student is graded the next time."""
    hand_in(course, "ann", {ONE: solved[ONE]})
    attempts = []

    def full(self, graded):
        attempts.append(graded)
        try:
            raise OperationalError("INSERT", {}, Exception("database or disk is full"))
        except OperationalError as error:
            raise InvalidEntry(*error.args)  # noqa: B904 (as nbgrader does)

    with monkeypatch.context() as patched, Writer(course) as writer:
        patched.setattr(Writer, "record", full)
        ((_, graded, problem),) = grade_class(course, ["ann"], grading_run(course, 1), writer, jobs=1)
    assert graded is None and "full" in problem
    assert [sum(row.score for row in graded.rows) for graded in attempts] == [points(ONE)]


def test_a_notebook_that_the_grader_fails_on_costs_itself(course, hand_in, solved, sandboxed, monkeypatch):
    from autograder.grading import grade

    restore, two = grade.restore, "2_homogeneous_transforms"
    hand_in(course, "ann", {ONE: solved[ONE], two: solved[two]})

    def fails(content, released):
        if released.name == ONE:
            raise ValueError("a bug of the grader's")
        return restore(content, released)

    with monkeypatch.context() as patched, Writer(course) as writer:
        patched.setattr(grade, "restore", fails)
        ((_, graded, problem),) = grade_class(course, ["ann"], grading_run(course, 1), writer, jobs=1)
    assert problem is None and "ValueError: a bug of the grader's" in " ".join(graded.problems)
    assert run(course, "grade")[0] == 0  # unchanged; its pages are made
    assert {statuses(course, "ann")[name] for name in ASKED[ONE].points} == {"unreadable"}
    assert sum(scores(course, "ann").values()) == points(two)
    assert "could not be judged" in (course.feedback("ann") / "index.html").read_text()
