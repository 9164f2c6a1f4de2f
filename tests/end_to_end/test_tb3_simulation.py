"""The launch files that Nav2's tutorials begin with, in lock-step."""

from __future__ import annotations

import math
import os
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped
from nav2_msgs.action import NavigateToPose

from daidalos.testing.scenario import Scenario
from daidalos.testing.worlds import World

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(600),
    pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals"),
]


def set_initial_pose(clock: Scenario, x: float, y: float) -> None:
    pose = PoseWithCovarianceStamped()
    pose.header.frame_id = "map"
    pose.pose.pose.position.x, pose.pose.pose.position.y, pose.pose.pose.orientation.w = x, y, 1.0
    publisher = clock.node.create_publisher(PoseWithCovarianceStamped, "/initialpose", 10)
    assert clock.wait(lambda: publisher.get_subscription_count() > 0, 30.0)
    publisher.publish(pose)


def goal_at(x: float, y: float) -> NavigateToPose.Goal:
    pose = PoseStamped()
    pose.header.frame_id = "map"
    pose.pose.position.x, pose.pose.position.y, pose.pose.orientation.w = x, y, 1.0
    return NavigateToPose.Goal(pose=pose)


@pytest.mark.scenario(timeout=120, seed=1)
@pytest.mark.parametrize(("slam", "goal"), [(False, (-0.5, -0.5)), (True, (1.5, 0.0))])
def test_a_goal_is_reached(
    world: World, launch: Any, action: Any, clock: Scenario, transform: Any, slam: bool, goal: tuple[float, float]
) -> None:
    launch("nav2_bringup", "tb3_simulation_launch.py", use_rviz=False, slam=slam)
    robot = world.wait_for("waffle")
    robot.never_touches()
    if not slam:  # with SLAM, the map begins where the robot does
        set_initial_pose(clock, -2.0, -0.5)
    transform("map", "base_link").wait(60.0)
    action("/navigate_to_pose", NavigateToPose).send_goal(goal_at(*goal), within=60.0)
    assert math.dist((robot.position.x, robot.position.y), (-0.5, -0.5)) < 0.4


@pytest.mark.scenario(timeout=120, seed=1)
def test_a_turtlebot_4_reaches_a_goal_in_the_depot(
    world: World, launch: Any, action: Any, clock: Scenario, transform: Any
) -> None:
    launch("nav2_bringup", "tb4_simulation_launch.py", use_rviz=False)
    robot = world.wait_for("turtlebot4")
    robot.never_touches()
    set_initial_pose(clock, -8.0, 0.0)
    transform("map", "base_link").wait(60.0)
    action("/navigate_to_pose", NavigateToPose).send_goal(goal_at(-6.5, 0.5), within=60.0)
    assert math.dist((robot.position.x, robot.position.y), (-6.5, 0.5)) < 0.4
