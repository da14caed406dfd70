"""The files of a JupyterHub on which the course runs, and who may do what with them.

`hub` writes what is not there yet, `doctor --hub` says what is not as it should be; both go by `steps`.
"""

import json
import os
import shlex
import stat
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from ..bridge.nbgrader_api import exchange
from ..course import Course, CourseError
from ..environment import LAB_SETTINGS, READ_MARKDOWN, installed, lacking
from ..files import replace

EXCHANGE = Path("/srv/nbgrader/exchange")
FORMGRADER = "nbgrader.server_extensions.formgrader"
OF_INSTRUCTORS = [f"@jupyter/nbgrader:{part}" for part in ("formgrader", "create-assignment", "course-list")]  # in Lab
INSIDE_LAB = {"headers": {"Content-Security-Policy": "frame-ancestors 'self'"}}
NO_LOGIN_SHELL = {"shell_command": ["bash"]}  # which would have the system's PATH, and not that of the environment
TEMPLATE = Path(__file__).with_name("everybody.py")
OURS = TEMPLATE.read_text(encoding="utf-8").partition("\n")[0]


@dataclass(frozen=True)
class Hub:
    """A course, the environment in which all users' servers run, and the folders for instructors' settings and the exchange."""

    course: Course
    environment: Path
    instructors: Path
    exchange: Path

    @cached_property
    def course_id(self) -> str:
        return exchange(self.course)[1]

    @property
    def command(self) -> str:
        """The options that say the same once more."""
        words = ["--environment", self.environment, "--instructor-config", self.instructors]
        return shlex.join(map(str, words + (["--exchange", self.exchange] if self.exchange != EXCHANGE else [])))


@dataclass(frozen=True)
class Step:
    """Something that has to be so; `take` sees to it, and is None where it is so already."""

    what: str
    take: Callable[[], None] | None


def hub(course: Course, environment: Path, instructors: Path, exchange: Path) -> Hub:
    """The Hub of these folders; raises CourseError for those that cannot be meant."""
    found = Hub(course, environment.absolute(), instructors.absolute(), exchange.absolute())
    if not (found.environment / "bin/python").exists():
        raise CourseError(
            f"{environment}: there is no bin/python in it. Give the folder of the environment in which students' servers run, "
            "such as /opt/tljh/user; what runs the hub itself may be another one."
        )
    if not found.course_id:
        raise CourseError("The course has no name: set c.CourseDirectory.course_id in nbgrader_config.py.")
    if found.instructors == found.environment or found.instructors.is_relative_to(found.environment / "etc/jupyter"):
        raise CourseError(f"{instructors}: what lies in {environment} counts for students, too; give another folder.")
    return found


def steps(hub: Hub) -> list[Step]:
    """All that has to be so, in the order in which it can be seen to; raises CourseError where only a person can."""
    return [*_files(hub), *_folders(hub)]


def _files(hub):
    """The settings of everybody, which are students', and those that instructors have besides."""
    everybody, disabled = hub.environment / "etc/jupyter", dict.fromkeys(OF_INSTRUCTORS, True)
    enabled = dict.fromkeys(OF_INSTRUCTORS, False)
    text = TEMPLATE.read_text(encoding="utf-8")
    for name, value in (("EXCHANGE", hub.exchange), ("COURSE", hub.course_id)):
        text = text.replace(f'"{name}"', json.dumps(str(value)))
    yield _python(
        everybody / "nbgrader_config.py", text, "for everybody: where the exchange is, and the course's name in it"
    )
    yield _json(
        everybody / "jupyter_server_config.json", "students' servers have no formgrader",
        {"ServerApp": {"jpserver_extensions": {FORMGRADER: False}}},
    )  # fmt: skip
    yield _json(
        everybody / "labconfig/page_config.json", "nor does their Lab show one, and they cannot switch it on there",
        {"disabledExtensions": disabled, "lockedExtensions": disabled},
    )  # fmt: skip
    yield _json(hub.environment / LAB_SETTINGS, "and it opens the glossary as one reads it", READ_MARKDOWN)
    text = f"{OURS}\nc = get_config()  # noqa: F821\nc.CourseDirectory.root = {json.dumps(str(hub.course.root.resolve()))}\n"
    yield _python(hub.instructors / "nbgrader_config.py", text, "for instructors: where the course is")
    server = {
        "jpserver_extensions": {FORMGRADER: True},
        "tornado_settings": INSIDE_LAB,
        "terminado_settings": NO_LOGIN_SHELL,
    }
    yield _json(
        hub.instructors / "jupyter_server_config.json",
        "their servers have the formgrader, let it open inside Lab, and find the environment's commands in a terminal",
        {"ServerApp": server},
    )
    yield _json(
        hub.instructors / "labconfig/page_config.json", "their Lab shows it",
        {"disabledExtensions": enabled, "lockedExtensions": enabled},
    )  # fmt: skip


def _json(path, what, wanted):
    """A JSON file that has these settings among others."""
    try:
        there = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
        merged = _merged(there, wanted)
    except ValueError as error:
        raise CourseError(f"{path} cannot be read as JSON ({error}): mend it, or move it away.") from None
    except TypeError:
        raise CourseError(f"{path} has a list or a text where Jupyter wants {{…}}: mend it, or move it away.") from None
    return _file(path, what, None if merged == there else json.dumps(merged, indent=2) + "\n")


def _merged(there, wanted):
    if not isinstance(there, dict):
        raise TypeError
    found = {
        name: _merged(there.get(name, {}), value) if isinstance(value, dict) else value
        for name, value in wanted.items()
    }
    return there | found


def _python(path, text, what):
    """A Python file of ours; in one that somebody else has written, our lines may stand, too."""
    there = path.read_text(encoding="utf-8") if path.exists() else ""
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    if there and not there.startswith(OURS):
        if not set(lines) <= set(there.splitlines()):
            raise CourseError(
                f"{path} is not ours to overwrite. Move it away (to /etc/jupyter, which everybody's servers read, too), or add "
                "to it:\n\n" + "\n".join(lines)
            )
        text = there
    return _file(path, what, None if there == text else text)


def _file(path, what, text):
    def write():
        path.parent.mkdir(parents=True, exist_ok=True)
        if text is not None:
            replace(path, text)
        path.chmod(0o644)
        for folder in made:
            folder.chmod(0o755)

    made = [folder for folder in path.parents if not folder.exists()]  # whatever the administrator's umask is
    open_to_others = path.exists() and path.stat().st_mode & stat.S_IROTH
    return Step(f"{path}: {what}", None if text is None and open_to_others else write)


def _folders(hub):
    """The exchange, into which everybody may put something that only its owner can take out, and the course's folder in it."""
    course, owner = hub.exchange / hub.course_id, hub.course.root.stat()

    def share():
        made = [folder for folder in hub.exchange.parents if not folder.exists()]
        hub.exchange.mkdir(parents=True, exist_ok=True)
        for folder in made:
            folder.chmod(0o755)
        hub.exchange.chmod(0o1777)

    def give():
        if not course.exists():
            course.mkdir()
            os.chown(course, owner.st_uid, owner.st_gid)
        course.chmod(0o755)

    shared = hub.exchange.is_dir() and hub.exchange.stat().st_mode & 0o1777 == 0o1777
    yield Step(f"{hub.exchange}: the exchange, mode 1777", None if shared else share)
    given = course.is_dir() and course.stat().st_mode & 0o007 == 0o005
    yield Step(f"{course}: the course's folder in it, made before a student could", None if given else give)


def problems(hub: Hub) -> Iterator[str]:
    """What `hub` leaves to its administrator, each with what to do."""
    python = hub.environment / "bin/python"
    packages = [str(path) for path in hub.environment.glob("lib/python3*/site-packages")]
    absent = lacking(hub.course.root / "environment.txt", installed(packages))
    if absent:
        names = ", ".join(absent[:5]) + (f" and {len(absent) - 5} more" if len(absent) > 5 else "")
        yield (
            f"{hub.environment} lacks {names}, in the versions of environment.txt: "
            f"`{python} -m pip install -r {hub.course.root / 'environment.txt'}`."
        )
    if not (hub.environment / "bin/jupyterhub-singleuser").exists():
        yield f"{hub.environment} has no jupyterhub-singleuser: `{python} -m pip install jupyterhub==…`, in the hub's version."
    room, owner = hub.exchange / hub.course_id, hub.course.root.stat()
    if room.exists() and room.stat().st_uid != owner.st_uid:
        yield (
            f"{room} belongs to another account than the course, and nbgrader lets only its owner release: while nobody has "
            f"handed in, `chown -R {owner.st_uid}:{owner.st_gid} {room}`; otherwise give the course to that account."
        )
    for folder, whose, passing in (
        (hub.environment, "everybody", stat.S_IXOTH),
        (python.resolve(), "everybody", stat.S_IXOTH),  # what the environment was made from
        (hub.exchange, "everybody", stat.S_IXOTH),
        (hub.instructors, "instructors", stat.S_IXOTH | stat.S_IXGRP),
    ):
        for path in (folder, *folder.parents):
            if path.exists() and not path.stat().st_mode & passing:
                yield f"{folder} is for {whose}, and {path} keeps them out: `chmod o+x {path}`, or choose another folder."


def for_the_spawner(hub: Hub) -> str:
    """What has to stand in jupyterhub_config.py besides."""
    return f'''\
INSTRUCTORS = {{"…"}}  # the names with which they log in to the hub
c.Spawner.environment.update({{
    "PATH": "{hub.environment}/bin:/usr/local/bin:/usr/bin:/bin",
    "JUPYTER_CONFIG_PATH": lambda spawner: "{hub.instructors}" if spawner.user.name in INSTRUCTORS else "",
}})
'''
