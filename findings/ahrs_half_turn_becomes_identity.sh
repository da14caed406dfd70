#!/usr/bin/env bash
# Surprise: ahrs==0.4.0: three of its five conversions of a rotation matrix to a quaternion are wrong for exact half
# turns: chiaverini answers the identity for every one of them, hughes and sarabandi lose the axis's relative signs.
# Guess: methods that are named after papers, side by side in one module, agree on every rotation to rounding.
# Seen: half turn about (1, -2, 3): chiaverini 1 0 0 0, hughes axis (1, 2, 3), sarabandi (1, 2, 3); shepperd and itzhack
# right.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps ahrs==0.4.0 numpy==2.4.6
venv/bin/python - <<'EOF'
import numpy as np
from ahrs.common import orientation

axis = np.array([1, -2, 3]) / 14**0.5
half_turn = 2 * np.outer(axis, axis) - np.eye(3)
seen = {}
for name in ("chiaverini", "hughes", "sarabandi", "shepperd", "itzhack"):
    quaternion = getattr(orientation, name)(half_turn)
    print(f"{name:10}", np.round(quaternion, 4))
    seen[name] = abs(quaternion @ [0, *axis])  # 1 where it is the half turn, whatever its sign
right = [name for name, overlap in seen.items() if abs(overlap - 1) < 1e-6]
if right != ["shepperd", "itzhack"] or not np.allclose(orientation.chiaverini(half_turn), [1, 0, 0, 0]):
    raise SystemExit("ahrs now converts a half turn otherwise.")
EOF
