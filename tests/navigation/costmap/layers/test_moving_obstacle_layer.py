"""The layer of moving obstacles: lethal where they will be, and nowhere else."""

import numpy as np

from daidalos.navigation.contracts import NavigationContext
from daidalos.navigation.costmap.footprint import Footprint, FootprintCollisionChecker
from daidalos.navigation.costmap.layered_costmap import CostmapParameters, LayeredCostmap
from daidalos.navigation.costmap.layers.moving_obstacle_layer import (
    MovingObstacleLayer,
    MovingObstacleLayerParameters,
)
from navigation.test_tracking import scan

ROBOT = np.zeros(3)


def walked(velocity, seconds=1.0, **parameters):
    """Return a costmap after somebody came from the right before the robot, and its layer."""
    layer = MovingObstacleLayer(
        MovingObstacleLayerParameters(**parameters), NavigationContext(footprint=Footprint.circle(0.2))
    )
    layered = LayeredCostmap(CostmapParameters(rolling_window=True, width=6.0, height=6.0), [layer])
    for k in range(round(10 * seconds) + 1):
        layer.add_scan("scan", scan(ROBOT, [(1.5, -1.5 + velocity * k / 10, 0.2)]), ROBOT, k / 10)
        layered.update(ROBOT, k / 10)
    return layered, layer


def test_the_way_ahead_of_a_walker_is_lethal():
    layered, _ = walked(1.0, prediction_time=1.5)
    costs = layered.costmap
    for y in (-0.4, 0.0, 0.5, 0.8):
        assert costs.cost_at(1.4, y) == 254
    assert costs.cost_at(1.4, -1.2) != 254
    assert costs.cost_at(0.5, 0.0) != 254
    assert costs.cost_at(1.4, 1.8) != 254


def test_who_stands_leaves_no_way():
    layered, layer = walked(0.0)
    assert not (layered.costmap.costs == 254).any()
    assert layer.moving(1.0) == []


def test_a_way_is_forgotten_when_the_walker_is_gone():
    layered, layer = walked(1.0)
    assert (layered.costmap.costs == 254).any()
    layered.update(ROBOT, 2.5)
    assert not (layered.costmap.costs == 254).any()
    layered, layer = walked(1.0)
    layer.clear(layered.costmap.window, inside=True)
    layered.update(ROBOT, 1.1)
    assert not (layered.costmap.costs == 254).any()


def test_prediction_time_is_how_far_the_way_goes():
    short, long = (walked(1.0, prediction_time=time)[0].costmap.costs for time in (0.3, 1.5))
    assert (short == 254).sum() < 0.5 * (long == 254).sum()


def test_a_way_over_the_robot_can_be_left():
    """Somebody walks towards the robot and would pass through it: the way costs, but is not lethal."""
    layer = MovingObstacleLayer(
        MovingObstacleLayerParameters(prediction_time=3.0), NavigationContext(footprint=Footprint.circle(0.2))
    )
    layered = LayeredCostmap(CostmapParameters(rolling_window=True, width=6.0, height=6.0), [layer])
    for k in range(11):
        layer.add_scan("scan", scan(ROBOT, [(2.2 - k / 10, 0.0, 0.2)]), ROBOT, k / 10)
        layered.update(ROBOT, k / 10)
    costs = layered.costmap
    assert 200 <= costs.cost_at(0.6, 0.0) == costs.cost_at(-0.6, 0.0) < 253
    assert costs.cost_at(0.0, 0.0) == 0
    assert not FootprintCollisionChecker(costs, Footprint.circle(0.2)).in_collision(ROBOT)


def test_a_way_that_a_part_of_the_robot_reaches_into_is_lethal_but_not_below_it():
    layer = MovingObstacleLayer(None, NavigationContext(footprint=Footprint.circle(0.4)))
    layered = LayeredCostmap(CostmapParameters(rolling_window=True, width=6.0, height=6.0), [layer])
    for k in range(11):
        layer.add_scan("scan", scan(ROBOT, [(0.6, -1.6 + k / 10, 0.1)]), ROBOT, k / 10)
        layered.update(ROBOT, k / 10)
    costs = layered.costmap
    assert costs.cost_at(0.65, 0.0) == 254
    assert not FootprintCollisionChecker(costs, Footprint.circle(0.4)).in_collision(ROBOT)
