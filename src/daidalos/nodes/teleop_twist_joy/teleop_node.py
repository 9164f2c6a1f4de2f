"""`teleop_node`: converts game pad states to velocities."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import Joy

from daidalos.nodes.runner import run

# The axis of the game pad, the scale, and the scale of high speed, by direction.
_LINEAR = {"x": (5, 0.5, 1.0), "y": (-1, 0.0, 0.0), "z": (-1, 0.0, 0.0)}
_ANGULAR = {"yaw": (2, 0.5, 1.0), "pitch": (-1, 0.0, 0.0), "roll": (-1, 0.0, 0.0)}
_COMPONENTS = {"yaw": "z", "pitch": "y", "roll": "x"}


class TeleopTwistJoy(Node):
    """Node that publishes ``cmd_vel`` from ``joy``.

    Parameters of the node, which may change while it runs except for the last two:

    ``require_enable_button`` (whether a button must be held), ``enable_button``, ``enable_turbo_button`` (for high
    speed; -1 for none), ``inverted_reverse`` (whether turning is inverted while the robot drives backwards);
    for each direction, ``axis_linear.x``, ``scale_linear.x`` [m/s] and ``scale_linear_turbo.x`` (also ``y`` and ``z``),
    ``axis_angular.yaw``, ``scale_angular.yaw`` [rad/s] and ``scale_angular_turbo.yaw`` (also ``pitch`` and ``roll``);
    ``publish_stamped_twist`` (whether to publish TwistStamped) and ``frame`` (of those).
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("teleop_twist_joy_node", **kwargs)
        self.declare_parameter("require_enable_button", True)
        self.declare_parameter("enable_button", 0)
        self.declare_parameter("enable_turbo_button", -1)
        self.declare_parameter("inverted_reverse", False)
        for kind, directions in (("linear", _LINEAR), ("angular", _ANGULAR)):
            for direction, (axis, scale, turbo) in directions.items():
                self.declare_parameter(f"axis_{kind}.{direction}", axis)
                self.declare_parameter(f"scale_{kind}.{direction}", scale)
                self.declare_parameter(f"scale_{kind}_turbo.{direction}", turbo)
        self._stamped = bool(self.declare_parameter("publish_stamped_twist", False).value)
        self._frame = str(self.declare_parameter("frame", "teleop_twist_joy").value)
        self._stands_still = True
        self._commands: Publisher = self.create_publisher(TwistStamped if self._stamped else Twist, "cmd_vel", 10)
        self.create_subscription(Joy, "joy", self._steer, 10)

    def _steer(self, joy: Joy) -> None:
        if self._is_held(joy, "enable_turbo_button"):
            self._publish(self._velocity(joy, "_turbo"))
            self._stands_still = False
        elif not self._value("require_enable_button") or self._is_held(joy, "enable_button"):
            self._publish(self._velocity(joy, ""))
            self._stands_still = False
        elif not self._stands_still:
            # Once only, so that other nodes may drive while the button is released.
            self._publish(Twist())
            self._stands_still = True

    def _is_held(self, joy: Joy, name: str) -> bool:
        button = int(self._value(name))
        return 0 <= button < len(joy.buttons) and bool(joy.buttons[button])

    def _velocity(self, joy: Joy, speed: str) -> Twist:
        twist = Twist()
        for direction in _LINEAR:
            setattr(twist.linear, direction, self._share(joy, "linear", direction, speed))
        for direction in _ANGULAR:
            setattr(twist.angular, _COMPONENTS[direction], self._share(joy, "angular", direction, speed))
        if twist.linear.x < 0 and self._value("inverted_reverse"):
            twist.angular.z = -twist.angular.z
        return twist

    def _share(self, joy: Joy, kind: str, direction: str, speed: str) -> float:
        axis = int(self._value(f"axis_{kind}.{direction}"))
        if not 0 <= axis < len(joy.axes):
            return 0.0
        return float(joy.axes[axis]) * float(self._value(f"scale_{kind}{speed}.{direction}"))

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _publish(self, twist: Twist) -> None:
        if not self._stamped:
            self._commands.publish(twist)
            return
        message = TwistStamped(twist=twist)
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = self._frame
        self._commands.publish(message)


def main() -> int:
    """Run the node."""
    return run(TeleopTwistJoy)
