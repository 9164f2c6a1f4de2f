"""`turtle_teleop_key`: controls a turtle with the keyboard."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from rclpy.node import Node

from daidalos.common.parameters import Parameters, parameter
from daidalos.nodes.keyboard import Keyboard
from daidalos.nodes.parameters import declare
from daidalos.nodes.teleoperation import run_with_keyboard

_HELP = """Reading from keyboard
---------------------------
Use arrow keys to move the turtle.
Use G|B|V|C|D|E|R|T keys to rotate to absolute orientations. 'F' to cancel a rotation.
'Q' to quit."""

# Forward and to the left, in shares of the scales.
_MOVES = {"up": (1.0, 0.0), "down": (-1.0, 0.0), "left": (0.0, 1.0), "right": (0.0, -1.0)}

# The keys lie around F as the headings lie around the turtle.
_HEADINGS = {
    "g": 0.0,
    "t": math.pi / 4,
    "r": math.pi / 2,
    "e": 3 * math.pi / 4,
    "d": math.pi,
    "c": -3 * math.pi / 4,
    "v": -math.pi / 2,
    "b": -math.pi / 4,
}


@dataclass(frozen=True)
class TeleopTurtleParameters(Parameters):
    """Parameters of ``turtle_teleop_key``."""

    scale_angular: float = parameter(2.0, "Angular velocity of a key.", unit="rad/s")
    scale_linear: float = parameter(2.0, "Velocity of a key.", unit="1/s")


class TeleopTurtle(Node):
    """Node that publishes ``turtle1/cmd_vel`` and sends goals to ``turtle1/rotate_absolute``."""

    def __init__(self, **kwargs: Any) -> None:
        super().__init__("teleop_turtle", **kwargs)
        from geometry_msgs.msg import Twist
        from rclpy.action import ActionClient
        from turtlesim.action import RotateAbsolute

        self._settings = declare(self, TeleopTurtleParameters, reconfigure=self._reconfigure)
        self._commands = self.create_publisher(Twist, "turtle1/cmd_vel", 1)
        self._rotations = ActionClient(self, RotateAbsolute, "turtle1/rotate_absolute")
        self._rotation: Any = None

    def _reconfigure(self, parameters: TeleopTurtleParameters) -> None:
        self._settings = parameters

    def steer(self, keyboard: Keyboard) -> None:
        """Obey keys until Q."""
        print(_HELP, flush=True)
        while (key := keyboard.read()) is not None and key not in ("q", "Q"):
            if key in _MOVES:
                self._move(*_MOVES[key])
            elif key.lower() in _HEADINGS:
                self._rotate(_HEADINGS[key.lower()])
            elif key.lower() == "f":
                self._cancel()

    def _move(self, forward: float, left: float) -> None:
        from geometry_msgs.msg import Twist, Vector3

        self._commands.publish(
            Twist(
                linear=Vector3(x=forward * self._settings.scale_linear),
                angular=Vector3(z=left * self._settings.scale_angular),
            )
        )

    def _rotate(self, heading: float) -> None:
        from turtlesim.action import RotateAbsolute

        self._rotation = self._rotations.send_goal_async(RotateAbsolute.Goal(theta=heading))

    def _cancel(self) -> None:
        """Cancel the newest rotation, be it only on its way."""
        rotation, self._rotation = self._rotation, None
        if rotation is not None:
            rotation.add_done_callback(_cancel_goal)


def _cancel_goal(answer: Any) -> None:
    if answer.result().accepted:
        answer.result().cancel_goal_async()


def main() -> int:
    """Run the node."""
    return run_with_keyboard(TeleopTurtle, TeleopTurtle.steer)
