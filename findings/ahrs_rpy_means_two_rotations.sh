#!/usr/bin/env bash
# Surprise: ahrs==0.4.0: DCM(rpy=angles) and Quaternion(rpy=angles) are different rotations: the matrix class takes yaw,
# pitch and roll in the other order than the quaternion class.
# Guess: the same keyword with the same three angles in one library is one rotation.
# Seen: for 0.1, 0.2, 0.3 they are 17.7 degrees apart; the matrix equals the quaternion of 0.3, 0.2, 0.1.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps ahrs==0.4.0 numpy==2.4.6
venv/bin/python - <<'EOF'
import numpy as np
from ahrs import DCM, Quaternion

angles = [0.1, 0.2, 0.3]
matrix, quaternion = np.array(DCM(rpy=angles)), Quaternion(rpy=angles).to_DCM()
swapped = Quaternion(rpy=angles[::-1]).to_DCM()
apart = np.degrees(np.arccos((np.trace(matrix.T @ quaternion) - 1) / 2))
print("DCM:\n", np.round(matrix, 4), "\nQuaternion:\n", np.round(quaternion, 4), f"\napart: {apart:.1f} degrees")
print("DCM equals the quaternion of the reversed angles:", np.allclose(matrix, swapped))
if not (np.allclose(matrix, swapped) and round(apart, 1) == 17.7):
    raise SystemExit("ahrs now reads roll, pitch and yaw otherwise.")
EOF
