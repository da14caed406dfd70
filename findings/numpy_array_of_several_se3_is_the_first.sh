#!/usr/bin/env bash
# Surprise: spatialmath-python@1.1.18 with numpy@2.4.6: np.asarray of an SE3 that holds three poses has the shape (4, 4): the
# first pose alone, without a word. The object says that its length is 3, and has len, indices and iteration as a list has.
# np.array of a list with the same three poses keeps all.
# Guess: an array of shape (3, 4, 4), or an error.
# Seen: shape (4, 4), the first pose; of the list, (3, 4, 4).
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet spatialmath-python==1.1.18 numpy==2.4.6
cat > run.py <<'EOF'
import numpy as np
from spatialmath import SE3

path = SE3([SE3(0.1, 0, 0), SE3(0.2, 0, 0), SE3(0.3, 0, 0)])
alone, listed = np.asarray(path), np.array(list(path))
print(f"length {len(path)}; np.asarray has the shape {alone.shape}, x = {alone[0, 3]}; of a list, {listed.shape}")
if not (len(path) == 3 and alone.shape == (4, 4) and alone[0, 3] == 0.1 and listed.shape == (3, 4, 4)):
    raise SystemExit("An array of several poses is another one now.")
EOF
venv/bin/python run.py
