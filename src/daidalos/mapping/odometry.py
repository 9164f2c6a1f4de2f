"""What odometry tells: how far it may be wrong after a motion, and how fast the robot moves."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array

MAX_STEP_NS = 500_000_000
"""Time [ns] since the last scan after which odometry no longer tells how fast the robot moves now."""

WORST_PER_METRE = 0.5
WORST_PER_RADIAN = 0.5
"""Largest error [m/m], [rad/rad] for which a place is searched."""

PRIOR_SAMPLES, MAX_SAMPLES = 3.0, 50.0
"""Matches that the assumption about odometry counts as, and over which its accuracy is averaged at most."""

OUTLIER = 3.0
"""Disagreement, in standard deviations, above which a match counts no more for the accuracy of odometry."""

MIN_SHARE = 0.01
"""Least deviation of odometry's headings as a share of the assumed one."""

JUMP, MAX_SPEED = 1.0, 8.0
"""Step [m], and speed [m/s] added to it, from which no robot can have moved as odometry says."""


@dataclass(frozen=True)
class Accuracy:
    """How well the headings of odometry have agreed with those of matches, by which the two are fused.

    Attributes
    ----------
    rotation : float
        Root mean squared disagreement as a share of what odometry of unknown quality is assumed to err.
    samples : float
        Matches that it rests on; the first ones are weighed against the assumption.
    """

    rotation: float = 1.0
    samples: float = PRIOR_SAMPLES

    def after(self, turn: float, drift: "Drift") -> "Accuracy":
        """Return the accuracy after a match whose heading differs by a turn [rad] from that by odometry.

        A single outlier, such as from a slipping wheel, counts little.
        """
        samples = min(self.samples + 1.0, MAX_SAMPLES)
        disagreement = min(abs(turn) / assumed_deviation(drift.distance, drift.turn)[1], OUTLIER * self.rotation)
        mean_square = self.rotation**2 + (disagreement**2 - self.rotation**2) / samples
        return Accuracy(max(MIN_SHARE, float(np.sqrt(mean_square))), samples)

    def information(self, distance: float, turn: float) -> Array:
        """Return the inverse covariance of a motion by odometry.

        Parameters
        ----------
        distance, turn : float
            Length [m] of the path and sum [rad] of the absolute turns.
        """
        along, about = assumed_deviation(distance, turn)
        return np.diag(1.0 / np.square([along, along, self.rotation * about]))


def assumed_deviation(distance: float, turn: float) -> tuple[float, float]:
    """Return the standard deviations [m], [rad] of a motion by odometry of unknown, low quality."""
    return 0.05 + 0.2 * distance, 0.2 + 0.2 * turn


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


def twist_between(step: Array, elapsed_ns: int) -> tuple[float, float, float]:
    """Return the velocity (x, y, yaw) of the base from a step of odometry; zero where it took too long."""
    if not 0 < elapsed_ns < MAX_STEP_NS:
        return (0.0, 0.0, 0.0)
    x, y, yaw = (float(value) * 1e9 / elapsed_ns for value in step)
    return (x, y, yaw)


def is_jump(step: Array, elapsed_ns: int) -> bool:
    """Return whether no robot can have made a step of odometry in its time, as after a restart of its driver."""
    return float(np.hypot(step[0], step[1])) > JUMP + MAX_SPEED * max(elapsed_ns, 0) * 1e-9
