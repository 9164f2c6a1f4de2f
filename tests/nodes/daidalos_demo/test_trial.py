"""The goals of a trial."""

import numpy as np
import pytest
import rclpy
from builtin_interfaces.msg import Time
from nav_msgs.msg import OccupancyGrid
from rclpy.executors import SingleThreadedExecutor
from scipy import ndimage

from daidalos.description.footprint import Footprint
from daidalos.nodes.conversions import grid_message
from daidalos.nodes.daidalos_demo._robot import Robot
from daidalos.nodes.daidalos_demo.trial import _CLEARANCE_M, choose_goals


@pytest.fixture
def plan() -> Footprint:
    """A room of 8 m by 6 m with a pillar, and a closed chamber."""
    occupied = np.zeros((120, 160), bool)
    occupied[[0, -1]] = occupied[:, [0, -1]] = True
    occupied[70:80, 100:110] = True
    occupied[90:, 130] = occupied[90, 130:] = True
    return Footprint(occupied, 0.05, np.array([-4.0, -3.0]))


@pytest.mark.parametrize("seed", range(5))
def test_goals_are_reachable_clear_and_spread(plan: Footprint, seed: int) -> None:
    goals = choose_goals(plan, 3, seed)
    clearance = ndimage.distance_transform_edt(~plan.occupied) * plan.resolution
    places = np.array([goal[:2] for goal in goals])
    for x, y in places:
        column, row = ((np.array([x, y]) - plan.origin) / plan.resolution).astype(int)
        assert clearance[row, column] >= _CLEARANCE_M
        assert not (x > 2.5 and y > 1.5), "the closed chamber cannot be reached"
    everywhere = np.vstack([np.zeros(2), places])
    distances = np.linalg.norm(everywhere[:, None] - everywhere[None], axis=-1)
    assert distances[np.triu_indices(4, 1)].min() > 1.5


def test_the_seed_decides(plan: Footprint) -> None:
    np.testing.assert_array_equal(choose_goals(plan, 3, 1), choose_goals(plan, 3, 1))
    assert not np.array_equal(choose_goals(plan, 3, 1), choose_goals(plan, 3, 2))


def test_a_goal_waits_until_the_map_reaches_as_far() -> None:
    rclpy.init(args=[])
    node = rclpy.create_node("trial")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    robot = Robot(node)
    reached = executor.create_task(robot.until_mapped(2.0, 0.5, 60.0))
    try:
        robot.map = _map_as_far_as(1.9)
        executor.spin_until_future_complete(reached, timeout_sec=1.0)
        assert not reached.done()
        robot.map = _map_as_far_as(2.1)
        executor.spin_until_future_complete(reached, timeout_sec=20.0)
        assert reached.done()
    finally:
        executor.shutdown()
        node.destroy_node()
        rclpy.shutdown()


def _map_as_far_as(x: float) -> OccupancyGrid:
    width = round((x + 1.0) / 0.1)
    return grid_message(np.zeros((20, width), np.int8), 0.1, np.array([-1.0, -1.0]), "map", Time())
