"""Beam model: compares each range with the distance to the first obstacle in the map."""

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.pose2 import compose
from daidalos.localization.config import AmclConfig
from daidalos.localization.likelihood_map import LikelihoodMap
from daidalos.localization.sensor_models.sensor_model import Beams, SensorModel


class BeamModel(SensorModel):
    """Mixture of hit, unexpected obstacle, no echo and noise (Thrun, Burgard and Fox 2005, table 6.1).

    The beams are put together as `1 + sum p^3`, as in `LikelihoodFieldModel`.
    """

    def __init__(self, config: AmclConfig) -> None:
        self.config = config

    def likelihoods(self, particles: Array, beams: Beams, world: LikelihoodMap) -> Array:
        """Implement `SensorModel.likelihoods`."""
        c = self.config
        return sum_over_beams(
            world.to_cells(compose(particles, beams.sensor_pose)),
            beams.ranges,
            beams.angles,
            beams.max_range,
            world.distance,
            world.resolution,
            np.array([c.z_hit, c.z_short, c.z_max, c.z_rand, c.sigma_hit, c.lambda_short]),
        )


@compiled
def sum_over_beams(
    sensors: Array,
    ranges: Array,
    angles: Array,
    max_range: float,
    distance: NDArray[np.float32],
    resolution: float,
    mixture: Array,
) -> Array:
    """Return for each sensor pose, with x and y in cells, 1 plus the sum of p^3 over the beams."""
    z_hit, z_short, z_max, z_rand = mixture[0], mixture[1], mixture[2], mixture[3]
    scale = -0.5 / (mixture[4] * mixture[4])
    rate = mixture[5]
    total = np.ones(sensors.shape[0])
    for i in range(sensors.shape[0]):
        for k in range(ranges.shape[0]):
            expected = cast_ray(
                distance,
                resolution,
                sensors[i, 0],
                sensors[i, 1],
                sensors[i, 2] + angles[k],
                max_range,
            )
            measured = ranges[k]
            error = measured - expected
            p = z_hit * math.exp(scale * error * error)
            if error < 0.0:
                p += z_short * rate * math.exp(-rate * measured)
            p += z_max if measured >= max_range else z_rand / max_range
            total[i] += p * p * p
    return total


@compiled
def cast_ray(
    distance: NDArray[np.float32], resolution: float, x: float, y: float, angle: float, max_range: float
) -> float:
    """Return the distance [m] along a ray to the first occupied cell, by sphere tracing in the distance field.

    Parameters
    ----------
    distance : ndarray, shape (height, width)
        Of `LikelihoodMap`.
    resolution : float
        Side of a cell [m].
    x, y : float
        Start of the ray, in cells.
    angle : float
        Its direction [rad].
    max_range : float
        Result where it meets nothing [m].
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    height, width = distance.shape
    travelled, farthest = 0.0, max_range / resolution
    while travelled < farthest:
        column = math.floor(x + travelled * cosine)
        row = math.floor(y + travelled * sine)
        if not (0 <= column < width and 0 <= row < height):
            return max_range
        away = float(distance[row, column])
        if away <= 0.0:
            return travelled * resolution
        travelled += max(away / resolution - 1.5, 0.5)
    return max_range
