"""What a file is that came in a notebook's place and is none: in words, with what to do, and never a reader's own error."""

import ast
import re

from .python_text import tree_of

AGAIN = "hand in the notebook itself (in Jupyter: File > Download)"
PULL = "hand in the file itself (on your machine: `{}` fetches it)"

# The first bytes of a file, and what it is then.
BEGINNINGS = (
    (b"PK\x03\x04", "a zip archive, or a document of a word processor"),
    (b"PK\x05\x06", "an empty zip archive"),
    (b"\x1f\x8b", "a file packed by gzip"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive"),
    (b"Rar!", "a RAR archive"),
    (b"%PDF-", "a PDF"),
    (b"\x89PNG", "a picture"),
    (b"\xff\xd8\xff", "a picture"),
    (b"GIF8", "a picture"),
    (b"{\\rtf", "a document of a word processor"),
    (b"\xd0\xcf\x11\xe0", "a document of a word processor"),
    (b"bplist00", "a shortcut of macOS, and not the file it leads to"),
    (b"L\x00\x00\x00\x01\x14\x02\x00", "a shortcut of Windows, and not the file it leads to"),
    (b"\x00\x05\x16\x07", "what macOS keeps beside a file (its name begins with ._), and not the file"),
)
# What the beginning of a text says, what the file is then, and what to do.
TEXTS = (
    (
        r"version https://git-lfs\.github\.com/spec/",
        "a pointer of Git LFS, and not the file",
        PULL.format("git lfs pull"),
    ),
    (r"diff --git |--- a/|Index: ", "a list of changes (a diff), and not the file", AGAIN),
    (r"https?://\S+\s*$", "a link, and not the file it leads to", AGAIN),
    (r"MIME-Version: |From: <Saved by ", "a web page or a mail, as a program keeps it", AGAIN),
    (r"\S*annex/objects/", "a pointer of git-annex, and not the file", PULL.format("git annex get")),
    (r"\[InternetShortcut\]|\[Desktop Entry\]", "a shortcut, and not the file it leads to", AGAIN),
    (r"<.{,200}?<!doctype plist|<!doctype plist", "a shortcut of macOS, and not the file it leads to", AGAIN),
    (r"<.{,2000}?<(?:html|head|body)\b|<(?:!doctype html|html|head|body)\b", "a web page (HTML)", AGAIN),
    (r"<[?a-z]", "XML or a part of a web page", AGAIN),
    (r"%!PS|\\documentclass", "a document for printing", AGAIN),
)
CELL_AS_TEXT = r"^(?:jupyter|jupytext|kernelspec):|^```\s*\{(?:code-cell|python)|^\+\+\+"  # R Markdown, MyST
CONFLICT = re.compile(r"^ *\"?(<{7}|={7}|>{7})( |\\n|$)")


def what_it_is(content: bytes, text: str, found: object) -> str:
    """What a file is, and what to do.

    text: the content, decoded; found: the error of reading it as JSON, or what was read, which holds no cells
    """
    if not text.strip("\ufeff\0 \t\r\n"):
        return f"it is empty; {AGAIN}"
    for beginning, name in BEGINNINGS:
        if content.startswith(beginning):
            return f"it is {name}; {AGAIN}"
    if content[257:262] == b"ustar":
        return f"it is a tar archive; {AGAIN}"
    text = text.lstrip("\ufeff \t\r\n")
    if isinstance(found, (dict, list)):
        return _other_json(found)
    if marks := [number for number, line in enumerate(text.split("\n"), 1) if CONFLICT.match(line)]:
        lines = ", ".join(map(str, marks[:6])) + (" …" if marks[6:] else "")
        return (
            f"a merge has left its conflict marks in it (lines {lines}): open it as text, decide for one side, take the "
            "marks out, and see whether Jupyter opens it; then hand it in again"
        )
    for pattern, name, advice in TEXTS:
        if re.match(pattern, text, re.IGNORECASE | re.DOTALL):
            return f"it is {name}; {advice}"
    if re.match(r"\{|\[\s*[\[{]", text):
        return _damaged(content, text, found)
    if re.search(CELL_AS_TEXT, text[:20_000], re.MULTILINE):
        return (
            f"it is a notebook written as text (Markdown); turn it into one with `jupytext --to notebook`, or {AGAIN}"
        )
    if _is_python(text):
        return f"it is a Python program, and no notebook; {AGAIN}"
    if len(re.findall("[\x00-\x08\x0e-\x1a\ufffd]", text)) > len(text) / 50:
        return f"it is no text, so it cannot be a notebook; {AGAIN}"
    return f"it is a text, and no notebook; {AGAIN}"


def _damaged(content, text, error):
    where = getattr(error, "pos", 0)
    if isinstance(error, ValueError) and (where >= len(text.rstrip()) - 6 or "Unterminated" in str(error)):
        size = len(content)
        return f"it is cut off after {size} bytes; download or copy it again, see whether Jupyter opens it, and hand that in"
    line = f" in line {text.count(chr(10), 0, where) + 1}" if isinstance(error, ValueError) else ""
    return f"it is damaged{line}, and Jupyter does not open it either; {AGAIN}"


def _other_json(found):
    if isinstance(found, dict):
        if isinstance(found.get("cells", found.get("worksheets")), list):
            return f"it is a notebook without any cell; {AGAIN}"
        if "cells" in found:
            return f"it is a damaged notebook, whose cells are no list; {AGAIN}"
        links = [
            value for value in found.values() if isinstance(value, str) and re.match(r"https?://\S*google\.", value)
        ]
        if links or "doc_id" in found:
            return "it is a shortcut to Google Drive, and not the file; hand in the notebook itself (in Colab: File > Download)"
        if isinstance(found.get("message"), str) and found.keys() <= {
            "message",
            "reason",
            "status",
            "documentation_url",
            "traceback",
        }:
            return f"it is a server's message that something went wrong, and not the file; {AGAIN}"
    return f"it is JSON that holds something else than a notebook; {AGAIN}"


def _is_python(text):
    tree = tree_of(text)
    if tree is None:
        code = r"^(?:def \w+\(.*|class \w+.*:|import [\w.]+(?: as \w+)?|from [\w.]+ import .*|# ?%%.*|# In\[.*)$"
        return re.search(code, text, re.MULTILINE) is not None
    return any(isinstance(node, (ast.FunctionDef, ast.Import, ast.ImportFrom, ast.ClassDef)) for node in tree.body)
