#!/usr/bin/env bash
# Surprise: mujoco==4.0.0: with a model edited in Python, body.alt.euler = [20, 40, 60] is stored, can be read back, and
# is not used: the body compiles with the identity. It counts only after alt.type is set too; as a keyword of add_body
# it counts at once.
# Guess: setting the angles sets the orientation.
# Seen: quaternion 1 0 0 0 without alt.type; 0.7717 0.3097 0.2101 0.5141 with it, and by keyword. The same for
# axisangle, xyaxes and zaxis.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps mujoco==4.0.0 mujoco-core==4.0.0 numpy==2.4.6
venv/bin/python - <<'EOF'
import mujoco
import numpy as np


def compiled(attribute, value, kind=None, **keywords):
    spec = mujoco.MjSpec()
    body = spec.worldbody.add_body(name="tool", **keywords)
    body.add_geom(size=[0.1, 0.1, 0.1])
    if not keywords:
        setattr(body.alt, attribute, value)
        if kind is not None:
            body.alt.type = kind
    return np.round(spec.compile().body("tool").quat, 4).tolist()


angles, seen = [20, 40, 60], [0.7717, 0.3097, 0.2101, 0.5141]
alone = [compiled(*pair) for pair in (("euler", angles), ("axisangle", [0, 0, 1, 90]), ("zaxis", [1, 0, 0]))]
typed = compiled("euler", angles, mujoco.mjtOrientation.mjORIENTATION_EULER)
keyword = compiled("euler", angles, euler=angles)
print("alt.euler, alt.axisangle, alt.zaxis alone:", *alone, "\nwith alt.type:", typed, "\nby keyword:", keyword)
if alone != [[1, 0, 0, 0]] * 3 or typed != seen or keyword != seen:
    raise SystemExit("MuJoCo's spec now takes orientations otherwise.")
EOF
