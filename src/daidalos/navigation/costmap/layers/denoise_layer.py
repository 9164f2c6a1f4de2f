"""Removal of obstacles of few cells, which are noise of sensors."""

from dataclasses import dataclass

import numpy as np

from daidalos.common.arrays import Array
from daidalos.common.parameters import Parameters, parameter
from daidalos.navigation.contracts import Layer, NavigationContext
from daidalos.navigation.costmap.costmap import EVERYWHERE, FREE_SPACE, LETHAL_OBSTACLE, Bounds, Costmap, Window


@dataclass(frozen=True)
class DenoiseLayerParameters(Parameters):
    """Parameters of the layer, by their Nav2 names."""

    minimal_group_size: int = parameter(
        2, "Number of connected cells from which on obstacles are kept; 1 keeps all.", minimum=1
    )
    group_connectivity_type: int = parameter(
        8, "Number of neighbours of a cell: 4 by its edges, 8 by its corners too.", choices=(4, 8)
    )
    enabled: bool = parameter(True, "Whether the layer is used.")


class DenoiseLayer(Layer):
    """Layer that frees groups of fewer connected lethal cells than `minimal_group_size`.

    It stands behind the layers of obstacles and before the inflation. An update of a part of the costmap gives
    what an update of the whole gives: the part is expanded by the size of a group, and cells beyond it count.
    """

    names = ("nav2_costmap_2d::DenoiseLayer",)
    Parameters = DenoiseLayerParameters
    parameters: DenoiseLayerParameters

    def __init__(
        self, parameters: DenoiseLayerParameters | None = None, context: NavigationContext | None = None
    ) -> None:
        super().__init__(parameters, context)
        self._resolution = 0.0
        self._is_outdated = False

    def reconfigure(self, parameters: DenoiseLayerParameters) -> None:
        """Implement `NavigationExtension.reconfigure`; the next update judges the whole costmap."""
        super().reconfigure(parameters)
        self._is_outdated = True

    def match_size(self, costmap: Costmap) -> None:
        """Set the size of a cell."""
        self._resolution = costmap.resolution

    def update_bounds(self, robot_pose: Array, now: float, bounds: Bounds) -> Bounds:
        """Expand the bounds by the extent of the largest group that is removed."""
        if self._is_outdated:
            self._is_outdated = False
            return EVERYWHERE
        return bounds.expanded(self.parameters.minimal_group_size * self._resolution)

    def update_costs(self, costmap: Costmap, window: Window) -> None:
        """Free the cells of small groups."""
        size = self.parameters.minimal_group_size
        if window.empty or size == 1:
            return
        from scipy.ndimage import generate_binary_structure, label

        left, bottom = max(window.left - size, 0), max(window.bottom - size, 0)
        around = costmap.costs[bottom : window.top + size, left : window.right + size]
        neighbours = generate_binary_structure(2, 1 if self.parameters.group_connectivity_type == 4 else 2)
        groups, _ = label(around == LETHAL_OBSTACLE, neighbours)
        is_small = np.bincount(groups.ravel()) < size
        is_small[0] = False
        inside = Window(window.left - left, window.bottom - bottom, window.right - left, window.top - bottom)
        costmap.costs[window.slices][is_small[groups[inside.slices]]] = FREE_SPACE
