#!/usr/bin/env bash
# Surprise: yourdfpy==0.0.60 (trimesh==5.2.0, pycollada==0.9.3): a COLLADA mesh says in its <unit> that its numbers are
# inches and in its <up_axis> that y is up. yourdfpy draws one inch as one metre, 39 times too large, and y stays y.
# Guess: 1 x 2 inches come out as 0.0254 x 0.0508 m.
# Seen: bounds 1 x 2 in x and y, the scene's `units` the text "0.0254 * meters", neither applied.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps yourdfpy==0.0.60 trimesh==5.2.0 pycollada==0.9.3 \
    python-dateutil==2.9.0.post0 lxml==6.1.3 six==1.17.0 numpy==2.4.6
cat > plate.dae <<'EOF'
<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><created>2020-01-01T00:00:00Z</created><modified>2020-01-01T00:00:00Z</modified>
<unit name="inch" meter="0.0254"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="plate"><mesh>
<source id="corners"><float_array id="numbers" count="9">0 0 0 1 0 0 0 2 0</float_array><technique_common>
<accessor source="#numbers" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="vertices"><input semantic="POSITION" source="#corners"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#vertices" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="scene"><node><instance_geometry url="#plate"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#scene"/></scene></COLLADA>
EOF
cat > robot.urdf <<'EOF'
<robot name="plate"><link name="base"><visual><geometry><mesh filename="plate.dae"/></geometry></visual></link></robot>
EOF
venv/bin/python - <<'EOF'
import yourdfpy

scene = yourdfpy.URDF.load("robot.urdf").scene
low, high = scene.bounds
print("size:", (high - low).tolist(), "units:", scene.units)
if (high - low).tolist() != [1, 2, 0] or scene.units != "0.0254 * meters":
    raise SystemExit("yourdfpy or trimesh now treats the unit or the up axis of a COLLADA mesh otherwise.")
EOF
