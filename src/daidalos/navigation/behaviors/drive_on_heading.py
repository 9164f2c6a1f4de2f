"""Behavior that drives straight, forwards or backwards, for a distance."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.behaviors.collision import contact_ahead
from daidalos.navigation.contracts import Behavior, BehaviorStep, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.errors import CollisionAhead, InvalidInput, TimedOut


@dataclass(frozen=True)
class DriveOnHeadingParameters(Parameters):
    """Parameters of the behaviour, by their Nav2 names."""

    simulate_ahead_time: float = parameter(
        2.0, "How far ahead the motion is checked for collisions.", unit="s", minimum=0.0
    )


@dataclass(frozen=True)
class DriveOnHeadingCommand:
    """Distance [m] and speed [m/s], negative for backwards, and time allowance [s]."""

    distance: float = 0.15
    speed: float = 0.025
    time_allowance: float = 10.0


class DriveOnHeading(Behavior[DriveOnHeadingCommand]):
    """Behavior that drives straight until the robot is a distance away from its start."""

    names = ("nav2_behaviors::DriveOnHeading",)
    Parameters = DriveOnHeadingParameters
    parameters: DriveOnHeadingParameters
    action = "nav2_msgs/action/DriveOnHeading"
    feedback = "distance_traveled"

    def __init__(
        self, parameters: DriveOnHeadingParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._command = DriveOnHeadingCommand()
        self._deadline = 0.0
        self._from = np.zeros(3)

    @classmethod
    def command(cls, goal: Any) -> DriveOnHeadingCommand:
        """Implement `Behavior.command`."""
        return DriveOnHeadingCommand(goal.target.x, goal.speed, goal.time_allowance)

    def start(self, command: DriveOnHeadingCommand, pose: Array, now: float) -> None:
        """Implement `Behavior.start`."""
        if command.distance * command.speed <= 0.0:
            raise InvalidInput(
                "distance and speed must both be positive or both negative, "
                f"not {command.distance} m and {command.speed} m/s"
            )
        self._command = command
        self._deadline = now + command.time_allowance
        self._from = pose.copy()

    def step(self, pose: Array, velocity: Array, costmap: Costmap, now: float) -> BehaviorStep:
        """Implement `Behavior.step`."""
        driven = math.hypot(float(pose[0] - self._from[0]), float(pose[1] - self._from[1]))
        left = abs(self._command.distance) - driven
        if left <= 0.0:
            return BehaviorStep(np.zeros(3), True, driven)
        if now > self._deadline:
            raise TimedOut(f"drove {driven:.2f} m of {abs(self._command.distance):.2f} in time")
        speed = self._command.speed
        ahead = min(self.parameters.simulate_ahead_time, left / abs(speed))
        if contact_ahead(costmap, self.context.footprint, pose, speed, 0.0, ahead):
            raise CollisionAhead(f"the robot would touch something within {left:.2f} m")
        slower = math.copysign(min(abs(speed), left / self.period), speed)
        return BehaviorStep(np.array([slower, 0.0, 0.0]), False, driven)
