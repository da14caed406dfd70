"""What decides a grade, in one number."""

import hashlib
from pathlib import Path


def specification(course):
    """A digest of all that decides a grade: the released notebooks, the grader, the students' package."""
    total = hashlib.sha256()
    for released in course.notebooks.values():
        total.update(released.digest.encode())
    for folder in (Path(__file__).parent, course.package):
        for path in sorted(folder.rglob("*.py")):
            total.update(path.read_bytes())
    return total.hexdigest()
