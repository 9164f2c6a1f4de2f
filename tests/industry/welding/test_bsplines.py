"""Splines of degree 4 through paths of poses."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from daidalos.industry.welding.bsplines import fit_path


def poses(positions, angles):
    out = np.tile(np.eye(4), (len(positions), 1, 1))
    out[:, :3, 3] = positions
    c, s = np.cos(angles), np.sin(angles)
    out[:, 0, 0], out[:, 0, 1], out[:, 1, 0], out[:, 1, 1] = c, -s, s, c
    return out


def test_a_polynomial_of_degree_4_needs_no_knots():
    at = np.linspace(0, 1, 200)
    fitted = fit_path(at, poses(np.column_stack([at, at**4, 1 - at**3]), np.zeros(200)))
    assert fitted.knots() == (0, 0)
    assert fitted.pieces[0].position.k == 4
    assert fitted.residuals.max() < 1e-12


def test_knots_are_added_until_the_tolerance_is_met():
    at = np.linspace(0, 1, 400)
    path = poses(np.column_stack([at, 0.1 * np.sin(20 * at), 0 * at]), 3.0 * at)
    counts = []
    for tolerance in (1e-3, 1e-5, 1e-7):
        fitted = fit_path(at, path, position_tolerance=tolerance)
        assert fitted.residuals.max() <= tolerance
        assert fitted.angle_residuals.max() <= 2e-5
        counts.append(fitted.knots()[0])
    assert counts == sorted(counts)
    assert counts[0] < counts[2]


def test_a_jump_is_kept_where_a_piece_begins():
    at = np.linspace(0, 1, 100)
    path = poses(np.column_stack([at, (at > 0.505) * 0.003, 0 * at]), np.zeros(100))
    fitted = fit_path(at, path, breaks=[51 if at[50] < 0.505 < at[51] else 50])
    assert len(fitted.pieces) == 2
    assert fitted.knots()[0] == 0
    assert fitted.residuals.max() < 1e-9


@given(st.integers(2, 40), st.integers(0, 5), st.randoms(use_true_random=False))
@settings(max_examples=40, deadline=None)
def test_no_path_is_too_short_or_too_wild(count, breaks, random):
    at = np.cumsum([random.uniform(1e-3, 1.0) for _ in range(count)])
    positions = np.array([[random.uniform(-1, 1) for _ in range(3)] for _ in range(count)])
    at_breaks = [random.randrange(1, count) for _ in range(breaks)]
    fitted = fit_path(at, poses(positions, np.linspace(0, 1, count)), at_breaks)
    assert fitted.residuals.max() < 1e-5
    assert fitted.pieces[-1].last == count - 1


def test_orientations_beyond_half_a_turn_stay_continuous():
    at = np.linspace(0, 1, 300)
    fitted = fit_path(at, poses(np.column_stack([at, 0 * at, 0 * at]), 9.0 * at))
    assert fitted.angle_residuals.max() == pytest.approx(0.0, abs=2e-5)
    assert fitted.knots()[1] < 30
