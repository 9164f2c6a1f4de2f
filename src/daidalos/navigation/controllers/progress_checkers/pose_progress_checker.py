"""Progress checker of position and yaw."""

from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.common.pose2 import wrap
from daidalos.navigation.controllers.progress_checkers.simple_progress_checker import (
    SimpleProgressChecker,
    SimpleProgressCheckerParameters,
)


@dataclass(frozen=True)
class PoseProgressCheckerParameters(SimpleProgressCheckerParameters):
    """Parameters of the checker, by their Nav2 names."""

    required_movement_angle: float = parameter(0.5, "Turn that counts as progress.", unit="rad", minimum=0.0)


class PoseProgressChecker(SimpleProgressChecker):
    """Progress checker that also accepts rotation in place."""

    names = ("nav2_controller::PoseProgressChecker",)
    Parameters = PoseProgressCheckerParameters
    parameters: PoseProgressCheckerParameters

    def moved_enough(self, base: Array, pose: Array) -> bool:
        """Return whether the robot has left the circle around a pose, or turned away from its yaw."""
        turned = abs(float(wrap(pose[2] - base[2])))
        return super().moved_enough(base, pose) or turned > self.parameters.required_movement_angle
