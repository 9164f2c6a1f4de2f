"""Fixtures of runs with navigation."""

from __future__ import annotations

from typing import Any

import pytest
from nav2_msgs.action import NavigateToPose

from daidalos.testing.scenario import Scenario
from daidalos.testing.worlds import World
from end_to_end.driving import Drive


@pytest.fixture
def waiting(world: World, launch: Any, action: Any, clock: Scenario, transform: Any) -> Drive:
    """Return a robot in the arena, with SLAM and navigation, that may not touch anything."""
    launch("turtlebot3_gazebo", "turtlebot3_arena.launch.py")
    launch("slam_toolbox", "online_async_launch.py", use_sim_time=True)
    launch("nav2_bringup", "navigation_launch.py", use_sim_time=True)
    robot = world.wait_for("waffle")
    robot.never_touches()
    transform("map", "base_link").wait(60.0)
    return Drive(robot, action("/navigate_to_pose", NavigateToPose), clock)


@pytest.fixture
def drive(waiting: Drive) -> Drive:
    """Return a robot that is on its way to a goal 2 m ahead."""
    waiting.start()
    return waiting
