#!/usr/bin/env bash
# Surprise: rosbags==0.11.9: a covariance given as an integer array, numpy.eye(6, dtype=int), is written into
# float64[36] bit for bit: every 1 arrives as 4.9e-324. Integers in the scalar fields of the same message arrive as the
# numbers they are.
# Guess: converted like the scalars, or refused (a float32 array and a list are).
# Seen: pose.position.x = 1 arrives as 1.0; the covariance's diagonal as 5e-324, in ROS 1 and in ROS 2 messages.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install -q --disable-pip-version-check --no-deps rosbags==0.11.9 numpy==2.4.6
venv/bin/python - <<'EOF'
import numpy as np
from rosbags.typesys import Stores, get_typestore

arrived = []
for name in (Stores.ROS1_NOETIC, Stores.ROS2_HUMBLE):
    store = get_typestore(name)
    point, quaternion, pose, message = (
        store.types["geometry_msgs/msg/" + kind] for kind in ("Point", "Quaternion", "Pose", "PoseWithCovariance")
    )
    sent = message(pose(point(1, 2, 3), quaternion(0, 0, 0, 1)), np.eye(6, dtype=np.int64).ravel())
    ros = "ros1" if name == Stores.ROS1_NOETIC else "cdr"
    data = getattr(store, "serialize_" + ros)(sent, message.__msgtype__)
    received = getattr(store, "deserialize_" + ros)(data, message.__msgtype__)
    arrived.append((float(received.pose.position.x), float(received.covariance[0])))
    print(name.name, "position.x, covariance[0]:", *arrived[-1])
if arrived != [(1.0, 5e-324)] * 2:
    raise SystemExit("rosbags now writes integer arrays otherwise.")
EOF
