"""A new term begins with an empty course, and nothing of the old one is lost, whenever the command is stopped."""

import shutil
from pathlib import Path

import pytest
from support import run

from autograder.bridge import term
from autograder.bridge.gradebook import Writer
from autograder.bridge.settings import settings
from autograder.course import CourseError

WORK = {
    "submitted/alice/transforms/1_rotation.ipynb": "hers",
    "autograded/alice/transforms/1_rotation.ipynb": "graded",
    "feedback/alice/transforms/index.html": "told",
    "reports/transforms/verdicts.csv": "all",
    "downloaded/transforms/archive/all.zip": "as it came",
}


@pytest.fixture
def worked(course):
    """A course with something in each folder."""
    for path, text in WORK.items():
        (course.root / path).parent.mkdir(parents=True, exist_ok=True)
        (course.root / path).write_text(text)
    with Writer(course):
        pass  # makes the gradebook
    return course


def kept(course, name="transforms"):
    folder = course.root / "archive" / name
    there = {path: (folder / path).read_text() for path in WORK if (folder / path).is_file()}
    return there == WORK and (folder / "gradebook.db").is_file()


def called(course):
    return settings(course).CourseDirectory.course_id


def test_the_old_term_is_put_away_and_the_new_one_begins_empty(worked):
    code, said = run(worked, "term", "transforms-2027")
    assert code == 0 and kept(worked) and called(worked) == "transforms-2027"
    assert "archive/transforms/" in said and "nbgrader db student import" in said and "--duedate" in said
    assert not any((worked.root / name).exists() for name in term.ARCHIVED)
    with Writer(worked) as writer:
        assert not writer.students()
    code, said = run(worked, "term", "transforms-2027")
    assert code == 2 and "already" in said
    assert run(worked, "term", "transforms-2028")[0] == 0 and called(worked) == "transforms-2028"
    assert (worked.root / "archive" / "transforms-2027" / "gradebook.db").is_file() and kept(worked)


@pytest.mark.parametrize("steps", range(8))
def test_one_that_was_stopped_is_gone_on_with(worked, steps, monkeypatch):
    left, rename = [None] * steps, Path.rename

    def stopped(path, target):
        if not left:
            raise KeyboardInterrupt
        left.pop()
        return rename(path, target)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "rename", stopped)
        patched.setattr(term, "replace", lambda *_: stopped(worked.root, worked.root))
        try:
            term.begin(worked, "next", print)
        except KeyboardInterrupt:
            pass
    if called(worked) == "transforms":
        term.begin(worked, "next", print)
    assert kept(worked) and called(worked) == "next"
    assert not list((worked.root / "archive").glob(".*"))


@pytest.mark.parametrize("name", ["", "a b", "../up", "-rf", "a/b", "ü", "x" * 65, "transforms"])
def test_what_can_be_no_new_name_is_refused_before_anything_is_moved(worked, name):
    with pytest.raises(CourseError):
        term.begin(worked, name, print)
    assert all((worked.root / path).read_text() == text for path, text in WORK.items())


def test_a_term_of_that_name_is_not_written_over(worked):
    (worked.root / "archive" / "transforms").mkdir(parents=True)
    with pytest.raises(CourseError, match="archive/transforms already"):
        term.begin(worked, "next", print)
    assert called(worked) == "transforms" and (worked.root / "gradebook.db").is_file()


@pytest.mark.parametrize("lines", ["", 'c.CourseDirectory.course_id = "a"\nc.CourseDirectory.course_id = "b"\n'])
def test_a_configuration_that_names_no_course_or_two_is_left_alone(worked, lines):
    path = worked.root / "nbgrader_config.py"
    text = term.CONFIGURED.sub("", path.read_text()) + lines
    path.write_text(text)
    with pytest.raises(CourseError, match="course_id"):
        term.begin(worked, "next", print)
    assert path.read_text() == text and (worked.root / "gradebook.db").is_file()


def test_a_gradebook_elsewhere_with_work_in_it_is_not_taken_along(worked, tmp_path):
    shutil.move(worked.root / "gradebook.db", tmp_path / "elsewhere.db")
    with open(worked.root / "nbgrader_config.py", "a", encoding="utf-8") as file:
        file.write(f'\nc.CourseDirectory.db_url = "sqlite:///{tmp_path}/elsewhere.db"\n')
    with Writer(worked) as writer:
        writer.gradebook.update_or_create_student("alice")
        writer.gradebook.update_or_create_submission("transforms", "alice")
    with pytest.raises(CourseError, match="holds 1 submissions"):
        term.begin(worked, "next", print)
    assert all((worked.root / path).is_file() for path in WORK)
    with Writer(worked) as writer:
        writer.gradebook.remove_student("alice")
    term.begin(worked, "next", print)
    assert called(worked) == "next"
