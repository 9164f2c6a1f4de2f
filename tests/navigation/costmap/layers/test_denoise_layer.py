"""Removal of small obstacles against a flood fill."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from daidalos.common.parameters import ParameterError, parameters_from
from daidalos.navigation.costmap.costmap import Bounds, Costmap
from daidalos.navigation.costmap.layers.denoise_layer import DenoiseLayer, DenoiseLayerParameters
from properties import examples


def twin(costs, size, connectivity):
    """Costs without the groups that a flood fill finds too small."""
    left = {(int(row), int(column)) for row, column in np.argwhere(costs == 254)}
    result = costs.copy()
    while left:
        group, edge = set(), [left.pop()]
        while edge:
            row, column = edge.pop()
            group.add((row, column))
            for d_row in (-1, 0, 1):
                for d_column in (-1, 0, 1):
                    near = (row + d_row, column + d_column)
                    if near in left and (connectivity == 8 or d_row == 0 or d_column == 0):
                        left.remove(near)
                        edge.append(near)
        if len(group) < size:
            for cell in group:
                result[cell] = 0
    return result


sizes = st.integers(1, 6)
connectivities = st.sampled_from([4, 8])


@examples(40)
@given(seed=st.integers(0, 10_000), size=sizes, connectivity=connectivities)
def test_small_groups_are_removed_and_all_else_stays(seed, size, connectivity):
    costs = np.random.default_rng(seed).choice([0, 100, 253, 254, 255], (30, 25), p=[0.5, 0.1, 0.1, 0.2, 0.1])
    costs = costs.astype(np.uint8)
    costmap = Costmap(costs.copy(), 0.05, (0.0, 0.0))
    DenoiseLayer(DenoiseLayerParameters(size, connectivity)).update_costs(costmap, costmap.window)
    assert np.array_equal(costmap.costs, twin(costs, size, connectivity))


@examples(40)
@given(seed=st.integers(0, 10_000), size=sizes, connectivity=connectivities)
def test_updates_of_parts_give_what_an_update_of_the_whole_gives(seed, size, connectivity):
    generator = np.random.default_rng(seed)
    costs = (generator.random((30, 30)) < 0.2).astype(np.uint8) * 254
    layer = DenoiseLayer(DenoiseLayerParameters(size, connectivity))
    costmap = Costmap(costs.copy(), 0.1, (0.0, 0.0))
    layer.match_size(costmap)
    layer.update_costs(costmap, costmap.window)
    for _ in range(4):
        row, column = generator.integers(0, 30, 2)
        costs[row, column] = 254 - costs[row, column]
        x, y = costmap.map_to_world(column, row)
        window = costmap.window_of(layer.update_bounds(np.zeros(3), 0.0, Bounds(x, y, x, y)))
        costmap.costs[window.slices] = costs[window.slices]
        layer.update_costs(costmap, window)
        assert np.array_equal(costmap.costs, twin(costs, size, connectivity))


def test_other_parameters_judge_the_whole_costmap_again():
    layer = DenoiseLayer(DenoiseLayerParameters(2))
    costmap = Costmap.filled(10, 10, 0.1, (0.0, 0.0))
    layer.match_size(costmap)
    layer.reconfigure(DenoiseLayerParameters(3))
    assert costmap.window_of(layer.update_bounds(np.zeros(3), 0.0, Bounds())) == costmap.window
    assert costmap.window_of(layer.update_bounds(np.zeros(3), 0.0, Bounds())).empty


@pytest.mark.parametrize("values", [{"minimal_group_size": 0}, {"group_connectivity_type": 6}])
def test_impossible_parameters_are_refused(values):
    with pytest.raises(ParameterError):
        parameters_from(DenoiseLayerParameters, values)
