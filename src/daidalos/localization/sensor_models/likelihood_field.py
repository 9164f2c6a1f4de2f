"""Likelihood-field models: likelihood of a beam by the distance of its end to the nearest obstacle."""

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.localization.config import AmclConfig
from daidalos.localization.likelihood_map import LikelihoodMap, Table
from daidalos.localization.particles import are_converged
from daidalos.localization.sensor_models.sensor_model import Beams, SensorModel

SMALLEST_LOGARITHM = -600.0
"""Below it the likelihoods of all particles are raised together, so that none of them underflows."""


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
        c = self.config
        table = world.table(c.z_hit, c.sigma_hit, c.z_rand / beams.max_range, product=False)
        return 1.0 + sum_over_ends(world.to_cells(particles), beams.ends / world.resolution, table)


class LikelihoodFieldProbModel(SensorModel):
    """AMCL's model ``likelihood_field_prob``: product of the beams' likelihoods, for static maps and few beams.

    With ``do_beamskip`` and particles that have converged, beams are left out that most particles cannot explain,
    such as those that meet people; unless that would leave out nearly all of them.
    """

    def __init__(self, config: AmclConfig) -> None:
        self.config = config

    def likelihoods(self, particles: Array, beams: Beams, world: LikelihoodMap) -> Array:
        """Implement `SensorModel.likelihoods`."""
        c = self.config
        poses, ends = world.to_cells(particles), beams.ends / world.resolution
        if c.do_beamskip and ends.size and are_converged(particles):
            ends = ends[self._explained(poses, ends, world)]
        table = world.table(c.z_hit, c.sigma_hit, c.z_rand / beams.max_range, product=True)
        logarithms = sum_over_ends(poses, ends, table)
        return np.exp(logarithms + max(SMALLEST_LOGARITHM - float(logarithms.max()), 0.0))

    def _explained(self, poses: Array, ends: Array, world: LikelihoodMap) -> NDArray[np.bool_]:
        """Return which beams enough particles agree with; all where too few are left."""
        c = self.config
        agreeing = count_agreeing(poses, ends, world.distance, c.beam_skip_distance) / poses.shape[0]
        explained: NDArray[np.bool_] = agreeing > c.beam_skip_threshold
        skipped = explained.size - int(explained.sum())
        return np.ones_like(explained) if skipped >= c.beam_skip_error_threshold * explained.size else explained


@compiled
def sum_over_ends(poses: Array, ends: Array, table: Table) -> Array:
    """Return for each pose the sum of the table's values at the ends of the beams.

    Parameters
    ----------
    poses : ndarray, shape (n, 3)
        With x and y in cells.
    ends : ndarray, shape (k, 2)
        In the frame of the pose, in cells.
    table : ndarray, shape (height + 2, width + 2)
        With a border for what is outside.
    """
    total = np.zeros(poses.shape[0])
    last_row, last_column = table.shape[0] - 1, table.shape[1] - 1
    for i in range(poses.shape[0]):
        cosine, sine = math.cos(poses[i, 2]), math.sin(poses[i, 2])
        x, y = poses[i, 0] + 1.0, poses[i, 1] + 1.0
        added = 0.0
        for k in range(ends.shape[0]):
            # Rounding towards zero keeps what is outside within the border.
            column = int(x + cosine * ends[k, 0] - sine * ends[k, 1])
            row = int(y + sine * ends[k, 0] + cosine * ends[k, 1])
            column = min(max(column, 0), last_column)
            row = min(max(row, 0), last_row)
            added += table[row, column]
        total[i] = added
    return total


@compiled
def count_agreeing(poses: Array, ends: Array, distance: Table, threshold: float) -> NDArray[np.int64]:
    """Return for each beam at how many of the poses it ends nearer to an obstacle than a threshold [m]."""
    height, width = distance.shape
    counts = np.zeros(ends.shape[0], dtype=np.int64)
    for i in range(poses.shape[0]):
        cosine, sine = math.cos(poses[i, 2]), math.sin(poses[i, 2])
        for k in range(ends.shape[0]):
            column = math.floor(poses[i, 0] + cosine * ends[k, 0] - sine * ends[k, 1])
            row = math.floor(poses[i, 1] + sine * ends[k, 0] + cosine * ends[k, 1])
            if 0 <= column < width and 0 <= row < height and distance[row, column] < threshold:
                counts[k] += 1
    return counts
