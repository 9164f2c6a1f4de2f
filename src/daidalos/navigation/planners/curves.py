"""Shortest curves of bounded curvature between two poses: Dubins (forward only) and Reeds-Shepp (both directions).

L. E. Dubins, On curves of minimal length with a constraint on average curvature (1957); J. A. Reeds and L. A. Shepp,
Optimal paths for a car that goes both forwards and backwards (1990), whose families of words are numbered here by their
formulas. Lengths are in turning radii; a curve is at most five segments, each of a turn (1 left, 0 straight, -1 right)
and a signed length, negative when driven backwards.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled

HALF = 0.5 * math.pi
WORDS = 12
TURNS: NDArray[np.float64] = np.array(
    [
        [1, 0, 1, 0, 0],  # 0 LSL
        [1, 0, -1, 0, 0],  # 1 LSR
        [1, -1, 1, 0, 0],  # 2 LRL
        [1, -1, 1, 0, 0],  # 3 LRL from its end
        [1, -1, 1, -1, 0],  # 4 LRLR, the middle ones in opposite directions
        [1, -1, 1, -1, 0],  # 5 LRLR, the middle ones in one direction
        [1, -1, 0, 1, 0],  # 6 LRSL
        [1, -1, 0, -1, 0],  # 7 LRSR
        [1, 0, -1, 1, 0],  # 8 LSRL, 6 from its end
        [-1, 0, -1, 1, 0],  # 9 RSRL, 7 from its end
        [1, -1, 0, 1, -1],  # 10 LRSLR
        [1, -1, 1, 0, 0],  # 11 LRL forward
    ],
    dtype=np.float64,
)


ROUNDING = 5e-7
"""Angle [rad] below which a negative angle is a rounded zero: roots double the number of digits that are lost."""


@compiled
def shortest_curve(x: float, y: float, yaw: float, is_reverse_allowed: bool) -> tuple[float, Array, Array]:
    """Return length, turns (5,) and signed lengths (5,) of the shortest curve from the origin to a pose.

    Parameters
    ----------
    x, y : float
        In turning radii.
    yaw : float
    is_reverse_allowed : bool
        Whether to return a Reeds-Shepp curve instead of a Dubins one.
    """
    best = np.inf
    best_turns, best_lengths = np.zeros(5), np.zeros(5)
    lengths = np.zeros(5)
    for word in range(WORDS):
        if (word == 11 and is_reverse_allowed) or (2 <= word < 11 and not is_reverse_allowed):
            continue
        for mirror in range(4 if is_reverse_allowed else 2):
            side = -1.0 if mirror % 2 else 1.0
            way = -1.0 if mirror >= 2 else 1.0
            to_x, to_y, to_yaw = way * x, side * y, side * way * yaw
            if word == 3 or 8 <= word <= 9:
                cosine, sine = math.cos(to_yaw), math.sin(to_yaw)
                to_x, to_y = to_x * cosine + to_y * sine, to_x * sine - to_y * cosine
            if not _word(word, to_x, to_y, to_yaw, is_reverse_allowed, lengths):
                continue
            total = np.abs(lengths).sum()
            if total < best - 1e-9 and _arrives(word, side, way, lengths, x, y, yaw):
                best = total
                for i in range(5):
                    best_turns[i] = side * TURNS[word, i]
                    best_lengths[i] = way * lengths[i]
    return best, best_turns, best_lengths


@compiled
def _arrives(word: int, side: float, way: float, lengths: Array, x: float, y: float, yaw: float) -> bool:
    """Return whether a word's curve leads to a pose, which rules out solutions of a formula outside of its domain."""
    at_x = at_y = at_yaw = 0.0
    for i in range(5):
        at_x, at_y, at_yaw = moved(at_x, at_y, at_yaw, side * TURNS[word, i], way * lengths[i])
    turn = remainder(at_yaw - yaw)
    return bool(abs(at_x - x) < 1e-6 and abs(at_y - y) < 1e-6 and abs(turn) < 1e-6)


@compiled
def moved(x: float, y: float, yaw: float, curvature: float, length: float) -> tuple[float, float, float]:
    """Return the pose after a signed length at a curvature, which is positive to the left."""
    if abs(curvature) < 1e-12:
        return x + length * math.cos(yaw), y + length * math.sin(yaw), yaw
    there = yaw + curvature * length
    return (
        x + (math.sin(there) - math.sin(yaw)) / curvature,
        y + (math.cos(yaw) - math.cos(there)) / curvature,
        there,
    )


@compiled
def remainder(angle: float) -> float:
    """Return an angle in [-pi, pi]."""
    return angle - 2.0 * math.pi * round(angle / (2.0 * math.pi))


@compiled
def _wrapped(angle: float, is_signed: bool) -> float:
    """Return an angle in [-pi, pi], or in [0, 2 pi) for curves that are driven forward only."""
    if is_signed:
        return remainder(angle)
    angle = angle % (2.0 * math.pi)
    return 0.0 if angle > 2.0 * math.pi - ROUNDING else angle


@compiled
def _tau_omega(u: float, v: float, xi: float, eta: float, yaw: float) -> tuple[float, float]:
    """Return the first and the last angle of words of four arcs."""
    delta = remainder(u - v)
    a = math.sin(u) - math.sin(delta)
    b = math.cos(u) - math.cos(delta) - 1.0
    first = math.atan2(eta * a - xi * b, xi * a + eta * b)
    if 2.0 * (math.cos(delta) - math.cos(v) - math.cos(u)) + 3.0 < 0.0:
        first += math.pi
    tau = remainder(first)
    return tau, remainder(tau - u + v - yaw)


@compiled
def _word(word: int, x: float, y: float, yaw: float, signed: bool, lengths: Array) -> bool:
    """Write the signed lengths of a word that leads to a pose, and return whether there is one."""
    lengths[:] = 0.0
    opposite = word == 1 or word == 4 or word == 5 or word == 7 or word == 9 or word == 10
    sine, cosine = math.sin(yaw), math.cos(yaw)
    xi = x + sine if opposite else x - sine
    eta = y - 1.0 - cosine if opposite else y - 1.0 + cosine
    rho = math.hypot(xi, eta)
    theta = math.atan2(eta, xi)
    if word == 0:
        # One arc alone: the direction of a straight part without length means nothing.
        t = _wrapped(yaw, signed) if rho < 1e-7 else _wrapped(theta, signed)
        lengths[0], lengths[1], lengths[2] = t, rho, _wrapped(yaw - t, signed)
    elif word == 1:
        if rho < 2.0 - 1e-9:
            return False
        u = math.sqrt(max(rho * rho - 4.0, 0.0))
        t = _wrapped(theta + math.atan2(2.0, u), signed)
        lengths[0], lengths[1], lengths[2] = t, u, _wrapped(t - yaw, signed)
    elif word == 2 or word == 3 or word == 11:
        if rho > 4.0 + 1e-9:
            return False
        u = -2.0 * math.asin(min(0.25 * rho, 1.0))
        t = _wrapped(theta + 0.5 * u + math.pi, signed)
        v = _wrapped(yaw - t + u, signed)
        if word == 3:
            t, v = v, t
        lengths[0], lengths[1], lengths[2] = t, (u + 2.0 * math.pi if word == 11 else u), v
    elif word == 4:
        share = 0.25 * (2.0 + rho)
        if share > 1.0:
            return False
        u = math.acos(share)
        t, v = _tau_omega(u, -u, xi, eta, yaw)
        lengths[0], lengths[1], lengths[2], lengths[3] = t, u, -u, v
    elif word == 5:
        share = (20.0 - rho * rho) / 16.0
        if share < 0.0 or share > 1.0:
            return False
        u = -math.acos(share)
        t, v = _tau_omega(u, u, xi, eta, yaw)
        lengths[0], lengths[1], lengths[2], lengths[3] = t, u, u, v
    elif rho < 2.0 - 1e-9:
        return False
    elif word == 6 or word == 8:
        r = math.sqrt(max(rho * rho - 4.0, 0.0))
        t = _wrapped(theta + math.atan2(r, -2.0), True)
        v = _wrapped(yaw - HALF - t, True)
        if word == 6:
            lengths[0], lengths[1], lengths[2], lengths[3] = t, -HALF, 2.0 - r, v
        else:
            lengths[0], lengths[1], lengths[2], lengths[3] = v, 2.0 - r, -HALF, t
    elif word == 7 or word == 9:
        t = math.atan2(xi, -eta)
        v = _wrapped(t + HALF - yaw, True)
        if word == 7:
            lengths[0], lengths[1], lengths[2], lengths[3] = t, -HALF, 2.0 - rho, v
        else:
            lengths[0], lengths[1], lengths[2], lengths[3] = v, 2.0 - rho, -HALF, t
    else:
        u = 4.0 - math.sqrt(max(rho * rho - 4.0, 0.0))
        t = _wrapped(math.atan2((4.0 - u) * xi - 2.0 * eta, -2.0 * xi + (u - 4.0) * eta), True)
        lengths[0], lengths[1], lengths[2], lengths[3], lengths[4] = t, -HALF, u, -HALF, _wrapped(t - yaw, True)
    return True


@compiled
def sampled(turns: Array, lengths: Array, radius: float, x: float, y: float, yaw: float, spacing: float) -> Array:
    """Return poses (n, 3) along a curve from a pose, the first left out, at most `spacing` apart."""
    count = 0
    for i in range(5):
        count += math.ceil(abs(lengths[i]) * radius / spacing - 1e-9) if abs(lengths[i]) > 1e-9 else 0
    poses = np.empty((count, 3))
    at = 0
    for i in range(5):
        if abs(lengths[i]) <= 1e-9:
            continue
        steps = math.ceil(abs(lengths[i]) * radius / spacing - 1e-9)
        curvature = turns[i] / radius
        for k in range(1, steps + 1):
            poses[at, 0], poses[at, 1], poses[at, 2] = moved(x, y, yaw, curvature, lengths[i] * radius * k / steps)
            at += 1
        x, y, yaw = poses[at - 1, 0], poses[at - 1, 1], poses[at - 1, 2]
    return poses[:at]
