"""Kernels of `daidalos.industry.motion.redundant_kinematics`.

`geometry` is `RedundantArm.geometry`: eight offsets, seven directions and the shoulder. `places` are the indices of the
elbow's and the wrist's axis.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled

Array = NDArray[np.float64]

_AXES = 7
_STEPS = 80
_PATIENCE = 6
"""Steps without a better solution after which the next beginning is tried."""

_STEP = 0.5
"""Greatest change of an angle in one step [rad]."""

_DIFFERENCE = 1e-6
_ROUNDING = 1e-14
_CENTRING = 0.1
"""Share of the way to the middle of the ranges by which a step without an arm angle moves in the null space."""


@compiled
def chain(angles: Array, geometry: Array, rotation: Array, origins: Array, axes: Array) -> None:
    """Compute one arm's rotation of the flange (3, 3), origins of the axes and the flange (8, 3), and axes (7, 3)."""
    rotation[:] = 0.0
    for k in range(3):
        rotation[k, k] = 1.0
    place = np.zeros(3)
    for n in range(_AXES):
        offset, direction = geometry[n], geometry[8 + n]
        for k in range(3):
            place[k] += rotation[k, 0] * offset[0] + rotation[k, 1] * offset[1] + rotation[k, 2] * offset[2]
            origins[n, k] = place[k]
            axes[n, k] = rotation[k, 0] * direction[0] + rotation[k, 1] * direction[1] + rotation[k, 2] * direction[2]
        cosine, sine = math.cos(angles[n]), math.sin(angles[n])
        x, y, z = direction
        rest = 1.0 - cosine
        for k in range(3):
            a, b, c = rotation[k, 0], rotation[k, 1], rotation[k, 2]
            along = (a * x + b * y + c * z) * rest
            rotation[k, 0] = a * cosine + along * x + (b * z - c * y) * sine
            rotation[k, 1] = b * cosine + along * y + (c * x - a * z) * sine
            rotation[k, 2] = c * cosine + along * z + (a * y - b * x) * sine
    for k in range(3):
        offset = geometry[_AXES]
        place[k] += rotation[k, 0] * offset[0] + rotation[k, 1] * offset[1] + rotation[k, 2] * offset[2]
        origins[_AXES, k] = place[k]


@compiled
def arm_angle_of(origins: Array, axes: Array, shoulder: Array, elbow: int, wrist: int) -> float:
    """Return the arm angle [rad] of a chain."""
    wx, wy, wz = origins[wrist, 0] - shoulder[0], origins[wrist, 1] - shoulder[1], origins[wrist, 2] - shoulder[2]
    length = math.sqrt(wx * wx + wy * wy + wz * wz)
    flat = math.hypot(wx, wy)
    if length == 0.0 or flat == 0.0:
        return math.nan
    wx, wy, wz = wx / length, wy / length, wz / length
    flat /= length
    # Axes of the plane across the line: w x z, and that x w.
    yx, yy = wy / flat, -wx / flat
    xx, xy, xz = yy * wz, -yx * wz, yx * wy - yy * wx
    e = axes[elbow]
    angle = math.atan2(yx * e[0] + yy * e[1], xx * e[0] + xy * e[1] + xz * e[2]) + 0.5 * math.pi
    return angle - 2.0 * math.pi if angle > math.pi else angle


@compiled
def _wrapped(angle: float) -> float:
    """Return an angle between -pi and pi [rad]."""
    return math.atan2(math.sin(angle), math.cos(angle))


@compiled
def forward_redundant(joints: Array, geometry: Array, places: Array, poses: Array, angles: Array) -> None:
    """Compute base from tool0 (N, 4, 4) and arm angles (N,) of joint angles (N, 7)."""
    rotation, origins, axes = np.empty((3, 3)), np.empty((8, 3)), np.empty((7, 3))
    for n in range(joints.shape[0]):
        chain(joints[n], geometry, rotation, origins, axes)
        angles[n] = arm_angle_of(origins, axes, geometry[15], int(places[0]), int(places[1]))
        for k in range(3):
            poses[n, k, 0], poses[n, k, 1] = -rotation[k, 2], rotation[k, 1]
            poses[n, k, 2], poses[n, k, 3] = rotation[k, 0], origins[7, k]
            poses[n, 3, k] = 0.0
        poses[n, 3, 3] = 1.0


@compiled
def link_frames(joints: Array, geometry: Array, bases: Array, out: Array) -> None:
    """Compute the frames (N, 8, 4, 4) of the base and the links of an arm whose base is at a pose (4, 4)."""
    rotation, origins, axes = np.empty((3, 3)), np.empty((8, 3)), np.empty((7, 3))
    partial = np.zeros(7)
    for n in range(joints.shape[0]):
        for link in range(8):
            # Angles behind a link do not move it.
            for k in range(_AXES):
                partial[k] = joints[n, k] if k < link else 0.0
            chain(partial, geometry, rotation, origins, axes)
            for row in range(3):
                for column in range(3):
                    total = 0.0
                    for k in range(3):
                        total += bases[row, k] * rotation[k, column]
                    out[n, link, row, column] = total
                place = bases[row, 3]
                if link > 0:
                    for k in range(3):
                        place += bases[row, k] * origins[link - 1, k]
                out[n, link, row, 3] = place
                out[n, link, 3, row] = 0.0
            out[n, link, 3, 3] = 1.0


@compiled
def _turn_between(found: Array, wanted: Array, out: Array) -> None:
    """Compute the turn [rad] in the base that takes a rotation (3, 3) to another one."""
    x = y = z = 0.0
    trace = 0.0
    for k in range(3):
        x += found[1, k] * wanted[2, k] - found[2, k] * wanted[1, k]
        y += found[2, k] * wanted[0, k] - found[0, k] * wanted[2, k]
        z += found[0, k] * wanted[1, k] - found[1, k] * wanted[0, k]
        trace += found[0, k] * wanted[0, k] + found[1, k] * wanted[1, k] + found[2, k] * wanted[2, k]
    sine = 0.5 * math.sqrt(x * x + y * y + z * z)
    angle = math.atan2(sine, 0.5 * (trace - 1.0))
    scale = 0.5 if sine < 1e-12 else 0.5 * angle / sine
    out[0], out[1], out[2] = scale * x, scale * y, scale * z


@compiled
def _errors(
    rotation: Array, origins: Array, axes: Array, pose: Array, arm_angle: float, geometry: Array, places: Array,
    scale: float, out: Array,
) -> float:  # fmt: skip
    """Compute the errors (7,): position [m] and turn and arm angle, scaled to metres; return the greatest."""
    wanted = np.empty((3, 3))
    for k in range(3):
        out[k] = pose[k, 3] - origins[7, k]
        wanted[k, 0], wanted[k, 1], wanted[k, 2] = pose[k, 2], pose[k, 1], -pose[k, 0]
    turn = np.empty(3)
    _turn_between(rotation, wanted, turn)
    for k in range(3):
        out[3 + k] = scale * turn[k]
    out[6] = 0.0
    if not math.isnan(arm_angle):
        angle = arm_angle_of(origins, axes, geometry[15], int(places[0]), int(places[1]))
        out[6] = scale * _wrapped(arm_angle - angle)
    worst = 0.0
    for k in range(7):
        worst = max(worst, abs(out[k]))
    return worst


@compiled
def _jacobian(
    angles: Array,
    origins: Array,
    axes: Array,
    geometry: Array,
    places: Array,
    has_angle: bool,
    scale: float,
    out: Array,
) -> None:
    """Compute the change of position, turn and arm angle with each angle, (7, 7); the last row is 0 without one."""
    rotation, other, turned = np.empty((3, 3)), np.empty((8, 3)), np.empty((7, 3))
    for n in range(_AXES):
        ax, ay, az = axes[n]
        px, py, pz = origins[7] - origins[n]
        out[0, n], out[1, n], out[2, n] = ay * pz - az * py, az * px - ax * pz, ax * py - ay * px
        out[3, n], out[4, n], out[5, n] = scale * ax, scale * ay, scale * az
        out[6, n] = 0.0
        if has_angle:
            kept = angles[n]
            angles[n] = kept + _DIFFERENCE
            chain(angles, geometry, rotation, other, turned)
            more = arm_angle_of(other, turned, geometry[15], int(places[0]), int(places[1]))
            angles[n] = kept - _DIFFERENCE
            chain(angles, geometry, rotation, other, turned)
            less = arm_angle_of(other, turned, geometry[15], int(places[0]), int(places[1]))
            angles[n] = kept
            out[6, n] = scale * _wrapped(more - less) / (2.0 * _DIFFERENCE)


@compiled
def _solve(normal: Array, right: Array) -> float:
    """Solve a positive definite system (7, 7) in place by Cholesky's method; return the greatest value, or NaN."""
    largest = 0.0
    for row in range(_AXES):
        for column in range(row + 1):
            total = normal[row, column]
            for k in range(column):
                total -= normal[row, k] * normal[column, k]
            if row != column:
                normal[row, column] = total / normal[column, column]
            elif total > 0.0:
                normal[row, row] = math.sqrt(total)
            else:
                return math.nan
        for k in range(row):
            right[row] -= normal[row, k] * right[k]
        right[row] /= normal[row, row]
    for row in range(_AXES - 1, -1, -1):
        for k in range(row + 1, _AXES):
            right[row] -= normal[k, row] * right[k]
        right[row] /= normal[row, row]
        largest = max(largest, abs(right[row]))
    return largest


@compiled
def solve_redundant(
    poses: Array, arm_angles: Array, seeds: Array, geometry: Array, places: Array, limits: Array, scale: float,
    tolerance: float, out: Array,
) -> None:  # fmt: skip
    """Find joint angles (N, 7) within the limits for poses (N, 4, 4) by damped Newton steps; NaN where there are none.

    The seeds (N, M, 7) of each pose are tried in their order. An arm angle of NaN leaves it free.
    """
    rotation, origins, axes = np.empty((3, 3)), np.empty((8, 3)), np.empty((7, 3))
    error, matrix = np.empty(7), np.empty((7, 7))
    normal, right = np.empty((7, 7)), np.empty(7)
    middle = 0.5 * (limits[:, 0] + limits[:, 1])
    for n in range(poses.shape[0]):
        out[n] = math.nan
        is_free = math.isnan(arm_angles[n])
        for seed in range(seeds.shape[1]):
            angles = seeds[n, seed].copy()
            best, since = math.inf, 0
            found = False
            for _ in range(_STEPS):
                chain(angles, geometry, rotation, origins, axes)
                worst = _errors(rotation, origins, axes, poses[n], arm_angles[n], geometry, places, scale, error)
                if not worst < math.inf:
                    break
                if worst < tolerance:
                    found = True
                    break
                since += 1
                if worst < 0.9 * best:
                    best, since = worst, 0
                elif since > _PATIENCE:
                    break
                _jacobian(angles, origins, axes, geometry, places, not is_free, scale, matrix)
                damping = min(1e-3, 1e-2 * worst)
                for row in range(_AXES):
                    right[row] = 0.0
                    for k in range(_AXES):
                        right[row] += matrix[k, row] * error[k]
                    for column in range(_AXES):
                        normal[row, column] = 0.0
                        for k in range(_AXES):
                            normal[row, column] += matrix[k, row] * matrix[k, column]
                if is_free:
                    # The weak pull to the middle acts where the pose leaves a choice.
                    for k in range(_AXES):
                        normal[k, k] += 1e-6 * min(1.0, worst)
                        right[k] += 1e-6 * min(1.0, worst) * _CENTRING * (middle[k] - angles[k])
                for k in range(_AXES):
                    normal[k, k] += damping * damping + _ROUNDING
                largest = _solve(normal, right)
                if not largest < math.inf:
                    break
                share = min(1.0, _STEP / largest) if largest > 0.0 else 1.0
                for k in range(_AXES):
                    angles[k] = min(max(angles[k] + share * right[k], limits[k, 0]), limits[k, 1])
            if found:
                out[n] = angles
                break
