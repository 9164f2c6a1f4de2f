"""Workpieces of the demonstration: a plate to be finished, and a clamp with excess material."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.grinding.height_field import RESOLUTION, Workpiece

PLACE = (2.2, 0.0, 0.8)
"""Where the workpiece is in the base of the robot [m]."""
MARGIN = 0.03
"""Distance of the region from the edges of a plate [m]."""
CLAMP_RADIUS = 0.2


def plate(
    size: float = 0.3, depth: float = 50e-6, roughness: float = 2e-6, seed: int = 0, resolution: float = RESOLUTION
) -> Workpiece:
    """Return a flat plate from which a layer shall be removed evenly.

    Parameters
    ----------
    size : float
        Of its edges [m].
    depth : float
        Of the layer [m].
    roughness : float
        Standard deviation of its heights [m].
    seed : int
        Of the roughness.
    resolution : float
        Edge of a cell [m].
    """
    count = round(size / resolution)
    axis = resolution * np.arange(count) - 0.5 * resolution * (count - 1)
    surface = np.random.default_rng(seed).normal(0.0, roughness, (count, count))
    inside = np.abs(axis) <= 0.5 * size - MARGIN
    return Workpiece(
        surface,
        np.full((count, count), -depth),
        inside[:, None] & inside[None, :],
        np.array([axis[0]] * 2),
        resolution,
        place(),
    )


def clamp(excess: float = 1.0e-3, seed: int = 0, resolution: float = RESOLUTION) -> Workpiece:
    """Return a part of a pipe clamp: a cylinder about y with a weld bead and the flash of a parting line on it.

    Parameters
    ----------
    excess : float
        Mean height of the bead [m]; the flash has half of it.
    seed : int
        Of the heights along both.
    resolution : float
        Edge of a cell [m].
    """
    rng = np.random.default_rng(seed)
    x = np.arange(-0.08, 0.08, resolution)
    y = np.arange(-0.13, 0.13, resolution)
    target = np.sqrt(CLAMP_RADIUS**2 - x**2)[None, :] - CLAMP_RADIUS + np.zeros((len(y), 1))
    ends = np.clip((0.09 - np.abs(y)) / 0.01, 0.0, 1.0)[:, None]
    surface = target + rng.normal(0.0, 2e-6, target.shape)
    for center, width, height in ((-0.012, 0.006, excess), (0.035, 0.003, 0.5 * excess)):
        along = height * (1.0 + 0.2 * _waves(y, rng))[:, None] * ends
        surface += along * np.maximum(1.0 - ((x - center) / width) ** 2, 0.0)[None, :]
    region = (np.abs(x) <= 0.06)[None, :] & (np.abs(y) <= 0.095)[:, None]
    return Workpiece(surface, target, region, np.array([x[0], y[0]]), resolution, place())


def _waves(along: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """Return smooth noise of about 1 along a line."""
    phases, lengths = rng.uniform(0.0, 2.0 * np.pi, 4), np.array([0.09, 0.05, 0.03, 0.02])
    waves: NDArray[np.float64] = np.sin(2.0 * np.pi * along[:, None] / lengths + phases).sum(axis=1) / 2.0
    return waves


def place() -> NDArray[np.float64]:
    """Return the pose (4, 4) of a workpiece in the base where none is given."""
    pose = np.eye(4)
    pose[:3, 3] = PLACE
    return pose
