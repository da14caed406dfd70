#!/usr/bin/env bash
# Surprise: nbgrader==0.9.6: a student who has one more notebook in the folder when it is submitted, such as Jupyter's
# Untitled.ipynb, never gets to see the feedback of the others: the list says "no feedback available", also after it was fetched.
# Guess: feedback that was released is shown; a notebook that is none of the assignment's has no say in that.
# Seen: two submissions of the same assignment, both with feedback for its notebook; the one with another notebook has none.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check nbgrader==0.9.6
export HOME="$work" JUPYTER_CONFIG_DIR="$work/none" PATH="$work/venv/bin:$PATH"
mkdir -m 777 exchange; mkdir -p source/one
cat >nbgrader_config.py <<EOF
c = get_config()
c.Exchange.root, c.CourseDirectory.course_id, c.ExchangeCollect.check_owner = "$work/exchange", "course", False
EOF
python -c 'import nbformat; nbformat.write(nbformat.v4.new_notebook(), "source/one/a.ipynb")'
{
  nbgrader generate_assignment one
  nbgrader release_assignment one
  for student in with without; do
    mkdir "$student"
    (
      cd "$student"
      export JUPYTER_DATA_DIR="$work/$student/data"
      cp ../nbgrader_config.py .
      nbgrader fetch_assignment one --student="$student"
      if [ "$student" = with ]; then cp one/a.ipynb one/Untitled.ipynb; fi
      nbgrader submit one --student="$student"
    )
  done
  nbgrader collect one
  nbgrader autograde one
  nbgrader generate_feedback one
  nbgrader release_feedback one
} >log 2>&1 || { cat log; exit 1; }
for student in with without; do
  (
    cd "$student"
    export JUPYTER_DATA_DIR="$work/$student/data"
    nbgrader fetch_feedback one --student="$student" >>../log 2>&1
    nbgrader list --cached --student="$student" 2>&1 | grep feedback | tee seen
    echo "  $student one more notebook, with these pages: $(cd one/feedback/*; ls | tr '\n' ' ')"
  )
done
grep -q "no feedback available" with/seen && grep -q "already fetched" without/seen ||
  { echo "nbgrader now shows feedback otherwise."; exit 1; }
