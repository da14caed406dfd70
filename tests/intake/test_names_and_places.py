"""Notebooks under the names, and in the places, that browsers, LMSs and people give them."""

import io
import json
import zipfile

import pytest
from editing import solution
from support import ASKED, ROOT, points, run, scores, statuses

from autograder.course import Course
from autograder.grading.one_student import check_files
from autograder.intake.naming import by_cells, by_name
from autograder.intake.sorting import sort
from autograder.intake.submission import submission_of

ONE, TWO, THREE = "1_rotation", "2_homogeneous_transforms", "3_chaining"


@pytest.fixture(scope="module")
def released_here():
    return Course(ROOT)


def work(name, mark=""):
    """A solved notebook's bytes; mark: what tells it from others"""
    raw = solution(name)
    raw["cells"].append({"cell_type": "markdown", "metadata": {}, "source": mark})
    return json.dumps(raw).encode()


def untouched(name):
    return ASKED_FILES[name]


ASKED_FILES = {name: (ROOT / "notebooks" / "transforms" / f"{name}.ipynb").read_bytes() for name in ASKED}


def packed(files):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return content.getvalue()


NAMES_OF_ONE = [
    "1_rotation (1).ipynb", "1_rotation(1).ipynb", "1_rotation (12).ipynb", "1_rotation-Copy1.ipynb",
    "1_rotation-Copy1-Copy2.ipynb", "Copy of 1_rotation.ipynb", "Kopie von 1_rotation.ipynb", "1_rotation – Kopie.ipynb",
    "1_rotation copy.ipynb", "1_rotation copy 2.ipynb", "1_rotation_jdoe.ipynb", "jdoe_1_rotation.ipynb",
    "1_rotation - Ann Doe.ipynb", "1_Rotation.ipynb", "1_ROTATION.IPYNB", "1_rotation-1.ipynb", "1_rotation+1.ipynb",
    "1_rotation (1)-2.ipynb", "1_rotation-c9a646d3-9c61-4cb7-bfcd-ee2522c8f633.ipynb", "1_rotation.ipynb.txt",
    "1_rotation.ipynb.json", "1_rotation.ipynb (1).txt", "1_rotation (1).ipynb.txt", "1_rotation.ipynb.ipynb",
    "1_rotation.txt", "1_rotation.json", "1_rotation", "1 rotation.ipynb", "1-rotation.ipynb", "1_rotation_final_v2.ipynb",
    "1_rotation_3.ipynb", "my work/1_rotation.ipynb", "a/b/c/1_rotation (1).ipynb",
]  # fmt: skip


@pytest.mark.parametrize("name", NAMES_OF_ONE)
def test_the_one_notebook_that_is_meant_is_taken(released_here, name):
    content = work(ONE)
    found = sort({name: content}, released_here.notebooks)
    assert found.notebooks == {ONE: content} and found.sources == {ONE: name}
    assert len(found.problems) in (1, 2) and any(
        name in line or "the notebooks were taken from" in line for line in found.problems
    )


@pytest.mark.parametrize("name", ["Untitled.ipynb", "rotation.ipynb", "homework 3.ipynb", "1_rotaton.ipynb"])
def test_a_name_that_says_nothing_is_no_obstacle_when_the_cells_do(released_here, name):
    content = work(ONE)
    assert sort({name: content}, released_here.notebooks).notebooks == {ONE: content}


@pytest.mark.parametrize(
    "name, numbers",
    [
        ("1_rotation.ipynb", ()),
        ("1_rotation (2).ipynb", (2,)),
        ("1_rotation-Copy3.ipynb", (3,)),
        ("1_rotation (1)-2.ipynb", (1, 2)),
        ("2024_1_rotation.ipynb", ()),
        ("1_rotation-c9a646d3-9c61-4cb7-bfcd-ee2522c8f633.ipynb", ()),
    ],
)
def test_the_numbers_of_copies(released_here, name, numbers):
    assert by_name(name, released_here.notebooks) == (ONE, numbers)


@pytest.mark.parametrize(
    "name", ["11_rotation.ipynb", "1_rotations.ipynb", "1_rotation and 3_chaining.ipynb", "x.ipynb"]
)
def test_names_that_mean_none(released_here, name):
    assert by_name(name, released_here.notebooks) is None


@pytest.mark.parametrize("name", ASKED)
def test_notebooks_are_known_by_their_cells(released_here, name):
    stripped = json.loads(work(name))
    for cell in stripped["cells"]:
        cell["metadata"] = {}
    for content in (work(name), untouched(name), json.dumps(stripped).encode()):
        assert by_cells(content, released_here.notebooks) == name
    assert by_cells(b'{"cells": [{"cell_type": "code", "source": "1"}]}', released_here.notebooks) is None
    assert by_cells(b"PK", released_here.notebooks) is None


def test_cells_that_say_otherwise(released_here):
    """A copy is not graded as what it is not; the one name that it should have is told."""
    for name in ("1_rotation (1).ipynb", "1_rotation.ipynb"):
        found = sort({name: work(THREE)}, released_here.notebooks)
        assert found.notebooks == {}
        assert found.problems == [
            f"{name}: not graded; it holds the cells of 3_chaining. If it is that notebook, call it 3_chaining.ipynb."
        ]


def test_a_notebook_of_another_course(released_here):
    other = b'{"cells": [{"cell_type": "code", "source": "1"}]}'
    found = sort({"Untitled.ipynb": other, "3_chainin.ipynb": other}, released_here.notebooks)
    assert found.notebooks == {}
    assert "Call it one of 1_rotation.ipynb, 2_homo" in found.problems[0]
    assert found.problems[1].endswith("Call it 3_chaining.ipynb.")


def test_of_several_files_for_one_notebook(released_here):
    first, second, third = (work(ONE, mark) for mark in ("first", "second", "third"))
    copies = {"1_rotation (2).ipynb": second, "1_rotation (10).ipynb": third, "1_rotation (1).ipynb": first}
    found = sort(copies, released_here.notebooks)
    assert found.sources == {ONE: "1_rotation (10).ipynb"} and found.notebooks == {ONE: third}
    assert sum("not graded; of 1_rotation.ipynb, 1_rotation (10).ipynb was" in line for line in found.problems) == 2
    found = sort(copies | {"1_rotation.ipynb": first}, released_here.notebooks)
    assert found.sources == {ONE: "1_rotation.ipynb"}  # its own name, and there is work in it
    for empty in (untouched(ONE), b""):
        found = sort(copies | {"1_rotation.ipynb": empty}, released_here.notebooks)
        assert found.sources == {ONE: "1_rotation (10).ipynb"}
    found = sort({"old/1_rotation.ipynb": first, "1_rotation.ipynb": second}, released_here.notebooks)
    assert found.sources == {ONE: "1_rotation.ipynb"}


def test_the_same_file_twice_is_no_news(released_here):
    found = sort({"1_rotation.ipynb": work(ONE), "1_rotation (1).ipynb": work(ONE)}, released_here.notebooks)
    assert found.problems == []


def test_what_is_made_of_a_notebook_is_not_the_notebook(released_here):
    files = {
        "1_rotation.py": b"def f(): ...",
        "3_chaining.html": b"<html>",
        "2_homogeneous_transforms (1).pdf": b"%PDF-",
    }
    found = sort(files | {"3_chaining.ipynb": work(THREE)}, released_here.notebooks)
    assert set(found.problems) == {
        "1_rotation.py: it is not the notebook; hand in 1_rotation.ipynb itself.",
        "2_homogeneous_transforms (1).pdf: it is not the notebook; hand in 2_homogeneous_transforms.ipynb itself.",
    }


def test_a_zip_is_unpacked(released_here):
    content = work(ONE)
    files = {
        "transforms/1_rotation.ipynb": content,
        "transforms/mine.py": b"x = 1",
        "transforms/transform_lab/tft.py": b"",
    }
    found = sort({"work.zip": packed(files)}, released_here.notebooks)
    assert found.notebooks == {ONE: content} and found.sources == {ONE: "work.zip"}
    assert found.helpers == {"mine.py": b"x = 1"} and found.problems == ["work.zip: it was unpacked."]


@pytest.mark.parametrize(
    "content, words",
    [
        (b"PK\x03\x04", "it is no zip file, or a damaged one"),
        (packed({}), "there is nothing in it"),
        (packed({"again.zip": packed({"1_rotation.ipynb": b""})}), "a zip in a zip was not unpacked"),
        (packed({"../1_rotation.ipynb": b"{}"}), "its path leads out of the archive"),
        (packed({f"{number}.txt": b"x" for number in range(201)}), "too many, or too large"),
    ],
    ids=["damaged", "empty", "zip in zip", "out of it", "many files"],
)
def test_odd_zips_are_told(released_here, content, words):
    found = sort({"a.zip": content}, released_here.notebooks)
    assert found.notebooks == {} and any("a.zip" in line and words in line for line in found.problems)


def test_archives_of_other_kinds_are_told(released_here):
    for name in ("work.7z", "work.RAR", "work.tar.gz"):
        assert (
            "was not opened; hand in the files themselves" in sort({name: b"7z"}, released_here.notebooks).problems[0]
        )


def test_helpers_lie_beside_the_notebooks(released_here):
    files = {"transforms/1_rotation.ipynb": work(ONE), "transforms/lib/mine.py": b"", "top.txt": b""}
    assert sorted(sort(files, released_here.notebooks).helpers) == ["lib/mine.py", "top.txt"]
    apart = {"a/1_rotation.ipynb": work(ONE), "b/3_chaining.ipynb": work(THREE), "b/mine.py": b""}
    found = sort(apart, released_here.notebooks)
    assert set(found.notebooks) == {ONE, THREE} and list(found.helpers) == ["b/mine.py", "mine.py"]


def test_a_new_name_is_a_change(released_here, tmp_path):
    """Or the words about it would be out of date."""
    (tmp_path / "1_rotation.ipynb").write_bytes(work(ONE))
    before = submission_of(released_here, "", tmp_path).digest
    (tmp_path / "1_rotation.ipynb").rename(tmp_path / "1_rotation (1).ipynb")
    assert submission_of(released_here, "", tmp_path).digest != before


# --- what students and instructors read ---------------------------------------------------------------------------------


def put(folder, files):
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)


def test_everybody_who_handed_something_in_is_graded_or_told_why_not(course, sandboxed):
    class_ = {
        "zip": {"transforms.zip": packed({f"transforms/{ONE}.ipynb": work(ONE)})},
        "folder": {f"transforms/{ONE}.ipynb": work(ONE), "transforms/transform_lab/tft.py": b"raise"},
        "copy": {f"{ONE} (1).ipynb": work(ONE)},
        "text": {f"{ONE}.ipynb.txt": work(ONE)},
        "pdf": {f"{ONE}.pdf": b"%PDF-1.7"},
        "page": {f"{ONE}.ipynb": b"<!DOCTYPE html>\n<html>"},
        "wrong": {f"{ONE} (1).ipynb": work(THREE)},
        "none": {"notes.txt": b"x"},
    }
    for student, files in class_.items():
        put(course.submitted(student), files)
    code, said = run(course, "grade")
    assert code == 0 and f"{len(class_)} graded" in said, said
    for student in ("zip", "folder", "copy", "text"):
        assert sum(scores(course, student).values()) == points(ONE), student
    assert (
        statuses(course, "page")["is_rotation"] == "unreadable" and statuses(course, "pdf")["is_rotation"] == "missing"
    )
    report = (course.reports / "index.html").read_text()
    told = {
        "zip": "transforms.zip: it was unpacked.",
        "folder": "transforms/: the notebooks were taken from this folder.",
        "copy": f"{ONE} (1).ipynb: it was taken for {ONE}.ipynb",
        "pdf": f"{ONE}.pdf: it is not the notebook; hand in {ONE}.ipynb itself.",
        "page": "it is a web page (HTML)",
        "wrong": "not graded; it holds the cells of 3_chaining",
    }
    for student in class_:
        page = (course.feedback(student) / "index.html").read_text()
        assert "did not hand in" not in page
        for text in (page, said, report):
            assert told.get(student, "") in text, student
    for student in ("pdf", "page"):
        page = (course.feedback(student) / "index.html").read_text()
        assert "Nothing of it could be graded" in page and "Begin with" not in page
    assert "The file could not be read. See <em>About your files</em>, and hand it in again." in page
    code, said = run(course, "grade")
    assert code == 0 and f"0 graded, {len(class_)} unchanged" in said

    (course.submitted("none") / f"{ONE}.ipynb").write_bytes(work(ONE))
    code, said = run(course, "grade")
    assert (
        "1 graded (hidden cases drawn from seed" in said
        and not (course.autograded("none") / "submission.json").exists()
    )


def test_check_goes_by_the_same_rules(released_here, tmp_path, sandboxed):
    put(
        tmp_path,
        {f"{ONE} (1).ipynb": work(ONE), "work.zip": packed({f"a/{THREE}.ipynb": work(THREE)}), "x.pdf": b"%PDF-"},
    )
    found, refused, said = check_files(released_here, [tmp_path / f"{ONE} (1).ipynb"], seed=7)
    assert {row.notebook for row, _ in found} == {ONE} and all(row.score == row.max_score for row, _ in found)
    assert refused == [] and any("it was taken for 1_rotation.ipynb" in line for line in said)
    found, refused, _ = check_files(released_here, [tmp_path / "work.zip", tmp_path / "x.pdf"], seed=7)
    assert {row.notebook for row, _ in found} == {THREE} and [line.partition(": ")[0] for line in refused] == [
        str(tmp_path / "x.pdf")
    ]
    found, refused, _ = check_files(released_here, [tmp_path], seed=7)
    assert sum(row.score for row, _ in found) == points(ONE, THREE) and refused == []


# --- what outside testers found -----------------------------------------------------------------------------------------


def changed(name, **sources):
    """The released notebook, in which cells have other texts: {the cell's name with _ for -: text}, or `first`."""
    raw = json.loads(untouched(name))
    for cell in raw["cells"]:
        entry = cell["metadata"].get("nbgrader", {}).get("grade_id", "").replace("-", "_")
        cell["source"] = sources.get(entry, cell["source"])
    raw["cells"][0]["source"] = sources.get("first", raw["cells"][0]["source"])
    return json.dumps(raw).encode()


def test_work_in_a_zip_counts_before_an_untouched_notebook_beside_it(released_here):
    solved = work(THREE)
    for files in (
        {"3_chaining.ipynb": untouched(THREE), "work.zip": packed({"3_chaining.ipynb": solved})},
        {"a.zip": packed({"3_chaining.ipynb": untouched(THREE)}), "b.zip": packed({"3_chaining.ipynb": solved})},
        {"a.zip": packed({"3_chaining.ipynb": solved}), "b.zip": packed({"3_chaining.ipynb": untouched(THREE)})},
    ):
        assert sort(files, released_here.notebooks).notebooks == {THREE: solved}


def test_a_name_in_the_title_is_no_work(released_here):
    named = changed(THREE, first="# 3 Chaining - Jane Doe")
    files = {"3_chaining.ipynb": named, "3_chaining (1).ipynb": work(THREE)}
    assert sort(files, released_here.notebooks).sources == {THREE: "3_chaining (1).ipynb"}


def test_all_notebooks_in_one_file(released_here):
    raw = {"cells": [cell for name in ASKED for cell in solution(name)["cells"]]}
    content = json.dumps(raw).encode()
    for path in ("all.ipynb", "1_rotation.ipynb"):
        found = sort({path: content}, released_here.notebooks)
        assert set(found.notebooks) == set(ASKED)
        assert sum("stand in it, too, and were graded as" in line for line in found.problems) == len(ASKED) - 1
    both = json.dumps({"cells": [*solution(THREE)["cells"], *solution("4_inversion")["cells"]]}).encode()
    found = sort({"3_chaining.ipynb": both, "4_inversion.ipynb": work("4_inversion")}, released_here.notebooks)
    assert found.notebooks["4_inversion"] == work("4_inversion")


@pytest.mark.parametrize("name", ["homework.json", "homework.txt", "homework", "submission.ipynb.bak"])
def test_a_notebook_under_a_name_of_another_kind(released_here, name):
    assert sort({name: work(ONE)}, released_here.notebooks).notebooks == {ONE: work(ONE)}


@pytest.mark.parametrize("name", ["submission", "work.zip (1)", "w.zipx", "1_rotation.zip"])
def test_a_zip_under_a_name_of_another_kind(released_here, name):
    assert sort({name: packed({"1_rotation.ipynb": work(ONE)})}, released_here.notebooks).notebooks == {ONE: work(ONE)}
    assert sort({"1_rotation.zip": work(ONE)}, released_here.notebooks).notebooks == {ONE: work(ONE)}


def test_where_nothing_is_a_notebook_each_file_is_named(released_here):
    files = {"homework.py": b"x = 1", "Notebook.html": b"<html>", "w.txz": b"\xfd7z", "essay.docx": packed({"a": b""})}
    said = sort(files, released_here.notebooks).problems
    assert all(any(line.startswith(f"{name}: ") for line in said) for name in files)


def test_a_helper_that_was_downloaded_twice(released_here):
    found = sort({"1_rotation.ipynb": work(ONE), "mine (1).py": b"x = 1"}, released_here.notebooks)
    assert found.helpers == {"mine (1).py": b"x = 1", "mine.py": b"x = 1"}
    assert found.problems == ["mine (1).py: it was taken for mine.py, too; that is what it should be called."]


def test_notebooks_that_run_others(released_here, tmp_path):
    raw = solution(THREE)
    (tmp_path / "1_rotation.ipynb").write_bytes(work(ONE))
    assert submission_of(released_here, "", tmp_path).helpers == {}
    raw["cells"].insert(2, {"cell_type": "code", "metadata": {}, "source": "%run 1_rotation.ipynb"})
    (tmp_path / "3_chaining.ipynb").write_text(json.dumps(raw))
    assert "1_rotation.ipynb" in submission_of(released_here, "", tmp_path).helpers


def test_a_notebook_of_one_s_own_that_defines_a_function_is_not_the_assignment_s(released_here):
    own = json.dumps({"cells": [{"cell_type": "code", "source": "def is_rotation(R):\n    return True"}]}).encode()
    assert sort({"my_functions.ipynb": own}, released_here.notebooks).notebooks == {}


def test_names_do_not_turn_the_line_they_stand_in(released_here, tmp_path):
    (tmp_path / "a\u202eb.ipynb").write_bytes(b"x")
    assert not [line for line in submission_of(released_here, "", tmp_path).problems if "\u202e" in line]


def test_of_zips_by_number_the_last_one_counts(released_here):
    packs = {f"hw{suffix}.zip": packed({"1_rotation.ipynb": work(ONE, suffix)}) for suffix in ("", "-1", "-2", "-10")}
    assert sort(packs, released_here.notebooks).sources == {ONE: "hw-10.zip"}
