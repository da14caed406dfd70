"""The two markers of the lab's demo, as the lab builds them."""

from .messages import ColorRGBA, Marker, Point

__all__ = ["axis_marker", "arrow_marker"]


def axis_marker(pose_stamped):
    """Return a Marker with the axes of the frame at `pose_stamped`: x red, y green, z blue, 1 m long, 0.1 m wide."""
    marker = Marker()
    marker.ns = "axes"
    marker.header = pose_stamped.header
    marker.pose = pose_stamped.pose
    marker.type = Marker.LINE_LIST
    marker.scale.x = 0.1
    for axis in [(1, 0, 0), (0, 1, 0), (0, 0, 1)]:
        marker.points += [Point(0, 0, 0), Point(*axis)]
        marker.colors += [ColorRGBA(*axis, 1), ColorRGBA(*axis, 1)]  # red, green, blue: as the axes are x, y, z
    return marker


def arrow_marker(point):
    """Return a Marker with a yellow arrow from the origin of `frame_a` to `point` (a Point in `frame_a`)."""
    marker = Marker()
    marker.ns = "arrow"
    marker.type = Marker.ARROW
    marker.header.frame_id = "frame_a"
    marker.points += [Point(0, 0, 0), point]
    marker.scale.x = 0.1
    marker.scale.y = 0.15
    marker.color.r = 1
    marker.color.g = 1
    marker.color.a = 1
    return marker
