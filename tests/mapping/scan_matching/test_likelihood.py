import numpy as np
import pytest

from daidalos.mapping.scan_matching.likelihood import FULL, build_likelihood


def test_cells_hold_the_gaussian_of_the_nearest_point() -> None:
    """Twin: every cell looks at every point, by the distance between their cells."""
    rng = np.random.default_rng(1)
    points = rng.uniform(-1.0, 1.0, (30, 2))
    grid = build_likelihood(points, 0.1, 0.15, 0)
    rows, columns = grid.levels.shape[1:]
    cells = np.floor((points - grid.corner) / grid.resolution)
    r, c = np.mgrid[:rows, :columns]
    offset = np.maximum(np.abs(c[..., None] - cells[:, 0]), np.abs(r[..., None] - cells[:, 1]))
    square = (c[..., None] - cells[:, 0]) ** 2 + (r[..., None] - cells[:, 1]) ** 2
    likelihood = np.where(offset <= 3, np.round(FULL * np.exp(-0.5 * square * 0.01 / 0.15**2)), 0.0)
    assert grid.levels[0] == pytest.approx(likelihood.max(axis=-1))


def test_levels_are_the_largest_values_over_windows() -> None:
    points = np.random.default_rng(2).uniform(-1.0, 1.0, (20, 2))
    grid = build_likelihood(points, 0.05, 0.05, 4)
    rows, columns = grid.levels.shape[1:]
    for level in range(1, 5):
        side = 2**level
        padded = np.pad(grid.levels[0], ((0, side), (0, side)))
        windows = np.lib.stride_tricks.sliding_window_view(padded, (side, side))[:rows, :columns]
        assert np.array_equal(grid.levels[level], windows.max(axis=(2, 3)))


def test_there_is_room_for_windows_that_begin_before_the_points() -> None:
    points = np.array([[0.0, 0.0]])
    for depth in range(5):
        grid = build_likelihood(points, 0.1, 0.1, depth)
        row, column = np.argwhere(grid.levels[0] == FULL)[0]
        assert min(row, column) >= 2**depth
