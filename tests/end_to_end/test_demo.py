"""`daidalos demo` as users run it: on trial, with other commands beside it, and ended at any moment."""

import json
import os
import re
import socket
from typing import Any

import pytest
from geometry_msgs.msg import Point, Pose, PoseStamped
from nav2_msgs.action import NavigateToPose
from std_msgs.msg import Header

from daidalos.testing.programs import Nodes, RunningNode
from daidalos.testing.scenario import ScenarioFailure
from end_to_end.processes import DAIDALOS, ROS2, Command, finished
from places import REPOSITORY

DEMO = [*DAIDALOS, "demo"]
EXAMPLES = REPOSITORY / "examples"
UP = "Managed nodes are active"


@pytest.mark.slow
@pytest.mark.timeout(480)
def test_headless_reaches_three_goals_and_touches_nothing(domain: int) -> None:
    done = finished(*DEMO, "--headless", "--seed", "1", "--json", domain=domain)
    assert done.returncode == 0, done.stderr
    report = json.loads(done.stdout)
    assert len(report["goals"]) == 3
    for goal in report["goals"]:
        assert goal["reached"]
        assert goal["position_error_m"] < 0.15
        assert goal["yaw_error_rad"] < 0.25
        assert goal["path_length_m"] > 1.0
        assert goal["time_s"] > 2.0
    assert report["contacts"] == 0
    assert report["localization_rmse_m"] < 0.05
    assert report["map"]["resolution_m"] == pytest.approx(0.05)
    assert report["map"]["walls_found"] > 0.8
    assert report["map"]["walls_true"] > 0.98
    assert report["real_time_factor"] > 0.9
    assert report["processes"] <= 5, "the launch, one container, and what spawns the robot and turns it at the start"
    assert 0 < report["cpu_percent"] < 200
    assert 100 < report["peak_rss_mb"] < 600


@pytest.mark.slow
@pytest.mark.parametrize(
    "moment",
    ["process started", "Loaded slam_toolbox", "spawned 'waffle'", UP, "ready for scans", "process has finished"],
)
def test_ctrl_c_ends_everything_at_any_moment(domain: int, moment: str) -> None:
    with Command(*DEMO, "--no-browser", domain=domain) as demo:
        demo.wait_for_line(re.escape(moment))
        demo.interrupt()
        demo.assert_no_traceback()


@pytest.mark.slow
def test_a_used_port_gives_the_next_one(domain: int) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with Command(*DEMO, "--no-browser", "--port", str(port), domain=domain) as demo:
            line = demo.wait_for_line("studio: http://")
            chosen = int(line.rsplit(":", 1)[1].strip("/"))
            assert chosen != port
            demo.interrupt()


@pytest.mark.slow
@pytest.mark.timeout(480)
def test_other_commands_see_the_running_demonstration(domain: int) -> None:
    with Command(*DEMO, "--no-browser", domain=domain) as demo:
        demo.wait_for_line(UP)
        topics = finished(*ROS2, "topic", "list", domain=domain).stdout.split()
        assert {"/clock", "/scan", "/odom", "/tf", "/tf_static", "/map", "/cmd_vel", "/plan"} <= set(topics)
        assert "/global_costmap/costmap" in topics
        nodes = finished(*ROS2, "node", "list", domain=domain).stdout.split()
        assert {"/gazebo", "/robot_state_publisher", "/slam_toolbox", "/planner_server", "/bt_navigator"} <= set(nodes)
        actions = finished(*ROS2, "action", "list", domain=domain).stdout.split()
        assert "/navigate_to_pose" in actions
        scan = finished(*ROS2, "topic", "echo", "--once", "/scan", "--field", "header.frame_id", domain=domain)
        assert scan.stdout.startswith("base_scan")
        info = finished(*ROS2, "topic", "info", "/map", domain=domain).stdout
        assert "nav_msgs/msg/OccupancyGrid" in info
        info = finished(*ROS2, "node", "info", "/bt_navigator", domain=domain).stdout
        assert "/navigate_to_pose: nav2_msgs/action/NavigateToPose" in info
        pub = ["topic", "pub", "--times", "2", "/cmd_vel", "geometry_msgs/msg/Twist", "{angular: {z: 0.1}}"]
        assert "publishing #2" in finished(*ROS2, *pub, domain=domain).stdout
        with Command(*ROS2, "topic", "hz", "/odom", domain=domain) as rate:
            line = rate.wait_for_line("average rate")
            assert 80.0 < float(line.split(":")[1]) < 120.0
            rate.interrupt()
        assert demo.interrupt() == 130


@pytest.mark.slow
@pytest.mark.timeout(480)
@pytest.mark.scenario(timeout=480, seed=1)
@pytest.mark.skipif(os.name == "nt", reason="the scenarios end programs by signals")
def test_goals_that_cannot_be_are_refused_and_the_examples_work(
    launch: Any, nodes: Nodes, topic: Any, action: Any
) -> None:
    demo = launch("daidalos_demo", "demo.launch.py", studio=False, seed=1)
    demo.prints("look_around.*finished", within=120.0)
    odometry = topic("/odom")
    navigate = action("/navigate_to_pose", NavigateToPose)
    wall = (-1.54, 2.2, "is in an obstacle")  # the face that the robot has seen
    for x, y, why in ((50.0, 0.0, "outside of the map"), wall):
        goal = PoseStamped(header=Header(frame_id="map"), pose=Pose(position=Point(x=x, y=y)))
        with pytest.raises(ScenarioFailure, match=f"was aborted: .*({why})"):
            navigate.send(pose=goal, within=120.0)
        travelled = odometry.wait(10.0).pose.pose.position.x
        assert abs(travelled) < 0.1, "the robot has to stay where it was"

    example = nodes.script(EXAMPLES / "nearest_wall.py")
    example.prints(r"\d\.\d\d m at [+-]\d+ deg", within=60.0)
    _end(example)
    example = nodes.script(EXAMPLES / "keep_distance.py")
    odometry.field("twist.twist.linear.x").eventually(between=(0.18, 0.3), within=60.0)
    _end(example)
    example = nodes.script(EXAMPLES / "patrol.py")
    example.prints(r"\(1.2, -1.6\): reached", within=240.0)
    _end(example)


def _end(example: RunningNode) -> None:
    """End an example as Ctrl-C does, and require that it prints no traceback."""
    example.interrupt()
    example.exits(within=30.0)
    assert not [line for line in example.lines if "Traceback" in line or "KeyboardInterrupt" in line]
