"""Contact friction and stiffness: conversion of SDF surfaces to MuJoCo geoms.

ODE, which SDF's numbers are written for, takes the smaller friction of two surfaces; MuJoCo takes the
larger one, or that of the geom with the higher priority. Giving a geom the higher priority the less
friction it has makes MuJoCo take the smaller one as well.
"""

from __future__ import annotations

import math
from typing import Any

from daidalos.description.link import Surface

DEFAULT_FRICTION = 1.0
MAX_FRICTION = 2.0
"""Descriptions write 100 or 1e5 for "does not slip"; the contact solver converges badly with those."""

SOLREF = (0.004, 2.0)
"""Time constant [s] and damping ratio of contacts.

They are stiff enough that wheels do not creep, and damped so far that what hits leaves with 4 % of its speed; with
critical damping it leaves with exp(-2) = 13.5 %, since the damper has stopped it before the spring has let go. Half the
time constant would lift what slides fast four times as far from the ground.
"""

SOLIMP = (0.999, 0.9999)
"""Impedance of contacts at no penetration and at 1 mm: heavy things on light ones sink little."""

BOUNCING_FREQUENCY = 400.0
"""Bandwidth of bouncing contacts [rad/s]: they last a few steps, since shorter ones would lose the bounce."""

BOUNCING_WEIGHT = 1e3
"""Weight of a bouncing surface relative to one that does not bounce."""

_FRICTIONLESS = 1e-3


def set_surface(geom: Any, surface: Surface) -> None:
    """Set friction, stiffness and collision bits of a geom.

    Parameters
    ----------
    geom : MjsGeom
    surface : Surface
        Two directions of friction become their mean, since a geom has only one coefficient.
    """
    set_friction(geom, surface)
    bounces = surface.restitution > left_speed(SOLREF[1])
    geom.solref[:2] = _bouncing(surface.restitution) if bounces else SOLREF
    geom.solimp[:2] = SOLIMP
    geom.solmix = BOUNCING_WEIGHT if bounces else 1.0
    geom.margin = 0.0


def set_friction(geom: Any, surface: Surface) -> None:
    """Set only a geom's friction."""
    friction = friction_of(surface)
    geom.priority = round(1000 * (MAX_FRICTION - friction))
    if friction < _FRICTIONLESS:
        geom.condim = 1
        return
    torsional = (surface.torsional or 0.0) * surface.patch_radius
    geom.condim = 4 if torsional > 0 else 3
    geom.friction[:] = (friction, min(torsional, 1.0), 0.0)


def left_speed(ratio: float) -> float:
    """Return the share of its speed with which a body leaves a spring and damper that can not pull.

    It leaves when the force is zero, before the spring is released (T. Schwager and T. Poeschel, "Coefficient of
    restitution and linear-dashpot model revisited", 2007).

    Parameters
    ----------
    ratio : float
        Damping ratio, above zero.
    """
    if abs(ratio - 1) < 1e-6:
        return math.exp(-2.0)
    root = math.sqrt(abs(1 - ratio * ratio))
    if ratio < 1:
        return math.exp(-ratio / root * math.atan2(2 * ratio * root, 2 * ratio * ratio - 1))
    return math.exp(-ratio / root * math.log((ratio + root) / (ratio - root)))


def _bouncing(restitution: float) -> tuple[float, float]:
    """Return time constant and damping ratio of a contact with a restitution coefficient."""
    wanted = min(restitution, 0.98)
    low, high = 1e-3, SOLREF[1]
    while high - low > 1e-6:
        middle = (low + high) / 2
        low, high = (middle, high) if left_speed(middle) > wanted else (low, middle)
    return 1 / (low * BOUNCING_FREQUENCY), low


def friction_of(surface: Surface) -> float:
    """Return the Coulomb friction coefficient of a surface."""
    mu = DEFAULT_FRICTION if surface.mu is None else surface.mu
    mu2 = mu if surface.mu2 is None else surface.mu2
    return max(0.0, (min(mu, MAX_FRICTION) + min(mu2, MAX_FRICTION)) / 2)
