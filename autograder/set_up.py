"""Makes `.venv`, the project's own environment, on first use. Standard library only.

It is made once, from environment.lock, which pins what the packages of environment.txt bring, too: by uv within seconds (the
one on PATH, or fetched into `.venv` first), or else by pip within minutes. A stamp written last says that it is whole, so a
set-up that failed or was interrupted is repaired by the next command.
"""

import fcntl
import hashlib
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

from .environment import LAB_SETTINGS, OLDEST, READ_MARKDOWN, lacking, normal, pins

# What environment.lock is for, as pyproject.toml says it to uv.
NEWEST_LOCKED = (3, 14)
LOCKED = {"linux": ("x86_64", "aarch64"), "darwin": ("x86_64", "arm64")}
MAKE_LOCK = (
    "uv pip compile --universal --python-version 3.11 --no-build --generate-hashes environment.txt -o environment.lock"
)
LOADED_MOST = (  # each line by a process of its own
    "nbgrader.apps.nbgraderapp nbgrader.plugins nbconvert.exporters",
    "matplotlib.pyplot matplotlib_inline.backend_inline scipy.spatial.transform IPython.core.interactiveshell rich.progress",
)
OLDEST_UV = (0, 5)  # of those on PATH
# For a network with an authority of its own, which this machine knows and uv does not; the second is for older ones.
SYSTEMS_CERTIFICATES = {"UV_SYSTEM_CERTS": "true", "UV_NATIVE_TLS": "true"}


MADE = "AUTOGRADER_MADE_ENVIRONMENT"  # in the environment of the interpreter that ours goes on in


class SetupFailed(Exception):
    """The environment could not be made; the message says what to do."""


class StepFailed(Exception):
    """A step of the set-up did not succeed; the message is its reason."""


def go_on(root, arguments):
    """Go on with the command in the `.venv` of `root`, which is made if need be (this call does not return)."""
    if sys.version_info < OLDEST:
        raise SetupFailed(f"Python {'.'.join(map(str, OLDEST))} or newer is needed; this is {sys.version.split()[0]}.")
    if Path(sys.prefix) == root / ".venv":
        if os.environ.get(MADE) == sys.prefix:
            raise SetupFailed(f".venv was made anew, and still lacks {', '.join(lacking(root / 'environment.txt'))}.")
        # Its packages were changed by hand: make it anew, with the Python that it was made from.
        (root / ".venv" / "stamp").unlink(missing_ok=True)
    with open(root / "environment.txt", encoding="utf-8") as claimed:
        try:
            fcntl.flock(claimed, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:  # two first commands at once: the second waits, and finds it made
            _say("Another command is setting up .venv; waiting for it …")
            fcntl.flock(claimed, fcntl.LOCK_EX)
        python = make(root)
    os.environ[MADE] = str(root / ".venv")
    os.environ.pop("PYTHONPATH", None)
    os.execv(python, [str(python), "-m", "autograder", *arguments])


def make(root):
    """Make `.venv` in `root` unless it is whole already; returns its interpreter."""
    folder, sources = root / ".venv", (root / "environment.txt", root / "environment.lock")
    python, stamp = folder / "bin" / "python", folder / "stamp"
    requirements, lock = (path.read_text(encoding="utf-8") if path.exists() else "" for path in sources)
    # The folder's own path counts, too: the scripts of an environment that was moved or copied do not work.
    digest = hashlib.sha256(repr((requirements, lock, str(folder))).encode()).hexdigest()
    if stamp.exists() and stamp.read_text() == digest and python.exists():
        return python
    _say("Setting up .venv, once:")
    started = time.monotonic()
    try:
        if reason := unfit(requirements, lock):
            _say(f"  from environment.txt, and whatever that brings today: environment.lock {reason}")
            _install(folder, ["-r", str(sources[0])], lock)
        else:
            _install(folder, ["--require-hashes", "-r", str(sources[1])], lock)
    except StepFailed as failure:
        raise SetupFailed(
            f"The set-up failed: {failure}\n"
            "Check the network (and that Python's venv module is installed: apt install python3-venv), then run "
            "the same command again; it starts over."
        ) from None
    except KeyboardInterrupt:
        raise SetupFailed("The set-up was interrupted; the next command starts over.") from None
    (folder / LAB_SETTINGS).parent.mkdir(parents=True, exist_ok=True)
    (folder / LAB_SETTINGS).write_text(json.dumps(READ_MARKDOWN))
    stamp.write_text(digest)
    _say(f"  done in {time.monotonic() - started:.0f} s")
    return python


def unfit(requirements, lock):
    """Why the text of environment.lock cannot be installed from here; None when it can.

    requirements: the text of environment.txt
    """
    pinned = {(normal(name), version) for name, version in pins(lock)}
    if missing := [name for name, version in pins(requirements) if (normal(name), version) not in pinned]:
        return f"does not pin {', '.join(missing)} as environment.txt does. Make it anew: .venv/bin/{MAKE_LOCK}"
    if platform.machine() not in LOCKED.get(sys.platform, ()) or sys.version_info[:2] > NEWEST_LOCKED:
        return f"is not for Python {platform.python_version()} on {sys.platform} {platform.machine()}."
    return None


def _install(folder, packages, lock):
    """Make `.venv` with `packages`, as uv and pip take them from a command line."""
    base = getattr(sys, "_base_executable", None) or sys.executable
    for install in (_with_uv, _with_pip):
        shutil.rmtree(folder, ignore_errors=True)
        _run([base, "-m", "venv", "--without-pip", str(folder)])  # with pip it would take seconds more
        try:
            return install(base, folder, packages, lock)
        except StepFailed as failure:
            if install is _with_pip:
                raise
            _say(f"  without uv, so it takes minutes: {' '.join(str(failure).split())[:300]}")


def _with_uv(base, folder, packages, lock):
    # Beside this interpreter, too, whose environment need not be active.
    uv = shutil.which("uv", path=os.pathsep.join((os.environ.get("PATH", ""), str(Path(sys.executable).parent))))
    if not uv or _version(uv) < OLDEST_UV:
        pinned = re.search(r"^(uv==\S+).*((?: \\\n +--hash=\S+)+)", lock, re.MULTILINE)
        if not pinned:
            raise StepFailed("it is not on PATH, and not in environment.lock.")
        _say("  fetching uv …")
        entry = folder / "uv.txt"
        entry.write_text("".join(pinned.groups()))  # without its marker: uv itself is for any Python
        options = ["--no-deps", "--only-binary", ":all:", "--require-hashes", "-r", str(entry)]
        _run([*_pip(base, folder), "install", *options])
        uv = folder / "bin" / "uv"
    _say("  installing the packages with uv …")
    python = folder / "bin" / "python"
    install = [uv, "pip", "install", "--python", python, *packages]
    try:
        _run(install, "Downloaded", "Downloading")
    except StepFailed as failure:
        if "certificate" not in str(failure):
            raise
        _run(install, "Downloaded", "Downloading", SYSTEMS_CERTIFICATES)
    if sys.dont_write_bytecode:  # else the first import does it, within seconds
        _compile(python)


def _compile(python):
    """Have Python write the bytecode of what most commands load, which they would compile at each start."""
    code = "import importlib, sys\nfor name in sys.argv[1:]: importlib.import_module(name)"
    options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
    # -I, for then it does not heed the environment, which says to write none.
    running = [subprocess.Popen([python, "-I", "-c", code, *names.split()], **options) for names in LOADED_MOST]
    for process in running:
        complaint = process.communicate()[1]
        if process.returncode != 0:
            _say(f"  commands will start slowly: {' '.join(complaint.splitlines()[-1:])[:300]}")


def _with_pip(base, folder, packages, lock):
    _say("  installing the packages with pip …")
    _run([*_pip(base, folder), "install", *packages], "Collecting")


def _version(uv):
    """The version of the command `uv`, (0, 13, 9); () when it does not tell."""
    try:
        return tuple(map(int, re.findall(r"\d+", _run([uv, "--version"]))[:3]))
    except StepFailed:
        return ()


def _pip(base, folder):
    """pip for `.venv`: that of the Python it is made from, or else the one Python carries along, which takes unpacking."""
    python = folder / "bin" / "python"
    command = ["-m", "pip", "--disable-pip-version-check"]
    try:
        _run([base, "-c", "import pip"])
    except StepFailed:
        _run([python, "-m", "ensurepip"])
        return [python, *command]
    return [base, *command, "--python", python]


def _run(step, counted=None, total=None, settings=()):
    """Run a step of the set-up; returns what it printed. On a terminal its latest line is shown meanwhile, and how many
    lines began with the word `counted`, of how many with the word `total`. settings: added to the environment.
    """
    lines, words, shown = [], Counter(), counted and sys.stderr.isatty()
    # Packages in PYTHONPATH, where ROS has its own, are not in `.venv`.
    variables = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    variables.update(settings)
    options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "env": variables}
    try:
        with subprocess.Popen(step, encoding="utf-8", errors="replace", **options) as process:
            try:
                for line in process.stdout:
                    lines.append(line.rstrip())
                    words.update(line.split(maxsplit=1)[:1])
                    if shown:
                        far = f"{words[counted]} of {words[total]}" if total else f"{words[counted]}"
                        _show(f"    {far}: {line.strip()}")
            except BaseException:
                process.kill()
                raise
            finally:
                if shown:
                    _show("")
    except OSError as error:
        raise StepFailed(str(error)) from None
    if process.returncode != 0:
        first = next((index for index, line in enumerate(lines) if line.lower().startswith("error")), -5)
        raise StepFailed("\n".join(lines[first:][:5]) or f"{step[0]} ended with {process.returncode}.")
    return "\n".join(lines)


def _say(line):
    print(line, file=sys.stderr, flush=True)


def _show(text):
    """Put `text` in the place of the terminal's last line."""
    print(f"\r{text[: shutil.get_terminal_size().columns - 1]}\x1b[K", end="", file=sys.stderr, flush=True)
