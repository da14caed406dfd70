#!/usr/bin/env bash
# Surprise: nbgrader==0.9.6: `nbgrader export` writes cells as they are, without quotes: a name with a comma moves all that
# follows by one column, so a spreadsheet or an LMS reads everything behind it, the points among it, out of another column.
# Guess: a table that is called CSV is written with quotes where a cell holds a comma.
# Seen: for the last name "Davis, Jr." the row has one cell more than the head, and the last name is read as Davis.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check nbgrader==0.9.6
PATH="$work/venv/bin:$PATH" python - <<'EOF'
import csv

from nbgrader.api import Gradebook
from nbgrader.plugins import CsvExportPlugin

with Gradebook("sqlite:///gradebook.db") as gradebook:
    gradebook.add_assignment("one")
    gradebook.add_student("sammy", first_name="Sammy", last_name="Davis, Jr.")
    gradebook.add_submission("one", "sammy")
    exporter = CsvExportPlugin()
    exporter.to = "grades.csv"
    exporter.export(gradebook)
text = open("grades.csv").read()
print(text)
head, row = csv.reader(text.splitlines())
print(len(head), "columns in the head,", len(row), "in the row; last name:", dict(zip(head, row))["last_name"])
if len(row) != len(head) + 1 or dict(zip(head, row))["last_name"] != "Davis":
    raise SystemExit("nbgrader now writes a name with a comma otherwise.")
EOF
