"""Projectors that a camera calibrates: a table, a camera and a projector made of independent homographies."""

from __future__ import annotations

import io

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from daidalos.industry.assistance.circles import DetectionError, find_circles, find_light, locate
from daidalos.industry.assistance.homography import fit
from daidalos.industry.assistance.projector_calibration import measure_pairs

Array = NDArray[np.float64]
KNOWN = [(-0.9, -0.6), (-0.9, 0.6), (0.9, -0.6), (0.9, 0.6), (0.4, 0.6)]
CAMERA = (320, 240)
PROJECTOR = (320, 240)
CORNERS = [(-1.0, -0.75), (-1.0, 0.75), (1.0, -0.75), (1.0, 0.75)]
TO_CAMERA = [(30, 220), (65, 20), (295, 210), (250, 30)]
"""Where the camera sees the table's corners [pixels]."""

TO_PROJECTOR = [(30, 210), (20, 15), (300, 225), (310, 30)]
"""Where the projector has them [pixels]."""


def mapped(matrix: Array, points: Array) -> Array:
    found = np.column_stack([points, np.ones(len(points))]) @ matrix.T
    return np.asarray(found[:, :2] / found[:, 2:])


def solve(points: list[tuple[float, float]], pixels: list[tuple[int, int]]) -> Array:
    """Return the map from four points to four pixels, from the eight linear equations with the last entry 1."""
    rows, values = [], []
    for (x, y), (u, v) in zip(points, pixels, strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        values += [u, v]
    return np.append(np.linalg.solve(np.array(rows, float), np.array(values, float)), 1.0).reshape(3, 3)


class Table:
    """A bright table with dark circles under a projector, and pictures of it."""

    def __init__(self, known: list[tuple[float, float]] = KNOWN, light: float = 60.0) -> None:
        self._light = light
        self._picture = np.zeros(PROJECTOR[::-1])
        self._noise = np.random.default_rng(3)
        width, height = CAMERA
        columns, rows = np.meshgrid(np.arange(2 * width) / 2 - 0.25, np.arange(2 * height) / 2 - 0.25)
        places = mapped(np.linalg.inv(solve(CORNERS, TO_CAMERA)), np.column_stack([columns.ravel(), rows.ravel()]))
        self._albedo = np.where((np.abs(places) < (1.0, 0.75)).all(axis=1), 0.8, 0.55)
        for x, y in known:
            self._albedo[np.hypot(places[:, 0] - x, places[:, 1] - y) < 0.04] = 0.1
        pixels = np.rint(mapped(solve(CORNERS, TO_PROJECTOR), places)).astype(int)
        self._is_lit = ((pixels >= 0) & (pixels < PROJECTOR)).all(axis=1)
        self._pixels = np.where(self._is_lit[:, None], pixels, 0)

    def show(self, png: bytes) -> None:
        """Project a picture."""
        self._picture = np.asarray(Image.open(io.BytesIO(png)).convert("L"), float)

    def take(self) -> Array:
        """Return what the camera sees: 2 x 2 rays a pixel, and noise."""
        width, height = CAMERA
        beam = np.where(self._is_lit, self._picture[self._pixels[:, 1], self._pixels[:, 0]], 0.0)
        seen = ((self._light + 0.4 * beam) * self._albedo * 2.0).reshape(height, 2, width, 2).mean(axis=(1, 3))
        return np.asarray(seen + self._noise.normal(0.0, 1.0, seen.shape))


@pytest.mark.slow
def test_pixels_are_found_on_the_plane() -> None:
    table, lines = (
        Table([*KNOWN, (0.35, -0.15), (-0.3, -0.4)]),
        list[str](),
    )  # circles that are none of the known points
    found = measure_pairs(KNOWN, PROJECTOR, table.show, table.take, lines.append)
    wanted = mapped(np.linalg.inv(solve(CORNERS, TO_PROJECTOR)), found.pixels)
    assert len(found.points) == 9
    assert np.linalg.norm(found.points - wanted, axis=1).max() < 0.004
    fitted = fit(found.points.tolist(), found.pixels.tolist())
    assert np.abs(fitted.pixels(CORNERS) - TO_PROJECTOR).max() < 1.0
    assert lines[0].startswith("circles: all 5 found")


@pytest.mark.slow
def test_what_the_camera_does_not_see_is_named() -> None:
    table = Table()
    with pytest.raises(DetectionError, match="sees 0 discs of the projector"):
        measure_pairs(KNOWN, PROJECTOR, lambda png: None, table.take, lambda line: None)
    table = Table(KNOWN[:4])
    with pytest.raises(DetectionError, match="sees 4 of 5 circles"):
        measure_pairs(KNOWN, PROJECTOR, table.show, table.take, lambda line: None)


def seen(points: object) -> Array:
    return mapped(solve(CORNERS, TO_CAMERA), np.array(points, float))


def test_circles_are_the_points_that_they_fit() -> None:
    known = np.array([*KNOWN, (0.1, -0.2)])
    shuffled = np.random.default_rng(1).permutation(np.concatenate([seen(known), [[300.0, 20.0]]]))
    found = locate(known, shuffled, CAMERA[0])
    assert found.pixels(CORNERS) == pytest.approx(np.array(TO_CAMERA, float), abs=1e-6)
    cases = [
        (KNOWN[:4], seen(KNOWN[:4]), "at least 5 known points"),
        ([*CORNERS, (0.0, 0.0)], seen([*CORNERS, (0.0, 0.0)]), "look the same from several sides"),
        (KNOWN, seen([*KNOWN[:4], (0.1, 0.1)]), "do not lie as the known points do"),
        (KNOWN, CAMERA[0] - seen(KNOWN) * (1, -1), "do not lie as the known points do"),  # mirrored
        ([(n, 0.0) for n in range(5)], seen(KNOWN), "no three of four points"),
    ]
    for points, circles, problem in cases:
        with pytest.raises(DetectionError, match=problem):
            locate(np.array(points, float), circles, CAMERA[0])


def test_only_filled_circles_are_found() -> None:
    rows, columns = np.mgrid[:200, :300].astype(float)
    picture = np.full((200, 300), 200.0)
    picture[np.hypot((rows - 60.3) / 6, (columns - 80.7) / 9) < 1.0] = 20.0  # an ellipse
    picture[20:60, 200:204] = 20.0  # a line
    picture[100:140, 60:100] = 20.0
    picture[105:135, 65:95] = 200.0  # a frame
    picture[np.hypot(rows - 150, columns - 220) < 2] = 20.0  # too small
    assert find_circles(picture) == pytest.approx(np.array([[80.7, 60.3]]), abs=0.3)
    assert len(find_circles(np.full((50, 50), 7.0))) == 0


def test_light_is_found_where_there_is_some() -> None:
    dark = np.random.default_rng(2).normal(50.0, 1.0, (100, 140))
    lit = dark + np.random.default_rng(3).normal(0.0, 1.0, dark.shape)
    assert find_light(dark, lit) is None
    assert find_light(dark, dark) is None
    rows, columns = np.mgrid[:100, :140]
    lit[np.hypot(rows - 40.0, columns - 90.0) < 6.0] += 30.0
    assert find_light(dark, lit) == pytest.approx((90.0, 40.0), abs=0.3)
    lit[:4, :4] += 200.0  # a brighter one that is cut off by the edge
    assert find_light(dark, lit) is None
