"""Sets of weighted particles: resampling, required number, clusters and moments."""

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.common.pose2 import wrap

TURNS = 36
"""Bins of a full turn."""

BIN = np.array([0.5, 0.5, 2.0 * math.pi / TURNS])
"""Size of a bin of the histogram over (x, y, yaw), by which particles are counted and clustered."""

CONVERGED_WITHIN = 0.5
"""Distance [m] from their mean up to which particles count as converged, as in AMCL."""

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


@compiled
def bins_of(particles: Array) -> NDArray[np.int64]:
    """Return the bin of each particle as a number: 20 bits each for x, y and yaw, which wraps around."""
    bins = np.empty(particles.shape[0], dtype=np.int64)
    for i in range(particles.shape[0]):
        x = math.floor(particles[i, 0] / BIN[0]) + HALF
        y = math.floor(particles[i, 1] / BIN[1]) + HALF
        bins[i] = (x << 40) + (y << 20) + math.floor(particles[i, 2] / BIN[2]) % TURNS
    return bins


@compiled
def count_bins(particles: Array, chosen: NDArray[np.int64]) -> int:
    """Return how many bins some of the particles are in, given the sorted indices of these."""
    kept = np.empty(chosen.shape[0], dtype=np.int64)
    number, last = 0, -1
    for index in chosen:
        if index != last:
            kept[number] = index
            number += 1
            last = index
    if number == 0:
        return 0
    bins = np.sort(bins_of(particles[kept[:number]]))
    return 1 + int((bins[1:] != bins[:-1]).sum())


def kld_bound(bins: int, error: float, quantile: float) -> int:
    """Return the number of particles that bounds the Kullback-Leibler divergence to the truth (Fox 2003).

    Parameters
    ----------
    bins : int
        Number of bins that the distribution covers.
    error : float
        Bound of the distance.
    quantile : float
        Of the standard normal distribution; 2.33 for a bound that holds with a probability of 0.99.
    """
    if bins <= 1:
        return 1
    k = bins - 1
    a = 2.0 / (9.0 * k)
    return math.ceil(k / (2.0 * error) * (1.0 - a + math.sqrt(a) * quantile) ** 3)


@compiled
def heaviest_cluster(particles: Array, weights: Array) -> NDArray[np.bool_]:
    """Return the members of the cluster with the largest weight; clusters are adjacent bins."""
    bins_of_all = bins_of(particles)
    bins = np.unique(bins_of_all)
    leaders = clusters(bins)
    cluster = leaders[np.searchsorted(bins, bins_of_all)]
    total = np.zeros(bins.shape[0])
    for i in range(weights.shape[0]):
        total[cluster[i]] += weights[i]
    members: NDArray[np.bool_] = cluster == np.argmax(total)
    return members


@compiled
def clusters(bins: NDArray[np.int64]) -> NDArray[np.int64]:
    """Join adjacent bins, given by distinct numbers; return for each the index of one bin of its cluster."""
    slots = np.full(1 << (2 + int(math.log2(bins.shape[0] + 1))), -1)
    for i in range(bins.shape[0]):
        slots[_slot_of(bins[i], bins, slots)] = i
    leader = np.arange(bins.shape[0])
    for i in range(bins.shape[0]):
        yaw = bins[i] & (2 * HALF - 1)
        for half in range(14, 27):  # of the 26 neighbours; the others have this bin among theirs
            dx, dy, turn = half // 9 - 1, half // 3 % 3 - 1, half % 3 - 1
            near = bins[i] + (dx << 40) + (dy << 20) - yaw + (yaw + turn) % TURNS
            j = slots[_slot_of(near, bins, slots)]
            if j >= 0:
                a, b = _leader(leader, i), _leader(leader, j)
                leader[max(a, b)] = min(a, b)
    for i in range(bins.shape[0]):
        leader[i] = _leader(leader, i)
    return leader


@compiled
def _slot_of(number: int, bins: NDArray[np.int64], slots: NDArray[np.int64]) -> int:
    """Return the slot of a hash table that holds the index of a bin, or the free one where it belongs."""
    slot = ((number ^ (number >> 19) ^ (number >> 37)) * 40503) & (slots.shape[0] - 1)
    while slots[slot] >= 0 and bins[slots[slot]] != number:
        slot = (slot + 1) & (slots.shape[0] - 1)
    return int(slot)


@compiled
def _leader(leader: NDArray[np.int64], i: int) -> int:
    while leader[i] != i:
        leader[i] = leader[leader[i]]
        i = leader[i]
    return i


def are_converged(particles: Array) -> bool:
    """Return whether all particles are within `CONVERGED_WITHIN` of their mean along both axes."""
    away = np.abs(particles[:, :2] - particles[:, :2].mean(axis=0))
    return bool(away.max() <= CONVERGED_WITHIN)


def mean_and_covariance(particles: Array, weights: Array) -> tuple[Array, Array]:
    """Return the weighted mean pose, with its circular mean of yaw, and the covariance (3, 3) of (x, y, yaw)."""
    share = weights / weights.sum()
    x, y = share @ particles[:, 0], share @ particles[:, 1]
    yaw = math.atan2(float(share @ np.sin(particles[:, 2])), float(share @ np.cos(particles[:, 2])))
    mean = np.array([x, y, yaw])
    return mean, second_moments(particles, share, mean)


def second_moments(particles: Array, weights: Array, pose: Array) -> Array:
    """Return the mean squares (3, 3) of the particles' distances from a pose; the weights sum up to 1."""
    away = particles - pose
    away[:, 2] = wrap(away[:, 2])
    moments: Array = (weights[:, None] * away).T @ away
    return moments
