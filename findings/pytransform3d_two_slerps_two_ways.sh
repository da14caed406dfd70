#!/usr/bin/env bash
# Surprise: pytransform3d==3.17.0: halfway between the same two orientations is 5.7 degrees by pq_slerp and by
# dual_quaternion_sclerp but 174.3 degrees the other way round by quaternion_slerp: it alone takes the long way when w <
# 0.
# Guess: every interpolation of the library takes the short way, as SciPy's and ROS's do.
# Seen: between 1 0 0 0 and the negated quaternion of 11.5 degrees; shortest_path=True, off by default, agrees with the
# others.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps pytransform3d==3.17.0 lxml==6.1.3 scipy==1.17.1 \
    numpy==2.4.6
venv/bin/python - <<'EOF'
import numpy as np
from pytransform3d.rotations import quaternion_slerp
from pytransform3d.transformations import dual_quaternion_sclerp, pq_slerp

start, end = np.array([1.0, 0, 0, 0]), -np.array([np.cos(0.1), 0, 0, np.sin(0.1)])
halfway = {
    "quaternion_slerp": quaternion_slerp(start, end, 0.5),
    "quaternion_slerp, shortest_path": quaternion_slerp(start, end, 0.5, shortest_path=True),
    "pq_slerp": pq_slerp(np.r_[0, 0, 0, start], np.r_[0, 0, 0, end], 0.5)[3:],
    "dual_quaternion_sclerp": dual_quaternion_sclerp(np.r_[start, 0, 0, 0, 0], np.r_[end, 0, 0, 0, 0], 0.5)[:4],
}
degrees = []
for name, quaternion in halfway.items():
    degrees.append(round(float(np.degrees(2 * np.arccos(min(1, abs(quaternion[0]))))), 1))
    print(f"{name}: {np.round(quaternion, 5)}, {degrees[-1]} degrees from the start")
if degrees != [174.3, 5.7, 5.7, 5.7]:
    raise SystemExit("pytransform3d's interpolations now take other ways.")
EOF
