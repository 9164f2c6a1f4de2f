"""State of a rigid body with 15 variables, and how it moves on at constant acceleration.

The state holds the position x, y, z [m] and the angles roll, pitch, yaw [rad] in the world's frame, and in the body's
frame the velocity [m/s], the angular velocity [rad/s] and the acceleration [m/s^2].
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array

SIZE = 15
"""Number of variables."""

POSITION, ANGLES, VELOCITY = slice(0, 3), slice(3, 6), slice(6, 9)
ANGULAR_VELOCITY, ACCELERATION = slice(9, 12), slice(12, 15)
"""Where the variables stand in the state."""

PLANAR_ZEROS = np.array([2, 3, 4, 8, 9, 10, 14])
"""Variables that are zero for a body that moves on a plane."""

_COMPLEX_STEP = 1e-30


def rotation(angles: NDArray[Any]) -> NDArray[Any]:
    """Return the rotation matrices of angles.

    Parameters
    ----------
    angles : ndarray, shape (3, ...)
        Roll, pitch and yaw [rad]: turns about the fixed axes x, y and z, in this order. They may be complex.

    Returns
    -------
    ndarray, shape (3, 3, ...)
    """
    (sr, sp, sy), (cr, cp, cy) = np.sin(angles), np.cos(angles)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def move(states: NDArray[Any], seconds: float) -> NDArray[Any]:
    """Return states after a while at constant acceleration.

    Parameters
    ----------
    states : ndarray, shape (15, n)
        They may be complex, as `jacobian` needs them.
    seconds : float
        How long [s].

    Returns
    -------
    ndarray, shape (15, n)
        With angles that are not wrapped.
    """
    angles, turn = states[ANGLES], states[ANGULAR_VELOCITY]
    way = states[VELOCITY] * seconds + 0.5 * seconds**2 * states[ACCELERATION]
    sine, cosine, slope = np.sin(angles[0]), np.cos(angles[0]), np.tan(angles[1])
    about_yaw = sine * turn[1] + cosine * turn[2]
    rates = [turn[0] + slope * about_yaw, cosine * turn[1] - sine * turn[2], about_yaw / np.cos(angles[1])]
    moved = states.copy()
    moved[POSITION] += np.einsum("ijn,jn->in", rotation(angles), way)
    moved[ANGLES] += np.array(rates) * seconds
    moved[VELOCITY] += states[ACCELERATION] * seconds
    return moved


def jacobian(state: Array, seconds: float) -> Array:
    """Return the derivative of `move` at a state, shape (15, 15), by a complex step, which is exact to rounding."""
    steps = state[:, None] + 1j * _COMPLEX_STEP * np.eye(SIZE)
    return np.asarray(move(steps, seconds).imag / _COMPLEX_STEP, dtype=float)
