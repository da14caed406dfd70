"""`source/` to `notebooks/`: what students get, made by nbgrader, with the public key beside the package."""

import json
import logging
import shutil
import tempfile
from pathlib import Path

import nbformat
from nbgrader.apps import NbGraderAPI
from nbgrader.coursedir import CourseDirectory

from .course import ASSIGNMENT, CourseError
from .exercises import EXERCISES, PUBLIC_SEED, key
from .gradebook import settings


def public_key(course):
    """The text of key.json: the public cases of every exercise, with its points as the source notebooks have them."""
    points = {}
    for path in sorted(course.source.glob("*.ipynb")):
        for cell in nbformat.read(path, as_version=4).cells:
            nbgrader = cell.metadata.get("nbgrader", {})
            if nbgrader.get("grade") and nbgrader.get("grade_id") in EXERCISES:
                points[nbgrader["grade_id"]] = nbgrader["points"]
    absent = [name for name in EXERCISES if name not in points]
    if absent:
        raise CourseError(f"The notebooks in source/{ASSIGNMENT} have no test cell for: {', '.join(absent)}.")
    exercises = {name: {"points": points[name], **key(EXERCISES[name], PUBLIC_SEED)} for name in points}
    return json.dumps({"exercises": exercises}, ensure_ascii=False, separators=(",", ":")) + "\n"


def release(course):
    """Make notebooks/ from source/ and record the assignment in the gradebook; the lines that say what changed."""
    before, text = _contents(course.release), public_key(course)
    key_file = course.package / "key.json"
    key_before = key_file.read_bytes() if key_file.exists() else None
    config = settings(course)
    with tempfile.TemporaryDirectory(prefix="release-") as kept:
        if before:
            shutil.copytree(course.release, Path(kept, ASSIGNMENT))
        try:
            key_file.write_text(text, encoding="utf-8")
            logging.getLogger("traitlets").setLevel(logging.CRITICAL)
            result = NbGraderAPI(CourseDirectory(config=config), config=config).generate_assignment(
                ASSIGNMENT, force=True
            )
            if not result["success"]:
                reason = (result.get("error") or result.get("log") or "no reason given").strip().splitlines()[-1]
                raise CourseError(f"nbgrader could not make the release, and notebooks/ is as before: {reason}")
        except BaseException:  # Ctrl-C, too, must not cost the notebooks
            shutil.rmtree(course.release, ignore_errors=True)
            if before:
                shutil.copytree(Path(kept, ASSIGNMENT), course.release)
            key_file.unlink(missing_ok=True)
            if key_before is not None:
                key_file.write_bytes(key_before)
            raise
    return _changes(before, _contents(course.release))


def _contents(folder):
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    }


def _changes(before, after):
    changes = [f"new: {path}" for path in after if path not in before]
    changes += [f"changed: {path}" for path in after if path in before and after[path] != before[path]]
    return changes + [f"removed: {path}" for path in before if path not in after]
