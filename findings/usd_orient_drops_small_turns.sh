#!/usr/bin/env bash
# Surprise: usd-core==26.11: a prim's xformOp:orient loses small rotations. The op takes the angle as 2 acos(w), and w
# of a small turn rounds to 1. A point instancer reads the same quaternion correctly.
# Guess: a turn of 2 degrees stays 2 degrees in half precision to about 0.01; float keeps hundredths of a degree.
# Seen: half precision: 2 degrees become exactly 0 (instancer: 2.001); float: 0.03 degrees become 0.0396, 0.01 becomes
# 0.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check usd-core==26.11
venv/bin/python - <<'EOF'
from math import atan2, cos, degrees, radians, sin

from pxr import Gf, Usd, UsdGeom, Vt

stage = Usd.Stage.CreateInMemory()


def about_z(kind, angle):
    return kind(cos(radians(angle) / 2), 0, 0, sin(radians(angle) / 2))


def drawn(matrix):
    return round(degrees(atan2(matrix[0][1], matrix[0][0])), 4)  # USD multiplies row vectors


def orient(name, kind, precision, angle):
    prim = UsdGeom.Xform.Define(stage, "/" + name)
    prim.AddOrientOp(precision).Set(about_z(kind, angle))
    return drawn(prim.GetLocalTransformation())


half = orient("a", Gf.Quath, UsdGeom.XformOp.PrecisionHalf, 2)
floats = [orient(n, Gf.Quatf, UsdGeom.XformOp.PrecisionFloat, a) for n, a in (("b", 0.03), ("c", 0.01))]
instancer = UsdGeom.PointInstancer.Define(stage, "/instancer")
instancer.CreatePrototypesRel().AddTarget(UsdGeom.Cube.Define(stage, "/instancer/cube").GetPath())
instancer.CreateProtoIndicesAttr(Vt.IntArray([0]))
instancer.CreatePositionsAttr(Vt.Vec3fArray([(0, 0, 0)]))
instancer.CreateOrientationsAttr(Vt.QuathArray([about_z(Gf.Quath, 2)]))
instanced = drawn(instancer.ComputeInstanceTransformsAtTime(0, 0)[0])
print("2 degrees in half precision: prim", half, "instancer", instanced)
print("0.03 and 0.01 degrees in float:", *floats)
if (half, floats, round(instanced, 2)) != (0, [0.0396, 0], 2):
    raise SystemExit("USD's orient op now treats small rotations otherwise.")
EOF
