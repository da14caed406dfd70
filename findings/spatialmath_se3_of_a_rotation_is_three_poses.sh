#!/usr/bin/env bash
# Surprise: spatialmath-python==1.1.18: SE3(R) of a 3x3 rotation matrix is no pose with that rotation but three poses
# without any: each row is read as a translation. SO3(R) and SE3.Rt(R) read the same array as a rotation.
# Guess: the pose with rotation R and no translation, or an error.
# Seen: len(SE3(R)) == 3, every rotation the identity, the translations R's rows.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check spatialmath-python==1.1.18 numpy==2.4.6 scipy==1.17.1
venv/bin/python - <<'EOF'
import numpy as np
from spatialmath import SE3, SO3

R = SO3.Rz(0.3).R
poses = SE3(R)
print("SE3(R) is", len(poses), "poses, the first:\n", poses[0].A, "\nSE3.Rt(R, 0) is", len(SE3.Rt(R, [0, 0, 0])))
plain = all(np.array_equal(pose.R, np.eye(3)) for pose in poses)
if len(poses) != 3 or not plain or not np.array_equal([pose.t for pose in poses], R):
    raise SystemExit("spatialmath now reads a 3x3 matrix otherwise.")
EOF
