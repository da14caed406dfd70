"""Files that others may be reading while they are written."""

import os


def replace(path, text):
    """Write a file in one step: whoever reads it finds the old text or the new one, and never half of it."""
    fresh = path.with_name(f".{path.name}.new")
    try:
        fresh.write_text(text, encoding="utf-8")
        os.replace(fresh, path)
    except OSError:
        fresh.unlink(missing_ok=True)
        raise
