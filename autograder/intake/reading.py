"""The cells of a notebook file, whatever tool wrote it: lenient about all that is thrown away anyway.

Of a file only its cells are kept, and of a cell its type, its source, its attachments and nbgrader's entry. All the rest
(outputs, counts, ids, tags, what editors add) is not looked at, so nothing in it can cost a student the notebook.
"""

import json
import re
from dataclasses import dataclass, field

from ..untrusted import printable
from .looks_like import what_it_is

LARGEST = 100_000_000  # bytes of a file, outputs among them
LARGEST_TEXT = 20_000_000  # characters of what is kept; of a released notebook it is below 100 kB, pictures included
MOST_CELLS = 2_000
MOST_PARTS = 500_000  # objects and lists in a file, which take much more memory than their text
LONGEST_INTEGER = 400  # digits; a float has 309 at most
ENTRY = ("grade_id", "points", "grade", "solution", "locked", "task", "checksum", "cell_type", "schema_version")
BEGINNING = re.compile(r'\{\s*"(?:cells|metadata|nbformat|nbformat_minor|worksheets)"\s*:')  # as notebooks begin
TEXT = ("markdown", "raw", "heading", "html")  # pages show raw cells unfiltered, so they are Markdown to us


class Unreadable(Exception):
    """The file holds no notebook; the message says what it is instead, and what to do."""


@dataclass(eq=False)
class Cell:
    """A cell as the file has it.

    kind: "code" or "markdown"; entry: what the file says that nbgrader knows the cell as, {} when it says nothing
    """

    kind: str
    source: str
    attachments: dict[str, dict[str, str]] = field(default_factory=dict)
    entry: dict = field(default_factory=dict)
    unknown: str = ""  # the type that the file gives it, where notebooks have no cells of that type


def cells(content: bytes) -> list[Cell]:
    """The cells of a notebook file; raises Unreadable."""
    if len(content) > LARGEST:
        raise Unreadable(
            f"it has more than {LARGEST / 1e6:.0f} MB; clear its outputs (in Jupyter: Edit > Clear Outputs of All Cells), "
            "save it, and hand it in again"
        )
    if content.count(b"{") + content.count(b"[") > MOST_PARTS or content.count(b",") > 10 * MOST_PARTS:
        raise Unreadable(
            "it has more parts than a notebook has; clear its outputs (in Jupyter: Edit > Clear Outputs of All Cells), save "
            "it, and hand it in again"
        )
    raw = _cells(content)
    if len(raw) > MOST_CELLS:
        raise Unreadable(
            f"it has {len(raw)} cells, at most {MOST_CELLS} are accepted; take out those that are not yours"
        )
    found = [_cell(one) for one in raw if isinstance(one, (dict, str))]
    size = sum(len(cell.source) + sum(map(len, _data(cell.attachments))) for cell in found)
    if size > LARGEST_TEXT:
        raise Unreadable(
            f"what is in its cells, without outputs, has {size / 1e6:.0f} MB, at most {LARGEST_TEXT / 1e6:.0f} MB are "
            "accepted; hand it in with smaller pictures"
        )
    return found


def _cells(content):
    """The list of cells in a file of today's format or of an older one."""
    try:
        text = content.decode(json.detect_encoding(content))
    except UnicodeDecodeError:
        text = content.decode("cp1252", "replace")  # an editor that was told to save it so
    start = text.lstrip("\ufeff \t\r\n")
    if start[:1] != "{" and (found := BEGINNING.search(start)):  # below a line that some program has put in front
        start = start[found.start() :]
    try:
        raw = _json(start)
    except (ValueError, RecursionError) as error:
        raise Unreadable(what_it_is(content, text, error)) from None
    if isinstance(raw, dict) and raw.get("type") == "notebook" and isinstance(raw.get("content"), dict):
        raw = raw["content"]  # what Jupyter's server answers, saved in the file's place
    if isinstance(raw, dict):
        sheets = raw.get("worksheets")  # formats 2 and 3
        for holder in (raw, *(sheets if isinstance(sheets, list) else ())):
            found = holder.get("cells") if isinstance(holder, dict) else None
            if isinstance(found, list) and any(isinstance(cell, dict) for cell in found):
                return found
    raise Unreadable(what_it_is(content, text, raw))


def _json(text):
    """The first value in a text; what follows is left from an editor that was interrupted."""
    try:
        return json.JSONDecoder(strict=False).raw_decode(text)[0]
    except ValueError:  # perhaps of an integer with too many digits
        return json.JSONDecoder(parse_int=_integer, strict=False).raw_decode(text)[0]


def _integer(digits):
    return int(digits) if len(digits) <= LONGEST_INTEGER else float("inf")


def _cell(raw):
    if isinstance(raw, str):
        raw = {"cell_type": "markdown", "source": raw}
    metadata = raw.get("metadata")
    entry = metadata.get("nbgrader") if isinstance(metadata, dict) else None
    entry = {name: entry[name] for name in ENTRY if name in entry} if isinstance(entry, dict) else {}
    if not isinstance(entry.get("grade_id"), str):
        entry = {}
    kind, unknown = str(raw.get("cell_type") or "").strip().lower(), ""
    source = _text(raw.get("source", raw.get("input", raw.get("text"))))  # formats before 4 had an input
    if not kind:
        looks = "code" if raw.keys() & {"outputs", "execution_count", "input"} else "markdown"
        kind = str(entry.get("cell_type") or looks)
    elif kind == "heading":  # format 3
        level = raw.get("level")
        source = f"{'#' * (level if level in range(1, 7) else 1)} {source}"
    elif kind not in ("code", *TEXT):
        unknown = printable(kind)[:40]
    code = kind == "code"
    return Cell(
        "code" if code else "markdown", source, {} if code else _attachments(raw.get("attachments")), entry, unknown
    )


def _text(source, between="\n"):
    """A cell's source, which is text or a list of lines; some tools leave the ends of the lines out."""
    if isinstance(source, list):
        lines = [str(line) for line in source if isinstance(line, (str, int, float))]
        ends = "" if any(line.endswith(("\n", "\r")) for line in lines) else between
        source = ends.join(lines)
    elif not isinstance(source, (str, int, float)):
        source = ""
    return printable(str(source)).replace("\r\n", "\n").replace("\r", "\n").replace("\0", "").lstrip("\ufeff")


def _attachments(raw):
    """{name: {type: data}} of those pictures that are as they have to be."""
    found = {}
    for name, bundle in raw.items() if isinstance(raw, dict) else ():
        bundle = bundle.items() if isinstance(bundle, dict) else ()
        kept = {printable(kind): _text(data, "") for kind, data in bundle if isinstance(data, (str, list))}
        if any(kept.values()):
            found[printable(name)] = kept
    return found


def _data(attachments):
    return (data for bundle in attachments.values() for data in bundle.values())
