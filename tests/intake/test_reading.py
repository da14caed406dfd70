"""Notebook files as editors and tools leave them: nothing that is thrown away anyway costs a student anything."""

import copy
import json

import nbformat
import pytest
from editing import solution
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support import ROOT

from autograder.course import Course
from autograder.grading.grade import grade_submission, grading_run
from autograder.intake import reading
from autograder.intake.reading import Unreadable, cells
from autograder.intake.restore import restore
from autograder.intake.submission import Submission

NAME = "3_chaining"
ANSWERED = "5_pre_grasp"


@pytest.fixture(scope="module")
def course():
    return Course(ROOT)


def kept(content, released):
    """What is judged of a file, and what was said of it."""
    intake = restore(content, released)
    nbformat.validate(intake.notebook)
    shown = [(c.cell_type, c.source, c.metadata, c.get("attachments")) for c in intake.notebook.cells]
    return shown, intake.statuses, intake.problems


def as_bytes(raw):
    return json.dumps(raw).encode()


# --- irregularities that tools are known to leave -----------------------------------------------------------------------


def first(kind):
    return lambda raw: next(cell for cell in raw["cells"] if cell["cell_type"] == kind)


code, text = first("code"), first("markdown")


def last(raw):
    raw["cells"].append({"cell_type": "code", "metadata": {}, "source": "", "outputs": [], "execution_count": None})
    return raw["cells"][-1]


def drop(holder, name):
    del holder[name]


KERNEL = {"display_name": "Python 3", "language": "python", "name": "python3"}
IRREGULAR = {  # each changes the JSON data of a file in a way that some editor or tool does
    "outputs on Markdown": lambda raw: text(raw).update(outputs=[]),
    "a count on Markdown": lambda raw: text(raw).update(execution_count=None),
    "both on Markdown": lambda raw: text(raw).update(outputs=[], execution_count=3),
    "attachments of a code cell": lambda raw: code(raw).update(attachments={}),
    "attachments null": lambda raw: text(raw).update(attachments=None),
    "attachments a list": lambda raw: text(raw).update(attachments=[]),
    "attachments without data": lambda raw: text(raw).update(attachments={"a.png": None}),
    "attachments of numbers": lambda raw: text(raw).update(attachments={"a.png": {"image/png": 7}}),
    "kernelspec with a name only": lambda raw: raw["metadata"].update(kernelspec={"name": "python3"}),
    "kernelspec empty": lambda raw: raw["metadata"].update(kernelspec={}),
    "kernelspec null": lambda raw: raw["metadata"].update(kernelspec=None),
    "kernelspec a text": lambda raw: raw["metadata"].update(kernelspec="python3"),
    "language_info without a name": lambda raw: raw["metadata"].update(language_info={"version": "3.11"}),
    "language_info null": lambda raw: raw["metadata"].update(language_info=None),
    "no metadata": lambda raw: drop(raw, "metadata"),
    "metadata null": lambda raw: raw.update(metadata=None),
    "metadata a list": lambda raw: raw.update(metadata=[]),
    "orig_nbformat": lambda raw: raw.update(orig_nbformat=4),
    "a version": lambda raw: raw.update(version="1.2.3"),
    "authors that are no list": lambda raw: raw["metadata"].update(authors="ann", title=7),
    "a tag twice": lambda raw: code(raw)["metadata"].update(tags=["a", "a"]),
    "a tag with a comma": lambda raw: code(raw)["metadata"].update(tags=["a,b"]),
    "tags as text": lambda raw: code(raw)["metadata"].update(tags="a"),
    "an empty name": lambda raw: code(raw)["metadata"].update(name=""),
    "collapsed as text": lambda raw: code(raw)["metadata"].update(collapsed="true"),
    "scrolled as text": lambda raw: code(raw)["metadata"].update(scrolled="yes"),
    "jupyter null": lambda raw: code(raw)["metadata"].update(jupyter=None),
    "format that is none": lambda raw: text(raw)["metadata"].update(format=7),
    "nbformat as text": lambda raw: raw.update(nbformat="4"),
    "nbformat of tomorrow": lambda raw: raw.update(nbformat=5, nbformat_minor=0),
    "no nbformat": lambda raw: drop(raw, "nbformat"),
    "no nbformat_minor": lambda raw: drop(raw, "nbformat_minor"),
    "nbformat_minor null": lambda raw: raw.update(nbformat_minor=None),
    "an id twice": lambda raw: [cell.update(id="same") for cell in raw["cells"]],
    "an id that is none": lambda raw: [cell.update(id="ä ö" * 50) for cell in raw["cells"]],
    "no ids": lambda raw: [cell.pop("id", None) for cell in raw["cells"]],
    "no cell metadata": lambda raw: drop(code(raw), "metadata"),
    "cell metadata null": lambda raw: code(raw).update(metadata=None),
    "no outputs": lambda raw: drop(code(raw), "outputs"),
    "outputs null": lambda raw: code(raw).update(outputs=None),
    "outputs of no kind": lambda raw: code(raw).update(outputs=[{"output_type": "x"}, 7, None]),
    "no count": lambda raw: drop(code(raw), "execution_count"),
    "a count as text": lambda raw: code(raw).update(execution_count="In [3]"),
    "fields of an editor": lambda raw: [cell.update(editor={"a": [1]}, locked=True) for cell in raw["cells"]],
    "source as one text": lambda raw: [cell.update(source="".join(cell["source"])) for cell in raw["cells"]],
    "lines without ends": lambda raw: [
        cell.update(source="".join(cell["source"]).split("\n")) for cell in raw["cells"] if len(cell["source"]) > 1
    ],
    "lines of Windows": lambda raw: [
        cell.update(source="".join(cell["source"]).replace("\n", "\r\n")) for cell in raw["cells"]
    ],
    "cell types in capitals": lambda raw: [cell.update(cell_type=cell["cell_type"].title()) for cell in raw["cells"]],
    "a code cell without a type": lambda raw: drop(code(raw), "cell_type"),
}
ADDED = {  # the same, with one more cell, which is the last one
    "a cell without source": lambda raw: drop(last(raw), "source"),
    "a source that is null": lambda raw: last(raw).update(source=None),
    "a source of numbers": lambda raw: last(raw).update(source=[1, None, {}]),
    "a cell of no type": lambda raw: last(raw).update(cell_type=None),
    "a cell that is null": lambda raw: raw["cells"].append(None),
    "a raw cell": lambda raw: last(raw).update(cell_type="raw", source="words"),
    "a heading": lambda raw: last(raw).update(cell_type="heading", level=2, source="Words"),
}


@pytest.mark.parametrize("name", [NAME, ANSWERED])
@pytest.mark.parametrize("irregularity", IRREGULAR)
def test_an_irregularity_changes_nothing(course, irregularity, name):
    raw = solution(name)
    wanted = kept(as_bytes(raw), course.notebooks[name])
    IRREGULAR[irregularity](raw)
    assert kept(as_bytes(raw), course.notebooks[name]) == wanted
    assert wanted[1:] == ({}, [])


@pytest.mark.parametrize("irregularity", ADDED)
def test_a_cell_more_changes_nothing_else(course, irregularity):
    raw, released = solution(NAME), course.notebooks[NAME]
    wanted = kept(as_bytes(raw), released)
    ADDED[irregularity](raw)
    shown, statuses, problems = kept(as_bytes(raw), released)
    assert (shown[: len(wanted[0])], statuses, problems) == wanted
    assert len(shown) - len(wanted[0]) == (irregularity != "a cell that is null")


def test_irregular_notebooks_earn_what_they_are_worth(course, sandboxed, thorough):
    names = list(IRREGULAR | ADDED) if thorough else ["both on Markdown", "kernelspec empty", "a cell without source"]
    run = grading_run(course, 7, notebooks=[NAME])
    for name in names:
        raw = solution(NAME)
        (IRREGULAR | ADDED)[name](raw)
        graded = grade_submission(Submission("ann", {f"{NAME}.ipynb": as_bytes(raw)}), run)
        earned = [(row.score, row.status) for row in graded.rows if row.notebook == NAME]
        assert earned == [(points, "graded") for points in course.notebooks[NAME].points.values()], name
        assert graded.problems == [], name


def test_cells_of_an_unknown_type_are_text_and_are_told(course):
    raw = solution(NAME)
    last(raw).update(cell_type="sql", source="select *")
    shown, statuses, problems = kept(as_bytes(raw), course.notebooks[NAME])
    assert shown[-1][:2] == ("markdown", "select *") and statuses == {}
    assert problems == [f"{NAME}.ipynb: 1 cell of the unknown type 'sql' was taken for text."]


@pytest.mark.parametrize("minor", range(6))
def test_formats_of_all_years(course, minor):
    """nbformat itself writes the older ones."""
    raw, released = solution(NAME), course.notebooks[NAME]
    wanted = kept(as_bytes(raw), released)
    notebook = nbformat.reads(json.dumps(raw), as_version=4)
    notebook.nbformat_minor = minor
    for cell in notebook.cells if minor < 5 else ():
        cell.pop("id", None)
    assert kept(nbformat.writes(notebook).encode(), released) == wanted
    if minor == 0:
        old = nbformat.convert(copy.deepcopy(notebook), 3)
        shown, statuses, problems = kept(nbformat.writes(old, 3).encode(), released)
        assert [cell[:2] for cell in shown] == [cell[:2] for cell in wanted[0]] and statuses == {}


def test_pictures_stay(course):
    raw = solution(ANSWERED)
    answer = next(cell for cell in raw["cells"] if "bottle's own z axis" in "".join(cell["source"]))
    answer["attachments"] = {
        "hand.png": {"image/png": ["aGFu", "ZA=="]},
        "bad.png": [],
        "worse.png": {"image/png": None},
    }
    shown, _, _ = kept(as_bytes(raw), course.notebooks[ANSWERED])
    assert [cell[3] for cell in shown if cell[3]] == [{"hand.png": {"image/png": "aGFuZA=="}}]


# --- anything at all in what is thrown away ------------------------------------------------------------------------------

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=6,
)
OF_NOTEBOOKS = ["metadata", "nbformat", "nbformat_minor", "orig_nbformat", "version", "signature", "id"]
OF_CELLS = ["id", "outputs", "execution_count", "level", "language", "collapsed", "prompt_number", "editor", "x"]
OF_METADATA = "tags name collapsed scrolled jupyter format slideshow deletable editable vscode colab id pycharm".split()
ENCODINGS = ["utf-8", "utf-8-sig", "utf-16", "utf-32"]


@st.composite
def changed_files(draw):
    """(bytes of a solved notebook in which everything that is thrown away is whatever comes, the notebook's name)"""
    name = draw(st.sampled_from([NAME, ANSWERED]))
    raw = solution(name)
    for field, value in draw(st.dictionaries(st.sampled_from(OF_NOTEBOOKS), VALUES, max_size=4)).items():
        raw[field] = value
    for number in draw(st.lists(st.integers(0, len(raw["cells"]) - 1), max_size=6)):
        cell = raw["cells"][number]
        metadata = cell["metadata"] if isinstance(cell.get("metadata"), dict) else {}
        metadata |= draw(
            st.dictionaries(st.sampled_from(OF_METADATA) | st.text(min_size=9, max_size=12), VALUES, max_size=3)
        )
        cell |= draw(st.dictionaries(st.sampled_from(OF_CELLS), VALUES, max_size=3))
        if cell["cell_type"] == "markdown":
            broken = VALUES.filter(lambda value: not (isinstance(value, dict) and any(map(_has_data, value.values()))))
            cell["attachments"] = draw(broken)
        if draw(st.booleans()):
            cell["source"] = "".join(cell["source"])
        if draw(st.booleans()):
            for field in draw(st.sets(st.sampled_from(["outputs", "execution_count", "id"]))):
                cell.pop(field, None)
        if "nbgrader" not in metadata and draw(st.booleans()):
            cell["metadata"] = draw(VALUES.filter(lambda value: not isinstance(value, dict)))
    raw = {field: raw[field] for field in draw(st.permutations(list(raw)))}
    text = json.dumps(raw, indent=draw(st.sampled_from([None, 1, "\t"])), ensure_ascii=True)
    text = draw(st.sampled_from(["", "\n", " \t\r\n"])) + text + draw(st.sampled_from(["", "\n", "\n}]}", "\0\0"]))
    return text.encode(draw(st.sampled_from(ENCODINGS))), name


def _has_data(value):
    return isinstance(value, dict) and any(isinstance(data, (str, list)) for data in value.values())


def test_what_is_thrown_away_may_be_anything(course, thorough):
    wanted = {name: kept(as_bytes(solution(name)), course.notebooks[name]) for name in (NAME, ANSWERED)}

    @settings(
        max_examples=2_000 if thorough else 60, deadline=None, database=None, derandomize=True,
        suppress_health_check=list(HealthCheck),
    )  # fmt: skip
    @given(changed_files())
    def holds(changed):
        content, name = changed
        assert kept(content, course.notebooks[name]) == wanted[name]

    holds()


# --- what is too much -----------------------------------------------------------------------------------------------------


def test_a_notebook_too_large_because_of_its_outputs_is_taken_without_them(course):
    raw = solution(NAME)
    wanted = kept(as_bytes(raw), course.notebooks[NAME])
    picture = {"output_type": "display_data", "data": {"image/png": "A" * 30_000_000}, "metadata": {}}
    code(raw)["outputs"] = [picture]
    content = as_bytes(raw)
    assert len(content) > reading.LARGEST_TEXT
    assert kept(content, course.notebooks[NAME]) == wanted


def test_bounds(course, monkeypatch):
    raw = solution(NAME)
    monkeypatch.setattr(reading, "LARGEST_TEXT", 1_000)
    with pytest.raises(Unreadable, match="without outputs"):
        cells(as_bytes(raw))
    with pytest.raises(Unreadable, match="cells, at most"):
        cells(b'{"cells": [' + b"{}," * 2_000 + b"{}]}")
    monkeypatch.setattr(reading, "LARGEST", 1_000)
    with pytest.raises(Unreadable, match="Clear Outputs of All Cells"):
        cells(as_bytes(raw))


# --- what is no notebook ----------------------------------------------------------------------------------------------------

HALF = as_bytes(solution(NAME))
INDENTED = json.dumps(solution(NAME), indent=1)
MERGED = INDENTED.replace(
    '   "cell_type": "code"', '<<<<<<< HEAD\n   "cell_type": "code"\n=======\n   "cell_type": "raw"\n>>>>>>> 5f3c2a1', 1
)
PROGRAM = "# %%\nimport numpy as np\n\n# %% [markdown]\n# Words\n\ndef chain(*transforms):\n    return 1\n"
NO_NOTEBOOKS = {
    "empty": (b"", "it is empty"),
    "blank": (b" \n\n", "it is empty"),
    "zeros": (bytes(5_000), "it is empty"),
    "web page": (b"<!DOCTYPE html>\n<html><head><title>Log in</title>", "it is a web page"),
    "web page in small letters": (b"\xef\xbb\xbf\n<!doctype html><html lang=en>", "it is a web page"),
    "web page of XML": (b'<?xml version="1.0"?>\n<!DOCTYPE html PUBLIC "x">\n<html>', "it is a web page"),
    "answer of a store": (b'<?xml version="1.0"?><Error><Code>AccessDenied</Code></Error>', "XML"),
    "Git LFS": (b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n", "pointer of Git LFS"),
    "git-annex": (b"/annex/objects/SHA256E-s12345--4d7a.ipynb\n", "pointer of git-annex"),
    "git-annex, a link as text": (b"../.git/annex/objects/xx/yy/SHA256E-s1--4d.ipynb\n", "pointer of git-annex"),
    "Drive": (b'{"url": "https://docs.google.com/open?id=1A", "doc_id": "1A", "email": "a@b.org"}', "Google Drive"),
    "Drive, older": (b'{"url": "https://colab.research.google.com/drive/1A", "resource_id": "x"}', "Google Drive"),
    "shortcut of Windows": (b"[InternetShortcut]\r\nURL=https://example.org\r\n", "a shortcut"),
    "link of Windows": (b"L\x00\x00\x00\x01\x14\x02\x00" + bytes(50), "shortcut of Windows"),
    "shortcut of macOS": (b'<?xml version="1.0"?>\n<!DOCTYPE plist PUBLIC "x">\n<plist>', "shortcut of macOS"),
    "AppleDouble": (b"\x00\x05\x16\x07\x00\x02\x00\x00Mac OS X", "macOS keeps beside"),
    "program": (PROGRAM.encode(), "a Python program"),
    "program with a slip": (b"import numpy as np\ndef f(:\n  pass\n", "a Python program"),
    "Markdown notebook": (
        b"---\njupyter:\n  kernelspec:\n    name: python3\n---\n\n# Words\n\n```python\n1\n```\n",
        "jupytext",
    ),
    "MyST": (b"# Words\n\n```{code-cell} ipython3\n1\n```\n", "jupytext"),
    "words": ("Liebe Frau Müller, hier ist meine Lösung".encode("cp1252"), "it is a text"),
    "zip": (b"PK\x03\x04" + bytes(50), "a zip archive"),
    "gzip": (b"\x1f\x8b\x08" + bytes(50), "packed by gzip"),
    "7z": (b"7z\xbc\xaf\x27\x1c" + bytes(50), "a 7z archive"),
    "RAR": (b"Rar!\x1a\x07\x01" + bytes(50), "a RAR archive"),
    "PDF": (b"%PDF-1.7\n%\xe2\xe3", "a PDF"),
    "picture": (b"\x89PNG\r\n\x1a\n" + bytes(50), "a picture"),
    "RTF": (b"{\\rtf1\\ansi {\\cells}}", "word processor"),
    "conflict": (MERGED.encode(), "conflict marks in it (lines "),
    "cut off": (HALF[: len(HALF) // 2], "cut off after"),
    "cut off between cells": (INDENTED[: INDENTED.index('"cell_type": "code"')].encode(), "cut off after"),
    "cut off at its end": (HALF[:-1], "cut off after"),
    "damaged": (INDENTED.replace('"outputs"', "outputs", 1).encode(), "it is damaged in line "),
    "deep": (b"[" * 200_000, "damaged"),
    "list": (b"[]", "something else than a notebook"),
    "package": (b'{"name": "x", "dependencies": {}}', "something else than a notebook"),
    "a number": (b"7", "it is a text"),
    "numbered lines": (b"1. My solution: I multiply.\n2. And so on.", "it is a text"),
    "error of a server": (b"404: Not Found", "it is a text"),
    "program with a docstring": (b'"""My solution."""\nimport numpy as np\n', "a Python program"),
    "diff": (b"diff --git a/3.ipynb b/3.ipynb\n--- a/3.ipynb\n+++ b/3.ipynb\n", "a diff"),
    "link": (b"https://colab.research.google.com/drive/1A?usp=sharing\n", "a link"),
    "link in Markdown": (b"[my notebook](https://colab.research.google.com/drive/1A)", "it is a text"),
    "MHTML": (b"From: <Saved by Blink>\nMIME-Version: 1.0\n", "a web page or a mail"),
    "tar": (b"3_chaining.ipynb".ljust(257, b"\0") + b"ustar\0" + bytes(500), "a tar archive"),
    "mail": (b"Dear all,\nfrom my point of view it is right.\n", "it is a text"),
    "500 of Jupyter": (b'{"message": "Unhandled error", "reason": null, "traceback": "x"}', "a server's message"),
    "Markdown notebook with code": (
        b"---\njupyter:\n  kernelspec:\n    name: python3\n---\n\n```python\nimport numpy as np\n```\n",
        "jupytext",
    ),
    "Quarto": (b"# Words\n\n```{python}\nimport numpy as np\ndef f():\n    pass\n```\n", "jupytext"),
    "server's message": (b'{"message": "Not Found", "reason": null}', "a server's message"),
    "no cells": (b'{"nbformat": 4, "nbformat_minor": 5, "metadata": {}, "cells": []}', "without any cell"),
    "cells that are none": (b'{"nbformat": 4, "cells": "x"}', "cells are no list"),
    "binary": (bytes(range(1, 256)) * 20, "cannot be a notebook"),
}
OF_READERS = "Expecting Unterminated delimiter column codec Extra Invalid nbformat jsonschema char required".split()


@pytest.mark.parametrize("kind", NO_NOTEBOOKS)
def test_what_is_no_notebook_is_named_for_what_it_looks_like(course, kind):
    content, words = NO_NOTEBOOKS[kind]
    released = course.notebooks[NAME]
    shown, statuses, (problem,) = kept(content, released)
    assert statuses == dict.fromkeys(released.points, "unreadable")
    assert problem.startswith(f"{NAME}.ipynb: it cannot be read: ") and words in problem
    assert "hand " in problem or "clear" in problem  # it says what to do
    assert not [word for word in OF_READERS if word in problem]
    assert "could not be read" in shown[0][1] and words in shown[0][1]


@pytest.mark.parametrize("share", [number / 40 for number in range(1, 40)])
def test_wherever_a_file_is_cut_off(course, share):
    for content in (HALF, INDENTED.encode()):
        _, _, (problem,) = kept(content[: int(len(content) * share)], course.notebooks[NAME])
        assert "cut off after" in problem


def test_a_notebook_that_a_server_answered_with_is_read(course):
    raw = solution(NAME)
    answer = {"name": f"{NAME}.ipynb", "type": "notebook", "format": "json", "content": raw}
    assert kept(as_bytes(answer), course.notebooks[NAME]) == kept(as_bytes(raw), course.notebooks[NAME])


def test_a_file_in_windows_letters_is_read(course):
    raw = solution(ANSWERED)
    answer = next(cell for cell in raw["cells"] if "bottle's own z axis" in "".join(cell["source"]))
    answer["source"] = "Größe"
    raw["cells"] = [cell for cell in raw["cells"] if cell["metadata"].get("nbgrader")]
    content = json.dumps(raw, ensure_ascii=False).encode("cp1252")
    assert "Größe" in [cell[1] for cell in kept(content, course.notebooks[ANSWERED])[0]]


def test_a_file_of_countless_parts_is_not_read(course, monkeypatch):
    """What a file needs in memory goes by its parts more than by its bytes."""
    monkeypatch.setattr(reading, "MOST_PARTS", 1_000)
    monkeypatch.setattr(reading, "_json", None)  # it would be called
    raw = solution(NAME)
    code(raw)["outputs"] = [[]] * 1_000
    with pytest.raises(Unreadable, match="clear its outputs"):
        cells(as_bytes(raw))


def test_an_integer_of_countless_digits_is_no_obstacle(course):
    content = as_bytes(solution(NAME)).replace(
        b'"execution_count": 1,', b'"execution_count": ' + b"7" * 10_000 + b",", 1
    )
    assert b"7" * 10_000 in content
    assert kept(content, course.notebooks[NAME]) == kept(as_bytes(solution(NAME)), course.notebooks[NAME])


def test_a_line_that_a_program_has_put_in_front(course):
    content = as_bytes(solution(NAME))
    assert kept(b"[I 12:00:00] Saving file\n" + content, course.notebooks[NAME]) == kept(
        content, course.notebooks[NAME]
    )
