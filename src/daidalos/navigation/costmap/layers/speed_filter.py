"""Filter that limits the robot's speed in zones by the values of a mask."""

from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import NavigationContext, Output, SpeedLimit
from daidalos.navigation.costmap.costmap import Bounds
from daidalos.navigation.costmap.costmap_filter import (
    SPEED_ABSOLUTE,
    SPEED_PERCENT,
    UNKNOWN,
    CostmapFilter,
    CostmapFilterParameters,
)

NO_LIMIT = 0.0


@dataclass(frozen=True)
class SpeedFilterParameters(CostmapFilterParameters):
    """Parameters of the filter, by their Nav2 names."""

    speed_limit_topic: str = parameter("speed_limit", "Topic of the speed limit.", not_empty=True, read_only=True)


class SpeedFilter(CostmapFilter):
    """Filter that publishes the speed limit of the place where the robot is, whenever it is another one.

    A mask's value v stands for a limit of base + multiplier * v, in percent for type 1 and in m/s for type 2; 0 stands
    for none. Where the mask is unknown or ends, the last limit stays.
    """

    names = ("nav2_costmap_2d::SpeedFilter",)
    Parameters = SpeedFilterParameters
    parameters: SpeedFilterParameters
    types = (SPEED_PERCENT, SPEED_ABSOLUTE)

    def __init__(
        self, parameters: SpeedFilterParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._limit = self._given = SpeedLimit(NO_LIMIT, percentage=False)

    @property
    def outputs(self) -> tuple[Output, ...]:
        """Implement `Layer.outputs`."""
        return (Output(self.parameters.speed_limit_topic, SpeedLimit, self._give),)

    def process(self, robot_pose: Array, bounds: Bounds) -> Bounds:
        """Find the limit at the robot's pose."""
        value = self.value_at(robot_pose)
        if value == UNKNOWN:
            self.warn("the mask is unknown where the robot is; the last speed limit stays")
        elif value is not None and self.info is not None:
            percentage = self.info.type == SPEED_PERCENT
            limit = NO_LIMIT if value == 0 else self.info.base + self.info.multiplier * value
            if limit < 0.0 or (percentage and limit > 100.0):
                unit = "%" if percentage else " m/s"
                self.warn(
                    f"a speed limit of {limit:g}{unit} for {value} in the mask is not possible; it means no limit"
                )
                limit = NO_LIMIT
            self._limit = SpeedLimit(limit, percentage=percentage)
        return bounds

    def _give(self) -> SpeedLimit | None:
        """Return the limit where it is another one than the last that was returned."""
        last, self._given = self._given, self._limit
        if self._limit == last or self._limit.value == last.value == NO_LIMIT:
            return None
        return self._limit
