"""Agreement of scans with a map at the estimated pose, and detection of a pose that no longer agrees.

Obstacles that the map does not have, such as people, only make beams shorter, and seldom most of them. A robot that is
not where it is thought to be sees through walls of the map as well, or nothing where it should be.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.pose2 import between, compose
from daidalos.localization.likelihood_map import LikelihoodMap, Table
from daidalos.localization.sensor_models.sensor_model import Beams

NEAR = 0.2
"""Distance [m] between the end of a beam and an obstacle of the map up to which the obstacle explains it."""

THROUGH = 0.4
"""Length [m] of a beam beyond an obstacle of the map from which the beam contradicts the map."""

FARTHEST = 30.0
"""Length [m] up to which a beam is followed."""

ESTABLISHED_SCANS = 10
"""Number of scans in agreement after which a pose counts as known."""

WELL_EXPLAINED = 0.5
"""Share of explained beams of a scan in agreement."""

LOST_SCANS = 3
"""Number of scans in a row without agreement after which the robot is lost."""

_LOST_SHARE = 0.6
"""Share of the usual number of explained beams below which a scan is not explained."""

_SUDDEN_SHARE = 0.4
"""The same share below which a scan of at least half a turn is not explained by people around the robot either."""

_CONTRADICTED = 0.1
"""Share of contradicting beams, above the usual one, from which the map is contradicted."""

_RATE = 0.05
"""Weight of a scan in the averages of what is usual."""


@dataclass(frozen=True)
class Agreement:
    """Agreement of a scan with the map.

    Attributes
    ----------
    explained : float
        Share, of the beams that met something, of those that end near an obstacle of the map.
    contradicted : float
        Share of the beams that go through an obstacle of the map.
    is_wide : bool
        Whether the scan covers at least half a turn.
    """

    explained: float
    contradicted: float
    is_wide: bool = True


def agreement_of(pose: Array, beams: Beams, world: LikelihoodMap) -> Agreement | None:
    """Return how far a scan agrees with the map where the base is at a pose (x, y, yaw); None for one without ends."""
    met = beams.ranges < beams.max_range
    if not met.any():
        return None
    sensor = compose(between(world.origin, pose), beams.sensor_pose)
    explained, contradicted = count_beams(
        sensor, beams.ranges, beams.angles, met, world.distance, world.resolution, world.max_distance
    )
    is_wide = float(np.ptp(beams.angles)) >= 0.99 * math.pi
    return Agreement(explained / int(met.sum()), contradicted / met.size, is_wide)


@compiled
def count_beams(
    sensor: Array,
    ranges: Array,
    angles: Array,
    met: NDArray[np.bool_],
    distance: Table,
    resolution: float,
    unknown: float,
) -> tuple[int, int]:
    """Return how many beams end near an obstacle, and how many go through one.

    Parameters
    ----------
    sensor : ndarray, shape (3,)
        Pose of the sensor in the grid's frame [m, m, rad].
    ranges, angles : ndarray, shape (k,)
        Lengths [m] of the beams, and their directions [rad] in the sensor's frame.
    met : ndarray of bool, shape (k,)
        Which of them met something.
    distance : ndarray of float32, shape (height, width)
        Distance [m] of each cell to the nearest obstacle.
    resolution : float
        Side of a cell [m].
    unknown : float
        Distance [m] outside of the grid.
    """
    explained, contradicted = 0, 0
    for k in range(ranges.shape[0]):
        dx, dy = math.cos(sensor[2] + angles[k]), math.sin(sensor[2] + angles[k])
        end = sensor[0] + ranges[k] * dx, sensor[1] + ranges[k] * dy
        if met[k] and distance_at(end[0], end[1], distance, resolution, unknown) <= NEAR:
            explained += 1
            continue
        at = 0.0
        last = min(ranges[k], FARTHEST) - THROUGH
        while at < last:
            free = distance_at(sensor[0] + at * dx, sensor[1] + at * dy, distance, resolution, unknown)
            if free < 0.5 * resolution:
                contradicted += 1
                break
            # The distance is that of centres of cells, either of which may be nearer by half a diagonal.
            at += max(free - 1.5 * resolution, 0.5 * resolution)
    return explained, contradicted


@compiled
def distance_at(x: float, y: float, distance: Table, resolution: float, unknown: float) -> float:
    """Return the distance [m] of the cell at a position to the nearest obstacle."""
    column, row = math.floor(x / resolution), math.floor(y / resolution)
    if 0 <= column < distance.shape[1] and 0 <= row < distance.shape[0]:
        return float(distance[row, column])
    return unknown


class LostDetector:
    """Detector of a robot that was well localized and is not any more, as after it was carried away."""

    def __init__(self) -> None:
        self.reset()

    def reset(self) -> None:
        """Forget what is usual, for a new first pose."""
        self._usual = np.zeros(2)
        self._agreeing = self._lost = 0

    @property
    def is_lost(self) -> bool:
        """Whether the last scans do not agree with the map at the estimated pose."""
        return self._lost >= LOST_SCANS

    def add(self, agreement: Agreement) -> None:
        """Judge a scan by those before it."""
        share = np.array([agreement.explained, agreement.contradicted])
        if self._agreeing < ESTABLISHED_SCANS:
            if agreement.explained >= WELL_EXPLAINED and agreement.contradicted <= _CONTRADICTED:
                self._agreeing += 1
                self._usual += (share - self._usual) / self._agreeing
            else:
                self.reset()
        elif self._disagrees(agreement):
            self._lost += 1
        else:
            self._lost = 0
            self._usual += _RATE * (share - self._usual)

    def _disagrees(self, agreement: Agreement) -> bool:
        explained, contradicted = self._usual
        if agreement.is_wide and agreement.explained < _SUDDEN_SHARE * explained:
            return True
        return bool(
            agreement.explained < _LOST_SHARE * explained and agreement.contradicted > contradicted + _CONTRADICTED
        )
