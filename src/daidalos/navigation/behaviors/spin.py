"""Behavior that rotates in place by an angle."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import ParameterError, Parameters, parameter
from daidalos.common.pose2 import wrap
from daidalos.navigation.behaviors.collision import contact_ahead
from daidalos.navigation.contracts import Behavior, BehaviorStep, NavigationContext
from daidalos.navigation.controllers.rotation import rotation_speed
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import CollisionAhead, InvalidInput, TimedOut

DONE_ANGLE = 0.02
"""Rest of the angle [rad] at which the turn is done."""


@dataclass(frozen=True)
class SpinParameters(Parameters):
    """Parameters of the behaviour, by their Nav2 names."""

    simulate_ahead_time: float = parameter(
        2.0, "How far ahead the motion is checked for collisions.", unit="s", minimum=0.0
    )
    max_rotational_vel: float = parameter(1.0, "Largest turn rate.", unit="rad/s", above=0.0)
    min_rotational_vel: float = parameter(0.4, "Least turn rate.", unit="rad/s", minimum=0.0)
    rotational_acc_lim: float = parameter(3.2, "Largest turn acceleration.", unit="rad/s^2", above=0.0)

    def check(self) -> None:
        """Raise an error if the minimum turn rate is above the maximum."""
        if self.min_rotational_vel > self.max_rotational_vel:
            raise ParameterError("min_rotational_vel", "is above max_rotational_vel")


@dataclass(frozen=True)
class SpinCommand:
    """Angle [rad], positive to the left, and time allowance [s]."""

    target_yaw: float = 1.57
    time_allowance: float = 10.0


class Spin(Behavior[SpinCommand]):
    """Behavior that rotates by an angle of any size, measured by the robot's pose."""

    names = ("nav2_behaviors::Spin",)
    Parameters = SpinParameters
    parameters: SpinParameters
    action = "nav2_msgs/action/Spin"
    feedback = "angular_distance_traveled"

    def __init__(self, parameters: SpinParameters | None = None, context: NavigationContext | None = None) -> None:
        super().__init__(parameters, context)
        self._command = SpinCommand()
        self._deadline = 0.0
        self._last_yaw = 0.0
        self._turned = 0.0

    @classmethod
    def command(cls, goal: Any) -> SpinCommand:
        """Implement `Behavior.command`."""
        return SpinCommand(goal.target_yaw, goal.time_allowance)

    def start(self, command: SpinCommand, pose: Array, now: float) -> None:
        """Implement `Behavior.start`."""
        if not np.isfinite(command.target_yaw):
            raise InvalidInput(f"target_yaw must be a finite angle in radians, not {command.target_yaw}")
        self._command = command
        self._deadline = now + command.time_allowance
        self._last_yaw = float(pose[2])
        self._turned = 0.0

    def step(self, pose: Array, velocity: Array, costmap: Costmap, now: float) -> BehaviorStep:
        """Implement `Behavior.step`."""
        self._turned += float(wrap(pose[2] - self._last_yaw))
        self._last_yaw = float(pose[2])
        left = self._command.target_yaw - self._turned
        if abs(left) <= DONE_ANGLE:
            return BehaviorStep(np.zeros(3), True, abs(self._turned))
        if now > self._deadline:
            raise TimedOut(f"turned {abs(self._turned):.2f} rad of {abs(self._command.target_yaw):.2f} in time")
        turn = self._speed(left, float(velocity[2]))
        ahead = min(self.parameters.simulate_ahead_time, abs(left) / max(abs(turn), 1e-3))
        if contact_ahead(costmap, self.context.footprint, pose, 0.0, turn, ahead):
            raise CollisionAhead("the robot would touch something while it turns")
        return BehaviorStep(np.array([0.0, 0.0, turn]), False, abs(self._turned))

    def _speed(self, left: float, present: float) -> float:
        """Return the angular velocity that brakes in time without creeping before the last cycle."""
        p = self.parameters
        turn = rotation_speed(
            left, present, max_speed=p.max_rotational_vel, max_accel=p.rotational_acc_lim, period=self.period
        )
        slowest = min(p.min_rotational_vel, abs(left) / self.period)
        return float(np.copysign(max(abs(turn), slowest), left))
