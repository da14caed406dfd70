#!/usr/bin/env bash
# Surprise: jupytext==1.19.6: in a .py notebook (py:percent) a comment whose first word is a shell command's name, or
# that starts with ! or ?, is taken for a commented-out magic: in the .ipynb it is no comment any more but a line of
# code. And the student's own "# %% mine" inside a cell cuts that cell in two on the way .ipynb -> .py -> .ipynb.
# Guess: comments stay comments, and a round trip keeps the cells.
# Seen: "# cp is the contact point" becomes "cp is the contact point", "# cat eye" "cat eye", "# ! not R" "! not R": the
# cell is a syntax error and defines nothing. One cell comes back as two, the second without the first's metadata.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check jupytext==1.19.6 nbformat==5.11.1
venv/bin/python - <<'EOF'
import jupytext
from nbformat.v4 import new_code_cell, new_notebook

comments = ["# cp is the contact point", "# cat eye", "# ls lists", "# ! not R", "# more precise", "# a: approach"]
changed = []
for comment in comments:
    text = f"# %%\nx = 1\n{comment}\ny = 2\n"
    line = jupytext.reads(text, "py:percent").cells[0].source.splitlines()[1]
    print(f"{comment!r} is read as {line!r}")
    changed.append(line != comment)
cell = new_code_cell("x = 1\n# %% mine\ny = 2", metadata={"nbgrader": {"grade_id": "answer"}})
notebook = jupytext.reads(jupytext.writes(new_notebook(cells=[cell]), "py:percent"), "py:percent")
cells = [(c.source, "nbgrader" in c.metadata) for c in notebook.cells]
print("one cell comes back as", cells)
if changed != [True, True, True, True, False, False] or cells != [("x = 1", True), ("y = 2", False)]:
    raise SystemExit("jupytext now reads comments otherwise.")
EOF
