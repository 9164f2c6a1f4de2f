"""`key_teleop`: publishes velocities while arrow keys are held."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.keyboard import Keyboard
from daidalos.nodes.parameters import declare
from daidalos.nodes.teleoperation import run_with_keyboard

_HELP = "Use arrow keys to move, q to exit."
_KEY_REPEAT_S = 0.4  # a key that is held comes again within this time

# Forward and to the left.
_MOVES = {"up": (1, 0), "down": (-1, 0), "left": (0, 1), "right": (0, -1)}


@dataclass(frozen=True)
class KeyTeleopParameters(Parameters):
    """Parameters of ``key_teleop``."""

    hz: int = parameter(10, "Rate of the velocities.", unit="Hz", above=0, read_only=True)
    fwd_rate: float = parameter(0.8, "Speed ahead.", unit="m/s")
    backward_rate: float = parameter(0.5, "Speed backwards.", unit="m/s")
    rotation_rate: float = parameter(1.0, "Speed of rotation.", unit="rad/s")
    twist_stamped_enabled: bool = parameter(False, "Whether to publish TwistStamped instead of Twist.", read_only=True)


class KeyTeleop(Node):
    """Node that publishes ``key_vel`` continuously."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("key_teleop", **kwargs)
        from geometry_msgs.msg import Twist, TwistStamped

        self._settings = declare(self, KeyTeleopParameters, reconfigure=self._reconfigure)
        self._stamped = self._settings.twist_stamped_enabled
        self._pressed_ns: dict[str, int] = {}
        self._shown = ""
        self._commands = self.create_publisher(TwistStamped if self._stamped else Twist, "key_vel", 10)
        self.create_timer(1.0 / self._settings.hz, self._on_timer)

    def _reconfigure(self, parameters: KeyTeleopParameters) -> None:
        self._settings = parameters

    def steer(self, keyboard: Keyboard) -> None:
        """Obey keys until Q."""
        print(_HELP, flush=True)
        while (key := keyboard.read()) is not None and key not in ("q", "Q"):
            if key in _MOVES:
                self._pressed_ns[key] = self.get_clock().now().nanoseconds
        print()

    def _on_timer(self) -> None:
        forward, left = self._held()
        linear = forward * (self._settings.fwd_rate if forward > 0 else self._settings.backward_rate)
        self._publish(linear, left * self._settings.rotation_rate)

    def _held(self) -> tuple[int, int]:
        """Return what the keys that are held mean together."""
        now_ns = self.get_clock().now().nanoseconds
        held = [key for key, pressed_ns in self._pressed_ns.items() if now_ns - pressed_ns < _KEY_REPEAT_S * 1e9]
        return sum(_MOVES[key][0] for key in held), sum(_MOVES[key][1] for key in held)

    def _publish(self, linear: float, angular: float) -> None:
        from geometry_msgs.msg import Twist, TwistStamped, Vector3
        from std_msgs.msg import Header

        shown = f"Linear: {linear:f}, Angular: {angular:f}"
        if shown != self._shown:
            self._shown = shown
            print(f"\r{shown}   ", end="", flush=True)
        twist = Twist(linear=Vector3(x=linear), angular=Vector3(z=angular))
        if self._stamped:
            self._commands.publish(TwistStamped(header=Header(stamp=self.get_clock().now().to_msg()), twist=twist))
        else:
            self._commands.publish(twist)


def main() -> int:
    """Run the node."""
    return run_with_keyboard(KeyTeleop, KeyTeleop.steer)
