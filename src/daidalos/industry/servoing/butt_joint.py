"""Butt joints of two plates: a seam, a gap, and edges that are rough, chipped and burred.

Lengths are along the direction of the programmed path, s, and to its left, y. The *seam* is the middle of the gap
between the nominal edges; what the edges do beside them is irregularity.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.errors import UserError
from daidalos.common.suggestions import hint

GAP = 0.2e-3
"""Of the workshop [m]."""
RUN_IN = 0.06
"""Length of the plates before the seam's beginning and after its end [m]."""
_STEP = 0.05e-3
_ROUGHNESS = 0.02e-3
"""Standard deviation of an edge [m]."""
_ROUGHNESS_LENGTH = 0.4e-3
"""Length over which the roughness is alike [m]."""
_CHIP_DISTANCE, _BURR_DISTANCE = 0.012, 0.03
"""Mean distances of chips and of burrs on an edge [m]."""


@dataclass(frozen=True)
class Seam:
    """A seam over a length.

    Attributes
    ----------
    name : str
    length : float
        [m]
    lateral : callable
        From lengths (n,) to the seam's place to the left of the programmed path (n,) [m].
    """

    name: str
    length: float
    lateral: Callable[[NDArray[np.float64]], NDArray[np.float64]]


class ButtJoint:
    """Two plates along a seam.

    Parameters
    ----------
    seam : Seam
    seed : int
        Of the edges' irregularity.
    irregularity : float
        Share of roughness, chips and burrs; 0 for perfect edges.
    mismatch : float
        Height of the left plate above the right one [m].
    """

    def __init__(self, seam: Seam, seed: int = 0, irregularity: float = 1.0, mismatch: float = 0.1e-3) -> None:
        self.seam = seam
        self.mismatch = mismatch
        rng = np.random.default_rng(seed)
        self._start = -RUN_IN
        count = int((seam.length + 2.0 * RUN_IN) / _STEP) + 2
        self._right, self._left = (irregularity * _edge(count, rng) for _ in range(2))
        self.glossy = _spots(seam.length, rng)

    def edges(self, s: float) -> tuple[float, float]:
        """Return where the right and the left plate end at a length [m]."""
        at = (s - self._start) / _STEP
        index = min(max(int(at), 0), len(self._right) - 2)
        share = min(max(at - index, 0.0), 1.0)
        middle = float(self.seam.lateral(np.array([s]))[0])
        right, left = ((1.0 - share) * edge[index] + share * edge[index + 1] for edge in (self._right, self._left))
        # Each edge recedes from the gap where its irregularity is positive, and never meets the other one.
        return middle - 0.5 * GAP - right, middle + 0.5 * GAP + left


def _edge(count: int, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return how far an edge recedes every `_STEP` (count,) [m]."""
    from scipy.ndimage import gaussian_filter1d

    sigma = _ROUGHNESS_LENGTH / _STEP
    edge = gaussian_filter1d(rng.normal(size=count), sigma, mode="nearest")
    edge *= _ROUGHNESS / (edge.std() or 1.0)
    at = np.arange(count) * _STEP
    for distance, depths, widths in (
        (_CHIP_DISTANCE, (0.1e-3, 0.6e-3), (0.3e-3, 1.2e-3)),
        (_BURR_DISTANCE, (-0.06e-3, -0.03e-3), (0.2e-3, 0.8e-3)),
    ):
        for place in rng.uniform(0.0, at[-1], rng.poisson(at[-1] / distance)):
            depth, width = rng.uniform(*depths), rng.uniform(*widths)
            edge += depth * np.exp(-(((at - place) / (0.5 * width)) ** 4))
    out: NDArray[np.float64] = np.maximum(edge, -0.45 * GAP)
    return out


def _spots(length: float, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return glossy spots (n, 4): length, place beside the seam, and their half extents [m]."""
    count = rng.poisson((length + 2.0 * RUN_IN) / 0.04)
    places = rng.uniform([-RUN_IN, -8e-3], [length + RUN_IN, 8e-3], size=(count, 2))
    return np.concatenate([places, rng.uniform([0.5e-3, 0.5e-3], [2e-3, 3e-3], size=(count, 2))], axis=1)


LINE_OFFSET = 1.5e-3
"""Of the straight seam beside the programmed line, about what the tool gives way [m]."""


def _line(s: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.full_like(s, LINE_OFFSET)


def _waves(s: NDArray[np.float64]) -> NDArray[np.float64]:
    out: NDArray[np.float64] = 1e-3 * (_WAVES[0] * np.sin(s / _WAVES[1]) + _WAVES[2] * np.sin(s / _WAVES[3] + 0.7))
    return out


_WAVES = (3.5, 0.0224, 1.1, 0.0092)
"""Amplitudes [mm] and lengths [m/rad] of the curve, chosen so that the proportional loop deviates as the workshop's."""

SEAMS = {
    "line": Seam("line", 0.1, _line),
    "curve": Seam("curve", 0.4, _waves),
    "long": Seam("long", 2.0, _waves),
}


def seam_named(name: str) -> Seam:
    """Return a test seam.

    Raises
    ------
    UserError
        Where there is none of that name.
    """
    if name not in SEAMS:
        raise UserError(f"there is no seam '{name}'{hint(name, SEAMS)}")
    return SEAMS[name]
