#!/usr/bin/env bash
# Surprise: scipy 1.16.3 and 1.17.1: Rotation.from_euler("z", [10, 20]) was two rotations about z until 1.16; 1.17
# raises ("last dimension of `angles`"), and a list of one angle, which was a stack of one rotation, is now a single
# rotation.
# Guess: a minor release keeps the call that tutorials show for "one axis, many angles".
# Seen: shapes of as_matrix for 10, [10], [10, 20], [[10], [20]]: (3, 3) (1, 3, 3) (2, 3, 3) (2, 3, 3) in 1.16.3; (3, 3)
# (3, 3) ValueError (2, 3, 3) in 1.17.1. The last form works in both.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
cat > shapes.py <<'EOF'
import scipy
from scipy.spatial.transform import Rotation

shapes = []
for angles in (10, [10], [10, 20], [[10], [20]]):
    try:
        shapes.append(str(Rotation.from_euler("z", angles, degrees=True).as_matrix().shape))
    except ValueError:
        shapes.append("ValueError")
print(scipy.__version__, *shapes)
EOF
for version in 1.16.3 1.17.1; do
    python3 -m venv --clear venv
    venv/bin/pip install -q --disable-pip-version-check scipy==$version numpy==2.3.5
    venv/bin/python shapes.py | tee -a seen
done
diff seen - <<'EOF' || { echo "SciPy now takes a list of angles about one axis otherwise." >&2; exit 1; }
1.16.3 (3, 3) (1, 3, 3) (2, 3, 3) (2, 3, 3)
1.17.1 (3, 3) (3, 3) ValueError (2, 3, 3)
EOF
