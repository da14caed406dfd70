"""What `collect` does with what is in submitted/ already, with people, and with archives that mean no good."""

import os
import shutil
import stat
import zipfile
from itertools import product
from zoneinfo import ZoneInfo

import downloads
import pytest
from downloads import ODD, Attempt, Student, later, packed, unpacked
from nbgrader.api import Gradebook
from test_systems import accounted, state, write_list

from autograder.collecting.collect import collect
from autograder.collecting.people import Unsure, folder_name
from autograder.collecting.told import table
from autograder.course import CourseError

ANA, BO, PAT = ODD[0], ODD[1], ODD[2]


def blackboard(tmp_path, works, name="a.zip"):
    return packed(tmp_path / name, downloads.blackboard(works))


def reasons(outcome):
    return [one for left in outcome.left.values() for one in left if one.look]


def students(course):
    """nbgrader's table, {id: (first name, last name, e-mail, LMS id)}."""
    with Gradebook(f"sqlite:///{course.gradebook}") as gradebook:
        return {s.id: (s.first_name, s.last_name, s.email, s.lms_user_id) for s in gradebook.students}


# --- what is there already ------------------------------------------------------------------------------------------


def test_a_newer_attempt_replaces_an_older_one_and_never_the_other_way_round(course, submitted, work, tmp_path):
    old = blackboard(tmp_path, {ANA: [Attempt(work("old"))]}, "old.zip")
    new = blackboard(tmp_path, {ANA: [Attempt(work("new", "1_rotation"), later(3))]}, "new.zip")
    for order in ([old, new], [new, old], [old, old], [new]):
        collect(course, order)
    found = submitted()["agarcia"]
    assert found["1_rotation.ipynb"] == work("new")["1_rotation.ipynb"]
    assert found["3_chaining.ipynb"] == work("old")["3_chaining.ipynb"]
    outcome = collect(course, [old])
    assert submitted()["agarcia"] == found and "an older 1_rotation.ipynb was not taken" in outcome.came[0].remarks
    assert not outcome.came[0].look and not reasons(outcome)


def test_of_downloads_without_times_the_one_made_later_counts(course, submitted, work, tmp_path):
    for name, day in (("submissions.zip", 20), ("submissions (1).zip", 21)):
        with zipfile.ZipFile(tmp_path / name, "w") as made:
            for path, content in downloads.moodle({ANA: [Attempt(work(day, "1_rotation"))]}).items():
                made.writestr(zipfile.ZipInfo(path, (2026, 11, day, 8, 0, 0)), content)
    outcome = collect(course, [tmp_path / "submissions.zip"], dry_run=True)
    assert outcome.came[0].remarks == []
    collect(course, [tmp_path / "submissions.zip"])
    for dry, how in ((True, "would be replaced"), (False, "replaced")):
        (came,) = collect(course, [tmp_path / "submissions (1).zip"], dry_run=dry).came
        assert came.remarks == [
            f"1_rotation.ipynb {how}: the download of 2026-11-21 08:00 counts as newer than that of 2026-11-20 08:00; "
            "`--dry-run` shows this before it is done"
        ]
    paths = [tmp_path / "submissions (1).zip", tmp_path / "submissions.zip"]  # as a shell sorts them
    collect(course, paths)
    assert list(submitted().values()) == [work(21, "1_rotation")]
    for path in reversed(paths):
        collect(course, [path])
        assert list(submitted().values()) == [work(21, "1_rotation")]


def test_what_an_instructor_has_changed_stays(course, submitted, work, tmp_path):
    where = blackboard(tmp_path, {ANA: [Attempt(work("first"))]})
    collect(course, [where])
    path = course.submitted("agarcia") / "1_rotation.ipynb"
    path.write_bytes(b"mended by hand")
    before = state(course.root)
    outcome = collect(course, [where])
    assert state(course.root) == before
    assert outcome.came[0].remarks == ["1_rotation.ipynb was changed here, and stays"] and not outcome.came[0].look
    again = blackboard(tmp_path, {ANA: [Attempt(work("second"), later(2))]}, "b.zip")
    outcome = collect(course, [again])
    found = submitted()["agarcia"]
    assert (
        found["1_rotation.ipynb"] == b"mended by hand"
        and found["3_chaining.ipynb"] == work("second")["3_chaining.ipynb"]
    )
    (reason,) = reasons(outcome)
    assert "to take this one, move that away and run again" in reason.why and outcome.came[0].look
    path.unlink()
    collect(course, [again])
    assert submitted()["agarcia"]["1_rotation.ipynb"] == work("second")["1_rotation.ipynb"]


def test_what_came_another_way_stays(course, submitted, work, tmp_path):
    folder = course.submitted("agarcia")
    folder.mkdir(parents=True)
    (folder / "1_rotation.ipynb").write_bytes(b"by hand")
    (folder / "timestamp.txt").write_text("2026-11-01 10:00:00.000000 UTC")
    outcome = collect(course, [blackboard(tmp_path, {ANA: [Attempt(work("a"))]})])
    found = submitted()["agarcia"]
    assert found["1_rotation.ipynb"] == b"by hand" and found["timestamp.txt"] == b"2026-11-01 10:00:00.000000 UTC"
    assert found["3_chaining.ipynb"] == work("a")["3_chaining.ipynb"]
    assert "did not come by `collect`" in reasons(outcome)[0].why


def test_an_empty_copy_does_not_win_over_work(course, submitted, work, tmp_path):
    blank = (course.release / "1_rotation.ipynb").read_bytes()
    mine = {"1_rotation.ipynb": blank, "1_rotation (1).ipynb": work("a")["1_rotation.ipynb"]}
    outcome = collect(course, [packed(tmp_path / "a.zip", downloads.moodle({ANA: [Attempt(mine)]}))])
    assert list(submitted().values()) == [work("a", "1_rotation")] and outcome.came[0].look


def test_notebooks_are_known_by_their_cells_and_by_their_names(course, submitted, work, tmp_path):
    mine = {
        "homework.ipynb": work("a")["1_rotation.ipynb"],
        "3_chaining-Copy1.ipynb": b"{ broken",
        "4_inversion.ipynb.txt": work("a")["4_inversion.ipynb"],
        "other.ipynb": b'{"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}',
        "report.pdf": b"%PDF",
    }
    collect(course, [packed(tmp_path / "a.zip", downloads.moodle({ANA: [Attempt(mine)]}))])
    (found,) = submitted().values()
    assert found == {
        "1_rotation.ipynb": work("a")["1_rotation.ipynb"],
        "3_chaining.ipynb": b"{ broken",
        "4_inversion.ipynb": work("a")["4_inversion.ipynb"],
        "other.ipynb": mine["other.ipynb"],
        "report.pdf": b"%PDF",
    }


def test_a_dry_run_says_the_same_and_writes_nothing(course, work, tmp_path):
    course.gradebook.unlink()
    where = blackboard(tmp_path, {s: [Attempt(work(s.login))] for s in ODD})
    listed = write_list(tmp_path / "list.csv", ODD)
    before = state(course.root)
    would = collect(course, [where], [listed], dry_run=True)
    assert state(course.root) == before and not (course.root / "submitted").exists()
    did = collect(course, [where], [listed])
    assert [(c.student, c.written, c.remarks) for c in would.came] == [
        (c.student, c.written, c.remarks) for c in did.came
    ]
    assert would.left == did.left and would.missing == did.missing


def test_a_memory_that_is_damaged_is_said(course, work, tmp_path):
    where = blackboard(tmp_path, {ANA: [Attempt(work("a"))]})
    collect(course, [where])
    for text in ("{", "[]", '{"files": {"a": 1}}', '{"files": {"a": {"b": {"order": []}}}}'):
        (course.root / "submitted" / ".collected.json").write_text(text)
        with pytest.raises(CourseError, match="Move it away"):
            collect(course, [where])


# --- times ----------------------------------------------------------------------------------------------------------


def test_times_are_written_as_nbgrader_reads_them(course, work, tmp_path):
    where = blackboard(tmp_path, {ANA: [Attempt(work("a")), Attempt(work("b", "1_rotation"), later(2))]})
    outcome = collect(course, [where], zone=ZoneInfo("America/New_York"))
    assert (course.submitted("agarcia") / "timestamp.txt").read_text() == "2026-11-19 00:34:05.000000 UTC\n"
    assert outcome.zoneless and outcome.came[0].time == downloads.utc(later(2), ZoneInfo("America/New_York"))


def test_times_are_shown_in_the_zone_that_was_used(course, work, tmp_path):
    where = blackboard(tmp_path, {ANA: [Attempt(work("a"))]})
    outcome = collect(course, [where], zone=ZoneInfo("America/New_York"))
    assert table(outcome)[0][3] == "2026-11-18 17:34 EST"
    assert table(collect(course, [where]))[0][3] == f"{downloads.START.astimezone():%Y-%m-%d %H:%M %Z}"


def test_times_of_zip_entries_are_no_times_of_handing_in(course, submitted, work, tmp_path):
    for build in (downloads.canvas, downloads.moodle, downloads.ilias):
        outcome = collect(course, [packed(tmp_path / "a.zip", build({ANA: [Attempt(work("a"))]}))])
        assert outcome.came[0].time is None
    assert not list(course.root.rglob("timestamp.txt"))


@pytest.mark.parametrize(
    "said", ["2026-02-30-10-00-00", "0000-00-00-00-00-00", "0001-01-01-00-00-00", "2026-11-18-25-61-61"]
)
def test_a_time_that_no_calendar_has_is_none(course, submitted, work, tmp_path, said):
    files = {f"Lab_ana_attempt_{said}_{name}": content for name, content in work("a").items()}
    collect(course, [packed(tmp_path / "a.zip", files)])
    assert submitted() == {"ana": work("a")}


def test_a_students_own_timestamp_is_not_nbgraders(course, submitted, work, tmp_path):
    mine = work("a") | {"timestamp.txt": b"2020-01-01 00:00:00", "submission_secret.txt": b"x", ".hidden": b"1"}
    files = downloads.moodle({ANA: [Attempt(mine)]})
    outcome = collect(course, [packed(tmp_path / "a.zip", files)])
    assert list(submitted().values()) == [work("a")] and not accounted(files, outcome)
    assert len(reasons(outcome)) == 2


# --- people ---------------------------------------------------------------------------------------------------------


def test_what_is_known_goes_into_nbgraders_table_and_nothing_there_is_lost(course, work, tmp_path):
    with Gradebook(f"sqlite:///{course.gradebook}") as gradebook:
        gradebook.add_student("agarcia", first_name="Anita", email="own@example.org")
    collect(course, [packed(tmp_path / "a.zip", downloads.canvas({BO: [Attempt(work("b"))]}))])
    assert students(course) == {
        "agarcia": ("Anita", None, "own@example.org", None),
        "48291": (None, None, None, "48291"),
    }
    outcome = collect(
        course,
        [packed(tmp_path / "a.zip", downloads.canvas({ANA: [Attempt(work("a"))]}))],
        [write_list(tmp_path / "list.csv", [ANA, BO, PAT])],
    )
    assert students(course) == {
        "agarcia": ("Anita", "García-Núñez", "own@example.org", "48288"),
        "48291": ("Bo", "de_la Cruz", BO.email, "48291"),
        "pobrien": ("Pat", "O'Brien", PAT.email, "48300"),
    }
    assert outcome.missing == ["pobrien"]


def test_one_person_in_two_systems_is_one_student(course, submitted, work, tmp_path):
    with Gradebook(f"sqlite:///{course.gradebook}") as gradebook:
        for s in ODD:
            gradebook.add_student(
                s.login, first_name=s.first, last_name=s.last, email=s.email, lms_user_id=str(s.number)
            )
    for build in (downloads.canvas, downloads.moodle, downloads.gradescope, downloads.brightspace, downloads.ilias):
        outcome = collect(course, [packed(tmp_path / "a.zip", build({s: [Attempt(work(s.login))] for s in ODD}))])
        assert {came.student for came in outcome.came} == {student.login for student in ODD}, build
    assert set(submitted()) == {student.login for student in ODD}


def test_who_is_not_in_the_class_list_is_left_and_said(course, submitted, work, tmp_path):
    where = packed(tmp_path / "a.zip", downloads.canvas({s: [Attempt(work(s.login))] for s in (ANA, BO)}))
    outcome = collect(course, [where], [write_list(tmp_path / "list.csv", [ANA])])
    assert set(submitted()) == {"agarcia"}
    assert [one.whose for one in reasons(outcome)] == ["de_lacruzbo (no. 48291)"] and "add a row" in reasons(outcome)[
        0
    ].why


def test_two_people_of_one_name_with_numbers_stay_two(course, submitted, work, tmp_path):
    twins = [Student("Kim", "Lee", "kim1", 11), Student("Kim", "Lee", "kim2", 22)]
    files = downloads.canvas({s: [Attempt(work(s.login))] for s in twins})
    collect(course, [packed(tmp_path / "a.zip", files)])
    assert submitted() == {"11": work("kim1"), "22": work("kim2")}


def test_two_people_of_one_name_without_numbers_stop_alone(course, submitted, work, tmp_path):
    twins = [Student("Kim", "Lee", "kim1", 11), Student("Kim", "Lee", "kim2", 22)]
    files = downloads.brightspace({s: [Attempt(work(s.login))] for s in [*twins, ANA]})
    where = packed(tmp_path / "a.zip", files)
    outcome = collect(course, [where])
    assert len(submitted()) == 1 and len(reasons(outcome)) == 2
    assert {one.whose for one in reasons(outcome)} == {"Kim Lee (no. 11)", "Kim Lee (no. 22)"}
    (tmp_path / "own.csv").write_text("id,number\nkim.lee.1,11\nkim.lee.2,22\n")
    collect(course, [where], [tmp_path / "own.csv", write_list(tmp_path / "list.csv", [ANA])])
    found = submitted()
    assert {"kim.lee.1", "kim.lee.2"} < set(found) and work("kim2").items() <= found["kim.lee.2"].items()


def test_a_name_in_a_later_download_of_another_number_is_not_taken_for_the_same(course, submitted, work, tmp_path):
    first, second = Student("Kim", "Lee", "kim1", 11), Student("Kim", "Lee", "kim2", 22)
    collect(course, [packed(tmp_path / "a.zip", downloads.moodle({first: [Attempt(work("first"))]}))])
    outcome = collect(course, [packed(tmp_path / "b.zip", downloads.moodle({second: [Attempt(work("second"))]}))])
    assert submitted() == {"Kim_Lee": work("first")} and len(reasons(outcome)) == 1


@pytest.mark.parametrize("one, other", [("ana", "Ana"), ("a/b", "a_b")])
def test_folders_that_would_be_one_stop_the_second(course, submitted, work, tmp_path, one, other):
    files = {
        f"{who}_7{i}_assignsubmission_file/1_rotation.ipynb": work(who)["1_rotation.ipynb"]
        for i, who in enumerate((one, other))
    }
    files = {name.replace("a/b", "a＿b").replace("a_b", "a＿b"): content for name, content in files.items()}
    outcome = collect(course, [packed(tmp_path / "a.zip", files)])
    assert len(submitted()) <= 1 and reasons(outcome)


@pytest.mark.parametrize(
    "text, name",
    [
        ("García-Núñez, Ana", "García-Núñez_Ana"), ("- Suharto", "Suharto"), (". Suharto", "Suharto"),
        ("a/b", "a_b"), ("a[1]*", "a_1__"), ("ana@example.org", "ana@example.org"),
        ("x" * 300, "x" * 128),
        ("O'Brien", "O'Brien"), ("山田 太郎", "山田_太郎"),
    ],
)  # fmt: skip
def test_a_students_folder_is_safe(text, name):
    assert folder_name(text) == name


@pytest.mark.parametrize("text", ["=cmd", "-rf", "--force", "+1", "@x", "../../etc", ".hidden", "..."])
def test_what_is_no_students_name_is_refused_and_not_made_into_anothers(course, submitted, work, tmp_path, text):
    with pytest.raises(Unsure, match="no folder can be called"):
        folder_name(text)
    for name, put in product((text.replace("/", ""), text.replace("/", "") + "\nrf"), (unpacked, packed)):
        files = {f"{who}/1_rotation.ipynb": work(who)["1_rotation.ipynb"] for who in (name, "rf", "cmd")}
        shutil.rmtree(course.root / "submitted", ignore_errors=True)
        outcome = collect(course, [put(tmp_path / "class", files)], system="plain")
        assert submitted() == {who: work(who, "1_rotation") for who in ("rf", "cmd")}
        (reason,) = reasons(outcome)
        assert (
            "its name has a line end in it" in reason.why if "\n" in name else "no folder can be called" in reason.why
        )
        (tmp_path / "class").rename(tmp_path / f"{put.__name__} {len(name)}")


@pytest.mark.parametrize("listed", [False, True])
def test_attempts_of_one_person_under_several_numbers_of_brightspace(course, submitted, work, tmp_path, listed):
    """The second number is nobody else's, or the class list has the name once."""
    files = {
        f"{number}-{second} - {who} - Sep {day}, 2026 926 PM/1_rotation.ipynb": work(day)["1_rotation.ipynb"]
        for number, second, who, day in (
            (397063, 7 if listed else 2557369, "Mary-Ann Smith", 24), (397064, 2557369, "Mary-Ann Smith", 25),
            (397065, 2557369 if listed else 2557370, "Bo Cruz", 26),
        )
    }  # fmt: skip
    (tmp_path / "list.csv").write_text("id,name\nmary,Mary-Ann Smith\nbo,Bo Cruz\n")
    where = packed(tmp_path / "a.zip", files)
    outcome = collect(course, [where], [tmp_path / "list.csv"] if listed else [])
    assert not reasons(outcome)
    found = submitted()["mary" if listed else "Mary-Ann_Smith"]
    assert found["1_rotation.ipynb"] == work(25)["1_rotation.ipynb"] and len(submitted()) == 2


def test_whose_work_was_left_is_not_said_to_have_handed_in_nothing(course, work, tmp_path):
    twins = [Student("Kim", "Lee", "kim1", 11), Student("Kim", "Lee", "kim2", 22)]
    files = downloads.moodle({s: [Attempt(work(s.login))] for s in twins} | {BO: [Attempt({}, text="words")]})
    listed = write_list(tmp_path / "list.csv", [*twins, BO, PAT])
    outcome = collect(course, [packed(tmp_path / "a.zip", files)], [listed])
    assert outcome.unsettled == ["bo_cruz", "kim1", "kim2"] and outcome.missing == ["pobrien"]


# --- what is of another assignment ----------------------------------------------------------------------------------


def test_who_has_no_notebook_of_ours_is_told(course, submitted, work, tmp_path):
    other = {"notes.txt": b"1", "README.md": b"2", "lab.docx": b"3"}
    works = {ANA: [Attempt(work("a"))], BO: [Attempt(other)], PAT: [Attempt({"all.zip": b"PK\5\6" + bytes(18)})]}
    outcome = collect(course, [packed(tmp_path / "a.zip", downloads.canvas(works))])
    came = {one.student: one for one in outcome.came}
    assert came["48291"].remarks == ["no notebook of this assignment among 3 files"] and came["48291"].look
    assert not came["48288"].look and not came["48300"].look


def test_the_download_of_another_assignment_is_refused_before_anything_is_written(course, submitted, work, tmp_path):
    good = blackboard(tmp_path, {ANA: [Attempt(work("a"))]}, "good.zip")
    empty = b'{"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}'
    other = packed(tmp_path / "b.zip", downloads.canvas({BO: [Attempt({"essay.docx": b"1", "essay.ipynb": empty})]}))
    with pytest.raises(CourseError, match="looks like the download of another assignment.*--from canvas"):
        collect(course, [good, other])
    assert not (course.root / "submitted").exists()
    collect(course, [other], system="canvas")
    assert set(submitted()["48291"]) == {"essay.docx", "essay.ipynb"}


# --- what means no good ---------------------------------------------------------------------------------------------


def test_nothing_gets_out_of_submitted(course, submitted, work, tmp_path):
    begin = "Ana X_7_assignsubmission_file"
    evil = {
        f"{begin}/../../../evil.py": b"1",
        f"{begin}\\..\\..\\evil.py": b"1",
        "/abs_7_assignsubmission_file/evil.py": b"1",
        "C:\\Ana X_7_assignsubmission_file\\evil.py": b"1",
        f"{begin}/..": b"1",
        f"{begin}/{'x' * 260}.py": b"1",
        "../../.._8_assignsubmission_file_evil.py": b"1",
        "..._9_assignsubmission_file_evil.py": b"1",
    }
    files = evil | {f"{begin}/{name}": content for name, content in work("a").items()}
    outside = state(course.root)
    outcome = collect(course, [packed(tmp_path / "a.zip", files)])
    assert submitted() == {"Ana_X": work("a")}
    assert not [path for path in tmp_path.rglob("evil.py")] and len(reasons(outcome)) == len(evil)
    inside = course.root / "submitted"
    assert {path for path in state(course.root) if not path.is_relative_to(inside)} == set(outside)


def test_a_link_in_submitted_is_not_followed(course, submitted, work, tmp_path):
    outside = tmp_path / "outside"
    outside.mkdir()
    folder = course.submitted("agarcia")
    folder.mkdir(parents=True)
    (folder / "data").symlink_to(outside)
    (folder / "1_rotation.ipynb").symlink_to(outside / "1_rotation.ipynb")
    mine = work("a") | {"data/own.py": b"1"}
    files = {f"agarcia/{name}": content for name, content in mine.items()}
    outcome = collect(course, [packed(tmp_path / "a.zip", files)])
    assert list(outside.iterdir()) == [] and len(reasons(outcome)) == 2
    assert all("is no file, or lies behind a link" in one.why for one in reasons(outcome))
    assert (folder / "3_chaining.ipynb").exists()


def test_links_and_pipes_in_a_folder_are_left(course, submitted, work, tmp_path):
    folder = unpacked(tmp_path / "all", {f"ana/{name}": content for name, content in work("a").items()})
    (tmp_path / "secret").write_text("secret")
    (folder / "ana" / "secret.txt").symlink_to(tmp_path / "secret")
    (folder / "bo").symlink_to(tmp_path)
    os.mkfifo(folder / "ana" / "pipe")
    outcome = collect(course, [folder])
    assert submitted() == {"ana": work("a")}
    said = " ".join(one.why + " ".join(one.files) for one in reasons(outcome))
    assert "secret.txt" in said and "pipe" in said and "bo" in said


@pytest.mark.filterwarnings("ignore:Duplicate name")
def test_odd_archives_cost_themselves_alone(course, submitted, work, tmp_path):
    where = tmp_path / "a.zip"
    files = downloads.canvas({ANA: [Attempt(work("a"))]})
    with zipfile.ZipFile(where, "w", zipfile.ZIP_DEFLATED) as made:
        for name, content in files.items():
            made.writestr(name, content)
        made.writestr("bo_5_7_bomb.py", bytes(50_000_000))
        link = zipfile.ZipInfo("bo_5_8_link.py")
        link.create_system, link.external_attr = 3, (stat.S_IFLNK | 0o777) << 16
        made.writestr(link, "/etc/passwd")
        made.writestr(next(iter(files)), work("twice")["1_rotation.ipynb"])
    outcome = collect(course, [where])
    assert submitted() == {"48288": work("a") | work("twice", "1_rotation")}
    said = " ".join(one.why for one in reasons(outcome))
    assert "50 MB packed into" in said and "it is a link" in said and "more than once" in said


def test_what_is_encrypted_is_not_called_old(course, work, tmp_path):
    where = packed(tmp_path / "a.zip", downloads.canvas({ANA: [Attempt(work("a"))]}))
    raw = bytearray(where.read_bytes())
    for mark, flags in ((b"PK\3\4", 6), (b"PK\1\2", 8)):
        place = -1
        while (place := raw.find(mark, place + 1)) >= 0:
            raw[place + flags] |= 1
    where.write_bytes(raw)
    outcome = collect(course, [where])
    assert table(outcome)[0][4] == "nothing could be taken" and "encrypted" in reasons(outcome)[0].why


def test_what_cannot_be_read_is_said_before_anything_is_written(course, work, tmp_path):
    good = blackboard(tmp_path, {ANA: [Attempt(work("a"))]})
    (tmp_path / "broken.zip").write_bytes(good.read_bytes()[:-30])
    for bad, says in (
        (tmp_path / "broken.zip", "no zip file, or a damaged one"),
        (tmp_path / "none.zip", "no such file"),
    ):
        with pytest.raises(CourseError, match=says):
            collect(course, [good, bad])
    assert not (course.root / "submitted").exists()


def test_a_folder_of_several_downloads(course, submitted, work, tmp_path):
    folder = tmp_path / "downloads"
    folder.mkdir()
    packed(folder / "late.zip", downloads.canvas({ANA: [Attempt(work("late", "1_rotation"), late=True)]}))
    packed(folder / "lab.zip", downloads.blackboard({BO: [Attempt(work("b"))]}))
    outcome = collect(course, [folder])
    assert set(submitted()) == {"48288", "bo_cruz"} and {came.form.name for came in outcome.came} == {
        "canvas",
        "blackboard",
    }
