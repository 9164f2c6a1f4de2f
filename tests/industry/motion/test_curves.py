"""Geometry of movements and corner paths against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation, Slerp

from daidalos.industry.motion.corners import PoseCorner
from daidalos.industry.motion.curves import METRES_PER_RADIAN, Circle, CircleMode, Line
from daidalos.industry.motion.faults import MotionFault
from daidalos.industry.motion.orientations import multiply, slerp
from daidalos.industry.motion.spline_kernels import spline_slopes, spline_values

DOWN = np.array([0.0, 1.0, 0.0, 0.0])


def turned(degrees: float) -> np.ndarray:
    return Rotation.from_euler("z", degrees, degrees=True).as_quat() if degrees else np.array([0.0, 0.0, 0.0, 1.0])


def test_slerp_and_products_are_those_of_scipy() -> None:
    a, b = Rotation.random(2, rng=1).as_quat()
    shares = np.linspace(0.0, 1.0, 11)
    wanted = Slerp([0, 1], Rotation.from_quat([a, b]))(shares).as_matrix()
    assert Rotation.from_quat(slerp(a, b, shares)).as_matrix() == pytest.approx(wanted, abs=1e-12)
    product = (Rotation.from_quat(a) * Rotation.from_quat(b)).as_matrix()
    assert Rotation.from_quat(multiply(a, b)).as_matrix() == pytest.approx(product, abs=1e-12)


@pytest.mark.parametrize("mode", ["path", "object", "point"])
def test_circle(mode: CircleMode) -> None:
    points = (np.array([1.0, 0.0, 0.5]), np.array([0.0, 1.0, 0.5]), np.array([-1.0, 0.0, 0.5]))
    turns = (turned(0), turned(70), turned(180))
    arc = Circle.through(points, turns, mode)
    assert arc.length == pytest.approx(math.pi)
    positions, orientations = arc.poses(np.linspace(0.0, arc.length, 9))
    angles = np.linspace(0.0, math.pi, 9)
    assert positions == pytest.approx(np.stack([np.cos(angles), np.sin(angles), np.full(9, 0.5)], axis=1), abs=1e-12)
    about = Rotation.from_quat(orientations).magnitude()
    if mode == "path":
        assert about == pytest.approx(angles, abs=1e-9)
    middle = {"path": 90.0, "object": 90.0, "point": 70.0}[mode]
    assert math.degrees(about[4]) == pytest.approx(middle, abs=1e-6)


@pytest.mark.parametrize(
    ("via", "end", "text"),
    [
        ([0.5, 0.0, 0.0], [1.0, 0.0, 0.0], "on a line"),
        ([0.0, 0.0, 0.0], [1.0, 0.0, 0.0], "apart"),
        ([1.0, 1.0, 0.0], [0.1, -0.3, 0.0], "more than 240"),
    ],
)
def test_circle_that_is_none(via: list[float], end: list[float], text: str) -> None:
    with pytest.raises(MotionFault, match=text) as caught:
        Circle.through((np.zeros(3), np.array(via), np.array(end)), (DOWN, DOWN, DOWN))
    assert caught.value.number == 50063


def test_corner_between_lines_is_the_parabola() -> None:
    corner, d = np.array([0.4, 0.1, 0.3]), 0.02
    u, v = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.6, 0.8])
    before = Line(corner - 0.2 * u, corner, turned(0), turned(30))
    after = Line(corner, corner + 0.3 * v, turned(30), turned(90))
    path = PoseCorner(before, after, d, 0.05)
    x = np.linspace(-d, d, 21)
    share = ((x + d) / (2 * d))[:, None]
    wanted = (1 - share) ** 2 * (corner - d * u) + 2 * share * (1 - share) * corner + share**2 * (corner + d * v)
    assert path.poses(x)[0] == pytest.approx(wanted, abs=1e-12)
    ends = path.poses(np.array([-0.05, 0.05]))
    assert ends[0] == pytest.approx(np.array([corner - 0.05 * u, corner + 0.05 * v]), abs=1e-12)
    angles = Rotation.from_quat(path.poses(np.array([-0.05, -0.05 + 1e-6, 0.05 - 1e-6, 0.05]))[1]).magnitude()
    assert math.degrees(angles[0]) == pytest.approx(22.5)
    assert math.degrees((angles[1] - angles[0]) / 1e-6) == pytest.approx(150.0, rel=1e-3)
    assert math.degrees((angles[3] - angles[2]) / 1e-6) == pytest.approx(200.0, rel=1e-3)


def test_rotation_in_place_counts_as_length() -> None:
    line = Line(np.zeros(3), np.zeros(3), turned(0), turned(90))
    assert line.length == pytest.approx(METRES_PER_RADIAN * math.pi / 2) == pytest.approx(0.9)


@pytest.mark.parametrize("count", [4, 5, 40])
def test_splines_are_those_of_scipy(count: int) -> None:
    x = np.linspace(0.3, 1.7, count)
    values = np.stack([np.sin(3.0 * x), np.exp(x), x**3], axis=1)
    slopes = np.empty_like(values)
    spline_slopes(x[1] - x[0], values, slopes)
    places = np.linspace(0.3, 1.7, 57)
    found = [np.empty((57, 3)) for _ in range(3)]
    spline_values(0.3, x[1] - x[0], values, slopes, places, *found)
    wanted = CubicSpline(x, values)
    for order, one in enumerate(found):
        assert one == pytest.approx(wanted(places, order), abs=1e-9)
