"""Zips for where students already are: the notebooks for an LMS, the autograder for Gradescope.

The same files give the same bytes on any machine and any day: names in order, one date, one set of permissions, and
nothing compressed (compression libraries differ in what they write).
"""

import re
import zipfile
from pathlib import Path

from ..course import ASSIGNMENT, CourseError

LICENSE = "LICENSE"  # asks to be kept with every copy
GRADESCOPE = Path(__file__).parent / "gradescope_files"  # what has to be at the root of its zip
# What grades one student's files, beside the solutions in source/ and what was released.
GRADER = (
    "autograder",
    f"source/{ASSIGNMENT}",
    f"notebooks/{ASSIGNMENT}",
    "environment.txt",
    "environment.lock",
    "nbgrader_config.py",
    LICENSE,
)
ABOUT_ENVIRONMENT = f"""\
# What the notebooks need. To install it: pip install -r environment.txt
# To open them then: jupyter lab (in this folder, {ASSIGNMENT})

"""


def for_students(course):
    """What students get, {path in the zip: bytes}: the released notebooks, and the packages that these need."""
    contents = course.release_contents()
    if not contents:
        raise CourseError("There is nothing to package: run `python3 -m autograder release` first.")
    text = (course.root / "environment.txt").read_text(encoding="utf-8")
    contents[LICENSE] = (course.root / LICENSE).read_bytes()
    contents["environment.txt"] = (ABOUT_ENVIRONMENT + students_section(text)).encode()
    return {f"{ASSIGNMENT}/{path}": content for path, content in contents.items() if _is_work(path)}


def for_gradescope(course):
    """The autograder as Gradescope takes it, {path in the zip: bytes}; it holds the solutions."""
    for_students(course)  # raises CourseError when nothing was released
    contents = {path.name: path.read_bytes() for path in GRADESCOPE.iterdir() if _wanted(path, GRADESCOPE)}
    for part in (course.root / name for name in GRADER):
        for path in [part] if part.is_file() else part.rglob("*"):
            if _wanted(path, course.root):
                contents[path.relative_to(course.root).as_posix()] = path.read_bytes()
    return contents


def students_section(text):
    """The part of environment.txt's text that is headed "# students", up to the next heading after an empty line."""
    found = re.search(r"^# students\b.*?(?=\n\n|\Z)", text, re.MULTILINE | re.DOTALL)
    if not found:
        raise CourseError('environment.txt has no section "# students" any more; the zip is made from it.')
    return found[0].strip() + "\n"


def write(path, contents):
    """Write {path in the zip: bytes} to `path`, in one step."""
    fresh = path.with_name(f".{path.name}.new")
    try:
        with zipfile.ZipFile(fresh, "w") as archive:
            for name, content in sorted(contents.items()):
                entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
                entry.create_system = 3  # Unix, wherever it is made: the permissions are Unix's
                entry.external_attr = (0o100755 if content.startswith(b"#!") else 0o100644) << 16
                archive.writestr(entry, content)
        fresh.replace(path)
    finally:
        fresh.unlink(missing_ok=True)


def _wanted(path, root):
    """Whether `path` is a file, and nothing that Python, Jupyter or an editor has made along the way."""
    return path.is_file() and _is_work(path.relative_to(root))


def _is_work(path):
    return not any(part.startswith(".") or part == "__pycache__" for part in Path(path).parts)
