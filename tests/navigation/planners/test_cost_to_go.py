"""Estimates of the cost to a goal."""

import math

import numpy as np
import pytest

from daidalos.navigation.planners.cost_to_go import cheapest_costs, costs_to_goal
from daidalos.navigation.planners.search import prices


@pytest.mark.parametrize("allow_unknown", [False, True])
def test_a_larger_cell_has_its_cheapest_cost(allow_unknown):
    price = prices(1.0, 2.0, quadratic=False, allow_unknown=allow_unknown)
    costs = np.array([[10, 254, 255], [20, 254, 254], [7, 30, 254]], dtype=np.uint8)
    found = cheapest_costs(costs, price, 2)
    assert found[0, 0] == 10
    assert np.isfinite(price[found[0, 1]]) == allow_unknown
    assert found[1].tolist() == [7, 254]


def test_costs_to_the_goal_are_those_of_the_best_way():
    costs = np.zeros((30, 40), dtype=np.uint8)
    costs[:25, 20] = 254
    price = prices(1.0, 2.0, quadratic=False, allow_unknown=True)
    rest = costs_to_goal(costs, price, 30, 5, 0.0, math.inf, 10, 5)
    assert rest[5, 30] == 0.0
    assert rest[5, 35] == pytest.approx(5.0)
    assert rest[8, 33] == pytest.approx(3.0 * math.sqrt(2.0), rel=1e-5)
    assert rest[5, 10] > 2.0 * math.hypot(10.0, 20.0) - 5.0
    near = costs_to_goal(costs, price, 30, 5, 0.0, 0.0, 28, 5)
    assert near[29, 0] < rest[29, 0]
    costs[:, 20] = 254
    assert not np.isfinite(costs_to_goal(costs, price, 30, 5, 0.0, 0.0, 10, 5)[5, 10])
