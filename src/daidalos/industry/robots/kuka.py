"""KUKA's arms, and the angles that their controllers show.

The controller's axes 1, 4 and 6 turn the other way, and its axes 2 and 3 are at -90 and 90 degrees where those of
`Arm` are at zero.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.industry.robots.arm import Arm, Axis

_SIGNS = np.array([-1.0, 1.0, 1.0, -1.0, 1.0, -1.0])
_ZEROS = np.array([0.0, -0.5 * math.pi, 0.5 * math.pi, 0.0, 0.0, 0.0])

KUKA_ARMS = (
    Arm(
        name="kr500_2mt",
        title="KUKA KR 500-2 MT",
        base_height=1.045,
        shoulder_offset=0.5,
        lower_arm=1.3,
        elbow_offset=-0.055,
        forearm=1.025,
        flange=0.29,
        axes=(
            Axis.from_degrees(-185, 185, 69),
            Axis.from_degrees(-40, 110, 57),
            Axis.from_degrees(-184, 60, 69),
            Axis.from_degrees(-350, 350, 76),
            Axis.from_degrees(-118, 118, 76),
            Axis.from_degrees(-350, 350, 120),
        ),
        payload=500.0,
        mass=2350.0,
        reach=2.826,
        source="KUKA specification of KR 360-2 and KR 500-2",
    ),
)


def controller_angles(joints: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the axes A1 to A6 [rad] of KUKA's controller for joint angles (..., 6) of `Arm` [rad]."""
    axes: NDArray[np.float64] = _SIGNS * joints + _ZEROS
    return axes


def joint_angles(axes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the joint angles of `Arm` [rad] for the axes A1 to A6 (..., 6) of KUKA's controller [rad]."""
    joints: NDArray[np.float64] = _SIGNS * (axes - _ZEROS)
    return joints
