"""Velocities of several bodies from the last step, available without computation to per-step plugins.

Bringing everything up to date takes as long as a step itself.
"""

from __future__ import annotations

from collections.abc import Iterable

import mujoco
import numpy as np

from daidalos.common.arrays import Array
from daidalos.simulation.physics import Physics


def velocities(physics: Physics, bodies: Iterable[int]) -> tuple[Array, Array]:
    """Return linear velocities (n, 3) of the bodies' origins and angular velocities (n, 3), in world axes."""
    motions = []
    for body in bodies:
        motion = np.empty(6)
        mujoco.mj_objectVelocity(physics.model, physics.data, mujoco.mjtObj.mjOBJ_XBODY, body, motion, 0)
        motions.append(motion)
    both = np.array(motions).reshape(-1, 6)
    return both[:, 3:], both[:, :3]


def cross(first: Array, second: Array) -> Array:
    """Return the cross products (n, 3) of rows, faster than numpy for few rows."""
    (a, b, c), (x, y, z) = first.T, second.T
    return np.stack((b * z - c * y, c * x - a * z, a * y - b * x), axis=1)
