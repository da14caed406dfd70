"""Files that others may be reading while they are written."""

import os
from pathlib import Path


def replace(path: Path, content: str | bytes) -> None:
    """Write a file in one step: whoever reads it finds the old content or the new one, and never half of it."""
    fresh = path.with_name(f".{path.name}.new")
    try:
        fresh.write_bytes(content.encode() if isinstance(content, str) else content)
        os.replace(fresh, path)
    except OSError:
        fresh.unlink(missing_ok=True)
        raise
