"""Deflection of a loaded arm: springs and play of its transmissions.

A wrench is the one that the tool exerts on the workpiece: force [N] and moment about the tool's centre point [Nm]. The
torques of the transmissions are then J^T W + G + Ff, with the torques G that hold the links and Ff that overcome
friction; each transmission is wound by K^-1 times its torque and lies against the flank that the torque's sign says.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.elasticity.elasticity import Elasticity
from daidalos.industry.elasticity.jacobians import jacobians
from daidalos.industry.motion.kinematics import forward
from daidalos.industry.robots.arm import Arm

MAX_ITERATIONS = 50
MAX_WINDING = 0.1
"""Winding of a transmission beyond which it is no linear spring [rad]."""
SETTLING_ITERATIONS = 8
"""Iterations after which transmissions stay on their flanks: a torque at the threshold would go to and fro."""


@dataclass(frozen=True)
class Options:
    """What counts for the deflection.

    Attributes
    ----------
    gravity : bool
        Whether the weight of the links counts. Not for a robot whose points were taught or measured unloaded: they hold
        the deflection by gravity already.
    friction : bool
        Whether friction of the moving joints counts.
    backlash : tuple of bool
        The axes whose backlash counts.
    """

    gravity: bool = False
    friction: bool = False
    backlash: tuple[bool, ...] = (True,) * 6


def transmission_torques(
    arm: Arm,
    elasticity: Elasticity,
    joints: NDArray[np.float64],
    points: NDArray[np.float64],
    wrenches: NDArray[np.float64],
    speeds: NDArray[np.float64],
    options: Options,
) -> NDArray[np.float64]:
    """Compute the torques J^T W + G + Ff of the transmissions (n, 6) [Nm].

    Parameters
    ----------
    arm, elasticity : Arm, Elasticity
        The arm.
    joints, speeds : array of shape (n, 6)
        Angles of the links [rad] and their speeds [rad/s].
    points : array of shape (n, 3)
        The tool's centre point in the base [m].
    wrenches : array of shape (n, 6)
        In the axes of the base [N, Nm].
    options : Options
        What counts.
    """
    torques: NDArray[np.float64] = np.einsum("nij,ni->nj", jacobians(arm, joints, points), wrenches)
    if options.gravity:
        torques += elasticity.gravity(arm, joints)
    if options.friction:
        torques += elasticity.friction(speeds)
    return torques


def flanks(torques: NDArray[np.float64], hold: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return against which flank, -1 or 1, each transmission lies along a path (n, 6), with hysteresis.

    A transmission goes over to the other flank where the sign of its torque (n, 6) has changed and the torque exceeds
    `hold` (6,), the friction that keeps the link where it is [Nm]. Before the first torque above `hold` it lies where
    that torque puts it, and where there is none, where the mean torque does.
    """
    known = continued(np.where(np.abs(torques) > hold, np.sign(torques), 0.0))
    return np.where(known == 0.0, np.where(torques.sum(axis=0) < 0.0, -1.0, 1.0), known)


def continued(sides: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return flanks along a path (n, 6) with zeros replaced by the flank before them, at first by the one after them.

    The zeros of an axis that has no others are kept.
    """
    at = np.where(sides != 0.0, np.arange(len(sides))[:, None], -1)
    np.maximum.accumulate(at, axis=0, out=at)
    first = np.argmax(sides != 0.0, axis=0)
    return np.take_along_axis(sides, np.where(at < 0, first[None, :], at), axis=0)


def windings(
    elasticity: Elasticity,
    torques: NDArray[np.float64],
    options: Options,
    sides: NDArray[np.float64] | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how far the motors are ahead of the links (n, 6) [rad], and the flanks (n, 6), which may be known."""
    if sides is None:
        sides = flanks(torques, elasticity.coulomb_friction)
    play = 0.5 * elasticity.backlash * np.array(options.backlash, dtype=np.float64)
    return torques / elasticity.stiffness + play * sides, sides


def deflections(
    arm: Arm, joints: NDArray[np.float64], points: NDArray[np.float64], wound: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Compute [dP; dTheta] = La J dq: by how much the tool stays behind the programmed pose.

    Parameters
    ----------
    arm : Arm
        The arm.
    joints : array of shape (n, 6)
        Angles [rad].
    points : array of shape (n, 3)
        The tool's centre point in the base [m].
    wound : array of shape (n, 6)
        How far the motors are ahead of the links [rad].

    Returns
    -------
    array of shape (n, 6)
        X, Y, Z [m], and the angles A, B, C about z, y', x'' of the flange [rad].
    """
    out: NDArray[np.float64] = np.einsum("nij,nj->ni", jacobians(arm, joints, points), wound)
    out[:, 3:] = np.einsum("nij,nj->ni", angle_rates(forward(arm, joints)[:, :3, :3]), out[:, 3:])
    return out


def angle_rates(rotations: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the matrices (n, 3, 3) from angular velocity in the base to the rates of A, B, C, for rotations (n, 3, 3).

    A, B and C turn about z, y' and x''. Where B is +-90 degrees, rates are infinite: they are limited to 1e6 there.
    """
    a = np.arctan2(rotations[:, 1, 0], rotations[:, 0, 0])
    cos_b = np.maximum(np.hypot(rotations[:, 0, 0], rotations[:, 1, 0]), 1e-6)
    tan_b = -rotations[:, 2, 0] / cos_b
    ca, sa, zero, one = np.cos(a), np.sin(a), np.zeros(len(a)), np.ones(len(a))
    rows = [[ca * tan_b, sa * tan_b, one], [-sa, ca, zero], [ca / cos_b, sa / cos_b, zero]]
    return np.moveaxis(np.array(rows), -1, 0)


@dataclass(frozen=True)
class Loaded:
    """State of a loaded arm along a path.

    Attributes
    ----------
    joints : array of shape (n, 6)
        Angles of the links [rad].
    poses : array of shape (n, 4, 4)
        Of the tool's centre point in the base.
    torques : array of shape (n, 6)
        Of the transmissions [Nm].
    sides : array of shape (n, 6)
        Flanks on which the transmissions lie, -1 or 1.
    """

    joints: NDArray[np.float64]
    poses: NDArray[np.float64]
    torques: NDArray[np.float64]
    sides: NDArray[np.float64]


def load(
    arm: Arm,
    elasticity: Elasticity,
    motors: NDArray[np.float64],
    tool: NDArray[np.float64],
    wrenches: NDArray[np.float64],
    speeds: NDArray[np.float64],
    options: Options,
    tolerance: float = 1e-10,
    sides: NDArray[np.float64] | None = None,
) -> Loaded:
    """Compute where a loaded arm is in equilibrium, for motor angles along a path.

    Parameters
    ----------
    arm, elasticity : Arm, Elasticity
        The arm.
    motors : array of shape (n, 6)
        Angles of the motors, after the gears [rad].
    tool : array of shape (4, 4)
        From the tool's centre point to tool0.
    wrenches : array of shape (n, 6)
        That the tool exerts on the workpiece, in the axes of the tool [N, Nm].
    speeds : array of shape (n, 6)
        Of the joints [rad/s].
    options : Options
        What counts.
    tolerance : float
        Change of an angle at which the iteration ends [rad].
    sides : array of shape (n, 6), optional
        Signs of the flanks on which the transmissions lie; where they are not given, the torques decide.

    Raises
    ------
    ValueError
        Where the arm is too soft for the load: a transmission is wound beyond `MAX_WINDING`, or nothing balances it.
    """
    joints = np.array(motors, dtype=np.float64)
    held = sides
    for iteration in range(MAX_ITERATIONS):
        poses, torques = _under_load(arm, elasticity, joints, tool, wrenches, speeds, options)
        earlier, (wound, sides) = sides, windings(elasticity, torques, options, held)
        if held is None and iteration == SETTLING_ITERATIONS:
            held = continued(np.where(sides == earlier, sides, 0.0))
        if np.abs(wound).max(initial=0.0) > MAX_WINDING:
            point, axis = (int(one) for one in np.unravel_index(np.abs(wound).argmax(), wound.shape))
            raise ValueError(f"point {point}: the load winds axis {axis + 1} by more than {MAX_WINDING:g} rad")
        change = motors - wound - joints
        if np.abs(change).max(initial=0.0) < tolerance:
            return Loaded(joints, poses, torques, sides)
        joints += change
    worst = int(np.abs(change).max(axis=1).argmax())
    raise ValueError(f"point {worst}: no equilibrium under this load within {MAX_ITERATIONS} iterations")


def flanks_at(
    arm: Arm,
    elasticity: Elasticity,
    joints: NDArray[np.float64],
    tool: NDArray[np.float64],
    wrenches: NDArray[np.float64],
    speeds: NDArray[np.float64],
    options: Options,
) -> NDArray[np.float64]:
    """Return the flanks (n, 6) where the links, and not the motors, are at angles (n, 6); see `load` and `flanks`."""
    _, torques = _under_load(arm, elasticity, joints, tool, wrenches, speeds, options)
    return flanks(torques, elasticity.coulomb_friction)


def _under_load(
    arm: Arm,
    elasticity: Elasticity,
    joints: NDArray[np.float64],
    tool: NDArray[np.float64],
    wrenches: NDArray[np.float64],
    speeds: NDArray[np.float64],
    options: Options,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the poses of the tool (n, 4, 4) and the torques of the transmissions (n, 6) for angles of the links."""
    poses = forward(arm, joints) @ tool
    rotations = poses[:, :3, :3]
    turned = np.concatenate(
        [np.einsum("nij,nj->ni", rotations, wrenches[:, part]) for part in (slice(3), slice(3, 6))], axis=1
    )
    return poses, transmission_torques(arm, elasticity, joints, poses[:, :3, 3], turned, speeds, options)
