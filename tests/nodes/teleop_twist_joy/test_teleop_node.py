"""Velocities from a game pad."""

from __future__ import annotations

from typing import Any

import pytest
import rclpy
import yaml
from ament_index_python.packages import get_package_share_path
from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import Joy

from daidalos.nodes.teleop_twist_joy.teleop_node import TeleopTwistJoy

PAD = {
    "axis_linear.x": 1,
    "axis_linear.y": 3,
    "scale_linear.y": 0.2,
    "scale_linear_turbo.y": 0.6,
    "axis_angular.yaw": 0,
    "enable_button": 1,
    "enable_turbo_button": 2,
}
AXES = [0.5, -0.4, 1.0, 1.0]


class Drive:
    """A game pad and the robot's end."""

    def __init__(self, node: Node, kind: type[Any] = Twist, **values: Any) -> None:
        overrides = [Parameter(name, value=value) for name, value in {**PAD, **values}.items()]
        self.teleop = TeleopTwistJoy(parameter_overrides=overrides)
        self._node = node
        self._joy = node.create_publisher(Joy, "joy", 10)
        self.received: list[Any] = []
        node.create_subscription(kind, "cmd_vel", self.received.append, 10)

    def press(self, *buttons: int, axes: list[float] | None = None) -> Any:
        """Play, and return the velocity that follows, None where none does."""
        del self.received[:]
        self._joy.publish(
            Joy(axes=AXES if axes is None else axes, buttons=[int(place in buttons) for place in range(3)])
        )
        rclpy.spin_once(self.teleop, timeout_sec=5.0)
        rclpy.spin_once(self._node, timeout_sec=0.05)
        return self.received[-1] if self.received else None


def numbers(twist: Twist) -> tuple[float, ...]:
    return (twist.linear.x, twist.linear.y, twist.linear.z, twist.angular.x, twist.angular.y, twist.angular.z)


def test_a_held_button_lets_drive(node: Node) -> None:
    drive = Drive(node)
    assert drive.press() is None
    assert numbers(drive.press(1)) == pytest.approx((-0.2, 0.2, 0, 0, 0, 0.25))
    assert numbers(drive.press(1, 2)) == pytest.approx((-0.4, 0.6, 0, 0, 0, 0.5))
    assert numbers(drive.press(0)) == (0.0,) * 6
    assert drive.press(0) is None


def test_no_button_need_be_held(node: Node) -> None:
    drive = Drive(node, require_enable_button=False)
    assert numbers(drive.press())[:2] == pytest.approx((-0.2, 0.2))
    assert numbers(drive.press(axes=[0.5]))[:2] == (0.0, 0.0)


def test_turning_is_inverted_backwards(node: Node) -> None:
    drive = Drive(node, inverted_reverse=True)
    assert drive.press(1).angular.z == -0.25
    assert drive.press(1, axes=[0.5, 0.4]).angular.z == 0.25


def test_parameters_may_change(node: Node) -> None:
    drive = Drive(node)
    drive.teleop.set_parameters([Parameter("scale_linear.x", value=2.0), Parameter("enable_button", value=0)])
    assert drive.press(0).linear.x == pytest.approx(-0.8)


def test_stamped_velocities(node: Node) -> None:
    drive = Drive(node, TwistStamped, publish_stamped_twist=True, frame="base_link")
    message = drive.press(1)
    assert (message.header.frame_id, message.twist.angular.z) == ("base_link", 0.25)
    assert message.header.stamp.sec > 0
    assert numbers(drive.press().twist) == (0.0,) * 6


@pytest.mark.parametrize("pad", ["ps3", "ps3-holonomic", "xbox"])
def test_the_files_for_game_pads_hold_parameters_of_the_node(node: Node, pad: str) -> None:
    path = get_package_share_path("teleop_twist_joy") / "config" / f"{pad}.config.yaml"
    given = yaml.safe_load(path.read_text())["teleop_twist_joy_node"]["ros__parameters"]
    flat = {
        f"{name}.{inner}" if inner else name: value
        for name, values in given.items()
        for inner, value in (values.items() if isinstance(values, dict) else [("", values)])
    }
    drive = Drive(node, **flat)
    for name, value in flat.items():
        assert drive.teleop.get_parameter(name).value == value
