#!/usr/bin/env bash
# Surprise: spatialmath-python==1.1.18: base.trlog of a rotation a ten-millionth of a radian short of a half turn is off
# by a milliradian: ten thousand times the distance to the half turn, and a billion times SciPy's error. Exact half
# turns are right.
# Guess: logarithms lose a few digits near pi; 1e-7 rad perhaps, as other libraries did.
# Seen: axis (1, -2, 3): error below 1e-8 rad at 1e-3 from pi, 1e-4 rad at 1e-6, 1e-3 rad at 1e-7, below 1e-12 at pi.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check spatialmath-python==1.1.18 numpy==2.4.6 scipy==1.17.1
venv/bin/python - <<'EOF'
from math import pi

import numpy as np
from scipy.spatial.transform import Rotation
from spatialmath.base import trlog

axis, errors = np.array([1, -2, 3]) / 14**0.5, {}
for short in (1e-3, 1e-5, 1e-6, 1e-7, 0):
    turn = Rotation.from_rotvec((pi - short) * axis)
    log = trlog(turn.as_matrix(), twist=True, check=False)
    errors[short] = (Rotation.from_rotvec(log) * turn.inv()).magnitude()
    scipy = (Rotation.from_rotvec(Rotation.from_matrix(turn.as_matrix()).as_rotvec()) * turn.inv()).magnitude()
    print(f"pi - {short:.0e}: off by {errors[short]:.1e} rad (SciPy {scipy:.1e})")
if not (errors[1e-3] < 1e-8 and errors[1e-6] > 1e-5 and errors[1e-7] > 1e-4 and errors[0] < 1e-12):
    raise SystemExit("spatialmath's logarithm now has other errors near a half turn.")
EOF
