#!/usr/bin/env bash
# Surprise: pin==4.1.0 (Pinocchio): `pose * p` moves a point of 3 numbers, but a homogeneous point of 4, or a 4x4
# matrix, is multiplied element by element: the pose turns into a NumPy array without a word, and the answer is 4x4
# numbers.
# Guess: the product (as with @), or an error.
# Seen: pose * [1, 2, 3, 1] has shape (4, 4), its columns scaled by 1, 2, 3, 1; pose @ [1, 2, 3, 1] is the moved point.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check pin==4.1.0 numpy==2.4.6
venv/bin/python - <<'EOF'
import numpy as np
import pinocchio

pose = pinocchio.SE3(pinocchio.utils.rotate("z", np.pi / 2), np.array([1.0, 0, 0]))
point = np.array([1.0, 2, 3])
homogeneous = np.append(point, 1)
moved, scaled = pose * point, pose * homogeneous
print("pose * point:", moved, "\npose * homogeneous point:\n", scaled)
print("pose @ homogeneous point:", pose @ homogeneous)
elementwise = np.array_equal(scaled, pose.homogeneous * homogeneous)
elementwise &= np.array_equal(pose * np.eye(4), np.diag(np.diag(pose.homogeneous)))
if not (np.allclose(moved, [-1, 1, 3]) and elementwise):
    raise SystemExit("Pinocchio now multiplies a pose and an array otherwise.")
EOF
