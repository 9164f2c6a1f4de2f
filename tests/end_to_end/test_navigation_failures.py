"""Failures of inputs and servers while the robot drives, in lock-step: it stops in time, and says why."""

from __future__ import annotations

import math
import os
import threading
from typing import Any

import pytest
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import NavigateToPose

from daidalos.testing.network import Network
from daidalos.testing.programs import Nodes
from daidalos.testing.scenario import Scenario, ScenarioFailure
from daidalos.testing.worlds import Robot, World

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(600),
    pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals"),
]

BLIND_M = 0.3
"""Largest distance [m] that is driven after the last good data."""


class Drive:
    """A robot that drives to a goal.

    Parameters
    ----------
    robot : Robot
    navigate : object
        The action.
    clock : Scenario
    """

    def __init__(self, robot: Robot, navigate: Any, clock: Scenario) -> None:
        self.robot = robot
        self.failure = ""
        self._navigate = navigate
        self._clock = clock
        self._thread = threading.Thread(target=self._go)

    def start(self) -> None:
        """Send it to a goal 2 m ahead, and return when it is on its way."""
        self._thread.start()
        self.robot.speed.eventually(above=0.3, within=30.0)
        self._clock.sleep(0.5)

    def _go(self) -> None:
        pose = PoseStamped()
        pose.header.frame_id = "map"
        pose.pose.position.x, pose.pose.orientation.w = 2.0, 1.0
        try:
            self._navigate.send_goal(NavigateToPose.Goal(pose=pose), within=60.0)
        except ScenarioFailure as failure:
            self.failure = str(failure)

    def distance_in(self, seconds: float) -> float:
        """Return how far [m] it gets in some time [s]."""
        x, y = self.robot.position.x, self.robot.position.y
        self._clock.sleep(seconds)
        return math.dist((x, y), (self.robot.position.x, self.robot.position.y))

    def end(self) -> str:
        """Return how the goal failed; empty where it was reached."""
        self._thread.join()
        return self.failure


@pytest.fixture
def drive(world: World, launch: Any, action: Any, clock: Scenario, transform: Any) -> Drive:
    launch("turtlebot3_gazebo", "turtlebot3_arena.launch.py")
    launch("slam_toolbox", "online_async_launch.py", use_sim_time=True)
    launch("nav2_bringup", "navigation_launch.py", use_sim_time=True)
    robot = world.wait_for("waffle")
    robot.never_touches()
    transform("map", "base_link").wait(60.0)
    driven = Drive(robot, action("/navigate_to_pose", NavigateToPose), clock)
    driven.start()
    return driven


@pytest.mark.scenario(timeout=120, seed=1)
@pytest.mark.parametrize("topic_name", ["/scan", "/tf"])
def test_data_that_stop(drive: Drive, network: Network, topic_name: str) -> None:
    network.drop_out(topic_name, 20.0)
    assert drive.distance_in(4.0) < BLIND_M
    assert "was aborted" in drive.end()
    assert "s old, longer" in drive.failure


@pytest.mark.scenario(timeout=120, seed=1)
def test_scans_that_come_late(drive: Drive, network: Network) -> None:
    network.disturb("/scan", latency=1.0)
    assert drive.distance_in(4.0) < BLIND_M
    assert "'/scan' is" in drive.end()


@pytest.mark.scenario(timeout=120, seed=1)
def test_localization_that_is_killed(drive: Drive, nodes: Nodes) -> None:
    nodes["slam_toolbox"].kill()
    assert drive.distance_in(4.0) < BLIND_M
    assert "the transform from map to odom" in drive.end()


@pytest.mark.scenario(timeout=120, seed=1)
@pytest.mark.parametrize("name", ["controller_server", "collision_monitor"])
def test_a_server_that_is_killed_comes_back(drive: Drive, nodes: Nodes, service: Any, name: str) -> None:
    from std_srvs.srv import Trigger

    nodes[name].kill()
    assert drive.distance_in(2.0) < BLIND_M
    assert "was deactivated" in drive.end()
    is_active = service("/lifecycle_manager_navigation/is_active", Trigger)
    for _ in range(20):
        if is_active.call().success:
            break
        drive.distance_in(0.5)
    again = Drive(drive.robot, drive._navigate, drive._clock)
    again.start()
    assert again.end() == ""
    assert math.dist((again.robot.position.x, again.robot.position.y), (2.0, 0.0)) < 0.3


@pytest.mark.scenario(timeout=120, seed=1)
def test_a_navigator_that_is_killed_stops_the_robot(drive: Drive, nodes: Nodes) -> None:
    nodes["bt_navigator"].kill()
    assert drive.distance_in(4.0) < BLIND_M


@pytest.mark.scenario(timeout=120, seed=1)
@pytest.mark.parametrize("speed", [0.6, 1.2])
def test_somebody_who_crosses_the_way_is_not_touched(drive: Drive, world: World, speed: float) -> None:
    world.walk("visitor", [(1.4, -1.5), (1.4, 1.5)], speed=speed, loop=False)
    assert drive.end() == ""


@pytest.mark.scenario(timeout=120, seed=1)
@pytest.mark.parametrize("pose", [(-1.5, -1.5, 2.0), (-2.0, 0.0, 3.1)])
def test_a_robot_that_is_carried_away_does_not_report_success(drive: Drive, pose: tuple[float, float, float]) -> None:
    drive.robot.move(pose[0], pose[1], yaw=pose[2])
    assert "was aborted" in drive.end()
    assert math.dist((drive.robot.position.x, drive.robot.position.y), pose[:2]) < 2.0
