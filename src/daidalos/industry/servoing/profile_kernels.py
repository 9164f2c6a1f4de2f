"""Kernels that find a butt joint in a profile, and a seam in what was measured of its edges."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from daidalos.common.kernels import compiled

Array = NDArray[np.float64]

BLOCK = 20
"""Points of a block whose median is the level of a plate there."""
DROP = 30e-6
"""Distance below a plate from which a point does not belong to it [m]."""
MAX_GAP = 1.5e-3
"""Widest gap that is looked for [m]."""
PLATE = 6e-3
"""Length of each plate that its line is fitted to [m]."""
EXPECTED_DEVIATION = 0.5e-3
"""Distance from where the gap is expected at which a candidate counts half as much [m]."""
TUKEY = 4.685
_FIGURES = 8


@compiled
def find_joint(heights: Array, pitch: float, expected: float) -> Array:
    """Return the joint in a profile: both edges, their heights, both slopes, scatter and quality (8,).

    Parameters
    ----------
    heights : array of shape (n,)
        NaN where there is none [m].
    pitch : float
        Distance between points; the middle of the profile is at 0 [m].
    expected : float
        Where the gap is expected [m]; NaN where that is not known.

    Returns
    -------
    array of shape (8,)
        Right and left edge, height of the right and of the left plate there, their slopes, standard deviation of the
        points about the plates, and a quality from 0 to 1; all 0 where no joint was found.
    """
    n = len(heights)
    out = np.zeros(_FIGURES)
    clean = _without_spikes(heights)
    levels = _levels(clean)
    low = np.zeros(n, dtype=np.int8)  # 1: without height, 2: below both plates
    for i in range(n):
        if not np.isfinite(clean[i]):
            low[i] = 1
            continue
        block = i // BLOCK
        level = np.inf
        for j in range(max(block - 2, 0), min(block + 3, len(levels))):
            level = min(level, levels[j])
        if np.isfinite(level) and clean[i] < level - 2.0 * DROP:
            low[i] = 2
    middle = 0.5 * (n - 1)
    best, first, last = 0.0, -1, -1
    i = 0
    while i < n:
        if low[i] == 0:
            i += 1
            continue
        end, evidence = i, 0
        j = i
        while j < n and j - end <= 2:  # single points of a plate do not end a gap
            if low[j]:
                end = j
                evidence += 1 if low[j] == 2 else 0
            j += 1
        width = (end - i + 1) * pitch
        missing = end - i + 1 - evidence
        is_near = np.isfinite(expected) and abs((0.5 * (i + end) - middle) * pitch - expected) < EXPECTED_DEVIATION
        if (evidence > 0 or (is_near and missing > 2)) and width < MAX_GAP:
            score = min(float(evidence), 4.0) + 0.25 * min(float(missing), 4.0)
            if np.isfinite(expected):
                away = ((0.5 * (i + end) - middle) * pitch - expected) / EXPECTED_DEVIATION
                score /= 1.0 + away * away
            if score > best:
                best, first, last = score, i, end
        i = end + 1
    if first < 0:
        return out
    reach = int(PLATE / pitch)
    right = _robust_line(clean, pitch, max(first - reach, 0), first - 1)
    left = _robust_line(clean, pitch, last + 2, min(last + 1 + reach, n))
    if right[3] == 0.0 or left[3] == 0.0:
        return out
    start = _edge(clean, pitch, first, -1, right)
    stop = _edge(clean, pitch, last, 1, left)
    if stop <= start:
        return out
    scatter = max(right[2], left[2])
    x_right, x_left = (start - middle) * pitch, (stop - middle) * pitch
    out[0], out[1] = x_right, x_left
    out[2], out[3] = right[0] + right[1] * x_right, left[0] + left[1] * x_left
    out[4], out[5], out[6] = right[1], left[1], scatter
    share = min(right[3], left[3])
    width = x_left - x_right
    out[7] = share * min(DROP / max(scatter, 1e-9), 1.0) * (1.0 if width < MAX_GAP else 0.0)
    return out


@compiled
def seam_at(places: Array, lateral: Array, weights: Array, begin: int, end: int, at: float, window: float) -> Array:
    """Return a seam's edge at a length, by a robust parabola through what was measured around it.

    Parameters
    ----------
    places, lateral, weights : arrays of shape (n,)
        Of the measurements: length, place of the edge and weight, ordered by the length.
    begin, end : int
        Of the measurements that count.
    at, window : float
        The length, and the distance from it up to which measurements count [m].

    Returns
    -------
    array of shape (3,)
        The edge's place [m], its slope, and the share of the measurements that agree; the share is 0 where there
        are fewer than 8.
    """
    out = np.zeros(3)
    count = end - begin
    if count < 8:
        return out
    x = (places[begin:end] - at) / window
    y = lateral[begin:end]
    base = weights[begin:end] * (1.0 - np.minimum(np.abs(x), 1.0) ** 3)
    curve = np.array([np.median(y), 0.0, 0.0])
    scale = 0.0
    for round_ in range(6):
        residuals = y - curve[0] - (curve[1] + curve[2] * x) * x
        scale = 1.4826 * np.median(np.abs(residuals)) + 1e-7
        moments = np.zeros(5)
        sides = np.zeros(3)
        for i in range(count):
            u = residuals[i] / ((12.0 if round_ == 0 else TUKEY) * scale)
            if abs(u) >= 1.0:
                continue
            w = base[i] * (1.0 - u * u) ** 2
            sides[0] += w * y[i]
            sides[1] += w * x[i] * y[i]
            sides[2] += w * x[i] * x[i] * y[i]
            for power in range(5):
                moments[power] += w
                w *= x[i]
        if not _solve(moments, sides, curve):
            return out
    agreeing = 0
    for i in range(count):
        if abs(y[i] - curve[0] - (curve[1] + curve[2] * x[i]) * x[i]) < TUKEY * scale:
            agreeing += 1
    out[0], out[1], out[2] = curve[0], curve[1] / window, agreeing / count
    return out


@compiled
def _solve(moments: Array, sides: Array, curve: Array) -> bool:
    """Compute a parabola (3,) from the moments of x (5,) and those of y (3,); return whether there is one."""
    m0, m1, m2, m3, m4 = moments
    a, b, c = m2 * m4 - m3 * m3, m2 * m3 - m1 * m4, m1 * m3 - m2 * m2
    determinant = m0 * a + m1 * b + m2 * c
    if determinant <= 1e-9 * m0 * m0 * m0:
        return False
    d, e, f = m0 * m4 - m2 * m2, m1 * m2 - m0 * m3, m0 * m2 - m1 * m1
    curve[0] = (a * sides[0] + b * sides[1] + c * sides[2]) / determinant
    curve[1] = (b * sides[0] + d * sides[1] + e * sides[2]) / determinant
    curve[2] = (c * sides[0] + e * sides[1] + f * sides[2]) / determinant
    return True


@compiled
def _without_spikes(heights: Array) -> Array:
    """Return heights without single points that are far from their neighbours."""
    n = len(heights)
    out = heights.copy()
    near = np.empty(4)
    for i in range(n):
        count = 0
        for j in range(max(i - 2, 0), min(i + 3, n)):
            if j != i and np.isfinite(heights[j]):
                near[count] = heights[j]
                count += 1
        if count < 2 or not np.isfinite(heights[i]):
            continue
        closest = np.inf
        for k in range(count):
            closest = min(closest, abs(near[k] - heights[i]))
        if closest > 10.0 * DROP and abs(np.median(near[:count]) - heights[i]) > 1e-3:
            out[i] = np.nan
    return out


@compiled
def _levels(heights: Array) -> Array:
    """Return the medians of blocks; NaN where a block has few heights."""
    blocks = len(heights) // BLOCK
    out = np.full(blocks, np.nan)
    values = np.empty(BLOCK)
    for b in range(blocks):
        count = 0
        for i in range(b * BLOCK, (b + 1) * BLOCK):
            if np.isfinite(heights[i]):
                values[count] = heights[i]
                count += 1
        if count >= BLOCK // 2:
            out[b] = np.median(values[:count])
    return out


@compiled
def _robust_line(heights: Array, pitch: float, begin: int, end: int) -> Array:
    """Return offset and slope of a plate between two points, scatter, and the share of points that lie on it (4,)."""
    out = np.zeros(4)
    if end - begin < 20:
        return out
    middle = 0.5 * (len(heights) - 1)
    x = np.empty(end - begin)
    y = np.empty(end - begin)
    count = 0
    for i in range(begin, end):
        if np.isfinite(heights[i]):
            x[count] = (i - middle) * pitch
            y[count] = heights[i]
            count += 1
    if count < 20:
        return out
    x, y = x[:count], y[:count]
    half = count // 2
    slope = (np.median(y[half:]) - np.median(y[:half])) / (np.median(x[half:]) - np.median(x[:half]))
    offset = np.median(y - slope * x)
    scale = 0.0
    for _ in range(4):
        residuals = y - offset - slope * x
        scale = 1.4826 * np.median(np.abs(residuals)) + 1e-7
        s0 = s1 = s2 = t0 = t1 = 0.0
        for i in range(count):
            u = residuals[i] / (TUKEY * scale)
            if abs(u) >= 1.0:
                continue
            w = (1.0 - u * u) ** 2
            s0 += w
            s1 += w * x[i]
            s2 += w * x[i] * x[i]
            t0 += w * y[i]
            t1 += w * x[i] * y[i]
        determinant = s0 * s2 - s1 * s1
        if s0 < 10.0 or determinant <= 0.0:
            return out
        offset = np.float64((s2 * t0 - s1 * t1) / determinant)
        slope = np.float64((s0 * t1 - s1 * t0) / determinant)
    out[0], out[1], out[2], out[3] = offset, slope, scale, count / (end - begin)
    return out


@compiled
def _edge(heights: Array, pitch: float, inside: int, step: int, line: Array) -> float:
    """Return where a plate begins, as a point's number, going from a point in the gap: at two points on its line."""
    n = len(heights)
    middle = 0.5 * (n - 1)
    allowed = max(DROP, 4.0 * line[2])
    i = inside
    on_plate = 0
    while 0 <= i < n:
        value = heights[i]
        if np.isfinite(value) and abs(value - line[0] - line[1] * (i - middle) * pitch) < allowed:
            on_plate += 1
            if on_plate == 2:
                return i - step * 1.5
        elif np.isfinite(value):
            on_plate = 0
        i += step
    return float(inside)
