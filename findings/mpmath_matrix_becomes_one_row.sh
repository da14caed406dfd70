#!/usr/bin/env bash
# Surprise: mpmath@1.3.0 with numpy@2.4.6: np.array of an mpmath matrix of 3 rows and 3 columns is one row of 9 numbers, without a
# word. Its length is 3, but it is gone through number by number. Its tolist has the rows.
# Guess: shape (3, 3), as of SymPy's matrices, whose numbers are mpmath's.
# Seen: (9,); of tolist(), (3, 3).
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check mpmath==1.3.0 numpy==2.4.6
venv/bin/python - <<'EOF'
import mpmath
import numpy as np

R = mpmath.matrix([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
shapes = np.array(R).shape, np.array(R.tolist()).shape
print(f"{R.rows} rows, {R.cols} columns, length {len(R)}; as an array", *shapes)
if shapes != ((9,), (3, 3)):
    raise SystemExit("An mpmath matrix now becomes another array.")
EOF
