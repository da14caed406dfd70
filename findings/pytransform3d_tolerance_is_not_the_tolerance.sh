#!/usr/bin/env bash
# Surprise: pytransform3d@3.17.0: check_matrix(R, tolerance=1e-6) takes a matrix whose axis is 0.000004 too long, so that R.T @ R
# is off by 0.000008: the tolerance is passed on as the absolute one alone, and NumPy's relative one of 0.00001 is added to it.
# Even tolerance=0 takes it. Off the diagonal, where a relative tolerance is worth nothing, 0.000008 is refused.
# Guess: ValueError for both.
# Seen: the longer axis is taken, the leaning one is refused.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check pytransform3d==3.17.0 numpy==2.4.6 scipy==1.17.1
venv/bin/python - <<'EOF'
import numpy as np
from pytransform3d.rotations import check_matrix


def refused(R, tolerance):
    try:
        check_matrix(R, tolerance=tolerance)
    except ValueError:
        return True
    return False


longer, leaning = np.diag([1 + 4e-6, 1, 1]), np.eye(3)
leaning[0, 1] = 8e-6
for name, R in (("longer", longer), ("leaning", leaning)):
    print(name, "off by", np.abs(R.T @ R - np.eye(3)).max(), "refused at 1e-6:", refused(R, 1e-6), "at 0:", refused(R, 0))
if [refused(R, tolerance) for R in (longer, leaning) for tolerance in (1e-6, 0)] != [False, False, True, True]:
    raise SystemExit("pytransform3d now has another tolerance.")
EOF
