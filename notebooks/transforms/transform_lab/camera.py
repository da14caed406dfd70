"""Where a scene is looked at from, so that all of it is in view."""

import math

import numpy as np

# From the front right and above: x points to the right and a little towards us, y away, z up. The azimuth is as far as
# can be from all multiples of 45 degrees, where an axis of the lab's frames would point straight at us or away.
AZIMUTH, ELEVATION = math.radians(-67.5), math.radians(28)
FIELD_OF_VIEW = math.radians(30)  # from the bottom to the top of the picture
MARGIN = 0.86  # of the picture's width and height, which the scene fills at most


class Camera:
    """A perspective camera that has all of `points` (Nx3, in the fixed frame) in view; `aspect` is width by height.

    `eye` and `target` are points in the fixed frame; z is up.
    """

    def __init__(self, points, aspect):
        points = np.asarray(points, float)
        cos_el, sin_el = math.cos(ELEVATION), math.sin(ELEVATION)
        self.back = np.array([math.cos(AZIMUTH) * cos_el, math.sin(AZIMUTH) * cos_el, sin_el])
        self.right = np.array([-math.sin(AZIMUTH), math.cos(AZIMUTH), 0])
        self.up = np.cross(self.back, self.right)
        self.aspect = aspect
        self.tangent = math.tan(FIELD_OF_VIEW / 2)
        self.target = (points.min(axis=0) + points.max(axis=0)) / 2
        limits = np.array([self.tangent * aspect, self.tangent]) * MARGIN
        for _ in range(4):  # perspective makes near things larger: find the distance, move to the middle, again
            across = (points - self.target) @ np.column_stack([self.right, self.up])
            nearer = (points - self.target) @ self.back
            self.distance = max((np.abs(across) / limits + nearer[:, None]).max(), 1e-6)
            seen = across / (self.distance - nearer)[:, None]
            middle = (seen.min(axis=0) + seen.max(axis=0)) / 2 * self.distance
            self.target = self.target + middle[0] * self.right + middle[1] * self.up
        self.eye = self.target + self.distance * self.back

    def project(self, points):
        """Return the place in the picture of points (...x3) in the fixed frame, and their distances.

        The places (...x2) go from 0, 0 at the lower left to `aspect`, 1 at the upper right.
        """
        relative = np.asarray(points, float) - self.eye
        depth = -(relative @ self.back)
        across = np.stack([relative @ self.right, relative @ self.up], axis=-1)
        place = across / depth[..., None] / (2 * self.tangent)
        return place + [self.aspect / 2, 0.5], depth
