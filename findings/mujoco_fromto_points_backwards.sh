#!/usr/bin/env bash
# Surprise: mujoco==4.0.0: the frame of a geom or site given by fromto="A B" has its z axis pointing from B to A, though
# the XML reference says that +Z goes from the first point towards the second. A tool's site made that way approaches
# backwards.
# Guess: z is (0, 0, 1) for fromto="0 0 0 0 0 2".
# Seen: (0, 0, -1), a half turn about x, for capsule, cylinder, box and ellipsoid, geom and site.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps mujoco==4.0.0 mujoco-core==4.0.0 numpy==2.4.6
venv/bin/python - <<'EOF'
import mujoco
import numpy as np

SHAPE = '<{0} name="it" type="{1}" fromto="0 0 0 0 0 2" size="0.1"/>'
directions = []
for shape in ("capsule", "cylinder", "box", "ellipsoid"):
    parts = "".join(SHAPE.format(element, shape) for element in ("geom", "site"))
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{parts}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    for name, part in (("geom", data.geom("it")), ("site", data.site("it"))):
        directions.append(part.xmat.reshape(3, 3)[:, 2])
        print(f"{name} {shape:9} centre {part.xpos} z axis {np.round(directions[-1], 6)}")
if not np.allclose(directions, [0, 0, -1]):
    raise SystemExit("MuJoCo's fromto frames now point elsewhere.")
EOF
