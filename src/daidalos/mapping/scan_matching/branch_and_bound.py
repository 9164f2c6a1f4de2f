"""Correlative scan matching in a window by branch and bound over blocks of poses.

The score is that of Olson 2009, "Real-time correlative scan matching"; its two resolutions become any number
of them as in Hess et al. 2016, "Real-time loop closure in 2D LIDAR SLAM".
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.common.arrays import Array
from daidalos.common.kernels import compiled
from daidalos.mapping.scan_matching.likelihood import FULL, Cells, Likelihood


@dataclass(frozen=True)
class Match:
    """Best pose of a scan in a window and its score: the mean likelihood of its points, from 0 to 1."""

    pose: Array
    score: float


def search(
    points: Array,
    likelihood: Likelihood,
    centre: Array,
    *,
    distance: float,
    angle: float,
    minimum_score: float = 0.0,
    distance_penalty: float = 0.0,
    angle_penalty: float = 0.0,
) -> Match | None:
    """Find the pose with the highest score in a window around a first guess.

    Parameters
    ----------
    points : ndarray, shape (n, 2)
        The scan in its own frame.
    likelihood : Likelihood
        What it is matched against.
    centre : ndarray, shape (3,)
        Middle of the window.
    distance, angle : float
        Half width of the window [m] and [rad].
    minimum_score : float
        Poses that score less are not looked at.
    distance_penalty, angle_penalty : float
        What the score loses [1/m^2] and [1/rad^2] with the square of the way from the middle of the window.

    Returns
    -------
    Match or None
        None where no pose reaches the minimum score.
    """
    if points.shape[0] == 0:
        return None
    # A turn by one step moves a typical point by one cell; the farthest ones move more.
    reach = max(float(np.sqrt(np.mean(points**2) * 2.0)), likelihood.resolution)
    step = min(likelihood.resolution / reach, 0.05)
    turns = int(np.ceil(angle / step))
    pose, score = _search(
        points,
        likelihood.levels,
        likelihood.corner,
        likelihood.resolution,
        np.array(centre, dtype=np.float64),
        int(np.ceil(distance / likelihood.resolution)),
        turns,
        step,
        float(minimum_score),
        float(distance_penalty) * likelihood.resolution**2,
        float(angle_penalty) * step**2,
    )
    if score < 0.0:
        return None
    return Match(pose, score)


@compiled
def _search(
    points: Array,
    levels: Cells,
    corner: Array,
    resolution: float,
    centre: Array,
    half: int,
    turns: int,
    step: float,
    minimum: float,
    shift_penalty: float,
    turn_penalty: float,
) -> tuple[Array, float]:
    count = points.shape[0]
    top = levels.shape[0] - 1
    width = 1 << top
    blocks = (2 * half + width) // width
    angles = 2 * turns + 1
    columns = np.empty((angles, count), np.int32)
    rows = np.empty((angles, count), np.int32)
    bounds = np.empty(angles * blocks * blocks)
    for a in range(angles):
        _rotate(points, corner, resolution, centre, half, (a - turns) * step, columns[a], rows[a])
        for by in range(blocks):
            for bx in range(blocks):
                penalty = turn_penalty * (a - turns) ** 2 + shift_penalty * _shift(bx * width, by * width, width, half)
                bounds[(a * blocks + by) * blocks + bx] = (
                    _score(levels[top], columns[a], rows[a], bx * width, by * width) - penalty
                )
    best = minimum
    found = np.full(3, -1, np.int64)
    # Depth first from the most promising block: each stack entry is a block of 2**level shifts.
    stack = np.empty((4 * (top + 1) + 1, 4), np.int64)
    stack_bounds = np.empty(4 * (top + 1) + 1)
    for k in np.argsort(-bounds, kind="mergesort"):
        if bounds[k] <= best:
            break
        stack[0, 0] = k // (blocks * blocks)
        stack[0, 1] = (k // blocks % blocks) * width
        stack[0, 2] = (k % blocks) * width
        stack[0, 3] = top
        stack_bounds[0] = bounds[k]
        size = 1
        while size > 0:
            size -= 1
            if stack_bounds[size] <= best:
                continue
            a, y, x, level = stack[size, 0], stack[size, 1], stack[size, 2], stack[size, 3]
            if level == 0:
                if y <= 2 * half and x <= 2 * half:
                    best = stack_bounds[size]
                    found[0], found[1], found[2] = a, y, x
                continue
            size = _branch(
                levels[level - 1],
                columns[a],
                rows[a],
                stack[size],
                half,
                turn_penalty * (a - turns) ** 2,
                shift_penalty,
                best,
                stack,
                stack_bounds,
                size,
            )
    if found[0] < 0:
        return np.zeros(3), -1.0
    pose = np.array(
        [
            centre[0] + (found[2] - half) * resolution,
            centre[1] + (found[1] - half) * resolution,
            centre[2] + (found[0] - turns) * step,
        ]
    )
    return pose, best


@compiled
def _rotate(
    points: Array,
    corner: Array,
    resolution: float,
    centre: Array,
    half: int,
    turn: float,
    columns: NDArray[np.int32],
    rows: NDArray[np.int32],
) -> None:
    """Return the cells of the scan's points at one heading, shifted to the lower left corner of the window."""
    cosine, sine = np.cos(centre[2] + turn), np.sin(centre[2] + turn)
    for i in range(points.shape[0]):
        x = centre[0] + cosine * points[i, 0] - sine * points[i, 1]
        y = centre[1] + sine * points[i, 0] + cosine * points[i, 1]
        columns[i] = int(np.floor((x - corner[0]) / resolution)) - half
        rows[i] = int(np.floor((y - corner[1]) / resolution)) - half


@compiled
def _score(cells: Cells, columns: NDArray[np.int32], rows: NDArray[np.int32], dx: int, dy: int) -> float:
    height, width = cells.shape
    total = 0
    for i in range(columns.shape[0]):
        r = rows[i] + dy
        c = columns[i] + dx
        if 0 <= r < height and 0 <= c < width:
            total += cells[r, c]
    return float(total / (FULL * columns.shape[0]))


@compiled
def _shift(x: int, y: int, width: int, half: int) -> float:
    """Return the squared distance in cells from the centre of the window to the nearest shift of a block."""
    dx = max(x - half, 0, half - (x + width - 1))
    dy = max(y - half, 0, half - (y + width - 1))
    return float(dx * dx + dy * dy)


@compiled
def _branch(
    cells: Cells,
    columns: NDArray[np.int32],
    rows: NDArray[np.int32],
    block: NDArray[np.int64],
    half: int,
    turn_penalty: float,
    shift_penalty: float,
    best: float,
    stack: NDArray[np.int64],
    stack_bounds: Array,
    size: int,
) -> int:
    """Push the four halves of a block that can still beat the best pose, the most promising one last."""
    first = size
    a, y, x, level = block[0], block[1], block[2], block[3] - 1
    width = 1 << level
    for dy in (0, width):
        for dx in (0, width):
            bound = _score(cells, columns, rows, x + dx, y + dy) - turn_penalty
            bound -= shift_penalty * _shift(x + dx, y + dy, width, half)
            if bound <= best:
                continue
            slot = size
            while slot > first and stack_bounds[slot - 1] > bound:
                stack[slot] = stack[slot - 1]
                stack_bounds[slot] = stack_bounds[slot - 1]
                slot -= 1
            stack[slot, 0], stack[slot, 1], stack[slot, 2], stack[slot, 3] = a, y + dy, x + dx, level
            stack_bounds[slot] = bound
            size += 1
    return size
