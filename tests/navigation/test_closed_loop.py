"""The whole library in a loop with a robot: it arrives, and touches nothing."""

import math

import numpy as np
import pytest

from .closed_loop import free_pose, jackal, turtlebot
from .flat_world import FlatWorld, arena, barn_world

WORLD = arena()
WALLS = FlatWorld(WORLD.segments[:32], WORLD.circles[:0])
"""The arena's walls; what stands between them is not on the map."""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "seed"), [("mppi", 1), ("mppi", 2), ("rpp", 1), ("rpp", 2), ("shim", 3), ("teb", 1), ("teb", 2)]
)
def test_random_goals_among_obstacles_that_the_map_does_not_know(kind, seed):
    generator = np.random.default_rng(seed)
    stack = turtlebot(WORLD, free_pose(WORLD, generator), WALLS, seed, kind)
    for _ in range(8):
        arrival = stack.drive_to(free_pose(WORLD, generator))
        assert not arrival.contact
        assert arrival.reached, arrival.error
        assert arrival.position_error < 0.15
        assert arrival.yaw_error < 0.15
        turning = np.abs(np.diff(arrival.commands[:, 2])).sum() / arrival.time
        assert turning < 3.0, "the robot wobbles"


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["mppi", "graceful", "teb"])
def test_one_goal_through_a_door(kind):
    stack = turtlebot(WORLD, [1.5, 1.5, 0.0], WALLS, kind=kind)
    arrival = stack.drive_to(np.array([4.5, 0.8, -1.0]))
    assert arrival.reached
    assert arrival.min_clearance > 0.05
    assert arrival.length < 5.0
    assert set(stack.started) == {"ComputePathToPose", "FollowPath"}


@pytest.mark.parametrize(
    ("goal", "words"),
    [((3.0, 0.5, 0.0), "is in an obstacle"), ((20.0, 1.0, 0.0), "is outside of the map")],
)
def test_a_goal_that_can_not_be_is_refused_and_the_robot_stays(goal, words):
    stack = turtlebot(WORLD, [1.5, 1.5, 0.0], WALLS)
    arrival = stack.drive_to(np.array(goal))
    assert not arrival.reached
    assert words in arrival.error
    assert arrival.length == 0.0


@pytest.mark.slow
def test_a_goal_behind_walls_is_given_up_with_the_reason():
    closed = np.concatenate([WALLS.segments, [(2.95, 1.1, 2.95, 2.1)], [(0.9, 2.6, 1.9, 2.6)]])
    walls = FlatWorld(closed, WALLS.circles)
    stack = turtlebot(walls, [1.5, 1.5, 0.0], walls)
    arrival = stack.drive_to(np.array([6.0, 4.0, 0.0]))
    assert not arrival.reached
    assert not arrival.contact
    assert "obstacles cut it off" in arrival.error


def test_a_robot_that_stands_in_a_wall_of_the_map_drives_away():
    thick = FlatWorld(np.concatenate([WALLS.segments, [(0.06, 0.5, 0.06, 2.4)]]), WALLS.circles)
    stack = turtlebot(WORLD, [0.26, 1.5, math.pi / 2], thick)
    arrival = stack.drive_to(np.array([1.5, 2.0, 0.0]))
    assert arrival.reached, arrival


@pytest.mark.slow
def test_a_door_that_is_shut_on_the_way_is_driven_around():
    stack = turtlebot(WORLD, [1.5, 1.6, 0.0], WALLS)
    shut = np.concatenate([WORLD.segments, [(2.95, 1.1, 2.95, 2.1)]])
    stack.robot.world = FlatWorld(shut, WORLD.circles)
    arrival = stack.drive_to(np.array([4.0, 1.2, 0.0]))
    assert arrival.reached
    assert arrival.length > 5.0


@pytest.mark.slow
def test_worlds_of_the_barn_benchmark(shared_data):
    data = np.load(shared_data / "barn" / "barn_000_099.npz")
    for index in (0, 14, 37, 50, 81, 99):
        stack = jackal(barn_world(data, index), [-2.0, 3.0, math.pi / 2], seed=index)
        arrival = stack.drive_to(np.array([-2.0, 13.0, math.pi / 2]), limit=100.0, stop_within=1.0)
        assert arrival.reached, f"world {index}: {arrival.error}"
        assert arrival.time < 20.0
