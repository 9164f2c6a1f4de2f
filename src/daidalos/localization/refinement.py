"""Refinement of a pose estimate: the likeliest pose near the mean of the particles.

The mean of some hundred particles is as coarse as they are spread. The posterior of the last scan, with the particles'
normal distribution as the prior and the likelihood field's mixture for each beam, has its maximum near by; Gauss-Newton
steps with the beams weighted by how likely each is a hit find it.
"""

import math

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.pose2 import compose, inverse
from daidalos.localization.config import AmclConfig
from daidalos.localization.likelihood_map import LikelihoodMap, Table
from daidalos.localization.sensor_models.sensor_model import Beams

STEPS = 6
"""Gauss-Newton steps; the last ones change the pose by less than a millimetre."""

SMALLEST_DEVIATION = np.array([0.02, 0.02, 0.01])
"""Standard deviations [m, m, rad] below which the prior is not taken to be certain."""


def refined(pose: Array, covariance: Array, beams: Beams, world: LikelihoodMap, config: AmclConfig) -> Array:
    """Return the likeliest pose near a pose, or the pose itself where nothing near it is likelier.

    Parameters
    ----------
    pose : ndarray, shape (3,)
        Mean (x, y, yaw) of the particles.
    covariance : ndarray, shape (3, 3)
        Theirs.
    beams : Beams
        The last scan.
    world : LikelihoodMap
    config : AmclConfig
        Parameters of the mixture.
    """
    information = np.linalg.inv(covariance + np.diag(SMALLEST_DEVIATION**2))
    turn = world.origin[2]
    rotation = np.array([[math.cos(turn), math.sin(turn), 0.0], [-math.sin(turn), math.cos(turn), 0.0], [0, 0, 1.0]])
    local = compose(inverse(world.origin), pose)
    level = config.z_rand / beams.max_range
    found = climb(
        local,
        np.ascontiguousarray(rotation @ information @ rotation.T),
        beams.ends,
        world.distance,
        world.resolution,
        config.z_hit,
        config.sigma_hit,
        level,
        STEPS,
    )
    return compose(world.origin, found)


@compiled
def climb(
    start: Array,
    information: Array,
    ends: Array,
    distance: Table,
    resolution: float,
    z_hit: float,
    sigma: float,
    level: float,
    steps: int,
) -> Array:
    """Return the pose in the grid's frame [m, m, rad] with the largest posterior that the steps come by."""
    pose, best = start.copy(), start.copy()
    largest = -np.inf
    scale = 1.0 / (sigma * sigma)
    for _ in range(steps + 1):
        cosine, sine = math.cos(pose[2]), math.sin(pose[2])
        away = pose - start
        normal = information.copy()
        slope = -(information @ away)
        posterior = -0.5 * float(away @ (information @ away))
        for k in range(ends.shape[0]):
            dx = cosine * ends[k, 0] - sine * ends[k, 1]
            dy = sine * ends[k, 0] + cosine * ends[k, 1]
            d, gx, gy = interpolated(distance, (pose[0] + dx) / resolution, (pose[1] + dy) / resolution)
            hit = z_hit * math.exp(-0.5 * scale * d * d)
            posterior += math.log(hit + level + 1e-30)
            if d <= 0.0:
                continue
            weight = scale * hit / (hit + level + 1e-30)
            gx, gy = gx / resolution, gy / resolution
            jacobian = np.array([gx, gy, gy * dx - gx * dy])
            for i in range(3):
                slope[i] -= weight * d * jacobian[i]
                for j in range(3):
                    normal[i, j] += weight * jacobian[i] * jacobian[j]
        if posterior > largest:
            largest = posterior
            best = pose.copy()
        pose = pose + np.linalg.solve(normal, slope)
    return best


@compiled
def interpolated(distance: Table, x: float, y: float) -> tuple[float, float, float]:
    """Return the bilinear interpolation between centres of cells and its slopes by x and y, all three [m]."""
    column, row = math.floor(x - 0.5), math.floor(y - 0.5)
    if not (0 <= column < distance.shape[1] - 1 and 0 <= row < distance.shape[0] - 1):
        return 1e3, 0.0, 0.0
    u, v = x - 0.5 - column, y - 0.5 - row
    a, b = float(distance[row, column]), float(distance[row, column + 1])
    c, d = float(distance[row + 1, column]), float(distance[row + 1, column + 1])
    low, high = a + u * (b - a), c + u * (d - c)
    return low + v * (high - low), (1.0 - v) * (b - a) + v * (d - c), high - low
