"""Couplings beyond the tree of bodies: mimic joints, gears, screws and closed loops."""

from __future__ import annotations

from typing import Any

import mujoco

from daidalos.common.pose3 import Pose
from daidalos.description.joint import Joint
from daidalos.simulation.conversion.joints import add_joints

SOLREF = (0.002, 1.0)
"""Time constant [s] and damping ratio of couplings: the stiffest at steps of 1 ms."""

SOLIMP = (0.9999, 0.9999)
"""Impedance of couplings: a loop gives way by micrometres, though a light ghost closes it."""

_GHOST_MASS_RATIO = 0.01
_MIN_MASS = 1e-4


def couple(spec: Any, follower: str, leader: str, offset: float, multiplier: float) -> None:
    """Constrain follower = offset + multiplier * leader.

    Parameters
    ----------
    spec : MjSpec
    follower, leader : str
        Names of MuJoCo's joints.
    offset, multiplier : float
        In the units of the joints.
    """
    coupling = spec.add_equality(
        name=f"{follower}~{leader}",
        type=mujoco.mjtEq.mjEQ_JOINT,
        objtype=mujoco.mjtObj.mjOBJ_JOINT,
        name1=follower,
        name2=leader,
    )
    coupling.data[:5] = (offset, multiplier, 0.0, 0.0, 0.0)
    coupling.solref[:2], coupling.solimp[:2] = SOLREF, SOLIMP


def close_loop(spec: Any, parent: Any, child: Any, joint: Joint, name: str) -> list[str]:
    """Add a joint to a link that already has a parent joint.

    A ghost of the child, light against it, takes the joint and is welded to the child. So every type
    works, with its limits and friction, and actuators find it.

    Parameters
    ----------
    spec : MjSpec
    parent, child : MjsBody
        In their places with every joint at zero.
    joint : Joint
    name : str
        Of the joint in the simulation.

    Returns
    -------
    list of str
        Names of MuJoCo's joints.
    """
    ghost = _add_body(parent, f"{name}::ghost", joint.origin @ joint.anchor.inverse)
    mass = max(_GHOST_MASS_RATIO * float(child.mass), _MIN_MASS)
    ghost.explicitinertial = True
    ghost.mass = mass
    ghost.ipos = child.ipos
    moments = [_GHOST_MASS_RATIO * float(moment) for moment in child.inertia]
    ghost.inertia = moments if child.mass else [1e-2 * mass] * 3
    ghost.iquat = child.iquat
    ghost.gravcomp = 1.0
    added = add_joints(ghost, joint, name)
    sites = [body.add_site(name=f"{name}::{place}") for body, place in ((ghost, "ghost"), (child, "child"))]
    weld = spec.add_equality(
        name=f"{name}::weld",
        type=mujoco.mjtEq.mjEQ_WELD,
        objtype=mujoco.mjtObj.mjOBJ_SITE,
        name1=sites[0].name,
        name2=sites[1].name,
    )
    weld.solref[:2], weld.solimp[:2] = SOLREF, SOLIMP
    return added


def _add_body(parent: Any, name: str, pose: Pose) -> Any:
    x, y, z, w = pose.orientation
    return parent.add_body(name=name, pos=list(pose.position), quat=[w, x, y, z])
