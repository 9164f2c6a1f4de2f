"""Kernels of the time-optimal parametrisation of a path.

Along a path q(s) with limits of speed and acceleration, each row of limits is |q'(s) u + q''(s) x| <= a, with x = s'^2
and u = s''. A pass from the end finds the greatest x from which all that follows can be kept, and a pass from the start
accelerates as much as that allows (Pham and Pham, "A New Approach to Time-Optimal Path Parameterization based on
Reachability Analysis", 2018).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled

_BISECTIONS = 40
_SMALL = 1e-12


@compiled(inline=True)
def _accelerations(
    x: float, first: NDArray[np.float64], second: NDArray[np.float64], limits: NDArray[np.float64]
) -> tuple[float, float]:
    """Return the least and the greatest u at a point; the least is above the greatest where there is none."""
    low, high = -1e30, 1e30
    for j in range(first.shape[0]):
        bend = second[j] * x
        slope = first[j]
        if abs(slope) < _SMALL:
            if abs(bend) > limits[j]:
                return 1.0, -1.0
            continue
        a, b = (-limits[j] - bend) / slope, (limits[j] - bend) / slope
        if a > b:
            a, b = b, a
        low, high = max(low, a), min(high, b)
    return low, high


@compiled
def greatest_speeds(
    s: NDArray[np.float64],
    first: NDArray[np.float64],
    second: NDArray[np.float64],
    limits: NDArray[np.float64],
    caps: NDArray[np.float64],
    start: float,
    end: float,
    controllable: NDArray[np.float64],
    x: NDArray[np.float64],
) -> None:
    """Compute x = s'^2 at the points s (N,) of a path.

    Parameters
    ----------
    s
        Points (N,), not falling; a point may come twice, with the derivatives before and after it.
    first, second, limits
        q', q'' and the limits of acceleration, (N, rows).
    caps
        Greatest x by the limits of speed (N,).
    start, end
        x at the first point, and the greatest x at the last.
    controllable, x
        Results (N,).
    """
    n = s.shape[0]
    controllable[n - 1] = min(end, caps[n - 1])
    for i in range(n - 2, -1, -1):
        step = 2.0 * (s[i + 1] - s[i])
        goal = controllable[i + 1]
        bad, good = caps[i], 0.0
        if step <= 0.0:
            controllable[i] = min(caps[i], goal)
            continue
        low, high = _accelerations(bad, first[i], second[i], limits[i])
        if low <= high and bad + step * low <= goal and bad + step * high >= 0.0:
            controllable[i] = bad
            continue
        for _ in range(_BISECTIONS):
            middle = 0.5 * (good + bad)
            low, high = _accelerations(middle, first[i], second[i], limits[i])
            if low <= high and middle + step * low <= goal and middle + step * high >= 0.0:
                good = middle
            else:
                bad = middle
        controllable[i] = good
    x[0] = start
    for i in range(n - 1):
        step = 2.0 * (s[i + 1] - s[i])
        if step <= 0.0:
            x[i + 1] = min(x[i], controllable[i + 1]) if controllable[i + 1] > 0.0 else 0.0
            continue
        low, high = _accelerations(x[i], first[i], second[i], limits[i])
        if low > high:
            low = high = 0.5 * (low + high)
        x[i + 1] = max(0.0, max(min(controllable[i + 1], x[i] + step * high), x[i] + step * low))


@compiled
def refine(
    s: NDArray[np.float64],
    first: NDArray[np.float64],
    second: NDArray[np.float64],
    limits: NDArray[np.float64],
    caps: NDArray[np.float64],
    x: NDArray[np.float64],
    out: NDArray[np.float64],
) -> int:
    """Insert the points between which the acceleration changes inside of a step; return how many points there are.

    Where the motion accelerates before a step, or is at its cap, and slows down after it, or is at its cap, it can do
    so inside of the step too: up to the cap, or to where both meet. `out` has room for (3 N, 2): s and x.
    """
    n, count = s.shape[0], 0
    is_rising = True
    for i in range(n - 1):
        out[count, 0], out[count, 1] = s[i], x[i]
        count += 1
        step = s[i + 1] - s[i]
        if step <= 0.0:
            continue
        low, high = _accelerations(x[i], first[i], second[i], limits[i])
        u = (x[i + 1] - x[i]) / (2.0 * step)
        tolerance = 1e-6 * (high - low)
        is_free = low < u - tolerance and u + tolerance < high
        starts = is_rising or x[i] >= caps[i] * (1.0 - 1e-9)
        is_rising = u >= high - tolerance
        if not (is_free and starts and _slows_after(i + 1, s, first, second, limits, caps, x)):
            continue
        top = min(caps[i], caps[i + 1])
        rise = min((top - x[i]) / (2.0 * high), step) if high > _SMALL else 0.0
        fall = min((x[i + 1] - top) / (2.0 * low), step) if low < -_SMALL else 0.0
        if rise + fall > step:
            rise = min(max((x[i + 1] - x[i] - 2.0 * low * step) / (2.0 * (high - low)), 0.0), step)
            fall = step - rise
        gap = 1e-6 * step
        if rise > gap:
            out[count, 0], out[count, 1] = s[i] + rise, x[i] + 2.0 * high * rise
            count += 1
        if fall > gap and rise + fall < step - gap:
            out[count, 0], out[count, 1] = s[i + 1] - fall, x[i + 1] - 2.0 * low * fall
            count += 1
    out[count, 0], out[count, 1] = s[n - 1], x[n - 1]
    return count + 1


@compiled(inline=True)
def _slows_after(
    i: int,
    s: NDArray[np.float64],
    first: NDArray[np.float64],
    second: NDArray[np.float64],
    limits: NDArray[np.float64],
    caps: NDArray[np.float64],
    x: NDArray[np.float64],
) -> bool:
    """Return whether the motion is at its cap, at its end, or slows as much as it may from a point on."""
    if x[i] >= caps[i] * (1.0 - 1e-9):
        return True
    while i < s.shape[0] - 1 and s[i + 1] <= s[i]:
        i += 1
        if x[i] >= caps[i] * (1.0 - 1e-9):
            return True
    if i >= s.shape[0] - 1:
        return True
    low, high = _accelerations(x[i], first[i], second[i], limits[i])
    u = (x[i + 1] - x[i]) / (2.0 * (s[i + 1] - s[i]))
    return bool(u <= low + 1e-6 * (high - low))


@compiled
def stopping_speeds(
    s: NDArray[np.float64],
    first: NDArray[np.float64],
    second: NDArray[np.float64],
    limits: NDArray[np.float64],
    start: float,
    x: NDArray[np.float64],
) -> int:
    """Compute x at points of a path while it slows as the limits allow; return the point that it does not pass."""
    x[0] = start
    for i in range(s.shape[0] - 1):
        low, high = _accelerations(x[i], first[i], second[i], limits[i])
        if low > high:
            low = high
        x[i + 1] = x[i] + 2.0 * (s[i + 1] - s[i]) * min(low, 0.0)
        if x[i + 1] <= 0.0:
            return i + 1
    return int(s.shape[0]) - 1
