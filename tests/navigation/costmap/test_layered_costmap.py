"""Layers together: updates of parts, growing maps, rolling windows, clearing."""

import numpy as np
import pytest

from daidalos.common.parameters import ParameterError
from daidalos.mapping.grid import OccupancyGrid
from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.layers.inflation_layer import InflationLayer, InflationLayerParameters
from daidalos.navigation.costmap.layers.obstacle_layer import ObstacleLayer
from daidalos.navigation.costmap.layers.static_layer import StaticLayer
from daidalos.navigation.costmap.observation import Observation

ROBOT = Footprint.circle(0.2)
HERE = np.array([1.0, 1.0, 0.0])


def build(track_unknown=True):
    static, obstacles = StaticLayer(), ObstacleLayer(None, NavigationContext(footprint=ROBOT))
    inflation = InflationLayer(InflationLayerParameters(0.5, 3.0), NavigationContext(footprint=Footprint.circle(0.2)))
    layered = LayeredCostmap(CostmapParameters(track_unknown_space=track_unknown), [static, obstacles, inflation])
    return layered, static, obstacles


def wall_map(shape=(60, 60), origin=(0.0, 0.0), column=50):
    data = np.zeros(shape, dtype=np.int8)
    data[:, column] = 100
    return OccupancyGrid(data, 0.05, (*origin, 0.0))


def hit(x, y):
    return Observation(HERE[:2], np.array([[x, y]]), np.array([True]), 0.0)


def test_the_costmap_takes_over_the_map():
    layered, static, _ = build()
    static.set_map(wall_map())
    layered.update(HERE, 0.0)
    assert layered.costmap.costs.shape == (60, 60)
    assert layered.costmap.resolution == 0.05
    assert layered.costmap.cost_at(2.52, 0.5) == 254
    assert layered.costmap.cost_at(2.42, 0.5) == 253
    assert 0 < layered.costmap.cost_at(2.1, 0.5) < 253


def test_a_part_that_is_updated_is_what_a_whole_update_makes():
    generator = np.random.default_rng(3)
    layered, static, obstacles = build()
    data = np.zeros((80, 80), dtype=np.int8)
    for step in range(12):
        data = data.copy()
        row, column = generator.integers(5, 75, 2)
        data[row : row + 3, column] = generator.choice([0, 100, -1])
        static.set_map(OccupancyGrid(data, 0.05, (0.0, 0.0, 0.0)))
        obstacles.add_observation(hit(*generator.uniform(0.2, 3.8, 2)))
        window = layered.update(HERE, float(step))
        assert step == 0 or not window.empty
        parts = layered.costmap.costs.copy()
        layered._pending = layered._pending.including(type(layered._pending)(-9.0, -9.0, 99.0, 99.0))
        layered.update(HERE, float(step))
        assert np.array_equal(parts, layered.costmap.costs)


def test_nothing_new_is_little_work():
    layered, static, _ = build()
    static.set_map(wall_map((400, 400)))
    layered.update(HERE, 0.0)
    window = layered.update(HERE, 0.2)
    assert (window.right - window.left) * (window.top - window.bottom) < 40 * 40


def test_a_growing_map_keeps_what_sensors_saw():
    layered, static, obstacles = build()
    static.set_map(wall_map())
    obstacles.add_observation(hit(2.03, 1.03))
    layered.update(HERE, 0.0)
    assert layered.costmap.cost_at(2.03, 1.03) == 254
    static.set_map(wall_map((100, 90), (-0.5, -1.0), 60))
    layered.update(HERE, 0.2)
    assert layered.costmap.costs.shape == (100, 90)
    assert np.allclose(layered.costmap.origin, [-0.5, -1.0])
    assert layered.costmap.cost_at(2.03, 1.03) == 254
    assert layered.costmap.cost_at(2.52, -0.9) == 254


def test_a_map_of_another_resolution():
    layered, static, _ = build()
    static.set_map(wall_map())
    layered.update(HERE, 0.0)
    static.set_map(OccupancyGrid(np.zeros((10, 20), dtype=np.int8), 0.2, (0.0, 0.0, 0.0)))
    layered.update(HERE, 0.2)
    assert (layered.costmap.width, layered.costmap.height, layered.costmap.resolution) == (20, 10, 0.2)


def test_before_the_first_map_all_is_unknown_or_free():
    assert (build(True)[0].costmap.costs == 255).all()
    assert (build(False)[0].costmap.costs == 0).all()


def test_a_rolling_window_follows_the_robot_without_smearing():
    obstacles = ObstacleLayer(None, NavigationContext(footprint=ROBOT, track_unknown_space=False))
    layered = LayeredCostmap(
        CostmapParameters(3.0, 3.0, 0.05, rolling_window=True),
        [obstacles, InflationLayer(None, NavigationContext(footprint=Footprint.circle(0.2)))],
    )
    obstacles.add_observation(hit(1.53, 1.03))
    layered.update(HERE, 0.0)
    for step in range(1, 60):
        pose = HERE + np.array([0.0173 * step, -0.009 * step, 0.1])
        layered.update(pose, 0.2 * step)
        middle = layered.costmap.origin + 1.5
        assert np.abs(middle - pose[:2]).max() <= 0.05 + 1e-9
        assert np.allclose(layered.costmap.origin / 0.05, np.round(layered.costmap.origin / 0.05))
        if np.hypot(*(pose[:2] - (1.53, 1.03))) > 0.25:
            assert layered.costmap.cost_at(1.53, 1.03) == 254
            assert (layered.costmap.costs == 254).sum() == 1


def test_clearing_forgets_sensors_and_keeps_the_map():
    layered, static, obstacles = build()
    static.set_map(wall_map())
    obstacles.add_observation(hit(1.53, 1.03))
    layered.update(HERE, 0.0)
    layered.clear_around(HERE, 0.4)
    layered.update(HERE, 0.2)
    assert layered.costmap.cost_at(1.53, 1.03) == 254
    layered.clear_except(HERE, 2.0)
    layered.update(HERE, 0.4)
    assert layered.costmap.cost_at(1.53, 1.03) == 254
    layered.clear_around(HERE, 1.2)
    layered.update(HERE, 0.6)
    assert layered.costmap.cost_at(1.53, 1.03) == 0
    obstacles.add_observation(hit(1.53, 1.03))
    layered.update(HERE, 0.8)
    layered.clear_entirely()
    layered.update(HERE, 1.0)
    assert layered.costmap.cost_at(1.53, 1.03) == 0
    assert layered.costmap.cost_at(2.52, 0.5) == 254


def test_the_circumscribed_cost_comes_from_inflation():
    layered, *_ = build()
    box = Footprint.of_corners(np.array([[0.3, 0.2], [0.3, -0.2], [-0.3, -0.2], [-0.3, 0.2]]))
    cost = layered.circumscribed_cost(box)
    assert 1 < cost < 253
    assert LayeredCostmap(CostmapParameters(), []).circumscribed_cost(box) == 1


def test_the_circumscribed_cost_is_the_highest_of_any_layer():
    class Halo(StaticLayer):
        def cost_at_distance(self, distance):
            return round(100 - 10 * distance)

    box = Footprint.of_corners(np.array([[0.4, 0.3], [0.4, -0.3], [-0.4, -0.3], [-0.4, 0.3]]))
    layers = [StaticLayer(), Halo(), InflationLayer(InflationLayerParameters(0.1, 3.0))]
    assert LayeredCostmap(CostmapParameters(resolution=0.1), layers).circumscribed_cost(box) == 94


def test_sizes_must_be_positive():
    with pytest.raises(ParameterError, match="must be above 0"):
        CostmapParameters(width=0.0)
