"""What odometry tells: how far it may be wrong after a motion, and how fast the robot moves."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array

MAX_STEP_NS = 500_000_000
"""Time [ns] since the last scan after which odometry no longer tells how fast the robot moves now."""

WORST_PER_METRE = 0.5
WORST_PER_RADIAN = 0.5
"""Largest error [m/m], [rad/rad] for which a place is searched."""

JUMP, MAX_SPEED = 1.0, 8.0
"""Step [m], and speed [m/s] added to it, from which no robot can have moved as odometry says."""


@dataclass(frozen=True)
class Drift:
    """Motion by odometry since a scan last corrected it.

    Attributes
    ----------
    distance : float
        Length of the path [m].
    turn : float
        Sum of the absolute turns [rad].
    """

    distance: float = 0.0
    turn: float = 0.0

    def after(self, step: Array) -> "Drift":
        """Return the drift after another step (x, y, yaw)."""
        return Drift(self.distance + float(np.hypot(step[0], step[1])), self.turn + abs(float(step[2])))

    @property
    def largest_error(self) -> tuple[float, float]:
        """Distance [m] and angle [rad] by which odometry may be wrong."""
        return WORST_PER_METRE * self.distance, WORST_PER_RADIAN * self.turn

    @property
    def information(self) -> Array:
        """Inverse covariance of the motion."""
        return odometry_information(np.array([self.distance, 0.0, self.turn]))


def odometry_information(moved: Array) -> Array:
    """Return the inverse covariance of a motion (x, y, yaw) by odometry alone, assumed to be inaccurate."""
    distance, turn = float(np.hypot(moved[0], moved[1])), abs(float(moved[2]))
    deviation = np.array([0.05 + 0.2 * distance, 0.05 + 0.2 * distance, 0.2 + 0.2 * turn])
    return np.diag(1.0 / deviation**2)


def twist_between(step: Array, elapsed_ns: int) -> tuple[float, float, float]:
    """Return the velocity (x, y, yaw) of the base from a step of odometry; zero where it took too long."""
    if not 0 < elapsed_ns < MAX_STEP_NS:
        return (0.0, 0.0, 0.0)
    x, y, yaw = (float(value) * 1e9 / elapsed_ns for value in step)
    return (x, y, yaw)


def is_jump(step: Array, elapsed_ns: int) -> bool:
    """Return whether no robot can have made a step of odometry in its time, as after a restart of its driver."""
    return float(np.hypot(step[0], step[1])) > JUMP + MAX_SPEED * max(elapsed_ns, 0) * 1e-9
