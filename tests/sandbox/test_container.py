"""What is said in a container that lets bubblewrap do nothing is tried: the options that it names, and the user."""

import re
import subprocess

from support import ROOT

ASKED = f"import sys; sys.path.insert(0, {str(ROOT)!r}); from autograder import sandbox; print(sandbox.problem())"


def said(container, python, user, *options):
    """What `doctor` would say of the sandbox to this user of a container with these options."""
    change = ["setpriv", f"--reuid={user}", f"--regid={user}", "--clear-groups"]
    command = [*container, *options, "/", *change, python, "-B", "-c", ASKED]
    return subprocess.run(command, capture_output=True, text=True, cwd="/", check=True).stdout.strip()


def test_the_advice_for_a_container_works(container, open_python, tmp_path_factory):
    refused = said(container, open_python, 1000)
    assert refused.startswith("bubblewrap is installed but may not make namespaces here")
    user = re.search(r"--user (\d+)", refused)[1]
    options = [f"--{option}" for option in re.findall(r"--security-opt (\S+=\w+)", refused) if "apparmor" not in option]
    assert said(container, open_python, user, *options) == "None"
    assert said(container, open_python, 0, *options) != "None"
    for option in options:  # each of them is needed, and no more than that
        assert said(container, open_python, user, *set(options) - {option}) != "None"
