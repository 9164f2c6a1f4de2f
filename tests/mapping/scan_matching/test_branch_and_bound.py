import numpy as np
import pytest

from daidalos.mapping.scan_matching.branch_and_bound import search
from daidalos.mapping.scan_matching.likelihood import FULL, Likelihood, build_likelihood


@pytest.mark.parametrize("depth", [0, 1, 3, 5])
@pytest.mark.parametrize("penalty", [0.0, 0.3])
def test_finds_what_an_exhaustive_search_finds(depth: int, penalty: float) -> None:
    rng = np.random.default_rng(depth)
    world = rng.uniform(-2.0, 2.0, (60, 2))
    turn = 0.2
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    points = ((world - (0.3, -0.2)) @ rotation)[::2] + rng.normal(scale=0.02, size=(30, 2))
    likelihood = build_likelihood(world, 0.1, 0.1, depth)
    centre = np.array([0.05, 0.02, 0.0])
    match = search(points, likelihood, centre, distance=0.5, angle=0.3, distance_penalty=penalty, angle_penalty=penalty)
    assert match is not None
    best = exhaustive(points, likelihood, centre, 0.5, 0.3, penalty)
    assert match.score == pytest.approx(best, abs=1e-9)
    assert match.pose == pytest.approx([0.3, -0.2, 0.2], abs=0.1)


def test_nothing_is_found_below_the_minimum_score() -> None:
    likelihood = build_likelihood(np.array([[0.0, 0.0], [1.0, 1.0]]), 0.1, 0.1, 2)
    far = np.array([[5.0, 5.0], [6.0, 5.0]])
    assert search(far, likelihood, np.zeros(3), distance=0.3, angle=0.1, minimum_score=0.1) is None
    assert search(np.empty((0, 2)), likelihood, np.zeros(3), distance=0.3, angle=0.1) is None


def test_a_penalty_keeps_an_ambiguous_scan_in_the_middle() -> None:
    """Along a wall every shift fits alike; the least one is taken."""
    wall = np.stack([np.arange(-5.0, 5.0, 0.05), np.zeros(200)], axis=1)
    likelihood = build_likelihood(wall, 0.05, 0.05, 3)
    part = np.stack([np.arange(-1.0, 1.0, 0.05), np.full(40, 0.2)], axis=1)
    match = search(part, likelihood, np.zeros(3), distance=0.5, angle=0.2, distance_penalty=0.1)
    assert match is not None
    assert match.pose == pytest.approx([0.0, -0.2, 0.0], abs=0.051)


def exhaustive(
    points: np.ndarray, likelihood: Likelihood, centre: np.ndarray, distance: float, angle: float, penalty: float
) -> float:
    """Best score over all steps of the window, one by one."""
    step = min(likelihood.resolution / np.sqrt(np.mean(points**2) * 2.0), 0.05)
    turns = int(np.ceil(angle / step))
    half = int(np.ceil(distance / likelihood.resolution))
    cells = likelihood.levels[0]
    best = 0.0
    for a in range(-turns, turns + 1):
        yaw = centre[2] + a * step
        rotated = points @ np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]]) + centre[:2]
        base = np.floor((rotated - likelihood.corner) / likelihood.resolution).astype(int)
        for dx in range(-half, half + 1):
            for dy in range(-half, half + 1):
                column, row = base[:, 0] + dx, base[:, 1] + dy
                inside = (column >= 0) & (row >= 0) & (column < cells.shape[1]) & (row < cells.shape[0])
                score = cells[row[inside], column[inside]].astype(float).sum() / FULL / len(points)
                shift = (dx**2 + dy**2) * likelihood.resolution**2
                best = max(best, score - penalty * (shift + (a * step) ** 2))
    return best
