"""Where a scene is looked at from, so that all of it is in view."""

import math

import numpy as np

# Azimuth and elevation in degrees: where the camera stands, seen from the middle of the scene.
VIEWS = {
    # From the front right and above: x points to the right and a little towards us, y away, z up. The azimuth is as far
    # as can be from all multiples of 45 degrees, where an axis of the lab's frames would point straight at us or away.
    "overview": (-67.5, 28),
    "above": (-90, 89.9),  # as on paper: x to the right, y up
    "side": (-90, 8),  # x to the right, z up
    "behind": (180, 12),  # as the robot sees it: x ahead, y to the left
}
FIELD_OF_VIEW = math.radians(30)  # from the bottom to the top of the picture
MARGIN = 0.86  # of the picture's width and height, which the scene fills at most
NEAREST = 0.02  # of the distance to the target: what is nearer to the eye than this is not drawn


class Camera:
    """A perspective camera that has all of `points` (Nx3, in the fixed frame) in view; `aspect` is width by height.

    `view` is one of VIEWS; `top` is the part of the picture's height that is kept free at its top. `eye` and `target`
    are points in the fixed frame; z is up.
    """

    def __init__(self, points, aspect, view="overview", top=0.0):
        points = np.asarray(points, float)
        azimuth, elevation = np.radians(VIEWS[view])
        self.back = np.array([math.cos(azimuth) * math.cos(elevation), math.sin(azimuth) * math.cos(elevation),
                              math.sin(elevation)])  # fmt: skip
        self.right = np.array([-math.sin(azimuth), math.cos(azimuth), 0])
        self.up = np.cross(self.back, self.right)
        self.aspect = aspect
        self.tangent = math.tan(FIELD_OF_VIEW / 2)
        self.target = (points.min(axis=0) + points.max(axis=0)) / 2
        # In units of the distance: how far left, right, down and up of the middle the scene may reach.
        half_width, half_height = self.tangent * aspect * MARGIN, self.tangent * (1 - top) * MARGIN
        low = -self.tangent * top  # the middle of what is not kept free
        limits = np.array([half_width, half_width, half_height - low, half_height + low])
        for _ in range(6):  # perspective makes near things larger: find the distance, move to the middle, again
            across = (points - self.target) @ np.column_stack([-self.right, self.right, -self.up, self.up])
            nearer = (points - self.target) @ self.back
            self.distance = max((across / limits + nearer[:, None]).max(), 1e-6)
            seen = across[:, [1, 3]] / (self.distance - nearer)[:, None]
            middle = ((seen.min(axis=0) + seen.max(axis=0)) / 2 - [0, low]) * self.distance
            self.target = self.target + middle[0] * self.right + middle[1] * self.up
        self.eye = self.target + self.distance * self.back

    def project(self, points):
        """Return the place in the picture of points (...x3) in the fixed frame, and their distances.

        The places (...x2) go from 0, 0 at the lower left to `aspect`, 1 at the upper right. A point that is behind the
        eye or too near to it is at NaN, NaN.
        """
        relative = np.asarray(points, float) - self.eye
        depth = -(relative @ self.back)
        across = np.stack([relative @ self.right, relative @ self.up], axis=-1)
        in_front = np.where(depth > NEAREST * self.distance, depth, np.nan)
        place = across / in_front[..., None] / (2 * self.tangent)
        return place + [self.aspect / 2, 0.5], depth
