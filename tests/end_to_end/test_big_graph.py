"""A graph with more endpoints than zenoh's channels hold by default."""

import sys

import pytest

from end_to_end.processes import ROS2, Command, finished

MANY = 400
NODE = f"""
import rclpy
from std_msgs.msg import Empty

rclpy.init()
node = rclpy.create_node("many")
publishers = [node.create_publisher(Empty, f"topic_{{number}}", 1) for number in range({MANY})]
print("ready", flush=True)
rclpy.spin(node)
"""


@pytest.mark.slow
def test_all_topics_of_a_big_graph_are_listed(domain: int) -> None:
    with Command(sys.executable, "-c", NODE, domain=domain) as node:
        node.wait_for_line("ready")
        listed = finished(*ROS2, "topic", "list", domain=domain, timeout=30).stdout.split()
        assert {f"/topic_{number}" for number in range(MANY)} <= set(listed)
        node.interrupt()
