"""`hand_over`: the left arm lifts a bar, the right arm takes it over and puts it down on its side."""

from __future__ import annotations

import math

import numpy as np

from daidalos.industry.robots.yumi import HOME_DEG
from daidalos.nodes.irb14000_description._two_arms import TwoArmClient, pose_above
from daidalos.nodes.runner import run_program

FORWARD = 0.36
"""Distance of the bar before the body [m]."""

BAR = 0.12
"""Distance of the bar's middle to the left, where it lies, and to the right, where it is put down [m]."""

GRIP = 0.075
"""Distance from the bar's middle to where each gripper holds it [m]."""

TABLE, LIFTED, APPROACH = 0.016, 0.15, 0.1
"""Heights of the grip when the bar lies and when it is handed over, and of the way down to it [m]."""


def hand_over() -> None:
    """Carry out the task."""
    import rclpy

    rclpy.init()
    arms = TwoArmClient()
    arms.connect()
    home = np.radians([HOME_DEG["left"], HOME_DEG["right"]])

    def left(y: float, z: float) -> dict[str, np.ndarray]:
        return {"left": pose_above(FORWARD, y, z, 0.5 * math.pi)}

    def right(y: float, z: float) -> dict[str, np.ndarray]:
        return {"right": pose_above(FORWARD, y, z, -0.5 * math.pi)}

    say = arms.get_logger().info
    arms.release("left", "right")
    say("the left arm takes the bar")
    arms.go(left(BAR + GRIP, TABLE + APPROACH), left(BAR + GRIP, TABLE))
    arms.go_straight(left(BAR + GRIP, TABLE))
    arms.grip("left")
    arms.go_straight(left(BAR + GRIP, LIFTED))
    arms.go_straight(left(GRIP, LIFTED))
    say("the right arm takes it over")
    arms.go(right(-GRIP, LIFTED + APPROACH), right(-GRIP, LIFTED))
    arms.go_straight(right(-GRIP, LIFTED))
    arms.grip("right")
    arms.release("left")
    arms.go_straight(left(GRIP, LIFTED + APPROACH))
    arms.go_home("left", home[0])
    say("the right arm puts it down")
    arms.go(right(-BAR - GRIP, TABLE + APPROACH), right(-BAR - GRIP, TABLE))
    arms.go_straight(right(-BAR - GRIP, TABLE))
    arms.release("right")
    arms.go_straight(right(-BAR - GRIP, TABLE + APPROACH))
    arms.go_home("right", home[1])
    say("done")


def main() -> int:
    """Run the program."""
    return run_program(hand_over, interrupted=130)
