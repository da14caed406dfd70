"""Which figures of a notebook carry the script that draws them all: those of the first two cells that show any.

They hand it to the notebook's window, where the other figures find it (page.html). Two, so that one is left where the other's
cell is deleted or cleared. A new kernel does not know what the notebook holds, and starts anew.
"""

from ..jupyter import shell

MOST = 2  # cells
_cells: list[str] = []


def carries():
    """Whether the figure that is being made has to carry the script. Outside of a notebook's cells, each one does."""
    cell = _running()
    if cell and cell not in _cells and len(_cells) < MOST:
        _cells.append(cell)
    return cell in _cells or len(_cells) < MOST


def _running():
    """The running cell's id, or what it says, where it is run without one (nbconvert); None where it is no cell."""
    kernel = getattr(shell(), "kernel", None)
    asked = kernel.get_parent() if kernel else {}
    return (asked.get("metadata") or {}).get("cellId") or (asked.get("content") or {}).get("code")
