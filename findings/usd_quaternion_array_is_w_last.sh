#!/usr/bin/env bash
# Surprise: usd-core==26.11: a quaternion is constructed and printed w first, Gf.Quatf(w, x, y, z), but an array of them
# is x, y, z, w as soon as NumPy sees it, in both directions, silently.
# Guess: numpy.array of QuatfArray([Quatf(1, 2, 3, 4)]) is [[1, 2, 3, 4]], as it is for vectors.
# Seen: [[2, 3, 4, 1]]; and FromNumpy([[1, 2, 3, 4]]) prints as (4, 1, 2, 3).
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check usd-core==26.11 numpy==2.4.6
venv/bin/python - <<'EOF'
import numpy as np
from pxr import Gf, Vt

quaternion = Gf.Quatf(1, 2, 3, 4)
out = np.array(Vt.QuatfArray([quaternion])).tolist()
back = Vt.QuatfArray.FromNumpy(np.array([[1, 2, 3, 4]], np.float32))[0]
print("printed:", quaternion, "in an array for NumPy:", out, "NumPy's 1 2 3 4 read back:", back)
if (str(quaternion), out, str(back)) != ("(1, 2, 3, 4)", [[2, 3, 4, 1]], "(4, 1, 2, 3)"):
    raise SystemExit("USD now orders the quaternions of an array otherwise.")
EOF
