"""Likelihood-field models: likelihood of a beam by the distance of its end to the nearest obstacle."""

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.localization.config import AmclConfig
from daidalos.localization.likelihood_map import LikelihoodMap
from daidalos.localization.sensor_models.sensor_model import Beams, SensorModel


class LikelihoodFieldModel(SensorModel):
    """AMCL's model ``likelihood_field``: ``1 + sum p^3`` over the beams.

    Each beam's p is the mixture of Thrun, Burgard and Fox 2005, table 6.3. The sum of cubes takes the place
    of the product, as in AMCL, for beams are not independent: a product of sixty makes the filter far too
    sure.
    """

    def __init__(self, config: AmclConfig) -> None:
        self.config = config

    def likelihoods(self, particles: Array, beams: Beams, world: LikelihoodMap) -> Array:
        """Implement `SensorModel.likelihoods`."""
        return _sum_over_beams(self.config, particles, beams, world, product=False)


class LikelihoodFieldProbModel(SensorModel):
    """AMCL's model ``likelihood_field_prob``: product of the beams' likelihoods, for static maps and few beams."""

    def __init__(self, config: AmclConfig) -> None:
        self.config = config

    def likelihoods(self, particles: Array, beams: Beams, world: LikelihoodMap) -> Array:
        """Implement `SensorModel.likelihoods`."""
        return np.exp(_sum_over_beams(self.config, particles, beams, world, product=True))


def _sum_over_beams(
    config: AmclConfig, particles: Array, beams: Beams, world: LikelihoodMap, *, product: bool
) -> Array:
    """Evaluate the beams with an echo; the others hold no distance to an obstacle."""
    met = beams.ranges < beams.max_range
    angle = beams.sensor_pose[2] + beams.angles[met]
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return sum_over_ends(
        particles,
        beams.sensor_pose[:2] + beams.ranges[met, None] * direction,
        world.distance,
        world.resolution,
        world.origin,
        config.z_hit,
        config.sigma_hit,
        config.z_rand / beams.max_range,
        world.max_distance,
        product,
    )


@compiled
def sum_over_ends(
    particles: Array,
    ends: Array,
    distance: NDArray[np.float32],
    resolution: float,
    origin: Array,
    z_hit: float,
    sigma: float,
    random_level: float,
    outside: float,
    product: bool,
) -> Array:
    """Return for each pose 1 plus the sum of p^3 over the beams, or the sum of log p for their product."""
    total = np.zeros(particles.shape[0])
    scale = -0.5 / (sigma * sigma)
    height, width = distance.shape
    for i in range(particles.shape[0]):
        cosine, sine = math.cos(particles[i, 2]), math.sin(particles[i, 2])
        added = 0.0 if product else 1.0
        for k in range(ends.shape[0]):
            x = particles[i, 0] + cosine * ends[k, 0] - sine * ends[k, 1]
            y = particles[i, 1] + sine * ends[k, 0] + cosine * ends[k, 1]
            column = math.floor((x - origin[0]) / resolution)
            row = math.floor((y - origin[1]) / resolution)
            away = outside
            if 0 <= column < width and 0 <= row < height:
                away = float(distance[row, column])
            p = z_hit * math.exp(scale * away * away) + random_level
            added += math.log(p) if product else p * p * p
        total[i] = added
    return total
