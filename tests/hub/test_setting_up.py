"""What `hub` writes is what Jupyter and nbgrader read; what is not so is told, mended, or refused."""

import json
import os
import shutil
import stat

import pytest
from jupyter_server.extension.config import ExtensionConfigManager
from jupyterlab_server.config import ConfigManager, get_page_config
from nbgrader.apps.baseapp import NbGrader
from nbgrader.exchange.default import Exchange
from support import run

from autograder.command_line import _parser
from autograder.course import CourseError
from autograder.doctor import examine_hub
from autograder.environment import pins
from autograder.hub import setting_up
from autograder.hub.setting_up import EXCHANGE, FORMGRADER, OF_INSTRUCTORS, for_the_spawner, problems, steps


@pytest.fixture
def hub(draft, tmp_path):
    """A hub in which nothing has been set up; its environment has a bin/python and nothing else."""
    (tmp_path / "env/bin").mkdir(parents=True)
    (tmp_path / "env/bin/python").touch(mode=0o755)
    return setting_up.hub(draft, tmp_path / "env", tmp_path / "instructors", tmp_path / "srv/exchange")


def lab_settings():
    """What Lab takes for its own settings until somebody chooses others."""
    return ConfigManager(config_dir_name="labconfig").get("default_setting_overrides")


def set_up(hub):
    """What was done."""
    done = [step for step in steps(hub) if step.take]
    for step in done:
        step.take()
    return [step.what for step in done]


def contents(folder):
    """{path: (mode, bytes of a file)}"""
    return {path: (path.stat().st_mode, path.is_file() and path.read_bytes()) for path in sorted(folder.rglob("*"))}


@pytest.fixture
def as_read(hub, monkeypatch):
    """as_read(folders): what Jupyter and nbgrader take from the settings in them, as a server with these would."""

    def read(*folders):
        monkeypatch.setenv("JUPYTER_CONFIG_PATH", os.pathsep.join(map(str, folders)))
        monkeypatch.setenv("JUPYTER_NO_CONFIG", "")
        lab, app = get_page_config([]), NbGrader()
        app.load_cwd_config = False
        app.initialize([])
        enabled = ExtensionConfigManager(read_config_path=list(map(str, folders))).get_jpserver_extensions()
        return {
            "disabled": {name for name in lab["disabledExtensions"] if "nbgrader" in name},
            "locked": set(lab.get("lockedExtensions", ())),
            "formgrader": enabled.get(FORMGRADER),
            "exchange": Exchange(config=app.config, coursedir=app.coursedir).root,
            "course": app.coursedir.course_id,
            "root": app.coursedir.root,
            "markdown": lab_settings().get("@jupyterlab/docmanager-extension:plugin", {}).get("defaultViewers"),
            "fetches": app.config.ExchangeFactory.fetch_feedback.__name__,
        }

    return read


def test_what_students_and_instructors_get(hub, as_read):
    set_up(hub)
    everybody = hub.environment / "etc/jupyter"
    students, instructors = as_read(everybody), as_read(hub.instructors, everybody)
    shared = {"exchange": str(hub.exchange), "course": "transforms", "fetches": "FetchFeedback"}
    shared |= {"markdown": {"markdown": "Markdown Preview"}}
    assert students == shared | {
        "disabled": set(OF_INSTRUCTORS), "locked": set(OF_INSTRUCTORS), "formgrader": False, "root": os.getcwd(),
    }  # fmt: skip
    assert instructors == shared | {
        "disabled": set(), "locked": set(), "formgrader": True, "root": str(hub.course.root),
    }  # fmt: skip


def test_all_can_read_it_whatever_the_administrators_umask_is(hub):
    before = os.umask(0o077)
    try:
        set_up(hub)
    finally:
        os.umask(before)
    closed = [path for root in (hub.environment / "etc", hub.instructors, hub.exchange) for path in (root, *root.rglob("*"))
              if not path.stat().st_mode & stat.S_IROTH or path.is_dir() and not path.stat().st_mode & stat.S_IXOTH]  # fmt: skip
    assert not closed
    assert stat.S_IMODE(hub.exchange.stat().st_mode) == 0o1777


def test_the_second_time_nothing_is_done(hub, tmp_path):
    assert len(set_up(hub)) == len(steps(hub))
    before = contents(tmp_path)
    assert set_up(hub) == [] and contents(tmp_path) == before


BREAKING = {
    "remove": lambda path: shutil.rmtree(path) if path.is_dir() else path.unlink(),
    "close": lambda path: path.chmod(0o700),
    "change": lambda path: path.chmod(0o777) if path.is_dir() else path.write_text(_changed(path.read_text())),
}


def _changed(text):
    for before, after in (("true", "0"), ("false", "1"), ("Preview", "Editor"), ("root = ", "root = '/elsewhere' or ")):
        text = text.replace(before, after)
    return text


@pytest.mark.parametrize("number", range(9))
@pytest.mark.parametrize("how", BREAKING)
def test_what_somebody_has_changed_is_told_and_mended(hub, number, how):
    set_up(hub)
    folders = hub.exchange, hub.exchange / "transforms"
    files = [path for root in (hub.environment / "etc", hub.instructors) for path in sorted(root.rglob("*.*"))]
    path = [*files, *folders][number]
    before = contents(path.parent)
    BREAKING[how](path)

    def told():
        return [line for good, line in examine_hub(hub) if not good and line.startswith(f"{path}: ")]

    (line,) = told()
    assert f"`python3 -m autograder hub {hub.command}` sees to that." in line
    set_up(hub)
    assert not told() and contents(path.parent).keys() == before.keys() and path.stat().st_mode == before[path][0]


def test_a_course_that_somebody_else_has_in_the_exchange_is_told(hub):
    if os.getuid() != 0:
        pytest.skip("needs root, to give a folder away")
    set_up(hub)
    os.chown(hub.exchange / "transforms", 65534, -1)
    assert "nbgrader lets only its owner release: while nobody has handed in, `chown -R 0:0 " in "\n".join(
        problems(hub)
    )


def test_other_settings_stay(hub):
    path = hub.environment / "etc/jupyter/jupyter_server_config.json"
    path.parent.mkdir(parents=True)
    path.write_text('{"ServerApp": {"port": 1, "jpserver_extensions": {"other": true}}, "Other": [1]}')
    set_up(hub)
    assert json.loads(path.read_text()) == {
        "ServerApp": {"port": 1, "jpserver_extensions": {"other": True, FORMGRADER: False}},
        "Other": [1],
    }


def test_our_lines_may_stand_among_somebody_elses(hub):
    path = hub.environment / "etc/jupyter/nbgrader_config.py"
    path.parent.mkdir(parents=True)
    path.write_text("c = get_config()\n")
    with pytest.raises(CourseError, match="not ours to overwrite") as refused:
        steps(hub)
    path.write_text("# mine\n" + str(refused.value).partition("\n\n")[2])
    set_up(hub)
    assert path.read_text().startswith("# mine") and set_up(hub) == []


REFUSED = {
    "etc/jupyter/jupyter_server_config.json": ("{", "cannot be read as JSON"),
    "etc/jupyter/labconfig/page_config.json": ('{"disabledExtensions": ["a"]}', "has a list or a text where Jupyter"),
    "etc/jupyter/nbgrader_config.py": ("c = get_config()\nc.Exchange.root = '/a'\n", "is not ours to overwrite"),
    "bin/python": (None, "there is no bin/python in it"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_done_is_refused_before_anything_is_written(hub, name):
    text, why = REFUSED[name]
    path = hub.environment / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.unlink(missing_ok=True) if text is None else path.write_text(text)
    before = contents(hub.environment)
    code, said = run(hub.course, "hub", *hub.command.split())
    assert code == 2 and why in said and str(hub.environment) in said
    assert contents(hub.environment) == before and not hub.instructors.exists() and not hub.exchange.exists()


def test_a_folder_for_instructors_that_students_read_is_refused(hub):
    for folder in (hub.environment, hub.environment / "etc/jupyter/labconfig"):
        with pytest.raises(CourseError, match="counts for students, too"):
            setting_up.hub(hub.course, hub.environment, folder, hub.exchange)


def test_what_is_left_to_the_administrator(hub, tmp_path):
    tmp_path.chmod(0o700)
    set_up(hub)
    told = "\n".join(problems(hub))
    assert " more, in the versions of environment.txt: `" in told
    assert "has no jupyterhub-singleuser" in told and f"`chmod o+x {tmp_path}`" in told
    packages = hub.environment / "lib/python3.11/site-packages"
    for name, version in pins((hub.course.root / "environment.txt").read_text()):
        (packages / f"{name.replace('-', '_')}-{version}.dist-info").mkdir(parents=True)
    (hub.environment / "bin/jupyterhub-singleuser").touch()
    told = "\n".join(problems(hub))
    assert "environment.txt" not in told and "singleuser" not in told


def test_the_spawner_is_told_who_is_an_instructor(hub):
    class Spawner:
        environment: dict = {}

    c = type("c", (), {"Spawner": Spawner})
    exec(for_the_spawner(hub).replace("…", "ann"), {"c": c})
    ann, ben = (type("spawner", (), {"user": type("user", (), {"name": name})}) for name in ("ann", "ben"))
    path = Spawner.environment["JUPYTER_CONFIG_PATH"]
    assert path(ann) == str(hub.instructors) and path(ben) == ""
    assert Spawner.environment["PATH"].startswith(f"{hub.environment}/bin:")


def test_doctor_has_to_be_told_where(draft):
    code, said = run(draft, "doctor", "--hub")
    assert code == 2 and "--environment" in said
    assert _parser().parse_args(["doctor"]).exchange == EXCHANGE
