"""`carry_together`: both arms lift a long bar at its ends, carry it forwards in step, and put it down."""

from __future__ import annotations

import math

import numpy as np

from daidalos.industry.robots.yumi import HOME_DEG
from daidalos.nodes.irb14000_description._two_arms import TwoArmClient, pose_above
from daidalos.nodes.runner import run_program

START, END = 0.36, 0.44
"""Distances of the bar before the body, before and after [m]."""

GRIP = 0.12
"""Distance from the bar's middle to where each gripper holds it [m]."""

TABLE, LIFTED = 0.016, 0.13
"""Heights of the grips when the bar lies and when it is carried [m]."""


def carry_together() -> None:
    """Carry out the task."""
    import rclpy

    rclpy.init()
    arms = TwoArmClient()
    arms.connect()

    def both(x: float, z: float) -> dict[str, np.ndarray]:
        return {"left": pose_above(x, GRIP, z, 0.5 * math.pi), "right": pose_above(x, -GRIP, z, -0.5 * math.pi)}

    say = arms.get_logger().info
    arms.release("left", "right")
    say("both arms take the bar")
    arms.go(both(START, LIFTED), both(START, TABLE))
    arms.go_straight(both(START, TABLE))
    arms.grip("left", "right")
    say("both arms carry it")
    arms.go_straight(both(START, LIFTED))
    arms.go_straight(both(END, LIFTED))
    arms.go_straight(both(END, TABLE))
    arms.release("left", "right")
    arms.go_straight(both(END, LIFTED))
    for side, angles in HOME_DEG.items():
        arms.go_home(side, np.radians(angles))
    say("done")


def main() -> int:
    """Run the program."""
    return run_program(carry_together, interrupted=130)
