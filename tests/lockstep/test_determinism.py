"""Equal bags of equal runs in two processes, whose hashes of strings differ: an arm under control, and navigation."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from daidalos.lockstep.options import Options
from lockstep.test_runs import run, script
from nodes.controller_manager.test_in_simulation import PARAMETERS, ROBOT

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(os.name == "nt", reason="the runs are interrupted by signals"),
]

ARM = """
from launch import LaunchDescription
from launch.actions import RegisterEventHandler
from launch.event_handlers import OnProcessExit
from launch_ros.actions import Node


def generate_launch_description():
    spawn = Node(package="gazebo_ros", executable="spawn_entity.py", arguments=["-entity", "arm", "-file", "arm.urdf"])
    controllers = Node(package="controller_manager", executable="spawner",
                       arguments=["joint_state_broadcaster", "arm_controller"])
    mover = Node(executable="./mover.py", output="screen")
    return LaunchDescription([
        Node(package="gazebo_ros", executable="gzserver"),
        spawn,
        RegisterEventHandler(OnProcessExit(target_action=spawn, on_exit=[controllers])),
        RegisterEventHandler(OnProcessExit(target_action=controllers, on_exit=[mover])),
    ])
"""
MOVER = f"""#!{sys.executable}
import random

import rclpy
from builtin_interfaces.msg import Duration
from control_msgs.action import FollowJointTrajectory
from rclpy.action import ActionClient
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

rclpy.init()
node = rclpy.create_node("mover")
client = ActionClient(node, FollowJointTrajectory, "/arm_controller/follow_joint_trajectory")
client.wait_for_server()
joints = sorted({{"shoulder", "elbow"}})
points = [JointTrajectoryPoint(positions=[random.uniform(-1.0, 1.0) for _ in joints],
                               time_from_start=Duration(sec=1 + k)) for k in range(2)]
goal = FollowJointTrajectory.Goal(trajectory=JointTrajectory(joint_names=joints, points=points))
answer = client.send_goal_async(goal)
rclpy.spin_until_future_complete(node, answer)
result = answer.result().get_result_async()
rclpy.spin_until_future_complete(node, result)
node.get_logger().info(f"ended with {{result.result().status}}")
"""


def digests(folder: Path) -> dict[str, str]:
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(folder.iterdir())}


def assert_alike(first: Path, second: Path) -> None:
    """Compare the bags' bits; what differs first is quoted."""
    if digests(first / "bag") == digests(second / "bag"):
        return
    command = [sys.executable, "-m", "daidalos.cli.daidalos", "diff", str(first / "bag"), str(second / "bag")]
    pytest.fail(subprocess.run(command, capture_output=True, text=True, check=False).stdout)


def twice(tmp_path: Path, *command: object, options: Options, files: dict[str, str]) -> list[str]:
    """Run a command in two folders and processes, and compare the bags; return what was printed."""
    printed = []
    for number in (1, 2):
        folder = tmp_path / str(number)
        folder.mkdir()
        for name, text in files.items():
            script(folder, text, name).chmod(0o755)
        result = run(*command, folder=folder, options=options, hash_seed=number)
        assert (folder / "bag" / "metadata.yaml").exists(), result.stdout + result.stderr
        printed.append(result.stdout + result.stderr)
    assert_alike(tmp_path / "1", tmp_path / "2")
    return printed


def test_an_arm_under_control_gives_the_same_bag_every_time(tmp_path: Path) -> None:
    files = {
        "arm.urdf": ROBOT.replace("{parameters}", "controllers.yaml"),
        "controllers.yaml": PARAMETERS,
        "mover.py": MOVER,
        "arm.launch.py": ARM,
    }
    options = Options(seed=3, until_s=6.0, bag="bag")
    printed = twice(tmp_path, "ros2", "launch", "arm.launch.py", options=options, files=files)
    assert "[mover]: ended with 4" in printed[0]


def test_mapping_and_navigation_give_the_same_bag_every_time(tmp_path: Path) -> None:
    command = ("daidalos", "demo", "--headless", "--seed", 1)
    printed = twice(tmp_path, *command, options=Options(1, 12.0, "bag", "^/camera/"), files={})
    assert "goal 1 of 3" in printed[0]
    counts = yaml.safe_load((tmp_path / "1/bag/metadata.yaml").read_text())["rosbag2_bagfile_information"]
    topics = {one["topic_metadata"]["name"]: one["message_count"] for one in counts["topics_with_message_count"]}
    assert topics["/plan"] > 0  # it knows where it is on the map
