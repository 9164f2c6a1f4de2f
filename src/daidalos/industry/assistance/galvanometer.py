"""Geometry of a laser projector: two mirrors that deflect the beam to a point, and back.

The beam meets the mirror that turns it sideways, and after the mirrors' distance the one that turns it up and down. The
projector's frame has its origin on the second mirror, z along the beam at rest, x to the right of the picture and y up.
Seen unfolded, a beam with the angles ``(ax, ay)`` comes from the distance ``e`` behind the origin, so that
``ay = atan2(y, z)`` and ``ax = atan2(x, sqrt(y^2 + z^2) + e)``: the pincushion distortion of every two-mirror scanner.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.pose3 import Pose, rotation_matrix

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Galvanometer:
    """Scanner of a laser projector.

    Attributes
    ----------
    pose : Pose
        Of the projector's frame in the cell.
    angles : (float, float)
        Angle of the beam at full deflection in x and y [rad], below a right angle.
    mirror_distance : float
        Between the two mirrors [m].
    """

    pose: Pose
    angles: tuple[float, float]
    mirror_distance: float = 0.0

    def deflections(self, points: object) -> Array:
        """Return the deflections ``(n, 2)`` to points ``(n, 3)`` of the cell [m], beyond -1 to 1 where out of reach.

        Points behind the projector have deflections that are not numbers.
        """
        moved = np.atleast_2d(np.asarray(points, dtype=float)) - self.pose.position
        x, y, z = (moved @ rotation_matrix(self.pose.orientation)).T
        angles = np.column_stack([np.arctan2(x, np.hypot(y, z) + self.mirror_distance), np.arctan2(y, z)])
        angles[z <= 0.0] = np.nan
        return np.asarray(angles / self.angles)

    def rays(self, deflections: object) -> tuple[Array, Array]:
        """Return origins and unit directions ``(n, 3)`` in the cell of beams with deflections ``(n, 2)``."""
        angles = np.atleast_2d(np.asarray(deflections, dtype=float)) * self.angles
        sines, cosines = np.sin(angles), np.cos(angles)
        axis = np.column_stack([np.zeros(len(angles)), sines[:, 1], cosines[:, 1]])
        directions = cosines[:, :1] * axis
        directions[:, 0] = sines[:, 0]
        rotation = rotation_matrix(self.pose.orientation)
        return self.pose.position - self.mirror_distance * axis @ rotation.T, directions @ rotation.T
