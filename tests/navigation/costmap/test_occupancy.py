"""Costs as Nav2 publishes them, and costs of maps."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from daidalos.navigation.costmap.occupancy import from_occupancy, to_occupancy


def test_the_marked_costs_have_nav2s_values():
    costs = np.array([[0, 1, 252, 253, 254, 255]], dtype=np.uint8)
    assert to_occupancy(costs).tolist() == [[0, 1, 98, 99, 100, -1]]
    assert to_occupancy(costs).dtype == np.int8


@given(st.integers(1, 251))
def test_costs_in_between_grow(cost):
    low, high = to_occupancy(np.array([cost, cost + 1], dtype=np.uint8))
    assert 1 <= low <= high <= 98


def test_a_map_becomes_free_lethal_and_unknown():
    occupancy = np.array([[-1, 0, 50, 99, 100]], dtype=np.int8)
    assert from_occupancy(occupancy).tolist() == [[255, 0, 0, 0, 254]]
    assert from_occupancy(occupancy, lethal_cost_threshold=65).tolist() == [[255, 0, 0, 254, 254]]
    assert from_occupancy(occupancy, track_unknown_space=False).tolist() == [[0, 0, 0, 0, 254]]
    assert from_occupancy(occupancy, trinary_costmap=False).tolist() == [[255, 0, 127, 251, 254]]


def test_views_that_are_not_contiguous_are_read_right():
    occupancy = np.array([[0, 100], [100, 0]], dtype=np.int8)[:, ::-1]
    assert from_occupancy(occupancy).tolist() == [[254, 0], [0, 254]]
