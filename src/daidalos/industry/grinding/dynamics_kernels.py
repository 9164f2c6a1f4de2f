"""Kernel of the dynamics of arm, valve, piston, spindle and sensor over one period of the control."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled
from daidalos.industry.grinding.contact_kernels import interpolate

PISTON, SPEED, PRESSURE, SEAL, ARM, SPINDLE, PHASE, FILTERED, FILTER_RATE = range(9)
"""Entries of the state: piston's position and speed, pressure, deflection of the seals, arm's offset, spindle's speed
and angle, filtered force and its rate."""
STATES = 9
SUBSTEPS = 10

_FREE, _CLOSED, _LOCKED = range(3)
_STOP_STIFFNESS = 1e5
_STOP_DAMPING = 800.0
_SEAL_DAMPING = 500.0
"""Damping of the seals before they slide [N s/m]."""


@compiled
def advance(
    state: NDArray[np.float64],
    constants: NDArray[np.float64],
    command: NDArray[np.float64],
    mode: int,
    closed_at: float,
    surface: NDArray[np.float64],
    depths: NDArray[np.float64],
    forces: NDArray[np.float64],
    lever: float,
    period: float,
    out: NDArray[np.float64],
) -> None:
    """Advance the state by one period.

    Parameters
    ----------
    state
        See `STATES`; changed.
    constants
        Area, mass, stroke, valve time, coulomb, static, stribeck, viscous, seal stiffness, closed stiffness, arm's time
        and speed, gravity's force against the piston, damping of the contact, spindle's idle speed, droop, time,
        unbalance, friction of the disc, cut-off of the filter [rad/s].
    command
        Pressure [Pa] and offset of the arm [m], as they come out of their dead times.
    mode
        0: valve open; 1: closed, the air is a spring; 2: piston blocked.
    closed_at
        Position of the piston at which the valve was closed [m].
    surface
        Distance of the first touch from the arm's nominal path, along the tool, at begin and end of the period [m].
    depths, forces
        Table of the contact.
    lever
        Radius at which the disc rubs [m].
    out
        Out (4): means of contact force, depth, torque, and force of the sensor [N, m, N m, N].
    """
    (area, mass, stroke, valve_time, coulomb, static, stribeck, viscous, seal, air) = constants[:10]
    (arm_time, arm_speed, gravity, damping, idle, droop, spindle_time, unbalance, rubbing, cut_off) = constants[10:]
    step = period / SUBSTEPS
    surface_speed = (surface[1] - surface[0]) / period
    out[:] = 0.0
    for index in range(SUBSTEPS):
        state[PRESSURE] += step / valve_time * (command[0] - state[PRESSURE])
        arm_rate = min(max((command[1] - state[ARM]) / arm_time, -arm_speed), arm_speed)
        state[ARM] += step * arm_rate
        touch = surface[0] + (surface[1] - surface[0]) * index / SUBSTEPS
        speed = state[SPEED]
        depth = state[ARM] + state[PISTON] - touch
        force, _ = interpolate(depth, depths, forces)
        if force > 0.0:
            # The damping fades out with the contact: a disc that leaves does not stick.
            force += damping * (speed + arm_rate - surface_speed) * force / (force + 1.0)
            force = max(force, 0.0)
        shake = unbalance * state[SPINDLE] ** 2 * math.sin(state[PHASE])
        if mode == _LOCKED:
            state[SPEED], acceleration = 0.0, 0.0
        else:
            limit = coulomb + (static - coulomb) * math.exp(-((speed / stribeck) ** 2))
            slip = speed - seal * abs(speed) / max(limit, 1e-9) * state[SEAL]
            longest = limit / seal
            state[SEAL] = min(max(state[SEAL] + step * slip, -longest), longest)
            drag = seal * state[SEAL] + _SEAL_DAMPING * slip * math.exp(-((speed / stribeck) ** 2)) + viscous * speed
            if limit <= 1e-9:
                drag = viscous * speed
            drive = area * state[PRESSURE]
            if mode == _CLOSED:
                drive -= air * (state[PISTON] - closed_at)
            total = drive - drag - gravity - force + shake + _stop(state[PISTON], speed, stroke)
            acceleration = total / mass
            state[SPEED] += step * acceleration
            state[PISTON] += step * state[SPEED]
        torque = rubbing * force * lever
        state[SPINDLE] = max(state[SPINDLE] + step / spindle_time * (idle - droop * torque - state[SPINDLE]), 0.0)
        state[PHASE] = (state[PHASE] + step * state[SPINDLE]) % (2.0 * math.pi)
        sensed = force + gravity + mass * acceleration - shake
        state[FILTER_RATE] += step * cut_off * (cut_off * (sensed - state[FILTERED]) - 1.4142 * state[FILTER_RATE])
        state[FILTERED] += step * state[FILTER_RATE]
        out[0] += force / SUBSTEPS
        out[1] += max(depth, 0.0) / SUBSTEPS
        out[2] += torque / SUBSTEPS
    out[3] = state[FILTERED]


@compiled(inline=True)
def _stop(position: float, speed: float, stroke: float) -> float:
    """Return the force of the ends of the stroke."""
    if position < 0.0:
        return max(-_STOP_STIFFNESS * position - _STOP_DAMPING * speed, 0.0)
    if position > stroke:
        return min(-_STOP_STIFFNESS * (position - stroke) - _STOP_DAMPING * speed, 0.0)
    return 0.0
