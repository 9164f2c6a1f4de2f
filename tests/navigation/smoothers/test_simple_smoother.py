"""Smoothing against its closed form, and away from obstacles."""

import numpy as np
import pytest

from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.paths import with_headings
from daidalos.navigation.smoothers.simple_smoother import SimpleSmoother, SimpleSmootherParameters


def zigzag():
    x = np.linspace(0.5, 3.5, 31)
    return with_headings(np.stack([x, 2.0 + 0.1 * (-1.0) ** np.arange(31)], axis=-1), final_heading=0.3)


def test_the_rest_is_the_solution_of_the_linear_equations():
    path = zigzag()
    parameters = SimpleSmootherParameters(
        tolerance=1e-20, max_its=20_000, do_refinement=False, enforce_path_inversion=False
    )
    smoothed = SimpleSmoother(parameters).smooth(path, Costmap.filled(80, 80, 0.05, (0.0, 0.0)))
    count = path.shape[0]
    matrix, wanted = np.eye(count), path[:, :2].copy()
    for i in range(1, count - 1):
        matrix[i, i - 1 : i + 2] = [-0.3, 0.2 + 0.6, -0.3]
        wanted[i] *= 0.2
    assert np.allclose(smoothed[:, :2], np.linalg.solve(matrix, wanted), atol=1e-6)
    assert np.array_equal(smoothed[[0, -1], :2], path[[0, -1], :2])
    assert smoothed[-1, 2] == 0.3


def test_no_point_is_moved_into_an_obstacle():
    path = zigzag()
    costmap = Costmap.filled(80, 80, 0.05, (0.0, 0.0))
    costmap.costs[38:42] = 254
    smoothed = SimpleSmoother().smooth(path, costmap)
    assert all(costmap.cost_at(*p[:2]) != 254 for p in smoothed)


@pytest.mark.parametrize("count", [1, 2])
def test_short_paths_stay(count):
    path = zigzag()[:count]
    assert np.array_equal(SimpleSmoother().smooth(path, Costmap.filled(8, 8, 0.5, (0.0, 0.0))), path)
