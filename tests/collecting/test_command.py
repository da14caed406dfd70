"""The command `collect`, and nbgrader's own zip_collect with this course's configuration, as an instructor runs them."""

import csv
import io
import re
import shutil
import subprocess
import sys
import zipfile

import downloads
import pytest
from downloads import ODD, Attempt, Student, later, packed
from support import run, scores
from test_systems import write_list

from autograder.course import Course
from autograder.intake.sorting import sort

ANA, BO = ODD[0], ODD[1]


def test_what_it_says(course, work, tmp_path, slow):
    works = {ANA: [Attempt(work("a"), late=True)], BO: [Attempt({}, text="<p>My answer</p>")]}
    where = packed(tmp_path / "a.zip", downloads.canvas(works))
    listed = write_list(tmp_path / "list.csv", ODD[:3])
    code, said = run(course, "collect", str(where), "--students", str(listed), "--dry-run")
    assert code == 1 and not (course.root / "submitted").exists()
    assert "5 files would be written; nothing was, this was a dry run." in said
    code, said = run(course, "collect", str(where), "--students", str(listed))
    assert code == 1
    assert (
        "agarcia" in said and "canvas: garcíanúñezana (no. 48288)" in said and "5 notebooks" in said and "LATE" in said
    )
    assert "left: de_lacruzbo (no. 48291): a text instead of a file" in said
    assert (
        "Nothing handed in: pobrien." in said and "Left, see above: bo_cruz." in said and "5 files were written" in said
    )
    code, said = run(course, "collect", str(where), "--students", str(listed))
    assert code == 1 and "Nothing is new: 1 student, all as they were." in said


@pytest.mark.parametrize(
    "arguments, says",
    [
        (["nowhere.zip"], "nowhere.zip: there is no such file or folder."),
        (["README.md"], "README.md: it is no zip file, or a damaged one"),
        ([".", "--from", "x"], "There is no system 'x'; choose from canvas"),
        ([".", "--from", "ultra"], "Blackboard Ultra: nothing public says how its downloads are named."),
        ([".", "--timezone", "Mars/Base"], "There is no time zone 'Mars/Base'"),
        ([".", "--timezone", "../x"], "There is no time zone"),
        (["a.zip", "--students", "README.md"], "this is no class list"),
        (["a.zip", "--students", "none.csv"], "none.csv: No such file"),
    ],
)
def test_bad_input_is_said(course, work, slow, arguments, says):
    (course.root / "README.md").write_text("# words\n")
    packed(course.root / "a.zip", downloads.canvas({ANA: [Attempt(work("a"))]}))
    code, said = run(course, "collect", *arguments)
    assert code == 2 and says in said and not (course.root / "submitted").exists()


@pytest.fixture
def whole(released, tmp_path):
    """A released course of the test's own, all of it."""
    return Course(shutil.copytree(released.root, tmp_path / "whole"))


@pytest.mark.parametrize("name", ["blackboard", "canvas", "moodle"])
def test_nbgraders_zip_collect_takes_the_same(whole, work, tmp_path, nbgrader, name):
    archive = whole.root / "downloaded" / "transforms" / "archive"
    archive.mkdir(parents=True)
    works = {s: [Attempt(work("old")), Attempt(work(s.login), later(2))] for s in (ANA, BO)}
    packed(archive / "a.zip", getattr(downloads, name)(works))
    done = nbgrader(whole, "zip_collect", "transforms")
    assert done.returncode == 0, done.stderr
    called = {"blackboard": "agarcia", "canvas": "48288", "moodle": "Ana_García-Núñez"}[name]
    folder = whole.submitted(called)
    assert {path.name: path.read_bytes() for path in folder.glob("*.ipynb")} == work(ANA.login)
    assert len(whole.students()) == 2
    assert (folder / "timestamp.txt").exists() == (name == "blackboard")


def test_nbgraders_zip_collect_never_writes_a_zip_under_a_notebook_s_name(whole, work, tmp_path, nbgrader):
    archive = whole.root / "downloaded" / "transforms" / "archive"
    archive.mkdir(parents=True)
    inside = packed(tmp_path / "hw.zip", work(ANA.login)).read_bytes()
    packed(archive / "a.zip", downloads.blackboard({ANA: [Attempt({"hw.zip": inside})]}))
    done = nbgrader(whole, "zip_collect", "transforms")
    assert done.returncode == 0, done.stderr
    assert (whole.submitted("agarcia") / "hw.zip").read_bytes() == inside
    assert sort(
        {path.name: path.read_bytes() for path in whole.submitted("agarcia").glob("*")}, whole.notebooks
    ).notebooks == {name.removesuffix(".ipynb"): content for name, content in work(ANA.login).items()}


def table(course, name, *options):
    code, said = run(course, "export", "--format", name, "--output", "points.csv", *options)
    assert code == 0, said
    return list(csv.DictReader(io.StringIO((course.root / "points.csv").read_text(encoding="utf-8"))))


def test_from_canvas_and_back(whole, solved_bytes, tmp_path, sandboxed):
    """The columns that Canvas finds a student by come back as its gradebook had them."""
    gradebook = tmp_path / "gradebook.csv"
    head = "Student,ID,SIS User ID,SIS Login ID,Section,Lab (7)\n    Points Possible,,,,,10\n"
    rows = [f'"{s.sortable}",{s.number},00{s.number},{s.login},A,' for s in ODD[:2]]
    gradebook.write_text(head + "\n".join(rows), encoding="utf-8")
    files = downloads.canvas({ANA: [Attempt(solved_bytes)]})
    code, said = run(whole, "collect", str(packed(tmp_path / "a.zip", files)), "--students", str(gradebook))
    assert code == 0, said
    assert run(whole, "grade", "--no-feedback")[0] == 0
    total = sum(scores(whole, "agarcia").values())
    assert total > 0
    possible, ana = table(whole, "canvas", "--column", "Lab (7)")
    assert possible["Student"] == "Points Possible"
    assert (ana["Student"], ana["ID"], ana["SIS Login ID"]) == ("García-Núñez, Ana", "48288", "agarcia")
    assert float(ana["Lab (7)"]) == total


def test_from_moodle_and_back(whole, solved_bytes, tmp_path, sandboxed):
    participants = tmp_path / "participants.csv"
    rows = [f"{s.first},{s.last},{s.login},00{s.number},{s.email}" for s in ODD[:3]]
    participants.write_text("First name,Surname,Username,ID number,Email address\n" + "\n".join(rows), encoding="utf-8")
    files = downloads.moodle({ODD[2]: [Attempt(solved_bytes)]})
    code, said = run(whole, "collect", str(packed(tmp_path / "a.zip", files)), "--students", str(participants))
    assert code == 0, said
    assert run(whole, "grade", "--no-feedback")[0] == 0
    (pat,) = table(whole, "moodle")
    assert [pat[column] for column in ("First name", "Last name", "Username", "Email address")] == [
        "Pat", "O'Brien", "pobrien", "pobrien@example.org",
    ]  # fmt: skip
    assert float(pat["transforms"]) == sum(scores(whole, "pobrien").values()) > 0


@pytest.fixture
def solved_bytes(solved):
    return {f"{name}.ipynb": path.read_bytes() for name, path in list(solved.items())[:2]}


def test_a_class_of_300_takes_little_memory(course, work, tmp_path, slow):
    """Outputs make the notebooks large, as pictures do."""
    output = bytes(range(97, 123)) * 20_000
    padding = b'{"cell_type": "code", "metadata": {}, "outputs": [{"text": "' + output + b'"}], "source": []}, '
    with zipfile.ZipFile(tmp_path / "a.zip", "w", zipfile.ZIP_DEFLATED) as made:
        for i in range(300):
            mine = {
                name: content.replace(b'"cells": [', b'"cells": [' + padding, 1) for name, content in work(i).items()
            }
            student = Student(f"F{i}", f"L{i}", f"u{i}", 10_000 + i)
            for name, content in downloads.canvas({student: [Attempt(mine)]}).items():
                made.writestr(name, content)
    code = (
        "import sys; from autograder.command_line import run; code = run(sys.argv[1:]);"
        "print(open('/proc/self/status').read()); sys.exit(code)"
    )
    command = [sys.executable, "-c", code, "collect", tmp_path / "a.zip"]
    done = subprocess.run(command, cwd=course.root, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert len(course.students()) == 300
    assert int(re.search(r"VmHWM:\s*(\d+) kB", done.stdout)[1]) < 300_000
