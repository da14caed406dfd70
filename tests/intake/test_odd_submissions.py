"""What real classes hand in besides clean notebooks: nothing of it stops the others, and both ways of grading agree."""

import os
import shutil
import subprocess
import sys

import nbformat
import pytest
from support import marks, points, run, scores, statuses

from autograder.bridge.gradebook import Writer
from autograder.grading import classroom
from autograder.grading.classroom import grade_class
from autograder.grading.grade import grade_submission, grading_run
from autograder.intake.submission import receipts, submission_of
from autograder.sandbox import Limits

ONE = "1_rotation"


def with_cell(path, source):
    """A notebook with one more cell at its end."""
    notebook = nbformat.read(path, as_version=4)
    notebook.cells.append(nbformat.v4.new_code_cell(source))
    return notebook


@pytest.fixture
def odd(course, hand_in, solved):
    """A class in which each student has handed in something odd beside, or in, a solved first notebook."""
    plain = {ONE: solved[ONE]}
    for student in ("subfolder", "shadow", "large", "many", "latin", "plain"):
        hand_in(course, student, plain)
    (course.submitted("subfolder") / "pictures").mkdir()
    (course.submitted("subfolder") / "pictures" / "hand.txt").write_text("x")
    (course.submitted("shadow") / "numpy.py").write_text("raise SystemExit")
    for name in ("a.bin", "b.bin"):
        (course.submitted("large") / name).write_bytes(bytes(3_000_000))
    for number in range(250):
        (course.submitted("many") / f"0_{number}.txt").write_text("x")
    (course.submitted("latin") / os.fsdecode(b"Aufgabe\xfc.txt")).write_text("x")
    hand_in(course, "helper", {ONE: with_cell(solved[ONE], "import mine; print(mine.answer)")})
    (course.submitted("helper") / "mine.py").write_text("answer = 'from the helper'")
    hand_in(course, "surrogate", {ONE: with_cell(solved[ONE], "print('\\ud83d')\nraise ValueError('\\ud800')")})
    hand_in(
        course,
        "in the source",
        {ONE: nbformat.writes(with_cell(solved[ONE], "x = 'MARK'")).replace("MARK", "\\ud83d").encode()},
    )
    hand_in(course, "bom", {ONE: b"\xef\xbb\xbf" + solved[ONE].read_bytes()})
    hand_in(course, "[red]markup", plain)
    hand_in(course, "linked", {})
    (course.submitted("linked") / f"{ONE}.ipynb").symlink_to(course.submitted("plain") / f"{ONE}.ipynb")
    return course


def test_everybody_is_graded_and_both_ways_agree(odd, tmp_path, sandboxed, nbgrader):
    from autograder.course import Course

    other = Course(shutil.copytree(odd.root, tmp_path / "other", symlinks=True))
    code, said = run(odd, "grade", "--no-feedback")
    assert code == 0, said
    everybody = odd.students()
    assert len(everybody) == 12
    for student in everybody:
        assert sum(scores(odd, student).values()) == (0 if student == "linked" else points(ONE)), student
    assert "large: b.bin: left out; besides notebooks, 200 files of 4 MB in all are taken." in said
    assert "left out; it is a link" in said
    assert "[red]markup " in said  # the table shows names as they are
    assert statuses(odd, "linked")["is_rotation"] == "unreadable"
    text = (odd.autograded("helper") / f"{ONE}.ipynb").read_text()
    assert "from the helper\\n" in text
    page = (odd.reports / "index.html").read_text()
    assert "1_rotation.ipynb: left out; it is a link." in page

    result = nbgrader(other, "autograde", "transforms")
    assert result.returncode == 0, result.stderr[-2000:]
    ours = {cell: mark for cell, mark in marks(odd).items() if cell[0] != "[red]markup"}  # no name for nbgrader
    assert marks(other) == ours


def test_a_timestamp_that_is_no_date_is_said(course, hand_in, solved, sandboxed):
    hand_in(course, "ann", {ONE: solved[ONE]})
    (course.submitted("ann") / "timestamp.txt").write_text("last tuesday-ish")
    code, said = run(course, "grade", "--no-feedback")
    assert code == 0 and "ann: timestamp.txt: 'last tuesday-ish' is no date" in said
    (course.submitted("ann") / "timestamp.txt").write_text("2020-11-20 10:00:00 UTC")
    code, said = run(course, "grade", "--no-feedback")
    assert code == 0 and "1 graded" in said
    with Writer(course) as writer:
        assert str(writer.gradebook.find_submission("transforms", "ann").timestamp) == "2020-11-20 10:00:00"


TIMES = {
    "2020-11-20 10:00:00.000000 UTC": None,
    "2020-11-20T10:00:00+14:00": None,
    "": None,
    "2222-11-20 10:00:00.000000 UTC": "is still to come",
    "9999-12-31 23:59:59 -1200": "is still to come",
    "0001-01-01 00:00:00": "is no date",
    "0001-01-01 00:00:00+14:00": "is no date",
    "99999-01-01": "is no date",
    "1" * 101: "is no date",
}


@pytest.mark.parametrize("said", TIMES, ids=lambda text: text[:30])
def test_a_timestamp_is_believed_when_it_can_be(tmp_path, said):
    (tmp_path / "timestamp.txt").write_text(said)
    known, problem = receipts(tmp_path)
    if TIMES[said]:
        assert not known and f"{TIMES[said]}; graded as if there were none." in problem
    else:
        assert problem is None and known == ({"timestamp.txt": said} if said else {})


def test_files_in_the_wrong_folder_are_said(course, hand_in, solved, sandboxed):
    hand_in(course, "ann", {ONE: solved[ONE]})
    (course.root / "submitted" / "bob").mkdir()
    shutil.copy(solved[ONE], course.root / "submitted" / "bob")
    code, said = run(course, "grade", "--no-feedback")
    assert "bob: not graded: its files have to be in submitted/bob/transforms/." in said
    code, said = run(course, "demo")
    assert code == 2 and "real submissions" in said


def test_a_withdrawn_submission_keeps_no_feedback(course, hand_in, solved, sandboxed):
    hand_in(course, "ann", {ONE: solved[ONE]})
    assert run(course, "grade")[0] == 0
    assert list(course.feedback("ann").glob("*.html"))
    (course.submitted("ann") / f"{ONE}.ipynb").unlink()
    assert run(course, "grade")[0] == 0
    assert [page.name for page in course.feedback("ann").glob("*.html")] == ["index.html"]
    assert set(statuses(course, "ann").values()) == {"missing"}


def test_marks_that_were_not_written_are_written_next_time(course, hand_in, solved, sandboxed, monkeypatch):
    """The grader stops between a student's files and marks: the next run does not take the student for graded."""
    hand_in(course, "ann", {ONE: solved[ONE]})
    against = grading_run(course, seed=1)

    def interrupted(self, graded):
        self.gradebook.update_or_create_student(graded.student)
        self.gradebook.update_or_create_submission("transforms", graded.student)
        raise KeyboardInterrupt

    with Writer(course) as writer:
        with monkeypatch.context() as patched:
            patched.setattr(Writer, "_write_marks", interrupted)
            with pytest.raises(KeyboardInterrupt):
                writer.record(grade_submission(submission_of(course, "ann"), against))
        ((student, graded, problem),) = grade_class(course, ["ann"], against, writer, jobs=1)
    assert graded is not None and problem is None
    assert f"ann,{points(ONE)}" in run(course, "export")[1]


def test_a_worker_that_dies_costs_only_its_own_submission(course, hand_in, solved, sandboxed, monkeypatch):
    for student in ("ann", "bad", "cid", "dan"):
        hand_in(course, student, {ONE: solved[ONE]})
    grade = classroom.grade_submission

    def killed(submission, against):
        if submission.student == "bad":
            os.kill(os.getpid(), 9)
        return grade(submission, against)

    monkeypatch.setattr(classroom, "grade_submission", killed)
    with Writer(course) as writer:
        found = {
            student: (graded, problem)
            for student, graded, problem in grade_class(
                course, course.students(), grading_run(course, 1), writer, jobs=2
            )
        }
    bad, problem = found["bad"]
    assert problem is None and "is there enough memory?" in bad.problems[0]
    assert {row.status for row in bad.rows if row.notebook == ONE} == {"killed"} and not any(r.score for r in bad.rows)
    for student in ("ann", "cid", "dan"):
        assert found[student][1] is None
        assert sum(row.score for row in found[student][0].rows) == points(ONE)


def test_a_slow_notebook_costs_itself_alone(course, hand_in, solved, sandboxed):
    notebook = nbformat.read(solved[ONE], as_version=4)
    notebook.cells.insert(1, nbformat.v4.new_code_cell("import time\ntime.sleep(60)"))
    hand_in(course, "ann", {**solved, ONE: notebook})
    against = grading_run(course, seed=1, limits=Limits(notebook=15, cell=60, grace=1))
    graded = grade_submission(submission_of(course, "ann"), against)
    earned = {row.exercise: (row.score, row.status) for row in graded.rows}
    assert earned["rotation_about_z"] == (0.0, "timeout")
    assert sum(row.score for row in graded.rows if row.notebook != ONE) == points() - points(ONE)


def test_a_damaged_gradebook_is_said(course, hand_in, solved, sandboxed):
    hand_in(course, "ann", {ONE: solved[ONE]})
    course.gradebook.write_bytes(b"no database" * 1000)
    code, said = run(course, "grade")
    assert code == 2 and "The gradebook cannot be read" in said and "move it away" in said


def test_a_damaged_record_counts_as_not_graded(course, hand_in, solved, sandboxed):
    damaged = {"ann": {"statuses": {}}, "bob": [], "cid": {"rows": [1]}, "dan": {"rows": []}}
    for student in (*damaged, "eve"):
        hand_in(course, student, {ONE: solved[ONE]})
    assert run(course, "grade", "--no-feedback")[0] == 0
    for student, damage in damaged.items():
        path = course.autograded(student) / f"{ONE}.ipynb"
        notebook = nbformat.read(path, as_version=4)
        notebook.metadata["transform_lab"] = damage
        nbformat.write(notebook, path)
    assert run(course, "report")[0] == 0
    code, said = run(course, "grade", "--no-feedback")
    assert code == 0 and "4 graded" in said and "1 unchanged" in said


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["grade", "--jobs", "0"], "invalid positive number value: '0'"),
        (["grade", "--seed", "-1"], "invalid whole number value: '-1'"),
        (["grade", "--no-such-option"], "unrecognized arguments: --no-such-option"),
        (["export", "--output", "nowhere/points.csv"], "nowhere/points.csv: not written; there is no folder nowhere."),
    ],
)
def test_options_that_make_no_sense(course, arguments, words):
    code, said = run(course, *arguments)
    assert code == 2 and words in said


def test_options_of_other_programs_are_passed_on(course, slow):
    code, said = run(course, "test", "--version")
    assert code == 0 and said.startswith("pytest ")
    code, said = run(course, "lab", "--version")
    assert code == 0 and said.strip().startswith("4.")


def test_a_course_that_notebooks_could_read_is_refused(course, hand_in, solved, sandboxed, tmp_path):
    """A virtual environment made in the course's root would take the whole course into the sandbox."""
    hand_in(course, "ann", {ONE: solved[ONE]})
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", "--system-site-packages", course.root], check=True)
    code = "import sys; sys.path.insert(0, '.'); from autograder import sandbox; print(sandbox.exposes('.'))"
    inside = subprocess.run(
        [course.root / "bin" / "python", "-c", code], cwd=course.root, capture_output=True, text=True
    )
    outside = subprocess.run([sys.executable, "-c", code], cwd=course.root, capture_output=True, text=True)
    assert (inside.stdout.strip(), outside.stdout.strip()) in (("True", "False"), ("", "False")), inside.stderr
