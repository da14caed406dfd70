#!/usr/bin/env bash
# Surprise: pyquaternion==0.9.9: Quaternion.slerp writes into its arguments. To go the short way it turns q0 itself into
# -q0, so the caller's start is not the start any more; it also normalises both.
# Guess: interpolating between two quaternions leaves them alone.
# Seen: after slerp(start, end) with end on the other half of the sphere, start == -(what it was); a property that is
# only read, rotation_matrix, rescales the quaternion (1, 1, 0, 0) to unit length as well.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps pyquaternion==0.9.9 numpy==2.4.6
venv/bin/python - <<'EOF'
import numpy as np
from pyquaternion import Quaternion

start, end = Quaternion(axis=[0, 0, 1], degrees=10), -Quaternion(axis=[0, 0, 1], degrees=20)
before = start.elements.copy()
Quaternion.slerp(start, end, 0.5)
print("before:", before, "after:", start.elements)
long = Quaternion(1, 1, 0, 0)
long.rotation_matrix
print("(1, 1, 0, 0) once its matrix was read:", long.elements)
if not (np.allclose(start.elements, -before) and np.allclose(long.elements, [0.5**0.5, 0.5**0.5, 0, 0])):
    raise SystemExit("pyquaternion no longer changes the quaternions that it is asked about.")
EOF
