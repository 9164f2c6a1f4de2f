"""The layer of layers: its own costmap, combined with what is below."""

from __future__ import annotations

import numpy as np
import pytest

from daidalos.navigation.contracts import Layer, NavigationContext
from daidalos.navigation.costmap.costmap import Bounds, Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.layers.inflation_layer import InflationLayer
from daidalos.navigation.costmap.layers.obstacle_layer import ObstacleLayer
from daidalos.navigation.costmap.layers.plugin_container_layer import (
    ContainedLayerParameters,
    PluginContainerLayer,
    PluginContainerLayerParameters,
)
from daidalos.navigation.costmap.observation import Observation

CONTEXT = NavigationContext(footprint=Footprint.circle(0.2), track_unknown_space=True)
ROBOT = np.zeros(3)


def container(*kinds: str, method: int = 1) -> PluginContainerLayer:
    names = tuple(f"layer_{number}" for number in range(len(kinds)))
    chosen = {name: ContainedLayerParameters(kind) for name, kind in zip(names, kinds, strict=True)}
    return PluginContainerLayer(PluginContainerLayerParameters(True, names, chosen, method), CONTEXT)


def after_a_ray(*layers: Layer) -> LayeredCostmap:
    """Return a costmap after a ray that met something 1 m ahead, seen by the first obstacle layer."""
    layered = LayeredCostmap(
        CostmapParameters(rolling_window=True, width=4.0, height=4.0, track_unknown_space=True), list(layers)
    )
    everything = [one for layer in layers for one in (layer, *layer.contained)]
    seeing = next(one for one in everything if isinstance(one, ObstacleLayer))
    seeing.add_observation(Observation(ROBOT[:2], np.array([[1.0, 0.0]]), np.array([True]), 0.0))
    layered.update(ROBOT, 0.0)
    return layered


def test_layers_in_a_container_are_as_they_are_outside() -> None:
    inside = after_a_ray(container("nav2_costmap_2d::ObstacleLayer", "nav2_costmap_2d::InflationLayer"))
    outside = after_a_ray(ObstacleLayer(None, CONTEXT), InflationLayer(None, CONTEXT))
    assert (outside.costmap.costs == 254).any()
    np.testing.assert_array_equal(inside.costmap.costs, outside.costmap.costs)
    assert inside.circumscribed_cost(CONTEXT.footprint) == outside.circumscribed_cost(CONTEXT.footprint)


def test_an_inflation_inside_leaves_obstacles_outside_alone() -> None:
    below = ObstacleLayer(None, CONTEXT)
    inflating = container("nav2_costmap_2d::ObstacleLayer", "nav2_costmap_2d::InflationLayer")
    costs = after_a_ray(below, inflating).costmap
    assert costs.cost_at(1.0, 0.0) == 254
    assert costs.cost_at(1.1, 0.0) == 255


@pytest.mark.parametrize(("method", "expected"), [(0, [30, 0, 0]), (1, [30, 40, 0]), (2, [30, 40, 255])])
def test_costs_are_combined_as_the_method_says(method: int, expected: list[int]) -> None:
    layer = container("nav2_costmap_2d::ObstacleLayer", method=method)
    layer._layers = (_Fixed(30, 0, 0),)
    ground = Costmap(np.array([[20, 40, 255]], np.uint8), 1.0, (0.0, 0.0))
    layer.match_size(ground)
    layer.update_costs(ground, ground.window)
    assert ground.costs.tolist() == [expected]


class _Fixed(Layer):
    """A layer whose costs never change."""

    def __init__(self, *costs: int) -> None:
        super().__init__()
        self._costs = np.array([costs], np.uint8)

    def update_bounds(self, robot_pose: np.ndarray, now: float, bounds: Bounds) -> Bounds:
        return bounds

    def update_costs(self, costmap: Costmap, window: object) -> None:
        costmap.costs[:] = self._costs


def test_what_a_contained_layer_lacks_is_what_the_container_lacks() -> None:
    layer = container("nav2_costmap_2d::StaticLayer")
    assert layer.missing_input(0.0) == "there is no map"
    assert [one.type.__name__ for one in layer.inputs] == ["OccupancyGrid"]


def test_contained_obstacles_are_cleared() -> None:
    layered = after_a_ray(container("nav2_costmap_2d::ObstacleLayer"))
    assert (layered.costmap.costs == 254).any()
    layered.clear_entirely()
    layered.update(ROBOT, 0.1)
    assert not (layered.costmap.costs == 254).any()
