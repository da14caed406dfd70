#!/usr/bin/env bash
# Surprise: vispy==0.17.0: Quaternion.create_from_euler_angles(rx, ry, rz): rz turns about x, and rx about z. And the
# matrix of a quaternion, put into vispy's own MatrixTransform, turns the other way than the quaternion does.
# Guess: rz=90 degrees takes x to y; so does the MatrixTransform of a quarter turn about z.
# Seen: rz=90 is the quaternion w=0.707, x=0.707; the quarter turn takes x to +y as a quaternion, to -y as a transform.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps vispy==0.17.0 hsluv==5.0.4 packaging==25.0 numpy==2.4.6
venv/bin/python - <<'EOF'
from math import pi

import numpy as np
from vispy.util.quaternion import Quaternion
from vispy.visuals.transforms import MatrixTransform

rz = Quaternion.create_from_euler_angles(0, 0, 90, degrees=True)
rx = Quaternion.create_from_euler_angles(90, 0, 0, degrees=True)
print("rz=90:", rz, "rx=90:", rx)
quarter = Quaternion.create_from_axis_angle(pi / 2, 0, 0, 1)
turned, mapped = quarter.rotate_point([1, 0, 0]), MatrixTransform(quarter.get_matrix()).map([1, 0, 0])
print("x by the quaternion:", np.round(turned, 6), "by the transform:", np.round(mapped[:3], 6))
half = 0.5**0.5
axes = np.allclose([rz.w, rz.x], half) and np.allclose([rx.w, rx.z], half)
if not (axes and np.allclose(turned, [0, 1, 0]) and np.allclose(mapped[:3], [0, -1, 0])):
    raise SystemExit("vispy now has other axes or directions.")
EOF
