"""What a student has packed themselves, within what the LMS packs: it is as new as the attempt that it came with."""

import io
import zipfile

import downloads
import pytest
from downloads import ODD, Attempt, later, packed

from autograder.collecting.collect import collect
from autograder.intake.submission import TIMESTAMP

ANA = ODD[0]


def zip_of(files):
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as made:
        for name, data in files.items():
            made.writestr(name, data)
    return content.getvalue()


def in_folder(files):
    return zip_of({f"my work/{name}": content for name, content in files.items()} | {"my work/mine.py": b"x = 1"})


def test_a_newer_zip_replaces_older_notebooks_and_an_older_one_does_not(course, submitted, work, tmp_path):
    old, new = work("old"), work("new")
    attempts = [Attempt(old), Attempt({"hw.zip": in_folder(new)}, later(48))]
    collect(course, [packed(tmp_path / "a.zip", downloads.blackboard({ANA: attempts}))])
    found = submitted()["agarcia"]
    assert {name: found[name] for name in new} == new and found["mine.py"] == b"x = 1" and "hw.zip" not in found
    assert found[TIMESTAMP].startswith(later(48).strftime("%Y-%m-%d").encode())

    back = [Attempt({"hw.zip": zip_of(old)}), Attempt(new, later(48))]
    collect(course, [packed(tmp_path / "b.zip", downloads.blackboard({ODD[1]: back}))])
    assert {name: submitted()["bo_cruz"][name] for name in new} == new
    before = submitted()
    collect(course, [tmp_path / "a.zip", tmp_path / "b.zip"])
    assert submitted() == before


@pytest.mark.parametrize("names", [("b.zip", "a.zip"), ("a.zip", "b.zip"), ("hw.zip", "hw.zip")])
def test_of_several_zips_the_newest_counts_whatever_it_is_called(course, submitted, work, tmp_path, names):
    attempts = [Attempt({names[0]: zip_of(work("old"))}), Attempt({names[1]: zip_of(work("new"))}, later(1))]
    collect(course, [packed(tmp_path / "a.zip", downloads.blackboard({ANA: attempts}))])
    assert {name: submitted()["agarcia"][name] for name in work("new")} == work("new")


def test_of_zips_that_canvas_renamed_the_last_upload_counts(course, submitted, work, tmp_path):
    attempts = [Attempt({"hw.zip": zip_of(work(number))}) for number in range(3)]
    files = {}
    for number, attempt in enumerate(attempts):
        name = f"hw{f'-{number}' if number else ''}.zip"
        files |= downloads.canvas({ANA: [Attempt({name: attempt.files["hw.zip"]})]})
    files = {name.replace("7710021", str(7710021 + number)): data for number, (name, data) in enumerate(files.items())}
    collect(course, [packed(tmp_path / "a.zip", files)])
    (found,) = submitted().values()
    assert {name: found[name] for name in work(2)} == work(2)


def test_other_zips_stay_as_they_are(course, submitted, work, tmp_path):
    files = {"pictures.zip": zip_of({"a.txt": b"1"}), "broken.zip": b"PK\x03\x04"}
    collect(course, [packed(tmp_path / "a.zip", downloads.blackboard({ANA: [Attempt(work("ana") | files)]}))])
    assert {name: submitted()["agarcia"][name] for name in files} == files
