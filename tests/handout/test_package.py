"""The zips: the same bytes each time, of use to a student after unzipping, and an autograder that Gradescope can run.

Gradescope is played by `Gradescope`: the zip unpacked into source/, run_autograder copied beside it, a submission, and
what it says of the results: https://gradescope-autograders.readthedocs.io/en/latest/specs/
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import textwrap
import zipfile
from pathlib import Path

import jsonschema
import nbformat
import pytest
from support import ASKED, NAMES, ROOT, points, points_by_hand, run

from autograder import environment
from autograder.course import Course, CourseError
from autograder.handout import package

VISIBILITY = {"enum": ["hidden", "after_due_date", "after_published", "visible"]}
FORMAT = {"enum": ["text", "html", "simple_format", "md", "ansi"]}
RESULTS = {
    "type": "object",
    "anyOf": [{"required": ["score"]}, {"required": ["tests"]}],
    "additionalProperties": False,
    "properties": {
        "score": {"type": "number"},
        "output": {"type": "string"},
        "output_format": FORMAT,
        "visibility": VISIBILITY,
        "stdout_visibility": VISIBILITY,
        "tests": {
            "type": "array",
            "items": {
                "type": "object",
                "required": ["score", "max_score", "name", "output"],
                "additionalProperties": False,
                "properties": {
                    "score": {"type": "number", "minimum": 0},
                    "max_score": {"type": "number"},
                    "status": {"enum": ["passed", "failed"]},
                    "name": {"type": "string"},
                    "output": {"type": "string"},
                    "output_format": FORMAT,
                    "visibility": VISIBILITY,
                },
            },
        },
    },
}
COMMANDS = ("bash", "cat", "chmod", "mkdir")  # what run_autograder calls


# --- the zips -------------------------------------------------------------------------------------------------------


def test_the_same_bytes_on_any_machine_and_any_day(course, tmp_path):
    assert run(course, "package", "--output", str(tmp_path / "one"))[0] == 0
    for path in sorted(filter(Path.is_file, course.root.rglob("*")), reverse=True):  # in another order on the disk
        target = tmp_path / "copied" / path.relative_to(course.root)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(path.read_bytes())
        target.chmod(0o600)
        os.utime(target, (1, 1))
    copied = Course(tmp_path / "copied")
    (copied.release / "transform_lab" / "__pycache__").mkdir(exist_ok=True)
    (copied.release / "transform_lab" / "__pycache__" / "check.pyc").write_bytes(b"made at run time")
    (copied.source / ".ipynb_checkpoints").mkdir(exist_ok=True)
    (copied.source / ".ipynb_checkpoints" / "1_rotation-checkpoint.ipynb").write_text("{}")
    code, said = run(copied, "package", "--output", str(tmp_path / "two"))
    assert code == 0 and "It holds the solutions: keep it to yourself." in said
    for name in ("transforms.zip", "transforms-gradescope.zip"):
        assert (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes()
        with zipfile.ZipFile(tmp_path / "one" / name) as archive:
            entries = archive.infolist()
            (license,) = (entry for entry in archive.namelist() if entry.endswith("LICENSE"))
            assert archive.read(license) == (ROOT / "LICENSE").read_bytes()
        assert [entry.filename for entry in entries] == sorted(entry.filename for entry in entries)
        assert {entry.date_time for entry in entries} == {(1980, 1, 1, 0, 0, 0)}
        assert {entry.create_system for entry in entries} == {3}
        assert {entry.compress_type for entry in entries} == {zipfile.ZIP_STORED}  # zlib's bytes differ by version
        assert {entry.external_attr >> 16 for entry in entries} == {0o100644, 0o100755}


def test_a_name_ending_in_zip_is_that_of_the_notebooks_alone(course, tmp_path):
    code, said = run(course, "package", "--output", str(tmp_path / "new" / "lab.zip"))
    assert code == 0 and "lab.zip: the notebooks" in said
    assert os.listdir(tmp_path / "new") == ["lab.zip"]
    code, said = run(course, "package")
    assert code == 0 and {"transforms.zip", "transforms-gradescope.zip"} <= set(os.listdir(course.root))


def test_nothing_is_packaged_before_a_release(course, tmp_path):
    shutil.rmtree(course.release)
    code, said = run(course, "package", "--output", str(tmp_path / "new"))
    assert code == 2 and "run `python3 -m autograder release` first" in said
    assert not list((tmp_path / "new").glob("*"))


def test_a_student_needs_nothing_but_the_zip(course, tmp_path):
    package.write(tmp_path / "lab.zip", package.for_students(course))
    shutil.unpack_archive(tmp_path / "lab.zip", tmp_path)
    folder = tmp_path / "transforms"
    assert sorted(path.name for path in tmp_path.iterdir() if path.name not in ("course", "lab.zip")) == ["transforms"]
    assert not environment.lacking(folder / "environment.txt")  # and it can be read as one
    wanted = {line.split("==")[0] for line in (folder / "environment.txt").read_text().splitlines() if "==" in line}
    assert {"jupyterlab", "numpy", "scipy", "anywidget"} <= wanted
    assert not {"nbgrader", "pytest", "playwright"} & wanted
    code = "from transform_lab import check; check('chain', lambda *transforms: transforms[0])"
    result = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True)
    assert "chain: not right yet" in result.stdout + result.stderr
    assert all(len(nbformat.read(folder / f"{name}.ipynb", as_version=4).cells) > 5 for name in course.notebooks)


def test_an_environment_without_a_section_for_students_is_said():
    section = "# students: x\nnumpy==1  # matrices\n"
    assert package.students_section(f"# About\n\n{section}\n# instructors\nnbgrader==1\n") == section
    with pytest.raises(CourseError, match="environment.txt has no section"):
        package.students_section("# instructors\nnbgrader==1\n")


def test_what_gradescope_asks_of_its_zip(course, tmp_path):
    contents = package.for_gradescope(course)
    for name in ("setup.sh", "run_autograder"):
        assert contents[name].startswith(b"#!/usr/bin/env bash\n")
        (tmp_path / name).write_bytes(contents[name])
        checked = subprocess.run(["bash", "-n", tmp_path / name], capture_output=True, text=True)
        assert checked.returncode == 0, checked.stderr
    setup = contents["setup.sh"].decode()
    assert (
        "--require-hashes -r environment.lock" in setup and {"environment.txt", "environment.lock"} <= contents.keys()
    )
    assert "from autograder.environment import OLDEST" in setup and isinstance(environment.OLDEST, tuple)
    assert "python3 -m venv /opt/transforms" in setup and b"/opt/transforms/bin/python" in contents["run_autograder"]
    assert (
        "source/transforms/1_rotation.ipynb" in contents and "notebooks/transforms/transform_lab/key.json" in contents
    )
    assert not any(
        name.startswith(("tests/", "submitted/", "reports/")) or "gradebook" in name.split("/")[0] for name in contents
    )


# --- a submission on Gradescope -------------------------------------------------------------------------------------


class Gradescope:
    """/autograder of one container, in another place.

    python: what setup.sh would have installed; path: the commands of the container; enter: the command that enters it
    """

    def __init__(self, course, folder, python, path, enter=()):
        self.folder, self.python, self.path, self.enter = folder, python, path, enter
        package.write(folder / "autograder.zip", package.for_gradescope(course))
        subprocess.run(["unzip", "-q", folder / "autograder.zip", "-d", folder / "source"], check=True)
        (folder / "autograder.zip").unlink()
        shutil.copy(folder / "source" / "run_autograder", folder)

    def grade(self, files, python=None, user=None):
        """What the student is told, checked against the documented format; what the instructor reads is in `said`."""
        shutil.rmtree(self.folder / "submission", ignore_errors=True)
        shutil.rmtree(self.folder / "results", ignore_errors=True)
        (self.folder / "submission").mkdir()
        (self.folder / "results").mkdir()
        for name, content in files.items():
            path = self.folder / "submission" / name
            path.parent.mkdir(exist_ok=True, parents=True)
            if isinstance(content, Path):
                path.symlink_to(content)
            else:
                path.write_bytes(content)
        settings = {
            "AUTOGRADER_FOLDER": str(self.folder),
            "AUTOGRADER_PYTHON": python or self.python,
            "PATH": self.path,
        }
        options = {"cwd": self.folder, "env": settings, "capture_output": True, "text": True}
        if user is not None:
            options |= {"user": user, "group": user, "extra_groups": []}
            for path in (self.folder, self.folder / "results"):
                os.chown(path, user, user)
        ran = subprocess.run([*self.enter, self.folder / "run_autograder"], **options)
        assert ran.returncode == 0
        self.said = ran.stdout + ran.stderr
        results = json.loads((self.folder / "results" / "results.json").read_text())
        jsonschema.validate(results, RESULTS)
        return results


@pytest.fixture(scope="module")
def solutions(released):
    return {path.name: path.read_bytes() for path in released.source.glob("*.ipynb")}


WAYS = ("bubblewrap", "user", "container")


@pytest.fixture(scope="module", params=[pytest.param(way, marks=pytest.mark.sandbox) for way in WAYS])
def gradescope(request, released, tmp_path_factory):
    """Once where bubblewrap works; twice where the grader is root and there is none, or a container lets it do nothing."""
    folder, path = tmp_path_factory.mktemp("autograder"), os.environ["PATH"]
    if request.param == "bubblewrap":
        request.getfixturevalue("sandboxed")
        return Gradescope(released, folder, sys.executable, path)
    python = request.getfixturevalue("open_python")
    if request.param == "user":
        return Gradescope(released, folder, python, without_bubblewrap(folder))
    enter = [*request.getfixturevalue("container"), "/", "env", "--chdir", folder]
    return Gradescope(released, folder, python, path, enter)


def without_bubblewrap(folder):
    """A PATH in `folder` with no more than run_autograder needs."""
    folder = Path(folder, "bin")
    folder.mkdir()
    for name in COMMANDS:
        (folder / name).symlink_to(shutil.which(name))
    return str(folder)


def scores(results):
    return {test["name"].split(": ")[1]: test["score"] for test in results["tests"]}


def outputs(results):
    return {test["name"].split(": ")[1]: test["output"] for test in results["tests"]}


def wrong(notebook, grade_id, code):
    """The notebook's bytes with another answer to an exercise: a cell before its test."""
    notebook = nbformat.reads(notebook, as_version=4)
    position = next(
        index
        for index, cell in enumerate(notebook.cells)
        if cell.metadata.get("nbgrader", {}).get("grade_id") == grade_id and cell.metadata.nbgrader.grade
    )
    notebook.cells.insert(position, nbformat.v4.new_code_cell(code))
    return nbformat.writes(notebook).encode()


def test_a_solved_submission_earns_everything(gradescope, solutions):
    results = gradescope.grade(solutions)
    assert results["score"] == points() and {test["status"] for test in results["tests"]} == {"passed"}
    assert list(scores(results)) == NAMES
    assert results["output"] == (
        f"The {sum(len(notebook.questions) for notebook in ASKED.values())} written questions ({points_by_hand():g} points) "
        "are graded by hand and not counted here."
    )
    assert results["stdout_visibility"] == "hidden"
    assert (gradescope.folder.stat().st_mode & 0o777) == 0o700


def test_a_mixed_submission(gradescope, solutions, released):
    backwards = """
        def chain(*transforms):
            result = transforms[-1]
            for transform in transforms[-2::-1]:
                result = result @ transform
            return result
        """
    files = {
        "1_rotation.ipynb": (released.release / "1_rotation.ipynb").read_bytes(),
        "2_homogeneous_transforms.ipynb": b"{ garbage \xff",
        "3_chaining.ipynb": wrong(solutions["3_chaining.ipynb"], "chain", textwrap.dedent(backwards)),
        "4_inversion.ipynb": gradescope.folder / "source/source/transforms/4_inversion.ipynb",
        "helper.py": gradescope.folder / "source/source/transforms/transform_lab/key.json",
        "5_pre_grasp copy.ipynb": solutions["5_pre_grasp.ipynb"],
    }
    results = gradescope.grade(files)
    said = outputs(results)
    assert said["rotation_about_z"] == "rotation_about_z: not done yet."
    assert "The file could not be read." in said["make_transform"]
    assert "order" in said["chain"] and "Kind of case" in said["chain"] and "expected" not in said["chain"]
    assert "The file could not be read." in said["invert_transform"]  # a link to the solution is not followed
    assert scores(results)["transform_pose"] == 2
    assert results["score"] == sum(scores(results).values()) == 2 + points("5_pre_grasp")
    for line in (
        "4_inversion.ipynb: left out; it is a link.",
        "helper.py: left out; it is a link.",
        "5_pre_grasp copy.ipynb: it was taken for 5_pre_grasp.ipynb; that is what it should be called.",
        "2_homogeneous_transforms.ipynb: it cannot be read: it is damaged in line 1",
    ):
        assert line in results["output"]
    assert str(gradescope.folder) not in json.dumps(results)


def test_nothing_that_can_be_graded(gradescope, solutions):
    for files in ({}, {"answers.txt": b"42"}, {".git/1_rotation.ipynb": b"{}"}):
        results = gradescope.grade(files)
        assert results["score"] == 0 and len(results["tests"]) == len(NAMES)
        assert results["output"].count("not handed in; 0 points.") == len(ASKED)
        assert "There is no 3_chaining.ipynb to grade." in outputs(results)["chain"]


def test_notebooks_in_a_folder_are_found(gradescope, solutions):
    files = {"__MACOSX/1_rotation.ipynb": b"{}", "my work/1_rotation.ipynb": solutions["1_rotation.ipynb"]}
    assert gradescope.grade(files)["score"] == points("1_rotation")


def test_hostile_work_earns_what_its_honest_part_earns(gradescope, solutions):
    attack = f"""
        import glob, os
        for path in glob.glob({str(gradescope.folder)!r} + '/**', recursive=True):
            raise SystemError('seen')
        try:
            open({str(gradescope.folder / "results/results.json")!r}, 'w').write('{{"score": 40}}')
        except OSError as error:
            print(error)
        os.kill(os.getppid(), 9)
        """
    attacked = wrong(solutions["1_rotation.ipynb"], "is_rotation", textwrap.dedent(attack))
    results = gradescope.grade({"1_rotation.ipynb": attacked})
    assert results["score"] == points("1_rotation") and len(results["tests"]) == len(NAMES)


def test_whatever_goes_wrong_there_is_a_result(released, solutions, sandboxed, tmp_path_factory):
    container = Gradescope(released, tmp_path_factory.mktemp("autograder"), sys.executable, os.environ["PATH"])
    results = container.grade(solutions, python="/nowhere/python")
    assert results["score"] == 0 and "the autograder itself stopped" in results["output"]
    assert "/nowhere/python" in container.said
    (container.folder / "source" / "notebooks" / "transforms" / "1_rotation.ipynb").write_text("{")
    results = container.grade(solutions)
    assert results["score"] == 0 and "that is not because of your files" in results["output"]
    assert "Traceback" in container.said and "Traceback" not in results["output"]


def test_without_protection_nothing_is_graded(released, solutions, open_python):
    """No bubblewrap, and a grader that is not root."""
    with tempfile.TemporaryDirectory(prefix="autograder-") as folder:
        container = Gradescope(released, Path(folder), open_python, without_bubblewrap(folder))
        results = container.grade(solutions, user=65534)
    assert results["score"] == 0 and "that is not because of your files" in results["output"]
    assert "bubblewrap (the command bwrap) is not installed" in container.said
    assert "only root may start processes as another user" in container.said
