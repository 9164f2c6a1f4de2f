"""Jacobians and torques of arms with a spherical wrist, over arrays of joint angles.

The frames of the links are those of `Arm` and of its description: parallel to the base at angles zero, with their
origins on the joints. All vectors are in the base.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled
from daidalos.industry.robots.arm import Arm

AXES = (2, 1, 1, 0, 1, 0)
"""Which coordinate each axis turns about."""


def link_frames(arm: Arm, joints: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Compute the frames of links 1 to 6 in the base.

    Parameters
    ----------
    arm : Arm
        The arm.
    joints : array of shape (n, 6)
        Angles [rad].

    Returns
    -------
    rotations : array of shape (n, 6, 3, 3)
    origins : array of shape (n, 6, 3)
        Points on the axes [m].
    """
    angles = np.ascontiguousarray(joints, dtype=np.float64)
    rotations, origins = np.empty((len(angles), 6, 3, 3)), np.empty((len(angles), 6, 3))
    _link_frames(angles, joint_offsets(arm), rotations, origins)
    return rotations, origins


def joint_offsets(arm: Arm) -> NDArray[np.float64]:
    """Return the origin of each joint in the frame of the link before it, an array of shape (6, 3) [m]."""
    return np.array(
        [
            [0.0, 0.0, 0.0],
            [arm.shoulder_offset, 0.0, arm.base_height],
            [0.0, 0.0, arm.lower_arm],
            [0.0, 0.0, arm.elbow_offset],
            [arm.forearm, 0.0, 0.0],
            [arm.flange, 0.0, 0.0],
        ]
    )


def jacobians(arm: Arm, joints: NDArray[np.float64], points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Compute the Jacobians of points that move with link 6.

    Parameters
    ----------
    arm : Arm
        The arm.
    joints : array of shape (n, 6)
        Angles [rad].
    points : array of shape (n, 3)
        Positions in the base [m].

    Returns
    -------
    array of shape (n, 6, 6)
        Linear velocity in the first three rows, angular velocity in the last three.
    """
    rotations, origins = link_frames(arm, joints)
    out = np.empty((len(origins), 6, 6))
    for joint, coordinate in enumerate(AXES):
        axis = rotations[:, joint, :, coordinate]
        out[:, :3, joint] = np.cross(axis, points - origins[:, joint])
        out[:, 3:, joint] = axis
    return out


def holding_torques(
    arm: Arm,
    joints: NDArray[np.float64],
    masses: NDArray[np.float64],
    centres: NDArray[np.float64],
    gravity: tuple[float, float, float] = (0.0, 0.0, -9.80665),
) -> NDArray[np.float64]:
    """Compute the torques that hold the links against gravity.

    Parameters
    ----------
    arm : Arm
        The arm.
    joints : array of shape (n, 6)
        Angles [rad].
    masses : array of shape (6,)
        Masses of links 1 to 6, that of the tool included in the last [kg].
    centres : array of shape (6, 3)
        Centres of mass in the frames of the links [m].
    gravity : tuple of float
        Acceleration in the base [m/s^2].

    Returns
    -------
    array of shape (n, 6)
        [Nm]
    """
    rotations, origins = link_frames(arm, joints)
    at = origins + np.einsum("nlij,lj->nli", rotations, centres)
    out = np.empty((len(origins), 6))
    for joint, coordinate in enumerate(AXES):
        carried = masses[joint:].sum()
        moment = np.einsum("l,nli->ni", masses[joint:], at[:, joint:]) - carried * origins[:, joint]
        out[:, joint] = -np.einsum("ni,ni->n", rotations[:, joint, :, coordinate], np.cross(moment, gravity))
    return out


@compiled
def _link_frames(
    joints: NDArray[np.float64],
    offsets: NDArray[np.float64],
    rotations: NDArray[np.float64],
    origins: NDArray[np.float64],
) -> None:
    for n in range(joints.shape[0]):
        for joint in range(6):
            c, s = np.cos(joints[n, joint]), np.sin(joints[n, joint])
            first, second = (0, 1) if joint == 0 else ((2, 0) if joint in (1, 2, 4) else (1, 2))
            for i in range(3):
                for j in range(3):
                    if joint == 0:
                        rotations[n, 0, i, j] = 1.0 if i == j else 0.0
                    else:
                        rotations[n, joint, i, j] = rotations[n, joint - 1, i, j]
                origins[n, joint, i] = offsets[joint, i] if joint == 0 else origins[n, joint - 1, i]
                if joint > 0:
                    for k in range(3):
                        origins[n, joint, i] += rotations[n, joint - 1, i, k] * offsets[joint, k]
            for i in range(3):
                a, b = rotations[n, joint, i, first], rotations[n, joint, i, second]
                rotations[n, joint, i, first] = c * a + s * b
                rotations[n, joint, i, second] = c * b - s * a
