#!/usr/bin/env bash
# Surprise: pythreejs==2.4.2: in Python an Object3D's rotation, quaternion and matrix are three unconnected values. One
# object can be turned by 1.5 rad, not turned, and have yet another matrix; only a browser connects them, as the last
# one to be sent wins.
# Guess: as in three.js, whichever is set, the others follow.
# Seen: rotation 1.5 about x leaves the quaternion 0 0 0 1; a new quaternion leaves the rotation; a new matrix and
# rotateZ leave both and the position.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check pythreejs==2.4.2 ipywidgets==8.1.9 numpy==2.4.6
venv/bin/python -W ignore - <<'EOF'
from pythreejs import Object3D

thing, seen = Object3D(), []
thing.rotation = (1.5, 0, 0, "XYZ")
seen.append(thing.quaternion)
thing.quaternion = (0, 0, 1, 0)
seen.append(thing.rotation)
thing.matrix = (0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1)
seen.append((thing.position, thing.quaternion))
other = Object3D()
other.rotateZ(1.0)
seen.append((other.rotation, other.quaternion))
print(*seen, sep="\n")
none = ((0, 0, 0, "XYZ"), (0, 0, 0, 1))
if seen != [(0, 0, 0, 1), (1.5, 0, 0, "XYZ"), ((0, 0, 0), (0, 0, 1, 0)), none]:
    raise SystemExit("pythreejs now connects rotation, quaternion and matrix in Python.")
EOF
