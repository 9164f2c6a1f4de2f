"""Homographies of projectors: known ones are found again, pairs that determine none are named."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.documents import DocumentError
from daidalos.industry.assistance.homography import HomographyError, fit, read_homography, write_pairs

CORNERS = [(-1.0, -0.75), (-1.0, 0.75), (1.0, -0.75), (1.0, 0.75)]
TRUE = np.array([[420.0, 31.0, 640.0], [-22.0, -400.0, 360.0], [0.05, -0.08, 1.0]])


def seen(points: object) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Return the pixels of points by the true homography, each by its definition."""
    rows = [TRUE @ (x, y, 1.0) for x, y in np.asarray(points)]
    return np.array([row[:2] / row[2] for row in rows])


def test_four_pairs_determine_all_others() -> None:
    found = fit(CORNERS, seen(CORNERS).tolist())
    others = np.array([(0.3, 0.2), (-0.8, 0.1), (0.0, 0.0)])
    assert found.pixels(others) == pytest.approx(seen(others), abs=1e-8)
    assert found.points(seen(others)) == pytest.approx(others, abs=1e-10)
    assert found.residual < 1e-8


def test_more_pairs_average_noise() -> None:
    rng = np.random.default_rng(1)
    grid = [(x, y) for x in np.linspace(-1, 1, 7) for y in np.linspace(-0.75, 0.75, 5)]
    found = fit(grid, (seen(grid) + rng.normal(0.0, 0.5, (len(grid), 2))).tolist())
    assert 0.4 < found.residual < 1.0  # sqrt(2) * 0.5 less what the eight parameters take
    assert np.abs(found.pixels(grid) - seen(grid)).max() < 1.0


@given(st.lists(st.tuples(st.floats(-2, 2), st.floats(-2, 2)), min_size=4, max_size=8))
def test_any_points_are_fitted_or_named(points: list[tuple[float, float]]) -> None:
    try:
        found = fit(points, seen(points).tolist())
    except HomographyError:
        return
    assert found.residual < 1e-3


@pytest.mark.parametrize(
    ("points", "pixels", "problem"),
    [
        (CORNERS[:3], CORNERS[:3], "at least 4 pairs"),
        ([(0, 0), (1, 1), (2, 2), (0, 1)], CORNERS, "line"),
        ([(0, 0)] * 4, CORNERS, "all points are the same"),
        (CORNERS, [(0, 0), (1, 1), (2, 2), (3, 3)], "line"),
        ([*CORNERS[:3], (np.nan, 0)], CORNERS, "finite"),
    ],
)
def test_pairs_that_determine_none(points: list[tuple[float, float]], pixels: object, problem: str) -> None:
    with pytest.raises(HomographyError, match=problem):
        fit(points, pixels)  # type: ignore[arg-type]


def test_file_there_and_back(tmp_path: Path) -> None:
    file = tmp_path / "beamer.yaml"
    write_pairs(file, CORNERS, seen(CORNERS).tolist())
    assert read_homography(file).pixels([(0.3, 0.2)]) == pytest.approx(seen([(0.3, 0.2)]), abs=1e-6)


@pytest.mark.parametrize(
    ("text", "problem"),
    [("[]", "list 'pairs'"), ("pairs: [{point: [1, 2]}]", r"pairs\[0\]: 'pixel'"), ("pairs: []", "at least 4")],
)
def test_files_that_are_none(tmp_path: Path, text: str, problem: str) -> None:
    file = tmp_path / "beamer.yaml"
    file.write_text(text)
    with pytest.raises((DocumentError, HomographyError), match=problem):
        read_homography(file)
