"""Attachment of one link to another by a stiff spring and damper."""

from __future__ import annotations

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.pose3 import Pose
from daidalos.simulation.forces import Forces
from daidalos.simulation.instance import LinkView

_BANDWIDTH = 60.0
"""Bandwidth of the holding spring [rad/s]: stiff, but well below the rate of the steps."""


def pull(key: str, holder: LinkView, target: LinkView, place: Pose) -> None:
    """Pull a link to its target pose; to be called in every step until `let_go`.

    Parameters
    ----------
    key : str
        Who holds.
    holder, target : LinkView
    place : Pose
        Of the target in the holder.
    """
    physics = holder.physics
    model, data = physics.model, physics.data
    held, own = target.pose, holder.pose
    wanted = own @ place
    error = (held.inverse @ wanted).orientation
    turn = 2 * np.array(error[:3]) * np.sign(error[3] or 1.0)
    linear, angular = target.velocity()
    own_linear, own_angular = holder.velocity()
    here, there = np.array(held.position), np.array(wanted.position)
    mass = float(model.body_subtreemass[target.body])
    moment = float(model.body_inertia[target.body].sum()) / 3
    slip = own_linear + _cross(own_angular, there - np.array(own.position)) - linear
    force = mass * (_BANDWIDTH**2 * (there - here) + 2 * _BANDWIDTH * slip - np.array(model.opt.gravity))
    torque = moment * (_BANDWIDTH**2 * (target.rotation @ turn) + 2 * _BANDWIDTH * (own_angular - angular))
    # The force acts at the link's origin; forces are held at centres of mass.
    at_target, at_holder = here - data.xipos[target.body], here - data.xipos[holder.body]
    physics.forces.hold(f"{key}/held", target.body, force, torque + _cross(at_target, force))
    physics.forces.hold(f"{key}/own", holder.body, -force, -torque - _cross(at_holder, force))


def let_go(key: str, forces: Forces) -> None:
    """Remove the forces."""
    for part in ("held", "own"):
        forces.release(f"{key}/{part}")


def _cross(first: Array, second: Array) -> Array:
    """Return the cross product of two vectors (3,), faster than numpy's."""
    (a, b, c), (x, y, z) = first.tolist(), second.tolist()
    return np.array((b * z - c * y, c * x - a * z, a * y - b * x))
