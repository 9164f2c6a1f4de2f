"""Filter that keeps the robot out of zones, or makes it prefer lanes, by the costs of a mask."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import parameter
from daidalos.navigation.contracts import Input, NavigationContext
from daidalos.navigation.costmap.costmap import (
    EVERYWHERE,
    INSCRIBED_INFLATED_OBSTACLE,
    LETHAL_OBSTACLE,
    MAX_NON_OBSTACLE,
    NO_INFORMATION,
    Bounds,
    Costmap,
    Window,
)
from daidalos.navigation.costmap.costmap_filter import (
    KEEPOUT,
    UNKNOWN,
    CostmapFilter,
    CostmapFilterParameters,
    FilterInfo,
    FilterMask,
)


@dataclass(frozen=True)
class KeepoutFilterParameters(CostmapFilterParameters):
    """Parameters of the filter, by their Nav2 names."""

    override_lethal_cost: bool = parameter(
        False, "Whether the robot may leave a zone that it stands in, at the cost `lethal_override_cost`."
    )
    lethal_override_cost: int = parameter(
        MAX_NON_OBSTACLE, "Cost of the mask's cells while the robot stands in a zone; at most 252.", minimum=0
    )


class KeepoutFilter(CostmapFilter):
    """Filter that raises costs to those of a mask, from 0 for free to 254 for a value of 100.

    Values in between are the costs of lanes that the robot prefers less; unknown cells of the mask change nothing.
    """

    names = ("nav2_costmap_2d::KeepoutFilter",)
    Parameters = KeepoutFilterParameters
    parameters: KeepoutFilterParameters
    types = (KEEPOUT,)

    def __init__(
        self, parameters: KeepoutFilterParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._is_in_zone = False
        self._is_outdated = False
        self._used_place: Array | None = None

    def reconfigure(self, parameters: KeepoutFilterParameters) -> None:
        """Implement `NavigationExtension.reconfigure`; the next update filters the whole costmap."""
        super().reconfigure(parameters)
        self._is_outdated = True

    def set_info(self, info: FilterInfo) -> Input | None:
        """Set the topic of the mask; other values than base 0 and multiplier 1 are of no effect."""
        if (info.base, info.multiplier) != (0.0, 1.0):
            self.warn(f"base {info.base:g} and multiplier {info.multiplier:g} are not used, but 0 and 1")
        return super().set_info(info)

    def set_mask(self, mask: FilterMask) -> None:
        """Set the mask; the next update filters the whole costmap."""
        super().set_mask(mask)
        self._is_outdated = True

    def process(self, robot_pose: Array, bounds: Bounds) -> Bounds:
        """Return everything when the mask, its place or the cost of a zone is another one."""
        was_in_zone, self._is_in_zone = self._is_in_zone, self._find_in_zone(robot_pose)
        if self._is_in_zone and not was_in_zone:
            cost = self._override_cost
            self.context.warn(f"{self.context.name}: the robot is in a keepout zone, whose cost is {cost} to leave it")
        is_same = self._used_place is not None and np.array_equal(self._place, self._used_place)  # type: ignore[arg-type]
        if is_same and self._is_in_zone == was_in_zone and not self._is_outdated:
            return bounds
        self._used_place, self._is_outdated = self._place, False
        return EVERYWHERE

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Raise the costs of a window to those of the mask."""
        values = None if window.empty else self.mask_values(costmap, window)
        if values is None:
            return
        costs = costmap.costs[window.slices]
        wanted = _COST_OF_VALUE[values.view(np.uint8)]
        is_raised = (values != UNKNOWN) & ((wanted > costs) | (costs == NO_INFORMATION))
        costs[is_raised] = self._override_cost if self._is_in_zone else wanted[is_raised]

    @property
    def _override_cost(self) -> int:
        return min(self.parameters.lethal_override_cost, MAX_NON_OBSTACLE)

    def _find_in_zone(self, robot_pose: Array) -> bool:
        """Return whether the robot stands in a zone that it may leave."""
        value = self.value_at(robot_pose) if self.parameters.override_lethal_cost else None
        return value is not None and INSCRIBED_INFLATED_OBSTACLE <= _COST_OF_VALUE[value] <= LETHAL_OBSTACLE


_COST_OF_VALUE = np.full(256, NO_INFORMATION, dtype=np.uint8)
_COST_OF_VALUE[:101] = np.round(np.arange(101) * LETHAL_OBSTACLE / 100)
"""Costs by the value of a mask; indices above 100 are values that mean unknown, -1 among them."""
