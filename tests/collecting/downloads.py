"""Made-up downloads, built by each system's own rule: how it changes names, what it puts beside students' files.

The rules are those that the modules of autograder/collecting/ cite, written once more and from the other side. Every
builder takes {Student: Work} and gives {path: bytes}.
"""

import json
import re
import string
import unicodedata
import zipfile
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta

START = datetime(2026, 11, 18, 17, 34, 5)
UUID = "0b8f3a52-91aa-4c4e-9d3e-5f1f2a3b4c5d"


@dataclass(frozen=True)
class Student:
    first: str
    last: str
    login: str
    number: int

    @property
    def email(self):
        return f"{self.login}@example.org"

    @property
    def full(self):
        return f"{self.first} {self.last}"

    @property
    def sortable(self):
        return f"{self.last}, {self.first}"


@dataclass
class Attempt:
    """files: {name: bytes}; time: without a zone; late: as the LMS says"""

    files: dict
    time: datetime = START
    late: bool = False
    text: str = ""


Work = list  # of Attempts, the oldest first

ODD = [
    Student("Ana", "García-Núñez", "agarcia", 48288),
    Student("Bo", "de_la Cruz", "bo_cruz", 48291),
    Student("Pat", "O'Brien", "pobrien", 48300),
    Student("太郎", "山田", "yamada", 48301),
    Student("Zofia", "Żółć", "zzolc", 48302),
    Student("Jörg", "Müller", "mueller", 48303),
    Student("Kim_3", "Lee", "lee.kim", 48304),
    Student("Anne Marie", "van der Berg - Smith", "amb", 48305),
    Student("Priya", "प्रिया", "priya", 48306),
]


def of_30():
    """A class of 30 with the odd names among them."""
    plain = [
        Student(f"First{letter}", f"Last{letter}", f"user{letter}", 50_000 + i)
        for i, letter in enumerate(string.ascii_lowercase)
    ]
    return (ODD + plain)[:30]


def packed(path, files):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as made:
        for name, content in files.items():
            made.writestr(zipfile.ZipInfo(name, (2026, 11, 20, 8, 0, 0)), content)
    return path


def unpacked(folder, files):
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder


def _letters(name, kept):
    return "".join(c for c in name if kept(c))


# --- Canvas ---------------------------------------------------------------------------------------------------------


def canvas_name(name):
    word = ("L", "M", "Nd", "Pc")
    name = re.sub(r"_(\d+)_", r"\1", name).lower()
    return _letters(name, lambda c: unicodedata.category(c).startswith(word))


def canvas(works, who=canvas_name, anonymous=False):
    """Files of the last attempt; what was uploaded before gets -1 … -7, then a UUID behind its name."""
    files, attachment = {}, 7_710_020
    for student, work in works.items():
        seen = {}
        for attempt in work:
            shown = {}
            for name, content in attempt.files.items():
                name = re.sub(r'[\0/\\:*?"<>|]+', "_", name)
                stem, dot, ending = name.partition(".")
                times = seen[name] = seen.get(name, -1) + 1
                suffix = "" if not times else f"-{times}" if times < 8 else f"-{UUID}"
                attachment += 1
                shown[f"{attachment}_{stem}{suffix}{dot}{ending}"] = content
        late = work[-1].late
        code = f"{student.number:x}zQ"[-5:]
        begin = (
            f"{'LATE_' * late}anon_{code}" if anonymous else f"{who(student.sortable)}{'_LATE' * late}_{student.number}"
        )
        files |= {f"{begin}_{name}": content for name, content in shown.items()}
        if work[-1].text:
            files[f"{begin}_text.html"] = work[-1].text.encode()
    return files


def canvas_anonymous(works):
    return canvas(works, anonymous=True)


# --- Moodle ---------------------------------------------------------------------------------------------------------


def moodle_name(name):
    return re.sub(r"[\x00-\x1f&<>\"`|':\\/]", "", name.replace("_", " "))


def moodle(works, layout="{who}_{number}_assignsubmission_file/{name}", who=lambda student: student.full):
    files = {}
    for student, work in works.items():
        told = {"who": moodle_name(who(student)), "number": student.number + 1_000_000}
        for name, content in work[-1].files.items():
            files[layout.format(**told, name=name)] = content
        if work[-1].text:
            text = layout.format(**told, name="onlinetext.html").replace(
                "assignsubmission_file", "assignsubmission_onlinetext"
            )
            files[text] = work[-1].text.encode()
    return files


def moodle_old(works):
    return moodle(works, "{who}_{number}_assignsubmission_file_/{name}")


def moodle_flat(works):
    return moodle(works, "{who}_{number}_assignsubmission_file_{name}")


def moodle_blind(works):
    return moodle(works, who=lambda student: "Teilnehmer/in")


def moodle_worksheet(students, delimiter=","):
    rows = [["Identifier", "Full name", "Email address", "Status", "Grade"]]
    rows += [[f"Participant {s.number + 1_000_000}", s.full, s.email, "Submitted for grading", ""] for s in students]
    return "\ufeff" + "\r\n".join(delimiter.join(f'"{cell}"' for cell in row) for row in rows)


# --- Blackboard -----------------------------------------------------------------------------------------------------


def blackboard(works, assignment="Transform_lab 3"):
    files = {}
    for student, work in works.items():
        for attempt in work:
            begin = f"{assignment}_{student.login}_attempt_{attempt.time:%Y-%m-%d-%H-%M-%S}"
            names = {name: f"{begin}_{name.replace(' ', '_')}" for name in attempt.files}
            files |= {names[name]: content for name, content in attempt.files.items()}
            listed = "\n".join(f"\tOriginal filename: {name}\n\tFilename: {given}\n" for name, given in names.items())
            text = attempt.text or "There is no student submission text data for this assignment."
            files[f"{begin}.txt"] = (
                f"Name: {student.full} ({student.login})\nAssignment: {assignment}\n"
                f"Date Submitted: {attempt.time:%A, %B %d, %Y %I:%M:%S %p} EST\nCurrent Grade: Not Yet Graded\n\n"
                f"Submission Field:\n{text}\n\nComments:\nThere are no student comments for this assignment.\n\nFiles:\n"
                + (listed or "\tNo files were attached to this submission.\n")
            ).encode()
    return files


# --- Brightspace ----------------------------------------------------------------------------------------------------


def brightspace(works, join="/"):
    files = {"index.html": b"<html></html>"}
    for student, work in works.items():
        for attempt in work:
            when = attempt.time
            hour = f"{(when.hour + 11) % 12 + 1}{when:%M %p}"
            folder = f"{student.number}-2557369 - {student.full} - {when:%b} {when.day}, {when.year} {hour}"
            files |= {f"{folder}{join}{name}": content for name, content in attempt.files.items()}
    return files


def brightspace_flat(works):
    return brightspace(works, " - ")


# --- Gradescope -----------------------------------------------------------------------------------------------------


def gradescope(works, groups=()):
    files, text = {}, "---\n"
    for i, (student, work) in enumerate(works.items(), 123_456):
        folder = f"submission_{i}"
        members = next((group for group in groups if student in group), [student])
        text += f"{folder}:\n  :submitters:\n"
        for member in members:
            name = json.dumps(member.full, ensure_ascii=False)
            text += f"  - :name: {name}\n    :sid: '{member.number:07}'\n    :email: {member.email}\n"
        text += (
            f"  :created_at: {work[-1].time:%Y-%m-%d %H:%M:%S}.861687000 Z\n  :score: 3.0\n  :results:\n    tests:\n"
        )
        text += "    - name: a\n      output: |\n        submission_1:\n          :submitters: []\n"
        files |= {f"assignment_99_export/{folder}/{name}": content for name, content in work[-1].files.items()}
    return {"assignment_99_export/submission_metadata.yml": text.encode()} | files


# --- ILIAS ----------------------------------------------------------------------------------------------------------

BASES = {
    "ñ": "n",
    "í": "i",
    "ú": "u",
    "é": "e",
    "&": "a",
    "ä": "ae",
    "ö": "oe",
    "ü": "ue",
    "ß": "ss",
    "Ä": "Ae",
    "Ö": "Oe",
    "Ü": "Ue",
}
BASES["ó"] = "o"


def ilias_name(name):
    made = "".join(BASES.get(c, c if ord(c) < 0x7F else "_" * len(c.encode())) for c in name)
    return re.sub(r'[:\\/*?"<>|]', "_", made)


def ilias(works, submissions="Abgaben", late="Verspätete Abgabe", team=""):
    files = {f"Transform Lab 3/{ilias_name('Übersicht')}.xlsx": b"PK"}
    for student, work in works.items():
        folder = ilias_name(f"{student.last}_{student.first}_{student.login}_{student.number}")
        folder = f"Transform Lab 3/{submissions}/{team}{folder}"
        seen = {}
        for attempt in work:
            for name, content in attempt.files.items():
                times = seen[name] = seen.get(name, 0) + 1
                stem, dot, ending = ilias_name(name).rpartition(".")
                shown = f"{stem} ({times}){dot}{ending}" if times > 1 else ilias_name(name)
                files[f"{folder}/{ilias_name(late) + ' - ' if attempt.late else ''}{shown}"] = content
    return files


def ilias_team(works):
    return ilias(works, team="Team 3/")


# --- Sakai ----------------------------------------------------------------------------------------------------------


def sakai_name(name):
    return _letters(unicodedata.normalize("NFD", name), lambda c: not unicodedata.combining(c))


def sakai(works, flat=False, old_times=False, word="Submission attachment(s)"):
    late = {student: "Late" if work[-1].late else "On time" for student, work in works.items()}
    rows = [
        ["Transforms", "Points"],
        [],
        ["Display ID", "ID", "Last Name", "First Name", "grade", "Submission date", "Late submission"],
    ]
    rows += [[s.login, f"{s.number:x}", f'"{s.last}"', f'"{s.first}"', "", "", late[s]] for s in works]
    files = {"Transforms/grades.csv": "\n".join(",".join(row) for row in rows).encode()}
    for student, work in works.items():
        who = sakai_name(f"{student.sortable}({student.login})")
        begin = f"Transforms/{who}{'_' if flat else '/'}"
        when = f"{work[-1].time:%Y%m%d%H%M%S}861" if old_times else f"{work[-1].time:%Y-%m-%dT%H:%M:%S}.861Z"
        files[f"{begin}timestamp.txt"] = when.encode()
        if not flat:
            files[f"{begin}{who}_submissionText.html"] = (work[-1].text or "<p>&nbsp;</p>").encode()
            files[f"{begin}feedbackText.html"] = files[f"{begin}comments.txt"] = b""
            files[f"{begin}Feedback Attachment(s)/hints.txt"] = b"from the teacher"
        for name, content in work[-1].files.items():
            files[f"{begin}{word}{'_' if flat else '/'}{name}"] = content
    return files


def sakai_flat(works):
    return sakai(works, flat=True)


def sakai_old(works):
    return sakai(works, old_times=True, word="Anhänge der Abgabe(s)")


# --- the others -----------------------------------------------------------------------------------------------------


def edx(works, others=True):
    unit = "[1]Week 3, [2]Transforms, [1]Lab"
    files, rows = {}, ["course_id,block_id,student_id,key,name,type,description,size,file_path,file_found"]
    for student, work in works.items():
        for i, (name, content) in enumerate(work[-1].files.items()):
            path = f"{unit}/[{i}] - {student.login} - {name}"[:255]
            files[path] = content
            rows.append(f'c,b,{"f" * 32},k,"{name}",file,,1,"{path}",True')
    if others:
        files["[1]Week 1, [1]Essay, [1]Essay/[0] - agarcia - essay.pdf"] = b"%PDF"
    return {"submissions.csv": "\n".join(rows).encode()} | files


def teams(works, top="Submitted files", version="Version"):
    files = {f"{top}/{next(iter(works)).full}/Essay/{version} 1/essay.docx": b"PK"}
    for student, work in works.items():
        for i, attempt in enumerate(work, 1):
            files |= {f"{top}/{student.full}/Transforms/{version} {i}/{name}": c for name, c in attempt.files.items()}
    return files


def teams_japanese(works):
    return teams(works, "提出済みのファイル", "バージョン")


def plain(works):
    return {
        f"{student.login}/{name}": content
        for student, work in works.items()
        for name, content in work[-1].files.items()
    }


def utc(when, zone):
    return when.replace(tzinfo=zone).astimezone(UTC)


def later(hours):
    return START + timedelta(hours=hours)
