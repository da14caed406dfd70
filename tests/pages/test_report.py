"""The class report, as an instructor reads it: what it says of a class with a bit of everything, and how it is made."""

import csv
import json
import os
import re
import shutil
from collections import Counter
from html.parser import HTMLParser
from urllib.parse import unquote

import nbformat
import numpy as np
import pytest
from editing import solve
from support import run, verdicts

from autograder.bridge.gradebook import Writer
from autograder.course import Course
from autograder.demo import STUDENTS, Student
from autograder.grading.judge import Row
from autograder.grading.records import missing
from autograder.pages import report
from autograder.pages import report_data as findings
from autograder.pages.report_data import Work

MARKUP = "<img src=x onerror=alert(1)>"  # a student's name, and what they write


@pytest.fixture(scope="module")
def graded(released, tmp_path_factory, hand_in, sandboxed):
    """A class graded once; not to be changed by tests."""
    course = Course(shutil.copytree(released.root, tmp_path_factory.mktemp("report") / "course"))
    for name in ("ben", "goran", "hana", "ivan", "jun", "kofi", "lena"):
        student = Student(STUDENTS / f"{name}.py")
        work = {
            nb: student.hand_in(made).encode() for nb, made in course.notebooks.items() if nb not in student.missing
        }
        hand_in(course, name, work)
    own = nbformat.read(course.source / "3_chaining.ipynb", as_version=4)
    solve(own, "chain", f"def chain(*transforms):\n    raise ValueError('{MARKUP}')")
    solve(own, "transform_pose", "import os\n\ndef transform_pose(a_T_b, pose_in_b):\n    os._exit(1)")
    hand_in(course, MARKUP, {"3_chaining": own})
    code, said = run(course, "grade", "--no-feedback")
    assert code == 0, said
    return course


@pytest.fixture
def course(graded, tmp_path):
    """A copy of the graded class, dates included, of the test's own."""
    return Course(shutil.copytree(graded.root, tmp_path / "course"))


class Outline(HTMLParser):
    """What a page consists of: its tags with their attributes, and its words."""

    def __init__(self, page):
        super().__init__()
        self.tags, self.words = [("", {})], ""
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))

    def handle_data(self, data):
        if self.tags[-1][0] != "style":
            self.words = " ".join(f"{self.words} {data}".split())

    def of(self, wanted):
        return [attributes for tag, attributes in self.tags if tag == wanted]

    def section(self, title, following):
        """The words from one heading to another; the last of each, as the page's navigation names them, too."""
        return self.words[self.words.rindex(title) : self.words.rindex(following)]


def make(course):
    """What `python3 -m autograder report` does."""
    with Writer(course) as writer:
        report.write(course, writer)


def page(course):
    return (course.reports / "index.html").read_text(encoding="utf-8")


def read(course):
    return Outline(page(course))


# --- what it says ---------------------------------------------------------------------------------------------------


def test_it_says_how_many_when_and_by_which_seed(graded):
    record = nbformat.read(graded.autograded("ben") / "1_rotation.ipynb", as_version=4).metadata.transform_lab
    words = read(graded).words
    assert f"8 students. Graded {record.graded[:10]}" in words
    assert f"hidden cases drawn from seed {record.seed}." in words


def test_misconceptions_are_ranked_over_exercises(graded):
    outline = read(graded)
    found = {}
    for row in verdicts(graded):
        for identifier in filter(None, row["misconception"].split(";")):
            found.setdefault(identifier, []).append((row["student"], row["exercise"]))
    assert len({student for student, _ in found["base-frame-offset"]}) == 3
    words = outline.section("What the class misunderstands", "Scores")
    assert "1. base-frame-offset 3 of 8 students , in pre_grasp (3), waypoint (3)" in words
    for identifier, times in found.items():
        for exercise, count in Counter(exercise for _, exercise in times).items():
            part = words[words.index(identifier) :]
            assert exercise in part[: part.index("_", part.index(exercise))] + exercise, (identifier, exercise, count)
    assert words.count("The offset was added along the axes of the base") == 1
    assert words.count("Behind, beside and above are meant along the object's axes") == 1


def test_an_example_is_drawn_with_a_text_for_who_does_not_see_it(graded):
    pictures = read(graded).of("img")
    assert pictures and len(pictures) <= 10
    for picture in pictures:
        assert picture["src"].startswith("data:image/webp;base64,")
        assert "(yours)" in picture["alt"] or "your x" in picture["alt"]


def test_each_misconception_leads_to_a_section_of_the_notebooks(graded):
    links = [link["href"] for link in read(graded).of("a") if ".ipynb#" in link["href"]]
    assert len(links) >= 10
    for link in links:
        path, _, anchor = unquote(link).partition("#")
        notebook = nbformat.read(graded.reports / path, as_version=4)
        text = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown").replace("`", "")
        assert any(line.replace(" ", "-") == f"##-{anchor}" for line in text.splitlines()), link
    assert "2_homogeneous_transforms: Carrying a point from B to A" in read(graded).words


def test_not_done_is_told_from_an_error(graded):
    rows = {(row["student"], row["exercise"]): row["status"] for row in verdicts(graded)}
    assert rows["ivan", "chain"] == rows[MARKUP, "chain"] == "error"
    words = read(graded).words
    with_error = findings.results({name: findings.work(graded, name) for name in graded.students()})["3_chaining"][0]
    assert (with_error.failed, with_error.undone) == (3, 1)  # kofi's file, lena's loop, an error; ivan
    assert sum(with_error[1:6]) == 8
    look = words[words.index("Had to be stopped") :]
    assert "ivan" not in look[: look.index("Not handed in")]


def test_who_needs_a_look_and_why(graded):
    words = read(graded).section("Who needs a look", "Hand-graded questions waiting")
    assert "lena chain : Your function did not finish in time" in words
    assert "transform_pose : Your function had to be stopped: its process ended all of a sudden." in words
    assert "kofi 3_chaining.ipynb: it cannot be read" in words and "kofi chain" not in words
    assert f"chain : Your function raised an error: ValueError: {MARKUP}" in words
    assert words.count("5_pre_grasp") == 1 and f"5_pre_grasp 2 {MARKUP}, jun" in words
    assert "not handed in;" not in words


def test_a_reason_leads_to_the_feedback_page(course):
    course.feedback(MARKUP).mkdir(parents=True)
    (course.feedback(MARKUP) / "3_chaining.html").write_text("…</html>")
    make(course)
    linked = [link["href"] for link in read(course).of("a") if "feedback" in link["href"]]
    assert linked and all((course.reports / unquote(link)).is_file() for link in linked)


def test_hand_graded_questions_that_wait_are_counted(course):
    def waiting():
        words = read(course).section("Hand-graded questions waiting", "What changed since the last run")
        return int(words.partition("where to grade them ")[2].split()[0]), words

    before, words = waiting()
    assert "Question: pose or transform?" in words
    assert "http://localhost:8888/formgrader/gradebook/transforms/ 2_homogeneous_transforms" in words
    with Writer(course) as writer:
        cells = [found["2_homogeneous_transforms"].cells for found in writer.grades().values()]
        assert before == sum(found["question-pose-or-transform"].waiting for found in cells)
        grade = writer.gradebook.find_grade(
            "question-pose-or-transform", "2_homogeneous_transforms", "transforms", "ben"
        )
        assert grade.needs_manual_grade
        grade.manual_score, grade.needs_manual_grade = 1.5, False
        writer.gradebook.db.commit()
    make(course)
    assert waiting()[0] == before - 1
    assert "1.5 of 6" in read(course).words


# --- what changed ---------------------------------------------------------------------------------------------------


def test_the_first_run_is_said_to_be_the_first(graded):
    assert "This is the first run." in read(graded).words
    assert not (graded.reports / "before.csv").exists()


def test_what_changed_since_the_run_before(course, solved, hand_in):
    first = (course.reports / "verdicts.csv").read_text()
    shutil.copy(solved["5_pre_grasp"], course.submitted("ben"))
    shutil.copy(course.release / "1_rotation.ipynb", course.submitted("goran"))
    shutil.rmtree(course.submitted("hana"))
    hand_in(course, "new", {"1_rotation": solved["1_rotation"]})
    assert run(course, "grade", "--no-feedback")[0] == 0
    assert (course.reports / "before.csv").read_text() == first

    def told():
        words = read(course).section("What changed since the last run", "All students")
        assert "1 student with more points, 1 with fewer, 1 new, 1 gone." in words
        assert "New: new" in words and "Gone: hana" in words
        assert words.index("goran") < words.index("ben ")  # who lost comes first
        assert "pre_grasp 0.6 → 3" in words or "→ 3 , waypoint" in words or "→ 3, waypoint" in words
        return words

    words = told()
    assert "The last run graded 3 students" in read(course).words and "earlier ones:" in read(course).words
    assert run(course, "report")[0] == 0
    assert told() == words  # made again, it has not lost what to compare with
    assert run(course, "grade", "--no-feedback")[0] == 0  # nothing is graded
    assert told() == words

    assert run(course, "grade", "ben", "--force", "--no-feedback")[0] == 0
    assert "no points changed, and the students are the same." in read(course).words


def test_a_damaged_file_of_before_is_said(course):
    (course.reports / "before.csv").write_bytes(b"student,exercise,score\nben,chain,many\n")
    make(course)
    assert "cannot be read, so nothing is compared" in read(course).words


def test_changes_are_those_of_who_is_in_both():
    def work(**scores):
        return Work([Row("1", name, score, 2.0, "graded") for name, score in scores.items()])

    before = {"a": {"x": 1.0, "y": 2.0}, "b": {"x": 1.0, "y": 1.0}, "c": {"x": 0.0}, "gone": {"x": 2.0}}
    now = {"a": work(x=1.0, y=2.0), "b": work(x=2.0, y=0.0), "c": work(x=2.0, z=1.0), "new": work(x=1.0)}
    changes = findings.changes(before, now)
    assert changes.scores == {"b": [("x", 1.0, 2.0), ("y", 1.0, 0.0)], "c": [("x", 0.0, 2.0)]}
    assert (changes.new, changes.gone, changes.better, changes.worse) == (["new"], ["gone"], 1, 0)


def class_of(**columns):
    """{student: Work} of exercises' points of 2, each column with one number for each student; misconceptions by `wrong`."""
    return {
        f"s{n:02}": Work([Row("1", name, points, 2.0, "graded") for name, points in zip(columns, each)])
        for n, each in enumerate(zip(*columns.values()))
    }


def test_an_exercise_tells_as_well_as_it_goes_with_the_others():
    strong_first = [2.0] * 6 + [0.0] * 6
    works = class_of(
        like_the_rest=strong_first,
        the_rest=strong_first,
        and_more=strong_first,
        reversed=strong_first[::-1],
        easy=[2.0] * 12,
        odd=[2.0, 0.0] * 6,
    )
    tells = {result.exercise: result.tells for result in findings.results(works)["1"]}
    assert tells["easy"] is None and tells["like_the_rest"] == tells["the_rest"] > 0 > tells["reversed"]
    expected = np.corrcoef([1.0] * 6 + [0.0] * 6, [w.points - w.rows[0].score for w in works.values()])[0, 1]
    assert tells["like_the_rest"] == pytest.approx(expected) and abs(tells["odd"]) < 0.3
    few = dict(list(works.items())[: findings.FEWEST - 1])
    assert {result.tells for result in findings.results(few)["1"]} == {None}


def with_misconceptions(*students):
    """{student: Work} of {exercise: misconceptions} for each."""
    return {
        f"s{n:02}": Work([Row("1", name, 0.0, 2.0, "graded", of.get(name, "")) for name in ("x", "y", "z")])
        for n, of in enumerate(students)
    }


def test_misconceptions_go_together_when_chance_would_not_have_it():
    pairs = findings.together(
        with_misconceptions(*[{"x": "a", "y": "b"}] * 5, {"x": "a"}, *[{"z": "c"}] * 4, *[{}] * 10)
    )
    assert pairs == [("a", "b", 6, 5, 5)]
    assert findings.together(with_misconceptions(*[{"x": "a", "y": "b"}] * 5, *[{}] * 4)) == []  # too few students
    assert (
        findings.together(with_misconceptions(*[{"x": "a", "y": "b"}] * 2, *[{}] * 20)) == []
    )  # too few who have both
    assert findings.together(with_misconceptions(*[{"x": "a;b"}] * 5, *[{}] * 10)) == []  # it is one function
    assert findings.together(with_misconceptions(*[{"x": "a", "y": "b"}] * 12)) == []  # everybody has everything
    mixed = [{"x": "a"}, {"y": "b"}, {"x": "a", "y": "b"}, {}] * 5
    assert findings.together(with_misconceptions(*mixed)) == []  # as often as chance would have it


def test_whose_grading_took_long_stands_out():
    works = {f"s{n}": Work(seconds=seconds) for n, seconds in enumerate([1.0, 2.0, 2.0, 0.0, 9.9, 11.0])}
    assert findings.slow(works) == {"s5": (11.0, 5.5)}
    assert findings.slow({f"s{n}": Work(seconds=20.0) for n in range(9)}) == findings.slow({}) == {}


def test_another_class_is_compared_by_shares(course, tmp_path):
    same = tmp_path / "archive" / "last"
    shutil.copytree(course.reports, same / "reports" / "transforms")
    lines = (same / "reports" / "transforms" / "verdicts.csv").read_text().splitlines(keepends=True)
    half = tmp_path / "half.csv"
    half.write_text(lines[0] + "".join(line for line in lines if line.startswith(("ben,", "goran,"))))
    for path in (same, same / "reports", same / "reports" / "transforms" / "verdicts.csv"):
        assert run(course, "report", "--compare", str(path))[0] == 0
        words = read(course).section("Compared with another class", "All students")
        shares = re.findall(r"(\d+) % (\d+) %", words)
        assert len(shares) > 16 and all(then == now for then, now in shares)
    assert run(course, "report", "--compare", str(half))[0] == 0
    words = read(course).section("Compared with another class", "All students")
    rows = [row for row in verdicts(course) if row["exercise"] == "chain"]
    then, now = (
        round(100 * sum(float(row["score"]) / float(row["max_score"]) for row in of) / len(of))
        for of in ([row for row in rows if row["student"] in ("ben", "goran")], rows)
    )
    assert f"chain {then} % {now} %" in words
    assert run(course, "report")[0] == 0 and "Compared" not in read(course).words


@pytest.mark.parametrize(
    "content, words",
    [
        (None, "there is no verdicts.csv"),
        (b"\xff\xfe\xfd", "this is no verdicts.csv"),
        (b"student,points\na,1\n", "this is no verdicts.csv"),
        (b"student,exercise,score,max_score,misconception\na,chain,much,2,\n", "this is no verdicts.csv"),
    ],
)
def test_what_is_no_table_of_verdicts_is_refused_in_words(course, tmp_path, content, words):
    path = tmp_path / "other.csv"
    if content is not None:
        path.write_bytes(content)
    code, said = run(course, "report", "--compare", str(path))
    assert code == 2 and words in said and str(path) in said and "Traceback" not in said


# --- how it is made -------------------------------------------------------------------------------------------------


def test_distribution_has_everybody_once():
    def work(points):
        return Work([Row("1", "x", points, 34.0, "graded")])

    points = (0.0, 4.99, 5.0, 33.99, 34.0, 34.0)
    bars = findings.distribution({str(number): work(earned) for number, earned in enumerate(points)})
    assert bars[0] == ("0 to under 5", 2) and bars[1] == ("5 to under 10", 1)
    assert bars[-2:] == [("30 to under 34", 1), ("all 34", 2)]
    assert sum(count for _, count in bars) == 6


def test_grades_csv_is_what_nbgrader_exports(course, nbgrader):
    # nbgrader orders by names and leaves to chance who comes first among people of the same name, or without one
    with Writer(course) as writer:
        for number, student in enumerate(course.students()):
            names = {"last_name": "ABC"[-number % 3], "first_name": f"{-number % 10}"}
            writer.gradebook.update_or_create_student(student, **names)
        writer.export(course.reports / "grades.csv", writer.grades())
    ours = (course.reports / "grades.csv").read_text()
    result = nbgrader(course, "export")
    assert result.returncode == 0, result.stderr
    assert ours == (course.root / "grades.csv").read_text()
    order = [row["student_id"] for row in csv.DictReader(ours.splitlines())]
    assert sorted(order) == course.students() != order


def test_people_without_a_name_are_in_grades_csv_by_what_they_are_called(course):
    with open(course.reports / "grades.csv", newline="", encoding="utf-8") as file:
        assert [row["student_id"] for row in csv.DictReader(file)] == sorted(course.students())


def test_nothing_in_grades_csv_is_run_and_every_name_stays_in_its_cell(course):
    nasty = {"first_name": "=1+1", "last_name": 'Müller, Jr. "Jojo', "email": "@SUM(1)\n=2"}
    student = course.students()[0]
    with Writer(course) as writer:
        writer.gradebook.update_or_create_student(student, **nasty)
        writer.export(course.reports / "grades.csv", writer.grades())
    with open(course.reports / "grades.csv", newline="", encoding="utf-8") as file:
        rows = {row["student_id"]: row for row in csv.DictReader(file)}
    assert rows.keys() == set(course.students())
    assert [rows[student][field] for field in nasty] == ["'=1+1", 'Müller, Jr. "Jojo', "'@SUM(1) =2"]


def test_records_of_an_older_grader_are_reported_without_words(course):
    for path in course.root.glob("autograded/*/transforms/*.ipynb"):
        notebook = nbformat.read(path, as_version=4)
        del notebook.metadata.transform_lab["verdicts"]
        nbformat.write(notebook, path)
    make(course)
    words = read(course).words
    assert "1. base-frame-offset 3 of 8 students" in words and "status timeout" in words


def test_what_is_not_graded_is_said(course, solved, hand_in):
    hand_in(course, "late", {"1_rotation": solved["1_rotation"]})
    (course.autograded("ben") / "1_rotation.ipynb").write_text("{")
    make(course)
    words = read(course).words
    assert "Handed in, but not graded: late." in words
    assert "ben 1_rotation.ipynb: not graded yet; run python3 -m autograder grade" in words
    assert "nothing handed in" not in words


def test_who_is_in_the_class_and_handed_nothing_in_is_said(course):
    with Writer(course) as writer:
        writer.gradebook.update_or_create_student("zoe")
    make(course)
    assert "In the class, nothing handed in: zoe." in read(course).words


def test_a_class_of_nobody(released, tmp_path):
    course = Course(shutil.copytree(released.root, tmp_path / "empty"))
    (course.root / "submitted").mkdir()
    make(course)
    words = read(course).words
    assert "0 students. Nothing is graded yet" in words and "No misconception was found" in words


def test_the_page_is_one_safe_file(graded):
    text, outline = page(graded), read(graded)
    assert len(text) < 1_500_000
    assert not {"script", "iframe", "object", "link", "form"} & {tag for tag, _ in outline.tags}
    assert MARKUP not in text and MARKUP in outline.words
    for tag, attributes in outline.tags:
        assert not [name for name in attributes if name.startswith("on")], (tag, attributes)
        assert not attributes.get("src", "data:image/png").startswith("http")


def test_the_page_is_in_order(graded):
    outline = read(graded)
    levels = [int(tag[1]) for tag, _ in outline.tags if tag in ("h1", "h2", "h3", "h4")]
    assert levels[0] == 1 and levels.count(1) == 1
    assert all(level <= above + 1 for above, level in zip(levels, levels[1:]))
    tables = page(graded).split("<table")[1:]
    assert tables and all('<th scope="col"' in table and '<th scope="row"' in table for table in tables)
    ids = {attributes["id"] for _, attributes in outline.tags if "id" in attributes}
    assert {link["href"][1:] for link in outline.of("a") if link["href"].startswith("#")} <= ids


@pytest.mark.parametrize("width", [1200, 600, 400, 320])
def test_the_page_fits_the_window_and_asks_for_nothing(graded, browser, width):
    window = browser.new_page(viewport={"width": width, "height": 800})
    asked, said = [], []
    window.on("request", lambda request: asked.append(request.url))
    window.on("dialog", lambda dialog: said.append(dialog.message))
    window.goto((graded.reports / "index.html").as_uri())
    assert window.evaluate("document.documentElement.scrollWidth") <= width
    assert window.evaluate("[...document.images].every(image => image.naturalWidth > 0)")
    window.close()
    assert [url for url in asked if not url.startswith("data:")] == [(graded.reports / "index.html").as_uri()]
    assert not said


def test_a_section_is_the_heading_above(released):
    notebook = released.notebooks["2_homogeneous_transforms"]
    assert notebook.section("transform_point") == "Carrying a point from B to A"
    assert notebook.section("question-pose-or-transform").startswith("Question: pose or transform?")
    assert notebook.section("no such exercise") == ""
    for other in released.notebooks.values():
        assert all(other.section(name) and "Exercise" not in other.section(name) for name in other.points)


def test_nobody_who_handed_nothing_in_is_reported_exercise_by_exercise(released):
    rows = missing(released.notebooks["5_pre_grasp"])
    look = findings.look({"a": Work(rows, absent=["5_pre_grasp"])})
    assert look == ({}, {}, {"5_pre_grasp": ["a"]})


def test_verdicts_keep_their_date(course):
    """The comparison hangs on it: the date is that of the newest grading in the file."""
    path = course.reports / "verdicts.csv"
    before = os.stat(path).st_mtime
    make(course)
    assert os.stat(path).st_mtime == before


@pytest.mark.parametrize(
    "damage",
    [lambda rows: rows[0].update(score="much"), lambda rows: rows[0].update(max_score=None), lambda rows: rows.clear()],
)
def test_a_damaged_record_costs_its_student_alone(course, damage):
    path = course.autograded("lena") / "3_chaining.ipynb"
    notebook = json.loads(path.read_text(encoding="utf-8"))
    damage(notebook["metadata"]["transform_lab"]["rows"])
    path.write_text(json.dumps(notebook), encoding="utf-8")
    with Writer(course) as writer:
        works = report.write(course, writer)
    assert set(works) == set(course.students()) and works["ben"].points > 0
    assert "lena" in (course.reports / "index.html").read_text(encoding="utf-8")


def test_a_name_that_no_file_can_hold_or_that_turns_words_around_costs_nothing(course):
    for name in (b"\xff", "\u202eevil".encode()):
        os.makedirs(os.path.join(os.fsencode(course.root), b"submitted", name, b"transforms"))
    with Writer(course) as writer:
        report.write(course, writer)
    page = (course.reports / "index.html").read_text(encoding="utf-8")
    assert "</html>" in page and "\u202e" not in page
