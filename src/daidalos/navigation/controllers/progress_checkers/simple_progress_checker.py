"""Progress checker of position."""

import math
from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import NavigationContext, ProgressChecker


@dataclass(frozen=True)
class SimpleProgressCheckerParameters(Parameters):
    """Parameters of the checker, by their Nav2 names."""

    required_movement_radius: float = parameter(0.5, "Motion that counts as progress.", unit="m", minimum=0.0)
    movement_time_allowance: float = parameter(10.0, "How long that motion may take.", unit="s", minimum=0.0)


class SimpleProgressChecker(ProgressChecker):
    """Progress checker: the robot must leave a circle around its last position within a time."""

    names = ("nav2_controller::SimpleProgressChecker",)
    Parameters = SimpleProgressCheckerParameters
    parameters: SimpleProgressCheckerParameters

    def __init__(
        self, parameters: SimpleProgressCheckerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._base: tuple[Array, float] | None = None

    def check(self, pose: Array, now: float) -> bool:
        """Implement `ProgressChecker.check`."""
        if self._base is None or self.moved_enough(self._base[0], pose):
            self._base = (pose.copy(), now)
        return now - self._base[1] <= self.parameters.movement_time_allowance

    def moved_enough(self, base: Array, pose: Array) -> bool:
        """Return whether the robot has left the circle around a pose."""
        moved = math.hypot(float(pose[0] - base[0]), float(pose[1] - base[1]))
        return moved > self.parameters.required_movement_radius

    def reset(self) -> None:
        """Implement `ProgressChecker.reset`."""
        self._base = None
