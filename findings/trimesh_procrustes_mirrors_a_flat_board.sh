#!/usr/bin/env bash
# Surprise: trimesh==5.2.0: registration.procrustes between a flat calibration board and the same board moved rigidly
# returns, about every second time, a mirror image (determinant -1) as "the" transform, with cost zero.
# Guess: what moved rigidly is answered by a rigid motion.
# Seen: 0 < mirror images < 200 of 200 random motions, every cost below 1e-20. A board cannot tell the side it is seen
# from, and reflection=True is the default; with reflection=False all 200 are rotations.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps trimesh==5.2.0 numpy==2.4.6 scipy==1.17.1
venv/bin/python - <<'EOF'
import numpy as np
from trimesh import registration, transform_points
from trimesh.transformations import random_rotation_matrix

random = np.random.default_rng(0)
corners = np.stack([*np.mgrid[0:6, 0:4].reshape(2, -1) * 0.03, np.zeros(24)], axis=1)
mirrors, rotations, cost = 0, 0, 0
for _ in range(200):
    motion = random_rotation_matrix(random.random(3))
    motion[:3, 3] = random.random(3)
    moved = transform_points(corners, motion)
    found, _, error = registration.procrustes(corners, moved, scale=False)
    rigid, *_ = registration.procrustes(corners, moved, scale=False, reflection=False)
    mirrors += np.linalg.det(found[:3, :3]) < 0
    rotations += np.linalg.det(rigid[:3, :3]) > 0
    cost = max(cost, error)
print(f"mirror images: {mirrors} of 200; greatest cost {cost:.1e}; rotations with reflection=False: {rotations}")
if not (0 < mirrors < 200 and cost < 1e-20 and rotations == 200):
    raise SystemExit("trimesh no longer answers the motion of a flat board with mirror images of cost zero.")
EOF
