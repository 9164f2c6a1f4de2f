import numpy as np
import pytest

from daidalos.mapping.scan_matching.buckets import MERGE_RADIUS, build_reference


def unit(angles: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(angles), np.sin(angles)], axis=1)


def test_points_lie_in_their_cells() -> None:
    rng = np.random.default_rng(0)
    points = rng.uniform(-3.0, 3.0, (500, 2))
    reference = build_reference(points, unit(rng.uniform(-3.0, 3.0, 500)), 0.25)
    assert reference.starts[-1] == len(reference.points)
    for cell in range(len(reference.starts) - 1):
        inside = reference.points[reference.starts[cell] : reference.starts[cell + 1]]
        row, column = divmod(cell, reference.columns)
        low = reference.corner + np.array([column, row]) * 0.25
        assert np.all((inside >= low - 1e-9) & (inside <= low + 0.25 + 1e-9))


def test_points_that_show_one_spot_become_their_mean() -> None:
    points = np.array([[0.50, 0.5], [0.51, 0.5], [0.52, 0.5]])
    reference = build_reference(points, unit(np.array([0.1, 0.0, -0.1])), 1.0)
    assert reference.points == pytest.approx(np.array([[0.51, 0.5]]))
    assert reference.normals == pytest.approx(np.array([[1.0, 0.0]]))


def test_both_sides_of_a_wall_are_kept() -> None:
    points = np.array([[0.5, 0.5], [0.5, 0.5]])
    reference = build_reference(points, np.array([[1.0, 0.0], [-1.0, 0.0]]), 1.0)
    assert len(reference.points) == 2


def test_distant_points_are_all_kept() -> None:
    points = np.stack(np.meshgrid(np.arange(10.0), np.arange(10.0)), axis=-1).reshape(-1, 2) * 2 * MERGE_RADIUS
    reference = build_reference(points, np.tile([0.0, 1.0], (100, 1)), 0.2)
    assert np.array_equal(np.unique(reference.points.round(6), axis=0), np.unique(points.round(6), axis=0))


def test_points_without_a_normal_are_left_out() -> None:
    reference = build_reference(np.zeros((3, 2)), np.zeros((3, 2)), 0.2)
    assert len(reference.points) == 0
    assert reference.starts.tolist() == [0, 0]
