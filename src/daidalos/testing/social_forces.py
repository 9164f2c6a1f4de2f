"""Social force model of pedestrians (Helbing and Molnar 1995), over arrays."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array

RELAXATION_S = 0.5
"""Time in which a pedestrian gets to the speed and direction that it wants."""

STRENGTH = 2.5
REACH = 0.3
"""Acceleration [m/s^2] of two that touch, and the distance [m] over which it falls to a third."""

WALL_STRENGTH = 3.0
WALL_REACH = 0.1
HURRY = 1.2
"""Largest speed over the wanted one."""

MARGIN = 0.08
"""Distance [m] to a robot at which a pedestrian goes no nearer."""


@dataclass(frozen=True)
class Bodies:
    """Round bodies on the ground.

    Parameters
    ----------
    positions : array (n, 2)
        [m].
    radii : array (n,)
        [m].
    """

    positions: Array
    radii: Array


def accelerations(
    people: Bodies, velocities: Array, wanted: Array, robots: Bodies, wall_distances: Array, wall_normals: Array
) -> Array:
    """Return the accelerations (n, 2) of pedestrians [m/s^2].

    Parameters
    ----------
    people : Bodies
    velocities, wanted : array (n, 2)
        How they walk, and how they want to [m/s].
    robots : Bodies
        Which they keep away from as from each other.
    wall_distances : array (n,)
        From their centres to the nearest obstacle [m].
    wall_normals : array (n, 2)
        Directions away from it.
    """
    pull = (wanted - velocities) / RELAXATION_S
    others = Bodies(np.concatenate([people.positions, robots.positions]), np.concatenate([people.radii, robots.radii]))
    apart = people.positions[:, None] - others.positions[None]
    distance = np.maximum(np.hypot(apart[..., 0], apart[..., 1]), 1e-6)
    gap = distance - people.radii[:, None] - others.radii[None]
    push = STRENGTH * np.exp(-np.maximum(gap, -0.2) / REACH)
    np.fill_diagonal(push, 0.0)
    away = (push / distance)[..., None] * apart
    # To the right as well, so that two who meet do not stand in front of each other.
    aside = 0.3 * np.stack([away[..., 1], -away[..., 0]], axis=-1)
    walls = WALL_STRENGTH * np.exp(-np.maximum(wall_distances - people.radii, -0.1) / WALL_REACH)
    total: Array = pull + (away + aside).sum(axis=1) + walls[:, None] * wall_normals
    return total


def walk(people: Bodies, velocities: Array, acceleration: Array, speeds: Array, robots: Bodies, step: float) -> Array:
    """Return the velocities (n, 2) after a step: not above the wanted speeds by much, and never into a robot.

    Parameters
    ----------
    people : Bodies
    velocities : array (n, 2)
        [m/s].
    acceleration : array (n, 2)
        [m/s^2].
    speeds : array (n,)
        Wanted [m/s].
    robots : Bodies
    step : float
        [s].
    """
    after = velocities + step * acceleration
    speed = np.maximum(np.hypot(after[:, 0], after[:, 1]), 1e-9)
    after = after * np.minimum(1.0, HURRY * speeds / speed)[:, None]
    for position, radius in zip(robots.positions, robots.radii, strict=True):
        apart = people.positions - position
        distance = np.maximum(np.hypot(apart[:, 0], apart[:, 1]), 1e-6)
        normal = apart / distance[:, None]
        towards = np.minimum((after * normal).sum(axis=1), 0.0)
        room = np.maximum(distance - people.radii - radius - MARGIN, 0.0)
        after = after + np.maximum(-towards - room / (2.0 * step), 0.0)[:, None] * normal
    return after
