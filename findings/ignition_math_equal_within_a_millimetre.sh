#!/usr/bin/env bash
# Surprise: Debian 12's Gazebo mathematics (python3-ignition-math, libignition-math6-6 ==6.10.0+ds3-7+b4): == between
# two vectors, quaternions or poses is true up to a difference of 0.001, a millimetre or 0.1 degrees; between two
# matrices up to 1e-6. So two poses can be equal while their matrices are not, and equality is not transitive.
# Guess: == is exact, or of one tolerance near 1e-6 throughout.
# Seen: 0.9 mm apart: vector, quaternion and pose equal, matrix different; 2 mm: all different; 1e-7: all equal.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"; chmod 755 .
apt-get download -q python3-ignition-math=6.10.0+ds3-7+b4 libignition-math6-6=6.10.0+ds3-7+b4 > log 2>&1 ||
    { cat log; echo "Needs Debian 12, after apt-get update." >&2; exit 2; }
for package in *.deb; do dpkg -x "$package" root; done
export PYTHONPATH=$work/root/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$work/root/usr/lib/$(uname -m)-linux-gnu
/usr/bin/python3 - <<'EOF'
from ignition.math import Matrix4d, Pose3d, Quaterniond, Vector3d

seen = {}
for apart in (2e-3, 9e-4, 1e-7):
    here, there = Pose3d(0, 0, 0, 0, 0, 0), Pose3d(apart, 0, 0, 0, 0, 0)
    seen[apart] = (
        Vector3d(1, 2, 3) == Vector3d(1, 2, 3 + apart),
        Quaterniond(1, 0, 0, 0) == Quaterniond(1, 0, 0, apart),
        here == there,
        Matrix4d(here) == Matrix4d(there),
    )
    print(f"{apart:.0e} apart, equal as vector, quaternion, pose, matrix:", *seen[apart])
if seen != {2e-3: (False,) * 4, 9e-4: (True, True, True, False), 1e-7: (True,) * 4}:
    raise SystemExit("Ignition Math now compares with other tolerances.")
EOF
