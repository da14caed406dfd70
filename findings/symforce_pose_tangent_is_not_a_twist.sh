#!/usr/bin/env bash
# Surprise: symforce-sym==0.12.0: Pose3.to_tangent is not the logarithm of SE(3): its last three numbers are the
# translation as it stands. Pose3 composes like SE(3), so twice the tangent is not the pose applied twice.
# Guess: (rotation vector, V^-1 t), as in gtsam, Pinocchio and SciPy.
# Seen: 1 rad about z and (1, 2, 3) has the tangent 0 0 1 1 2 3 (SciPy: 0 0 1 1.9152 1.3305 3); from_tangent(2 *
# tangent) is over a metre from pose * pose.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check symforce-sym==0.12.0 numpy==2.4.6 scipy==1.17.1
venv/bin/python - <<'EOF'
import numpy as np
import sym
from scipy.spatial.transform import RigidTransform, Rotation

turn, translation = np.array([0, 0, 1.0]), np.array([1.0, 2, 3])
pose = sym.Pose3(sym.Rot3.from_tangent(turn), translation)
tangent = np.array(pose.to_tangent())
log = RigidTransform.from_components(translation, Rotation.from_rotvec(turn)).as_exp_coords()
apart = np.linalg.norm(np.ravel(sym.Pose3.from_tangent(2 * tangent).t) - np.ravel((pose * pose).t))
print("tangent:", tangent, "SciPy's logarithm:", np.round(log, 4))
print(f"twice the tangent and the pose applied twice: {apart:.3f} m apart")
if not (np.allclose(tangent, [0, 0, 1, 1, 2, 3]) and not np.allclose(log, tangent) and apart > 1):
    raise SystemExit("SymForce's Pose3 now has another tangent.")
EOF
