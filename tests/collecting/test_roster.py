"""Class lists as systems export them: their columns, their separators, and rows that are nobody."""

import pytest

from autograder.collecting import roster
from autograder.collecting.people import People
from autograder.collecting.systems import FORMS
from autograder.course import CourseError


def read(tmp_path, *texts, encoding="utf-8"):
    people = People(FORMS.values())
    for i, text in enumerate(texts):
        path = tmp_path / f"{i}.csv"
        path.write_bytes(text.encode(encoding))
        roster.read(path, people)
    return people


CANVAS = """\
Student,ID,SIS User ID,SIS Login ID,Section,Lab (7)
,,,,,Manual Posting
    Points Possible,,,,,10
"García-Núñez, Ana",48288,0012,agarcia,A,
"Student, Test",99,,x,A,
"""
LISTS = {
    "canvas": (CANVAS, "agarcia"),
    "canvas, with a mark": ("\ufeff" + CANVAS, "agarcia"),
    "moodle's participants": (
        "First name,Surname,ID number,Email address\nAna,García-Núñez,0012,ana@example.org\n", "ana@example.org",
    ),
    "moodle's worksheet": (
        '\ufeffIdentifier,"Full name","Email address",Status\n"Participant 12","Ana García-Núñez",ana@example.org,-\n',
        "ana@example.org",
    ),
    "in German": ("Vorname;Nachname;Anmeldename;E-Mail-Adresse\nAna;García-Núñez;agarcia;ana@example.org\n", "agarcia"),
    "blackboard": (
        '"Last Name"\t"First Name"\t"Username"\t"Student ID"\n"García-Núñez"\t"Ana"\t"agarcia"\t"0012"\n',
        "agarcia",
    ),
    "brightspace": (
        "OrgDefinedId,Username,Last Name,First Name,End-of-Line Indicator\n#0012,#agarcia,García-Núñez,Ana,#\n",
        "agarcia",
    ),
    "gradescope": ("First Name,Last Name,SID,Email,Sections\nAna,García-Núñez,0012,ana@example.org,\n", "ana@example.org"),
    "sakai": (
        '"Transforms","Points"\n\n"Display ID","ID","Last Name","First Name","grade"\n"agarcia","u-7","García-Núñez","Ana",""\n',
        "agarcia",
    ),
    "nbgrader": (
        "id,first_name,last_name,email,lms_user_id\nagarcia,Ana,García-Núñez,ana@example.org,48288\n", "agarcia",
    ),
    "github": ('"identifier","github_username","github_id","name"\n"agarcia","anag","1","Ana García-Núñez"\n', "agarcia"),
    "moodle's worksheet in German": (
        "Kennung;Vollständiger Name;E-Mail-Adresse\nTeilnehmer/in 12;Ana García-Núñez;ana@example.org\n", "ana@example.org",
    ),
    "with an ID that is a number": (
        "ID;Vollständiger Name;E-Mail-Adresse\nTeilnehmer/in 12;Ana García-Núñez;ana@example.org\n", "ana@example.org",
    ),
    "gradescope with roles": (
        "Name,SID,Email,Role\nAna García-Núñez,0012,ana@example.org,Student\nPat Lee,7,p@example.org,Instructor\n"
        "Kim Lee,8,k@example.org,TA\n", "ana@example.org",
    ),
    "names alone": ("Name\nAna García-Núñez\n", "Ana_García-Núñez"),
}  # fmt: skip


@pytest.mark.parametrize("name", LISTS)
def test_a_list_is_known_by_its_columns(tmp_path, name):
    text, identifier = LISTS[name]
    people = read(tmp_path, text)
    (person,) = people.all.values()
    assert person.id == identifier and person.listed
    assert "García-Núñez, Ana" in person.variants()


def test_what_lists_say(tmp_path):
    (person,) = read(
        tmp_path, *(text for name, (text, _) in LISTS.items() if name not in ("github", "names alone"))
    ).all.values()
    assert person.keys["lms_id"] == {"48288"} and "agarcia" in person.keys["login"] and person.keys["number"] == {"12"}
    assert person.keys["sid"] == {"0012"} and (person.first, person.last) == ("Ana", "García-Núñez")


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "cp1252"])
def test_as_spreadsheets_save_them(tmp_path, encoding):
    (person,) = read(
        tmp_path, "Username;First name;Surname\nagarcia;Ana;García-Núñez\n", encoding=encoding
    ).all.values()
    assert person.last == "García-Núñez"


@pytest.mark.parametrize("text", ["", "a,b\n1,2\n", "PK\3\4", "grade,points\n1,2\n"])
def test_what_is_no_list_is_refused(tmp_path, text):
    with pytest.raises(CourseError, match="this is no class list"):
        read(tmp_path, text)


def test_a_list_that_is_not_there(tmp_path):
    with pytest.raises(CourseError, match="No such file"):
        roster.read(tmp_path / "none.csv", People())


def test_two_of_one_name_stay_two_where_anything_tells_them_apart(tmp_path):
    people = read(tmp_path, "name,email\nKim Lee,k1@example.org\nKim Lee,k2@example.org\n")
    assert set(people.all) == {"k1@example.org", "k2@example.org"}
    people = read(tmp_path, "name,number\nKim Lee,1\n", "id,name\nother,Jo Lee\n")
    assert set(people.all) == {"Kim_Lee", "other"}
    with pytest.raises(CourseError, match="this name twice"):
        read(tmp_path, "name\nKim Lee\nKim Lee\n")
    with pytest.raises(CourseError, match="already another student"):
        read(tmp_path, "name,number\nKim Lee,1\nKim Lee,2\n")


def test_one_id_of_two_people_is_said_with_both(tmp_path):
    rows = "agarcia,Ana García,ana@example.org\nagarcia,Bo Cruz,bo@example.org\n"
    with pytest.raises(CourseError, match=r"Ana García \(.*\) and Bo Cruz \(.*\): two people of one id, agarcia"):
        read(tmp_path, "id,name,email\n" + rows)
    with pytest.raises(CourseError, match="two people of one id, agarcia"):
        read(tmp_path, "username,name,email\n" + rows)
    people = read(tmp_path, 'id,name,email\nagarcia,Ana García,ana@example.org\nagarcia,"García, Ana",a2@example.org\n')
    assert set(people.all) == {"agarcia"}


def test_a_full_name_goes_into_the_table_in_two(tmp_path):
    (person,) = read(tmp_path, "Kennung;Vollständiger Name\nTeilnehmer/in 12;Ana Maria García\n").all.values()
    assert (person.first, person.last) == ("Ana Maria", "García") and person.keys["number"] == {"12"}


def test_which_columns_were_understood_is_said(tmp_path):
    with pytest.raises(CourseError, match="Understood was gruppe, role alone."):
        read(tmp_path, "Gruppe,Role,Note\nA,Learner,1\n")
    with pytest.raises(CourseError, match="No column was understood."):
        read(tmp_path, "a,b\n1,2\n")
