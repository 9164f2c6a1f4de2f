"""`daidalos light demo`: a point on a topic becomes Art-Net, the simulated head turns, its spot lies on the part."""

from __future__ import annotations

import math
import socket
from typing import Any

import pytest
import rclpy
from geometry_msgs.msg import PointStamped
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import LaserScan
from tf2_py import TransformException
from tf2_ros import Buffer, TransformListener
from visualization_msgs.msg import MarkerArray

from artnet_port import artnet_port
from daidalos.common.pose3 import Pose
from end_to_end.processes import DAIDALOS, Command

pytestmark = [pytest.mark.slow, pytest.mark.timeout(120)]

PART = (0.6, 0.35, 0.9)
"""On the gearbox, 0.15 m above the table."""
FREE = (0.5, -0.45, 0.75)
_PORT = 8867


class Watcher:
    """Someone who looks where the spot is."""

    def __init__(self, node: Node) -> None:
        self.node, self.markers = node, list[Any]()
        self._buffer = Buffer(node=node)
        self._listener = TransformListener(self._buffer, node)
        self._points = node.create_publisher(PointStamped, "clicked_point", 1)
        node.create_subscription(MarkerArray, "beam/markers", self._take, 1)
        node.create_subscription(LaserScan, "beam/range", lambda scan: None, 1)

    def _take(self, message: MarkerArray) -> None:
        self.markers = list(message.markers)

    @property
    def spot(self) -> tuple[float, float, float] | None:
        """Where the middle of the spot is in the world; None while it is dark or not known."""
        spots = [one for one in self.markers if one.ns == "spot" and one.color.a > 0.5]
        try:
            found = self._buffer.lookup_transform("world", "head_link", Time(), Duration(seconds=0.0)).transform
        except TransformException:
            return None
        if not spots:
            return None
        shift, turn = found.translation, found.rotation
        head = Pose((shift.x, shift.y, shift.z), (turn.x, turn.y, turn.z, turn.w))
        return head.transform((0.0, 0.0, spots[0].pose.position.z))

    def point(self, place: tuple[float, float, float]) -> None:
        """Publish a point until the spot is there."""
        message = PointStamped()
        message.header.frame_id = "world"
        message.point.x, message.point.y, message.point.z = place
        for turn in range(6000):
            if turn % 100 == 0:
                self._points.publish(message)
            rclpy.spin_once(self.node, timeout_sec=0.01)
            if self.spot is not None and math.dist(self.spot, place) < 0.01:
                return
        raise AssertionError(f"the spot is at {self.spot}, not at {place}")


def test_the_spot_lies_on_the_part(domain: int) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        artnet = str(probe.getsockname()[1])
    words = (*DAIDALOS, "light", "demo", "--no-browser", "--port", str(_PORT), "--artnet-port", artnet)
    with artnet_port(), Command(*words, domain=domain) as demo:
        demo.wait_for_line("studio: http://")
        rclpy.init(domain_id=domain)
        watcher = Watcher(rclpy.create_node("watcher"))
        for place in (PART, FREE, PART):
            watcher.point(place)
        watcher.node.destroy_node()
        rclpy.try_shutdown()
        status = demo.interrupt()
    assert status in (0, 130)
