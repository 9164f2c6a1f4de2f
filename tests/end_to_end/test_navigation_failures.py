"""Failures of inputs and servers while the robot drives, in lock-step: it stops in time, and says why."""

from __future__ import annotations

import math
import os
from typing import Any

import pytest
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import PoseStamped
from nav2_msgs.action import FollowWaypoints, Spin
from std_srvs.srv import Trigger

from daidalos.testing.network import Network
from daidalos.testing.programs import Nodes
from daidalos.testing.scenario import Scenario
from daidalos.testing.worlds import World
from end_to_end.driving import BLIND_M, Drive

pytestmark = [
    pytest.mark.slow,
    pytest.mark.timeout(600),
    pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals"),
]


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
def test_scans_that_are_frozen(drive: Drive, network: Network) -> None:
    first: list[Any] = []

    def freeze(scan: Any) -> None:
        first.append(scan.ranges)
        scan.ranges = first[0]

    network.alter("/scan", freeze)
    assert drive.distance_in(4.0) < BLIND_M
    assert "'/scan' is" in drive.end()


@pytest.mark.scenario(timeout=120, seed=1)
@pytest.mark.parametrize("frame", ["elsewhere", "odom"])
def test_scans_in_a_wrong_frame(drive: Drive, network: Network, frame: str) -> None:
    network.alter("/scan", lambda scan: setattr(scan.header, "frame_id", frame))
    assert drive.distance_in(4.0) < BLIND_M
    assert "'/scan' is" in drive.end()


@pytest.mark.scenario(timeout=120, seed=1)
def test_localization_that_is_killed(drive: Drive, nodes: Nodes) -> None:
    nodes["slam_toolbox"].kill()
    assert drive.distance_in(4.0) < BLIND_M
    assert "the transform from map to odom" in drive.end()


@pytest.mark.scenario(timeout=120, seed=1)
@pytest.mark.parametrize("name", ["controller_server", "collision_monitor", "planner_server", "velocity_smoother"])
def test_a_server_that_is_killed_comes_back(
    drive: Drive, nodes: Nodes, service: Any, clock: Scenario, name: str
) -> None:
    nodes[name].kill()
    assert drive.distance_in(2.0) < BLIND_M
    assert "was deactivated" in drive.end()
    is_active = service("/lifecycle_manager_navigation/is_active", Trigger)
    wait_until_active(is_active, clock)
    drive.start()
    assert drive.end() == ""
    assert math.dist((drive.robot.position.x, drive.robot.position.y), (2.0, 0.0)) < 0.3


@pytest.mark.scenario(timeout=120, seed=1)
def test_a_navigator_that_is_killed_stops_the_robot(drive: Drive, nodes: Nodes) -> None:
    nodes["bt_navigator"].kill()
    assert drive.distance_in(4.0) < BLIND_M


@pytest.mark.scenario(timeout=120, seed=1)
def test_a_lifecycle_manager_that_is_killed_comes_back(drive: Drive, nodes: Nodes) -> None:
    nodes["lifecycle_manager_navigation"].kill()
    assert drive.end() == ""


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


@pytest.mark.scenario(timeout=300, seed=1)
def test_servers_of_waypoints_behaviors_and_smoothing_that_are_killed_come_back(
    waiting: Drive, nodes: Nodes, service: Any, action: Any, clock: Scenario
) -> None:
    """Kill the waypoint follower on its way, the behaviours in a turn, and the smoother while nothing moves."""
    is_active = service("/lifecycle_manager_navigation/is_active", Trigger)
    pose = PoseStamped()
    pose.header.frame_id = "map"
    pose.pose.position.x, pose.pose.orientation.w = 2.0, 1.0
    waypoints = action("/follow_waypoints", FollowWaypoints)
    waypoints.start_goal(FollowWaypoints.Goal(poses=[pose]), within=60.0)
    waiting.robot.speed.eventually(above=0.3, within=30.0)
    nodes["waypoint_follower"].kill()
    assert waiting.distance_in(2.0) < BLIND_M
    wait_until_active(is_active, clock)
    turn = Spin.Goal(target_yaw=6.0, time_allowance=Duration(sec=20))
    action("/spin", Spin).start_goal(turn, within=10.0)
    waiting.robot.pose.field("yaw").eventually(above=0.5, within=5.0)
    nodes["behavior_server"].kill()
    clock.sleep(0.5)
    yaw = waiting.robot.position.yaw
    clock.sleep(1.0)
    assert abs(waiting.robot.position.yaw - yaw) < 0.02
    wait_until_active(is_active, clock)
    nodes["smoother_server"].kill()
    clock.sleep(1.0)
    wait_until_active(is_active, clock)
    waiting.start()
    assert waiting.end() == ""


def wait_until_active(is_active: Any, clock: Scenario) -> None:
    """Wait until the lifecycle manager says that all servers are active."""
    for _ in range(20):
        if is_active.call().success:
            return
        clock.sleep(0.5)
    raise AssertionError("the servers are not active again within 10 s")
