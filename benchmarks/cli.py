"""What a user waits for who types a command, beside a running node."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time

DOMAIN = "93"
REPETITIONS = 9
ENVIRONMENT = os.environ | {"ROS_DOMAIN_ID": DOMAIN}
ROS2 = [sys.executable, "-m", "daidalos.cli.ros2"]
NODE = "import rclpy; rclpy.init(); rclpy.create_node('n').destroy_node(); rclpy.shutdown()"
TALKER = """
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("talker")
node.create_publisher(String, "chatter", 10)
print("ready", flush=True)
rclpy.spin(node)
"""


def run() -> dict[str, float]:
    """Measure; times are medians."""
    talker = subprocess.Popen([sys.executable, "-c", TALKER], env=ENVIRONMENT, stdout=subprocess.PIPE, text=True)
    assert talker.stdout is not None
    try:
        talker.stdout.readline()
        return measure_start() | measure_list()
    finally:
        subprocess.run([*ROS2, "daemon", "stop"], env=ENVIRONMENT, stdout=subprocess.DEVNULL)
        talker.kill()
        talker.communicate()


def measure_start() -> dict[str, float]:
    """Measure what costs time whatever is asked."""
    return {
        "command.python_s": seconds([sys.executable, "-c", "pass"]),
        "command.import_and_node_s": seconds([sys.executable, "-c", NODE]),
        "command.ros2_help_s": seconds([*ROS2, "--help"]),
    }


def measure_list() -> dict[str, float]:
    """Measure the list of topics, asked of the talker itself and of the daemon."""
    alone = seconds([*ROS2, "topic", "list", "--no-daemon"])
    subprocess.run([*ROS2, "daemon", "start"], env=ENVIRONMENT, stdout=subprocess.DEVNULL, check=True)
    return {
        "command.ros2_topic_list_s": alone,
        "command.ros2_topic_list_with_daemon_s": seconds([*ROS2, "topic", "list"]),
    }


def seconds(command: list[str]) -> float:
    """Return the median time of a command."""
    times = []
    for _ in range(REPETITIONS):
        begun = time.perf_counter()
        subprocess.run(command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, check=True)
        times.append(time.perf_counter() - begun)
    return statistics.median(times)
