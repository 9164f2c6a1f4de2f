"""`teleop_node`: converts game pad states to velocities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from rclpy.node import Node
from rclpy.publisher import Publisher
from sensor_msgs.msg import Joy

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.parameters import declare
from daidalos.nodes.runner import run

_COMPONENTS = {"yaw": "z", "pitch": "y", "roll": "x"}


def _axis(default: int, name: str) -> Any:
    return parameter(default, "Axis of the game pad; -1 for none.", name=f"axis_{name}")


def _scale(default: float, name: str) -> Any:
    what, unit = ("Velocity", "m/s") if name.startswith("linear") else ("Angular velocity", "rad/s")
    held = " while the turbo button is held" if "turbo" in name else ""
    return parameter(default, f"{what} at the end of the axis{held}.", unit=unit, name=f"scale_{name}")


@dataclass(frozen=True)
class TeleopTwistJoyParameters(Parameters):
    """Parameters of ``teleop_node``."""

    require_enable_button: bool = parameter(True, "Whether a button must be held to drive.")
    enable_button: int = parameter(0, "Button to be held.")
    enable_turbo_button: int = parameter(-1, "Button to be held for high speed; -1 for none.")
    inverted_reverse: bool = parameter(False, "Whether turning is inverted while the robot drives backwards.")
    axis_linear_x: int = _axis(5, "linear.x")
    axis_linear_y: int = _axis(-1, "linear.y")
    axis_linear_z: int = _axis(-1, "linear.z")
    axis_angular_yaw: int = _axis(2, "angular.yaw")
    axis_angular_pitch: int = _axis(-1, "angular.pitch")
    axis_angular_roll: int = _axis(-1, "angular.roll")
    scale_linear_x: float = _scale(0.5, "linear.x")
    scale_linear_y: float = _scale(0.0, "linear.y")
    scale_linear_z: float = _scale(0.0, "linear.z")
    scale_angular_yaw: float = _scale(0.5, "angular.yaw")
    scale_angular_pitch: float = _scale(0.0, "angular.pitch")
    scale_angular_roll: float = _scale(0.0, "angular.roll")
    scale_linear_turbo_x: float = _scale(1.0, "linear_turbo.x")
    scale_linear_turbo_y: float = _scale(0.0, "linear_turbo.y")
    scale_linear_turbo_z: float = _scale(0.0, "linear_turbo.z")
    scale_angular_turbo_yaw: float = _scale(1.0, "angular_turbo.yaw")
    scale_angular_turbo_pitch: float = _scale(0.0, "angular_turbo.pitch")
    scale_angular_turbo_roll: float = _scale(0.0, "angular_turbo.roll")
    publish_stamped_twist: bool = parameter(False, "Whether to publish TwistStamped instead of Twist.", read_only=True)
    frame: str = parameter("teleop_twist_joy", "Frame of stamped velocities.")


class TeleopTwistJoy(Node):
    """Node that publishes ``cmd_vel`` from ``joy``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("teleop_twist_joy_node", **kwargs)
        self._settings = declare(self, TeleopTwistJoyParameters, reconfigure=self._reconfigure)
        self._stamped = self._settings.publish_stamped_twist
        self._stands_still = True
        self._commands: Publisher = self.create_publisher(TwistStamped if self._stamped else Twist, "cmd_vel", 10)
        self.create_subscription(Joy, "joy", self._steer, 10)

    def _reconfigure(self, parameters: TeleopTwistJoyParameters) -> None:
        self._settings = parameters

    def _steer(self, joy: Joy) -> None:
        if _is_held(joy, self._settings.enable_turbo_button):
            self._publish(self._velocity(joy, "_turbo"))
            self._stands_still = False
        elif not self._settings.require_enable_button or _is_held(joy, self._settings.enable_button):
            self._publish(self._velocity(joy, ""))
            self._stands_still = False
        elif not self._stands_still:
            # Once only, so that other nodes may drive while the button is released.
            self._publish(Twist())
            self._stands_still = True

    def _velocity(self, joy: Joy, speed: str) -> Twist:
        twist = Twist()
        for direction in ("x", "y", "z"):
            setattr(twist.linear, direction, self._share(joy, "linear", direction, speed))
        for direction, component in _COMPONENTS.items():
            setattr(twist.angular, component, self._share(joy, "angular", direction, speed))
        if twist.linear.x < 0 and self._settings.inverted_reverse:
            twist.angular.z = -twist.angular.z
        return twist

    def _share(self, joy: Joy, kind: str, direction: str, speed: str) -> float:
        axis = getattr(self._settings, f"axis_{kind}_{direction}")
        if not 0 <= axis < len(joy.axes):
            return 0.0
        return float(joy.axes[axis]) * float(getattr(self._settings, f"scale_{kind}{speed}_{direction}"))

    def _publish(self, twist: Twist) -> None:
        if not self._stamped:
            self._commands.publish(twist)
            return
        message = TwistStamped(twist=twist)
        message.header.stamp = self.get_clock().now().to_msg()
        message.header.frame_id = self._settings.frame
        self._commands.publish(message)


def _is_held(joy: Joy, button: int) -> bool:
    return 0 <= button < len(joy.buttons) and bool(joy.buttons[button])


def main() -> int:
    """Run the node."""
    return run(TeleopTwistJoy)
