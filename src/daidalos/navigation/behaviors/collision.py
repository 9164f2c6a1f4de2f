"""Collision checks of motions."""

import numpy as np

from daidalos.common.arrays import Array
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint, FootprintCollisionChecker


def contact_ahead(
    costmap: Costmap, footprint: Footprint, pose: Array, speed: float, turn: float, duration: float
) -> bool:
    """Return whether a robot that keeps its velocity for a time collides with an obstacle that it does not touch now.

    Parameters
    ----------
    costmap : Costmap
        Inflated costs around the robot.
    footprint : Footprint
        Outline of the robot.
    pose : ndarray, shape (3,)
        Where it is.
    speed, turn : float
        Forward [m/s] and angular [rad/s] velocity.
    duration : float
        How far to look ahead [s].
    """
    checker = FootprintCollisionChecker(costmap, footprint)
    if checker.in_collision(pose):
        return False
    motion = max(abs(speed), abs(turn) * footprint.circumscribed_radius)
    steps = max(int(np.ceil(motion * duration / costmap.resolution)), 1)
    elapsed = np.arange(1, steps + 1) * (duration / steps)
    headings = pose[2] + turn * elapsed
    ahead = speed * elapsed * np.sinc(turn * elapsed / (2.0 * np.pi))
    chords = pose[2] + 0.5 * turn * elapsed
    poses = np.stack([pose[0] + ahead * np.cos(chords), pose[1] + ahead * np.sin(chords), headings], axis=-1)
    return any(checker.in_collision(at) for at in poses)
