#!/usr/bin/env bash
# Surprise: Debian 12's ROS 1: python3-tf2==0.7.6-1+b2, libtf2-2d==0.7.6-1+b2: a quaternion 0.1 % too long is accepted
# and never made a unit one: forwards the frame is right, backwards the distance is 0.2 % wrong. At 1 % the transform is
# thrown away: set_transform raises nothing and returns nothing, a line on stderr aside.
# Guess: normalised on the way in, or refused from 1e-6 on.
# Seen: b lies 1 m along a's x and is not turned; a lies -1.002 m along b's x, quaternion w 1.001. At 1 %:
# LookupException.
set -euo pipefail
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT; cd "$work"; chmod 755 .
apt-get download -q python3-tf2=0.7.6-1+b2 libtf2-2d=0.7.6-1+b2 librostime1d libconsole-bridge1.0 \
    python3-{geometry-msgs,std-msgs,genpy,genmsg,rospy,roscpp-msg,rosgraph,rosgraph-msgs,roslib,rospkg,catkin} \
    python3-{catkin-pkg,yaml,dateutil,six,pyparsing} libyaml-0-2 > log 2>&1 ||
    { cat log; echo "Needs Debian 12, after apt-get update." >&2; exit 2; }
for package in *.deb; do dpkg -x "$package" root; done
export PYTHONPATH=$work/root/usr/lib/python3/dist-packages LD_LIBRARY_PATH=$work/root/usr/lib/$(uname -m)-linux-gnu
/usr/bin/python3 - <<'EOF'
from genpy import Time
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from tf2_py import BufferCore, LookupException

seen = []
for w in (1.001, 1.01):
    message, buffer = TransformStamped(child_frame_id="b"), BufferCore()
    message.header.frame_id, message.header.stamp = "a", Time(1)
    message.transform.translation, message.transform.rotation = Vector3(1, 0, 0), Quaternion(0, 0, 0, w)
    buffer.set_transform(message, "me")
    try:
        there = buffer.lookup_transform_core("a", "b", Time(1)).transform
        back = buffer.lookup_transform_core("b", "a", Time(1)).transform
        seen.append((there.translation.x, round(back.translation.x, 6), round(back.rotation.w, 6)))
    except LookupException:
        seen.append("LookupException")
    print("w =", w, "->", seen[-1])
if seen != [(1, -1.002001, 1.001), "LookupException"]:
    raise SystemExit("tf2 now treats quaternions that are not quite of length one otherwise.")
EOF
