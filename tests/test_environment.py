"""The first use makes `.venv`; what was interrupted, changed or broken is made anew. Real environments, no network."""

import fcntl
import functools
import hashlib
import importlib.util
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
import time
import tomllib
import zipfile
from importlib import metadata
from itertools import product
from pathlib import Path

import pytest
from packaging.markers import Marker
from packaging.requirements import Requirement
from support import ROOT

from autograder import environment, set_up

NOTHING = "# no package\n"
ANEW = f"environment.lock does not fit environment.txt. Make it anew: {set_up.MAKE_LOCK}"
UV = shutil.which("uv", path=Path(sys.prefix, "bin"))  # one of environment.txt's packages


@pytest.fixture
def root(tmp_path):
    """Where an environment without a package can be made."""
    root = tmp_path / "root"
    root.mkdir()
    (root / "environment.txt").write_text(NOTHING)
    (root / "environment.lock").write_text(NOTHING)
    return root


@pytest.fixture
def tools(tmp_path, monkeypatch):
    """The folder that PATH names, and pip without a network; there is no uv unless a test puts it there."""
    (tmp_path / "bin").mkdir()
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setattr(sys, "executable", str(tmp_path / "bin" / "python3"))
    return tmp_path / "bin"


def prefix(python):
    return subprocess.run(
        [python, "-c", "import sys; print(sys.prefix)"], capture_output=True, text=True
    ).stdout.strip()


def pretend_uv(tools, does, version="99.0"):
    """Put an uv on PATH that says its version, and otherwise does what `does` tells the shell."""
    (tools / "uv").unlink(missing_ok=True)
    (tools / "uv").write_text(f'#!/bin/sh\n[ "$1" = --version ] && echo "uv {version} of 2024-03-01" && exit\n{does}\n')
    (tools / "uv").chmod(0o755)


def wheel(folder, name, scripts=()):
    """A package that can be installed without a network; returns what a lock says of it."""
    path = folder / f"{name}-1.0-py3-none-any.whl"
    info = f"{name}-1.0.dist-info"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(f"{name}.py", "")
        archive.writestr(f"{info}/METADATA", f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
        archive.writestr(f"{info}/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
        for command, text in dict(scripts).items():
            entry = zipfile.ZipInfo(f"{name}-1.0.data/scripts/{command}")
            entry.external_attr = 0o100755 << 16
            archive.writestr(entry, f"#!/bin/sh\n{text}\n")
        archive.writestr(f"{info}/RECORD", "")
    return f"{name}==1.0 \\\n    --hash=sha256:{hashlib.sha256(path.read_bytes()).hexdigest()}\n"


def needs_a_package(root):
    """Let the environment have one package, `lacking_here`."""
    (root / "environment.txt").write_text(f"--no-index\n--find-links {root}\nlacking_here==1.0  # for tests\n")
    (root / "environment.lock").write_text(f"--no-index\n--find-links {root}\n{wheel(root, 'lacking_here')}")


def has_the_package(python):
    return subprocess.run([python, "-c", "import lacking_here"], capture_output=True).returncode == 0


# --- when it is made ------------------------------------------------------------------------------------------------


def test_it_is_made_once(root):
    python = set_up.make(root)
    assert prefix(python) == str(root / ".venv")
    (root / ".venv" / "mark").touch()
    assert set_up.make(root) == python
    assert (root / ".venv" / "mark").exists()


@pytest.mark.parametrize("spoil", ["interrupted", "requirements", "lock", "broken", "moved"])
def test_it_is_made_anew_when_it_is_not_whole(root, tmp_path_factory, spoil):
    set_up.make(root)
    (root / ".venv" / "mark").touch()
    if spoil == "interrupted":
        (root / ".venv" / "stamp").unlink()
    elif spoil == "requirements":
        (root / "environment.txt").write_text(NOTHING + "# one more line\n")
    elif spoil == "lock":
        (root / "environment.lock").write_text(NOTHING + "# one more line\n")
    elif spoil == "broken":
        (root / ".venv" / "bin" / "python").unlink()
    else:
        root = root.rename(tmp_path_factory.mktemp("elsewhere") / "course")
    assert prefix(set_up.make(root)) == str(root / ".venv")
    assert not (root / ".venv" / "mark").exists()
    assert "Markdown Preview" in (root / ".venv" / environment.LAB_SETTINGS).read_text()


def test_a_failed_set_up_says_what_to_do_and_is_repaired(root, tools):
    (tools / "uv").symlink_to(UV)
    (root / "environment.lock").write_text("no-such-package==1.0 --hash=sha256:00\n")
    with pytest.raises(set_up.SetupFailed, match="no-such-package(?s:.*)run the same command again"):
        set_up.make(root)
    assert not (root / ".venv" / "stamp").exists()
    (root / "environment.lock").write_text(NOTHING)
    assert prefix(set_up.make(root)) == str(root / ".venv")


def test_what_an_interpreter_lacks(root):
    assert environment.lacking(ROOT / "environment.txt") == []
    (root / "environment.txt").write_text("pytest==0.1  # old\nno-such-package-anywhere==1.0\n")
    assert environment.lacking(root / "environment.txt") == ["pytest", "no-such-package-anywhere"]


def test_the_names_of_folders_tell_what_the_packages_themselves_do():
    told = {}
    for package in metadata.distributions():
        told.setdefault(environment.normal(package.name), package.version)
    assert environment.installed() == told


@pytest.mark.parametrize("form", ["{}-{}.dist-info", "{}-{}.egg-info", "{}-{}-py3.11.egg-info"])
def test_the_package_that_python_finds_first_counts(root, monkeypatch, form):
    for place, version in ("first", "1.0"), ("second", "2.0"):
        (root / place / form.format("a_Package", version)).mkdir(parents=True)
    monkeypatch.setattr(sys, "path", [str(root / place) for place in ("nowhere", "first", "second")])
    assert environment.installed() == {"a-package": "1.0"}
    (root / "environment.txt").write_text("a.package==2.0\n")
    assert environment.lacking(root / "environment.txt") == ["a.package"]


def test_an_old_python_is_told_so(root, monkeypatch):
    monkeypatch.setattr(set_up, "OLDEST", (99, 0))
    with pytest.raises(set_up.SetupFailed, match="Python 99.0 or newer is needed"):
        set_up.go_on(root, [])


# --- with uv or pip -------------------------------------------------------------------------------------------------


def test_uv_is_used_where_there_is_one(root, tools, capsys):
    needs_a_package(root)
    (tools / "uv").symlink_to(UV)
    assert has_the_package(set_up.make(root))
    said = capsys.readouterr().err
    assert "with uv" in said and "fetching" not in said and "pip" not in said


@pytest.mark.parametrize("there", ["none", "old"])
def test_uv_is_fetched_where_there_is_none_that_serves(root, tools, monkeypatch, capsys, there):
    needs_a_package(root)
    monkeypatch.setenv("PIP_FIND_LINKS", str(root))
    entry = wheel(root, "uv", {"uv": f'echo fetched >> {root}/log; exec {UV} "$@"'})
    with open(root / "environment.lock", "a") as lock:
        lock.write(entry.replace("==1.0", "==1.0 ; python_full_version < '3.0'"))  # uv itself is for any Python
    if there == "old":
        pretend_uv(tools, "exit 2", "0.1.24")
    assert has_the_package(set_up.make(root))
    said = capsys.readouterr().err
    assert "fetching uv" in said and "with uv" in said and "minutes" not in said
    assert (root / "log").read_text() == "fetched\n"


@pytest.mark.parametrize(
    "why, reason",
    [
        ("not to be had", "it is not on PATH, and not in environment.lock."),
        ("other bytes", "DO NOT MATCH THE HASHES"),
        ("fails", "error: the disk is full cause: too much on it"),
    ],
)
def test_pip_is_used_where_uv_is_not_to_be_had_or_fails(root, tools, monkeypatch, capsys, why, reason, slow):
    needs_a_package(root)
    if why == "other bytes":
        monkeypatch.setenv("PIP_FIND_LINKS", str(root))
        wheel(root, "uv", {"uv": f"touch {root}/ran"})
        with open(root / "environment.lock", "a") as lock:
            lock.write(f"uv==1.0 \\\n    --hash=sha256:{'0' * 64}\n")
        monkeypatch.setattr(set_up, "_with_pip", lambda *arguments: None)  # it would find the same
    elif why == "fails":
        pretend_uv(tools, "echo error: the disk is full; echo cause: too much on it; exit 2")
    python = set_up.make(root)
    said = [line for line in capsys.readouterr().err.splitlines() if "minutes" in line]
    assert len(said) == 1 and reason in said[0]
    assert not (root / "ran").exists()
    assert why == "other bytes" or has_the_package(python)


@pytest.mark.parametrize("knows", ["UV_SYSTEM_CERTS", "UV_NATIVE_TLS"])
def test_uv_takes_the_systems_certificates_where_its_own_do_not_serve(root, tools, monkeypatch, capsys, knows):
    needs_a_package(root)
    for variable in ("UV_SYSTEM_CERTS", "UV_NATIVE_TLS"):
        monkeypatch.delenv(variable, raising=False)
    refused = (
        f"echo asked >> {root}/log; echo error: it cannot be fetched; echo cause: invalid peer certificate; exit 2"
    )
    pretend_uv(tools, f'[ "${knows}" = true ] && exec {UV} "$@"\n{refused}')
    assert has_the_package(set_up.make(root))
    said = capsys.readouterr().err
    assert "with uv" in said and "pip" not in said
    assert (root / "log").read_text() == "asked\n"  # those of its own first: there may be no others


def test_uv_that_fails_for_another_reason_is_not_tried_again(root, tools):
    needs_a_package(root)
    pretend_uv(tools, f"echo asked >> {root}/log; echo error: the disk is full; exit 2")
    set_up.make(root)
    assert (root / "log").read_text() == "asked\n"


@pytest.mark.parametrize("with_uv", [True, False])
def test_other_bytes_than_the_locks_are_not_installed(root, tools, with_uv, slow):
    needs_a_package(root)
    if with_uv:
        (tools / "uv").symlink_to(UV)
    with zipfile.ZipFile(root / "lacking_here-1.0-py3-none-any.whl", "a") as archive:
        archive.writestr("lacking_here/more.py", "")
    with pytest.raises(set_up.SetupFailed, match="(?i)hash"):
        set_up.make(root)
    assert not has_the_package(root / ".venv" / "bin" / "python")


def test_pip_that_python_carries_along_serves_where_it_has_none(root, tools, monkeypatch, slow):
    """As on Debian, where pip is a package of its own."""
    needs_a_package(root)
    run = set_up._run

    def without_pip(step, *progress):
        if "import pip" in step:
            raise set_up.StepFailed("No module named pip")
        return run(step, *progress)

    monkeypatch.setattr(set_up, "_run", without_pip)
    assert has_the_package(set_up.make(root))


@pytest.mark.parametrize("why", ["changed", "added", "gone", "machine", "python"])
def test_without_a_lock_that_fits_the_requirements_are_installed(root, tools, monkeypatch, capsys, why):
    needs_a_package(root)
    (tools / "uv").symlink_to(UV)
    lock = root / "environment.lock"
    if why == "changed":
        lock.write_text(lock.read_text().replace("==1.0", "==0.9"))
    elif why == "added":
        lock.write_text(NOTHING)
    elif why == "gone":
        lock.unlink()
    elif why == "machine":
        monkeypatch.setattr(set_up.platform, "machine", lambda: "riscv64")
    else:
        monkeypatch.setattr(set_up, "NEWEST_LOCKED", (3, 10))
    assert has_the_package(set_up.make(root))
    said = capsys.readouterr().err
    if why in ("machine", "python"):
        assert "environment.lock is not for Python 3." in said and set_up.MAKE_LOCK not in said
    else:
        assert "does not pin lacking_here as environment.txt does" in said and set_up.MAKE_LOCK in said


def test_what_python_finds_elsewhere_is_installed_all_the_same(root, tools, tmp_path, monkeypatch):
    """ROS puts its own packages into PYTHONPATH."""
    needs_a_package(root)
    shutil.unpack_archive(root / "lacking_here-1.0-py3-none-any.whl", tmp_path / "ros", "zip")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "ros"))
    python = set_up.make(root)
    monkeypatch.delenv("PYTHONPATH")
    assert has_the_package(python)


@pytest.mark.parametrize("written", [True, False])
def test_modules_are_compiled_where_the_first_import_will_not_do_it(root, tools, monkeypatch, written, capfd):
    needs_a_package(root)
    (tools / "uv").symlink_to(UV)
    monkeypatch.setattr(sys, "dont_write_bytecode", not written)
    monkeypatch.setattr(set_up, "LOADED_MOST", ("json lacking_here", "lacking_here no_such_module"))
    set_up.make(root)
    assert bool(list((root / ".venv").rglob("lacking_here.*.pyc"))) is not written
    assert (
        "start slowly: ModuleNotFoundError: No module named 'no_such_module'" in capfd.readouterr().err
    ) is not written


def test_what_most_commands_load_is_there():
    for names in set_up.LOADED_MOST:
        assert all(map(importlib.util.find_spec, names.split()))


# --- as a command meets it ------------------------------------------------------------------------------------------


@pytest.fixture
def command(root, tools):
    """The command line of a project in `root` that needs a package, and says where it runs."""
    needs_a_package(root)
    package = root / "autograder"
    package.mkdir()
    for name in ("__init__.py", "__main__.py", "environment.py", "set_up.py"):
        shutil.copy(ROOT / "autograder" / name, package)
    (package / "command_line.py").write_text(
        "import sys\ndef run(arguments):\n    print(sys.prefix, arguments)\n    return 3\n"
    )
    (tools / "uv").symlink_to(UV)
    (tools / "python3").symlink_to(sys._base_executable)
    return [tools / "python3", "-m", "autograder", "demo", "--remove"]


def test_a_command_goes_on_in_the_new_environment(root, command):
    """An interpreter that lacks a package installs it into `.venv` and goes on there with the command's arguments."""
    for _ in range(2):  # the second time, the environment is there
        result = subprocess.run(command, cwd=root, capture_output=True, text=True)
        assert result.stdout == f"{root / '.venv'} ['demo', '--remove']\n", result.stderr
        assert result.returncode == 3
    assert "Setting up" not in result.stderr


def test_two_first_commands_wait_for_each_other(root, command):
    with open(root / "environment.txt") as claimed:
        fcntl.flock(claimed, fcntl.LOCK_EX)  # as the other one does
        process = subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert process.stderr.readline() == "Another command is setting up .venv; waiting for it …\n"
        assert not (root / ".venv").exists()
    assert process.communicate()[0] == f"{root / '.venv'} ['demo', '--remove']\n"


def test_an_interrupted_set_up_is_said_and_repaired(root, tools, command):
    pretend_uv(tools, f"echo $$ > {root}/pid; /bin/mv {root}/pid {root}/started; exec /bin/sleep 600")
    # As at a terminal: a job that a shell has put into the background ignores interrupts.
    heeding = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    process = subprocess.Popen(command, cwd=root, stderr=subprocess.PIPE, text=True, preexec_fn=heeding)
    while not (root / "started").exists() and process.poll() is None:
        time.sleep(0.05)
    sleeping = int((root / "started").read_text())
    process.send_signal(signal.SIGINT)
    said = process.communicate()[1]
    assert process.returncode == 1 and said.endswith("The set-up was interrupted; the next command starts over.\n")
    assert "Traceback" not in said
    with pytest.raises(ProcessLookupError):
        os.kill(sleeping, 0)
    (tools / "uv").unlink()
    (tools / "uv").symlink_to(UV)
    assert subprocess.run(command, cwd=root, capture_output=True).returncode == 3


def test_a_terminal_shows_how_far_it_is(root, tools, command):
    steps = "echo 'Downloading scipy (34MiB)'; echo 'Downloading numpy (16MiB)'; echo ' Downloaded numpy'"
    pretend_uv(tools, f'{steps}; exec {UV} "$@"')
    ours, theirs = pty.openpty()
    with subprocess.Popen(command, cwd=root, stdout=subprocess.DEVNULL, stderr=theirs) as process:
        os.close(theirs)
        shown = b""
        try:
            while read := os.read(ours, 4096):
                shown += read
        except OSError:  # the end of a terminal whose other side is closed
            os.close(ours)
    assert process.returncode == 3
    assert b"\r    0 of 2: Downloading numpy (16MiB)\x1b[K\r    1 of 2: Downloaded numpy\x1b[K" in shown
    plain = subprocess.run(
        command, cwd=shutil.copytree(root, root.with_name("plain")), capture_output=True, text=True
    ).stderr
    assert "with uv" in plain and "Downloaded" not in plain and "\r" not in plain


# --- environment.txt and environment.lock ---------------------------------------------------------------------------


MACHINES = [(system, machine) for system, machines in set_up.LOCKED.items() for machine in machines]
PYTHONS = ["3.11.0", *(f"3.{minor}.9" for minor in range(11, set_up.NEWEST_LOCKED[1] + 1))]


def machine_environment(system, machine, python):
    """What the markers of requirements are evaluated in: a Python there."""
    return {
        "sys_platform": system,
        "platform_machine": machine,
        "platform_system": system.title(),
        "os_name": "posix",
        "python_version": python.rpartition(".")[0],
        "python_full_version": python,
        "implementation_name": "cpython",
        "platform_python_implementation": "CPython",
        "extra": "",
    }


def locked(lock):
    """{name: [(version, marker or None, number of hashes)]} of environment.lock's text."""
    found = {}
    for name, version, marker, hashes in re.findall(
        r"^([\w.-]+)==(\S+)(?: ; (.*?))?((?: \\\n +--hash=sha256:[0-9a-f]{64})*)$", lock, re.MULTILINE
    ):
        found.setdefault(name, []).append((version, Marker(marker) if marker else None, hashes.count("--hash")))
    return found


def wrong_in(requirements, lock):
    """What is wrong in the text of environment.lock, for each machine and Python that it is for: a sorted list.

    What a package needs is read from its metadata here; of one that is for other machines alone nothing is known.
    """
    wrong, reached, found = set(), set(), locked(lock)
    asked = [
        Requirement(line.partition("#")[0]) for line in requirements.splitlines() if "==" in line.partition("#")[0]
    ]
    for machine in [machine_environment(*machine, python) for machine, python in product(MACHINES, PYTHONS)]:
        where = f"Python {machine['python_full_version']} on {machine['sys_platform']} {machine['platform_machine']}"
        waiting, seen = [(requirement, "") for requirement in asked], set()
        while waiting:
            requirement, extra = waiting.pop()
            if requirement.marker and not requirement.marker.evaluate({**machine, "extra": extra}):
                continue
            name = environment.normal(requirement.name)
            entries = [entry for entry in found.get(name, ()) if not entry[1] or entry[1].evaluate(machine)]
            if len(entries) != 1:
                wrong.add(f"{name} is pinned {len(entries)} times for {where}")
                continue
            [(version, _, hashes)] = entries
            if not hashes:
                wrong.add(f"{name} has no hash")
            if not requirement.specifier.contains(version, prereleases=True):
                wrong.add(f"{name}=={version} is not {requirement}")
            for extra in ("", *requirement.extras):
                if (name, extra) not in seen:
                    seen.add((name, extra))
                    waiting += [(needed, extra) for needed in needs(name, version)]
        reached |= {name for name, _ in seen}
    for name in found.keys() - reached:
        if any(not marker or marker.evaluate(machine) for _, marker, _ in found[name]):
            wrong.add(f"{name} is needed by nothing")
    return sorted(wrong)


@functools.cache
def needs(name, version):
    """What this version of a package requires; nothing when this interpreter does not have it."""
    try:
        distribution = metadata.distribution(name)
    except metadata.PackageNotFoundError:
        return []
    return [Requirement(line) for line in distribution.requires or []] if distribution.version == version else []


def files():
    return [(ROOT / name).read_text(encoding="utf-8") for name in ("environment.txt", "environment.lock")]


def test_each_dependency_is_pinned_and_explained():
    lines = files()[0].splitlines()
    packages = [line for line in lines if line and not line.startswith("#")]
    assert len(packages) > 10
    for line in packages:
        name, _, comment = line.partition("#")
        assert "==" in name and comment.strip(), line


def test_the_lock_fits():
    requirements, lock = files()
    assert wrong_in(requirements, lock) == [], ANEW
    assert len(locked(lock)) > 3 * len(environment.pins(requirements)), ANEW
    assert f"#    {set_up.MAKE_LOCK}\n" in lock, ANEW
    assert "://" not in lock and not re.search(r"^-", lock, re.MULTILINE)  # no registry, no option


def test_what_the_lock_is_for_is_said_to_uv():
    said = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["uv"]
    major, minor = set_up.NEWEST_LOCKED
    assert said == {
        "environments": [f"python_full_version < '{major}.{minor + 1}'"],
        "required-environments": [
            f"sys_platform == '{system}' and platform_machine == '{machine}'" for system, machine in MACHINES
        ],
    }
    assert f"--python-version {'.'.join(map(str, environment.OLDEST))} " in set_up.MAKE_LOCK


@pytest.mark.parametrize(
    "pattern, replacement, message",
    [
        (r"^numpy==.*?(?=^\S)", "", "numpy is pinned 0 times for Python 3.11.0 on linux x86_64"),
        (r"^tornado==.*?(?=^\S)", "", "tornado is pinned 0 times for Python 3.11.0 on linux x86_64"),  # of a package
        (r"^appnope==.*?(?=^\S)", "", "appnope is pinned 0 times for Python 3.14.9 on darwin arm64"),
        (r"^scipy==\S+", "scipy==1.0", r"scipy==1.0 is not scipy=="),
        (r"^soupsieve==2\S+ ; .*?\\$", r"soupsieve==2.10 \\", "soupsieve is pinned 2 times for Python 3.11.9"),
        (r"^zipp==(\S+) ; .*?\\$", r"zipp==\1 ; sys_platform == 'win32' \\", "zipp is pinned 0 times"),
        (r"^(rich==.*?) \\$.*?(?=^ +#)", r"\1\n", "rich has no hash"),
        (
            r"^rich==",
            r"left-over==1.0 \\\n    --hash=sha256:" + 64 * "0" + r"\nrich==",
            "left-over is needed by nothing",
        ),
    ],
)
def test_a_lock_that_does_not_fit_is_noticed(pattern, replacement, message):
    requirements, lock = files()
    spoiled = re.sub(pattern, replacement, lock, count=1, flags=re.MULTILINE | re.DOTALL)
    assert spoiled != lock
    assert message in "\n".join(wrong_in(requirements, spoiled))


@pytest.mark.parametrize("change", ["numpy==2.0.0  # changed", "some-package==1.0  # added"])
def test_requirements_that_the_lock_does_not_fit_are_noticed(change):
    requirements, lock = files()
    name = change.partition("==")[0]
    changed = re.sub(rf"^{name}==.*\n", "", requirements, flags=re.MULTILINE) + change + "\n"
    assert any(line.startswith(name) for line in wrong_in(changed, lock))
    assert set_up.unfit(requirements, lock) is None
    assert f"does not pin {name} " in set_up.unfit(changed, lock)
    assert set_up.MAKE_LOCK in set_up.unfit(changed, lock)
