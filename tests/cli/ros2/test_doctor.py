"""`ros2 doctor` and `ros2 multicast`."""

import signal
import subprocess

import pytest

from .commands import ROS2, ros2

DEAF = """
import rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("talker")
node.create_publisher(String, "nobody_hears", 10)
rclpy.spin(node)
"""


@pytest.mark.slow
def test_topics_that_lead_nowhere_are_warned_of(env, beside, wait_for):
    beside(DEAF)
    wait_for("/talker/set_parameters")
    result = ros2("doctor", env=env)
    assert result.status == 0
    assert "Publisher without subscriber detected on /nobody_hears." in result.out + result.err


@pytest.mark.slow
def test_the_report_has_every_part(env, beside, wait_for):
    beside(DEAF)
    wait_for("/talker/set_parameters")
    result = ros2("wtf", "--report", env=env)
    assert result.status == 0
    titles = {line.strip() for line in result.out.splitlines() if line.startswith("   ") and line.strip().isupper()}
    parts = {"NETWORK CONFIGURATION", "PACKAGE VERSIONS", "PLATFORM INFORMATION", "QOS COMPATIBILITY LIST"}
    assert parts | {"RMW MIDDLEWARE", "TOPIC LIST"} <= titles
    assert "/nobody_hears" in result.out
    shorter = ros2("doctor", "-r", "-ep", env=env)
    assert "TOPIC LIST" in shorter.out
    assert "PACKAGE VERSIONS" not in shorter.out


def test_two_commands_reach_each_other_by_multicast(env):
    command = [*ROS2, "multicast", "receive"]
    receiver = subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True)
    try:
        assert receiver.stdout.readline() == "Waiting for UDP multicast datagram...\n"
        assert ros2("multicast", "send", env=env).out == "Sending one UDP multicast datagram...\n"
        assert "Hello World!" in receiver.stdout.readline()
    finally:
        receiver.send_signal(signal.SIGINT)
        receiver.communicate(timeout=20)
