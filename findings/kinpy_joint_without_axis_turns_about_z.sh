#!/usr/bin/env bash
# Surprise: kinpy==0.6.1: a URDF joint that leaves its <axis> out turns about z. The URDF format's default is x, and
# yourdfpy 0.0.60 turns about x: one file, two robots.
# Guess: x in both.
# Seen: at a quarter turn the link's y axis points to -x in kinpy and to z in yourdfpy.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps kinpy==0.6.1 yourdfpy==0.0.60 trimesh==5.2.0 \
    transformations==2026.1.18 absl-py==2.5.1 pyyaml==6.0.4 lxml==6.1.3 six==1.17.0 scipy==1.17.1 numpy==2.4.6
cat > robot.urdf <<'EOF'
<robot name="wrist"><link name="base"/><link name="hand"/><joint name="turn" type="continuous">
<parent link="base"/><child link="hand"/></joint></robot>
EOF
venv/bin/python - <<'EOF'
from math import pi

import kinpy
import numpy as np
import yourdfpy

chain = kinpy.build_chain_from_urdf(open("robot.urdf").read())
by_kinpy = chain.forward_kinematics({"turn": pi / 2})["hand"].matrix()[:3, 1]
robot = yourdfpy.URDF.load("robot.urdf")
robot.update_cfg({"turn": pi / 2})
by_yourdfpy = robot.get_transform("hand", "base")[:3, 1]
print("the hand's y axis: kinpy", np.round(by_kinpy, 6), "yourdfpy", np.round(by_yourdfpy, 6))
if not (np.allclose(by_kinpy, [-1, 0, 0]) and np.allclose(by_yourdfpy, [0, 0, 1])):
    raise SystemExit("kinpy or yourdfpy now has another default axis.")
EOF
