"""Each system's downloads, from its rule to submitted/: the right students, the right bytes, the newest, and nothing lost."""

from datetime import UTC
from pathlib import Path

import downloads
import pytest
from downloads import ODD, START, Attempt, Student, later, of_30, packed, unpacked

from autograder.collecting.collect import collect
from autograder.collecting.people import folder_name
from autograder.collecting.systems import FORMS
from autograder.collecting.told import needs_a_look
from autograder.course import CourseError


def by_login(student):
    return student.login


def by_email(student):
    return student.email


def by_number(student):
    return str(student.number)


def by_name(student):
    return folder_name(downloads.moodle_name(student.full))


def by_full_name(student):
    return folder_name(student.full)


def by_ilias(student):
    """A login with `_`, or a name with odd letters: nothing tells where it begins, so the folder is called as ILIAS called it."""
    whole = downloads.ilias_name(f"{student.last}_{student.first}_{student.login}_{student.number}")
    return student.login if whole.count("_") == 3 else folder_name(whole)


# name: (builder, system, what a student is called without a class list, whether it gives the time)
SYSTEMS = {
    "canvas": (downloads.canvas, "canvas", by_number, False),
    "moodle": (downloads.moodle, "moodle", by_name, False),
    "moodle before 4.1": (downloads.moodle_old, "moodle", by_name, False),
    "moodle flat": (downloads.moodle_flat, "moodle", by_name, False),
    "blackboard": (downloads.blackboard, "blackboard", by_login, True),
    "brightspace": (downloads.brightspace, "brightspace", by_full_name, True),
    "brightspace flat": (downloads.brightspace_flat, "brightspace", by_full_name, True),
    "gradescope": (downloads.gradescope, "gradescope", by_email, True),
    "ilias": (downloads.ilias, "ilias", by_ilias, False),
    "ilias team": (downloads.ilias_team, "ilias", by_ilias, False),
    "sakai": (downloads.sakai, "sakai", by_login, True),
    "sakai flat": (downloads.sakai_flat, "sakai", by_login, True),
    "sakai before": (downloads.sakai_old, "sakai", by_login, True),
    "edx": (downloads.edx, "edx", by_login, False),
    "teams": (downloads.teams, "teams", by_full_name, False),
    "teams in japanese": (downloads.teams_japanese, "teams", by_full_name, False),
    "plain": (downloads.plain, "plain", by_login, False),
}


def accounted(files, outcome):
    """Whether each file of a download is in submitted/ now, or was named among what was left."""
    taken = {name for _, name in outcome.taken}
    left = {name for some in outcome.left.values() for one in some for name in one.files}

    def covered(path):
        parts = Path(path).parts
        return any("/".join(parts[i:]) in taken | left for i in range(len(parts)))

    return [path for path in files if not covered(path)]


def state(folder):
    """All below a folder, with contents and dates."""
    return {path: (path.read_bytes(), path.stat().st_mtime_ns) for path in sorted(folder.rglob("*")) if path.is_file()}


@pytest.mark.parametrize("name", SYSTEMS)
@pytest.mark.parametrize(
    "students, form",
    [
        pytest.param(ODD, "zip", id="odd names"),
        pytest.param(of_30(), "zip", id="30", marks=pytest.mark.slow),
        pytest.param(of_30(), "folder", id="30 unpacked", marks=pytest.mark.slow),
    ],
)
def test_a_class_comes_out_as_it_handed_in(course, submitted, work, tmp_path, name, students, form):
    build, system, called, timed = SYSTEMS[name]
    handed_in = {student: work(student.login) | {"helper.py": b"x = 1"} for student in students}
    files = build({student: [Attempt(mine)] for student, mine in handed_in.items()})
    where = (
        packed(tmp_path / "submissions (1).zip", files) if form == "zip" else unpacked(tmp_path / "submissions", files)
    )
    outcome = collect(course, [where])
    assert {came.form.name for came in outcome.came} == {system}
    found = submitted()
    assert set(found) == {called(student) for student in students}
    for student, mine in handed_in.items():
        theirs = found[called(student)]
        stamp = theirs.pop("timestamp.txt", b"").decode()
        zoned = START.replace(tzinfo=UTC) if system in ("gradescope", "sakai") else START.astimezone(UTC)
        assert stamp.startswith(f"{zoned:%Y-%m-%d %H:%M}" if timed else "") and timed == bool(stamp)
        assert theirs == mine, student
    assert not accounted(files, outcome)
    assert not [one for left in outcome.left.values() for one in left if one.look]

    before = state(course.root)
    again = collect(course, [where])
    assert state(course.root) == before
    assert not any(came.written for came in again.came) and not any(came.look for came in again.came)


@pytest.mark.parametrize("name", [name for name in SYSTEMS if name != "edx"])
def test_a_single_student_is_enough_to_see_the_system(course, submitted, work, tmp_path, name):
    build, system, called, _ = SYSTEMS[name]
    student = ODD[0]
    outcome = collect(course, [packed(tmp_path / "a.zip", build({student: [Attempt(work("ana"))]}))])
    assert [(came.form.name, came.student) for came in outcome.came] == [(system, called(student))]
    assert work("ana").items() <= submitted()[called(student)].items()


def write_list(path, students, head="id,first_name,last_name,email,lms_user_id"):
    rows = [f'{s.login},"{s.first}","{s.last}",{s.email},{s.number}' for s in students]
    path.write_text("\n".join([head, *rows]), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", SYSTEMS)
def test_with_a_class_list_everybody_has_their_own_id(course, submitted, work, tmp_path, name):
    build, _, _, _ = SYSTEMS[name]
    files = build({student: [Attempt(work(student.login))] for student in ODD[:-1]})
    listed = write_list(tmp_path / "list.csv", ODD)
    outcome = collect(course, [packed(tmp_path / "a.zip", files)], [listed])
    found = submitted()
    assert set(found) == {student.login for student in ODD[:-1]}
    for student in ODD[:-1]:
        assert work(student.login).items() <= found[student.login].items()
    assert outcome.missing == [ODD[-1].login]


@pytest.mark.parametrize("name", SYSTEMS)
def test_the_same_students_after_a_class_list_is_there(course, submitted, work, tmp_path, slow, name):
    """Who was known by a name or a number stays the same student when a list tells all of them."""
    build, _, called, _ = SYSTEMS[name]
    files = build({student: [Attempt(work(student.login))] for student in ODD})
    where = packed(tmp_path / "a.zip", files)
    collect(course, [where])
    before = submitted()
    outcome = collect(course, [where], [write_list(tmp_path / "list.csv", ODD)])
    assert submitted() == before and not outcome.missing
    assert not any(came.look for came in outcome.came)


# --- again, and late ------------------------------------------------------------------------------------------------

AGAIN = ["canvas", "blackboard", "brightspace", "ilias", "teams"]


@pytest.mark.parametrize("name", AGAIN)
def test_the_newest_of_each_notebook_counts(course, submitted, work, tmp_path, name):
    build, _, called, _ = SYSTEMS[name]
    ana = ODD[0]
    last = work("third", "1_rotation") | ({} if name != "canvas" else work("second", "2_homogeneous_transforms"))
    attempts = [
        Attempt(work("first", "1_rotation", "3_chaining") if name != "canvas" else work("first")),
        Attempt(work("second", "1_rotation", "2_homogeneous_transforms"), later(1)),
        Attempt(last, later(25)),
    ]
    files = build({ana: attempts})
    collect(course, [packed(tmp_path / "a.zip", files)])
    found = submitted()[called(ana)]
    assert found["1_rotation.ipynb"] == work("third")["1_rotation.ipynb"]
    assert found["2_homogeneous_transforms.ipynb"] == work("second")["2_homogeneous_transforms.ipynb"]
    if name != "canvas":  # of which the last attempt comes alone
        assert found["3_chaining.ipynb"] == work("first")["3_chaining.ipynb"]


def test_canvas_shows_how_often_a_name_was_uploaded(course, submitted, work, tmp_path):
    ana = ODD[0]
    for times in (1, 2, 9, 10):
        files = downloads.canvas({ana: [Attempt(work(f"try {i}", "1_rotation")) for i in range(times)]})
        (name,) = files
        assert name.endswith({1: "1_rotation.ipynb", 2: "1_rotation-1.ipynb"}.get(times, f"-{downloads.UUID}.ipynb"))
        collect(course, [packed(tmp_path / f"{times}.zip", files)])
        assert submitted()["48288"] == work(f"try {times - 1}", "1_rotation")


@pytest.mark.parametrize("name", ["canvas", "ilias", "sakai"])
def test_late_work_is_told(course, work, tmp_path, name):
    build, _, called, _ = SYSTEMS[name]
    files = build({student: [Attempt(work(student.login), late=student == ODD[0])] for student in ODD[:3]})
    outcome = collect(course, [packed(tmp_path / "a.zip", files)])
    assert {came.student: came.late for came in outcome.came} == {called(s): s == ODD[0] for s in ODD[:3]}


def test_a_text_in_place_of_a_file_is_told(course, submitted, work, tmp_path):
    for name in ("canvas", "moodle", "moodle flat", "blackboard", "sakai"):
        build, *_ = SYSTEMS[name]
        ana, bo = ODD[0], ODD[2]
        files = build({ana: [Attempt({}, text="<p>My answer</p>")], bo: [Attempt(work("bo"))]})
        outcome = collect(course, [packed(tmp_path / f"{name}.zip", files)])
        (left,) = [one for some in outcome.left.values() for one in some if one.look]
        assert "a text" in left.why and left.whose, name
        assert not accounted(files, outcome)


# --- what one system alone has --------------------------------------------------------------------------------------


def test_canvas_anonymous_names_nobody_until_a_list_does(course, submitted, work, tmp_path):
    files = downloads.canvas_anonymous({s: [Attempt(work(s.login), late=s == ODD[1])] for s in ODD[:3]})
    assert any(name.startswith("LATE_anon_") for name in files)
    where = packed(tmp_path / "a.zip", files)
    outcome = collect(course, [where])
    assert submitted() == {} and not accounted(files, outcome)
    reasons = [one for some in outcome.left.values() for one in some]
    assert len(reasons) == 3 and all(
        "columns id,number, and a row STUDENT,NUMBER" in one.why and one.whose for one in reasons
    )
    code = next(name for name in files if not name.startswith("LATE")).split("_")[1]
    (tmp_path / "codes.csv").write_text(f"id,number\nana,{code}\n")
    collect(course, [where], [tmp_path / "codes.csv"])
    assert list(submitted()) == ["ana"] and submitted()["ana"] == work(ODD[0].login)


def test_canvas_gives_a_groups_work_to_all_its_members(course, submitted, work, tmp_path):
    files = downloads.canvas({ODD[0]: [Attempt(work("group"))]}, who=lambda _: downloads.canvas_name("Group 7"))
    where = packed(tmp_path / "a.zip", files)
    rows = [f'"{s.full}",{s.number},{s.login},{s.login},,{"Group 7" if s in ODD[:2] else ""}' for s in ODD]
    path = tmp_path / "groups.csv"
    path.write_text("\n".join(["name,canvas_user_id,user_id,login_id,sections,group_name", *rows]), encoding="utf-8")
    outcome = collect(course, [where], [path])
    assert submitted() == {student.login: work("group") for student in ODD[:2]}
    assert not any(came.remarks for came in outcome.came)


def test_a_group_of_canvas_without_a_list_of_groups_is_told(course, submitted, work, tmp_path):
    files = downloads.canvas({ODD[0]: [Attempt(work("group"))]}, who=lambda _: downloads.canvas_name("Group 7"))
    outcome = collect(course, [packed(tmp_path / "a.zip", files)], [write_list(tmp_path / "list.csv", ODD)])
    (came,) = outcome.came
    assert came.student == ODD[0].login and came.look and "perhaps a group's" in came.remarks[0]


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
def test_moodles_worksheet_tells_who_is_blind(course, submitted, work, tmp_path, delimiter):
    files = downloads.moodle_blind({s: [Attempt(work(s.login))] for s in ODD})
    where = packed(tmp_path / "a.zip", files)
    outcome = collect(course, [where])
    assert submitted() == {} and not accounted(files, outcome)
    assert all("grading worksheet" in one.why for some in outcome.left.values() for one in some)
    path = tmp_path / "worksheet.csv"
    path.write_text(downloads.moodle_worksheet(ODD, delimiter), encoding="utf-8")
    collect(course, [where], [path])
    assert submitted() == {student.email: work(student.login) for student in ODD}


def test_two_people_of_one_name_in_moodle_stop_alone_and_the_worksheet_tells_them_apart(
    course, submitted, work, tmp_path
):
    twins = [Student("Kim", "Lee", "kim1", 1), Student("Kim", "Lee", "kim2", 2)]
    files = downloads.moodle({s: [Attempt(work(s.login))] for s in [*twins, ODD[0]]})
    where = packed(tmp_path / "a.zip", files)
    outcome = collect(course, [where])
    assert submitted() == {by_name(ODD[0]): work(ODD[0].login)} and not accounted(files, outcome)
    reasons = [one for some in outcome.left.values() for one in some]
    assert len(reasons) == 2 and all("several people in this download have one name" in one.why for one in reasons)
    listed = write_list(tmp_path / "list.csv", [*twins, ODD[0]])
    outcome = collect(course, [where], [listed])
    assert len([one for some in outcome.left.values() for one in some]) == 2  # the list has no number of Moodle's
    (tmp_path / "worksheet.csv").write_text(downloads.moodle_worksheet([*twins, ODD[0]]), encoding="utf-8")
    collect(course, [where], [listed, tmp_path / "worksheet.csv"])
    assert submitted() == {"kim1": work("kim1"), "kim2": work("kim2"), by_name(ODD[0]): work(ODD[0].login)}


def test_one_name_under_two_numbers_is_nobody_even_where_the_list_has_it_once(course, submitted, work, tmp_path):
    twins = [Student("Kim", "Lee", "kim1", 1), Student("Kim", "Lee", "kim2", 2)]
    files = downloads.moodle({s: [Attempt(work(s.login))] for s in [*twins, ODD[0]]})
    collect(course, [packed(tmp_path / "a.zip", files)], [write_list(tmp_path / "list.csv", [twins[0], ODD[0]])])
    assert set(submitted()) == {ODD[0].login}


def test_a_name_that_all_have_is_the_word_for_participant(course, submitted, work, tmp_path):
    def left(students, *lists):
        files = downloads.moodle({s: [Attempt(work(s.login))] for s in students}, who=lambda _: "Osaleja")
        outcome = collect(course, [packed(tmp_path / "a.zip", files)], lists)
        assert submitted() == {}
        return [one for some in outcome.left.values() for one in some]

    assert {one.whose for one in left(ODD[:3])} == {"no. 1048288", "no. 1048291", "no. 1048300"}
    assert all("several people in this download have one name" in one.why for one in left(ODD[:2]))
    (tmp_path / "list.csv").write_text("id,name\no,Osaleja\n")
    assert all(
        "several people in this download have one name" in one.why for one in left(ODD[:3], tmp_path / "list.csv")
    )


def test_moodles_groups(course, submitted, work, tmp_path):
    old = {"Team A-Ana García-Núñez_17_assignsubmission_file_/1_rotation.ipynb": work("a")["1_rotation.ipynb"]}
    new = {
        "Team A_4_assignsubmission_file/1_rotation.ipynb": work("b")["1_rotation.ipynb"],
        "Default group_assignsubmission_file/1_rotation.ipynb": work("c")["1_rotation.ipynb"],
    }
    path = tmp_path / "list.csv"
    rows = [f"{s.login},{s.first},{s.last},{'Team A' if s in ODD[:3:2] else ''}" for s in ODD]
    path.write_text("\n".join(["username,first name,surname,group", *rows]), encoding="utf-8")
    outcome = collect(course, [packed(tmp_path / "new.zip", new)])
    assert submitted() == {} and not accounted(new, outcome)
    collect(course, [packed(tmp_path / "new.zip", new)], [path])
    assert submitted() == {s.login: work("b", "1_rotation") for s in ODD[:3:2]}
    collect(course, [packed(tmp_path / "old.zip", old)], [path])
    assert submitted()[ODD[0].login] == work("a", "1_rotation")


def test_moodles_groups_without_a_list_are_no_people(course, submitted, work, tmp_path):
    new = {f"{name}_99{i}_assignsubmission_file/{path}": content
           for i, name in enumerate(("Team A", "Gruppe 12", "Lab group B")) for path, content in work(i).items()}  # fmt: skip
    outcome = collect(course, [packed(tmp_path / "new.zip", new)])
    assert submitted() == {} and not accounted(new, outcome)
    whose = {"Team A-Ana G-N": "a", "Team A-Bo Cruz": "a", "Default group-Pat Lee": "p", "Team B-Kim Lee": "k"}
    whose |= {"Jean-Paul X": "j", "Jean-Luc X": "j"}
    old = {f"{name}_{1234 + i}_assignsubmission_file_/{path}": content
           for i, (name, mine) in enumerate(whose.items()) for path, content in work(mine).items()}  # fmt: skip
    outcome = collect(course, [packed(tmp_path / "old.zip", old)])
    both = {name: work("a") for name in ("Ana_G-N", "Bo_Cruz")}
    assert submitted() == both | {"Pat_Lee": work("p"), "Jean-Paul_X": work("j"), "Jean-Luc_X": work("j")}
    assert {one.whose for some in outcome.left.values() for one in some} == {"Team B-Kim Lee (no. 1237)"}


@pytest.mark.parametrize(
    "folder", ["BAE,WOOJIN-2018147546_6130510", "Woojin Bae__wbaeATexample.org__6130510", "wbae Woojin Bae_6130510"]
)
def test_moodles_sites_that_put_more_into_a_name(course, submitted, work, tmp_path, folder):
    files = {f"{folder}_assignsubmission_file_/{name}": content for name, content in work("w").items()}
    path = tmp_path / "list.csv"
    path.write_text(
        "Username,First name,Surname,ID number,Email address\nwbae,Woojin,Bae,2018147546,wbae@example.org\n"
    )
    collect(course, [packed(tmp_path / "a.zip", files)], [path])
    assert submitted() == {"wbae": work("w")}


def test_moodle_keeps_the_folders_of_a_student(course, submitted, work, tmp_path):
    files = {f"Ana X_7_assignsubmission_file/lab/{name}": c for name, c in work("a").items()}
    files["Ana X_7_assignsubmission_file/lab/tools/own.py"] = b"1"
    collect(course, [packed(tmp_path / "a.zip", files)])
    assert submitted() == {"Ana_X": work("a") | {"lab/tools/own.py": b"1"}}


def test_blackboard_without_receipts_and_with_names_that_hold_underscores(course, submitted, work, tmp_path):
    files = downloads.blackboard({s: [Attempt(work(s.login))] for s in ODD})
    files = {name: content for name, content in files.items() if not name.endswith(".txt")}
    collect(course, [packed(tmp_path / "a.zip", files)])
    assert set(submitted()) == {student.login for student in ODD}


def test_blackboards_receipts_give_the_names_that_students_gave(course, submitted, work, tmp_path):
    files = downloads.blackboard({ODD[0]: [Attempt({"my tools.py": b"1", **work("a")})]})
    assert any(name.endswith("my_tools.py") for name in files)
    collect(course, [packed(tmp_path / "a.zip", files)])
    assert submitted()["agarcia"]["my tools.py"] == b"1"


def test_gradescopes_groups_and_those_without_anybody(course, submitted, work, tmp_path):
    files = downloads.gradescope({ODD[0]: [Attempt(work("both"))]}, groups=[ODD[:2]])
    metadata = files["assignment_99_export/submission_metadata.yml"]
    files["assignment_99_export/submission_metadata.yml"] = metadata + b"submission_5:\n  :submitters: []\n"
    files["assignment_99_export/submission_5/1_rotation.ipynb"] = b"{}"
    outcome = collect(course, [packed(tmp_path / "a.zip", files)])
    found = submitted()
    assert set(found) == {student.email for student in ODD[:2]}
    assert all(work("both").items() <= mine.items() for mine in found.values())
    assert not accounted(files, outcome)


def test_ilias_makes_two_files_of_one_only_where_they_are_two(course, submitted, work, tmp_path):
    work_of = [Attempt(work("old", "1_rotation"), late=False), Attempt(work("new", "1_rotation"), late=True)]
    outcome = collect(course, [packed(tmp_path / "a.zip", downloads.ilias({ODD[0]: work_of}))])
    assert not outcome.came[0].look and outcome.came[0].late
    assert submitted() == {"agarcia": work("new", "1_rotation")}


def test_sakais_plus_one_is_another_file_and_not_a_newer_one(course, submitted, work, tmp_path):
    mine = work("one", "1_rotation") | {"1_rotation+1.ipynb": work("two")["1_rotation.ipynb"]}
    outcome = collect(course, [packed(tmp_path / "a.zip", downloads.sakai({ODD[0]: [Attempt(mine)]}))])
    assert work("one", "1_rotation").items() <= submitted()["agarcia"].items()
    assert outcome.came[0].look and "nothing says which is newer" in outcome.came[0].remarks[0]


def test_sakai_in_an_unknown_language_shows_in_which_folder_a_file_lies(course, work, tmp_path):
    files = downloads.sakai({ODD[0]: [Attempt(work("a", "1_rotation"))]}, word="Liitteet")
    (path,) = (name for name in files if name.endswith("1_rotation.ipynb"))
    files[path.replace("Liitteet", "Palaute")] = work("teacher")["1_rotation.ipynb"]
    (came,) = collect(course, [packed(tmp_path / "a.zip", files)]).came
    assert (
        came.look and "Liitteet/1_rotation.ipynb" in came.remarks[0] and "Palaute/1_rotation.ipynb" in came.remarks[0]
    )


@pytest.mark.parametrize("between", ["; ", ";\n", "\r\n", "\n"])
def test_sakais_members_stand_in_one_line_or_in_several(course, submitted, work, tmp_path, between):
    members = between.join(("García-Núñez, Ana(agarcia)", "O'Brien, Pat(pobrien)", ""))
    files = {"Lab/Cruz, Bo/members.txt": members.encode()}
    files |= {f"Lab/Cruz, Bo/Submission attachment(s)/{name}": content for name, content in work("both").items()}
    outcome = collect(course, [packed(tmp_path / "a.zip", files)])
    assert submitted() == {who: work("both") for who in ("agarcia", "pobrien")}
    assert {came.who.name for came in outcome.came} == {"García-Núñez, Ana", "O'Brien, Pat"}


def test_sakais_groups_and_anonymous_folders(course, submitted, work, tmp_path):
    files = {
        "Lab/Cruz, Bo/members.txt": "García-Núñez, Ana(agarcia); O'Brien, Pat(pobrien); ".encode(),
        "Lab/Cruz, Bo/timestamp.txt": b"2026-11-18T17:34:00.861Z",
        **{f"Lab/Cruz, Bo/Submission attachment(s)/{name}": content for name, content in work("both").items()},
        f"Lab/{downloads.UUID} Anonymous/timestamp.txt": b"",
        f"Lab/{downloads.UUID} Anonymous/Submission attachment(s)/1_rotation.ipynb": b"{}",
        "Lab/grades.csv": b"",
    }
    outcome = collect(course, [packed(tmp_path / "a.zip", files)])
    assert set(submitted()) == {"agarcia", "pobrien"} and not accounted(files, outcome)
    assert downloads.UUID in next(one.whose for some in outcome.left.values() for one in some if one.look)


def test_edx_names_nobody_by_32_digits(course, submitted, work, tmp_path):
    nobody = Student("", "", "0123456789abcdef" * 2, 1)
    files = downloads.edx({nobody: [Attempt(work("x"))], ODD[0]: [Attempt(work("a"))]})
    outcome = collect(course, [packed(tmp_path / "a.zip", files)])
    assert set(submitted()) == {"agarcia"} and not accounted(files, outcome)


def test_edx_knows_the_assignment_by_cells_where_names_say_nothing(course, submitted, work, tmp_path):
    mine = {f"file {i}.ipynb": content for i, content in enumerate(work("a").values())}
    collect(course, [packed(tmp_path / "a.zip", downloads.edx({ODD[0]: [Attempt(mine)]}))])
    assert submitted() == {"agarcia": work("a")}
    other = {"essay.ipynb": b'{"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}'}
    outcome = collect(course, [packed(tmp_path / "b.zip", downloads.edx({ODD[0]: [Attempt(other)]}))])
    assert not outcome.came and needs_a_look(outcome)


def test_edx_finds_the_whole_name_in_its_table(course, submitted, work, tmp_path):
    long = "tools" * 60 + ".py"
    files = downloads.edx({ODD[0]: [Attempt(work("a"))]})
    path = f"[1]Week 3, [2]Transforms, [1]Lab/[9] - agarcia - {long}"[:255]
    files |= {
        path: b"1",
        "submissions.csv": files["submissions.csv"] + f'\nc,b,f,k,"own.py",file,,1,"{path}",True'.encode(),
    }
    collect(course, [packed(tmp_path / "a.zip", files)])
    assert submitted()["agarcia"]["own.py"] == b"1"


def test_github_classroom(course, submitted, work, tmp_path):
    import subprocess

    folder = tmp_path / "transforms-lab-submissions"
    for login in ("ana-b", "ana-c"):
        clone = unpacked(folder / f"transforms-lab-{login}", work(login) | {".github/workflows/a.yml": b""})
        environment = {"GIT_COMMITTER_DATE": "2026-11-18T18:34:05+01:00", "PATH": "/usr/bin:/bin"}
        git = ["git", "-C", clone, "-c", "user.name=a", "-c", "user.email=a@example.org"]
        subprocess.run(["git", "init", "-q", clone], check=True)
        subprocess.run([*git, "add", "-A"], check=True)
        subprocess.run([*git, "commit", "-qm", "work"], check=True, env=environment)
    collect(course, [folder])
    assert submitted() == {
        login: work(login) | {"timestamp.txt": b"2026-11-18 17:34:05.000000 UTC\n"} for login in ("ana-b", "ana-c")
    }


def test_zip_files_of_students(course, submitted, work, tmp_path):
    folder = unpacked(tmp_path / "all", {"ana.zip": b"PK\5\6" + bytes(18), "bo.zip": b"PK\5\6" + bytes(18)})
    collect(course, [folder])
    assert submitted() == {name: {f"{name}.zip": b"PK\5\6" + bytes(18)} for name in ("ana", "bo")}


# --- which system it is ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "files",
    [
        {"1_rotation.ipynb": b"{}"},
        {"Ana Garcia - 1_rotation.ipynb": b"{}", "Bo - 1_rotation.ipynb": b"{}"},
        {"readme.txt": b""},
    ],
)
def test_what_is_of_no_system_is_refused_with_those_that_are_known(course, tmp_path, files):
    with pytest.raises(CourseError) as refused:
        collect(course, [packed(tmp_path / "a.zip", files)])
    for name in ("Canvas", "Moodle", "Blackboard (Original)", "Google Classroom", "Blackboard Ultra"):
        assert name in str(refused.value)
    assert not (course.root / "submitted").exists()


@pytest.mark.parametrize(
    "system, says", [("ultra", "Blackboard Ultra"), ("google", "Google Classroom"), ("x", "choose from canvas")]
)
def test_a_system_that_is_asked_for_and_not_known(course, tmp_path, system, says):
    with pytest.raises(CourseError, match=says):
        collect(course, [packed(tmp_path / "a.zip", {"a": b""})], system=system)


def test_an_empty_download_is_said(course, tmp_path):
    with pytest.raises(CourseError) as refused:
        collect(course, [packed(tmp_path / "a.zip", {})])
    assert str(refused.value) == "a: there is no file to be taken in it."


def test_a_system_that_is_asked_for_counts(course, submitted, work, tmp_path):
    files = downloads.canvas({ODD[0]: [Attempt(work("a"))]}) | {f"notes {i}.txt": b"" for i in range(20)}
    where = packed(tmp_path / "a.zip", files)
    with pytest.raises(CourseError):
        collect(course, [where])
    outcome = collect(course, [where], system="canvas")
    assert set(submitted()) == {"48288"} and not accounted(files, outcome)


def test_folders_around_a_download_do_not_matter(course, submitted, work, tmp_path):
    for name in ("moodle", "brightspace", "gradescope", "canvas", "sakai"):
        build, system, *_ = SYSTEMS[name]
        files = build({student: [Attempt(work(student.login))] for student in ODD})
        files = {f"submissions (1)/Lab 3/{path}": content for path, content in files.items()}
        files |= {"__MACOSX/submissions (1)/._x": b"", "submissions (1)/.DS_Store": b""}
        outcome = collect(course, [packed(tmp_path / f"{name}.zip", files)], dry_run=True)
        assert {came.form.name for came in outcome.came} == {system} and len(outcome.came) == len(ODD)


@pytest.mark.parametrize("around", ["Transforms/", "dl/Transforms (1)/"])
@pytest.mark.parametrize("who", [ODD[:2], ODD[:1]])
def test_folders_around_students_folders_do_not_matter(course, submitted, work, tmp_path, around, who):
    files = {around + path: c for path, c in downloads.plain({s: [Attempt(work(s.login))] for s in who}).items()}
    files["__MACOSX/Transforms/._x"] = b""
    collect(course, [packed(tmp_path / "Transforms.zip", files)])
    assert submitted() == {s.login: work(s.login) for s in who}


def test_zip_files_and_nbgraders_folders_in_a_folder(course, submitted, work, tmp_path):
    files = {f"submitted/ana/transforms/{name}": content for name, content in work("a").items()}
    collect(course, [packed(tmp_path / "a.zip", files)])
    assert submitted() == {"ana": work("a")}
    files = {f"Transforms/{name}.zip": b"PK\5\6" + bytes(18) for name in ("bo", "pat")}
    collect(course, [packed(tmp_path / "b.zip", files)])
    assert set(submitted()) == {"ana", "bo", "pat"}


@pytest.mark.parametrize(
    "others",
    [{"notes.txt"}, {"Transforms/notes.txt", "Transforms/1_rotation.ipynb"}, {"Transforms/pat.zip"}],
)
def test_people_are_never_merged(course, work, tmp_path, others):
    files = {f"Transforms/{who}/{name}": c for who in ("ana", "bo") for name, c in work(who).items()}
    with pytest.raises(CourseError, match="nothing tells whether Transforms is a student's folder"):
        collect(course, [packed(tmp_path / "a.zip", files | dict.fromkeys(others, b"1"))])
    assert not (course.root / "submitted").exists()


@pytest.mark.parametrize("name, top", [("a", "Transforms"), ("Lab-2026-001", "Lab"), ("a", "Homework 3")])
def test_loose_notebooks_of_several_people_in_one_folder_are_refused(course, work, tmp_path, name, top):
    files = {f"{top}/{file}": content for file, content in work("a").items()}
    if top == "Homework 3":
        files[f"{top}/1_rotation (1).ipynb"] = b"{}"
    with pytest.raises(CourseError, match="(?s)Google Classroom.*called as the student is"):
        collect(course, [packed(tmp_path / f"{name}.zip", files)])
    assert not (course.root / "submitted").exists()


def test_one_download_in_a_folder_is_that_download(course, submitted, work, tmp_path):
    files = downloads.canvas({ODD[0]: [Attempt(work("a"))]})
    folder = tmp_path / "dl"
    folder.mkdir()
    inner = packed(folder / "submissions.zip", files)
    collect(course, [folder])
    assert submitted() == {"48288": work("a")}
    unpacked(folder / "submissions", files)
    collect(course, [folder])
    assert submitted() == {"48288": work("a")}
    (folder / "notes.txt").write_text("1")
    for bad in (folder, packed(tmp_path / "outer.zip", {"submissions.zip": inner.read_bytes()})):
        with pytest.raises(CourseError, match=r"submissions(.zip)? in it is a download of its own \(Canvas"):
            collect(course, [bad])


def test_every_system_has_its_downloads_here():
    assert {system for _, system, _, _ in SYSTEMS.values()} | {"github"} == set(FORMS)
