"""`source/` to `notebooks/`: what students get, made by nbgrader, with the public key beside the package.

The page of all exercises, which instructors read, is made along with it.
"""

import json
import shutil
from pathlib import Path

import transform_lab

from ..bridge import gradebook, nbgrader_api, registration
from ..course import ASSIGNMENT, CourseError
from ..exercises import EXERCISES, PUBLIC_SEED, key
from ..files import replace
from ..grading import digests
from ..released import without_points
from . import exercises_page, source

REMEMBERED = Path(__file__).parent / "__pycache__" / "public.json"  # 700 wrong functions, called with each of 50 cases


def public_key(course):
    """The text of key.json: what each notebook in source/ asks for how many points, and the public cases of its exercises."""
    return _key(source.notebooks(course), _public())


def _public(files=None):
    """{exercise: its public cases as plain data}"""
    return {name: key(exercise, PUBLIC_SEED) for name, exercise in EXERCISES.items()}


def _key(wanted, public):
    points, notebooks = {}, {}
    for notebook in wanted.values():
        points |= notebook.points
        questions = [
            [without_points(notebook.section(name)).removeprefix("Question: "), most]
            for name, most in notebook.questions.items()
        ]
        notebooks[notebook.name] = {"exercises": list(notebook.points), "questions": questions}
    exercises = {name: {"points": points[name], **public[name]} for name in points}
    return f'{{"notebooks":{_json(notebooks)},\n"exercises":{{\n{_by_line(exercises)}\n}}}}\n'


def _by_line(exercises):
    """The exercises as JSON with a case a line, so that a change of one is seen as such."""
    texts = []
    for name, exercise in exercises.items():
        cases = ",\n".join(map(_json, exercise["cases"]))
        texts.append(f"{_json(name)}:{_json({**exercise, 'cases': []})[:-2]}\n{cases}\n]}}")
    return ",\n".join(texts)


def _json(plain):
    return json.dumps(plain, ensure_ascii=False, separators=(",", ":"))


def release(course):
    """Make notebooks/ from source/ and record the assignment in the gradebook; the lines that say what changed."""
    notebooks = source.notebooks(course)
    with gradebook.opened(course) as book:
        registration.refuse_to_lose(book, notebooks)
    public = digests.remembered(REMEMBERED, Path(transform_lab.__file__).parent, _public)
    before, text = course.release_contents(), _key(notebooks, public)
    key_file = course.package / "key.json"
    key_before = key_file.read_bytes() if key_file.exists() else None
    try:
        key_file.write_text(text, encoding="utf-8")
        nbgrader_api.call(course, "generate_assignment", ASSIGNMENT)
    except BaseException as error:  # Ctrl-C, too, must not cost the notebooks
        shutil.rmtree(course.release, ignore_errors=True)
        for path, content in before.items():
            (course.release / path).parent.mkdir(parents=True, exist_ok=True)
            (course.release / path).write_bytes(content)
        key_file.unlink(missing_ok=True)
        if key_before is not None:
            key_file.write_bytes(key_before)
        if isinstance(error, CourseError):
            raise CourseError(f"nbgrader could not make the release, and notebooks/ is as before: {error}") from None
        raise
    changes = _changes(before, course.release_contents())
    described = course.root / exercises_page.PAGE
    written = described.read_text(encoding="utf-8") if described.exists() else ""
    if written != (text := exercises_page.page(public)):
        replace(described, text)
        changes.append(f"changed: {exercises_page.PAGE}")
    return changes


def _changes(before, after):
    changes = [f"new: {path}" for path in after if path not in before]
    changes += [f"changed: {path}" for path in after if path in before and after[path] != before[path]]
    return changes + [f"removed: {path}" for path in before if path not in after]
