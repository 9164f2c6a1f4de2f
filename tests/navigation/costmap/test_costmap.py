"""The grid itself: geometry, windows, and moving over the world."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.costmap.costmap import (
    EVERYWHERE,
    NO_INFORMATION,
    Bounds,
    Costmap,
    CostmapError,
    Window,
)


def test_cells_and_positions_are_inverse():
    costmap = Costmap.filled(7, 5, 0.1, (-0.3, 2.0))
    for row in range(5):
        for column in range(7):
            assert costmap.world_to_map(*costmap.map_to_world(column, row)) == (column, row)


def test_rows_grow_with_y_and_columns_with_x():
    costs = np.zeros((2, 3), dtype=np.uint8)
    costs[1, 2] = 77
    costmap = Costmap(costs, 1.0, (10.0, 20.0))
    assert costmap.cost_at(12.5, 21.5) == 77
    assert costmap.cost_at(11.5, 21.5) == 0


def test_outside_is_unknown():
    assert Costmap.filled(2, 2, 1.0, (0.0, 0.0)).cost_at(-0.01, 1.0) == NO_INFORMATION


@pytest.mark.parametrize("resolution", [0.0, -1.0, float("nan"), float("inf")])
def test_a_resolution_must_be_a_length(resolution):
    with pytest.raises(CostmapError, match="resolution"):
        Costmap(np.zeros((2, 2), dtype=np.uint8), resolution, (0.0, 0.0))


def test_costs_must_be_bytes():
    with pytest.raises(CostmapError, match="int8"):
        Costmap(np.zeros((2, 2), dtype=np.int8), 0.1, (0.0, 0.0))


@given(right=st.integers(-6, 6), up=st.integers(-6, 6), width=st.integers(1, 9), height=st.integers(1, 9))
def test_cells_keep_their_place_when_the_grid_moves(right, up, width, height):
    generator = np.random.default_rng(0)
    before = Costmap(generator.integers(0, 255, (4, 5)).astype(np.uint8), 0.25, (1.0, -1.0))
    after = before.copy()
    after.cover(width, height, before.origin + 0.25 * np.array([right, up]), 255)
    assert after.costs.shape == (height, width)
    for row in range(height):
        for column in range(width):
            x, y = after.map_to_world(column, row)
            assert after.costs[row, column] == before.cost_at(x, y)


def test_windows_of_bounds_are_cut_to_the_grid():
    costmap = Costmap.filled(10, 8, 0.5, (0.0, 0.0))
    assert costmap.window_of(EVERYWHERE) == Window(0, 0, 10, 8)
    assert costmap.window_of(Bounds()).empty
    assert costmap.window_of(Bounds(1.1, 0.6, 1.2, 2.1)) == Window(2, 1, 3, 5)
    assert costmap.window_of(Bounds(100.0, 100.0, 101.0, 101.0)).empty


def test_bounds_grow_and_stay_empty():
    assert Bounds().expanded(3.0).empty
    both = Bounds(0.0, 0.0, 1.0, 1.0).including_points(np.array([[2.0, -1.0]]))
    assert both == Bounds(0.0, -1.0, 2.0, 1.0)
    assert both.including(Bounds()) == both
