"""Holds one link at its place on another: by a stiff spring and damper that pull back at the holder."""

from __future__ import annotations

import numpy as np

from daidalos.description.pose import Pose
from daidalos.simulation.forces import Forces
from daidalos.simulation.instance import LinkView

_BANDWIDTH = 60.0
"""Of the spring that holds [rad/s]: stiff, and still well below the steps' rate."""


def pull(key: str, holder: LinkView, target: LinkView, place: Pose) -> None:
    """Pull a link to its place, until `let_go`; to be called in every step.

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
    wanted = holder.pose @ place
    error = (target.pose.inverse @ wanted).orientation
    turn = 2 * np.array(error[:3]) * np.sign(error[3] or 1.0)
    linear, angular = target.velocity()
    own_linear, own_angular = holder.velocity()
    arm = np.array(wanted.position) - np.array(holder.pose.position)
    mass = float(model.body_subtreemass[target.body])
    moment = float(model.body_inertia[target.body].mean())
    gap = np.array(wanted.position) - np.array(target.pose.position)
    slip = own_linear + np.cross(own_angular, arm) - linear
    force = mass * (_BANDWIDTH**2 * gap + 2 * _BANDWIDTH * slip - np.array(model.opt.gravity))
    torque = moment * (_BANDWIDTH**2 * (target.rotation @ turn) + 2 * _BANDWIDTH * (own_angular - angular))
    # The force acts at the link's origin; forces are held at centres of mass.
    at_target = np.array(target.pose.position) - data.xipos[target.body]
    at_holder = np.array(target.pose.position) - data.xipos[holder.body]
    physics.forces.hold(f"{key}/held", target.body, force, torque + np.cross(at_target, force))
    physics.forces.hold(f"{key}/own", holder.body, -force, -torque - np.cross(at_holder, force))


def let_go(key: str, forces: Forces) -> None:
    """Hold no longer."""
    for part in ("held", "own"):
        forces.release(f"{key}/{part}")
