#!/usr/bin/env bash
# Surprise: gtsam==4.3.0: writeG2o prints six significant digits, so a pose in map (UTM) coordinates comes back metres
# away from where it was, in a file that everything reads without complaint.
# Guess: a file of poses keeps what a double holds, or at least millimetres.
# Seen: y = 4649776.123 m is written as 4.64978e+06: the vehicle has moved by 3.9 m.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps gtsam==4.3.0 numpy==2.4.6
venv/bin/python - <<'EOF'
import gtsam
import numpy as np

position = np.array([500123.4567, 4649776.123, 12.3456789])
poses = gtsam.Values()
poses.insert(0, gtsam.Pose3(gtsam.Rot3.Ypr(0.1, 0.2, 0.3), position))
gtsam.writeG2o(gtsam.NonlinearFactorGraph(), poses, "map.g2o")
line = open("map.g2o").readline().split()
print(*line)
_, read = gtsam.readG2o("map.g2o", True)
error = read.atPose3(0).translation() - position
print("read back, off by (m):", np.round(error, 3))
if line[2:5] != ["500123", "4.64978e+06", "12.3457"] or not 3.8 < np.linalg.norm(error) < 4:
    raise SystemExit("gtsam now writes other digits into a g2o file.")
EOF
