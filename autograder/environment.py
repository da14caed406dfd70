"""Whether this interpreter can run the project, or the project's own `.venv` has to. Standard library only.

One that already has every package of environment.txt at its version is used as it is. Every command begins here, so nothing
is imported that takes time.
"""

import os
import re
import sys
from contextlib import suppress
from pathlib import Path

OLDEST = (3, 11)
# JupyterLab's settings in an environment: a page in Markdown, such as the glossary, opens as one reads it.
LAB_SETTINGS = "etc/jupyter/labconfig/default_setting_overrides.json"
READ_MARKDOWN = {"@jupyterlab/docmanager-extension:plugin": {"defaultViewers": {"markdown": "Markdown Preview"}}}


def suits(root):
    """Whether this interpreter can run the project in `root`; if so, the commands of its environment are on PATH."""
    if sys.version_info < OLDEST or lacking(root / "environment.txt"):
        return False
    # nbgrader runs `alembic` and `jupyter` by name
    os.environ["PATH"] = f"{Path(sys.prefix, 'bin')}{os.pathsep}{os.environ.get('PATH', '')}"
    return True


def lacking(requirements, there=None):
    """The requirements that are not `there`, {name: version}, at their version; by default, in this interpreter."""
    there = installed() if there is None else there
    wanted = pins(requirements.read_text(encoding="utf-8"))
    return [name for name, version in wanted if there.get(normal(name)) != version]


def installed(folders=None):
    """{name: version} of the packages that Python finds, or that lie in these folders, by the names of the folders that say so:
    reading these takes longer."""
    found = {}
    for folder in sys.path if folders is None else folders:
        with suppress(OSError):
            for entry in os.listdir(folder or "."):
                if match := re.fullmatch(r"([^-]+)-([^-]+)(?:-.*)?\.(?:dist|egg)-info", entry):
                    found.setdefault(normal(match[1]), match[2])
    return found


def pins(text):
    """[(name, version)] of what environment.txt or environment.lock pins, as spelled there."""
    return re.findall(r"^([\w.-]+)==([\w.]+)", text, re.MULTILINE)


def normal(name):
    """A package's name as uv writes it."""
    return re.sub(r"[-_.]+", "-", name).lower()
