#!/usr/bin/env bash
# Surprise: pyrr==0.10.3: Matrix33.from_z_rotation(a) and Quaternion.from_z_rotation(a) turn a vector in opposite
# directions when each is applied by the library's own `*`; converting the quaternion to a matrix turns it round too.
# Guess: one library, one angle, one axis, one rotation.
# Seen: for a = 0.3, x goes to y = -0.2955 by the matrix (made or converted) and to y = +0.2955 by the quaternion. With
# a vector of integers the quaternion's product is cut off to integers: [0, 0, 0].
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps pyrr==0.10.3 numpy==2.4.6 \
    multipledispatch==1.0.0 six==1.17.0
venv/bin/python - <<'EOF'
import numpy as np
from pyrr import Matrix33, Quaternion, Vector3

x, turn = Vector3([1.0, 0, 0]), Quaternion.from_z_rotation(0.3)
by_matrix, by_quaternion = Matrix33.from_z_rotation(0.3) * x, turn * x
converted, whole = Matrix33.from_quaternion(turn) * x, turn * Vector3([1, 0, 0])
print("matrix:", by_matrix, "quaternion:", by_quaternion, "quaternion as matrix:", converted, "integers:", whole)
seen = np.round([by_matrix[1], by_quaternion[1], converted[1]], 4).tolist()
if seen != [-0.2955, 0.2955, -0.2955] or whole.tolist() != [0, 0, 0]:
    raise SystemExit("pyrr's matrices and quaternions now turn otherwise.")
EOF
