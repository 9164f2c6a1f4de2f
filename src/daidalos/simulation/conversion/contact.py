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

SOLREF = (0.004, 1.0)
"""Time constant [s] and damping ratio of contacts: stiff enough that wheels do not creep."""

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
    geom.solref[:2] = _bouncing(surface.restitution) if surface.restitution > 0 else SOLREF
    geom.solmix = BOUNCING_WEIGHT if surface.restitution > 0 else 1.0
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


def _bouncing(restitution: float) -> tuple[float, float]:
    """Return time constant and damping ratio of a contact with a restitution coefficient.

    A spring and damper with damping ratio z let go with exp(-pi z / sqrt(1 - z^2)) of the speed.
    """
    share = math.log(min(restitution, 0.98))
    ratio = -share / math.hypot(math.pi, share)
    return 1 / (ratio * BOUNCING_FREQUENCY), ratio


def friction_of(surface: Surface) -> float:
    """Return the Coulomb friction coefficient of a surface."""
    mu = DEFAULT_FRICTION if surface.mu is None else surface.mu
    mu2 = mu if surface.mu2 is None else surface.mu2
    return max(0.0, (min(mu, MAX_FRICTION) + min(mu2, MAX_FRICTION)) / 2)
