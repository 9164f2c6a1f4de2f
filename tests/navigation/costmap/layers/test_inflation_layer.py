"""Inflation against scipy's exact distance transform."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.ndimage import distance_transform_edt

from daidalos.common.parameters import ParameterError
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Costmap, Window
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layers.inflation_layer import InflationLayer, InflationLayerParameters
from properties import examples


def twin(costs, resolution, inscribed, radius, factor):
    """Inflation, cell by cell, from the formula."""
    inflated = costs.copy()
    if not (costs == 254).any():
        return inflated
    cells = distance_transform_edt(costs != 254)
    for (row, column), distance in np.ndenumerate(cells * resolution):
        if costs[row, column] >= 254 or cells[row, column] > math.floor(radius / resolution + 1e-9):
            continue
        near = distance <= inscribed + 1e-9
        cost = 253 if near else int(252 * math.exp(-factor * (distance - inscribed)))
        inflated[row, column] = max(inflated[row, column], cost)
    return inflated


@examples(40)
@given(
    seed=st.integers(0, 10_000),
    share=st.sampled_from([0.0, 0.002, 0.02, 0.2]),
    shape=st.tuples(st.integers(1, 45), st.integers(1, 45)),
    radius=st.sampled_from([0.0, 0.05, 0.31, 0.55, 1.0]),
    factor=st.sampled_from([0.0, 3.0, 10.0]),
)
def test_costs_follow_the_exact_distance(seed, share, shape, radius, factor):
    generator = np.random.default_rng(seed)
    costs = np.where(generator.random(shape) < share, 254, generator.integers(0, 40, shape)).astype(np.uint8)
    layer = InflationLayer(
        InflationLayerParameters(radius, factor), NavigationContext(footprint=Footprint.circle(0.22))
    )
    costmap = Costmap(costs.copy(), 0.05, (0.0, 0.0))
    layer.update_costs(costmap, costmap.window)
    expected = twin(costs, 0.05, 0.22, radius, factor) if radius > 0.0 else costs
    assert np.array_equal(costmap.costs, expected)


@examples(30)
@given(seed=st.integers(0, 10_000), left=st.integers(0, 30), bottom=st.integers(0, 30))
def test_a_window_gets_what_the_whole_gets(seed, left, bottom):
    generator = np.random.default_rng(seed)
    costs = (generator.random((40, 40)) < 0.01).astype(np.uint8) * 254
    layer = InflationLayer(InflationLayerParameters(0.5, 3.0), NavigationContext(footprint=Footprint.circle(0.2)))
    whole, part = (Costmap(costs.copy(), 0.05, (0.0, 0.0)) for _ in range(2))
    layer.update_costs(whole, whole.window)
    window = Window(left, bottom, min(left + 10, 40), min(bottom + 10, 40))
    layer.update_costs(part, window)
    assert np.array_equal(part.costs[window.slices], whole.costs[window.slices])
    part.costs[window.slices] = costs[window.slices]
    assert np.array_equal(part.costs, costs)


def test_unknown_is_inflated_only_within_contact_unless_asked_for():
    costs = np.full((1, 12), 255, dtype=np.uint8)
    costs[0, 0] = 254
    plain, all_of_it = (Costmap(costs.copy(), 0.1, (0.0, 0.0)) for _ in range(2))
    InflationLayer(InflationLayerParameters(0.5, 3.0), NavigationContext(footprint=Footprint.circle(0.2))).update_costs(
        plain, plain.window
    )
    assert plain.costs[0].tolist() == [254, 253, 253] + [255] * 9
    layer = InflationLayer(
        InflationLayerParameters(0.5, 3.0, inflate_unknown=True), NavigationContext(footprint=Footprint.circle(0.2))
    )
    layer.update_costs(all_of_it, all_of_it.window)
    assert all_of_it.costs[0, 3] == 186
    assert all_of_it.costs[0, 6] == 255


def test_around_unknown():
    costs = np.zeros((1, 6), dtype=np.uint8)
    costs[0, 0] = 255
    costmap = Costmap(costs, 0.1, (0.0, 0.0))
    parameters = InflationLayerParameters(0.3, 3.0, inflate_around_unknown=True)
    InflationLayer(parameters, NavigationContext(footprint=Footprint.circle(0.15))).update_costs(
        costmap, costmap.window
    )
    assert costmap.costs[0, 1] == 253
    assert 0 < costmap.costs[0, 3] < 253


def test_cost_at_a_distance():
    layer = InflationLayer(InflationLayerParameters(0.5, 3.0), NavigationContext(footprint=Footprint.circle(0.2)))
    assert [layer.cost_at_distance(d) for d in (0.0, 0.2, 0.3, 0.6)] == [253, 253, 186, 0]


def test_negative_parameters_are_refused():
    with pytest.raises(ParameterError, match="must be at least 0"):
        InflationLayerParameters(inflation_radius=-0.1)
