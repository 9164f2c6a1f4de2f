"""Statistics of fleets: confidence intervals of shares, and tests of two versions against each other."""

from __future__ import annotations

import math
from collections.abc import Sequence

Z_95 = 1.959963984540054
"""Quantile of the normal distribution for an interval of 95 %."""


def wilson_interval(successes: int, count: int, z: float = Z_95) -> tuple[float, float]:
    """Return the confidence interval of a share.

    Parameters
    ----------
    successes, count : int
    z : float
        Quantile of the normal distribution; 1.96 for 95 %.

    Source: E. B. Wilson, Probable inference, the law of succession, and statistical inference, 1927.
    """
    if count <= 0:
        return 0.0, 1.0
    share = successes / count
    scale = 1.0 + z * z / count
    centre = share + z * z / (2 * count)
    spread = z * math.sqrt(share * (1.0 - share) / count + z * z / (4 * count * count))
    low = 0.0 if successes == 0 else (centre - spread) / scale
    high = 1.0 if successes == count else (centre + spread) / scale
    return low, high


def compare_shares(first: tuple[int, int], second: tuple[int, int]) -> float:
    """Return the two-sided p-value of Fisher's exact test that two shares are one.

    Parameters
    ----------
    first, second : tuple of 2 int
        Successes and their number of runs.
    """
    (a, n), (b, m) = first, second
    total = a + b
    logs = {
        k: _log_choose(n, k) + _log_choose(m, total - k) - _log_choose(n + m, total)
        for k in range(max(0, total - m), min(n, total) + 1)
    }
    limit = logs[a] + 1e-7
    return min(1.0, math.fsum(math.exp(value) for value in logs.values() if value <= limit))


def compare_values(first: Sequence[float], second: Sequence[float]) -> float:
    """Return the two-sided p-value of the test of Mann and Whitney that two samples are of one distribution."""
    from scipy.stats import mannwhitneyu

    if not first or not second or (len(set(first)) == 1 and set(first) == set(second)):
        return 1.0
    return float(mannwhitneyu(first, second, alternative="two-sided").pvalue)


def _log_choose(n: int, k: int) -> float:
    return math.lgamma(n + 1) - math.lgamma(k + 1) - math.lgamma(n - k + 1)
