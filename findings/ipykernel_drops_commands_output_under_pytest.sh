#!/usr/bin/env bash
# Surprise: ipykernel@7.4.0 with nbclient@0.11.0: what a cell's os.system prints is in the notebook, unless the notebook is run by a
# test of pytest's: a kernel that finds PYTEST_CURRENT_TEST in its environment does not look at its file descriptors. So a test that
# runs notebooks sees other outputs than a person does who runs them.
# Guess: the same outputs.
# Seen: "from a command" without the variable, nothing with it.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check ipykernel==7.4.0 nbclient==0.11.0 nbformat==5.11.1
cat > run.py <<'EOF'
import os
import sys

import nbformat
from nbclient import NotebookClient

cell = nbformat.v4.new_code_cell("import os, time\nos.system('echo from a command')\ntime.sleep(1)")
seen = []
for test in (None, "test_notebook.py::test_it (call)"):
    os.environ.pop("PYTEST_CURRENT_TEST", None)
    if test:
        os.environ["PYTEST_CURRENT_TEST"] = test
    notebook = nbformat.v4.new_notebook(cells=[cell.copy()])
    NotebookClient(notebook, kernel_name="python3").execute()
    seen.append("".join(output.get("text", "") for output in notebook.cells[0].outputs))
    print("in a test:" if test else "by hand:", repr(seen[-1]))
if seen != ["from a command\n", ""]:
    sys.exit("A kernel in a test now tells what commands print.")
EOF
JUPYTER_PATH="$work/venv/share/jupyter" PATH="$work/venv/bin:$PATH" venv/bin/python run.py
