#!/usr/bin/env bash
# Surprise: yourdfpy==0.0.60, urchin==0.0.30, pytransform3d==3.17.0: a gripper's second finger (<mimic> multiplier 2,
# offset 0.01) is somewhere else in each of three readers of the same URDF, and none of them says so.
# Guess: finger 2 = 2 * finger 1 + 0.01 everywhere.
# Seen: with the first at 0.03: 0.07 in yourdfpy and urchin, 0 in pytransform3d (which leaves <mimic> out). At rest:
# 0.01 in yourdfpy, 0 in urchin, which forgets the offset until some joint is named (then 0.01).
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps yourdfpy==0.0.60 urchin==0.0.30 pytransform3d==3.17.0 \
    trimesh==5.2.0 networkx==3.6.1 pillow==12.1.0 lxml==6.1.3 six==1.17.0 scipy==1.17.1 numpy==2.4.6
cat > gripper.urdf <<'EOF'
<robot name="gripper"><link name="palm"/><link name="first"/><link name="second"/>
<joint name="finger_1" type="prismatic"><parent link="palm"/><child link="first"/><axis xyz="1 0 0"/>
<limit lower="0" upper="1" effort="1" velocity="1"/></joint>
<joint name="finger_2" type="prismatic"><parent link="palm"/><child link="second"/><axis xyz="1 0 0"/>
<limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="finger_1" multiplier="2" offset="0.01"/></joint>
</robot>
EOF
venv/bin/python -W ignore - <<'EOF'
import urchin
import yourdfpy
from pytransform3d.urdf import UrdfTransformManager

yours, urchins, manager = yourdfpy.URDF.load("gripper.urdf"), urchin.URDF.load("gripper.urdf"), UrdfTransformManager()
manager.load_urdf(open("gripper.urdf").read())


def places(opening):
    if opening is not None:
        yours.update_cfg({"finger_1": opening})
        manager.set_joint("finger_1", opening)
    poses = urchins.link_fk(cfg=None if opening is None else {"finger_1": opening}, use_names=True)
    second = yours.get_transform("second", "palm"), poses["second"], manager.get_transform("second", "palm")
    return [round(float(pose[0, 3]), 9) for pose in second]


seen = {opening: places(opening) for opening in (None, 0.0, 0.03)}
for opening, where in seen.items():
    print("first finger", opening, "-> second in yourdfpy, urchin, pytransform3d:", where)
if seen != {None: [0.01, 0, 0], 0.0: [0.01, 0.01, 0], 0.03: [0.07, 0.07, 0]}:
    raise SystemExit("One of the three now puts the mimicking finger elsewhere.")
EOF
