"""Work that is there counts, wherever it lies and whatever a tool did to the cells around it."""

import copy
import json

import pytest
from editing import solution
from support import ROOT

from autograder.course import Course
from autograder.grading.grade import grade_submission, grading_run
from autograder.grading.marks import marks
from autograder.intake.restore import restore
from autograder.intake.submission import Submission

NAME, ANSWERED = "3_chaining", "5_pre_grasp"
QUESTION = "question-which-frame"
WORDS = "Of the object: the gripper knows no other."
RIGHT = """\
def chain(*transforms):
    result = transforms[0]
    for t in transforms[1:]:
        result = result @ t
    return result
"""
WRONG = RIGHT.replace("result @ t", "t @ result")


@pytest.fixture(scope="module")
def course():
    return Course(ROOT)


class Notebook:
    """A notebook's JSON data, with its cells by the names that nbgrader knows them by."""

    def __init__(self, name, raw=None):
        self.name, self.raw = name, raw or solution(name)
        self.cells = self.raw["cells"]
        for cell in self.cells:
            cell["source"] = "".join(cell["source"])

    def __getitem__(self, name):
        return next(cell for cell in self.cells if entry(cell).get("grade_id") == name)

    def place(self, name):
        return self.cells.index(self[name])

    def drop(self, name):
        self.cells.remove(self[name])

    def insert(self, place, source, kind="code", nbgrader=None):
        metadata = {"nbgrader": copy.deepcopy(nbgrader)} if nbgrader else {}
        self.cells.insert(place, {"cell_type": kind, "metadata": metadata, "source": source})

    def strip(self, *names):
        """Lose nbgrader's entries, of all cells or of some."""
        for cell in self.cells:
            if not names or entry(cell).get("grade_id") in names:
                cell["metadata"] = {}

    def restored(self, course):
        return restore(json.dumps(self.raw).encode(), course.notebooks[self.name])


def entry(cell):
    return cell["metadata"].get("nbgrader", {})


def named(intake, name):
    (found,) = (cell for cell in intake.notebook.cells if cell.metadata.get("nbgrader", {}).get("grade_id") == name)
    return found


def judged(intake, name):
    """The text of the function that stands last above the test cell of an exercise, or None."""
    above = intake.notebook.cells[: intake.notebook.cells.index(named(intake, name))]
    return next((c.source for c in reversed(above) if c.cell_type == "code" and f"def {name}(" in c.source), None)


# --- check cells and solutions ------------------------------------------------------------------------------------------


def deleted(n):
    n.drop("chain")


def joined(n):
    n["chain-solution"]["source"] += "\n\n" + n["chain"]["source"]
    n.drop("chain")


def joined_the_other_way(n):
    n["chain"]["source"] = n["chain-solution"]["source"] + "\n\n" + n["chain"]["source"]
    n.drop("chain-solution")


def joined_without_the_call(n):
    n["chain"]["source"] = n["chain-solution"]["source"]
    n.drop("chain-solution")


def written_into_the_check(n):
    n["chain"]["source"] = RIGHT + "\n" + n["chain"]["source"]
    n["chain-solution"]["source"] = "def chain(*transforms):\n    raise NotImplementedError"


def split(n):
    n["chain"]["source"] = 'check("chain",'
    n.insert(n.place("chain") + 1, "chain)", nbgrader=entry(n["chain"]))


def retyped(n):
    n.insert(n.place("chain"), "check( 'chain' , chain )  # once more")
    n.drop("chain")


def by_keywords(n):
    n["chain"]["source"] = "check(name='chain', value=chain)"


def printed_into(n):
    n["chain"]["source"] += "\nprint('hello')"


def replaced(n):
    n["chain"]["source"] = "print(chain)"


def emptied(n):
    n["chain"]["source"] = ""


def turned_to_text(n):
    n["chain"].update(cell_type="markdown")


def all_stripped(n):
    n.strip()


def checks_stripped(n):
    n.strip("chain", "transform_pose")


def solution_retyped(n):
    n.insert(n.place("chain-solution"), RIGHT)
    n.drop("chain-solution")


def solution_retyped_below(n):
    n.drop("chain-solution")
    n.insert(n.place("chain") + 1, RIGHT)


def solution_retyped_and_the_stub_kept(n):
    n["chain-solution"]["source"] = released_text(n, "chain-solution")
    n.insert(n.place("chain-solution"), RIGHT)


def solution_retyped_behind_the_check(n):
    n["chain-solution"]["source"] = released_text(n, "chain-solution")
    n.insert(n.place("chain") + 1, RIGHT)


def solution_and_check_swapped(n):
    solution = n["chain-solution"]
    n.cells.remove(solution)
    n.cells.insert(n.place("chain") + 1, solution)


def solution_as_text(n):
    n["chain-solution"].update(cell_type="markdown")


def retyped_solution_as_text(n):
    n.drop("chain-solution")
    n.insert(n.place("chain"), RIGHT, kind="markdown")


def copied_before_it_was_written(n):
    n.insert(n.place("chain-solution") + 1, released_text(n, "chain-solution"), nbgrader=entry(n["chain-solution"]))


def copied_and_the_copy_written(n):
    right = n["chain-solution"]["source"]
    n["chain-solution"]["source"] = released_text(n, "chain-solution")
    n.insert(n.place("chain-solution") + 1, right, nbgrader=entry(n["chain-solution"]))


def copied_below_the_check(n):
    n.insert(n.place("chain") + 1, n["chain-solution"]["source"], nbgrader=entry(n["chain-solution"]))
    n["chain-solution"]["source"] = WRONG


def both_in_one_cell(n):
    n["chain-solution"]["source"] += "\n\n" + n["transform_pose-solution"]["source"]
    n.drop("transform_pose-solution")


def both_in_one_cell_and_the_stub_kept(n):
    n["chain-solution"]["source"] += "\n\n" + n["transform_pose-solution"]["source"]
    n["transform_pose-solution"]["source"] = released_text(n, "transform_pose-solution")


def under_a_magic(n):
    n["chain-solution"]["source"] = "%%time\n" + n["chain-solution"]["source"]
    n.drop("chain")


def all_moved_to_the_end(n):
    solution, check = n["chain-solution"], n["chain"]
    for cell in (solution, check):
        n.cells.remove(cell)
    n.cells += [solution, check]


def both_in_one_cell_and_the_checks_deleted(n):
    both_in_one_cell(n)
    n.drop("chain"), n.drop("transform_pose")


def both_in_the_second_cell_and_a_check_deleted(n):
    n["transform_pose-solution"]["source"] = RIGHT + "\n\n" + n["transform_pose-solution"]["source"]
    n.drop("chain-solution"), n.drop("chain")


def swapped_and_the_checks_deleted(n):
    first, second = n["chain-solution"], n["transform_pose-solution"]
    first["source"], second["source"] = second["source"], first["source"]
    n.drop("chain"), n.drop("transform_pose")


def everything_in_the_first_cell(n):
    for name in ("chain", "transform_pose"):
        n.cells[1]["source"] += "\n\n" + n[f"{name}-solution"]["source"]
        n.drop(f"{name}-solution"), n.drop(name)


def stripped_with_a_scratch_line_below(n):
    n.strip()
    n.insert(len(n.cells), "chain = chain(np.eye(4))")


def stripped_with_an_experiment_below(n):
    n.strip()
    n.insert(len(n.cells), WRONG)


def stub_kept_and_an_experiment_below(n):
    solution_retyped_and_the_stub_kept(n)
    n.insert(len(n.cells), WRONG)


def retyped_and_a_loop_below(n):
    solution_retyped(n)
    n.insert(len(n.cells), "for chain in [1, 2]:\n    print(chain)")


def stub_pasted_below_without_an_entry(n):
    n.insert(n.place("chain-solution") + 1, released_text(n, "chain-solution"))


def stub_with_a_comment_and_the_solution_below_the_check(n):
    n["chain-solution"]["source"] = released_text(n, "chain-solution") + "\n    # todo"
    n.insert(n.place("chain") + 1, RIGHT)
    n.insert(n.place("chain") + 2, 'check("chain", chain)')


def solution_with_its_check_below_the_check(n):
    n["chain-solution"]["source"] = released_text(n, "chain-solution")
    n.insert(n.place("chain") + 1, RIGHT + '\ncheck("chain", chain)')


def solution_fenced(n):
    n["chain-solution"].update(cell_type="markdown", source=f"My solution:\n\n```python\n{RIGHT}```\n\nIt multiplies.")


def solution_fenced_in_a_new_cell(n):
    n["chain-solution"]["source"] = released_text(n, "chain-solution")
    n.insert(n.place("chain-solution") + 1, f"```python\n{RIGHT}```", "markdown")


def solution_split(n):
    lines = RIGHT.split("\n")
    n["chain-solution"]["source"] = "\n".join(lines[:2])
    n.insert(n.place("chain-solution") + 1, "\n".join(lines[2:]))


def solution_split_with_both_entries(n):
    solution_split(n)
    n.cells[n.place("chain-solution") + 1]["metadata"] = {"nbgrader": entry(n["chain-solution"])}


def solution_split_after_its_first_line(n):
    lines = RIGHT.split("\n")
    n["chain-solution"]["source"] = lines[0]
    n.insert(n.place("chain-solution") + 1, "\n".join(lines[1:]))


def released_text(n, name):
    return Course(ROOT).notebooks[n.name].cells[name].source


TOOLS = [
    deleted, joined, joined_the_other_way, joined_without_the_call, written_into_the_check, split, retyped, by_keywords,
    printed_into, replaced, emptied, turned_to_text, all_stripped, checks_stripped, solution_retyped,
    solution_retyped_below, solution_retyped_and_the_stub_kept, solution_retyped_behind_the_check,
    solution_and_check_swapped, solution_as_text, retyped_solution_as_text, copied_before_it_was_written,
    copied_and_the_copy_written, copied_below_the_check, both_in_one_cell, both_in_one_cell_and_the_stub_kept,
    under_a_magic, all_moved_to_the_end, both_in_one_cell_and_the_checks_deleted,
    both_in_the_second_cell_and_a_check_deleted, swapped_and_the_checks_deleted, everything_in_the_first_cell,
    stripped_with_a_scratch_line_below, stripped_with_an_experiment_below, stub_kept_and_an_experiment_below,
    retyped_and_a_loop_below, stub_pasted_below_without_an_entry,
    stub_with_a_comment_and_the_solution_below_the_check, solution_with_its_check_below_the_check, solution_fenced,
    solution_fenced_in_a_new_cell, solution_split, solution_split_with_both_entries,
    solution_split_after_its_first_line,
]  # fmt: skip
SILENT = {retyped, by_keywords, all_moved_to_the_end, stub_pasted_below_without_an_entry}


@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.__name__)
def test_the_student_s_function_stands_above_its_test_cell(course, tool):
    notebook = Notebook(NAME)
    tool(notebook)
    intake = notebook.restored(course)
    assert intake.statuses == {}
    for name in ("chain", "transform_pose"):
        released = course.notebooks[NAME].cells
        assert (named(intake, name).source, named(intake, name).metadata) == (
            released[name].source,
            released[name].metadata,
        )
        found = judged(intake, name)
        assert found and "raise NotImplementedError" not in found and found.strip() != WRONG.strip(), found
        assert named(intake, f"{name}-solution")
    assert intake.problems or tool in SILENT
    assert all(problem.startswith(f"{NAME}.ipynb: ") and problem.endswith(".") for problem in intake.problems)


def test_all_of_them_earn_all_points(course, sandboxed, thorough):
    run = grading_run(course, 7, notebooks=[NAME])
    for tool in TOOLS if thorough else [joined_the_other_way, split, both_in_one_cell_and_the_stub_kept]:
        notebook = Notebook(NAME)
        tool(notebook)
        files = {f"{NAME}.ipynb": json.dumps(notebook.raw).encode()}
        rows = [row for row in grade_submission(Submission("ann", files), run).rows if row.notebook == NAME]
        assert [(row.exercise, row.score, row.remark) for row in rows] == [
            (name, points, "") for name, points in course.notebooks[NAME].points.items()
        ], tool.__name__


@pytest.mark.parametrize(
    "tool, words",
    [
        (deleted, "the test cell of chain is missing; it was put back behind its solution"),
        (
            split,
            "the test cell of chain had been changed; what stands there was run, and the test cell put back behind it",
        ),
        (
            joined,
            "the test cell of chain had been changed; what stands there was run, and the test cell put back behind it",
        ),
        (turned_to_text, "the cell chain had another type; it was set back"),
        (all_stripped, "nbgrader's data of all cells were lost; they were recognised by what stands in them"),
        (
            checks_stripped,
            "the test cell of chain, transform_pose had lost its nbgrader data; it was recognised by its call",
        ),
        (solution_and_check_swapped, "the test cell of chain stood before its solution; it was moved behind it"),
        (
            copied_and_the_copy_written,
            "the cell chain-solution is there 2 times; the one that was written in was graded",
        ),
        (solution_as_text, "the cell chain-solution had another type; it was set back"),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_what_was_mended_is_said(course, tool, words):
    notebook = Notebook(NAME)
    tool(notebook)
    assert f"{NAME}.ipynb: {words}." in notebook.restored(course).problems


def test_of_two_copies_that_were_written_the_last_one_counts(course):
    notebook = Notebook(NAME)
    notebook.insert(notebook.place("chain") + 1, WRONG, nbgrader=entry(notebook["chain-solution"]))
    intake = notebook.restored(course)
    assert judged(intake, "chain") == WRONG and named(intake, "chain-solution").source == WRONG
    assert "is there 2 times; the last one that was written in was graded" in intake.problems[0]


def test_nothing_of_an_exercise_is_missing(course):
    notebook = Notebook(NAME)
    notebook.drop("chain"), notebook.drop("chain-solution")
    intake = notebook.restored(course)
    assert intake.statuses == {"chain": "missing"}
    assert "the test cell of chain is missing, and so is the function: 0 points" in intake.problems[0]
    assert named(intake, "chain") and named(intake, "chain-solution")


def test_an_experiment_below_does_not_count(course):
    """Where nothing is odd, the test cell judges what stands above it, as nbgrader does."""
    notebook = Notebook(NAME)
    notebook.insert(notebook.place("chain") + 2, WRONG)
    intake = notebook.restored(course)
    assert judged(intake, "chain") == notebook["chain-solution"]["source"] and intake.problems == []


def test_a_function_from_where_its_name_is_not_seen(course):
    notebook = Notebook(NAME)
    notebook.insert(notebook.place("chain") + 1, "from mine import *")
    notebook.drop("chain"), notebook.drop("chain-solution")
    intake = notebook.restored(course)
    assert intake.statuses == {}
    above = intake.notebook.cells[intake.notebook.cells.index(named(intake, "chain")) - 1]
    assert above.source == "from mine import *"


@pytest.mark.parametrize("source", ["chain = np.eye(4)", "from itertools import chain", "for chain in []:\n    pass"])
def test_another_use_of_the_name_is_no_solution(course, source):
    notebook = Notebook(NAME, json.loads(course.notebooks[NAME].text))
    notebook.insert(1, source)
    intake = notebook.restored(course)
    assert intake.problems == [] and "raise NotImplementedError" in judged(intake, "chain")


def test_what_was_not_done_stays_not_done(course):
    notebook = Notebook(NAME, json.loads(course.notebooks[NAME].text))
    for tool in (deleted, all_stripped):
        tool(notebook)
        intake = notebook.restored(course)
        assert "raise NotImplementedError" in judged(intake, "chain") and intake.statuses == {}


# --- written answers ----------------------------------------------------------------------------------------------------


def unanswered(n):
    n[QUESTION]["source"] = released_text(n, QUESTION)


def answer_stripped(n):
    n[QUESTION]["source"] = WORDS
    n.strip()


def answer_before_an_untouched_copy(n):
    n.insert(n.place(QUESTION) + 1, released_text(n, QUESTION), "markdown", entry(n[QUESTION]))
    n[QUESTION]["source"] = WORDS


def answer_behind_an_untouched_copy(n):
    n.insert(n.place(QUESTION), released_text(n, QUESTION), "markdown", entry(n[QUESTION]))
    n.cells[n.place(QUESTION) + 1]["source"] = WORDS


def answer_in_a_new_cell_below(n):
    unanswered(n)
    n.insert(n.place(QUESTION) + 1, WORDS, "markdown")


def answer_in_a_new_cell_above(n):
    unanswered(n)
    n.insert(n.place(QUESTION), WORDS, "markdown")


def answer_in_a_raw_cell(n):
    unanswered(n)
    n.insert(n.place(QUESTION) + 1, WORDS, "raw")


def answer_in_two_cells(n):
    unanswered(n)
    n.insert(n.place(QUESTION) + 1, WORDS, "markdown")
    n.insert(n.place(QUESTION) + 2, "And more.", "markdown")


def answer_as_code(n):
    unanswered(n)
    n.insert(n.place(QUESTION) + 1, "# " + WORDS, "code")


def answer_below_its_question(n):
    unanswered(n)
    n.cells[n.place(QUESTION) - 1]["source"] += "\n\n" + WORDS


def answer_cell_retyped(n):
    n.insert(n.place(QUESTION), WORDS, "markdown")
    n.drop(QUESTION)


def answer_cell_deleted(n):
    n.drop(QUESTION)


def answer_emptied(n):
    n[QUESTION]["source"] = ""


def answer_as_a_code_cell(n):
    n[QUESTION].update(cell_type="code", source=WORDS)


def answer_at_the_end(n):
    unanswered(n)
    n.insert(len(n.cells), f"## Question: which way is up?\n\n{WORDS}", "markdown")


def answer_at_the_top(n):
    unanswered(n)
    n.insert(1, f"Which way is up? {WORDS}", "markdown")


def answer_behind_the_next_heading(n):
    unanswered(n)
    n.insert(n.place(QUESTION) + 2, WORDS, "markdown")


def answer_shown_by_code(n):
    unanswered(n)
    n.insert(len(n.cells), f"from IPython.display import Markdown\nMarkdown('''{WORDS}''')", "code")


def answer_in_a_comment(n):
    unanswered(n)
    n["waypoint-solution"]["source"] += f"\n# Answer: {WORDS}"


def answer_above_its_heading(n):
    unanswered(n)
    n.cells[n.place(QUESTION) - 2]["source"] += f"\n# Question: {WORDS}"


def answer_as_a_picture(n):
    n[QUESTION]["source"] = released_text(n, QUESTION)
    n[QUESTION]["attachments"] = {"hand.png": {"image/png": "aGFuZA=="}}


def answer_as_a_picture_below(n):
    unanswered(n)
    n.insert(n.place(QUESTION) + 1, "", "markdown")
    n.cells[n.place(QUESTION) + 1]["attachments"] = {"hand.png": {"image/png": "aGFuZA=="}}


ANSWERS = [
    answer_stripped, answer_before_an_untouched_copy, answer_behind_an_untouched_copy, answer_in_a_new_cell_below,
    answer_in_a_new_cell_above, answer_in_a_raw_cell, answer_in_two_cells, answer_as_code, answer_below_its_question,
    answer_cell_retyped, answer_cell_deleted, answer_emptied, answer_as_a_code_cell, answer_at_the_end,
    answer_at_the_top, answer_behind_the_next_heading, answer_shown_by_code, answer_in_a_comment,
    answer_above_its_heading, answer_as_a_picture, answer_as_a_picture_below,
]  # fmt: skip
BESIDE = {
    answer_in_two_cells, answer_as_code, answer_at_the_end, answer_at_the_top, answer_behind_the_next_heading,
    answer_shown_by_code, answer_in_a_comment, answer_above_its_heading,
}  # fmt: skip
PICTURES = {answer_as_a_picture, answer_as_a_picture_below}


@pytest.mark.parametrize("tool", ANSWERS, ids=lambda tool: tool.__name__)
def test_a_person_reads_what_was_written(course, tool):
    notebook = Notebook(ANSWERED)
    tool(notebook)
    intake = notebook.restored(course)
    found = marks(intake.notebook)
    assert found.scores[QUESTION] is None and found.comments[QUESTION] is None
    answer, everything = named(intake, QUESTION), [cell.source for cell in intake.notebook.cells]
    if tool in BESIDE:
        assert "written elsewhere" in answer.source and WORDS in answer.source
        assert any(WORDS in source for source in everything)
    elif tool in PICTURES:
        assert "![hand.png](<attachment:hand.png>)" in answer.source and "hand.png" in answer.attachments
    elif tool is answer_cell_deleted:
        assert "The grader has added it" in answer.source
        assert "Question: which way is up?" in everything[everything.index(answer.source) - 1]
    elif tool is not answer_emptied:
        assert answer.source.endswith(WORDS) and sum(WORDS in source for source in everything) == 1
        assert sum("YOUR ANSWER HERE" in source for source in everything) == 0
    assert intake.problems or tool in (answer_emptied, answer_as_a_picture)


@pytest.mark.parametrize("tool", [unanswered, lambda n: (unanswered(n), n.strip())], ids=["as given", "stripped"])
def test_an_answer_that_nobody_gave_gets_nothing(course, tool):
    notebook = Notebook(ANSWERED)
    tool(notebook)
    found = marks(notebook.restored(course).notebook)
    assert found.scores[QUESTION] == 0 and found.comments[QUESTION] == "No response."


def test_of_two_answers_the_last_one_counts_and_both_are_seen(course):
    notebook = Notebook(ANSWERED)
    notebook.insert(notebook.place(QUESTION) + 1, WORDS, "markdown", entry(notebook[QUESTION]))
    first = notebook[QUESTION]["source"]
    intake = notebook.restored(course)
    assert named(intake, QUESTION).source == WORDS
    assert first in [cell.source for cell in intake.notebook.cells]
    assert "is there 2 times; the last one that was written in was graded" in intake.problems[0]


def test_a_note_elsewhere_is_no_answer(course):
    notebook = Notebook(ANSWERED)
    unanswered(notebook)
    notebook.insert(3, "My notes.", "markdown")
    notebook.insert(5, "x = 1  # to try it", "code")
    notebook.insert(len(notebook.cells), "print(1)", "code")
    assert marks(notebook.restored(course).notebook).scores[QUESTION] == 0
