"""Deterministic control sequences that sampling rarely finds: stop, and turn in place before driving."""

import math

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.navigation.controllers.mppi.rollouts import Limits, Samples

FACING = 0.15
"""Angle [rad] to the point at which driving begins."""


def turn_then_drive(
    pose: Array, velocity: Array, target: tuple[float, float], limits: Limits, steps: int, step: float
) -> Samples:
    """Return the sequence that turns in place to a point, drives there and stops.

    Among random sequences the like are rare, and without them a robot beside its goal stays there. Sequences of a
    simpler controller among the samples keep the optimality of MPPI (Trevisan and Alonso-Mora 2024, "Biased-MPPI").

    Parameters
    ----------
    pose, velocity : ndarray, shape (3,)
        State of the robot: (x, y, yaw) and its rates in its own frame.
    target : tuple of float
        The point.
    limits : Limits
        What the robot can do.
    steps, step : int, float
        Number and length [s] of the steps.

    Returns
    -------
    ndarray of float32, shape (steps, 2)
        Forward and angular velocity.
    """
    controls = np.zeros((steps, 2), dtype=np.float32)
    state = np.array([pose[0], pose[1], pose[2], velocity[0], velocity[2]])
    rates = np.array([limits.vx_max, limits.ax_max, -limits.ax_min, limits.wz_max, limits.az_max])
    fill_turn_then_drive(state, target[0], target[1], rates, step, FACING, controls)
    return controls


@compiled
def fill_turn_then_drive(
    state: Array, target_x: float, target_y: float, rates: Array, step: float, facing: float, controls: Samples
) -> None:
    """Write the sequence; speeds allow braking in time."""
    x, y, yaw, v, w = state
    fastest, gaining, braking, turn, turning = rates
    for t in range(controls.shape[0]):
        dx, dy = target_x - x, target_y - y
        away = math.hypot(dx, dy)
        wanted_v = wanted_w = 0.0
        if away > 0.01:
            angle = (math.atan2(dy, dx) - yaw + math.pi) % (2.0 * math.pi) - math.pi
            wanted_w = min(turn, _braked(abs(angle), turning, step))
            wanted_w = wanted_w if angle > 0.0 else -wanted_w
            if abs(angle) < facing:
                wanted_v = min(fastest, _braked(away, braking, step))
        v = min(max(wanted_v, v - braking * step), v + gaining * step)
        w = min(max(wanted_w, w - turning * step), w + turning * step)
        controls[t, 0] = np.float32(v)
        controls[t, 1] = np.float32(w)
        x += v * step * math.cos(yaw + 0.5 * w * step)
        y += v * step * math.sin(yaw + 0.5 * w * step)
        yaw += w * step


@compiled
def _braked(left: float, braking: float, step: float) -> float:
    """Return the speed from which a robot that brakes from the next step on stops in time."""
    change = braking * step
    return min(math.sqrt(2.0 * braking * left + 0.25 * change * change) - 0.5 * change, left / step)
