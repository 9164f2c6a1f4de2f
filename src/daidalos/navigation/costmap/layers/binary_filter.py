"""Filter that switches something on and off, such as a camera, by the values of a mask."""

from dataclasses import dataclass

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import NavigationContext, Output
from daidalos.navigation.costmap.costmap import Bounds
from daidalos.navigation.costmap.costmap_filter import BINARY, UNKNOWN, CostmapFilter, CostmapFilterParameters


@dataclass(frozen=True)
class BinaryFilterParameters(CostmapFilterParameters):
    """Parameters of the filter, by their Nav2 names."""

    default_state: bool = parameter(False, "State where the mask does not flip it.", read_only=True)
    binary_state_topic: str = parameter("binary_state", "Topic of the state.", not_empty=True, read_only=True)
    flip_threshold: float = parameter(50.0, "Value above which the state is flipped: base + multiplier * mask.")


class BinaryFilter(CostmapFilter):
    """Filter that publishes a state at the start and whenever it changes.

    Where the mask is unknown the last state stays, outside of the mask it is `default_state`.
    """

    names = ("nav2_costmap_2d::BinaryFilter",)
    Parameters = BinaryFilterParameters
    parameters: BinaryFilterParameters
    types = (BINARY,)

    def __init__(
        self, parameters: BinaryFilterParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._state = self.parameters.default_state
        self._given: bool | None = None

    @property
    def outputs(self) -> tuple[Output, ...]:
        """Implement `Layer.outputs`."""
        return (Output(self.parameters.binary_state_topic, bool, self._give),)

    def process(self, robot_pose: Array, bounds: Bounds) -> Bounds:
        """Find the state at the robot's pose."""
        p, info = self.parameters, self.info
        value = self.value_at(robot_pose)
        if value == UNKNOWN:
            self.warn("the mask is unknown where the robot is; the last state stays")
        elif value is None or info is None:
            self._state = p.default_state
        else:
            is_flipped = info.base + info.multiplier * value > p.flip_threshold
            self._state = p.default_state != is_flipped
        return bounds

    def _give(self) -> bool | None:
        """Return the state where it is another one than the last that was returned."""
        last, self._given = self._given, self._state
        return None if last == self._state else self._state
