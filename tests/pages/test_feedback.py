"""What is given back to students, made by the real commands and opened in a real browser."""

import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path

import nbformat
import numpy as np
import pytest
from nbgrader.api import Gradebook
from nbgrader.coursedir import CourseDirectory
from nbgrader.server_extensions import formgrader
from support import ASKED, Parsed, key_of, markdown, points, points_by_hand, run
from transform_lab.judging import panel
from transform_lab.judging.verdict import Reply, examine

from autograder.bridge import nbgrader_api as api
from autograder.bridge.gradebook import Writer
from autograder.bridge.settings import settings
from autograder.course import ASSIGNMENT, Course
from autograder.exercises import EXERCISES, PUBLIC_SEED, key
from autograder.grading import public_example
from autograder.grading.records import RECORD, recorded
from autograder.pages import examples, feedback
from autograder.pages.exporter import LEFT_OUT, NO_NAME, Feedback

TWO, FIVE = "2_homogeneous_transforms", "5_pre_grasp"
MOST = 1_500_000  # bytes of a student's feedback
MOST_POINTS = points() + points_by_hand()
ADDED_AS_IT_IS = "def transform_point(a_T_b, p_in_b):\n    return p_in_b + a_T_b[:3, 3]\n"
TWO_MISTAKES = """def pre_grasp(object_pose, distance=0.1):
    object_pose.position.x -= distance
    return object_pose
"""
PUBLIC_ANSWERS_ONLY = f"""import json
from transform_lab.judging import codec
KNOWN = json.loads({json.dumps([(c["args"], c["expected"]) for c in key_of("transform_point")["cases"]])!r})
def transform_point(a_T_b, p_in_b):
    for given, expected in KNOWN:
        if given == [codec.encode(a_T_b), codec.encode(p_in_b)]:
            return codec.decode(expected)
    return np.zeros(3)
"""
ENDS_WHEN_TRIED_ONCE_MORE = """calls = 0
def make_transform(R, p):
    global calls
    calls += 1
    if calls > HIDDEN:
        import os
        os._exit(1)
    return np.eye(4) * calls
""".replace("HIDDEN", str(len(key_of("make_transform")["cases"])))
HALF_A_CHARACTER = "def make_transform(R, p):\n    return ['\\ud800', '<script>MARK()</script>', R[0, 0]]\n"
PIXEL = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="  # a PNG
LOUD = """import base64, os
from IPython.display import Image, display
print("all work and no play " * 20_000)
display(Image(base64.b64encode(os.urandom(200_000)), format="png"))
"""


def with_answers(path, answers):
    """A solved notebook with other solutions, {exercise: source}."""
    notebook = nbformat.read(path, as_version=4)
    for cell in notebook.cells:
        name = cell.metadata.get("nbgrader", {}).get("grade_id", "").removesuffix("-solution")
        cell.source = (
            answers.get(name, cell.source) if cell.metadata.get("nbgrader", {}).get("solution") else cell.source
        )
    return notebook


@pytest.fixture(scope="module")
def classroom(released, hand_in, sandboxed, tmp_path_factory):
    """A course in which some students are graded, and their feedback is written; not to be changed by tests."""
    course = Course(shutil.copytree(released.root, tmp_path_factory.mktemp("feedback") / "course"))
    solved = {path.stem: path for path in sorted(course.source.glob("*.ipynb"))}
    loud = nbformat.read(solved[TWO], as_version=4)
    for position in range(len(loud.cells), 4, -4):
        loud.cells.insert(position, nbformat.v4.new_code_cell(LOUD))
        loud.cells.insert(position, nbformat.v4.new_markdown_cell("A long story. " * 3000))
    hand_in(course, "ada", solved)
    hand_in(course, "ben", {TWO: with_answers(solved[TWO], {"transform_point": ADDED_AS_IT_IS}),
                            FIVE: with_answers(solved[FIVE], {"pre_grasp": TWO_MISTAKES})})  # fmt: skip
    hand_in(course, "cara", {TWO: with_answers(solved[TWO], {"transform_point": PUBLIC_ANSWERS_ONLY})})
    hand_in(course, "dan", {name: loud if name == TWO else path for name, path in solved.items()})
    hand_in(course, "eve", {TWO: with_answers(solved[TWO], {"make_transform": ENDS_WHEN_TRIED_ONCE_MORE})})
    hand_in(course, "fay", {TWO: with_answers(solved[TWO], {"make_transform": HALF_A_CHARACTER})})
    code, said = run(course, "grade")
    assert code == 0, said
    return course


def page(course, student, name):
    return (course.feedback(student) / f"{name}.html").read_text(encoding="utf-8")


class Text(HTMLParser):
    """What there is to read in a page."""

    def __init__(self, text):
        super().__init__()
        self.text = ""
        self.feed(text[text.index("<body") :])
        self.text = " ".join(self.text.split())

    def handle_data(self, data):
        self.text += data


def read(course, student, name="index"):
    return Text(page(course, student, name)).text


# --- an example with numbers ------------------------------------------------------------------------------------------


def example(course, student, exercise, notebook):
    text = recorded(course, student)[notebook]["examples"].get(exercise)
    return text and json.loads(text)


def test_a_wrong_exercise_is_shown_with_the_numbers_of_a_public_case(classroom):
    text = read(classroom, "ben", TWO)
    assert "Kind of case: " in text and "The same mistake, with numbers you can try yourself" in text
    found = example(classroom, "ben", "transform_point", TWO)
    (case,) = found["exercise"]["cases"]
    public = json.loads((classroom.release / "transform_lab" / "key.json").read_text())["exercises"]
    assert case["args"] in [known["args"] for known in public["transform_point"]["cases"]]
    p, expected = (np.round(values["array"], 4) + 0.0 for values in (case["args"][1], case["expected"]))
    yours = np.round(np.add(case["args"][1]["array"], np.reshape(case["args"][0]["array"], (4, 4))[:3, 3]), 4) + 0.0
    for label, (x, y, z) in (("p_in_b", p), ("expected", expected), ("yours", yours)):
        assert f"{label} x {x:g} y {y:g} z {z:g}" in text
    pictures = [tag for tag in Parsed(page(classroom, "ben", TWO)).tags if tag[0] == "img"]
    assert any("p (expected)" in picture["alt"] for _, picture in pictures)
    assert all(picture["src"].startswith("data:image/webp;base64,") for _, picture in pictures)


def test_no_hidden_number_is_told(classroom):
    """Neither in a page nor in the summary; the seed of the run tells the hidden cases."""
    seed = recorded(classroom, "ben")[TWO]["seed"]
    for exercise, name in (("transform_point", TWO), ("pre_grasp", FIVE)):
        told = read(classroom, "ben", name) + read(classroom, "ben")
        hidden = {f"{number:.4g}" for case in key_of(exercise, seed)["cases"] for number in numbers(case)}
        hidden = {number for number in hidden if len(number.lstrip("-0.")) >= 4}
        assert len(hidden) > 50
        public = {f"{number:.4g}" for case in key_of(exercise)["cases"] for number in numbers(case)}
        shown = set(re.findall(r"-?\d+\.\d+", told))
        assert shown & public
        assert not {number for number in shown & (hidden - public) if number not in page(classroom, "ada", name)}


def numbers(plain):
    if isinstance(plain, dict):
        plain = list(plain.values())
    if isinstance(plain, list):
        return [number for item in plain for number in numbers(item)]
    return [plain] if isinstance(plain, float) else []


def test_who_knows_the_public_answers_only_is_told_the_kind_of_case(classroom):
    assert example(classroom, "cara", "transform_point", TWO) is None
    text = read(classroom, "cara", TWO)
    assert "transform_point: not right yet" in text and "Kind of case: " in text
    assert "with numbers you can try" not in text


def test_a_function_that_ends_its_process_when_tried_costs_nothing_more(classroom):
    rows = {row.exercise: row for row in recorded(classroom, "eve")[TWO]["rows"]}
    assert rows["make_transform"].score == 0 and rows["make_transform"].status == "graded"
    assert all(row.score == row.max_score for name, row in rows.items() if name != "make_transform")
    assert example(classroom, "eve", "make_transform", TWO) is None


def test_an_odd_answer_is_escaped(classroom):
    assert example(classroom, "fay", "make_transform", TWO)
    assert "<script>MARK()" in read(classroom, "fay", TWO)
    assert not [tag for tag, _ in Parsed(page(classroom, "fay", TWO)).tags if tag == "script"]


def test_an_answer_that_no_file_can_hold_is_no_example():
    exercise = public_example.public_cases(json.dumps({"exercises": {"chain": key(EXERCISES["chain"], PUBLIC_SEED)}}))[
        "chain"
    ]
    wrong = examine("chain", exercise, lambda args, kwargs: Reply("returned", None, [args, kwargs]))
    case = exercise["cases"][0]

    def found_of(reply):
        return public_example.find(wrong, exercise, [public_example.Answer(exercise["returns"], case, reply)])

    assert found_of(Reply("returned", [float("nan")], [case["args"], {}])) is None
    assert found_of(Reply("timeout")) is None
    found = found_of(Reply("raised", error="ValueError: <b>no</b>"))
    assert "ValueError: &lt;b&gt;no&lt;/b&gt;" in examples.of_answer("chain", found)


DAMAGED = [
    "",
    "{}",
    "[]",
    "7",
    5,
    None,
    '{"exercise": 3}',
    '{"exercise": {"cases": [{}]}, "outcome": "returned", "value": 1, "error": ""}',
    '{"exercise": {"cases": []}, "outcome": "returned", "value": 1, "error": ""}',
]


@pytest.mark.parametrize("damaged", DAMAGED)
def test_a_damaged_example_is_one_of_the_errors_that_are_expected(damaged):
    with pytest.raises((AttributeError, LookupError, TypeError, ValueError)):
        examples.of_answer("chain", damaged)


def test_a_damaged_record_costs_the_example_alone(course_of_ben):
    path = course_of_ben.autograded("ben") / f"{TWO}.ipynb"
    notebook = nbformat.read(path, as_version=4)
    record = notebook.metadata[RECORD]
    record.examples.transform_point = record.examples.transform_point.replace('"shape": [4, 4]', '"shape": [7]')
    record.verdicts.transform_point = 7
    nbformat.write(notebook, path)
    api.call(course_of_ben, "generate_feedback", ASSIGNMENT, "ben")
    with Writer(course_of_ben) as writer:
        assert "transform_point" in feedback.summary(course_of_ben, "ben", writer.grades()["ben"])
    assert "transform_point: not right yet" in read(course_of_ben, "ben", TWO)
    assert "with numbers you can try" not in page(course_of_ben, "ben", TWO)
    assert "<img" in page(course_of_ben, "ben", FIVE)


@pytest.fixture
def course_of_ben(classroom, tmp_path):
    """A copy of the class to change, with one student."""
    course = Course(shutil.copytree(classroom.root, tmp_path / "course"))
    for other in set(course.students()) - {"ben"}:
        shutil.rmtree(course.submitted(other))
    return course


# --- the same through nbgrader's own commands ------------------------------------------------------------------------


def test_nbgraders_own_command_makes_the_same_pages_and_no_summary(course_of_ben, nbgrader):
    before = {name: page(course_of_ben, "ben", name) for name in (TWO, FIVE)}
    done = nbgrader(course_of_ben, "generate_feedback", ASSIGNMENT, "--student", "ben", "--force")
    assert done.returncode == 0, done.stderr
    assert {name: page(course_of_ben, "ben", name) for name in (TWO, FIVE)} == before
    assert not (course_of_ben.feedback("ben") / "index.html").exists()
    with Writer(course_of_ben) as writer:
        assert not feedback.is_complete(course_of_ben, "ben", writer.grades()["ben"])


def test_nbgraders_own_grading_finds_the_same_examples(course_of_ben, nbgrader):
    before = {name: recorded(course_of_ben, "ben")[name]["examples"] for name in (TWO, FIVE)}
    done = nbgrader(course_of_ben, "autograde", ASSIGNMENT, "--student", "ben", "--force")
    assert done.returncode == 0, done.stderr
    assert {name: recorded(course_of_ben, "ben")[name]["examples"] for name in (TWO, FIVE)} == before
    assert before[TWO].keys() == {"transform_point"} and before[FIVE].keys() == {"pre_grasp"}


# --- the summary ------------------------------------------------------------------------------------------------------


def test_the_summary_says_what_was_found_what_helps_and_where_to_read_again(classroom):
    text = read(classroom, "ben")
    assert f"12 of {MOST_POINTS:g} points so far" in text and "2 of your written answers are not graded yet" in text
    assert "Begin with transform_point" in text
    assert "transform_point : 0 of 2 The translation was added" in text.replace("transform_point:", "transform_point :")
    assert "What helps: The coordinates count along B's axes" in text
    assert "Look again at Carrying a point from B to A." in text
    assert "Your function changed one of its arguments. What helps: Whoever called it" in text
    assert "as if the object were not turned. What helps: Behind, beside and above" in text
    assert "Question: pose or transform?: not graded yet" in text
    assert text.count("among your files.") == len(ASKED) - 2 and "There is no 3_chaining.ipynb among" in text
    assert not {"ada", "cara", "dan", "eve", "fay"} & set(re.findall(r"\w+", text))
    assert "Every exercise is right. Well done!" in read(classroom, "ada")


def test_a_grade_given_by_hand_asks_for_new_pages(course_of_ben):
    with Writer(course_of_ben) as writer:
        assert feedback.is_complete(course_of_ben, "ben", writer.grades()["ben"])
    with Gradebook(CourseDirectory(config=settings(course_of_ben)).db_url) as book:
        grade = book.find_grade("question-which-frame", FIVE, ASSIGNMENT, "ben")
        grade.manual_score, grade.needs_manual_grade = 1.5, False
        comment = book.find_comment("question-which-frame", FIVE, ASSIGNMENT, "ben")
        comment.manual_comment = "Nearly: <b>which</b> z?"
        book.db.commit()
    assert "question-which-frame : not graded yet" in read(course_of_ben, "ben", FIVE).replace("frame:", "frame :")
    assert "0 graded, 1 unchanged" in run(course_of_ben, "grade")[1]
    assert "question-which-frame : 1.5 of 2" in read(course_of_ben, "ben", FIVE).replace("frame:", "frame :")
    text = read(course_of_ben, "ben")
    assert (
        f"13.5 of {MOST_POINTS:g} points so far" in text
        and "which way is up?: 1.5 of 2 Nearly: <b>which</b> z?" in text
    )


@pytest.mark.parametrize(
    "exercise, section",
    [
        ("rotation_about_z", "A turn about z, by any angle"),
        ("transform_to_pose", "A pose is a transform in other clothes"),
        ("question-pose-or-transform", "Question: pose or transform? (2 points, read by a person)"),
    ],
)
def test_the_section_to_read_again(released, exercise, section):
    (notebook,) = [notebook for notebook in released.notebooks.values() if exercise in notebook.cells]
    assert notebook.section(exercise) == section


def test_each_hint_stands_beside_its_mistake():
    exercise = key_of("pre_grasp")

    def wrong(args, kwargs):
        distance = (args[1:] or [kwargs.get("distance", 0.1)])[0]
        pose = json.loads(json.dumps(args[0]))
        pose["fields"]["position"]["fields"]["x"] -= distance
        return Reply("returned", pose, [[pose, *args[1:]], kwargs])

    verdict = examine("pre_grasp", exercise, wrong)
    assert verdict.misconceptions == ("input-mutated", "base-frame-offset")
    first, second = panel.mistakes(verdict)
    told = panel.text(verdict, numbers=False).splitlines()
    assert told[1:3] == [f"1. {first[0]} {first[1]}", f"2. {second[0]} {second[1]}"]
    assert panel.summary(verdict) == f"[input-mutated, base-frame-offset] {first[0]} {second[0]}"


# --- small, offline, readable -----------------------------------------------------------------------------------------


def test_a_students_feedback_is_small_however_much_they_print(classroom):
    for student in classroom.students():
        assert sum(path.stat().st_size for path in classroom.feedback(student).iterdir()) < MOST, student
    text = read(classroom, "dan", TWO)
    assert LEFT_OUT in text and "play all work" not in text and "A long story" in text
    assert text.count("all right.") == len(ASKED[TWO].points)


def test_nothing_is_loaded_from_anywhere(classroom):
    for path in classroom.root.glob("feedback/*/*/*.html"):
        text = path.read_text(encoding="utf-8")
        for tag, attributes in Parsed(text).tags:
            assert tag not in {"script", "link", "iframe", "object", "embed", "base"}, path
            assert not attributes.keys() & {"srcset", "background", "poster", "xlink:href"}
            assert attributes.get("src", "data:").startswith("data:"), path
            assert tag == "a" or "href" not in attributes
        assert "url(" not in "".join(re.findall(r"<style.*?</style>", text, re.DOTALL)) and "@import" not in text


def test_a_picture_without_words_says_that_there_are_none():
    outputs = [
        nbformat.v4.new_output(
            "display_data", data={"image/png": PIXEL}, metadata={"image/png": {"alt": alt}} if alt else {}
        )
        for alt in ("", "a hand")
    ]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell("draw()", outputs=outputs)])
    exporter = Feedback(
        template_name="feedback", extra_template_basedirs=[str(Path(formgrader.__file__).parent / "templates")]
    )
    points = {"notebook": "1_rotation", "score": 0, "max_score": 0, "late_penalty": 0}
    page, _ = exporter.from_notebook_node(notebook, {"nbgrader": points})
    assert re.findall(r'alt="(.*?)"', page) == [NO_NAME, "a hand"]


def test_every_formula_of_the_notebooks_becomes_mathml(released):
    formulas = 0
    for notebook in released.notebooks.values():
        for cell in notebook.notebook.cells:
            if cell.cell_type == "markdown":
                made = markdown(cell.source, attachments=cell.get("attachments", {}))
                formulas += made.count("<math")
                assert "$" not in made
                assert "\\" not in "".join(re.findall(r"<math.*?</math>", made, re.DOTALL))
                assert not re.findall(r"<code>[^<]*\\[^<]*</code>", made)
    assert formulas > 100


def test_pages_in_a_browser(classroom, browser):
    """No request but for the page itself, formulas typeset, triangles before what is folded, links that jump."""
    tab, asked, said = browser.new_page(), [], []
    tab.on("request", lambda request: asked.append(request.url))
    tab.on("console", lambda message: said.append(message.text))
    summary = (classroom.feedback("ben") / "index.html").as_uri()
    tab.goto(summary)
    tab.get_by_text("Carrying a point from B to A").click()
    heading = tab.get_by_role("heading", name="Carrying a point from B to A")
    heading.wait_for()
    assert -1 <= heading.evaluate("found => found.getBoundingClientRect().top") < 100
    assert {url.partition("#")[0] for url in asked if not url.startswith("data:")} == {
        summary,
        summary.replace("index", TWO),
    }
    assert said == []
    sizes = tab.locator("math").evaluate_all("all => all.map(one => one.getBoundingClientRect().height)")
    assert len(sizes) > 10 and min(sizes[:1]) > 5
    matrix = tab.locator("mtable").first
    assert matrix.evaluate("found => found.getBoundingClientRect().height") > 60  # four rows, and not one
    folded = tab.locator("summary").first
    assert folded.evaluate("found => getComputedStyle(found).display") == "list-item"
    assert folded.evaluate("found => getComputedStyle(found).listStyleType") == "disclosure-closed"
    image = tab.locator("figure img").last
    assert image.evaluate("found => found.complete && found.naturalWidth") > 500


@pytest.mark.parametrize("width, zoom", [(360, 1), (1280, 2)])
def test_pages_fit_a_phone_and_large_letters(classroom, browser, width, zoom):
    tab = browser.new_page(viewport={"width": width // zoom, "height": 700})
    for name in ("index", TWO, FIVE):
        tab.goto((classroom.feedback("ben") / f"{name}.html").as_uri())
        assert tab.evaluate("document.documentElement.scrollWidth") <= width // zoom, name
