#!/usr/bin/env bash
# Surprise: Debian 12's ROS 1: python3-tf2==0.7.6-1+b2, libtf2-2d==0.7.6-1+b2: whether a frame is static is decided by
# the first transform that comes for it. After a static one, moving ones of any stamp overwrite all of time; after a
# moving one, a static one is a sample like any other: it is interpolated with, and after its stamp there is none.
# Guess: set_transform_static holds for ever from then on; set_transform always keeps a history.
# Seen: x of frame b in a at 1 s: 3 m, though 2 m was sent for 1 s (and 3 m for 2 s, after a static 1 m). The other way
# round, 1 m moving at 5 s then 7 m static (stamp 0): 5.8 m at 1 s, and an extrapolation error at 99 s.
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
from tf2_py import BufferCore, ExtrapolationException


def at(x, stamp):
    message = TransformStamped(child_frame_id="b")
    message.header.frame_id, message.header.stamp = "a", Time(stamp)
    message.transform.translation, message.transform.rotation = Vector3(x, 0, 0), Quaternion(0, 0, 0, 1)
    return message


def x(buffer, stamp):
    try:
        return round(buffer.lookup_transform_core("a", "b", Time(stamp)).transform.translation.x, 6)
    except ExtrapolationException:
        return "extrapolation"


static_first, moving_first = BufferCore(), BufferCore()
static_first.set_transform_static(at(1, 0), "me")
static_first.set_transform(at(2, 1), "me")
static_first.set_transform(at(3, 2), "me")
moving_first.set_transform(at(1, 5), "me")
moving_first.set_transform_static(at(7, 0), "me")
seen = [x(static_first, t) for t in (1, 2, 99)], [x(moving_first, t) for t in (1, 5, 99)]
print("static, then moving, at 1, 2, 99 s:", seen[0], "\nmoving, then static, at 1, 5, 99 s:", seen[1])
if seen != ([3, 3, 3], [5.8, 1, "extrapolation"]):
    raise SystemExit("tf2 now decides otherwise what is static.")
EOF
