"""Which released notebook a file is: by its cells, and by the names that browsers, Jupyter, LMSs and people give copies.

`1_rotation (1).ipynb`, `1_rotation-Copy1.ipynb`, `Copy of 1_rotation.ipynb`, `1_rotation_jdoe.ipynb`, `1_Rotation.ipynb`,
`1_rotation-1.ipynb`, `1_rotation.ipynb.txt` are all called after 1_rotation.
"""

import re
import unicodedata
from collections.abc import Iterable, Mapping

from ..released import Released
from .python_text import checks, defines
from .reading import Cell, Unreadable, cells

# What a notebook's file ends in, also where a browser or a mail program has put its own ending behind.
ENDING = re.compile(
    r"(?:\.ipynb)+((?: ?\(\d+\))?)(?:\.(?:txt|json|ipynb|html?\.ipynb))?$|\.ipynb\.json$", re.IGNORECASE
)
UUID = re.compile(r"[0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12}")  # before words are taken apart: it is no number


def is_notebook(filename: str) -> bool:
    """Whether a file is called as notebooks are."""
    return ENDING.search(filename) is not None


def by_name(filename: str, notebooks: Iterable[str]) -> tuple[str, tuple[int, ...]] | None:
    """(the released notebook that a file is called after, the numbers that its copy has); None without exactly one.

    The numbers are in the order of the name, () when it has none: those of `1_rotation (2).ipynb` are (2,). What they mean
    differs from system to system.
    """
    stem = unicodedata.normalize("NFKC", filename).rpartition("/")[2]
    stem = ENDING.sub(r"\1", stem)
    if stem in notebooks:
        return stem, ()
    words = _words(UUID.sub(" ", stem.lower()))
    found = {name: place for name in notebooks if (place := _place(_words(name.lower()), words)) is not None}
    longest = max((len(_words(name)) for name in found), default=0)
    meant = [name for name in found if len(_words(name)) == longest]
    if len(meant) != 1:
        return None
    behind = words[found[meant[0]] + longest :]
    return meant[0], tuple(int(word.removeprefix("copy")) for word in behind if re.fullmatch(r"(copy)?\d{1,4}", word))


def _words(name):
    """Letters and digits in the order of a name; separators differ from system to system, and so does what joins them."""
    return re.findall(r"[^\W_]+", name)


def _place(wanted, words):
    """Where `wanted` stands among `words`, or None."""
    size = len(wanted)
    return next((start for start in range(len(words) - size + 1) if words[start : start + size] == wanted), None)


def by_cells(content: bytes, notebooks: Mapping[str, Released]) -> str | None:
    """The released notebook whose cells a file has, the most by far; None when it is no notebook, or nothing tells.

    notebooks: {name: Released}
    """
    try:
        return meant(cells(content), notebooks)
    except Unreadable:
        return None


def meant(found: Iterable[Cell], notebooks: Mapping[str, Released]) -> str | None:
    """As `by_cells`, of cells that are read already."""
    entries = {cell.entry.get("grade_id") for cell in found}
    counts = {name: len(entries & set(released.cells)) for name, released in notebooks.items()}
    if not any(counts.values()):  # without nbgrader's entries: by what is checked
        names = {name for cell in found for name in checks(cell.source)[0]}
        counts = {name: len(names & set(released.points)) for name, released in notebooks.items()}
    if not any(counts.values()):  # by what is defined, when that is half of a notebook at least
        names = {name for cell in found for name in defines(cell.source)}
        counts = {name: len(names & set(released.points)) for name, released in notebooks.items()}
        counts = {name: count for name, count in counts.items() if 2 * count >= len(notebooks[name].points)}
    most = sorted(counts.values(), reverse=True)
    if not most or not most[0] or most[1:2] == most[:1]:
        return None
    return max(counts, key=lambda name: counts[name])


def has_work(found: Iterable[Cell], released: Released) -> bool:
    """Whether any answer was given: a solution's or an answer's cell changed, or a function of an exercise defined."""
    given = {cell.source.strip() for cell in released.notebook.cells}
    answers = {name for name, cell in released.cells.items() if cell.metadata.nbgrader.solution}
    return any(
        cell.entry.get("grade_id") in answers or not released.points.keys().isdisjoint(defines(cell.source))
        for cell in found
        if cell.source.strip() and cell.source.strip() not in given
    )
