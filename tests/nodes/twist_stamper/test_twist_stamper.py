"""Stamps on velocities, and off them."""

from __future__ import annotations

from typing import Any

import pytest
import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node
from rclpy.parameter import Parameter

from daidalos.nodes.twist_stamper.twist_stamper import TwistStamper
from daidalos.nodes.twist_stamper.twist_unstamper import TwistUnstamper


def passed(node: Node, through: Node, message: Any, kind: type[Any]) -> Any:
    """Return what a node makes of a message."""
    received: list[Any] = []
    publisher = node.create_publisher(type(message), "cmd_vel_in", 10)
    node.create_subscription(kind, "cmd_vel_out", received.append, 10)
    publisher.publish(message)
    rclpy.spin_once(through, timeout_sec=5.0)
    rclpy.spin_once(node, timeout_sec=5.0)
    return received[0]


def test_a_velocity_gets_a_stamp(node: Node) -> None:
    twist = Twist()
    twist.linear.x = 0.5
    stamper = TwistStamper(parameter_overrides=[Parameter("frame_id", value="base_link")])
    before = node.get_clock().now().nanoseconds
    message = passed(node, stamper, twist, TwistStamped)
    assert (message.twist, message.header.frame_id) == (twist, "base_link")
    assert message.header.stamp.sec * 10**9 + message.header.stamp.nanosec >= before


def test_a_velocity_loses_its_stamp(node: Node) -> None:
    stamped = TwistStamped()
    stamped.twist.angular.z = -0.25
    assert passed(node, TwistUnstamper(), stamped, Twist) == stamped.twist


@pytest.mark.usefixtures("graph")
def test_names() -> None:
    assert [TwistStamper().get_name(), TwistUnstamper().get_name()] == ["twist_stamper", "twist_unstamper"]
