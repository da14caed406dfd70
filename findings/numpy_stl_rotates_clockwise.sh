#!/usr/bin/env bash
# Surprise: numpy-stl==4.1.1: Mesh.rotate([0, 0, 1], +90 degrees) turns the part clockwise, and rotate_using_matrix(R)
# applies R's transpose; Mesh.transform(T) of the same class, with the same R inside, turns it the right way.
# Guess: right-handed, as the axis and the angle say.
# Seen: (1, 0, 0) goes to (0, -1, 0) by rotate and by rotate_using_matrix, to (0, 1, 0) by transform.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps numpy-stl==4.1.1 python-utils==4.2.0 \
    typing_extensions==4.16.0 numpy==2.4.6
venv/bin/python - <<'EOF'
import numpy as np
from stl.mesh import Mesh

quarter = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
ends = []
for method, argument in (
    ("rotate", ([0, 0, 1], np.pi / 2)),
    ("rotate_using_matrix", (quarter[:3, :3],)),
    ("transform", (quarter,)),
):
    corners = np.zeros(1, Mesh.dtype)
    corners["vectors"][0] = np.eye(3)
    part = Mesh(corners)
    getattr(part, method)(*argument)
    ends.append(np.round(part.vectors[0][0], 6).tolist())
    print(f"{method}: x goes to {ends[-1]}")
if not np.array_equal(ends, [[0, -1, 0], [0, -1, 0], [0, 1, 0]]):
    raise SystemExit("numpy-stl now turns otherwise.")
EOF
