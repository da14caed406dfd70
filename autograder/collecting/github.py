"""GitHub Classroom: the clones that `gh classroom clone student-repos` makes.

SLUG-submissions/SLUG-LOGIN/ (or SLUG-TEAM): github/gh-classroom, cmd/gh-classroom/clone/student-repos. The time is that of
the last commit, as the student's own machine told it. The first clone that fails ends that command, so some may be missing.
"""

import os
import subprocess
from datetime import datetime
from pathlib import PurePosixPath

from .piece import Form, Found, Left, Piece, Who, share

CLONES = "-submissions"
PATIENCE = 20  # seconds for git
# Nothing that a repository says is run.
GIT = (
    "git",
    "--no-pager",
    "-c",
    "core.fsmonitor=false",
    "-c",
    "core.hooksPath=/dev/null",
    "-c",
    "log.showSignature=false",
)


def fits(download):
    clones = {path.parts[0]: path for path in download.files if len(path.parts) > 1}
    git = {name for name, path in clones.items() if (place := download.on_disk(path, 1)) and (place / ".git").exists()}
    return share(download, lambda path: path.parts[0] in git)


def sort(download, notebooks, people):
    pieces, left, times = [], [], {}
    clones = {path.parts[0]: download.on_disk(path, 1) for path in download.files if len(path.parts) > 1}
    slug = _slug(download.name, clones, people)
    for path in download.files:
        top = path.parts[0]
        if len(path.parts) == 1 or not (clones[top] and (clones[top] / ".git").exists()):
            left.append(Left("it is in no clone", (str(path),)))
        elif not (slug and top.startswith(slug)):
            why = f"nothing says where in {top} the login begins; the folder around the clones has to be called SLUG{CLONES}"
            left.append(Left(why, (str(path),)))
        else:
            times.setdefault(top, _time(clones[top]))
            who = Who(login=top.removeprefix(slug))
            pieces.append(Piece((who,), path, PurePosixPath(*path.parts[1:]), time=times[top]))
    return Found(pieces, left)


def _slug(around, clones, people):
    """What all repositories' names begin with, the hyphen included; "" where nothing says so."""
    if around.endswith(CLONES):
        return around.removesuffix(CLONES) + "-"
    begins = {
        name[: -len(login)]
        for name in clones
        for login in people.values("login")
        if name.casefold().endswith(f"-{login}".casefold())
    }
    if len(begins) != 1 and len(clones) > 1:
        begins = {"".join(os.path.commonprefix(sorted(clones)).rpartition("-")[:2])}
    return begins.pop() if len(begins) == 1 else ""


def _time(clone):
    """The time of a clone's last commit; None where git does not tell."""
    try:
        done = subprocess.run(
            [*GIT, "-C", clone, "log", "-1", "--format=%cI"], capture_output=True, text=True, timeout=PATIENCE
        )
        return datetime.fromisoformat(done.stdout.strip()) if done.returncode == 0 else None
    except (OSError, ValueError, subprocess.TimeoutExpired):
        return None


FORM = Form("github", "GitHub Classroom: gh classroom clone student-repos", fits, sort)
