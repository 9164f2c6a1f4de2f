"""Outlines of robots: what they are, and what lies under them."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Point, Polygon

from daidalos.navigation.costmap.costmap import Costmap, CostmapError
from daidalos.navigation.costmap.footprint import (
    Footprint,
    FootprintCollisionChecker,
    fill_polygon,
    outline_cost,
)

BOX = np.array([[0.3, 0.2], [0.3, -0.2], [-0.4, -0.2], [-0.4, 0.2]])


def test_radii_of_a_box():
    footprint = Footprint.of_corners(BOX)
    assert footprint.inscribed_radius == pytest.approx(0.2)
    assert footprint.circumscribed_radius == pytest.approx(math.hypot(0.4, 0.2))
    assert not footprint.circular


def test_an_outline_beside_the_origin_inscribes_nothing():
    assert Footprint.of_corners(BOX + np.array([1.0, 0.0])).inscribed_radius == 0.0


def test_padding_moves_corners_outward():
    padded = Footprint.of_corners(BOX, 0.05)
    assert np.allclose(np.abs(padded.polygon) - np.abs(BOX), 0.05)


def test_parameters_of_a_parameter_file():
    assert Footprint.from_parameters(robot_radius=0.22).circular
    given_corners = Footprint.from_parameters("[ [0.3, 0.2], [0.3, -0.2], [-0.4, -0.2], [-0.4, 0.2] ]", 0.22, 0.0)
    assert np.allclose(given_corners.polygon, BOX)


@pytest.mark.parametrize("text", ["[[0.1, 0.2]", "[[0.1, 0.2], [0.3]]", "hello", "[[0, 0], [1, 1]]", "[[[]]]x"])
def test_a_footprint_that_is_none_is_refused(text):
    with pytest.raises(CostmapError, match="footprint must be"):
        Footprint.from_parameters(text)


@pytest.mark.parametrize("radius", [0.0, -0.1, math.nan])
def test_a_radius_must_be_a_length(radius):
    with pytest.raises(CostmapError, match="robot_radius"):
        Footprint.circle(radius)


@given(x=st.floats(0.5, 2.5), y=st.floats(0.5, 2.5), yaw=st.floats(-math.pi, math.pi), seed=st.integers(0, 50))
def test_the_outline_sees_what_a_dense_walk_along_it_sees(x, y, yaw, seed):
    generator = np.random.default_rng(seed)
    costs = (generator.random((30, 30)) < 0.02).astype(np.uint8) * 254
    costmap = Costmap(costs, 0.1, (0.0, 0.0))
    corners = Footprint.of_corners(BOX).at(np.array([x, y, yaw]))
    walk = [
        costmap.cost_at(*(a + s * (b - a)))
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
        for s in np.linspace(0.0, 1.0, 400)
    ]
    cost = outline_cost(costs, 0.1, costmap.origin, BOX, x, y, yaw)
    assert cost in (0, 254)
    if cost == 254:
        assert max(walk) == 254
    elif max(walk) == 254:
        # Only a corner of a cell can lie between the half-cell steps of the outline.
        assert np.mean(np.array(walk) == 254) < 0.05


@given(x=st.floats(0.6, 2.4), y=st.floats(0.6, 2.4), yaw=st.floats(-math.pi, math.pi))
def test_filled_cells_are_those_whose_centres_are_inside(x, y, yaw):
    costmap = Costmap.filled(30, 30, 0.1, (0.0, 0.0))
    corners = Footprint.of_corners(BOX).at(np.array([x, y, yaw]))
    fill_polygon(costmap, corners, 9)
    polygon = Polygon(corners)
    for row in range(30):
        for column in range(30):
            centre = Point(*costmap.map_to_world(column, row))
            if polygon.exterior.distance(centre) > 1e-9:
                assert (costmap.costs[row, column] == 9) == polygon.contains(centre)


def test_a_round_robot_is_judged_by_its_centre():
    costmap = Costmap.filled(10, 10, 0.1, (0.0, 0.0))
    costmap.costs[5, 5] = 253
    checker = FootprintCollisionChecker(costmap, Footprint.circle(0.2))
    assert checker.in_collision(np.array([0.55, 0.55, 1.0]))
    assert checker.footprint_cost_at(np.array([0.45, 0.55, 0.0])) == 0
    assert checker.footprint_cost_at(np.array([-1.0, 0.0, 0.0])) == 255


def test_a_long_robot_touches_with_its_corner_only():
    costmap = Costmap.filled(40, 40, 0.05, (-1.0, -1.0))
    column, row = costmap.world_to_map(0.0, 0.37)
    costmap.costs[row, column] = 254
    checker = FootprintCollisionChecker(costmap, Footprint.of_corners(BOX))
    assert not checker.in_collision(np.zeros(3))
    assert not checker.in_collision(np.array([0.0, 0.0, math.pi / 2]))
    assert checker.in_collision(np.array([0.0, 0.0, -math.pi / 2]))
