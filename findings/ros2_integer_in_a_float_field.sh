#!/usr/bin/env bash
# Surprise: ros-geometry-msgs@5.5.1 (ROS 2 Kilted) and what it brings: a message's field of type double takes an integer, a text, or
# another message, and keeps it, unless ROS_PYTHON_CHECK_FIELDS=1 is in the environment, or check_fields=True among the arguments.
# What the message reports of its own fields is double all the same. Up to Iron, every assignment was checked.
# Guess: AssertionError, "must be of type 'float'", for all three, as ever.
# Seen: all three are kept as they are; with the variable, all three raise it.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"
python3 -m venv venv
venv/bin/pip install --quiet numpy==2.4.6
venv/bin/pip install --quiet --no-deps ros-geometry-msgs==5.5.1 ros-rosidl-parser==4.9.5
cat > run.py <<'EOF'
import os

from geometry_msgs.msg import Point

kept = []
for value in (1, "one", Point()):
    try:
        kept.append(Point(x=value).x is value)
    except AssertionError:
        kept.append(False)
told = os.environ.get("ROS_PYTHON_CHECK_FIELDS")
print(f"ROS_PYTHON_CHECK_FIELDS={told}: an integer, a text, a message in a {Point.get_fields_and_field_types()['x']}: kept {kept}")
if kept != [told != "1"] * 3:
    raise SystemExit("What a field takes is another thing now.")
EOF
venv/bin/python run.py
ROS_PYTHON_CHECK_FIELDS=1 venv/bin/python run.py
