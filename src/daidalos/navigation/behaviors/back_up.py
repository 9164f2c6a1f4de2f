"""Drive straight backwards for a distance."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from daidalos.navigation.behaviors.behavior import Behavior, BehaviorStep, InvalidInput
from daidalos.navigation.behaviors.drive_on_heading import (
    DriveOnHeading,
    DriveOnHeadingCommand,
    DriveOnHeadingParameters,
)
from daidalos.navigation.costmap.costmap import Costmap
from daidalos.navigation.costmap.footprint import Footprint

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BackUpCommand:
    """How far back [m] and how fast [m/s] to drive, both positive, and how long that may take [s]."""

    backup_dist: float = 0.15
    backup_speed: float = 0.025
    time_allowance: float = 10.0


class BackUp(Behavior[BackUpCommand]):
    """Drives on the robot's heading, backwards."""

    Parameters = DriveOnHeadingParameters

    def __init__(
        self,
        footprint: Footprint,
        parameters: DriveOnHeadingParameters | None = None,
        cycle_frequency: float = 10.0,
    ) -> None:
        super().__init__(footprint, cycle_frequency)
        self._drive = DriveOnHeading(footprint, parameters, cycle_frequency)

    def start(self, command: BackUpCommand, pose: Array, now: float) -> None:
        """See `Behavior.start`."""
        if command.backup_dist <= 0.0 or command.backup_speed <= 0.0:
            raise InvalidInput(
                "backup_dist and backup_speed must be positive, "
                f"not {command.backup_dist} m and {command.backup_speed} m/s"
            )
        backwards = DriveOnHeadingCommand(-command.backup_dist, -command.backup_speed, command.time_allowance)
        self._drive.start(backwards, pose, now)

    def step(self, pose: Array, velocity: Array, costmap: Costmap, now: float) -> BehaviorStep:
        """See `Behavior.step`."""
        return self._drive.step(pose, velocity, costmap, now)
