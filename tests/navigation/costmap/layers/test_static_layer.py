"""Maps as a layer: what changed, and where it lies."""

import math

import numpy as np
import pytest

from daidalos.common.pose2 import transform_points
from daidalos.mapping.grid import OccupancyGrid
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.costmap import Bounds, Costmap, CostmapError
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.layers.static_layer import StaticLayer, StaticLayerParameters


def grid(data, origin=(0.0, 0.0, 0.0), resolution=1.0):
    return OccupancyGrid(np.array(data, dtype=np.int8), resolution, origin)


def test_only_what_differs_is_asked_for():
    layer = StaticLayer()
    data = np.zeros((10, 10), dtype=np.int8)
    layer.set_map(grid(data))
    assert layer.update_bounds(np.zeros(3), 0.0, Bounds()).min_x == -np.inf
    layer.set_map(grid(data))
    assert layer.update_bounds(np.zeros(3), 0.0, Bounds()).empty
    data[3, 4] = data[6, 5] = 100
    layer.set_map(grid(data))
    assert layer.update_bounds(np.zeros(3), 0.0, Bounds()) == Bounds(4.5, 3.5, 5.5, 6.5)


def test_changes_of_several_maps_add_up():
    layer = StaticLayer()
    data = np.zeros((10, 10), dtype=np.int8)
    layer.set_map(grid(data))
    layer.update_bounds(np.zeros(3), 0.0, Bounds())
    for cell in ((1, 1), (8, 8)):
        data = data.copy()
        data[cell] = 100
        layer.set_map(grid(data))
    assert layer.update_bounds(np.zeros(3), 0.0, Bounds()) == Bounds(1.5, 1.5, 8.5, 8.5)


def test_a_map_that_covers_another_place_is_cut_to_the_costmap():
    layer = StaticLayer()
    layer.set_map(grid([[100, 0], [0, 100]], origin=(1.0, 2.0, 0.0)))
    costmap = Costmap.filled(4, 4, 1.0, (0.0, 1.0), 77)
    layer.update_costs(costmap, costmap.window)
    assert costmap.costs.tolist() == [[77] * 4, [77, 254, 0, 77], [77, 0, 254, 77], [77] * 4]


def test_without_a_map_nothing_happens():
    costmap = Costmap.filled(4, 4, 1.0, (0.0, 0.0), 77)
    StaticLayer().update_costs(costmap, costmap.window)
    assert (costmap.costs == 77).all()


def test_thresholds_are_used():
    layer = StaticLayer(StaticLayerParameters(lethal_cost_threshold=65))
    layer.set_map(grid([[64, 65]]))
    costmap = Costmap.filled(2, 1, 1.0, (0.0, 0.0))
    layer.update_costs(costmap, costmap.window)
    assert costmap.costs.tolist() == [[0, 254]]


def test_an_empty_or_turned_map_is_refused():
    with pytest.raises(CostmapError, match="no cells"):
        StaticLayer().set_map(grid(np.zeros((0, 0))))
    with pytest.raises(CostmapError, match="turned"):
        StaticLayer().set_map(grid([[0]], origin=(0.0, 0.0, 0.3)))


def in_odometry(place: tuple[np.ndarray, float] | None) -> tuple[LayeredCostmap, StaticLayer]:
    """Return a costmap in the frame odom, and its layer of a map of an obstacle at (2, 1) to (2.1, 1.1) in map."""
    layer = StaticLayer(None, NavigationContext(global_frame="odom", locate=lambda frame: place))
    data = np.zeros((40, 60), dtype=np.int8)
    data[20:22, 40:42] = 100
    layer.set_map(OccupancyGrid(data, 0.05, (0.0, 0.0, 0.0), "map"))
    return LayeredCostmap(CostmapParameters(6.0, 6.0, 0.05, rolling_window=True), [layer]), layer


def test_a_map_in_another_frame_is_placed_by_the_transform() -> None:
    place = np.array([0.5, -0.3, math.pi / 2])
    layered, layer = in_odometry((place, 0.1))
    layered.update(np.zeros(3), 0.0)
    x, y = transform_points(place, np.array([[2.05, 1.05]]))[0]
    assert layered.costmap.cost_at(float(x), float(y)) == 254
    assert (layered.costmap.costs == 254).sum() == 4
    assert layer.missing_input(0.0) == ""
    assert layer.age_of_input(0.0) == pytest.approx(0.1 / 0.3)


@pytest.mark.parametrize(("place", "problem"), [(None, "there is no transform"), ((np.zeros(3), 0.5), "is 0.5 s old")])
def test_a_map_whose_place_is_not_known_makes_the_costmap_out_of_date(
    place: tuple[np.ndarray, float] | None, problem: str
) -> None:
    _, layer = in_odometry(place)
    assert problem in layer.missing_input(0.0)
