"""Sets of weighted particles: resampling, required number, clusters and moments."""

import math
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.pose2 import wrap

TURNS = 36
"""Bins of a full turn."""

BIN = np.array([0.5, 0.5, 2.0 * math.pi / TURNS])
"""Size of a bin of the histogram over (x, y, yaw), by which particles are counted and clustered."""

HALF = 1 << 19
"""Offset that keeps the parts of a bin's number positive."""


@compiled
def low_variance_indices(weights: Array, count: int, offset: float) -> NDArray[np.int64]:
    """Resample particles by their weights with one random number (Thrun, Burgard and Fox 2005, table 4.4).

    Parameters
    ----------
    weights : ndarray, shape (n,)
        Weights that sum up to 1.
    count : int
        How many to choose.
    offset : float
        Random number in [0, 1).
    """
    chosen = np.empty(count, dtype=np.int64)
    i = 0
    reached = weights[0]
    for k in range(count):
        wanted = (k + offset) / count
        while reached < wanted and i < weights.shape[0] - 1:
            i += 1
            reached += weights[i]
        chosen[k] = i
    return chosen


def bins_of(particles: Array) -> NDArray[np.int64]:
    """Return the bin of each particle as a number: 20 bits each for x, y and yaw, which wraps around."""
    cells = np.floor(particles / BIN).astype(np.int64)
    cells[:, 2] %= TURNS
    bins: NDArray[np.int64] = ((cells[:, 0] + HALF) << 40) + ((cells[:, 1] + HALF) << 20) + cells[:, 2]
    return bins


def kld_bound(bins: int, error: float, probability: float) -> int:
    """Return the number of particles that bounds the Kullback-Leibler divergence to the truth (Fox 2003).

    Parameters
    ----------
    bins : int
        Number of bins that the distribution covers.
    error : float
        Bound of the distance.
    probability : float
        With which it has to hold.
    """
    if bins <= 1:
        return 1
    z = NormalDist().inv_cdf(probability)
    k = bins - 1
    a = 2.0 / (9.0 * k)
    return math.ceil(k / (2.0 * error) * (1.0 - a + math.sqrt(a) * z) ** 3)


def heaviest_cluster(particles: Array, weights: Array) -> NDArray[np.bool_]:
    """Return the members of the cluster with the largest weight; clusters are adjacent bins."""
    bins, inverse = np.unique(bins_of(particles), return_inverse=True)
    cluster = clusters(bins)[inverse]
    members: NDArray[np.bool_] = cluster == np.argmax(np.bincount(cluster, weights))
    return members


@compiled
def clusters(bins: NDArray[np.int64]) -> NDArray[np.int64]:
    """Join adjacent bins, given by sorted numbers; return for each the index of one bin of its cluster."""
    leader = np.arange(bins.shape[0])
    for i in range(bins.shape[0]):
        yaw = bins[i] & (2 * HALF - 1)
        for dx in range(-1, 2):
            for dy in range(-1, 2):
                for turn in range(-1, 2):
                    near = bins[i] + (dx << 40) + (dy << 20) - yaw + (yaw + turn) % TURNS
                    j = np.searchsorted(bins, near)
                    if j < bins.shape[0] and bins[j] == near:
                        a, b = _leader(leader, i), _leader(leader, j)
                        leader[max(a, b)] = min(a, b)
    for i in range(bins.shape[0]):
        leader[i] = _leader(leader, i)
    return leader


@compiled
def _leader(leader: NDArray[np.int64], i: int) -> int:
    while leader[i] != i:
        leader[i] = leader[leader[i]]
        i = leader[i]
    return i


def mean_and_covariance(particles: Array, weights: Array) -> tuple[Array, Array]:
    """Return the weighted mean pose, with its circular mean of yaw, and the covariance (3, 3) of (x, y, yaw)."""
    share = weights / weights.sum()
    x, y = share @ particles[:, 0], share @ particles[:, 1]
    yaw = math.atan2(float(share @ np.sin(particles[:, 2])), float(share @ np.cos(particles[:, 2])))
    mean = np.array([x, y, yaw])
    away = particles - mean
    away[:, 2] = wrap(away[:, 2])
    return mean, (share[:, None] * away).T @ away
