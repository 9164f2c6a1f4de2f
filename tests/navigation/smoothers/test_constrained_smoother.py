"""Constrained smoothing against SciPy's least squares, and each parameter."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.optimize import least_squares

from daidalos.common.parameters import ParameterError
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import SmootherError
from daidalos.navigation.paths import path_length, with_headings
from daidalos.navigation.smoothers.constrained_smoother import (
    ConstrainedSmoother,
    ConstrainedSmootherParameters,
    OptimizerParameters,
    upsampled,
)
from daidalos.navigation.smoothers.path_optimization import Limits, Weights, _Problem, interpolated, optimize
from properties import examples

FREE = Costmap.filled(80, 80, 0.05, (0.0, 0.0))
CENTRE = np.array([[0.0, 0.0, 1.0]])


def smoother(**parameters):
    return ConstrainedSmoother(ConstrainedSmootherParameters(**parameters))


def slope():
    """Return a costmap whose cost grows with y, by 40 a metre."""
    costs = np.repeat(np.arange(80, dtype=np.uint8)[:, None] * 2, 80, axis=1)
    return Costmap(costs, 0.05, (0.0, 0.0))


def corner():
    x = np.arange(1.0, 2.0, 0.05)
    points = np.concatenate([np.stack([x, np.ones(20)], -1), np.stack([np.full(20, 2.0), x], -1)])
    return with_headings(points, final_heading=math.pi / 2)


def there_and_back():
    """Return a path forwards to the right, and backwards away to the left, with a cusp at its 21st pose."""
    ahead = np.stack([np.linspace(1.0, 2.0, 21), np.linspace(1.0, 1.3, 21), np.full(21, 0.29)], axis=-1)
    back = np.stack([np.linspace(1.95, 1.0, 20), np.linspace(1.31, 1.5, 20), np.full(20, -0.2)], axis=-1)
    return np.concatenate([ahead, back])


def curvature(path):
    steps = np.diff(path[:, :2], axis=0)
    a, b = steps[:-1], steps[1:]
    lengths = np.hypot(*a.T) * np.hypot(*b.T) * np.hypot(*(a + b).T)
    return 2.0 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / lengths


@examples(20)
@given(seed=st.integers(0, 1000), is_dense=st.booleans(), has_cusp=st.booleans())
@example(seed=630, is_dense=False, has_cusp=False)
def test_the_least_squares_are_those_of_scipy(seed, is_dense, has_cusp):
    generator = np.random.default_rng(seed)
    points = np.cumsum(generator.uniform(0.03, 0.1, (12, 2)) * (1.0, 0.3), axis=0) + 1.0
    signs = np.ones(11)
    if has_cusp:
        points[7:] = points[6] - (points[7:] - points[6]) * (1.0, -1.0)
        signs[6:] = -1.0
    fixed = np.zeros(12, dtype=bool)
    fixed[[0, 1, -2, -1]] = True
    weights = Weights(2000.0, 3.0, 1.0, np.full(12, 1e-3), 2.5, np.array([[0.1, 0.05, 0.5], [0.0, 0.0, 0.5]]))
    rows, columns = np.indices((80, 80))
    costs = 120.0 + 60.0 * np.sin(0.05 * columns + seed) + 60.0 * np.cos(0.04 * rows)
    costmap = Costmap(costs.astype(np.uint8), 0.05, (0.0, 0.0))
    problem = _Problem(points, signs, costmap, weights)

    def residuals(moved):
        x = points.copy()
        x[2:-2] = moved.reshape(-1, 2)
        return problem.residuals(x[:-2], x[1:-1], x[2:]).ravel()

    outcome = optimize(points, signs, fixed, costmap, weights, Limits(1000, 1e-15, 1e-14, 1e-9, is_dense))
    assert np.array_equal(outcome.points[fixed], points[fixed])
    polished = least_squares(residuals, outcome.points[2:-2].ravel(), max_nfev=100)
    # Cells have whole costs: the gradient jumps at their edges, where a descent may end.
    assert outcome.after == pytest.approx(polished.cost, rel=5e-3, abs=1e-9)
    assert outcome.after <= outcome.before


def test_without_costs_and_curvature_the_result_is_that_of_linear_algebra():
    path = corner()
    smooth = smoother(w_cost=0.0, w_curve=0.0, w_dist=100.0, w_smooth=50.0).smooth(path, FREE)
    count = len(path)
    differences = np.zeros((count - 2, count))
    lengths = np.hypot(*np.diff(path[:, :2], axis=0).T)
    for i in range(count - 2):
        ratio = lengths[i] / lengths[i + 1]
        differences[i, i : i + 3] = 1.0, -1.0 - ratio, ratio
    whole = np.concatenate([50.0**0.5 * differences, 10.0 * np.eye(count)])
    target = np.concatenate([np.zeros((count - 2, 2)), 10.0 * path[:, :2]])
    inner = slice(2, count - 2)
    fixed = [0, 1, count - 2, count - 1]
    target -= whole[:, fixed] @ path[fixed, :2]
    expected = np.linalg.lstsq(whole[:, inner], target, rcond=None)[0]
    assert smooth[inner, :2] == pytest.approx(expected, abs=1e-6)


def test_interpolated_costs_are_exact_at_cells_and_for_slopes():
    grid = np.random.default_rng(3).uniform(0.0, 255.0, (7, 9))
    rows, columns = np.indices(grid.shape)
    cells = np.stack([columns.ravel(), rows.ravel()], axis=-1).astype(float)
    assert interpolated(grid, cells) == pytest.approx(grid.ravel())
    plane = 3.0 * columns + 5.0 * rows
    places = np.random.default_rng(4).uniform(1.0, 5.0, (50, 2))
    assert interpolated(plane, places) == pytest.approx(places @ (3.0, 5.0))
    assert interpolated(grid, np.array([[-5.0, -5.0], [99.0, 99.0]])) == pytest.approx([grid[0, 0], grid[-1, -1]])


def test_a_path_moves_away_from_costs_by_their_weight():
    path = with_headings(np.stack([np.linspace(0.5, 3.5, 61), np.full(61, 2.0)], axis=-1))
    moved = [smoother(w_cost=w).smooth(path, slope())[30, 1] for w in (0.0, 0.0015, 0.015)]
    assert moved[0] == pytest.approx(2.0)
    assert 2.0 > moved[1] + 0.01 > moved[2] + 0.02
    held = smoother(w_cost=0.015, w_dist=1e6).smooth(path, slope())
    assert held[:, 1] == pytest.approx(np.full(61, 2.0), abs=0.01)


def test_corners_get_as_wide_as_the_turning_radius():
    path = corner()
    loose = {"w_smooth": 10.0, "w_dist": 1.0, "w_cost": 0.0, "optimizer": OptimizerParameters(max_iterations=300)}
    narrow = curvature(smoother(minimum_turning_radius=0.0, **loose).smooth(path, FREE)).max()
    for radius in (0.3, 0.5):
        wide = smoother(minimum_turning_radius=radius, w_curve=3e4, **loose).smooth(path, FREE)
        assert curvature(wide).max() == pytest.approx(1.0 / radius, rel=0.05)
        assert curvature(wide).max() < narrow
    ignored = smoother(minimum_turning_radius=0.5, w_curve=0.0, **loose).smooth(path, FREE)
    assert curvature(ignored).max() == pytest.approx(narrow)


def test_ends_keep_their_headings_where_that_is_asked_for():
    path = corner()
    path[0, 2], path[-1, 2] = 0.3, 1.2
    smooth = smoother().smooth(path, FREE)
    assert np.array_equal(smooth[[0, -1]], path[[0, -1]])
    free = smoother(keep_start_orientation=False, keep_goal_orientation=False).smooth(path, FREE)
    assert np.array_equal(free[[0, -1], :2], path[[0, -1], :2])
    steps = np.diff(free[:, :2], axis=0)
    assert free[[0, -1], 2] == pytest.approx(np.arctan2(steps[[0, -1], 1], steps[[0, -1], 0]))
    assert free[0, 2] > smooth[0, 2] - 0.3 + 1e-3  # it cuts the corner from the beginning on


def test_a_robot_that_reverses_looks_the_same_way():
    path = there_and_back()
    smooth = smoother(w_cost=0.0).smooth(path, FREE)
    assert np.cos(smooth[:, 2]).min() > 0.9
    steps = np.diff(smooth[:, :2], axis=0)
    assert (steps[:19, 0] > 0.0).all()
    assert (steps[22:, 0] < 0.0).all()
    assert not np.allclose(smooth[20, :2], path[20, :2], atol=1e-4)
    turned = smoother(w_cost=0.0, reversing_enabled=False).smooth(path, FREE)
    assert np.cos(turned[32:39, 2]).max() < -0.9


def test_costs_weigh_more_where_the_robot_reverses():
    path = there_and_back()
    given = {"w_smooth": 200.0, "w_dist": 1e4}
    moved = {}
    for name, more in (
        ("same", {"w_cost_cusp_multiplier": 1.0}),
        ("more", {"w_cost_cusp_multiplier": 9.0}),
        ("near", {"w_cost_cusp_multiplier": 9.0, "cusp_zone_length": 0.2}),
    ):
        moved[name] = path[:, 1] - smoother(**given, **more).smooth(path, slope())[:, 1]
    assert moved["more"][20] > moved["near"][20] > moved["same"][20] > 0.0
    weights = smoother(w_cost_cusp_multiplier=4.0)._weights(
        np.array([[0, 0], [1, 0], [0.5, 0], [-1, 0]]), np.array([1, -1, -1])
    )
    assert weights.cost / 0.015 == pytest.approx([1.2**2, 4.0, 1.6**2, 1.0])


def test_places_of_the_robot_under_which_costs_are_taken():
    path = with_headings(np.stack([np.linspace(0.5, 3.5, 61), np.full(61, 2.0)], axis=-1))
    costs = np.zeros((80, 80), np.uint8)
    costs[44:] = np.arange(0, 180, 5, dtype=np.uint8)[:, None]
    costmap = Costmap(costs, 0.05, (0.0, 0.0))
    assert smoother().smooth(path, costmap)[30, 1] == pytest.approx(2.0, abs=1e-3)
    beside = smoother(cost_check_points=(0.0, 0.25, 1.0)).smooth(path, costmap)
    assert beside[30, 1] < 1.99
    back = path.copy()
    back[:, 2] = np.pi
    assert smoother(cost_check_points=(0.0, -0.25, 1.0)).smooth(back, costmap)[30, 1] < 1.99
    points = ConstrainedSmootherParameters(cost_check_points=(0.0, 0.2, 4.0, 0.1, 0.0, 1.0)).check_points
    assert points == pytest.approx(np.array([[0.0, 0.2, 2 / 3], [0.1, 0.0, 1 / 3]]))
    for wrong in ((1.0, 2.0), (0.0, 0.0, -1.0), (0.0, 0.0, 0.0)):
        with pytest.raises(ParameterError, match="cost_check_points"):
            ConstrainedSmootherParameters(cost_check_points=wrong)


def test_points_are_left_out_and_put_back():
    path = corner()
    sizes = {}
    for down, up in ((1, 1), (3, 1), (3, 0), (3, 2), (1, 3), (1000, 0)):
        smooth = smoother(path_downsampling_factor=down, path_upsampling_factor=up).smooth(path, FREE)
        sizes[down, up] = len(smooth)
        assert np.allclose(smooth[[0, -1]], path[[0, -1]])
        ahead = np.diff(smooth[:, :2], axis=0)
        assert path_length(smooth) <= path_length(path) + 1e-6
        assert (np.cos(smooth[:-1, 2]) * ahead[:, 0] + np.sin(smooth[:-1, 2]) * ahead[:, 1] > 0.0).all()
    assert sizes == {(1, 1): 40, (3, 1): 40, (3, 0): 16, (3, 2): 79, (1, 3): 118, (1000, 0): 4}
    cusp = smoother(path_downsampling_factor=6, path_upsampling_factor=0, w_cost=0.0).smooth(there_and_back(), FREE)
    assert cusp[:, 0].max() == pytest.approx(2.0, abs=0.05)


def test_points_between_are_on_the_curve():
    angles = np.linspace(0.0, 1.0, 3)
    arc = np.stack([np.sin(angles), 1.0 - np.cos(angles), angles], axis=-1)
    for sign in (1.0, -1.0):
        turned = arc[:: int(sign)]
        dense = upsampled(turned, np.full(2, sign), np.array([4, 4]))
        assert np.hypot(dense[:, 0], dense[:, 1] - 1.0) == pytest.approx(np.ones(9), abs=2e-3)
        assert dense[:, 2] == pytest.approx(np.linspace(turned[0, 2], turned[-1, 2], 9), abs=0.02)


def test_turns_in_place_stay():
    path = corner()
    turning = path[19:20].repeat(3, axis=0)
    turning[:, 2] = (0.5, 1.0, 1.5)
    with_turn = np.concatenate([path[:20], turning, path[20:]])
    smooth = smoother(w_cost=0.0).smooth(with_turn, FREE)
    assert smooth.shape == with_turn.shape
    assert np.array_equal(smooth[20:22], turning[:2])
    assert np.array_equal(smooth[19, :2], path[19, :2])


def test_short_paths_stay_and_impossible_ones_are_refused():
    for count in range(3):
        assert np.array_equal(smoother().smooth(corner()[:count], FREE), corner()[:count])
    assert smoother().smooth(corner()[:3], FREE).shape == (3, 3)
    path = corner()
    path[3, 1] = np.nan
    with pytest.raises(SmootherError, match="not finite"):
        smoother().smooth(path, FREE)


def test_the_optimisation_ends_as_its_parameters_say_and_logs():
    path, lines = corner(), []

    def iterations(**optimizer):
        given = ConstrainedSmootherParameters(optimizer=OptimizerParameters(debug_optimizer=True, **optimizer))
        lines.clear()
        ConstrainedSmoother(given, replace(NavigationContext(), warn=lines.append)).smooth(path, slope())
        assert len(lines) == 1
        return int(lines[0].split(" in ")[1].split()[0])

    assert iterations(max_iterations=2) == 2
    full = iterations()
    assert full > 2
    assert iterations(fn_tol=0.5) < full
    assert iterations(param_tol=0.5) == 1
    assert iterations(gradient_tol=1e12) == 1
    assert abs(iterations(linear_solver_type="DENSE_QR") - full) <= 1
    with pytest.raises(ParameterError, match="must be one of DENSE_QR, SPARSE_NORMAL_CHOLESKY"):
        OptimizerParameters(linear_solver_type="QR")
