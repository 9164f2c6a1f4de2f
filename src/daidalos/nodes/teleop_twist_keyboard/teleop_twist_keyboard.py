"""`teleop_twist_keyboard`: publishes velocities that are set with the keys around K."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.keyboard import Keyboard
from daidalos.nodes.parameters import declare
from daidalos.nodes.teleoperation import run_with_keyboard

_HELP = """
Keys set the velocity, which is published as Twist or TwistStamped.
The places of the keys are those of a US keyboard.
---------------------------
Moving around:
   u    i    o
   j    k    l
   m    ,    .

Sideways (for robots that can), with the shift key:
---------------------------
   U    I    O
   J    K    L
   M    <    >

t : up (+z)
b : down (-z)

anything else : stop

q/z : increase/decrease max speeds by 10%
w/x : increase/decrease only linear speed by 10%
e/c : increase/decrease only angular speed by 10%

CTRL-C to quit
"""
_HELP_AGAIN = 15  # lines of speeds after which the help has scrolled away

# x, y, z and turning, in shares of the speeds.
_MOVES = {
    "i": (1, 0, 0, 0),
    "o": (1, 0, 0, -1),
    "j": (0, 0, 0, 1),
    "l": (0, 0, 0, -1),
    "u": (1, 0, 0, 1),
    ",": (-1, 0, 0, 0),
    ".": (-1, 0, 0, 1),
    "m": (-1, 0, 0, -1),
    "I": (1, 0, 0, 0),
    "O": (1, -1, 0, 0),
    "J": (0, 1, 0, 0),
    "L": (0, -1, 0, 0),
    "U": (1, 1, 0, 0),
    "<": (-1, 0, 0, 0),
    ">": (-1, -1, 0, 0),
    "M": (-1, 1, 0, 0),
    "t": (0, 0, 1, 0),
    "b": (0, 0, -1, 0),
}

# Factors of the linear and the angular speed.
_SPEEDS = {
    "q": (1.1, 1.1),
    "z": (0.9, 0.9),
    "w": (1.1, 1.0),
    "x": (0.9, 1.0),
    "e": (1.0, 1.1),
    "c": (1.0, 0.9),
}


@dataclass(frozen=True)
class TeleopTwistKeyboardParameters(Parameters):
    """Parameters of ``teleop_twist_keyboard``."""

    stamped: bool = parameter(False, "Whether to publish TwistStamped instead of Twist.")
    frame_id: str = parameter("", "Frame of stamped velocities.")
    speed: float = parameter(0.5, "Linear speed at the beginning.", unit="m/s")
    turn: float = parameter(1.0, "Angular speed at the beginning.", unit="rad/s")


class TeleopTwistKeyboard(Node):
    """Node that publishes ``cmd_vel``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("teleop_twist_keyboard", **kwargs)
        from geometry_msgs.msg import Twist, TwistStamped

        settings = declare(self, TeleopTwistKeyboardParameters)
        self._stamped, self._frame = settings.stamped, settings.frame_id
        self._speed, self._turn = settings.speed, settings.turn
        self._move: tuple[int, ...] = (0, 0, 0, 0)
        self._commands = self.create_publisher(TwistStamped if self._stamped else Twist, "cmd_vel", 10)

    def steer(self, keyboard: Keyboard) -> None:
        """Obey keys until there are no more; then let the robot stand still."""
        print(_HELP)
        self._say_speeds()
        told = 0
        try:
            while (key := keyboard.read()) is not None:
                if key in _SPEEDS:
                    faster, tighter = _SPEEDS[key]
                    self._speed, self._turn = self._speed * faster, self._turn * tighter
                    self._say_speeds()
                    told += 1
                    if told % _HELP_AGAIN == 0:
                        print(_HELP, flush=True)
                else:
                    self._move = _MOVES.get(key, (0, 0, 0, 0))
                self._publish()
        finally:
            self._move = (0, 0, 0, 0)
            self._publish()

    def _say_speeds(self) -> None:
        print(f"currently:\tspeed {self._speed}\tturn {self._turn} ", flush=True)

    def _publish(self) -> None:
        from geometry_msgs.msg import Twist, TwistStamped, Vector3
        from std_msgs.msg import Header

        x, y, z = (self._speed * share for share in self._move[:3])
        twist = Twist(linear=Vector3(x=x, y=y, z=z), angular=Vector3(z=self._turn * self._move[3]))
        if self._stamped:
            header = Header(stamp=self.get_clock().now().to_msg(), frame_id=self._frame)
            self._commands.publish(TwistStamped(header=header, twist=twist))
        else:
            self._commands.publish(twist)


def main() -> int:
    """Run the node."""
    return run_with_keyboard(TeleopTwistKeyboard, TeleopTwistKeyboard.steer)
