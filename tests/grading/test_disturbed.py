"""A class whose grading is disturbed again and again, and then left alone: it holds what one that was never disturbed holds."""

import os
import random
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from functools import cache

import pytest
from support import processes_in, run, wait_for

from autograder.course import Course
from autograder.grading import settled

SEED = "20170424"
ONE, TWO = "1_rotation", "2_homogeneous_transforms"
KILLS = 10
# What tells when something was graded: dates and times, and the digests of pages in which these are.
WHEN = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(?::\d\d(?:\+00:00)?)?|[0-9a-f]{64}")
TOOK = re.compile(r'"seconds": [\d.e-]+')
pytestmark = pytest.mark.usefixtures("sandboxed", "slow")


def class_of_three(course, hand_in):
    """One has done two notebooks, one has begun a notebook, and what the third has handed in cannot be read."""
    hand_in(course, "ann", {name: course.source / f"{name}.ipynb" for name in (ONE, TWO)})
    hand_in(course, "bob", {ONE: course.release / f"{ONE}.ipynb"})
    hand_in(course, "eve", {ONE: b"{", TWO: course.source / f"{TWO}.ipynb"})
    return course


def grade(*arguments):
    """The command of all runs."""
    return [sys.executable, "-m", "autograder", "grade", "--seed", SEED, *arguments]


def disturbed(course, *arguments, before=()):
    """Grade to the end, perhaps behind another command; (exit code, what was said)."""
    result = subprocess.run(
        [*before, *grade(*arguments)], cwd=course.root, capture_output=True, text=True, stdin=subprocess.DEVNULL
    )
    assert "Traceback" not in result.stdout + result.stderr
    return result.returncode, " ".join((result.stdout + result.stderr).split())


def files(course):
    """What the grader has written, {path: which file that is}: one that was replaced is another."""
    found = {}
    for name in ("autograded", "feedback", "reports"):
        for path in (course.root / name).rglob("*.*"):
            try:
                found[path] = path.stat().st_ino, path.stat().st_mtime_ns
            except FileNotFoundError:
                continue  # it was replaced just now
    return found


def kill_at(course, moment, delay):
    """Grade, and kill all processes of the grader's group when so many files are new; whether it was killed."""
    before = files(course)
    grader = subprocess.Popen(
        grade(), cwd=course.root, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, start_new_session=True
    )
    wait_for(lambda: len(files(course).items() - before.items()) >= moment or grader.poll() is not None)
    time.sleep(delay)
    os.killpg(grader.pid, signal.SIGKILL)
    killed = grader.wait() == -signal.SIGKILL
    wait_for(lambda: not processes_in(course.root))
    return killed


def full_disk(course):
    """Grade all again on a file system without room for all; what is there then is what the course has afterwards."""
    size = sum(path.stat().st_size for path in course.root.rglob("*") if path.is_file())
    script = (
        f"cp -r {course.root}/. /mnt/ && cd /mnt && dd if=/dev/zero of=/mnt/filling bs=1k 2>/dev/null\n"
        f"truncate -s -4k /mnt/filling\n{' '.join(grade('--force'))}; code=$?\n"
        f"rm /mnt/filling; rm -r {course.root}/*; cp -r /mnt/. {course.root}/; exit $code"
    )
    bwrap = ["bwrap", "--dev-bind", "/", "/", "--size", str(size + 4_000_000), "--tmpfs", "/mnt", "sh", "-c", script]
    result = subprocess.run(bwrap, capture_output=True, text=True, stdin=subprocess.DEVNULL, cwd=course.root.parent)
    assert "Traceback" not in result.stdout + result.stderr
    return result.returncode, " ".join((result.stdout + result.stderr).split())


def contents(gradebook):
    """{table: its rows, sorted} of a gradebook, what is drawn at random (ids) replaced by what it stands for."""
    database = sqlite3.connect(gradebook)
    database.row_factory = sqlite3.Row
    names = [name for (name,) in database.execute("select name from sqlite_master where type = 'table'")]
    tables = {name: [dict(row) for row in database.execute(f'select * from "{name}"')] for name in names}
    database.close()

    @cache
    def meant(value):
        return tuple(
            (name, told(row))
            for name, rows in tables.items()
            for row in rows
            if value is not None and row.get("id") == value
        )

    def told(row):
        known = {column: value for column, value in row.items() if column != "id"}
        return tuple((column, meant(value) or repr(value)) for column, value in known.items())

    return {name: sorted(map(repr, map(told, rows))) for name, rows in tables.items()}


def outcome(course):
    """All that came of grading a class, times aside: {what: content}."""
    found = dict(contents(course.gradebook))
    # The report compares with the grading before, if any; and the next run goes by how the files look.
    for name in ("before.csv", settled.KEPT):
        (course.reports / name).unlink(missing_ok=True)
    assert run(course, "report")[0] == 0
    for path in files(course):
        found[path.relative_to(course.root).as_posix()] = TOOK.sub("…", WHEN.sub("…", path.read_text()))
    return found


def test_a_class_that_was_disturbed_ends_as_one_that_was_not(released, hand_in, tmp_path):
    calm, class_ = (
        class_of_three(Course(shutil.copytree(released.root, tmp_path / name / "course")), hand_in)
        for name in ("calm", "class")
    )
    assert disturbed(calm)[0] == 0
    wanted = outcome(calm)
    assert {
        "autograded/ann/transforms/1_rotation.ipynb",
        "feedback/bob/transforms/index.html",
        "grade",
    } <= wanted.keys()
    total = len(files(calm))

    chance = random.Random(SEED)
    moments = [0, *(chance.randrange(1, total) for _ in range(KILLS - 1))]
    killed = [kill_at(class_, moment, chance.random() / 2) for moment in moments]
    assert killed.count(True) >= KILLS - 2  # others came too late

    code, said = full_disk(class_)
    assert code in (1, 2) and ("No space left on device" in said or "disk is full" in said), said

    read_only = f"bwrap --dev-bind / / --ro-bind {class_.gradebook} {class_.gradebook}".split()
    code, said = disturbed(class_, "--force", before=read_only)
    assert code == 1 and "readonly database" in said, said

    patience = class_.root / "autograder/bridge/gradebook.py"
    text = patience.read_text()
    patience.write_text(text.replace("PATIENCE = 60.0", "PATIENCE = 0.2"))
    lock = sqlite3.connect(class_.gradebook, isolation_level=None)
    lock.execute("BEGIN EXCLUSIVE")
    code, said = disturbed(class_, "--force")
    assert code == 2 and "locked" in said and "try again" in said, said
    lock.execute("COMMIT")
    lock.execute("BEGIN IMMEDIATE")  # as one who writes: others may still read
    code, said = disturbed(class_, "--force")
    assert code == 1 and "locked" in said, said
    lock.execute("COMMIT")
    lock.close()
    patience.write_text(text)

    code, said = disturbed(class_)
    assert code == 0, said
    found = outcome(class_)
    assert found.keys() == wanted.keys()
    assert not [what for what in wanted if found[what] != wanted[what]]
    assert "0 graded, 3 unchanged" in run(class_, "grade")[1]
