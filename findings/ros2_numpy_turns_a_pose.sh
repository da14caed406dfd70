#!/usr/bin/env bash
# Surprise: ros2_numpy==0.0.5 with transformations==2026.1.18 and ros-geometry-msgs@5.5.1: the matrix of a Pose or a Transform has another
# orientation than the message. It hands the quaternion to a library that has w first in ROS's order, w last. The way back from a matrix
# has the order right for a Transform, and wrong for a Pose, so that a Pose that is not turned comes back turned by half a turn about x.
# ros_numpy, of which it is made, gives the right ones with ROS 1.
# Guess: numpify gives the matrix of the pose, as its documentation says, and msgify(Pose, numpify(pose)) the pose.
# Seen: a quarter turn about z: the x axis of the matrix is (-1, 0, 0), and not (0, 1, 0). No turn: half a turn about z. From the identity
# msgify makes a Pose whose quaternion (x, y, z, w) is 1, 0, 0, 0, and a Transform whose quaternion is 0, 0, 0, 1.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet numpy==2.4.6 transformations==2026.1.18
venv/bin/pip install --quiet --no-deps ros2_numpy==0.0.5 ros-geometry-msgs==5.5.1 ros-rosidl-parser==4.9.5 \
    ros-std-msgs==5.5.1 ros-sensor-msgs==5.5.1 ros-nav-msgs==5.5.1 ros-builtin-interfaces==2.3.0
cat > run.py <<'EOF'
import numpy as np
from geometry_msgs.msg import Pose, Quaternion, Transform
from ros2_numpy import msgify, numpify

h = np.sqrt(0.5)
quarter, none = Pose(orientation=Quaternion(x=0.0, y=0.0, z=h, w=h)), Pose(orientation=Quaternion(x=0.0, y=0.0, z=0.0, w=1.0))
x_axes = [(numpify(pose)[:3, 0].round(6) + 0).tolist() for pose in (quarter, none)]
made = [msgify(Pose, np.eye(4)).orientation, msgify(Transform, np.eye(4)).rotation]
made = [[float(getattr(q, name)) for name in "xyzw"] for q in made]
print("x axis of the matrix: of a quarter turn about z", x_axes[0], "and of no turn", x_axes[1])
print("x, y, z, w made of the identity: of a Pose", made[0], "and of a Transform", made[1])
if x_axes != [[-1, 0, 0], [-1, 0, 0]] or np.abs(made).tolist() != [[1, 0, 0, 0], [0, 0, 0, 1]]:
    raise SystemExit("What ros2_numpy makes of a pose is another thing now.")
EOF
venv/bin/python run.py
