"""An environment with the libraries of requirements.txt and ROS 2's messages, beside that of the course."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from support import PATIENCE, ROOT, lacking

HERE = Path(__file__).parent
UV = Path(sys.executable).with_name("uv")
SLOW_TO_COMPILE = (
    "import jax.numpy, jax.scipy.spatial.transform, jaxlie, pydrake.math, pinocchio, spatialmath, sympy, trimesh"
)


class Libraries:
    """The Python of that environment."""

    def __init__(self, folder):
        self.python = folder / "bin/python"

    def ask(self, program, question, *arguments, **environment):
        """The answer of one of our programs, which reads and writes JSON."""
        known = {
            "PATH": os.defpath,
            "PYTHONPATH": f"{ROOT}/source/transforms",
            "MPLBACKEND": "agg",
            "OPENBLAS_NUM_THREADS": "1",
        }
        found = subprocess.run(
            [self.python, "-W", "ignore", HERE / program, *arguments],
            env={**known, **environment}, input=json.dumps(question), capture_output=True, text=True, timeout=PATIENCE,
        )  # fmt: skip
        assert found.returncode == 0, found.stderr
        return json.loads(found.stdout.splitlines()[-1])


@pytest.fixture(scope="session")
def libraries(slow, made_once):
    """The environment with the libraries, made once in a run."""

    def make(folder):
        installing = [
            [UV, "venv", "--quiet", "--clear", "--python", sys.executable, folder],
            [UV, "pip", "install", "--python", folder, "-r", ROOT / "environment.txt", "-r", HERE / "requirements.txt"],
            [UV, "pip", "install", "--python", folder, "--no-deps", "-r", HERE / "ros2.txt"],
            # Once, and not in each sandbox, which cannot keep it; -I, for then it does not heed an environment that says not to.
            [folder / "bin/python", "-I", "-c", SLOW_TO_COMPILE],
        ]
        for command in installing:
            step = subprocess.run(command, capture_output=True, text=True)
            if step.returncode != 0:
                lacking(f"needs the libraries of tests/libraries: {step.stderr[:500]}")

    return Libraries(made_once("libraries", make))
