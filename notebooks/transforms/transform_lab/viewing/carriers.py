"""Which of a notebook's figures carry the script that draws them all: those of the first two cells that show any.

They hand it to the notebook's window, where the other figures find it (page.html). Two, so that one is left where the other's
cell is deleted or cleared. A new kernel does not know what the notebook holds, and starts anew. So it is with predictions.
"""

from ..jupyter import shell

MOST = 2  # cells
_cells: dict[str, list[str]] = {}


def carries(kind="figure"):
    """Whether what is being shown has to carry the script of its kind. Outside of a notebook's cells, each one does."""
    cell, cells = _running(), _cells.setdefault(kind, [])
    if cell and cell not in cells and len(cells) < MOST:
        cells.append(cell)
    return cell in cells or len(cells) < MOST


def _running():
    """The running cell's id, or what it says, where it is run without one (nbconvert); None where it is no cell."""
    kernel = getattr(shell(), "kernel", None)
    asked = kernel.get_parent() if kernel else {}
    return (asked.get("metadata") or {}).get("cellId") or (asked.get("content") or {}).get("code")
