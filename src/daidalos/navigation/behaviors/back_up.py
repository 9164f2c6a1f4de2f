"""Behavior that drives straight backwards for a distance."""

from dataclasses import dataclass
from typing import Any

from daidalos.common.arrays import Array
from daidalos.navigation.behaviors.drive_on_heading import (
    DriveOnHeading,
    DriveOnHeadingCommand,
    DriveOnHeadingParameters,
)
from daidalos.navigation.contracts import Behavior, BehaviorStep, NavigationContext
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint
from daidalos.navigation.errors import InvalidInput


@dataclass(frozen=True)
class BackUpCommand:
    """Distance [m] and speed [m/s], both positive, and time allowance [s]."""

    backup_dist: float = 0.15
    backup_speed: float = 0.025
    time_allowance: float = 10.0


class BackUp(Behavior[BackUpCommand]):
    """Behavior that drives backwards along the robot's heading."""

    names = ("nav2_behaviors::BackUp",)
    Parameters = DriveOnHeadingParameters
    parameters: DriveOnHeadingParameters
    action = "nav2_msgs/action/BackUp"
    feedback = "distance_traveled"

    def __init__(
        self, parameters: DriveOnHeadingParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._drive = DriveOnHeading(self.parameters, self.context)

    def reconfigure(self, parameters: DriveOnHeadingParameters) -> None:
        """Implement `NavigationExtension.reconfigure`."""
        super().reconfigure(parameters)
        self._drive.reconfigure(parameters)

    def set_footprint(self, footprint: Footprint) -> None:
        """Implement `Behavior.set_footprint`."""
        super().set_footprint(footprint)
        self._drive.set_footprint(footprint)

    @classmethod
    def command(cls, goal: Any) -> BackUpCommand:
        """Implement `Behavior.command`; the signs of distance and speed do not matter."""
        return BackUpCommand(abs(goal.target.x), abs(goal.speed), goal.time_allowance)

    def start(self, command: BackUpCommand, pose: Array, now: float) -> None:
        """Implement `Behavior.start`."""
        if command.backup_dist <= 0.0 or command.backup_speed <= 0.0:
            raise InvalidInput(
                "backup_dist and backup_speed must be positive, "
                f"not {command.backup_dist} m and {command.backup_speed} m/s"
            )
        backwards = DriveOnHeadingCommand(-command.backup_dist, -command.backup_speed, command.time_allowance)
        self._drive.start(backwards, pose, now)

    def step(self, pose: Array, velocity: Array, costmap: Costmap, now: float) -> BehaviorStep:
        """Implement `Behavior.step`."""
        return self._drive.step(pose, velocity, costmap, now)
