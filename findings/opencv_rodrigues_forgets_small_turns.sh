#!/usr/bin/env bash
# Surprise: opencv-python-headless==5.0.0.93: Rodrigues(R) answers exactly zero for every rotation of up to some 1e-5
# rad, in double precision, in the direction matrix -> vector only: increments of a tracker vanish instead of adding up.
# Guess: the matrix holds the angle with 16 digits; 1e-5 rad come back, as in SciPy, to 1e-16.
# Seen: from a vector of 1e-5 rad the matrix is right, and back from it the vector is 0, 0, 0; 1e-4 rad come back.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps opencv-python-headless==5.0.0.93 numpy==2.4.6
venv/bin/python - <<'EOF'
import cv2
import numpy as np

axis, back = np.array([1, -2, 3]) / 14**0.5, {}
for angle in (1e-4, 1e-5, 1e-6):
    R, _ = cv2.Rodrigues(angle * axis)
    kept = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]]) / 2  # sin(angle) * axis
    back[angle] = np.linalg.norm(cv2.Rodrigues(R)[0])
    print(f"{angle:.0e} rad: the matrix holds {np.linalg.norm(kept):.12e}, Rodrigues finds {back[angle]:.12e}")
if abs(back[1e-4] - 1e-4) > 1e-10 or back[1e-5] or back[1e-6]:
    raise SystemExit("OpenCV now finds other small rotations.")
EOF
